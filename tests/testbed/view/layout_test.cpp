// Rows and columns of a figure.

#include "testbed/view/figure/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "testbed/view/display.h"
#include "tests/testbed/fake_run.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

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

TEST(Blocks, ARowBelowShowsTheOtherSideOfSomeFrames) {
  const TestFolder folder;
  const RunRecord record = make_fake_run(folder.path);
  FigureView view;
  view.parameters = {0, 90};
  view.below = FurtherRow{};
  view.below->direction = {0, 0, -1};
  view.below->target = {0.1, 0.2, 0.3};  // its height in the picture
  view.below->height_m = 2;
  view.below->parameters = {90};
  view.at_parameter = 0;  // of the figure alone
  const auto blocks = make_blocks(OpenedRun(folder.path, record), view);
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0].rows.size(), 2u);
  EXPECT_EQ(blocks[1].rows.size(), 1u);
  EXPECT_NEAR(blocks[1].look.window.center.y(), 0.2, 1e-12);
  EXPECT_DOUBLE_EQ(blocks[1].look.window.height_m, 2);
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

}  // namespace
}  // namespace geoprior
