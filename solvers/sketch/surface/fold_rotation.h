#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/options.h"
#include "models/sketch/surface/sketch_surface.h"

namespace geoprior::sketch {

struct FoldOptions {
  double angle_deg = 60;
  double width = 0.03;
};
void describe(OptionVisitor& v, FoldOptions& options);

/// What drawn folds ask of the triangles (thesis 2.1.2, Figure 2.5): on the contour of a fold the
/// normal makes a given angle with the view direction; the triangle is turned there about the
/// fold's edge. The demand has weight 1 on the fold and fades smoothly to 0 at `width` along the
/// surface.
///
/// Two turns lead to that angle: the surface falls away to the left of the stroke or to its right.
/// All of a fold goes the same way, the drawn one or the one that turns its triangles less in all:
/// triangles that each took the shorter turn would crumple a surface that faces the eye. Likewise
/// the axis is the mean direction of the fold's edges nearby, since the path zigzags with the mesh.
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
    int edge = 0;   ///< of `edges_`, whose direction is the axis
    int group = 0;  ///< of the triangles that turn the same way
  };
  [[nodiscard]] const std::vector<Demand>& demands() const { return triangles_; }

 private:
  /// An edge of a fold, along its stroke.
  struct FoldEdge {
    Edge edge{};
    std::vector<int> nearby;  ///< edges whose mean direction is the axis
  };
  /// Triangles of one fold on one side of the object.
  struct Group {
    Eigen::Vector3d to_eye = Eigen::Vector3d::UnitZ();  ///< of who looks at that side
    double angle = 0;                                   ///< rad
    std::optional<FoldSide> side = {};                  ///< as seen by who looks at that side
  };
  void add_edges(const SketchSurface& surface);
  /// Direction of the axis of every edge now.
  [[nodiscard]] std::vector<Eigen::Vector3d> axes(const Eigen::MatrixX3d& X) const;

  std::vector<Demand> triangles_;
  std::vector<FoldEdge> edges_;
  std::vector<int> first_edge_;  ///< of each fold
  std::vector<Group> groups_;    ///< two a fold: the front, the back
};

}  // namespace geoprior::sketch
