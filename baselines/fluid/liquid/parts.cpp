#include "baselines/fluid/liquid/parts.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace geoprior::fluid {
namespace {

TriMesh box_mesh(const LiquidShape& shape) {
  TriMesh mesh;
  mesh.V.resize(8, 3);
  for (int c = 0; c < 8; ++c) {
    const Eigen::Vector3d side(c % 2 * 2 - 1, c / 2 % 2 * 2 - 1, c / 4 * 2 - 1);
    mesh.V.row(c) = shape.centre + side.cwiseProduct(shape.half_size);
  }
  mesh.F.resize(12, 3);
  mesh.F << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6,
      2, 1, 3, 7, 1, 7, 5;
  return mesh;
}

/// Rings of a body of revolution about `axis`, from below upwards, closed by its two end points.
/// @param profile  height along the axis and radius of each ring
TriMesh revolved(const Eigen::Vector3d& centre, const Eigen::Vector3d& axis,
                 const std::vector<Eigen::Vector2d>& profile, double low, double high) {
  constexpr int kAround = 32;
  const Eigen::Vector3d e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
  const int rings = static_cast<int>(profile.size());
  TriMesh mesh;
  mesh.V.resize(rings * kAround + 2, 3);
  mesh.F.resize(2 * kAround * rings, 3);
  for (int r = 0; r < rings; ++r) {
    const Eigen::Vector2d& at = profile[r];
    for (int s = 0; s < kAround; ++s) {
      const double angle = 2 * std::numbers::pi * s / kAround;
      mesh.V.row(r * kAround + s) =
          centre + at.x() * axis + at.y() * (std::cos(angle) * e1 + std::sin(angle) * e2);
    }
  }
  const int bottom = rings * kAround, top = bottom + 1;
  mesh.V.row(bottom) = centre + low * axis;
  mesh.V.row(top) = centre + high * axis;
  int f = 0;
  for (int s = 0; s < kAround; ++s) {
    const int t = (s + 1) % kAround;
    mesh.F.row(f++) << bottom, t, s;
    for (int r = 0; r + 1 < rings; ++r) {
      const int a = r * kAround + s, b = r * kAround + t;
      mesh.F.row(f++) << a, b, b + kAround;
      mesh.F.row(f++) << a, b + kAround, a + kAround;
    }
    mesh.F.row(f++) << top, (rings - 1) * kAround + s, (rings - 1) * kAround + t;
  }
  return mesh;
}

TriMesh sphere_mesh(const LiquidShape& shape) {
  constexpr int kRings = 15;
  std::vector<Eigen::Vector2d> profile;
  for (int r = 1; r <= kRings; ++r) {
    const double angle = std::numbers::pi * r / (kRings + 1);
    profile.emplace_back(-shape.radius * std::cos(angle), shape.radius * std::sin(angle));
  }
  return revolved(shape.centre, Eigen::Vector3d::UnitZ(), profile, -shape.radius, shape.radius);
}

TriMesh cylinder_mesh(const LiquidShape& shape) {
  return revolved(shape.centre, shape.axis,
                  {{-shape.half_length, shape.radius}, {shape.half_length, shape.radius}},
                  -shape.half_length, shape.half_length);
}

/// Where the body stands at t = 0; no triangles for a half space.
TriMesh shape_mesh(const LiquidShape& shape) {
  switch (shape.kind) {
    case LiquidShape::Kind::box:
      return box_mesh(shape);
    case LiquidShape::Kind::sphere:
      return sphere_mesh(shape);
    case LiquidShape::Kind::cylinder:
      return cylinder_mesh(shape);
    case LiquidShape::Kind::mesh:
      return shape.mesh;
    case LiquidShape::Kind::half_space:
      break;
  }
  return {};
}

}  // namespace

Part solids_part(const Tank& tank, std::span<const PlacedSolid> placed) {
  std::vector<TriMesh> meshes;
  Eigen::Index points = 0, triangles = 0;
  for (std::size_t s = 0; s < tank.solids.size(); ++s) {
    TriMesh mesh = shape_mesh(tank.solids[s].shape);
    const Eigen::Isometry3d& placement = placed[s].placement;
    mesh.V =
        (mesh.V * placement.linear().transpose()).rowwise() + placement.translation().transpose();
    points += mesh.V.rows();
    triangles += mesh.F.rows();
    meshes.push_back(std::move(mesh));
  }
  Part part;
  part.points.resize(points, 3);
  part.triangles.resize(triangles, 3);
  Eigen::MatrixXd index(triangles, 1);
  Eigen::Index p = 0, t = 0;
  for (std::size_t s = 0; s < meshes.size(); ++s) {
    const TriMesh& mesh = meshes[s];
    part.points.middleRows(p, mesh.V.rows()) = mesh.V;
    part.triangles.middleRows(t, mesh.F.rows()) = mesh.F.array() + static_cast<int>(p);
    index.middleRows(t, mesh.F.rows()).setConstant(static_cast<double>(s));
    p += mesh.V.rows();
    t += mesh.F.rows();
  }
  part.arrays.push_back({"solid", "1", NamedArray::On::cells, std::move(index)});
  return part;
}

Part particles_part(const Tank& tank, const LiquidParticles& particles) {
  Part part;
  part.kind = Part::Kind::points;
  const Eigen::Index n = particles.size();
  part.points.resize(n, 3);
  Eigen::MatrixXd velocity(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    part.points.row(i) = tank.origin + particles.position[i].cast<double>();
    velocity.row(i) = particles.velocity[i].cast<double>();
  }
  part.arrays.push_back({"velocity", "m/s", NamedArray::On::points, std::move(velocity)});
  return part;
}

}  // namespace geoprior::fluid
