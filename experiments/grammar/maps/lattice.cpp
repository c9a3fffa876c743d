#include "experiments/grammar/maps/lattice.h"

#include <array>
#include <cmath>

#include "core/error.h"

namespace geoprior::grammar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMostLatticePoints = 16;  ///< along an axis

/// Bernstein's polynomials of one degree, and their derivatives.
struct BernsteinBasis {
  std::array<double, kMostLatticePoints> value{};
  std::array<double, kMostLatticePoints> slope{};

  /// By raising the degree: B_i^n = (1 - u) B_i^(n-1) + u B_(i-1)^(n-1), and with the last but one
  /// the derivatives n (B_(i-1)^(n-1) - B_i^(n-1)).
  BernsteinBasis(int points, double u) {
    value[0] = 1;
    const int degree = points - 1;
    for (int n = 1; n <= degree; ++n) {
      for (int i = n; i >= 0; --i) {
        const double lower = i > 0 ? value[i - 1] : 0;
        if (n == degree) slope[i] = degree * (lower - value[i]);
        value[i] = (1 - u) * value[i] + u * lower;
      }
    }
  }
};

}  // namespace

void require_valid(const Lattice& lattice, const std::string& where) {
  if (!lattice.low.allFinite() || !lattice.high.allFinite() ||
      !((lattice.high - lattice.low).minCoeff() > 0))
    throw Error("has a lattice whose box has no volume", where, "'low' below 'high' on each axis");
  std::size_t count = 1;
  for (const int n : lattice.points) {
    if (n < 2 || n > kMostLatticePoints)
      throw Error("has a lattice of " + std::to_string(n) + " control points along an axis", where,
                  "2 to " + std::to_string(kMostLatticePoints));
    count *= static_cast<std::size_t>(n);
  }
  if (lattice.shifts.size() != count)
    throw Error("has a lattice of " + std::to_string(lattice.shifts.size()) + " shifts", where,
                std::to_string(count) + ", one a control point");
  for (const Vector3d& shift : lattice.shifts)
    if (!shift.allFinite())
      throw Error("has a lattice with a shift that is not finite", where, "finite numbers");
}

LatticeMap::LatticeMap(const Lattice& lattice, double fraction)
    : lattice_(lattice), box_(lattice.low, lattice.high) {
  for (Vector3d& shift : lattice_.shifts) shift *= fraction;
}

Vector3d LatticeMap::place_in_box(const Vector3d& x) const {
  return (x - lattice_.low).cwiseQuotient(lattice_.high - lattice_.low);
}

Vector3d LatticeMap::at(const Vector3d& x) const {
  if (!box_.contains(x)) return x;
  const Vector3d u = place_in_box(x);
  const auto [nx, ny, nz] = lattice_.points;
  const BernsteinBasis a(nx, u.x()), b(ny, u.y()), c(nz, u.z());
  Vector3d shift = Vector3d::Zero();
  const Vector3d* control = lattice_.shifts.data();
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      Vector3d row = Vector3d::Zero();
      for (int i = 0; i < nx; ++i) row += a.value[i] * *control++;
      shift += b.value[j] * c.value[k] * row;
    }
  }
  return x + shift;
}

MappedPoint LatticeMap::with_jacobian(const Vector3d& x) const {
  if (!box_.contains(x)) return {x, Matrix3d::Identity()};
  const Vector3d u = place_in_box(x);
  const auto [nx, ny, nz] = lattice_.points;
  const BernsteinBasis a(nx, u.x()), b(ny, u.y()), c(nz, u.z());
  Vector3d shift = Vector3d::Zero();
  Matrix3d slopes = Matrix3d::Zero();
  const Vector3d* control = lattice_.shifts.data();
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      Vector3d row = Vector3d::Zero(), row_slope = Vector3d::Zero();
      for (int i = 0; i < nx; ++i, ++control) {
        row += a.value[i] * *control;
        row_slope += a.slope[i] * *control;
      }
      shift += b.value[j] * c.value[k] * row;
      slopes.col(0) += b.value[j] * c.value[k] * row_slope;
      slopes.col(1) += b.slope[j] * c.value[k] * row;
      slopes.col(2) += b.value[j] * c.slope[k] * row;
    }
  }
  const Vector3d size = lattice_.high - lattice_.low;
  return {x + shift, Matrix3d::Identity() + slopes * size.cwiseInverse().asDiagonal()};
}

}  // namespace geoprior::grammar
