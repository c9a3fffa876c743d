#include "models/sketch/flatten/flat_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace geoprior::sketch {
namespace {

constexpr double kFlatThinnest = 1e-9;

FlatTriangle lay_triangle_flat(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Eigen::Vector3d& c, double largest_cotangent) {
  const Eigen::Vector3d ab = b - a, bc = c - b, ca = a - c;
  FlatTriangle flat;
  flat.area = ab.cross(bc).norm() / 2;
  flat.angle = {std::atan2(2 * flat.area, -ab.dot(ca)), std::atan2(2 * flat.area, -bc.dot(ab)),
                std::atan2(2 * flat.area, -ca.dot(bc))};
  // Laid along its longest edge, so that a needle keeps its shape to round-off.
  const std::array<double, 3> length{ab.norm(), bc.norm(), ca.norm()};
  const std::size_t k = std::max_element(length.begin(), length.end()) - length.begin();
  if (!(length[k] > 0)) return flat;
  const std::array<Eigen::Vector3d, 3> side{ab, bc, ca};
  const auto along = [&](std::size_t i) { return side[i].dot(side[k]) / length[k]; };
  const double height = 2 * flat.area / length[k];
  flat.edge[k] = length[k];
  flat.edge[(k + 1) % 3] = {along((k + 1) % 3), height};
  flat.edge[(k + 2) % 3] = {along((k + 2) % 3), -height};
  flat.cot = opposite_cotangents(flat.angle, largest_cotangent);
  return flat;
}

double longest_flat_edge(const FlatTriangle& t) {
  return std::max({std::abs(t.edge[0]), std::abs(t.edge[1]), std::abs(t.edge[2])});
}

}  // namespace

std::array<double, 3> opposite_cotangents(const std::array<double, 3>& angle, double largest) {
  const double least = std::atan2(1.0, largest);
  const std::size_t widest = std::max_element(angle.begin(), angle.end()) - angle.begin();
  const auto cot_of = [&](std::size_t k) { return 1 / std::tan(std::max(angle[k], least)); };
  std::array<double, 3> at{};
  const std::size_t i = (widest + 1) % 3, j = (widest + 2) % 3;
  at[i] = cot_of(i);
  at[j] = cot_of(j);
  at[widest] = (1 - at[i] * at[j]) / (at[i] + at[j]);  // -cot(alpha_i + alpha_j)
  return {at[2], at[0], at[1]};
}

std::vector<FlatTriangle> flat_triangles(const TriMesh& mesh, double largest_cotangent) {
  std::vector<FlatTriangle> triangles;
  triangles.reserve(mesh.triangle_count());
  const auto corner = [&](int t, int k) -> Eigen::Vector3d {
    return mesh.V.row(mesh.F(t, k)).transpose();
  };
  for (int t = 0; t < mesh.triangle_count(); ++t)
    triangles.push_back(
        lay_triangle_flat(corner(t, 0), corner(t, 1), corner(t, 2), largest_cotangent));
  return triangles;
}

Eigen::VectorXcd to_complex(const Eigen::MatrixX2d& points) {
  Eigen::VectorXcd z(points.rows());
  z.real() = points.col(0);
  z.imag() = points.col(1);
  return z;
}

Eigen::MatrixX2d to_points(const Eigen::VectorXcd& z) {
  Eigen::MatrixX2d points(z.size(), 2);
  points.col(0) = z.real();
  points.col(1) = z.imag();
  return points;
}

std::vector<int> flipped_triangles(const std::vector<FlatTriangle>& triangles,
                                   const Eigen::MatrixX3i& F, const Eigen::VectorXcd& z) {
  std::vector<int> flipped;
  for (int t = 0; t < std::ssize(triangles); ++t) {
    const double length = longest_flat_edge(triangles[t]);
    if (2 * triangles[t].area <= kFlatThinnest * length * length) continue;
    if (!(twice_signed_area(z(F(t, 0)), z(F(t, 1)), z(F(t, 2))) > 0)) flipped.push_back(t);
  }
  return flipped;
}

void scale_to_area(const std::vector<FlatTriangle>& triangles, const Eigen::MatrixX3i& F,
                   Eigen::VectorXcd& z) {
  double in_space = 0, in_plane = 0;
  for (int t = 0; t < std::ssize(triangles); ++t) {
    in_space += triangles[t].area;
    in_plane += twice_signed_area(z(F(t, 0)), z(F(t, 1)), z(F(t, 2))) / 2;
  }
  if (in_plane > 0) z *= std::sqrt(in_space / in_plane);
}

}  // namespace geoprior::sketch
