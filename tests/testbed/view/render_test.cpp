// Figures and contact sheets of a run.

#include "testbed/view/render.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/testbed/fake_run.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/view/views.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

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

}  // namespace
}  // namespace geoprior
