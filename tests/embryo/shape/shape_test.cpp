#include "models/embryo/shape/shape.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "models/embryo/surface/field.h"

namespace geoprior::embryo {
namespace {

using Eigen::Vector3d;

Shape turned_shape(Primitive primitive, const Vector3d& radii) {
  Shape shape;
  shape.primitive = primitive;
  shape.center = {1, 2, 3};
  shape.axes = Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  shape.radii = radii;
  return shape;
}

TEST(EmbryoShape, AnchorsOfUnitCoordinatesLieOnAnOvoidsSurface) {
  Shape ovoid = turned_shape(Primitive::ovoid, {1, 1.5, 2});
  ovoid.egg = 0.3;
  for (const Vector3d& direction :
       {Vector3d(1, 0, 0), Vector3d(0, 0, -1), Vector3d(1, 2, -2), Vector3d(-1, 1, 3)})
    EXPECT_NEAR(ovoid_field(ovoid, anchor_point(ovoid, direction.normalized())), 0, 1e-14);
}

TEST(EmbryoShape, AnchorsFollowTheFormulaOfTheirPrimitive) {
  const Vector3d at(0.5, -0.25, -1);
  const auto local = [&](const Shape& s) -> Vector3d {
    return s.axes.transpose() * (anchor_point(s, at) - s.center);
  };
  EXPECT_LT((local(turned_shape(Primitive::cylinder, {2, 2, 5})) - Vector3d(1, -0.5, -5)).norm(),
            1e-14);
  EXPECT_LT((local(turned_shape(Primitive::line, {0, 0, 5})) - Vector3d(0, 0, -5)).norm(), 1e-14);
  EXPECT_LT((local(turned_shape(Primitive::plane, {4, 4, 0})) - Vector3d(2, -1, 0)).norm(), 1e-14);
  EXPECT_LT(local(turned_shape(Primitive::point, {0, 0, 0})).norm(), 1e-14);
}

TEST(EmbryoShape, ADuctIsAnchoredByTheFractionOfItsArc) {
  Shape duct;
  duct.primitive = Primitive::duct;
  duct.points = {{0, 0, 0}, {0, 0, 1}, {0, 0, 4}};
  EXPECT_LT((anchor_point(duct, {0, 0, 0.5}) - Vector3d(0, 0, 2)).norm(), 1e-9);
  EXPECT_EQ(anchor_point(duct, {0, 0, 0}), duct.points.front());
}

TEST(EmbryoShape, LandmarksAreNoSolids) {
  for (const Primitive p : {Primitive::point, Primitive::line, Primitive::plane})
    EXPECT_FALSE(is_solid(p));
  for (const Primitive p : {Primitive::ovoid, Primitive::cylinder, Primitive::duct})
    EXPECT_TRUE(is_solid(p));
}

}  // namespace
}  // namespace geoprior::embryo
