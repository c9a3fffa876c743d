#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace geoprior::sketch {

/// Eigenvalues of a symmetric 3 x 3 matrix, ascending, and their unit eigenvectors (columns, right
/// handed).
struct SymmetricEigen {
  Eigen::Vector3d values;
  Eigen::Matrix3d vectors;
};

namespace symmetric_eigen_detail {

/// Eigenvector of the eigenvalue that is farthest from the mean of the three, and which it is.
struct LoneEigenvector {
  Eigen::Vector3d vector;
  bool largest;  ///< otherwise the smallest
};

/// By the trigonometric roots of the cubic and the longest cross product of two columns of
/// A - lambda I, which are long because the other two eigenvalues are far from lambda.
/// @return  nothing for a multiple of the identity (to rounding)
inline std::optional<LoneEigenvector> lone_eigenvector(const Eigen::Matrix3d& matrix) {
  const double scale = matrix.cwiseAbs().maxCoeff();
  if (!(scale > 0)) return std::nullopt;
  Eigen::Matrix3d centred = matrix / scale;
  centred.diagonal().array() -= centred.trace() / 3;
  const double spread = std::sqrt(centred.squaredNorm() / 6);
  if (!(spread > 1e-16)) return std::nullopt;
  const double cos_3phi =
      std::clamp(centred.determinant() / (2 * spread * spread * spread), -1.0, 1.0);
  const bool largest = cos_3phi >= 0;
  // The smallest root at phi is minus the largest at pi / 3 - phi.
  const double root = (largest ? 2 : -2) * std::cos(std::acos(std::abs(cos_3phi)) / 3);
  centred.diagonal().array() -= root * spread;
  const Eigen::Vector3d ab = centred.col(0).cross(centred.col(1));
  const Eigen::Vector3d bc = centred.col(1).cross(centred.col(2));
  const Eigen::Vector3d ca = centred.col(2).cross(centred.col(0));
  const double first = ab.squaredNorm(), second = bc.squaredNorm(), third = ca.squaredNorm();
  if (first >= second && first >= third) return LoneEigenvector{ab / std::sqrt(first), largest};
  if (second >= third) return LoneEigenvector{bc / std::sqrt(second), largest};
  return LoneEigenvector{ca / std::sqrt(third), largest};
}

/// Eigenvector of the larger of the two eigenvalues in the plane orthogonal to `alone`, by a
/// rotation in that plane; `alone` times it is the other one.
inline Eigen::Vector3d upper_in_plane(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& alone) {
  const Eigen::Vector3d u = alone.unitOrthogonal(), v = alone.cross(u);
  const Eigen::Vector3d image = matrix * u;
  const double half = (image.dot(u) - v.dot(matrix * v)) / 2, mixed = image.dot(v);
  const double radius = std::hypot(half, mixed);
  if (!(radius > 0)) return u;
  // Half of the angle of (half, mixed), without cancellation.
  const Eigen::Vector3d upper = half >= 0 ? Eigen::Vector3d((half + radius) * u + mixed * v)
                                          : Eigen::Vector3d(mixed * u + (radius - half) * v);
  return upper.normalized();
}

}  // namespace symmetric_eigen_detail

/// In closed form: the eigenvalue farthest from the mean by the trigonometric roots of the cubic,
/// its eigenvector from cross products, and the other two by one rotation in the plane orthogonal
/// to it. Eigenvectors of a double eigenvalue are some orthonormal pair; eigenvalues are Rayleigh
/// quotients, exact to about 1e-15 of the largest modulus. Both triangles are read.
///
/// Source: the trigonometric solution of the characteristic cubic (Smith 1961) and the order of
/// work of Eberly, A Robust Eigensolver for 3 x 3 Symmetric Matrices, 2014.
inline SymmetricEigen symmetric_eigen(const Eigen::Matrix3d& matrix) {
  SymmetricEigen result{matrix.diagonal(), Eigen::Matrix3d::Identity()};
  const auto lone = symmetric_eigen_detail::lone_eigenvector(matrix);
  if (!lone) return result;
  const Eigen::Vector3d& alone = lone->vector;
  const Eigen::Vector3d upper = symmetric_eigen_detail::upper_in_plane(matrix, alone);
  if (lone->largest)
    result.vectors << upper.cross(alone), upper, alone;
  else
    result.vectors << alone, upper.cross(alone), upper;
  for (int k = 0; k < 3; ++k)
    result.values(k) = result.vectors.col(k).dot(matrix * result.vectors.col(k));
  return result;
}

/// The first eigenvector of `symmetric_eigen` alone, up to its sign.
inline Eigen::Vector3d smallest_eigenvector(const Eigen::Matrix3d& matrix) {
  const auto lone = symmetric_eigen_detail::lone_eigenvector(matrix);
  if (!lone) return Eigen::Vector3d::UnitX();
  if (!lone->largest) return lone->vector;
  return symmetric_eigen_detail::upper_in_plane(matrix, lone->vector).cross(lone->vector);
}

}  // namespace geoprior::sketch
