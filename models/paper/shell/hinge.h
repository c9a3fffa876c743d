#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace geoprior::paper {

/// Dihedral angle of the edge a-b with c opposite on its left and d on its right, and its gradient.
///
/// Sign as in core/geometry/curvature_fit.h. With unit normals n1, n2, heights h1, h2 of c, d over
/// the edge:
///   d theta/dc = n1/h1, d theta/dd = n2/h2, and a, b take the negative in the proportion in which
///   the feet of the heights divide the edge.
/// Not defined for a triangle without area in space, nor differentiable where folded flat on
/// itself.
struct HingeAngle {
  double angle = 0;                         ///< rad
  std::array<Eigen::Vector3d, 4> gradient;  ///< by a, b, c, d (rad/m)

  template <bool WithGradient>
  static HingeAngle of(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                       const Eigen::Vector3d& d) {
    HingeAngle h;
    const Eigen::Vector3d e = b - a, ac = c - a, ad = d - a;
    const Eigen::Vector3d left = e.cross(ac), right = ad.cross(e);
    const double square = e.squaredNorm(), length = std::sqrt(square);
    // right x left = (ad x e) x left = e (ad . left).
    h.angle = std::atan2(ad.dot(left) * length, left.dot(right));
    if constexpr (WithGradient) {
      const Eigen::Vector3d dc = left * (length / left.squaredNorm());
      const Eigen::Vector3d dd = right * (length / right.squaredNorm());
      const Eigen::Vector3d db = -(ac.dot(e) / square) * dc - (ad.dot(e) / square) * dd;
      h.gradient = {-db - dc - dd, db, dc, dd};
    }
    return h;
  }
};

}  // namespace geoprior::paper
