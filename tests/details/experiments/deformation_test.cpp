// Deformations over time, against what each does to a shape in closed form.
#include "experiments/details/scene/deformation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/details/scene/handle_drag.h"
#include "experiments/details/scene/surfaces.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::details {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

/// An operation that goes from nothing at 0 s to `value` at 1 s.
DeformationOptions operation(DeformationKind kind, double value) {
  DeformationOptions options;
  options.kind = kind;
  const bool angle = kind == DeformationKind::twist || kind == DeformationKind::bend;
  options.keys = {{0, angle ? 0.0 : 1.0}, {1, value}};
  return options;
}

/// The surface after the operations, at time `t`.
TriMesh deformed(const TriMesh& rest, const std::vector<DeformationOptions>& operations,
                 double t = 1) {
  const auto base = std::make_shared<StoredMotion>(std::vector{rest.V}, std::vector{0.0});
  const ScriptedMotion motion(rest, base, operations, {0, 0.25, 0.5, 1});
  EXPECT_EQ(motion.positions(0), rest.V);
  const int frame = t == 1 ? 3 : t == 0.5 ? 2 : 1;
  EXPECT_EQ(motion.parameter(frame), t);
  return {motion.positions(frame), rest.F};
}

double area_of(const TriMesh& mesh) { return triangle_areas(mesh.V, mesh.F).sum(); }

TEST(DetailDeformation, StretchMultipliesTheLengthAndCrossKeepsTheArea) {
  const TriMesh plane = plane_surface(1, 1, 0.1);
  DeformationOptions stretch = operation(DeformationKind::stretch, 2);
  EXPECT_NEAR(area_of(deformed(plane, {stretch})), 2, 1e-12);
  EXPECT_NEAR(area_of(deformed(plane, {stretch}, 0.25)), 1.25, 1e-12);
  stretch.cross = 1;
  EXPECT_NEAR(area_of(deformed(plane, {stretch})), 1, 1e-12);
  EXPECT_NEAR(deformed(plane, {stretch}).V.col(0).maxCoeff(), 1, 1e-12);
}

TEST(DetailDeformation, AVolumeStaysWithCrossOneHalf) {
  const TriMesh sphere = sphere_surface(0.5, 0.1);
  DeformationOptions stretch = operation(DeformationKind::stretch, 2);
  stretch.cross = 0.5;
  const TriMesh now = deformed(sphere, {stretch});
  EXPECT_NEAR(signed_volume(now.V, now.F), signed_volume(sphere.V, sphere.F), 1e-12);
}

// From -0.2 to 0.3 becomes twice as long: what is below stays, what is above moves by 0.5.
TEST(DetailDeformation, APartIsStretchedAndTheRestMovesAlong) {
  const TriMesh plane = plane_surface(2, 1, 0.05);
  DeformationOptions stretch = operation(DeformationKind::stretch, 2);
  stretch.from = -0.2;
  stretch.to = 0.3;
  const TriMesh now = deformed(plane, {stretch});
  double before = -2;
  for (Eigen::Index v = 0; v <= 40; ++v) {
    const double x = plane.V(v, 0), moved = now.V(v, 0);
    if (x <= -0.2) {
      EXPECT_NEAR(moved, x, 1e-12);
    }
    if (x >= 0.3) {
      EXPECT_NEAR(moved, x + 0.5, 1e-12);
    }
    EXPECT_GT(moved, before);
    before = moved;
  }
}

TEST(DetailDeformation, InflationReachesItsArea) {
  const TriMesh blob = blob_surface(0.5, 0.2, 0.1);
  const TriMesh more = deformed(blob, {operation(DeformationKind::inflate, 2)});
  EXPECT_NEAR(area_of(more) / area_of(blob), 2, 1e-9);
  const TriMesh less = deformed(blob, {operation(DeformationKind::inflate, 0.7)});
  EXPECT_NEAR(area_of(less) / area_of(blob), 0.7, 1e-9);
  EXPECT_THAT(test::error_of([] {
                deformed(plane_surface(1, 1, 0.2), {operation(DeformationKind::inflate, 2)});
              }),
              HasSubstr("scene.motion.deform.0, frame 3: does not reach an area of 2"));
}

TEST(DetailDeformation, ScaleAndSqueezeMultiplyDistances) {
  const TriMesh tube = capsule_surface(0.2, 1, 0.05);
  const TriMesh scaled = deformed(tube, {operation(DeformationKind::scale, 3)});
  EXPECT_TRUE(scaled.V.isApprox(3 * tube.V, 1e-14));
  DeformationOptions squeeze = operation(DeformationKind::squeeze, 0.5);
  squeeze.from = -0.3;
  squeeze.to = 0.3;
  const TriMesh waist = deformed(tube, {squeeze});
  for (Eigen::Index v = 0; v < tube.V.rows(); ++v) {
    const double before = tube.V.row(v).tail<2>().norm(), now = waist.V.row(v).tail<2>().norm();
    EXPECT_EQ(waist.V(v, 0), tube.V(v, 0));
    if (std::abs(tube.V(v, 0)) < 1e-12) {
      EXPECT_NEAR(now, before / 2, 1e-12);
    }
    if (std::abs(tube.V(v, 0)) >= 0.3) {
      EXPECT_NEAR(now, before, 1e-12);
    }
  }
}

TEST(DetailDeformation, TwistTurnsByItsAngle) {
  const TriMesh plane = plane_surface(1, 0.2, 0.05);
  const TriMesh now = deformed(plane, {operation(DeformationKind::twist, 90)});
  for (Eigen::Index v = 0; v < plane.V.rows(); ++v) {
    const double angle = pi / 2 * (plane.V(v, 0) + 0.5), y = plane.V(v, 1);
    const Eigen::RowVector3d expected(plane.V(v, 0), y * std::cos(angle), y * std::sin(angle));
    EXPECT_LT((now.V.row(v) - expected).norm(), 1e-12);
  }
}

// The axis of 1 m becomes half a circle: radius 1 / pi, its length stays.
TEST(DetailDeformation, BendMakesAnArcOfTheSameLength) {
  const TriMesh plane = plane_surface(1, 0.2, 0.05);
  const TriMesh now = deformed(plane, {operation(DeformationKind::bend, 180)});
  const Eigen::RowVector3d middle(-0.5, 0, 1 / pi);
  for (Eigen::Index v = 0; v < plane.V.rows(); ++v) {
    Eigen::RowVector3d arm = now.V.row(v) - middle;
    EXPECT_EQ(now.V(v, 1), plane.V(v, 1));
    arm.y() = 0;
    EXPECT_NEAR(arm.norm(), 1 / pi, 1e-12);
    const double angle = pi * (plane.V(v, 0) + 0.5);
    EXPECT_NEAR(arm.x(), std::sin(angle) / pi, 1e-12);
  }
}

TEST(DetailDeformation, NothingMovesBeyondTheFalloff) {
  const TriMesh plane = plane_surface(2, 2, 0.1);
  DeformationOptions scale = operation(DeformationKind::scale, 1.3);
  scale.radius = 0.5;
  const TriMesh now = deformed(plane, {scale});
  for (Eigen::Index v = 0; v < plane.V.rows(); ++v) {
    const double d = plane.V.row(v).norm();
    const double share = d < 0.5 ? std::pow(1 - d * d / 0.25, 2) : 0;
    EXPECT_LT((now.V.row(v) - (1 + 0.3 * share) * plane.V.row(v)).norm(), 1e-12);
  }
}

TEST(DetailDeformation, OperationsFollowEachOther) {
  const TriMesh plane = plane_surface(1, 1, 0.1);
  DeformationOptions across = operation(DeformationKind::stretch, 3);
  across.axis = {0, 2, 0};
  const TriMesh now = deformed(plane, {operation(DeformationKind::stretch, 2), across});
  EXPECT_NEAR(area_of(now), 6, 1e-12);
}

TEST(DetailDeformation, AmountsAreLinearBetweenKeysAndConstantBeyond) {
  const std::vector<AmountKey> keys{{1, 2}, {3, 6}, {4, 1}};
  EXPECT_EQ(amount_at(keys, 0), 2);
  EXPECT_EQ(amount_at(keys, 2), 4);
  EXPECT_EQ(amount_at(keys, 3.5), 3.5);
  EXPECT_EQ(amount_at(keys, 9), 1);
}

TEST(DetailDeformation, MistakesAreNamed) {
  const auto message = [](const DeformationOptions& o) {
    return test::error_of([&] { deformed(plane_surface(1, 1, 0.5), {o}); });
  };
  DeformationOptions o;
  EXPECT_THAT(message(o), HasSubstr("scene.motion.deform.0.keys: has no keys"));
  o.keys = {{0, 1}, {0, 2}};
  EXPECT_THAT(message(o), HasSubstr("keys.1.t: is not after the key before"));
  o.keys = {{0, 0}};
  EXPECT_THAT(message(o), HasSubstr("keys.0.value: is no factor"));
  o.keys = {{0, 1}};
  o.axis = {0, 0, 0};
  EXPECT_THAT(message(o), HasSubstr("axis: has no direction"));
  o.axis = {1, 0, 0};
  o.from = 0.2;
  o.to = 0.1;
  EXPECT_THAT(message(o), HasSubstr("from: is not below `to`"));
  o = operation(DeformationKind::bend, 10);
  o.side = {2, 0, 0};
  EXPECT_THAT(message(o), HasSubstr("side: runs along the axis"));
}

HandleBallOptions ball(double x, double radius) {
  HandleBallOptions handle;
  handle.centre = {x, 0, 0};
  handle.radius = radius;
  return handle;
}

TEST(HandleDrag, HandlesThatMoveAlikeMoveTheWholeRigidly) {
  const TriMesh tube = capsule_surface(0.2, 1, 0.08);
  HandleDragOptions drag;
  drag.handles = {ball(-0.6, 0.2), ball(0.6, 0.2)};
  for (HandleBallOptions& handle : drag.handles)
    handle.keys = {{0, {0, 0, 0}, {0, 0, 0}}, {1, {0.3, -0.2, 0.1}, {0, 0, 0}}};
  const auto motion = drag_handles(tube, drag, {0, 0.5, 1});
  EXPECT_EQ(motion->positions(0), tube.V);
  const Eigen::RowVector3d shift(0.3, -0.2, 0.1);
  EXPECT_LT((motion->positions(2) - (tube.V.rowwise() + shift)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(HandleDrag, HandlesGoWhereTheyAreTold) {
  const TriMesh tube = capsule_surface(0.2, 1, 0.08);
  HandleDragOptions drag;
  drag.handles = {ball(-0.6, 0.25), ball(0.6, 0.25)};
  drag.handles[1].keys = {{0, {0, 0, 0}, {0, 0, 0}}, {1, {0, 0, 0.3}, {0, -60, 0}}};
  const auto first = drag_handles(tube, drag, {0, 0.5, 1});
  const auto again = drag_handles(tube, drag, {0, 0.5, 1});
  EXPECT_EQ(first->positions(2), again->positions(2));
  const Eigen::Matrix3d turn = to_rotation({0, -60, 0}).toRotationMatrix();
  const Eigen::Vector3d centre(0.6, 0, 0), shift(0, 0, 0.3);
  int held = 0, free = 0;
  for (Eigen::Index v = 0; v < tube.V.rows(); ++v) {
    const Eigen::Vector3d x = tube.V.row(v), now = first->positions(2).row(v);
    if ((x - centre).norm() <= 0.25) {
      EXPECT_LT((now - (centre + turn * (x - centre) + shift)).norm(), 1e-12);
      ++held;
    } else if ((x + centre).norm() <= 0.25) {
      EXPECT_LT((now - x).norm(), 1e-12);
    } else {
      ++free;
    }
  }
  EXPECT_GT(held, 10);
  EXPECT_GT(free, 10);
}

TEST(HandleDrag, MistakesAreNamed) {
  const TriMesh tube = capsule_surface(0.2, 1, 0.1);
  const auto message = [&](const HandleDragOptions& drag) {
    return test::error_of([&] { drag_handles(tube, drag, {0, 1}); });
  };
  HandleDragOptions drag;
  EXPECT_THAT(message(drag), HasSubstr("scene.motion.drag: has no handles"));
  drag.handles = {ball(5, 0.1)};
  EXPECT_THAT(message(drag), HasSubstr("scene.motion.drag.handles.0: holds no vertex"));
  drag.handles = {ball(0.6, 0.3), ball(0.7, 0.3)};
  EXPECT_THAT(message(drag), HasSubstr("as well as handle 0"));
  drag.handles = {ball(0, 5)};
  EXPECT_THAT(message(drag), HasSubstr("hold every vertex"));
  drag.handles = {ball(0.6, 0.3)};
  drag.handles[0].keys = {{0, {1, 0, 0}, {0, 0, 0}}, {1, {0, 0, 0}, {0, 0, 0}}};
  EXPECT_THAT(message(drag), HasSubstr("handles.0.keys: is not at rest in the first frame"));
}

}  // namespace
}  // namespace geoprior::details
