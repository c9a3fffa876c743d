#include "experiments/paper/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "core/mesh.h"
#include "experiments/paper/topic.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::paper {
namespace {

using namespace test;

class PaperScenes : public RunTest {
 protected:
  /// What a [scene] table describes.
  [[nodiscard]] PaperScene scene(const std::string& scene_lines) const {
    const auto file = write_experiment(
        "paper/scene", "title = \"A scene\"\ntopic = \"paper\"\n[scene]\n" + scene_lines +
                           "\n[[variant]]\nname = \"dense\"\nmethod = \"dense\"\n");
    const Experiment experiment = load_experiment(file, {make_topic()}, {});
    const auto loaded = make_topic().load(*experiment.cases[0].scene, file.parent_path(), 1);
    return dynamic_cast<const PaperScene&>(*loaded);
  }
  [[nodiscard]] Sheet sheet(const std::string& scene_lines) const {
    return scene(scene_lines).sheet;
  }
};

TEST_F(PaperScenes, DefaultsToAnA4SheetOfOfficePaper) {
  const Sheet s = sheet("");
  EXPECT_NEAR(signed_area(s.pattern), 0.21 * 0.297, 1e-15);
  EXPECT_EQ(s.material.thickness, 1e-4);
  EXPECT_EQ(s.material.area_density, 0.08);
  EXPECT_EQ(s.gravity, Eigen::Vector3d(0, 0, -9.81));
}

/// A quarter disc of 2 units, y down in the drawing, and a triangle beside it.
TEST_F(PaperScenes, ReadADrawingInItsUnitAndPlace) {
  std::ofstream(write_experiment("paper/scene", "").parent_path() / "shapes.svg")
      << "<svg xmlns='http://www.w3.org/2000/svg'><path id='fan' d='M0 0 L2 0 A2 2 0 0 1 0 2Z'/>"
         "<path id='flag' d='M0 0 L1 0 L0 1Z'/></svg>";
  const auto pattern = [&](const std::string& more) {
    return sheet("pattern = { kind = \"svg\", file = \"shapes.svg\", " + more + " }\n").pattern;
  };
  EXPECT_NEAR(signed_area(pattern("path = \"flag\"")), 0.5e-6, 1e-18) << "millimetres";
  EXPECT_NEAR(signed_area(pattern("path = \"flag\", unit_m = 0.1")), 0.5e-2, 1e-15);
  const std::string fan = "path = \"fan\", unit_m = 0.1, tolerance = ";
  const Pattern fine = pattern(fan + "1e-5"), coarse = pattern(fan + "1e-2");
  EXPECT_NEAR(signed_area(fine), std::numbers::pi * 0.01, 1e-5);
  EXPECT_GT(fine.border.size(), 3 * coarse.border.size());
  EXPECT_NEAR(bounding_box(fine).center().norm(), 0, 1e-15);
  const Eigen::AlignedBox2d drawn = bounding_box(pattern(fan + "1e-5, centred = false"));
  EXPECT_NEAR((drawn.min() - Eigen::Vector2d(0, -0.2)).norm(), 0, 1e-12);
}

/// 2 x 1 units on a page of which a unit is a centimetre.
TEST_F(PaperScenes, ReadADrawingByThePagesSizeOrTheirOwn) {
  std::ofstream(write_experiment("paper/scene", "").parent_path() / "page.svg")
      << "<svg xmlns='http://www.w3.org/2000/svg' width='10cm' height='10cm' viewBox='0 0 10 10'>"
         "<rect width='2' height='1'/></svg>";
  const auto loaded = [&](const std::string& more) {
    return scene("pattern = { kind = \"svg\", file = \"page.svg\"" + more + " }\n");
  };
  const PaperScene guessed = loaded("");
  EXPECT_NEAR(signed_area(guessed.sheet.pattern), 2e-4, 1e-15);
  EXPECT_THAT(guessed.load_warnings,
              testing::ElementsAre(testing::HasSubstr("is 10 mm by the size")));
  const auto area = [&](const std::string& more) {
    return signed_area(loaded(more).sheet.pattern);
  };
  EXPECT_NEAR(area(", unit = \"guess\", unit_m = 0.1"), 2e-2, 1e-15);
  EXPECT_NEAR(area(", unit = \"page\""), 2e-4, 1e-15);
  EXPECT_NEAR(area(", unit = \"viewbox\""), 2e-6, 1e-15);
}

TEST_F(PaperScenes, TurnIsAxisTimesAngleInDegrees) {
  const Sheet s = sheet(
      "handles = [{ points = [{ u = 0, v = 0.1 }], keys = [{ t = 0 }, { t = 2, move = [1, 2, 3], "
      "turn_deg = [0, 0, 90] }] }]\n"
      "placement = { move = [0, 0, 1], turn_deg = [90, 0, 0] }\n");
  const Eigen::Vector3d turned = s.handles[0].motion->at(2).turn * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((turned - Eigen::Vector3d::UnitY()).norm(), 0, 1e-15);
  EXPECT_EQ(s.handles[0].motion->at(2).shift, Eigen::Vector3d(1, 2, 3));
  const Eigen::Vector3d placed = s.placement * Eigen::Vector3d(0, 0.1, 0);
  EXPECT_NEAR((placed - Eigen::Vector3d(0, 0, 1.1)).norm(), 0, 1e-15);
}

TEST_F(PaperScenes, ReadsEveryShapeOfHandleAndObstacle) {
  const Sheet s = sheet(
      "handles = [\n"
      "  { segment = [-0.1, 0, 0.1, 0.05], keys = [{ t = 0 }], active = [{ from = 0, to = 1 }] },\n"
      "  { disc = { u = 0, v = -0.1, radius = 0.01 }, force = [0, 0, 0.5] },\n"
      "]\n"
      "obstacles = [\n"
      "  { kind = \"plane\", centre = [0, 0, -1], axis = [0, 0, 5] },\n"
      "  { kind = \"hollow-sphere\", radius = 0.5, radii = [{ t = 0, radius = 0.5 }, { t = 1, "
      "radius = 0.2 }] },\n"
      "  { kind = \"cylinder\", centre = [0, 0, 0.2], axis = [1, 0, 0], radius = 0.1, half_length "
      "= 0.3, keys = [{ t = 0 }, { t = 1, move = [0, 0, -0.1] }] },\n"
      "  { kind = \"torus\", centre = [0, 0, -0.1], radius = 0.05, tube_radius = 0.01 },\n"
      "]\n");
  ASSERT_EQ(s.handles.size(), 2U);
  EXPECT_TRUE(s.handles[0].covers({0, 0.025}));
  EXPECT_FALSE(s.handles[0].is_active(1.5));
  EXPECT_TRUE(s.handles[1].covers({0.005, -0.1}));
  EXPECT_EQ(*s.handles[1].force, Eigen::Vector3d(0, 0, 0.5));
  ASSERT_EQ(s.obstacles.size(), 4U);
  const Eigen::Vector3d x(0, 0, 0.05);
  EXPECT_NEAR(s.obstacles[0].contact(x, 0).distance, 1.05, 1e-15);
  EXPECT_NEAR(s.obstacles[1].contact(x, 1).distance, 0.15, 1e-15);
  EXPECT_NEAR(s.obstacles[2].contact(x, 1).distance, -0.05, 1e-15);
  EXPECT_NEAR(s.obstacles[3].contact(x, 0).distance, std::hypot(0.15, 0.05) - 0.01, 1e-15);
}

/// Two corners of a pattern 0.2 m wide; the right one moves by `move`, from 0 to 1 s.
std::string two_corners(const std::string& pattern, const std::string& move) {
  return "duration = 2\npattern = " + pattern +
         "\nhandles = [{ name = \"l\", points = [{ u = -0.1, v = -0.1 }], keys = [{ t = 0 }] }, "
         "{ name = \"r\", points = [{ u = 0.1, v = -0.1 }], keys = [{ t = 0 }, { t = 1, move = " +
         move + " }, { t = 2 }] }]\n";
}
const std::string kSquare = "{ kind = \"rectangle\", width = 0.2, height = 0.2 }";

// 0.3 mm of 0.2 m are 0.15 %, and 0.1 mm are 0.05 %.
TEST_F(PaperScenes, WarnOnceOfHandlesThatPullTheSheetApart) {
  const auto warnings = scene(two_corners(kSquare, "[3e-4, 0, 0]")).warnings();
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], ::testing::HasSubstr("scene.handles.0 'l' and scene.handles.1 'r'"));
  EXPECT_THAT(warnings[0], ::testing::HasSubstr("at t = 1 s"));
  EXPECT_TRUE(scene(two_corners(kSquare, "[1e-4, 0, 0]")).warnings().empty());
  EXPECT_TRUE(scene(two_corners(kSquare, "[-0.05, 0, 0.1]")).warnings().empty());
}

// Between two keys at rest the cubic is fastest in the middle, at 3/2 of the mean: 0.15 m in 1 s
// make 0.225 m/s, and the sheet is 0.2 m wide.
TEST_F(PaperScenes, WarnOnceOfHandlesThatAreFasterThanTheSheetIsWideInASecond) {
  const auto warnings = scene(two_corners(kSquare, "[-0.15, 0, 0]")).warnings();
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], ::testing::HasSubstr("scene.handles.1 'r' moves at 0.225 m/s at t = "));
  EXPECT_THAT(warnings[0], ::testing::HasSubstr("beyond 0.2 m/s"));
  EXPECT_TRUE(scene(two_corners(kSquare, "[-0.13, 0, 0]")).warnings().empty()) << "0.195 m/s";
}

// Between the feet of the notch the sheet has 0.28 m: their 0.2 m in the plane bound nothing.
TEST_F(PaperScenes, WarnOfNothingOnAPatternThatIsNotConvex) {
  const std::string notched =
      "{ kind = \"polygon\", points = [{ u = -0.1, v = -0.1 }, { u = 0, v = 0 }, { u = 0.1, v = "
      "-0.1 }, { u = 0.1, v = 0.1 }, { u = -0.1, v = 0.1 }] }";
  EXPECT_TRUE(scene(two_corners(notched, "[0.02, 0, 0]")).warnings().empty());
}

// The same triangle clockwise and counter-clockwise, and drawn in millimetres.
TEST_F(PaperScenes, PatternsRunCounterClockwiseHoweverTheyAreGiven) {
  const std::string corners[] = {"{ u = 0, v = 0 }", "{ u = 0.2, v = 0 }", "{ u = 0, v = 0.1 }"};
  const auto polygon = [&](int a, int b, int c) {
    return sheet("pattern = { kind = \"polygon\", points = [" + corners[a] + ", " + corners[b] +
                 ", " + corners[c] + "] }\n");
  };
  EXPECT_NEAR(signed_area(polygon(0, 1, 2).pattern), 0.01, 1e-15);
  EXPECT_NEAR(signed_area(polygon(0, 2, 1).pattern), 0.01, 1e-15);
  const auto drawing = folder() / "experiments" / "paper" / "triangle.svg";
  std::filesystem::create_directories(drawing.parent_path());
  std::ofstream(drawing) << "<svg><path id='t' d='M0 0 h200 l-200 100z'/></svg>";
  EXPECT_NEAR(signed_area(sheet("pattern = { kind = \"svg\", file = \"triangle.svg\" }\n").pattern),
              0.01, 1e-15);
}

/// What it holds of the flat sheet goes where the hand takes it.
TEST_F(PaperScenes, GiveHandsAsTheMapsOfWhatTheyHold) {
  const PaperScene s = scene(
      "pattern = { kind = \"rectangle\", width = 0.1, height = 0.1 }\nimperfection = 0\n"
      "placement = { move = [0, 0, 0.3], turn_deg = [0, 90, 0] }\n"
      "duration = 0.2\nframe_interval = 0.1\n[[scene.handles]]\nsegment = [-0.05, -0.05, -0.05, "
      "0.05]\nkeys = [{ t = 0 }, { t = 0.2, move = [0, 0.01, 0.02], turn_deg = [0, 0, 30] }]\n");
  const Frame given = s.given();
  const Part& sheet = given.require_part("sheet", Part::Kind::triangles);
  const Eigen::MatrixXd& handle =
      given.require_array("sheet", "handle", NamedArray::On::points).values;
  EXPECT_NEAR(triangle_areas(sheet.points, sheet.triangles).sum(), 0.01, 1e-12);
  EXPECT_EQ(given.require_table("frames").rows.col(1), Eigen::Vector3d(0, 0.1, 0.2));
  const Eigen::Matrix<double, 1, 12> last =
      given.require_table("handle_transforms").rows.bottomRightCorner<1, 12>();
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> map(last.data());
  const Eigen::Vector3d centre = s.sheet.placement * Eigen::Vector3d(-0.05, 0, 0);
  int held = 0;
  for (Eigen::Index v = 0; v < sheet.points.rows(); ++v) {
    if (handle(v) < 0) continue;
    const Eigen::Vector3d x = sheet.points.row(v);
    EXPECT_NEAR((map * x.homogeneous() - s.sheet.handles[0].target(x, centre, 0.2)).norm(), 0,
                1e-15);
    ++held;
  }
  EXPECT_GE(held, 3);
}

}  // namespace
}  // namespace geoprior::paper
