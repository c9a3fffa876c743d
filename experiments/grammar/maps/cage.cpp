#include "experiments/grammar/maps/cage.h"

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/geometry/topology.h"

namespace geoprior::grammar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Half the sum of angles falls short of pi by this on a triangle, and the sine of a dihedral angle
/// seen from x is at most this in its plane (rad).
constexpr double kFlatTriangle = 1e-8;

/// Weights that a triangle gives its corners.
struct CornerWeights {
  Vector3d weight{0, 0, 0};
  bool on_triangle = false;  ///< barycentric, and no other triangle counts
};

/// Seen from x as the unit vectors u_i, with angles theta_i opposite to them, a triangle covers a
/// spherical one of the mean vector m = sum theta_i n_i / 2, n_i the unit normal of the plane of
/// the other two; the weight of its corner i is (n_i . m) / (n_i . u_i) / |v_i - x|. It is figure 4
/// of the paper without its root of 1 - c^2, which loses half the digits in the triangle's plane.
/// @param corners  columns
CornerWeights corner_weights(const Matrix3d& corners, const Vector3d& x) {
  Matrix3d u = corners.colwise() - x;
  Vector3d distance;
  for (int i = 0; i < 3; ++i) {
    distance[i] = u.col(i).norm();
    if (distance[i] == 0) return {Vector3d::Unit(i), true};
    u.col(i) /= distance[i];
  }
  Matrix3d normal;
  Vector3d angle, sine;
  for (int i = 0; i < 3; ++i) {
    const Vector3d next = u.col((i + 1) % 3), last = u.col((i + 2) % 3);
    angle[i] = 2 * std::atan2((next - last).norm(), (next + last).norm());
    normal.col(i) = next.cross(last);
    sine[i] = normal.col(i).norm();
  }
  CornerWeights out;
  if (std::numbers::pi - angle.sum() / 2 < kFlatTriangle) {
    out.on_triangle = true;
    for (int i = 0; i < 3; ++i)
      out.weight[i] = sine[i] * distance[(i + 1) % 3] * distance[(i + 2) % 3];
    return out;
  }
  const double determinant = u.col(0).dot(normal.col(0));
  if (!(sine.minCoeff() > 0)) return out;
  if (std::abs(determinant) <= kFlatTriangle * sine.prod() / sine.minCoeff()) return out;
  const Vector3d doubled_mean = normal * angle.cwiseQuotient(sine);
  for (int i = 0; i < 3; ++i)
    out.weight[i] = normal.col(i).dot(doubled_mean) / (determinant * distance[i]);
  return out;
}

}  // namespace

CageMap::CageMap(const Cage& cage, double share) : rest_(cage.rest) {
  if (cage.moved.rows() != cage.rest.V.rows())
    throw Error("has " + std::to_string(cage.moved.rows()) + " moved vertices", "cage",
                std::to_string(cage.rest.V.rows()));
  if (!cage.moved.allFinite() || !cage.rest.V.allFinite())
    throw Error("has a vertex that is not finite", "cage");
  require_closed_manifold(rest_, "a deformation by mean value coordinates", "cage");
  moved_ = (1 - share) * rest_.V + share * cage.moved;
  step_ = 1e-6 * bounding_box_diagonal(rest_.V);
}

Vector3d CageMap::at(const Vector3d& x) const {
  Vector3d sum = Vector3d::Zero();
  double weights = 0;
  for (int t = 0; t < rest_.triangle_count(); ++t) {
    Matrix3d corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = rest_.V.row(rest_.F(t, i)).transpose();
    const CornerWeights w = corner_weights(corners, x);
    if (w.on_triangle) {
      sum.setZero();
      weights = 0;
    }
    for (int i = 0; i < 3; ++i) sum += w.weight[i] * moved_.row(rest_.F(t, i)).transpose();
    weights += w.weight.sum();
    if (w.on_triangle) break;
  }
  return sum / weights;
}

}  // namespace geoprior::grammar
