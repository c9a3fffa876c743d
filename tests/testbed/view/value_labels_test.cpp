// Names beside what a panel shows.
#include "testbed/view/panel/value_labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "testbed/view/display.h"
#include "testbed/view/figure/layout.h"
#include "testbed/view/figure/named_values.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/view/organ_parts.h"
#include "tests/testbed/view/views.h"

namespace geoprior {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Looks at organs along -z: six by three metres, the first box's middle a metre from the left.
ViewWindow organ_window() {
  ViewWindow window;
  window.center = {2.5, 0.5, 0.5};
  window.width_m = 6;
  window.height_m = 3;
  window.depth_m = 2;
  return window;
}

std::vector<std::string> names_of(const std::vector<SeenName>& seen) {
  std::vector<std::string> names;
  for (const SeenName& one : seen) names.push_back(one.name);
  std::sort(names.begin(), names.end());
  return names;
}

TEST(SeenNames, LieInTheMiddleOfWhatIsSeen) {
  const Part part = organ_boxes({"kidney", "ureter", "bladder"});
  const auto seen = seen_names({{&part}, {}, {}}, organ_window(), "structure", 600, 300);
  ASSERT_EQ(seen.size(), 3u);
  EXPECT_EQ(seen[1].name, "ureter");
  EXPECT_NEAR(seen[1].at.x(), 250, 2);  // (2 - 2.5) m of 100 pixels, from the middle
  EXPECT_NEAR(seen[1].at.y(), 150, 2);
  EXPECT_NEAR(seen[1].pixels, 1e4, 500);
  EXPECT_TRUE(seen_names({{&part}, {}, {}}, organ_window(), "organ", 600, 300).empty());
}

// A wall before the second box, an overlay of another part; the third is outside the window.
TEST(SeenNames, AreNotOfWhatIsHiddenOrOutside) {
  const Part part = organ_boxes({"kidney", "ureter", "bladder", "far"});
  const Part wall = make_box({1.4, -0.1, 2}, {2.6, 1.1, 2.1});
  const auto seen =
      seen_names({{&part}, {{&wall, {0, 0, 0}, false}}, {}}, organ_window(), "structure", 600, 300);
  EXPECT_THAT(names_of(seen), ElementsAre("bladder", "far", "kidney"));
  ViewWindow narrow = organ_window();
  narrow.center.x() = 0.5;
  narrow.width_m = 1.6;
  EXPECT_THAT(names_of(seen_names({{&part}, {}, {}}, narrow, "structure", 160, 300)),
              ElementsAre("kidney"));
}

TEST(SeenNames, AreAlsoOfLinesAndPointsOfOverlays) {
  const Part part = organ_boxes({"kidney"});
  Part line;
  line.kind = Part::Kind::lines;
  line.points.resize(2, 3);
  line.points << 2, 0, 0, 4, 1, 0;
  line.lines = {{0, 1}};
  line.arrays = {{"structure", "1", NamedArray::On::cells, Eigen::VectorXd::Zero(1), {"duct"}}};
  Part point;
  point.kind = Part::Kind::points;
  point.points = Eigen::RowVector3d(5, 0.5, 0);
  point.arrays = {{"structure", "1", NamedArray::On::points, Eigen::VectorXd::Zero(1), {"pole"}}};
  const auto seen = seen_names({{&part}, {{&line, {}, false}, {&point, {}, false}}, {}},
                               organ_window(), "structure", 600, 300);
  EXPECT_THAT(names_of(seen), ElementsAre("duct", "kidney", "pole"));
  for (const SeenName& one : seen) {
    if (one.name == "kidney") continue;
    EXPECT_NEAR(one.at.x(), one.name == "duct" ? 350 : 550, 3);
  }
}

SeenName seen_at(const std::string& name, double x, double y, double pixels = 100) {
  return {name, {x, y}, pixels};
}

TEST(Labels, StandAtTheirThingsHeightOnTheNearerSide) {
  const auto placed =
      place_labels({seen_at("a", 100, 50), seen_at("b", 300, 150)}, 400, 200, 80, 20);
  ASSERT_EQ(placed.size(), 2u);
  EXPECT_EQ(placed[0].text, "A");
  EXPECT_FALSE(placed[0].right);
  EXPECT_DOUBLE_EQ(placed[0].y, 50);
  EXPECT_TRUE(placed[1].right);
  EXPECT_DOUBLE_EQ(placed[1].y, 150);
}

// Two that want one place move by half a line each: the least sum of squares.
TEST(Labels, AreALineApartInsideThePicture) {
  auto placed = place_labels({seen_at("a", 100, 100), seen_at("b", 110, 100)}, 400, 200, 80, 20);
  EXPECT_DOUBLE_EQ(placed[0].y, 90);
  EXPECT_DOUBLE_EQ(placed[1].y, 110);
  placed = place_labels({seen_at("a", 100, 0), seen_at("b", 110, 1), seen_at("c", 120, 199)}, 400,
                        200, 80, 20);
  EXPECT_DOUBLE_EQ(placed[0].y, 11);
  EXPECT_DOUBLE_EQ(placed[1].y, 31);
  EXPECT_DOUBLE_EQ(placed[2].y, 189);
}

// Wanted in order of height, "deep" before "near": its line would cross the other's.
TEST(Labels, DoNotCrossTheirLines) {
  const auto placed =
      place_labels({seen_at("deep", 199, 100), seen_at("near", 90, 102)}, 400, 200, 80, 60);
  ASSERT_EQ(placed.size(), 2u);
  const auto height_at = [](const PlacedLabel& label, double x) {
    return label.y + (x - 80) / (label.thing.x() - 80) * (label.thing.y() - label.y);
  };
  const PlacedLabel& deep = placed[placed[0].text == "Deep" ? 0 : 1];
  const PlacedLabel& near = placed[placed[0].text == "Deep" ? 1 : 0];
  EXPECT_GT((height_at(deep, 80) - near.y) * (height_at(deep, 90) - near.thing.y()), 0);
}

TEST(Labels, ThatDoNotFitGoToTheOtherSideAndTheLeastAreLeftOut) {
  std::vector<SeenName> seen;
  for (int i = 0; i < 12; ++i)
    seen.push_back(seen_at("n" + std::to_string(i), 10 + i, 50, 100 + i));
  const auto placed = place_labels(seen, 400, 100, 80, 20);
  ASSERT_EQ(placed.size(), 8u) << "four lines of twenty pixels a side";
  EXPECT_EQ(std::count_if(placed.begin(), placed.end(), [](const auto& p) { return p.right; }), 4);
  for (const PlacedLabel& label : placed) {
    EXPECT_GE(label.size, 104);
    EXPECT_GE(label.y, 10);
    EXPECT_LE(label.y, 90);
  }
}

TEST(Labels, MakeRoomBesideWhatThePanelsShow) {
  ViewWindow window = organ_window();
  const LabelColumns columns =
      make_label_columns("structure", {"kidney", "urinary bladder"}, 900, 1100, window);
  EXPECT_GT(columns.share, 0.1);
  EXPECT_LT(columns.share, 0.3);
  EXPECT_GT(window.width_m * (1 - 2 * columns.share), 6 - 1e-9) << "what was seen, between them";
  EXPECT_EQ(window.height_m, 3);
}

bool is_white(const Rgb& pixel) { return pixel == Rgb{255, 255, 255}; }

/// Pixels that are not white, of columns x from .. to.
int inked(const Picture& picture, int from, int to) {
  int count = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = from; x < to; ++x) count += is_white(picture.at(x, y)) ? 0 : 1;
  }
  return count;
}

TEST(Labels, AreDrawnInTheirColumnsInsideThePicture) {
  Picture picture(600, 300);
  LabelColumns columns{"structure", {"kidney", "urinary bladder"}, 0.3};
  draw_value_labels(picture, {seen_at("kidney", 200, 3), seen_at("urinary bladder", 380, 297)},
                    columns);
  EXPECT_GT(inked(picture, 0, 180), 100);
  EXPECT_GT(inked(picture, 420, 600), 100);
  EXPECT_FALSE(is_white(picture.at(200, 3))) << "a dot on the thing";
  EXPECT_EQ(inked(picture, 0, 4), 0);
  EXPECT_EQ(inked(picture, 596, 600), 0);
  const std::string many(300, 'w');
  Picture narrow(200, 100);
  draw_value_labels(narrow, {seen_at(many, 50, 50)}, {"structure", {many}, 0.3});
  EXPECT_EQ(inked(narrow, 0, 4), 0);
  EXPECT_GT(inked(narrow, 4, 90), 20) << "its beginning, and an ellipsis";
}

/// A run whose first variant has organs and whose second has none.
RunRecord organ_run(const TestFolder& folder) {
  RunRecord record = make_fake_run(folder.path);
  VariantRecord& variant = record.cases[0].variants[0];
  variant.frames.clear();
  for (int i = 0; i < 3; ++i)
    add_frame(variant, folder.path, 45.0 * i, organ_boxes({"kidney", "ureter"}));
  return record;
}

TEST(Labels, StandInThePanelsThatHaveTheArrayAndInNoOthers) {
  const TestFolder folder;
  const RunRecord record = organ_run(folder);
  FigureView view;
  view.labels = "structure";
  const auto blocks = make_blocks(OpenedRun(folder.path, record), view);
  ASSERT_TRUE(blocks.at(0).look.labels);
  EXPECT_THAT(blocks[0].look.labels->names, ElementsAre("kidney", "ureter"));
  const Display display;
  constexpr int kWidth = 160;
  const Picture picture = draw_panels(blocks[0], kWidth);
  const int column = static_cast<int>(blocks[0].look.labels->share * kWidth);
  EXPECT_GT(inked(picture, 0, column), 10);
  EXPECT_GT(inked(picture, kWidth - column, kWidth), 10);
  EXPECT_EQ(inked(picture, kWidth, kWidth + column), 0) << "the second variant has no such array";
  EXPECT_EQ(inked(picture, 2 * kWidth - column, 2 * kWidth), 0);
  view.labels = "organ";
  EXPECT_THAT(test::error_of([&] { make_blocks(OpenedRun(folder.path, record), view); }),
              HasSubstr("kind, structure"));
}

// Room for names at both sides of each: six panels without them.
TEST(Labels, HaveThreePanelsSideBySideAtMost) {
  const TestFolder folder;
  RunRecord record = make_fake_run(folder.path);
  record.cases[0].variants.resize(1);
  VariantRecord& variant = record.cases[0].variants[0];
  variant.frames.clear();
  for (int i = 0; i < 6; ++i) add_frame(variant, folder.path, 10.0 * i, organ_boxes({"kidney"}));
  FigureView view;
  view.parameters = {0, 10, 20, 30, 40, 50};
  view.across = FigureView::Across::states;
  EXPECT_EQ(make_blocks(OpenedRun(folder.path, record), view).at(0).rows.size(), 1u);
  view.labels = "structure";
  const auto rows = make_blocks(OpenedRun(folder.path, record), view).at(0).rows;
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].cells.size(), 3u);
  EXPECT_TRUE(rows[1].has_headings);
}

TEST(NamedValues, AreTheLegendOfAnArrayWithoutClasses) {
  const TestFolder folder;
  const RunRecord record = organ_run(folder);
  FigureView view;
  view.color_by = std::make_optional<std::string>("kind");
  auto blocks = make_blocks(OpenedRun(folder.path, record), view);
  EXPECT_THAT(blocks.at(0).view.classes, ElementsAre("gland", "duct"));
  ASSERT_EQ(blocks[0].look.legend.size(), 2u);
  EXPECT_EQ(blocks[0].look.legend[1].label, "Duct");
  EXPECT_EQ(blocks[0].look.style.scale->palette.size(), 2u);
  view.classes = {"one", "other"};
  blocks = make_blocks(OpenedRun(folder.path, record), view);
  EXPECT_EQ(blocks[0].look.legend[1].label, "Other") << "what the view says is first";
}

// Kinds of two parts in different order: a name is one colour, and one that is nowhere is left out.
TEST(NamedValues, OfSeveralPartsAreOneList) {
  std::vector<FigureRow> rows(1);
  rows[0].cells.resize(2);
  rows[0].cells[0].part = organ_boxes({"kidney", "ureter"});
  rows[0].cells[1].part = organ_boxes({"ureter", "bladder", "kidney"});
  rows[0].cells[1].part->arrays[0].names.push_back("nowhere");
  EXPECT_THAT(unite_names(rows, "structure"),
              ElementsAre("kidney", "ureter", "bladder", "nowhere"));
  const NamedArray& second = *named_array(*rows[0].cells[1].part, "structure");
  EXPECT_EQ(second.values(0, 0), 1);
  EXPECT_EQ(second.values(12, 0), 2);
  EXPECT_EQ(second.values(24, 0), 0);
  EXPECT_THAT(second.names, ElementsAre("kidney", "ureter", "bladder", "nowhere"));
  EXPECT_THAT(codes_that_occur(rows, "structure"), ElementsAre(true, true, true));
  EXPECT_THAT(label_names(rows, "structure"), ElementsAre("kidney", "ureter", "bladder"));
  EXPECT_TRUE(unite_names(rows, "height").empty());
}

}  // namespace
}  // namespace geoprior
