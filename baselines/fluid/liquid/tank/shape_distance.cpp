#include "baselines/fluid/liquid/tank/shape_distance.h"

#include <algorithm>
#include <limits>

#include "baselines/fluid/liquid/tank/shape_distance_mesh.h"
#include "core/error.h"
#include "core/geometry/topology.h"

namespace geoprior::fluid {

struct ShapeDistance::Grid {
  MeshDistance distance;
};

ShapeDistance::ShapeDistance(const LiquidShape& shape, double cell) : shape_(shape) {
  if (!(cell > 0)) throw Error("the cell must be positive", "ShapeDistance");
  if (shape_.kind != LiquidShape::Kind::mesh) {
    shape_.mesh = {};
    return;
  }
  if (shape_.mesh.triangle_count() == 0)
    throw Error("the mesh has no triangles", "ShapeDistance", "a closed mesh");
  require_closed_manifold(shape_.mesh, "ShapeDistance", "shape.mesh");
  grid_ = std::make_unique<Grid>(Grid{mesh_distance(shape_.mesh, cell)});
}

ShapeDistance::~ShapeDistance() = default;
ShapeDistance::ShapeDistance(ShapeDistance&&) noexcept = default;
ShapeDistance& ShapeDistance::operator=(ShapeDistance&&) noexcept = default;

double ShapeDistance::operator()(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d way = x - shape_.centre;
  switch (shape_.kind) {
    case LiquidShape::Kind::box: {
      const Eigen::Vector3d beyond = way.cwiseAbs() - shape_.half_size;
      return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
    }
    case LiquidShape::Kind::sphere:
      return way.norm() - shape_.radius;
    case LiquidShape::Kind::cylinder: {
      const double along = way.dot(shape_.axis);
      const Eigen::Vector2d beyond((way - along * shape_.axis).norm() - shape_.radius,
                                   std::abs(along) - shape_.half_length);
      return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
    }
    case LiquidShape::Kind::half_space:
      return way.dot(shape_.axis);
    case LiquidShape::Kind::mesh:
      return grid_->distance(x);
  }
  return std::numeric_limits<double>::infinity();
}

Eigen::AlignedBox3d ShapeDistance::bounds() const {
  const double infinity = std::numeric_limits<double>::infinity();
  Eigen::Vector3d half = Eigen::Vector3d::Constant(infinity);
  switch (shape_.kind) {
    case LiquidShape::Kind::box:
      half = shape_.half_size;
      break;
    case LiquidShape::Kind::sphere:
      half.setConstant(shape_.radius);
      break;
    case LiquidShape::Kind::cylinder: {
      const Eigen::Array3d a = shape_.axis.array();
      half = shape_.half_length * a.abs() + shape_.radius * (1 - a.square()).max(0.0).sqrt();
      break;
    }
    case LiquidShape::Kind::half_space:
      break;
    case LiquidShape::Kind::mesh: {
      Eigen::AlignedBox3d box;
      box.extend(Eigen::Vector3d(shape_.mesh.V.colwise().minCoeff()));
      box.extend(Eigen::Vector3d(shape_.mesh.V.colwise().maxCoeff()));
      return box;
    }
  }
  return {Eigen::Vector3d(shape_.centre - half), Eigen::Vector3d(shape_.centre + half)};
}

}  // namespace geoprior::fluid
