// The picture of a run: sections, framing, colours, and pixels that show what they should.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include "testbed/formats/wav_file.h"
#include "testbed/runner/process/stop.h"
#include "testbed/view/child_process.h"
#include "testbed/view/display.h"
#include "testbed/view/figure/cells.h"
#include "testbed/view/figure/colors.h"
#include "testbed/view/figure/frame_times.h"
#include "testbed/view/figure/layout.h"
#include "testbed/view/figure/legend.h"
#include "testbed/view/media/sound_track.h"
#include "testbed/view/media/spectrogram.h"
#include "testbed/view/media/video.h"
#include "testbed/view/panel/panel.h"
#include "testbed/view/panel/section.h"
#include "testbed/view/render.h"
#include "testbed/view/view_window.h"
#include "tests/testbed/fake_run.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Looks along -z at the plane z = 1/2, four by four metres.
ViewWindow front_window() {
  ViewWindow window;
  window.center = {0, 0, 0.5};
  window.width_m = 4;
  window.height_m = 4;
  return window;
}

Part box_about(double x, double half) {
  return make_box({x - half, -half, 0}, {x + half, half, 1});
}

double enclosed_area(const std::vector<CurveSegment>& segments) {
  double area = 0;
  for (const CurveSegment& s : segments) {
    area += 0.5 * (s.from.x() * s.to.y() - s.from.y() * s.to.x());
  }
  return area;
}

TEST(Section, OfABoxIsItsSquareCounterClockwise) {
  const auto segments = cut(box_about(0, 0.5), front_window());
  EXPECT_NEAR(enclosed_area(segments), 1.0, 1e-12);  // round-off of a few products
  EXPECT_EQ(winding_number(segments, {0.1, 0.2}), 1);
  EXPECT_EQ(winding_number(segments, {0.7, 0.2}), 0);
  EXPECT_EQ(winding_number(segments, {0.1, 0.8}), 0);
}

TEST(Section, CountsOverlapTwiceAndInsideOutNegative) {
  const auto overlapping = cut(join(box_about(0, 0.5), box_about(0.6, 0.5)), front_window());
  EXPECT_EQ(winding_number(overlapping, {0.3, 0.0}), 2);
  EXPECT_EQ(winding_number(overlapping, {-0.3, 0.0}), 1);
  EXPECT_EQ(winding_number(overlapping, {0.9, 0.0}), 1);
  Part inside_out = box_about(0, 0.5);
  inside_out.triangles.col(1).swap(inside_out.triangles.col(2));
  EXPECT_EQ(winding_number(cut(inside_out, front_window()), {0, 0}), -1);
}

TEST(Section, PlaneThroughVerticesGivesAClosedCurve) {
  ViewWindow window = front_window();
  window.center.z() = 1;  // the top face lies in the plane and counts as in front of it
  EXPECT_NEAR(enclosed_area(cut(box_about(0, 0.5), window)), 1.0, 1e-12);
}

TEST(Section, PaintsOverlapRedOnItsTrueArea) {
  const Part part = join(box_about(0, 0.5), box_about(0.6, 0.5));
  constexpr int kSize = 400;
  const Picture picture = draw_section(cut(part, front_window()), front_window(), kSize, kSize);
  int red = 0;
  for (const Rgb& p : picture.pixels) red += p[0] > 180 && p[1] < 120 ? 1 : 0;
  // The overlap is 0.4 m by 1 m of 16 m^2; its border, 1.5 px thick, takes at most a pixel a side.
  const double pixels_per_metre = kSize / 4.0;
  EXPECT_NEAR(red, 0.4 * pixels_per_metre * pixels_per_metre, 2.8 * pixels_per_metre);
  EXPECT_EQ(picture.at(2, 2), (Rgb{255, 255, 255}));
}

TEST(Section, OpenSurfaceIsNotFilled) {
  Part open = box_about(0, 0.5);
  open.triangles.conservativeResize(2, 3);  // one side
  const Picture picture = draw_section(cut(open, front_window()), front_window(), 100, 100);
  EXPECT_EQ(picture.at(90, 50), (Rgb{255, 255, 255}));
  EXPECT_EQ(picture.at(50, 50), (Rgb{255, 255, 255}));
}

TEST(ViewWindow, HoldsEveryPointAndIsOrthonormal) {
  const Part a = make_box({0, 0, 0}, {1, 2, 3});
  const Part b = make_box({-2, 0.5, 0}, {-1, 1, 1});
  FigureView view;
  view.direction = {1, 0.5, 2};
  const ViewWindow window = fit_window({&a, &b}, view);
  Eigen::Matrix3d axes;
  axes << window.right, window.up, window.direction;
  EXPECT_LT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  for (const Part* part : {&a, &b}) {
    for (Eigen::Index i = 0; i < part->points.rows(); ++i) {
      const Eigen::Vector3d p = part->points.row(i).transpose() - window.center;
      EXPECT_LE(std::abs(p.dot(window.right)), window.width_m / 2);
      EXPECT_LE(std::abs(p.dot(window.up)), window.height_m / 2);
      EXPECT_LE(std::abs(p.dot(window.direction)), window.depth_m);
    }
  }
}

TEST(ViewWindow, DirectionAlongUpIsAnError) {
  const Part part = make_box({0, 0, 0}, {1, 1, 1});
  FigureView view;
  view.direction = {0, 2, 0};
  EXPECT_THAT(test::error_of([&] { fit_window({&part}, view); }),
              HasSubstr("figure_view.direction"));
}

TEST(ViewWindow, SectionLooksAlongTheNormalAtThePlane) {
  SectionView section;
  section.origin = {3, 0, 0};
  section.normal = {-1, 0, 0};
  ViewWindow window = front_window();
  window.direction = Eigen::Vector3d(1, 0, 1).normalized();
  const ViewWindow plane = section_window(window, section);
  EXPECT_LT((plane.direction - Eigen::Vector3d::UnitX()).norm(), 1e-12);  // towards the eye
  EXPECT_NEAR(plane.center.x(), 3, 1e-12);
  EXPECT_NEAR(plane.center.z(), window.center.z(), 1e-12);
}

Part with_values(const std::string& name, const Eigen::VectorXd& values) {
  Part part = make_box({0, 0, 0}, {1, 1, 1});
  part.arrays.push_back({name, "m", NamedArray::On::points, values});
  return part;
}

TEST(ColorScale, SignedValuesAreSymmetricAboutZeroAndRatiosAboutOne) {
  const Eigen::VectorXd signs = Eigen::VectorXd::LinSpaced(8, -1, 3);
  const Part part = with_values("offset", signs);
  const ColorScale scale = make_color_scale({&part}, "offset");
  EXPECT_TRUE(scale.diverging);
  EXPECT_DOUBLE_EQ(scale.low, -3);
  EXPECT_DOUBLE_EQ(scale.high, 3);
  const Part ratios = with_values("area_ratio", Eigen::VectorXd::LinSpaced(8, 0.5, 1.2));
  const ColorScale about_one = make_color_scale({&ratios}, "area_ratio");
  EXPECT_DOUBLE_EQ(about_one.low, 0.5);
  EXPECT_DOUBLE_EQ(about_one.high, 1.5);
}

TEST(ColorScale, OneRangeForAllPartsAndUnknownArrayNamesTheOnesThereAre) {
  const Part a = with_values("height", Eigen::VectorXd::LinSpaced(8, 1, 2));
  const Part b = with_values("height", Eigen::VectorXd::LinSpaced(8, 3, 7));
  const ColorScale scale = make_color_scale({&a, &b}, "height");
  EXPECT_DOUBLE_EQ(scale.low, 1);
  EXPECT_DOUBLE_EQ(scale.high, 7);
  EXPECT_THAT(test::error_of([&] { make_color_scale({&a}, "curvature"); }), HasSubstr("height"));
}

TEST(Names, AreWrittenForReaders) {
  EXPECT_EQ(display_name("dual-quaternion"), "Dual quaternion");
  EXPECT_EQ(with_unit(90, "deg"), "90\u00b0");
  EXPECT_EQ(with_unit(0.25, "s"), "0.25 s");
  EXPECT_EQ(with_unit(3, "1"), "3");
  EXPECT_EQ(display_name("flip-uncorrected"), "FLIP uncorrected");
  EXPECT_EQ(display_name("pictures"), "Pictures") << "no acronym, though it begins like one";
}

TEST(Colors, AValueThatIsNoClassIsNamed) {
  Part part = two_classes();
  part.arrays[0].values(1, 0) = 2;
  EXPECT_THAT(test::error_of([&] {
                make_class_scale({&part}, "kind", {"flat", "cylinder"});
              }),
              HasSubstr("has the value 2"));
  EXPECT_EQ(make_class_scale({}, "kind", {"flat"}).classes.size(), 1u) << "no part need have it";
}

TEST(Cells, ObstaclesComeWithTheFrameAndDoNotMoveTheWindow) {
  const TestFolder folder;
  RunRecord record = make_fake_run(folder.path);
  VariantRecord& variant = record.cases[0].variants[0];
  VariantRecord extra;
  extra.name = variant.name;
  add_frame(extra, folder.path, 0, make_box({-9, -9, -9}, {9, 9, 9}), "obstacles");
  variant.frames[0].files.push_back(extra.frames[0].files[0]);
  FigureView view;
  view.at_parameter = 0;
  view.variants = {variant.name};
  const auto rows = collect_cells(OpenedRun(folder.path, record), view);
  ASSERT_TRUE(rows.at(0).cells.at(0).obstacles.has_value());
  EXPECT_TRUE(rows[0].cells[0].overlays.empty());
}

TEST(ScalarBar, TitleStaysInsideANarrowPicture) {
  ColorScale scale;
  scale.array = "curvature_of_the_reference_surface";
  scale.unit = "1/m";
  for (const int width : {360, 540, 900, 2400}) {
    Picture picture(width, 160);
    draw_scalar_bar(picture, scale, 14);
    int left = width, right = 0;
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (picture.at(x, y) == Rgb{255, 255, 255}) continue;
        left = std::min(left, x);
        right = std::max(right, x);
      }
    }
    EXPECT_GE(left, 8) << width;
    EXPECT_LE(right, width - 9) << width;
    EXPECT_GT(right - left, width / 2) << "title and bar are there";
  }
}

TEST(Legend, BreaksIntoLinesThatFitTheFigure) {
  std::vector<LegendEntry> entries;
  for (const char* name : {"Flat", "Cylinder", "Cone", "Rulings", "Singular points", "Handles"}) {
    entries.push_back({name, {0, 0, 0}, LegendEntry::Mark::area});
  }
  EXPECT_EQ(legend_lines(entries, 2400).size(), 1U);
  EXPECT_EQ(legend_height({}, 998), 0);
  const auto lines = legend_lines(entries, 998);  // a figure of one column
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].size() + lines[1].size(), entries.size());
  Picture picture(998, legend_height(entries, 998));
  draw_legend(picture, entries, 0);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < 20; ++x) {
      ASSERT_EQ(picture.at(x, y), (Rgb{255, 255, 255})) << x << ' ' << y;
      ASSERT_EQ(picture.at(997 - x, y), (Rgb{255, 255, 255})) << 997 - x << ' ' << y;
    }
  }
}

TEST(Legend, ExplainsTheClassesAndOverlaysThatSomePanelHas) {
  FigureView view;
  view.color_by = std::make_optional<std::string>("kind");
  view.classes = {"flat", "cone"};
  view.overlays = {"rulings", "singular_points"};
  FigureRow row;
  row.cells.resize(2);
  row.cells[0].part = make_box({0, 0, 0}, {1, 1, 1});  // a baseline without classes
  EXPECT_TRUE(legend_entries({row}, view).empty());
  row.cells[1].part = two_classes();
  Part points;
  points.kind = Part::Kind::points;
  row.cells[1].overlays = {{"singular_points", points}};
  const auto entries = legend_entries({row}, view);
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[1].label, "Cone");
  EXPECT_EQ(entries[2].label, "Singular points");
  EXPECT_EQ(entries[2].mark, LegendEntry::Mark::ball);
  EXPECT_GT(entries[2].color[0], 2 * entries[2].color[2]) << "red, though it is named second";
}

/// Boxes from the side, where they are flat: panels of few pixels, which are quickly drawn.
FigureView side_view() {
  FigureView view;
  view.direction = {0, -1, 0};
  view.up = {0, 0, 1};
  return view;
}
constexpr double kFlat = 0.05;  ///< height of such boxes (m)

TEST(Render, DrawsTheSameFigureTwiceWithoutADisplay) {
  const TestFolder folder;
  make_fake_run(folder.path, kFlat);
  ::unsetenv("DISPLAY");
  FigureView view = side_view();
  view.parameters = {0, 90};
  view.color_by = "height";
  view.section = SectionView{{0.5, 0.5, 0.02}, {0, 1, 0}};
  render_run(OpenedRun(folder.path), view);
  const std::string once = read_whole_file(folder.path / "figure.png");
  EXPECT_EQ(once.substr(1, 3), "PNG");
  EXPECT_LT(once.size(), 1u << 20);
  render_run(OpenedRun(folder.path), view);
  EXPECT_EQ(read_whole_file(folder.path / "figure.png"), once);
}

TEST(Render, NamesWhatTheRunDoesNotHave) {
  const TestFolder folder;
  make_fake_run(folder.path);
  FigureView view;
  view.variants = {"third-box"};
  EXPECT_THAT(test::error_of([&] { render_run(OpenedRun(folder.path), view); }),
              HasSubstr("first-box, second-box"));
  view.variants = {};
  view.part = "strokes";
  EXPECT_THAT(test::error_of([&] { render_run(OpenedRun(folder.path), view); }),
              HasSubstr("surface"));
  EXPECT_FALSE(fs::exists(folder.path / "figure.png"));
}

TEST(Cells, AFrameIsDrawnOnceThoughSeveralParametersAreNearestToIt) {
  const TestFolder folder;
  const RunRecord record = make_fake_run(folder.path);
  FigureView view;
  view.parameters = {0, 90, 120, 180};
  const auto rows = collect_cells(OpenedRun(folder.path, record), view);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].label, "Angle 90\u00b0");
}

TEST(Cells, AVariantThatFailedBeforeTheStateIsNotDrawnInAnother) {
  const TestFolder folder;
  RunRecord record = make_fake_run(folder.path);
  VariantRecord& failed = record.cases[0].variants[0];
  failed.status = "failed";
  failed.frames.resize(2);  // 0 and 45 degrees
  FigureView view;
  view.parameters = {45, 90};
  const auto rows = collect_cells(OpenedRun(folder.path, record), view);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_TRUE(rows[0].cells[0].part.has_value());
  EXPECT_EQ(rows[1].label, "Angle 90\u00b0");
  EXPECT_FALSE(rows[1].cells[0].part.has_value());
  EXPECT_EQ(rows[1].cells[0].note, "failed after 45\u00b0");
  EXPECT_TRUE(rows[1].cells[1].part.has_value());
}

// Ten iterations of one method and a hundred of another are not one state.
TEST(Cells, LastFramesAtSeveralParametersAreLabelledAsTheLast) {
  const TestFolder folder;
  RunRecord record = make_fake_run(folder.path);
  EXPECT_EQ(collect_cells(OpenedRun(folder.path, record), {}).at(0).label, "Angle 90\u00b0");
  record.cases[0].variants[0].frames.resize(2);
  EXPECT_EQ(collect_cells(OpenedRun(folder.path, record), {}).at(0).label, "Last angle");
}

TEST(Cells, NearestFrameIsTakenAndLabelledWithItsOwnParameter) {
  const TestFolder folder;
  const RunRecord record = make_fake_run(folder.path);
  FigureView view;
  view.parameters = {50};
  const auto rows = collect_cells(OpenedRun(folder.path, record), view);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].label, "Angle 45\u00b0");
  ASSERT_EQ(rows[0].cells.size(), 2u);
  EXPECT_EQ(rows[0].cells[1].label, "Second box");
  EXPECT_DOUBLE_EQ(rows[0].cells[0].part->points.col(0).maxCoeff(), 1.1);
}

TEST(Cells, StatesStandSideBySideWhenTheViewSaysAcross) {
  const TestFolder folder;
  const RunRecord record = make_fake_run(folder.path);
  FigureView view;
  view.parameters = {0, 45, 90, 180};  // 180 is nearest to 90, which is there
  view.across = FigureView::Across::states;
  const auto rows = collect_cells(OpenedRun(folder.path, record), view);
  ASSERT_EQ(rows.size(), 2u) << "a row a variant";
  EXPECT_EQ(rows[1].label, "Second box");
  ASSERT_EQ(rows[1].cells.size(), 3u);
  EXPECT_EQ(rows[1].cells[2].label, "Angle 90\u00b0");
  EXPECT_DOUBLE_EQ(rows[1].cells[1].part->points.col(0).maxCoeff(), 1.1);
  EXPECT_TRUE(rows[0].has_headings);
}

TEST(Blocks, ARowAboveHasItsOwnPartCameraAndLabel) {
  const TestFolder folder;
  const RunRecord record = make_fake_run(folder.path);
  FigureView view;
  view.parameters = {0, 90};
  view.across = FigureView::Across::states;
  view.label = "Heights";
  view.color_by = "height";
  view.variants = {"first-box"};
  view.above = FurtherRow{};
  view.above->label = "Input";
  view.above->direction = {0, -1, 0};
  view.above->up = {0, 0, 1};
  const auto blocks = make_blocks(OpenedRun(folder.path, record), view);
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0].rows[0].label, "Input");
  EXPECT_EQ(blocks[1].rows[0].label, "Heights");
  EXPECT_NEAR(blocks[0].look.window.direction.y(), -1, 1e-12);
  EXPECT_NEAR(blocks[1].look.window.direction.z(), 1, 1e-12);
  EXPECT_FALSE(blocks[0].look.style.scale) << "coloured in the row below alone";
  EXPECT_TRUE(blocks[1].look.style.scale);
  EXPECT_TRUE(blocks[0].rows[0].has_headings);
  EXPECT_FALSE(blocks[1].rows[0].has_headings) << "the same states stand over it already";
}

// The drawing that all variants share stands over them once, without a name; what is below has no
// names of its own when they stand over it already.
TEST(Blocks, RowsAboveAndBelowTakeTheirOrderAndNames) {
  const TestFolder folder;
  const RunRecord record = make_fake_run(folder.path);
  FigureView view;
  view.above = FurtherRow{};
  view.above->label = "Shared";
  view.above->variants = {"first-box"};
  view.below = FurtherRow{};
  view.below->label = "Again";
  view.below->direction = {0, -1, 0};
  view.below->up = {0, 0, 1};
  const auto blocks = make_blocks(OpenedRun(folder.path, record), view);
  ASSERT_EQ(blocks.size(), 3u);
  EXPECT_EQ(blocks[0].rows[0].cells.size(), 1u);
  EXPECT_FALSE(blocks[0].rows[0].has_headings);
  EXPECT_EQ(blocks[1].rows[0].cells.size(), 2u);
  EXPECT_TRUE(blocks[1].rows[0].has_headings);
  EXPECT_EQ(blocks[2].rows[0].label.substr(0, 5), "Again");
  EXPECT_FALSE(blocks[2].rows[0].has_headings);
  EXPECT_NEAR(blocks[2].look.window.direction.y(), -1, 1e-12);
}

// Plain panels have neither the colours nor the legend; they are under the others, and beside them
// where these are one column.
TEST(Blocks, PlainPanelsAreUnderTheOthersOrBesideASingleColumn) {
  const TestFolder folder;
  const RunRecord record = make_fake_run(folder.path);
  const auto size_of = [&](bool plain, const std::vector<std::string>& variants) {
    FigureView view;
    view.plain = plain;
    view.color_by = "height";
    view.variants = variants;
    view.parameters = {0, 90};
    const FigureSize size = figure_size(make_blocks(OpenedRun(folder.path, record), view));
    return std::pair{size.width, size.height};
  };
  const auto [width, height] = size_of(false, {});
  const auto [wide, high] = size_of(true, {});
  EXPECT_EQ(wide, width);
  EXPECT_GT(high, 1.5 * height) << "two rows more";
  const auto [narrow, low] = size_of(false, {"first-box"});
  const auto [beside, still_low] = size_of(true, {"first-box"});
  EXPECT_GT(beside, 1.8 * narrow);
  EXPECT_EQ(still_low, low);
}

TEST(Blocks, ARowAboveOfAnInputIsTakenFromTheRunOfThatContent) {
  const TestFolder folder;
  const fs::path input = folder.path / "runs/test/boxes/20250101T000000Z-00000000";
  make_fake_run(input);
  const fs::path own = folder.path / "own";
  RunRecord record = make_fake_run(own);
  record.inputs = {{"run:test/boxes/second-box", std::string(64, 'b')}};
  ::setenv("GEOPRIOR_RUNS", (folder.path / "runs").c_str(), 1);
  FigureView view;
  view.at_parameter = 45;
  view.above = FurtherRow{};
  view.above->input = "run:test/boxes/second-box";
  const auto blocks = make_blocks(OpenedRun(own, record), view);
  ASSERT_EQ(blocks.size(), 2u);
  ASSERT_EQ(blocks[0].rows.at(0).cells.size(), 1u);
  EXPECT_EQ(blocks[0].rows[0].cells[0].label, "Second box");
  record.inputs[0].sha256 = std::string(64, 'c');
  EXPECT_THAT(test::error_of([&] { make_blocks(OpenedRun(own, record), view); }),
              HasSubstr("no longer there"));
  record.inputs.clear();
  EXPECT_EQ(make_blocks(OpenedRun(own, record), view).size(), 1u)
      << "made of files: no run to show";
  ::unsetenv("GEOPRIOR_RUNS");
}

TEST(ColorScale, IdentitiesTakeColoursInTurnAndLeaveTheFirstToNone) {
  Eigen::VectorXd ids = Eigen::VectorXd::Zero(8);
  ids[3] = kIdentityColors + 1;
  const Part part = with_values("track", ids);
  const ColorScale scale = make_identity_scale({&part}, "track", true);
  ASSERT_EQ(scale.palette.size(), kIdentityColors + 2);
  EXPECT_EQ(scale.palette.front(), class_palette(1, true).front());
  EXPECT_EQ(scale.palette[1], scale.palette[kIdentityColors + 1]);
  EXPECT_NE(scale.palette[1], scale.palette[2]);
  EXPECT_NE(scale.palette[1], scale.palette[0]);
  ids[3] = 0.5;
  const Part broken = with_values("track", ids);
  EXPECT_THAT(test::error_of([&] { make_identity_scale({&broken}, "track", true); }),
              HasSubstr("0.5"));
}

TEST(FrameTimes, AreEvenlyChosenWithTheFirstAndTheLast) {
  const TestFolder folder;
  const RunRecord record = make_fake_run(folder.path);
  EXPECT_EQ(frame_parameters(record, {}), (std::vector<double>{0, 45, 90}));
  EXPECT_EQ(evenly_chosen({0, 1, 2, 3, 4, 5, 6, 7, 8}, 3), (std::vector<double>{0, 4, 8}));
  EXPECT_EQ(evenly_chosen({0, 1}, 12), (std::vector<double>{0, 1}));
  EXPECT_EQ(evenly_chosen({0, 1, 2}, 1), (std::vector<double>{2}));
}

TEST(Render, DrawsAContactSheetWhereTheViewAsksForOne) {
  const TestFolder folder;
  make_fake_run(folder.path, kFlat);
  FigureView view = side_view();
  view.variants = {"first-box"};
  render_run(OpenedRun(folder.path), view);
  EXPECT_FALSE(fs::exists(folder.path / "contact-sheet.png"));
  view.contact_sheet = 3;
  render_run(OpenedRun(folder.path), view);
  EXPECT_EQ(read_whole_file(folder.path / "contact-sheet.png").substr(1, 3), "PNG");
}

/// Puts a folder first on the PATH, for as long as it lives.
class PathOf {
 public:
  explicit PathOf(const fs::path& folder) : old_(std::getenv("PATH")) {
    ::setenv("PATH", (folder.string() + ":" + old_).c_str(), 1);
  }
  ~PathOf() { ::setenv("PATH", old_.c_str(), 1); }
  PathOf(const PathOf&) = delete;
  PathOf& operator=(const PathOf&) = delete;

 private:
  std::string old_;
};

/// A program named ffmpeg that runs `script`; its last argument is $file.
void make_ffmpeg(const fs::path& folder, const std::string& script) {
  write_file_atomically(folder / "ffmpeg",
                        std::string_view("#!/bin/sh\nfor file; do :; done\n" + script + "\n"));
  fs::permissions(folder / "ffmpeg", fs::perms::owner_all);
}

TEST(Video, HasAPictureAFrameAndIsWholeOrAbsent) {
  const TestFolder folder;
  make_fake_run(folder.path / "run", kFlat);
  const PathOf path(folder.path);
  FigureView view = side_view();
  view.variants = {"first-box"};
  make_ffmpeg(folder.path, "echo half > \"$file\"; echo no encoder >&2; exit 1");
  const fs::path out = folder.path / "50% video";
  EXPECT_THAT(test::error_of([&] {
                make_video(OpenedRun(folder.path / "run"), view, {25, out});
              }),
              HasSubstr("no encoder"));
  EXPECT_TRUE(fs::exists(out / "frame_0002.png"));
  EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 3) << "three frames, no half video";
  make_ffmpeg(folder.path, "echo \"$@\" > \"$file\"");
  const Video video = make_video(OpenedRun(folder.path / "run"), view, {25, out});
  EXPECT_EQ(video.frames, 3);
  ASSERT_EQ(video.file, out / "video.mp4");
  EXPECT_THAT(read_whole_file(out / "video.mp4"), HasSubstr("50%% video/frame_%04d.png"));
}

/// The fake run with its frames at these times (s) and a sound of the second box.
RunRecord make_sounding_run(const fs::path& folder, const std::vector<double>& times) {
  RunRecord record = make_fake_run(folder, kFlat);
  CaseRecord& of = record.cases[0];
  of.parameter_name = "time";
  of.parameter_unit = "s";
  for (VariantRecord& variant : of.variants) {
    for (std::size_t i = 0; i < times.size(); ++i) variant.frames[i].parameter = times[i];
  }
  const auto wav = wav_bytes({8000, Eigen::MatrixXd::Constant(8000, 1, 0.25)});
  const std::string name = "artifacts/default/second-box/mix.wav";
  make_folders((folder / name).parent_path());
  write_file_atomically(folder / name, std::span<const std::byte>(wav));
  of.variants[1].artifacts = {{"artifacts/default/second-box/notes.txt", ""}, {name, sha256(wav)}};
  write_fake_run(record, folder);
  return record;
}

TEST(SoundTrack, IsTheFirstWavFileOfADrawnVariantAndRealTimeIsItsRate) {
  const TestFolder folder;
  const RunRecord record = make_sounding_run(folder.path, {0.5, 0.54, 0.58});
  std::string problem;
  const auto track = sound_track(record, {}, {0.5, 0.54, 0.58}, problem);
  ASSERT_TRUE(track);
  EXPECT_EQ(track->variant, "second-box");
  EXPECT_EQ(track->file.name, "artifacts/default/second-box/mix.wav");
  EXPECT_NEAR(track->frames_per_second, 25, 1e-9);
  EXPECT_EQ(track->start_s, 0.5);
  EXPECT_EQ(problem, "");
  FigureView first_only;
  first_only.variants = {"first-box"};
  EXPECT_FALSE(sound_track(record, first_only, {0.5, 0.54, 0.58}, problem));
  EXPECT_EQ(problem, "") << "what is not drawn is not missed";
}

TEST(SoundTrack, IsAbsentWhereFramesCannotKeepStepWithIt) {
  const TestFolder folder;
  RunRecord record = make_sounding_run(folder.path, {0, 0.04, 0.08});
  std::string problem;
  EXPECT_FALSE(sound_track(record, {}, {0, 0.01, 0.08}, problem));
  EXPECT_THAT(problem, HasSubstr("evenly"));
  EXPECT_FALSE(sound_track(record, {}, {0.04}, problem));
  EXPECT_THAT(problem, HasSubstr("one frame"));
  EXPECT_FALSE(sound_track(record, {}, {-1, 0, 1}, problem));
  EXPECT_THAT(problem, HasSubstr("before the sound"));
  record.cases[0].parameter_unit = "deg";
  record.cases[0].parameter_name = "angle";
  EXPECT_FALSE(sound_track(record, {}, {0, 45, 90}, problem));
  EXPECT_THAT(problem, HasSubstr("angle"));
}

/// What the ffmpeg of this script is called with; the video holds it.
Video video_of(const fs::path& folder, std::optional<double> frames_per_second) {
  FigureView view = side_view();
  view.variants = {"second-box"};
  return make_video(OpenedRun(folder / "run"), view, {frames_per_second, folder / "video"});
}

TEST(Video, HasTheSoundOfAVariantWithItsFramesInRealTime) {
  const TestFolder folder;
  make_sounding_run(folder.path / "run", {0.5, 0.75, 1});
  const PathOf path(folder.path);
  make_ffmpeg(folder.path, "echo \"$@\" > \"$file\"");
  const Video video = video_of(folder.path, {});
  EXPECT_EQ(video.sound_of, "second-box");
  EXPECT_EQ(video.frames_per_second, 4);
  const std::string command = read_whole_file(folder.path / "video/video.mp4");
  const std::string wav = (folder.path / "run/artifacts/default/second-box/mix.wav").string();
  EXPECT_THAT(command, HasSubstr("-framerate 4 -t 0.625 -i ")) << "2.5 frames: the third begins";
  EXPECT_THAT(command, HasSubstr("-ss 0.5 -i file:" + wav + " -map 0:v -map 1:a -c:a aac"));
  const Video slow = video_of(folder.path, 2);
  EXPECT_FALSE(slow.sound_of);
  EXPECT_THAT(slow.no_sound, HasSubstr("real time is 4 frames a second"));
  const std::string silent = read_whole_file(folder.path / "video/video.mp4");
  EXPECT_THAT(silent, testing::Not(HasSubstr("aac")));
  EXPECT_THAT(silent, HasSubstr("-framerate 2 "));
}

TEST(Video, OfAnFfmpegWithoutTheCodecIsOneErrorThatSaysSo) {
  const TestFolder folder;
  make_sounding_run(folder.path / "run", {0, 0.25, 0.5});
  const PathOf path(folder.path);
  make_ffmpeg(folder.path, "echo \"Unknown encoder 'aac'\" >&2; exit 1");
  EXPECT_THAT(test::error_of([&] { video_of(folder.path, {}); }),
              testing::AllOf(HasSubstr("Unknown encoder 'aac'"), HasSubstr("mp4 with AAC")));
  EXPECT_FALSE(fs::exists(folder.path / "video/video.mp4"));
  std::ofstream(folder.path / "run/artifacts/default/second-box/mix.wav", std::ios::app) << "more";
  EXPECT_THAT(test::error_of([&] { video_of(folder.path, {}); }), HasSubstr("mix.wav"));
}

TEST(Spectrogram, IsDrawnWithFramesWhereTheRunHasASound) {
  const TestFolder folder;
  make_fake_run(folder.path / "mute");
  EXPECT_FALSE(draw_spectrogram(OpenedRun(folder.path / "mute"), {}));
  EXPECT_FALSE(fs::exists(folder.path / "mute/spectrogram.png"));
  const fs::path run = folder.path / "run";
  make_sounding_run(run, {0, 0.5, 1});
  ::unsetenv("DISPLAY");
  EXPECT_TRUE(draw_spectrogram(OpenedRun(run), side_view()));
  EXPECT_EQ(read_whole_file(run / "spectrogram.png").substr(1, 3), "PNG");
  EXPECT_FALSE(fs::exists(run / "spectrogram-frames.png"));
}

// Beside the panels there is nothing: the second row begins where the first one ends.
TEST(Panels, AreDrawnEdgeToEdge) {
  const TestFolder folder;
  const RunRecord record = make_fake_run(folder.path);
  FigureView view;
  view.parameters = {0, 45, 90};
  view.across = FigureView::Across::states;
  const auto blocks = make_blocks(OpenedRun(folder.path, record), view);
  ASSERT_EQ(blocks.size(), 1u);
  EXPECT_EQ(blocks[0].rows[1].cells[2].parameter, 90);
  const Display display;
  const Picture picture = draw_panels(blocks[0], 100);
  EXPECT_EQ(picture.width, 300);
  const ViewWindow& window = blocks[0].look.window;
  const int height = static_cast<int>(std::lround(100 * window.height_m / window.width_m));
  EXPECT_EQ(picture.height, 2 * height);
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) {
      EXPECT_NE(picture.at(100 * column + 50, row * height + height / 2), (Rgb{255, 255, 255}))
          << row << ' ' << column;
    }
  }
}

TEST(Video, IsLeftOutAfterCtrlC) {
  const TestFolder folder;
  make_fake_run(folder.path);
  request_stop();
  const Video video = make_video(OpenedRun(folder.path), {}, {25, folder.path / "video"});
  clear_stop();
  EXPECT_TRUE(video.stopped);
  EXPECT_EQ(video.frames, 0);
  EXPECT_FALSE(video.file);
}

}  // namespace
}  // namespace geoprior
