#include "baselines/embryo/keyframes/primitive_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/geometry/subdivision.h"
#include "models/embryo/shape/curve.h"

namespace geoprior::embryo {
namespace {

TriMesh unit_sphere(int triangles) {
  TriMesh mesh;
  mesh.V.resize(6, 3);
  mesh.V << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  mesh.F.resize(8, 3);
  mesh.F << 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5;
  while (mesh.triangle_count() < triangles) {
    const Subdivision step = loop_subdivision(mesh.F, mesh.vertex_count());
    mesh.V = (step.stencil * mesh.V).rowwise().normalized();
    mesh.F = step.F;
  }
  return mesh;
}

TriMesh ovoid_mesh(const Shape& shape, int triangles) {
  TriMesh mesh = unit_sphere(triangles);
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    Eigen::Vector3d local = mesh.V.row(v).transpose().cwiseProduct(shape.radii);
    local.head<2>() *= 1 + shape.egg * mesh.V(v, 2);
    mesh.V.row(v) = (shape.center + shape.axes * local).transpose();
  }
  return mesh;
}

/// A circle of a tube.
struct Ring {
  Eigen::Vector3d center;
  Eigen::Vector3d tangent;
  double radius = 0;
};

/// A direction across a tangent: of the axes the one that is least along it.
Eigen::Vector3d across(const Eigen::Vector3d& tangent) {
  Eigen::Index least = 0;
  tangent.cwiseAbs().minCoeff(&least);
  return tangent.cross(Eigen::Vector3d::Unit(least)).normalized();
}

/// Rings from the first pole to the last; both are points.
TriMesh swept(const std::vector<Ring>& rings, int segments) {
  const int n = static_cast<int>(rings.size());
  TriMesh mesh;
  mesh.V.resize(n * segments + 2, 3);
  mesh.F.resize(2 * n * segments, 3);
  Eigen::Vector3d normal = across(rings[0].tangent);
  for (int i = 0; i < n; ++i) {
    const Ring& ring = rings[i];
    normal = (normal - ring.tangent.dot(normal) * ring.tangent).normalized();
    const Eigen::Vector3d other = ring.tangent.cross(normal);
    for (int k = 0; k < segments; ++k) {
      const double angle = 2 * std::numbers::pi * k / segments;
      mesh.V.row(i * segments + k) =
          (ring.center + ring.radius * (std::cos(angle) * normal + std::sin(angle) * other))
              .transpose();
    }
  }
  Eigen::Index t = 0;
  for (int i = 0; i + 1 < n; ++i) {
    for (int k = 0; k < segments; ++k) {
      const int a = i * segments + k, b = i * segments + (k + 1) % segments;
      mesh.F.row(t++) << a, b, b + segments;
      mesh.F.row(t++) << a, b + segments, a + segments;
    }
  }
  const int first = n * segments, last = first + 1;
  for (int k = 0; k < segments; ++k) {
    mesh.F.row(t++) << first, (k + 1) % segments, k;
    mesh.F.row(t++) << last, (n - 1) * segments + k, (n - 1) * segments + (k + 1) % segments;
  }
  return mesh;
}

/// A tube about points with their tangents and radii, with half spheres at both ends.
TriMesh tube(const std::vector<Ring>& line, int triangles) {
  constexpr int kSegments = 24, kCap = 6;
  const int n = static_cast<int>(line.size());
  std::vector<Ring> rings;
  const auto cap = [&](const Ring& end, double side, int k) {
    const double angle = 0.5 * std::numbers::pi * k / kCap;
    rings.push_back({end.center + side * end.radius * std::cos(angle) * end.tangent, end.tangent,
                     end.radius * std::sin(angle)});
  };
  for (int k = 1; k < kCap; ++k) cap(line.front(), -1, k);
  const int along = std::max(n, triangles / (2 * kSegments) - 2 * kCap + 3);
  for (int i = 0; i < along; ++i) {
    const double at = double(i) * (n - 1) / (along - 1);
    const int j = std::min(static_cast<int>(at), n - 2);
    const double u = at - j;
    rings.push_back({(1 - u) * line[j].center + u * line[j + 1].center,
                     ((1 - u) * line[j].tangent + u * line[j + 1].tangent).normalized(),
                     (1 - u) * line[j].radius + u * line[j + 1].radius});
  }
  for (int k = kCap - 1; k > 0; --k) cap(line.back(), 1, k);
  TriMesh mesh = swept(rings, kSegments);
  mesh.V.row(mesh.V.rows() - 2) =
      (line.front().center - line.front().radius * line.front().tangent).transpose();
  mesh.V.row(mesh.V.rows() - 1) =
      (line.back().center + line.back().radius * line.back().tangent).transpose();
  return mesh;
}

TriMesh cylinder_mesh(const Shape& shape, int triangles) {
  const double radius = std::min(shape.radii.x(), shape.radii.z());
  const Eigen::Vector3d axis = shape.axes.col(2), half = (shape.radii.z() - radius) * axis;
  return tube({{shape.center - half, axis, radius}, {shape.center + half, axis, radius}},
              triangles);
}

TriMesh duct_mesh(const Shape& shape, int triangles) {
  constexpr int kSamples = 40;
  const Curve curve(shape.points);
  std::vector<Ring> line;
  for (int i = 0; i <= kSamples; ++i) {
    const double s = double(i) / kSamples;
    line.push_back({curve.at_fraction(s), Eigen::Vector3d::UnitZ(),
                    shape.radius + s * (shape.end_radius - shape.radius)});
  }
  for (int i = 0; i <= kSamples; ++i) {
    const Eigen::Vector3d chord =
        line[std::min(i + 1, kSamples)].center - line[std::max(i - 1, 0)].center;
    if (chord.norm() > 0) line[i].tangent = chord.normalized();
  }
  return tube(line, triangles);
}

}  // namespace

TriMesh primitive_mesh(const Shape& shape, int triangles) {
  switch (shape.primitive) {
    case Primitive::ovoid:
      return ovoid_mesh(shape, triangles);
    case Primitive::cylinder:
      return cylinder_mesh(shape, triangles);
    case Primitive::duct:
      return duct_mesh(shape, triangles);
    default:
      return {};
  }
}

TriMesh half_mesh(const Half& half, int triangles) {
  TriMesh mesh = primitive_mesh(half.shape, triangles);
  const Eigen::Vector3d outward = half.sign * half.cut.normal;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    const double beyond =
        half.cut.thickness / 2 - outward.dot(mesh.V.row(v).transpose() - half.cut.point);
    if (beyond > 0) mesh.V.row(v) += beyond * outward.transpose();
  }
  return mesh;
}

}  // namespace geoprior::embryo
