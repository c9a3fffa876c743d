// Measures of frames in which there is nothing to measure: absent, and no error.

#include <gtest/gtest.h>

#include <string>

#include "experiments/sketch/garment_measures.h"
#include "experiments/sketch/scene/scene.h"

namespace geoprior::sketch {
namespace {

NamedArray of_cells(const std::string& name, const Eigen::MatrixXd& values) {
  return {name, "1", NamedArray::On::cells, values};
}

/// A border that is drawn in the side view of a triangle.
class DrawnBorder : public ::testing::Test {
 protected:
  DrawnBorder() {
    Stroke border;
    border.kind = StrokeKind::border;
    border.points = {{0, 0}, {0, 1}};
    scene.aligned = {"drawing", {View{ViewKind::side, {border}}}};
    Part& surface = frame.parts["surface"];
    surface.points = Eigen::Matrix3d::Identity();
    surface.triangles = Eigen::RowVector3i(0, 1, 2);
    Part& strokes = frame.parts["strokes"];
    strokes.kind = Part::Kind::lines;
    strokes.points = surface.points;
    strokes.lines = {{0, 1}};
    const auto number = [](int x) { return Eigen::MatrixXd::Constant(1, 1, x); };
    strokes.arrays = {of_cells("kind", number(static_cast<int>(StrokeKind::border))),
                      of_cells("view", number(static_cast<int>(ViewKind::side))),
                      of_cells("number", number(0))};
  }
  SketchScene scene;
  Frame frame;
};

TEST_F(DrawnBorder, IsMeasuredOverTheSilhouetteOfItsView) {
  scene.silhouettes.push_back(
      {ViewKind::side, Eigen::Matrix3d::Identity(), {{0, 0}, {3, 0}, {3, 4}}});
  // The vertex (1, 0, 0) is 1 beside the border; the diagonal is 5.
  EXPECT_NEAR(stroke_measures(scene, frame).off_percent.value(), 20, 1e-9);
}

TEST_F(DrawnBorder, OfAViewWithoutASilhouetteIsNotMeasured) {
  EXPECT_FALSE(stroke_measures(scene, frame).off_percent);
  scene.silhouettes.push_back(
      {ViewKind::front, Eigen::Matrix3d::Identity(), {{0, 0}, {1, 0}, {1, 1}}});
  EXPECT_FALSE(stroke_measures(scene, frame).off_percent);
  scene.aligned.views.clear();
  EXPECT_FALSE(stroke_measures(scene, frame).off_percent);
}

TEST_F(DrawnBorder, OnASurfaceWithoutPointsMirrorAndDepthAreAbsent) {
  scene.silhouettes.push_back(
      {ViewKind::side, Eigen::Matrix3d::Identity(), {{0, 0}, {1, 0}, {1, 1}}});
  frame.parts["pattern"] = Part{};
  frame.parts["surface"] = Part{};
  EXPECT_FALSE(mirror_percent(scene, frame));
  EXPECT_FALSE(generator_measures(scene, frame).range);
}

}  // namespace
}  // namespace geoprior::sketch
