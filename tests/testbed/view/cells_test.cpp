// Which frames of a run a figure shows, and what stands over them.

#include "testbed/view/figure/cells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "testbed/view/figure/frame_times.h"
#include "tests/testbed/fake_run.h"

namespace geoprior {
namespace {

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

TEST(Cells, PlainPanelsHaveAPartOfTheirOwnWhereTheFrameHasIt) {
  const TestFolder folder;
  RunRecord record = make_fake_run(folder.path);
  VariantRecord& variant = record.cases[0].variants[0];
  VariantRecord extra;
  extra.name = variant.name;
  add_frame(extra, folder.path, 0, make_box({-9, -9, -9}, {9, 9, 9}), "drawn");
  variant.frames[0].files.push_back(extra.frames[0].files[0]);
  FigureView view;
  view.at_parameter = 0;
  view.plain_part = "drawn";
  const OpenedRun run(folder.path, record);
  EXPECT_FALSE(collect_cells(run, view).at(0).cells.at(0).plain.has_value()) << "none is asked for";
  view.plain = true;
  const auto rows = collect_cells(run, view);
  ASSERT_TRUE(rows.at(0).cells.at(0).plain.has_value());
  EXPECT_EQ(rows[0].cells[0].plain->points.maxCoeff(), 9);
  EXPECT_LT(rows[0].cells[0].part->points.maxCoeff(), 9);
  EXPECT_FALSE(rows[0].cells.at(1).plain.has_value()) << "it has no such part";
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

TEST(Cells, AVariantThatCouldNotRunSaysSo) {
  const TestFolder folder;
  RunRecord record = make_fake_run(folder.path);
  VariantRecord& failed = record.cases[0].variants[0];
  failed.status = "failed";
  failed.frames.clear();
  const auto rows = collect_cells(OpenedRun(folder.path, record), {});
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].cells[0].note, "cannot run");
  EXPECT_TRUE(rows[0].cells[1].part.has_value());
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

TEST(Cells, CasesStandSideBySideWhenTheViewSaysAcross) {
  const TestFolder folder;
  RunRecord record = make_fake_run(folder.path);
  for (const char* name : {"wide-one", "narrow", "flat"}) {
    record.cases.push_back(record.cases[0]);
    record.cases.back().name = name;
  }
  FigureView view;
  view.across = FigureView::Across::cases;
  view.at_parameter = 45;
  view.cases = {"wide-one", "narrow", "flat"};
  view.variants = {"second-box"};
  const auto rows = collect_cells(OpenedRun(folder.path, record), view, 2);
  ASSERT_EQ(rows.size(), 2u) << "three cases, two of them side by side";
  EXPECT_EQ(rows[0].label, "Angle 45\u00b0");
  EXPECT_EQ(rows[0].cells.at(0).label, "Wide one");
  EXPECT_EQ(rows[1].cells.at(0).label, "Flat");
  EXPECT_TRUE(rows[1].has_headings);
  view.variants.clear();
  EXPECT_EQ(collect_cells(OpenedRun(folder.path, record), view).at(1).label,
            "Second box, Angle 45\u00b0");
}

TEST(FrameTimes, AreEvenlyChosenWithTheFirstAndTheLast) {
  const TestFolder folder;
  const RunRecord record = make_fake_run(folder.path);
  EXPECT_EQ(frame_parameters(record, {}), (std::vector<double>{0, 45, 90}));
  EXPECT_EQ(evenly_chosen({0, 1, 2, 3, 4, 5, 6, 7, 8}, 3), (std::vector<double>{0, 4, 8}));
  EXPECT_EQ(evenly_chosen({0, 1}, 12), (std::vector<double>{0, 1}));
  EXPECT_EQ(evenly_chosen({0, 1, 2}, 1), (std::vector<double>{2}));
}

}  // namespace
}  // namespace geoprior
