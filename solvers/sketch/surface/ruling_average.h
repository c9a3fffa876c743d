#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/options.h"

namespace geoprior::sketch {

struct RulingAverageOptions {
  double share = 0.5;
  double reach = 2.2;
  double across = 1.15;
  double along = 2.6;
};
void describe(OptionVisitor& v, RulingAverageOptions& options);

/// Rotations that make a surface fair along its rulings: the normals of a developable surface are
/// constant along them, so each triangle is turned to the mean of the normals in an ellipse that is
/// long along its ruling and short across it. A saw along a ridge is averaged away, teeth of one
/// side against those of the other; the ridge itself becomes a cylinder of the width of the
/// ellipse.
///
/// The ruling is the axis A of the cone that fits the normals within `reach`, guarded as in
/// `DevelopableRotation` (a good 30 degrees from the mean normal), seen along the mean normal:
/// over a few edges it is the ridge's own direction, where one ring of triangles sees the saw.
/// Means are weighted by area and (1 - q)^2, q = (x / across)^2 + (y / along)^2, y along the
/// ruling.
///
/// It cannot tell a saw from a wanted detail of that size, and at a border, where neighbours lie on
/// one side, a bend is flattened a little; the cones after it mend that.
///
/// Lengths are in mean edge lengths of the mesh that is given.
class RulingAverage {
 public:
  /// @param V  n x 3, whose distances tell who is a neighbour; they are those of the start
  /// @param F  triangles; averages do not go beyond its borders
  RulingAverage(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                const RulingAverageOptions& options);

  /// @param X  n x 3, now
  /// @return   a rotation a triangle
  [[nodiscard]] std::vector<Eigen::Matrix3d> rotations(const Eigen::MatrixX3d& X) const;

 private:
  struct Triangles {
    Eigen::MatrixX3d centre, normal;
    Eigen::VectorXd area;
  };
  [[nodiscard]] Triangles measured(const Eigen::MatrixX3d& X) const;
  /// Mean normal of a triangle's ellipse, unit; 0 where there is none.
  [[nodiscard]] Eigen::Vector3d mean_normal(int triangle, const Triangles& all) const;

  Eigen::MatrixX3i F_;
  double reach_, across_, along_;       ///< m
  std::vector<int> begin_, neighbour_;  ///< of each triangle, itself among them
};

}  // namespace geoprior::sketch
