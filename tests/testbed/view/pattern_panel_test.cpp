// The flat pattern beside a sheet: its border, what lies in it, its scale and its place.

#include "testbed/view/panel/pattern_panel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "testbed/view/display.h"
#include "testbed/view/figure/layout.h"
#include "tests/testbed/fake_run.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior {
namespace {

using testing::HasSubstr;

constexpr Rgb kWhite{255, 255, 255};
constexpr std::array<double, 3> kRed{0.8, 0.1, 0.1};

Part of_points(Part::Kind kind, const Eigen::MatrixX3d& points) {
  Part part;
  part.kind = kind;
  part.points = points;
  return part;
}

void set_pattern(Part& part, const Eigen::MatrixX2d& places) {
  part.arrays.push_back({"pattern", "m", NamedArray::On::points, places});
}

/// Two by one metres, upright in space. It is whole along the upper half of the line u = 1 and cut
/// along the lower half; two triangles are clockwise.
Part cut_sheet() {
  Eigen::MatrixX2d places(8, 2);
  places << 0, 0, 1, 0, 1, 0.5, 1, 1, 0, 1, 1, 0, 2, 0, 2, 1;
  Part sheet;
  sheet.points.setZero(8, 3);
  sheet.points.col(0) = places.col(0);
  sheet.points.col(2) = places.col(1);
  sheet.triangles.resize(6, 3);
  sheet.triangles << 0, 1, 2, 0, 2, 4, 4, 2, 3, 5, 6, 2, 6, 2, 7, 7, 2, 3;
  set_pattern(sheet, places);
  return sheet;
}

double length(const std::vector<CurveSegment>& segments) {
  double sum = 0;
  for (const CurveSegment& s : segments) sum += (s.to - s.from).norm();
  return sum;
}

TEST(Pattern, BorderHasBothLipsOfACutAndTheSheetOnItsLeft) {
  const auto border = pattern_border(cut_sheet());
  EXPECT_NEAR(length(border), 2 * (2 + 1) + 2 * 0.5, 1e-12) << "outline and two lips";
  EXPECT_EQ(winding_number(border, {0.6, 0.3}), 1);
  EXPECT_EQ(winding_number(border, {1.6, 0.9}), 1) << "in the clockwise triangle";
  EXPECT_EQ(winding_number(border, {2.1, 0.5}), 0);
}

TEST(Pattern, WindowHoldsThePatternsOfAllSheetsThatHaveOne) {
  const Part sheet = cut_sheet();
  const Part box = make_box({-9, -9, -9}, {9, 9, 9});
  const PatternWindow window = fit_pattern({&box, &sheet});
  EXPECT_LT((window.center - Eigen::Vector2d(1, 0.5)).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(window.width_m, 2);
  EXPECT_DOUBLE_EQ(window.height_m, 1);
}

TEST(Pattern, SheetsWithoutOneAreAnErrorThatListsWhatTheyHave) {
  Part box = make_box({0, 0, 0}, {1, 1, 1});
  box.arrays.push_back({"height", "m", NamedArray::On::points, box.points.col(2)});
  const std::string error = test::error_of([&] { fit_pattern({&box}); });
  EXPECT_THAT(error, HasSubstr("figure_view.pattern"));
  EXPECT_THAT(error, HasSubstr("'height'"));
  set_pattern(box, box.points.leftCols(2));
  box.arrays.back().values = box.points;
  EXPECT_THAT(test::error_of([&] { fit_pattern({&box}); }), HasSubstr("3 components"));
}

TEST(Pattern, PlacesAreThoseOfTheOverlayOrOfTheVerticesUnderIt) {
  const Part sheet = cut_sheet();
  Part hands = of_points(Part::Kind::points, sheet.points.row(7));
  EXPECT_EQ(places_in_pattern(hands, "hands", sheet), Eigen::RowVector2d(2, 1));
  hands.points(0, 1) = 1e-3;
  EXPECT_THAT(test::error_of([&] { places_in_pattern(hands, "hands", sheet); }),
              HasSubstr("'hands'"));
  set_pattern(hands, Eigen::RowVector2d(0.25, 0.5));
  EXPECT_EQ(places_in_pattern(hands, "hands", sheet), Eigen::RowVector2d(0.25, 0.5));
}

/// Pixels of exactly this colour.
int count(const Picture& picture, const Rgb& color) {
  return static_cast<int>(std::count(picture.pixels.begin(), picture.pixels.end(), color));
}

/// 100 pixels a metre, the sheet in the middle of 240 x 140 pixels.
Picture drawn(const std::vector<PatternOverlay>& overlays,
              const std::vector<Eigen::Vector2d>& expected = {}) {
  return draw_pattern(cut_sheet(), overlays, expected, {{1, 0.5}, 100}, 240, 140);
}

TEST(Pattern, IsPaperWithADarkBorderAtItsScale) {
  const Picture picture = drawn({});
  const Rgb paper = picture.at(20 + 50, 20 + 30);
  // Of 200 x 100 pixels, less than two a side go to the border and the lips, which are 50 long.
  EXPECT_NEAR(count(picture, paper), (200 - 4) * (100 - 4) - 4 * 50, 300);
  EXPECT_LT(picture.at(20, 70)[1], 120) << "left side";
  EXPECT_LT(picture.at(220, 70)[1], 120) << "right side";
  EXPECT_LT(picture.at(120, 100)[1], 120) << "the cut, below the middle";
  EXPECT_EQ(picture.at(120, 40), paper) << "above it the sheet is whole";
  EXPECT_EQ(picture.at(120, 17), kWhite);
  EXPECT_EQ(picture.at(12, 70), kWhite);
}

TEST(Pattern, PathsAreDarkWhereTheyWereGivenAndColouredWhereTheyGrew) {
  Part path = of_points(Part::Kind::lines, Eigen::MatrixX3d::Zero(3, 3));
  path.lines = {{0, 1, 2}};
  Eigen::MatrixX2d places(3, 2);
  places << 1, 0, 1, 0.5, 1.5, 0.5;
  set_pattern(path, places);
  path.arrays.push_back({"time", "s", NamedArray::On::points, Eigen::Vector3d(0, 0, 2)});
  const Picture picture = drawn({{"tears", &path, kRed}});
  const Rgb given = picture.at(120, 100), grown = picture.at(145, 70);
  EXPECT_LT(given[0], 80);
  EXPECT_GT(grown[0], 4 * grown[1]);
  EXPECT_EQ(picture.at(145, 75), drawn({}).at(145, 75)) << "nothing beside it";
}

TEST(Pattern, OtherLinesArePaleUnderTheBorderAndPointsAreOnTop) {
  const Part sheet = cut_sheet();
  Part ruling = of_points(Part::Kind::lines, Eigen::MatrixX3d::Zero(2, 3));
  ruling.points.row(0) = sheet.points.row(0);
  ruling.points.row(1) = sheet.points.row(7);
  ruling.lines = {{0, 1}};
  const Part hands = of_points(Part::Kind::points, sheet.points.row(6));
  const Picture picture = drawn({{"hands", &hands, kRed}, {"rulings", &ruling, {0, 0, 0}}});
  int darkest = 255;
  for (int y = 85; y <= 105; ++y) darkest = std::min<int>(darkest, picture.at(70, y)[1]);
  EXPECT_LT(darkest, 200) << "the ruling goes from corner to corner";
  EXPECT_GT(darkest, 90);
  EXPECT_GT(picture.at(220, 120)[0], 4 * picture.at(220, 120)[1]) << "the hand at the corner";
  Part hull = make_box({0, 0, 0}, {1, 1, 1});
  EXPECT_THAT(test::error_of([&] { drawn({{"hull", &hull, kRed}}); }), HasSubstr("'hull'"));
}

TEST(Pattern, DashesGoOnAroundCornersOfTheirLine) {
  const auto pieces = dashes({{0, 0}, {5, 0}, {5, 9}}, 4, 2);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_LT((pieces[0].to - Eigen::Vector2d(4, 0)).norm(), 1e-12);
  EXPECT_LT((pieces[1].from - Eigen::Vector2d(5, 1)).norm(), 1e-12);
  EXPECT_LT((pieces[1].to - Eigen::Vector2d(5, 5)).norm(), 1e-12);
  EXPECT_LT((pieces[2].to - Eigen::Vector2d(5, 9)).norm(), 1e-12) << "the line ends in a dash";
}

TEST(Pattern, ExpectedCurveIsDashedOverIt) {
  const Picture plain = drawn({});
  const Picture picture = drawn({}, {{0.2, 0.75}, {0.8, 0.75}});
  int dark = 0;
  for (int x = 40; x < 100; ++x) dark += picture.at(x, 45)[1] < 100 ? 1 : 0;
  EXPECT_GT(dark, 30);
  EXPECT_LT(dark, 50);
  EXPECT_EQ(picture.at(70, 55), plain.at(70, 55));
}

TEST(Pattern, PointsThatAreNotThereOrFarAwayAreLeftOut) {
  Part hands = of_points(Part::Kind::points, Eigen::MatrixX3d::Zero(2, 3));
  Eigen::MatrixX2d places(2, 2);
  places << std::nan(""), 0.5, 1e200, -1e200;
  set_pattern(hands, places);
  Part path = hands;
  path.kind = Part::Kind::lines;
  path.lines = {{0, 1}};
  EXPECT_EQ(drawn({{"hands", &hands, kRed}, {"tears", &path, kRed}}).pixels, drawn({}).pixels);
}

/// A run of one frame a variant: flat sheets that stand as they lie in their patterns.
RunRecord make_sheet_run(const std::filesystem::path& folder,
                         const std::vector<std::pair<std::string, Part>>& sheets) {
  RunRecord record = make_fake_run(folder);
  record.cases[0].variants.clear();
  for (const auto& [name, sheet] : sheets) {
    VariantRecord variant;
    variant.name = name;
    variant.status = "done";
    add_frame(variant, folder, 0, sheet);
    record.cases[0].variants.push_back(variant);
  }
  return record;
}

FigureView front_view() {
  FigureView view;
  view.direction = {0, -1, 0};
  view.up = {0, 0, 1};
  view.overlays = {"tears"};
  view.pattern = {"tears"};
  return view;
}

/// The columns from the first to the last that hold something, a run of them at a time.
std::vector<std::pair<int, int>> drawn_columns(const Picture& picture, int top, int bottom) {
  std::vector<std::pair<int, int>> runs;
  for (int x = 0; x < picture.width; ++x) {
    bool empty = true;
    for (int y = top; y < bottom && empty; ++y) empty = picture.at(x, y) == kWhite;
    if (empty) continue;
    if (runs.empty() || runs.back().second < x - 1) runs.emplace_back(x, x);
    runs.back().second = x;
  }
  return runs;
}

TEST(Pattern, StandsBesideItsSheetAtTheSheetsScale) {
  const TestFolder folder;
  const RunRecord record =
      make_sheet_run(folder.path, {{"one", cut_sheet()}, {"other", cut_sheet()}});
  const Display display;
  const Picture picture = draw_figure(make_blocks(OpenedRun(folder.path, record), front_view()));
  // Below the headings, right of the row's label.
  const auto columns = drawn_columns(picture, 90, picture.height);
  ASSERT_EQ(columns.size(), 5u) << "label, two sheets, two patterns, apart from each other";
  const auto width = [&](int i) { return columns[i].second - columns[i].first; };
  EXPECT_NEAR(width(2), width(1), 5) << "the border is drawn about the pattern's outline";
  EXPECT_NEAR(width(4), width(3), 5);
  EXPECT_LT(columns[2].first - columns[1].second, columns[3].first - columns[2].second)
      << "a pattern is nearer to its own sheet than to the next";
  EXPECT_LT(columns[4].second, picture.width - 20);
}

// It is as high as the panels of its cell where these are lower: a sheet seen at a slant.
TEST(Pattern, IsNoHigherThanThePanelsBesideIt) {
  const TestFolder folder;
  const RunRecord record =
      make_sheet_run(folder.path, {{"one", cut_sheet()}, {"other", cut_sheet()}});
  const Display display;
  FigureView view = front_view();
  view.direction = {0, -0.2, 1};
  view.up = {0, 1, 0};
  const auto widths = [&] {
    const Picture picture = draw_figure(make_blocks(OpenedRun(folder.path, record), view));
    const auto columns = drawn_columns(picture, 90, picture.height);
    EXPECT_EQ(columns.size(), 5u);
    return std::pair(columns.at(1).second - columns[1].first, columns[2].second - columns[2].first);
  };
  const auto [sheet, pattern] = widths();
  EXPECT_LT(pattern, 0.5 * sheet);
  view.plain = true;
  const auto [lower_sheet, larger] = widths();
  EXPECT_GT(1.0 * larger / lower_sheet, 1.5 * pattern / sheet) << "beside both panels";
}

TEST(Pattern, AVariantWithoutOneLeavesItsPlaceEmpty) {
  const TestFolder folder;
  const RunRecord record = make_sheet_run(
      folder.path, {{"solid", make_box({0, 0, 0}, {2, 1, 1})}, {"sheet", cut_sheet()}});
  const Display display;
  const auto draw = [&](const std::vector<std::string>& variants) {
    FigureView view = front_view();
    view.variants = variants;
    return draw_figure(make_blocks(OpenedRun(folder.path, record), view));
  };
  const Picture both = draw({});
  EXPECT_EQ(drawn_columns(both, 90, both.height).size(), 4u) << "label, two parts, one pattern";
  EXPECT_THAT(test::error_of([&] { draw({"solid"}); }), HasSubstr("figure_view.pattern"));
}

}  // namespace
}  // namespace geoprior
