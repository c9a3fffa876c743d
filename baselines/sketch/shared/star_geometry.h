#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/connectivity.h"
#include "core/mesh.h"

namespace geoprior::sketch {

/// Derivatives of an energy by what a star is made of: of corner c = 3 t + k, by its angle and by
/// the unit normal of its triangle (summed over the three corners when they are used).
struct StarDerivatives {
  Eigen::VectorXd by_angle;    ///< 3 m
  Eigen::Matrix3Xd by_normal;  ///< 3 x 3 m; what points along the normal has no effect
};

/// Angles and normals of the triangles at every vertex, and the way back: the gradient by the
/// positions of an energy that is given by them.
///
/// For corner i of a triangle with the opposite edge e_i (counter-clockwise), normal n and area A,
///
///   d n / d p_i       = (e_i x n) n' / (2 A)
///   d theta_i / d p_j = -(n x u) / |u|^2,  u = p_j - p_i   (j the next corner)
///   d theta_i / d p_k =  (n x v) / |v|^2,  v = p_k - p_i   (k the last corner)
///
/// and d theta_i / d p_i is minus the sum of the latter two.
class StarGeometry {
 public:
  /// @throws Error  on a vertex index out of range
  StarGeometry(const Eigen::MatrixX3i& F, int vertex_count);

  /// Measures all triangles. A degenerate one gets a normal of zeros and contributes nothing to
  /// gradients.
  void measure(const Eigen::MatrixX3d& x);

  /// Adds up the derivatives by the positions that were measured.
  void gradient(const StarDerivatives& derivatives, Eigen::MatrixX3d& gradient);

  [[nodiscard]] int vertex_count() const { return static_cast<int>(border_.size()); }
  [[nodiscard]] int corner_count() const { return static_cast<int>(3 * F_.rows()); }
  [[nodiscard]] const VertexCorners& corners() const { return corners_; }
  /// Whether a vertex has triangles all around it.
  [[nodiscard]] bool interior(int v) const { return !border_[v] && corners_.count(v) > 0; }
  [[nodiscard]] const std::vector<bool>& border() const { return border_; }
  /// Angle of a corner (rad).
  [[nodiscard]] double angle(int corner) const { return angle_(corner); }
  /// Unit normal of the triangle of a corner.
  [[nodiscard]] Eigen::Vector3d normal(int corner) const { return normal_.col(corner / 3); }

 private:
  void measure_triangle(int t, const Eigen::MatrixX3d& x);
  void differentiate_triangle(int t, const StarDerivatives& derivatives);

  Eigen::MatrixX3i F_;
  VertexCorners corners_;
  std::vector<bool> border_;
  Eigen::VectorXd angle_;       ///< by corner
  Eigen::VectorXd twice_area_;  ///< by triangle
  Eigen::Matrix3Xd normal_;     ///< by triangle
  Eigen::Matrix3Xd edge_;       ///< opposite to each corner, counter-clockwise
  Eigen::Matrix3Xd at_corner_;  ///< scratch: gradient by the corner's vertex in its triangle
};

}  // namespace geoprior::sketch
