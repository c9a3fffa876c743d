#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/options.h"
#include "models/sketch/sketch_surface.h"

namespace geoprior::sketch {

struct FoldOptions {
  double angle_deg = 60;  ///< between the normal on a fold's contour and the view direction
  double width = 0.03;    ///< distance along the surface over which a fold fades (m)
};
void describe(OptionVisitor& v, FoldOptions& options);

/// What drawn folds ask of the triangles (thesis 2.1.2, Figure 2.5): on the contour of a fold the
/// normal makes a given angle with the view direction; the triangle is turned there about the
/// fold's edge, the shorter of the two ways. The demand has weight 1 on the fold and fades smoothly
/// to 0 at `width` along the surface.
///
/// The text gives no width. Distances are along edges (Dijkstra), which is up to 8 % long.
class FoldRotation {
 public:
  /// @param V  hull positions, along which distances are measured
  FoldRotation(const SketchSurface& surface, const FoldOptions& options);

  [[nodiscard]] bool empty() const { return triangles_.empty(); }
  /// Turns the rotations of triangles near folds towards what the folds ask.
  /// @param X          n x 3, now
  /// @param normals    of the triangles now
  /// @param rotations  one a triangle
  void blend(const Eigen::MatrixX3d& X, const Eigen::MatrixX3d& normals,
             std::vector<Eigen::Matrix3d>& rotations) const;
  /// Triangles that touch a fold, and the view of each.
  [[nodiscard]] std::vector<int> on_fold() const;

  struct Demand {
    int triangle = 0;
    double weight = 0;
    Edge edge{};  ///< of the fold, whose direction is the axis
    Eigen::Vector3d to_eye = Eigen::Vector3d::UnitZ();
    double angle = 0;  ///< rad
  };
  [[nodiscard]] const std::vector<Demand>& demands() const { return triangles_; }

 private:
  std::vector<Demand> triangles_;
};

}  // namespace geoprior::sketch
