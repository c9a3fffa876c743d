#include "solvers/sketch/surface/refine_depth.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "experiments/sketch/truth/known_view.h"
#include "metrics/shape/depth_error.h"
#include "solvers/sketch/one_view.h"

namespace geoprior::sketch {
namespace {

/// RMS of depth over the height, without its mean.
double depth_share(const SyntheticView& drawing, const OneViewResult& result) {
  std::vector<Eigen::Vector3d> found, real;
  for (const SketchCurve& curve : result.net.curves) {
    const std::vector<Eigen::Vector3d>& truth = drawing.truth[curve.stroke];
    for (int i = 0; i < curve.size(); ++i) {
      const double at = curve.drawn_at[static_cast<std::size_t>(i)];
      const auto low = static_cast<std::size_t>(at);
      const double t = at - std::floor(at);
      found.push_back(result.depth.nodes.row(curve.nodes[i]).transpose());
      real.push_back((1 - t) * truth[low % truth.size()] + t * truth[(low + 1) % truth.size()]);
    }
  }
  Eigen::MatrixX3d points(found.size(), 3), places(points);
  for (std::size_t k = 0; k < found.size(); ++k) {
    points.row(k) = found[k].transpose();
    places.row(k) = real[k].transpose();
  }
  return geoprior::depth_error(points, places, Eigen::Vector3d::UnitZ(), drawing.height).share;
}

/// The linear system alone, of the points as they are drawn.
OneViewOptions linear_options() {
  OneViewOptions options;
  options.refine.reset();
  options.fair = false;
  options.depth.copied_planes = 0;
  options.curves.snap = 0.008;
  options.pair_tolerance = 0.3;
  return options;
}

OneViewOptions refined_options() {
  OneViewOptions options = linear_options();
  options.refine = RefineOptions{};
  return options;
}

SyntheticView known_drawing_of(KnownShape shape, double noise, std::uint64_t seed) {
  SyntheticView drawing = known_view(known_object(shape));
  if (noise > 0) add_drawing_noise(drawing.view, noise * drawing.height, seed);
  return drawing;
}

void stretch_first_vector(View& view, double factor) {
  for (Stroke& stroke : view.strokes) {
    if (stroke.name == "sym-a")
      stroke.points[1] = stroke.points[0] + factor * (stroke.points[1] - stroke.points[0]);
  }
}

// By drawn pairs alone it is wrong by 12, 18 and 29 %.
TEST(KnownDepth, IsRightForBagTentAndHelmet) {
  for (const auto& [shape, bound] : {std::pair{KnownShape::bag, 0.001},
                                     {KnownShape::tent, 0.001},
                                     {KnownShape::helmet, 0.005}}) {
    const SyntheticView drawing = known_drawing_of(shape, 0, 1);
    EXPECT_LT(depth_share(drawing, reconstruct_one_view(drawing.view, linear_options())), bound);
    OneViewOptions alone = linear_options();
    alone.depth.developability = alone.depth.dense = alone.depth.copied_planes = 0;
    EXPECT_GT(depth_share(drawing, reconstruct_one_view(drawing.view, alone)), 0.1);
  }
}

// The symmetry of whole borders leaves it a fifth to mend.
TEST(RefineDepth, IsNoWorseOnNoisyDrawings) {
  for (const KnownShape shape : {KnownShape::bag, KnownShape::tent, KnownShape::helmet}) {
    double linear = 0, refined = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const SyntheticView drawing = known_drawing_of(shape, 0.003, seed);
      linear += depth_share(drawing, reconstruct_one_view(drawing.view, linear_options()));
      refined += depth_share(drawing, reconstruct_one_view(drawing.view, refined_options()));
    }
    EXPECT_LT(refined, linear);
  }
}

// The drawn ratio of lengths is wrong by 1.3. Direction of pairs and right angle tell the plane.
TEST(RefineDepth, FindsTheRatioOfThePlaneVectors) {
  SyntheticView drawing = known_drawing_of(KnownShape::bag, 0, 1);
  stretch_first_vector(drawing.view, 1.3);
  EXPECT_GT(depth_share(drawing, reconstruct_one_view(drawing.view, linear_options())), 0.05);
  const OneViewResult result = reconstruct_one_view(drawing.view, refined_options());
  EXPECT_LT(depth_share(drawing, result), 0.003);
  ASSERT_TRUE(result.refined);
  EXPECT_NEAR(result.refined->vector_ratio, 1.3, 0.01);
  EXPECT_LT((result.planes.chosen.normal - drawing.mirror_normal).norm(), 0.005);
}

// Held to the wrong ratio it stays near the drawn plane.
TEST(RefineDepth, KeepsARatioThatIsGivenWeight) {
  SyntheticView drawing = known_drawing_of(KnownShape::bag, 0, 1);
  stretch_first_vector(drawing.view, 1.1);
  OneViewOptions options = refined_options();
  options.refine->vector_ratio = 1e4;
  const OneViewResult result = reconstruct_one_view(drawing.view, options);
  EXPECT_NEAR(result.refined->vector_ratio, 1, 0.01);
}

// (x, y) seen at c + (1 + p z / D) ((x, y) - c), with z = 0 at the tail of sym-a and p = 0.1.
// Matches and rulings stay those of an orthographic picture, so that only a part of it is found:
// measured 0.043, and 0.74 % of depth instead of 1.04 %.
TEST(RefineDepth, FindsAPartOfWeakPerspective) {
  SyntheticView drawing = known_drawing_of(KnownShape::bag, 0, 1);
  const OneViewResult exact = reconstruct_one_view(drawing.view, linear_options());
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : exact.net.points) box.extend(p);
  double tail = 0;
  for (std::size_t s = 0; s < drawing.view.strokes.size(); ++s)
    if (drawing.view.strokes[s].name == "sym-a") tail = drawing.truth[s].front().z();
  for (std::size_t s = 0; s < drawing.view.strokes.size(); ++s) {
    Stroke& stroke = drawing.view.strokes[s];
    if (stroke.kind == StrokeKind::plane_vector) continue;
    for (std::size_t k = 0; k < stroke.points.size(); ++k) {
      const double scale = 1 + 0.1 * (drawing.truth[s][k].z() - tail) / exact.net.diagonal;
      stroke.points[k] = box.center() + scale * (stroke.points[k] - box.center());
    }
  }
  OneViewOptions options = refined_options();
  const double orthographic = depth_share(drawing, reconstruct_one_view(drawing.view, options));
  options.refine->perspective = true;
  const OneViewResult result = reconstruct_one_view(drawing.view, options);
  EXPECT_GT(result.refined->perspective, 0.03);
  EXPECT_LT(result.refined->perspective, 0.1);
  EXPECT_LT(depth_share(drawing, result), 0.8 * orthographic);
}

TEST(RefineDepth, LowersItsCostAndRepeatsItselfBitForBit) {
  const SyntheticView drawing = known_drawing_of(KnownShape::tent, 0.003, 4);
  const OneViewResult one = reconstruct_one_view(drawing.view, refined_options());
  const OneViewResult other = reconstruct_one_view(drawing.view, refined_options());
  EXPECT_LT(one.refined->cost_after, 0.9 * one.refined->cost_before);
  EXPECT_EQ(one.depth.nodes, other.depth.nodes);
}

// Exact drawings of three views: the plane is that of the object, whatever the vectors' lengths.
TEST(PlaneFromPairs, IsExactForVectorsOfAnyLength) {
  for (const KnownShape shape : {KnownShape::bag, KnownShape::tent, KnownShape::helmet}) {
    SyntheticView drawing = known_drawing_of(shape, 0, 1);
    stretch_first_vector(drawing.view, 1.2);
    const MirrorPlane drawn = drawn_mirror_planes(drawing.view).chosen;
    EXPECT_GT((drawn.normal - drawing.mirror_normal).norm(), 0.02);
    const MirrorPlane found = plane_from_pairs(drawing.view, drawn);
    EXPECT_LT((found.normal - drawing.mirror_normal).norm(), 1e-9);
  }
}

// Without a pair that has a length nothing is known beside what is drawn.
TEST(PlaneFromPairs, FallsBackToTheDrawnPlane) {
  SyntheticView drawing = known_drawing_of(KnownShape::bag, 0, 1);
  std::erase_if(drawing.view.strokes,
                [](const Stroke& s) { return s.kind == StrokeKind::symmetric_pair; });
  const MirrorPlane drawn = drawn_mirror_planes(drawing.view).chosen;
  EXPECT_EQ(plane_from_pairs(drawing.view, drawn).normal, drawn.normal);
}

}  // namespace
}  // namespace geoprior::sketch
