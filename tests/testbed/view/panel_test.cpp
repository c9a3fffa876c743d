// What a panel shows: pixels of surfaces, lines, points and grids, of paper and its folds.

#include "testbed/view/panel/panel.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "testbed/view/display.h"
#include "testbed/view/figure/colors.h"
#include "tests/support/long_tests.h"
#include "tests/testbed/fake_run.h"

namespace geoprior {
namespace {

Part make_sphere(double radius, int rings) {
  Part part;
  const int sectors = 2 * rings;
  part.points.resize((rings + 1) * sectors, 3);
  part.triangles.resize(2 * rings * sectors, 3);
  Eigen::Index t = 0;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double theta = std::numbers::pi * i / rings;
      const double phi = 2 * std::numbers::pi * j / sectors;
      part.points.row(i * sectors + j) =
          radius * Eigen::RowVector3d(std::sin(theta) * std::cos(phi), std::cos(theta),
                                      -std::sin(theta) * std::sin(phi));
      if (i == rings) continue;
      const int next = (j + 1) % sectors;
      part.triangles.row(t++) << i * sectors + j, (i + 1) * sectors + j, i * sectors + next;
      part.triangles.row(t++) << i * sectors + next, (i + 1) * sectors + j,
          (i + 1) * sectors + next;
    }
  }
  return part;
}

TEST(Panel, SphereCoversItsDiscOnWhite) {
  const Display display;
  const Part sphere = make_sphere(1, 48);
  ViewWindow window;
  window.width_m = 4;
  window.height_m = 4;
  window.depth_m = 1.2;
  constexpr int kSize = 200;
  const Picture picture = draw_panel({{&sphere}, {}, {}}, window, {}, kSize, kSize);
  int covered = 0;
  for (const Rgb& p : picture.pixels) covered += p[0] < 250 || p[2] < 250 ? 1 : 0;
  const double radius_px = kSize / 4.0;
  // One pixel of soft edge around the disc.
  EXPECT_NEAR(covered, std::numbers::pi * radius_px * radius_px, 2 * std::numbers::pi * radius_px);
  EXPECT_EQ(picture.at(0, 0), (Rgb{255, 255, 255}));
  const Rgb lit = picture.at(80, 75);  // the key light comes from the upper left
  const Rgb shaded = picture.at(125, 135);
  EXPECT_GT(lit[0], shaded[0] + 20);
}

TEST(Panel, LinesPointsAndGridsAreDrawn) {
  const Display display;
  Part lines;
  lines.kind = Part::Kind::lines;
  lines.points.resize(2, 3);
  lines.points << -1, 0, 0, 1, 0, 0;
  lines.lines = {{0, 1}};
  Part points;
  points.kind = Part::Kind::points;
  points.points = lines.points;
  Part ball;  // the distance field of a ball: its zero level is drawn
  ball.kind = Part::Kind::grid;
  ball.grid_size = {21, 21, 21};
  ball.grid_origin.setConstant(-1);
  ball.grid_spacing.setConstant(0.1);
  Eigen::VectorXd distance(21 * 21 * 21);
  for (int i = 0; i < distance.size(); ++i) {
    const Eigen::Vector3d p(i % 21, (i / 21) % 21, i / 441);
    distance[i] = (0.1 * p - Eigen::Vector3d::Ones()).norm() - 0.6;
  }
  ball.arrays.push_back({"distance", "m", NamedArray::On::points, distance});
  ViewWindow window;
  window.width_m = 4;
  window.height_m = 4;
  window.depth_m = 2;
  for (const Part* part : {&lines, &points, &ball}) {
    const Picture picture = draw_panel({{part}, {}, {}}, window, {}, 100, 100);
    int covered = 0;
    for (const Rgb& p : picture.pixels) covered += p[0] < 240 ? 1 : 0;
    EXPECT_GT(covered, 4) << static_cast<int>(part->kind);
    EXPECT_LT(covered, 3000) << static_cast<int>(part->kind);
  }
}

ViewWindow above() {
  ViewWindow window;
  window.width_m = 4;
  window.height_m = 4;
  window.depth_m = 1;
  return window;
}

/// Blue over red: above 1 for class 1 (blue), below it for class 0 (warm white) and for red.
double blueness(const Rgb& pixel) { return 1.0 * pixel[2] / std::max<int>(1, pixel[0]); }

TEST(Panel, ClassesHaveTheirColours) {
  const Display display;
  const Part part = two_classes();
  PanelStyle style;
  style.scale = make_class_scale({&part}, "kind", {"flat", "cylinder"});
  style.flat = true;
  const Picture picture = draw_panel({{&part}, {}, {}}, above(), style, 200, 200);
  EXPECT_LT(blueness(picture.at(130, 120)), 1) << "below the diagonal";
  EXPECT_GT(blueness(picture.at(70, 80)), 1.3) << "above it";
}

TEST(Panel, EdgesOverlaysAndBothSidesOfPaperAreSeen) {
  const Display display;
  const Part part = two_classes();
  Part ball;
  ball.kind = Part::Kind::points;
  ball.points.resize(1, 3);
  ball.points << 0.5, -0.5, 0;
  PanelStyle style;
  style.material = PanelStyle::Material::paper;
  style.flat = true;
  ViewWindow window = above();
  const Picture plain = draw_panel({{&part}, {}, {}}, window, style, 200, 200);
  style.edges = true;
  const Picture with =
      draw_panel({{&part}, {{&ball, {0.8, 0.1, 0.1}}}, {}}, window, style, 200, 200);
  int darkest = 255;
  for (int x = 88; x <= 92; ++x) darkest = std::min<int>(darkest, with.at(x, 110)[1]);
  EXPECT_LT(darkest, plain.at(90, 110)[1] - 10) << "the diagonal";
  EXPECT_EQ(with.at(60, 80), plain.at(60, 80)) << "no edge here";
  EXPECT_GT(with.at(125, 125)[0], 2 * with.at(125, 125)[1]) << "the ball is red";
  window.direction = {0, 0, -1};
  window.right = {-1, 0, 0};
  const Picture back = draw_panel({{&part}, {}, {}}, window, style, 200, 200);
  EXPECT_GT(blueness(back.at(60, 80)), blueness(plain.at(60, 80)) + 0.05) << "the back is cooler";
}

// A square whose array leans the normals at its sides away from each other is shaded as half of a
// cylinder; without the array it has one tone.
TEST(Panel, ASurfaceIsShadedByItsOwnNormals) {
  const Display display;
  Part part = two_classes();
  const auto contrast = [&] {
    const Picture picture = draw_panel({{&part}, {}, {}}, above(), {}, 200, 200);
    return std::abs(picture.at(60, 100)[1] - picture.at(140, 100)[1]);
  };
  EXPECT_LT(contrast(), 3);
  Eigen::MatrixXd normals(4, 3);
  normals << -0.6, 0, 0.8, 0.6, 0, 0.8, 0.6, 0, 0.8, -0.6, 0, 0.8;
  part.arrays.push_back({"normal", "1", NamedArray::On::points, normals});
  EXPECT_GT(contrast(), 12);
}

/// Two squares that meet at `degrees` along the picture's direction `axis_degrees`, the sheet
/// turned by `tilt_degrees` about the picture's horizontal.
Part folded_sheet(double degrees, double axis_degrees, double tilt_degrees) {
  const auto turn = [](double angle, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle * std::numbers::pi / 180, axis).toRotationMatrix();
  };
  Part part;
  part.points.resize(6, 3);
  part.points << -1, -1, 0, -1, 1, 0, 0, -1, 0, 0, 1, 0, 1, -1, 0, 1, 1, 0;
  part.triangles.resize(4, 3);
  part.triangles << 0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5;
  const Eigen::Matrix3d whole =
      turn(tilt_degrees, Eigen::Vector3d::UnitX()) * turn(axis_degrees, Eigen::Vector3d::UnitZ());
  for (int i = 0; i < 6; ++i) {
    const double side = i < 2 ? 0.5 : i < 4 ? 0.0 : -0.5;
    const Eigen::Matrix3d own = turn(side * degrees, Eigen::Vector3d::UnitY());
    part.points.row(i) = (whole * own * part.points.row(i).transpose()).transpose();
  }
  return part;
}

/// The largest difference of a channel between two pixels.
int contrast(const Rgb& a, const Rgb& b) {
  int largest = 0;
  for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(a[c] - b[c]));
  return largest;
}

/// Tones between the two sides of folds of ten degrees: about axes all round, on sheets that face
/// the eye and that are turned away from it, in ascending order. Six folds; with GEOPRIOR_LONG, 18.
std::vector<int> fold_contrasts(const PanelStyle& style) {
  const double tilt_step = test::at_length() ? 40 : 80, axis_step = test::at_length() ? 30 : 60;
  std::vector<int> contrasts;
  for (double tilt = -40; tilt <= 40; tilt += tilt_step) {
    for (double axis = 0; axis < 180; axis += axis_step) {
      const Part sheet = folded_sheet(10, axis, tilt);
      constexpr int kHalf = 100;  // the picture's side is 4 m: so many pixels are 2 m
      const Picture picture = draw_panel({{&sheet}, {}, {}}, above(), style, 2 * kHalf, 2 * kHalf);
      const auto at = [&](double x) {  // half a metre to the side of the fold, in pixels
        const double angle = axis * std::numbers::pi / 180;
        const double height = std::sin(angle) * std::cos(tilt * std::numbers::pi / 180);
        return picture.at(kHalf + static_cast<int>(kHalf / 2 * x * std::cos(angle)),
                          kHalf - static_cast<int>(kHalf / 2 * x * height));
      };
      contrasts.push_back(contrast(at(-0.5), at(0.5)));
    }
  }
  std::sort(contrasts.begin(), contrasts.end());
  return contrasts;
}

// Two even areas beside each other are told apart from about two of 255 tones on. One light leaves
// a fold about the axis that points at it even; Lambert's law bounds the median by 2/pi times the
// range of tones over the range of angles, about 15.
TEST(LongPanel, PlainPaperShowsAFoldOfTenDegrees) {
  const Display display;
  PanelStyle style;
  style.material = PanelStyle::Material::paper;
  style.flat = true;
  const std::vector<int> usual = fold_contrasts(style);
  style.raking = true;
  const std::vector<int> raking = fold_contrasts(style);
  const std::size_t half = raking.size() / 2;
  EXPECT_GE(raking.front(), 2) << "every fold is seen";
  if (test::at_length()) {  // few of 18 point at the light
    EXPECT_GE(raking[raking.size() / 6], 4);
  }
  EXPECT_GE(raking[half], 10);
  EXPECT_GT(raking[half], usual[half]) << "better than under the light of coloured panels";
}

TEST(Panel, AnObstacleIsTranslucentAndMayReachOutOfTheWindow) {
  const Display display;
  const Part part = two_classes();
  const Part obstacle = make_box({-50, -50, -50}, {50, 50, 50});
  PanelStyle style;
  style.scale = make_class_scale({&part}, "kind", {"flat", "cylinder"});
  const Picture picture = draw_panel({{&part}, {}, {&obstacle}}, above(), style, 200, 200);
  EXPECT_LT(picture.at(3, 3)[0], 245) << "the obstacle";
  EXPECT_GT(blueness(picture.at(70, 80)), blueness(picture.at(130, 120)) + 0.1)
      << "the sheet shows through";
}

}  // namespace
}  // namespace geoprior
