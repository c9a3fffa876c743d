#include "metrics/isometry/shell_energy.h"

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior {
namespace {

/// Edge vectors of a triangle in the pattern, as columns.
Eigen::Matrix2d pattern_edges(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3i& triangles,
                              Eigen::Index t) {
  const Eigen::RowVector2d a = pattern.row(triangles(t, 0));
  Eigen::Matrix2d edges;
  edges << (pattern.row(triangles(t, 1)) - a).transpose(),
      (pattern.row(triangles(t, 2)) - a).transpose();
  return edges;
}

}  // namespace

double plate_form(double uu, double uv, double vv, double poisson_ratio) {
  const double trace = uu + vv;
  return (1 - poisson_ratio) * (uu * uu + 2 * uv * uv + vv * vv) + poisson_ratio * trace * trace;
}

double plate_form(double uu, double uv, double vv, const PlateStiffness& plate) {
  const double c = std::cos(plate.grain), s = std::sin(plate.grain);
  const double bend = c * c * uu + 2 * c * s * uv + s * s * vv;
  return plate_form(uu, uv, vv, plate.poisson_ratio) + (plate.along - 1) * bend * bend;
}

double membrane_energy(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3d& x,
                       const Eigen::MatrixX3i& triangles, const PlateStiffness& plate) {
  double energy = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Matrix2d rest = pattern_edges(pattern, triangles, t);
    const double area = rest.determinant() / 2;
    if (!(area > 0)) {
      throw Error("no area in the pattern, or turned over", "triangle " + std::to_string(t),
                  "counter-clockwise triangles");
    }
    Eigen::Matrix<double, 3, 2> now;
    now << (x.row(triangles(t, 1)) - x.row(triangles(t, 0))).transpose(),
        (x.row(triangles(t, 2)) - x.row(triangles(t, 0))).transpose();
    const Eigen::Matrix<double, 3, 2> F = now * rest.inverse();
    const Eigen::Matrix2d G = (F.transpose() * F - Eigen::Matrix2d::Identity()) / 2;
    energy += area * plate_form(G(0, 0), G(0, 1), G(1, 1), plate.poisson_ratio);
  }
  return energy * plate.membrane / 2;
}

double bending_energy(const CurvatureFit& fit, const Eigen::MatrixX3d& x,
                      const Eigen::MatrixX3d& rest_curvature, const PlateStiffness& plate) {
  const Eigen::MatrixX3d S = shape_operators(fit, x);
  if (rest_curvature.rows() != S.rows()) {
    throw Error(std::to_string(rest_curvature.rows()) + " rest curvatures", "bending energy",
                std::to_string(S.rows()) + ", one a triangle");
  }
  const Eigen::MatrixX3d elastic = S - rest_curvature;
  double energy = 0;
  for (Eigen::Index t = 0; t < elastic.rows(); ++t) {
    energy += fit.area[t] * plate_form(elastic(t, 0), elastic(t, 1), elastic(t, 2), plate);
  }
  return energy * plate.bending / 2;
}

double kinetic_energy(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3d& velocity,
                      const Eigen::MatrixX3i& triangles, double area_density) {
  double integral = 0;  // of |v|^2 over the pattern
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::RowVector3d a = velocity.row(triangles(t, 0));
    const Eigen::RowVector3d b = velocity.row(triangles(t, 1));
    const Eigen::RowVector3d c = velocity.row(triangles(t, 2));
    const double area = pattern_edges(pattern, triangles, t).determinant() / 2;
    integral += area / 12 *
                (a.squaredNorm() + b.squaredNorm() + c.squaredNorm() + (a + b + c).squaredNorm());
  }
  return integral * area_density / 2;
}

}  // namespace geoprior
