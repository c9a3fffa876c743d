#include "models/embryo/shape/shape.h"

#include <algorithm>

#include "models/embryo/shape/curve.h"

namespace geoprior::embryo {

bool is_solid(Primitive primitive) {
  return primitive == Primitive::ovoid || primitive == Primitive::cylinder ||
         primitive == Primitive::duct;
}

double smallest_radius(const Shape& shape) {
  switch (shape.primitive) {
    case Primitive::ovoid:
      return shape.radii.minCoeff();
    case Primitive::cylinder:
      return shape.radii.x();
    case Primitive::duct:
      return std::min(shape.radius, shape.end_radius);
    default:
      return 0;
  }
}

Eigen::Vector3d anchor_point(const Shape& shape, const Eigen::Vector3d& uvw) {
  if (shape.primitive == Primitive::duct) return Curve(shape.points).at_fraction(uvw.z());
  Eigen::Vector3d local = uvw.cwiseProduct(shape.radii);
  if (shape.primitive == Primitive::ovoid) local.head<2>() *= 1 + shape.egg * uvw.z();
  return shape.center + shape.axes * local;
}

}  // namespace geoprior::embryo
