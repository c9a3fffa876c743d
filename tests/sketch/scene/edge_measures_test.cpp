// What the runner measures of drawn edges and of textures, on frames whose values are known.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/angles.h"
#include "experiments/sketch/layer_measures.h"
#include "experiments/sketch/texture_measures.h"

namespace geoprior::sketch {
namespace {

/// Half a circle about the z axis; seen along z it is one too.
std::vector<Eigen::Vector3d> half_circle(double radius, double z) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= 90; ++i) {
    const double s = 2 * kDegree * i;
    points.emplace_back(radius * std::cos(s), radius * std::sin(s), z);
  }
  return points;
}

/// Two drawn edges of radius 2 and 3, and a layer with rims of other radii.
class DrawnEdges : public ::testing::Test {
 protected:
  DrawnEdges() {
    scene.truth.emplace();
    View view{ViewKind::photo, {}};
    for (const double radius : {2.0, 3.0}) {
      Stroke arc;
      arc.id = "arc";
      arc.kind = StrokeKind::arc;
      for (const Eigen::Vector3d& p : half_circle(radius, 0)) arc.points.emplace_back(p.head<2>());
      view.strokes.push_back(arc);
      scene.truth->truth.push_back(half_circle(radius, 0.03));
    }
    scene.input.drawing = {"drawing", {view}};
    frame.parts["strokes"].kind = Part::Kind::lines;
  }

  void set_rims(double front, double rear) {
    Part& rims = frame.parts["rims"];
    rims.kind = Part::Kind::lines;
    rims.points.resize(182, 3);
    rims.lines = {{}, {}};
    int row = 0;
    for (const double radius : {front, rear}) {
      for (const Eigen::Vector3d& p : half_circle(radius, 0)) {
        rims.lines[radius == front ? 0 : 1].push_back(row);
        rims.points.row(row++) = p.transpose();
      }
    }
  }

  SketchScene scene;
  Frame frame;
};

// The front rim is 0.1 within an edge of radius 2: 5 %; the rear rim 0.06 outside one of radius 3.
TEST_F(DrawnEdges, AreMeasuredOverTheirRadii) {
  set_rims(1.9, 3.06);
  EXPECT_NEAR(edge_measures(scene, frame).drawn.value(), 0.05, 1e-4);
  EXPECT_NEAR(edge_measures(scene, frame).known.value(), std::hypot(0.1, 0.03) / 2, 1e-4);
  set_rims(2, 3.06);
  EXPECT_NEAR(edge_measures(scene, frame).drawn.value(), 0.02, 1e-4);
}

TEST_F(DrawnEdges, AreNotMeasuredWithoutRims) { EXPECT_FALSE(edge_measures(scene, frame).drawn); }

// One of four texels is the background's green, one is near to it, two are red.
TEST(BackgroundTexels, AreCountedByTheHueOfTheKnownColour) {
  SketchScene scene;
  Frame frame;
  Part& texels = frame.parts["texels"];
  texels.kind = Part::Kind::points;
  texels.points = Eigen::MatrixX3d::Zero(4, 3);
  NamedArray colour{"colour", "1", NamedArray::On::points, Eigen::MatrixXd(4, 3)};
  colour.values << 40, 160, 90, 60, 150, 90, 200, 60, 50, 200, 60, 50;
  texels.arrays.push_back(colour);
  EXPECT_FALSE(background_texels(scene, frame)) << "not known";
  scene.background = "#28a05a";
  EXPECT_EQ(background_texels(scene, frame).value(), 0.5);
  EXPECT_EQ(key_excess({50, 160, 90}, {40, 160, 90}), 70);
  EXPECT_LT(key_excess({200, 60, 50}, {40, 160, 90}), 0);
}

}  // namespace
}  // namespace geoprior::sketch
