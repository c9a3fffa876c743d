#include "solvers/sketch/surface/silhouette_stops.h"

#include <gtest/gtest.h>

#include "models/sketch/drawing/align_views.h"
#include "tests/sketch/surface/drawn_solids.h"

namespace geoprior::sketch {
namespace {

struct StoppedCylinder {
  VisualHull hull = visual_hull(align_views(solids::drawn_cylinder(0.2, 0.3, 180)), {3000});
  SilhouetteStops stops{hull, 0};  // the front: x and y
  Eigen::MatrixX3d X = hull.mesh.V;

  /// The vertex that is nearest to a point.
  [[nodiscard]] int vertex_at(const Eigen::RowVector3d& x) const {
    Eigen::Index v = 0;
    (hull.mesh.V.rowwise() - x).rowwise().squaredNorm().minCoeff(&v);
    return static_cast<int>(v);
  }
  [[nodiscard]] CoordinatePins held() {
    CoordinatePins pins(static_cast<int>(X.rows()));
    stops.hold(X, pins);
    return pins;
  }
};

TEST(SilhouetteStops, LeaveWhatIsInsideAlone) {
  StoppedCylinder of;
  of.X *= 0.99;
  of.X.col(1).array() += 0.001;
  EXPECT_TRUE(of.held().value.isZero());
}

TEST(SilhouetteStops, PutAVertexBackAcrossTheSilhouette) {
  StoppedCylinder of;
  of.X *= 0.99;
  of.X.col(1).array() += 0.001;
  const int v = of.vertex_at({0.07, 0.15, 0.07});
  of.X(v, 0) = 0.12;
  const CoordinatePins pins = of.held();
  EXPECT_TRUE(pins.pinned[0][v]);
  EXPECT_NEAR(pins.value(v, 0), 0.1, 1e-9);
  EXPECT_FALSE(pins.pinned[1][v]) << "free to slide";
  EXPECT_FALSE(pins.pinned[2][v]);
}

TEST(SilhouetteStops, HoldAVertexOfTheSilhouetteAtItsPlace) {
  StoppedCylinder of;
  of.X *= 0.99;
  of.X.col(1).array() += 0.001;
  const int v = of.vertex_at({0.1, 0.15, 0});
  of.X(v, 0) = 0.11;
  EXPECT_NEAR(of.held().value(v, 1), of.hull.mesh.V(v, 1), 1e-12);
  of.X(v, 0) = 0.09;
  const CoordinatePins later = of.held();
  EXPECT_TRUE(later.pinned[0][v]) << "from then on";
  EXPECT_EQ(later.value(v, 0), of.hull.mesh.V(v, 0));
}

}  // namespace
}  // namespace geoprior::sketch
