#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/connectivity.h"
#include "core/mesh.h"
#include "models/sketch/surface/path.h"
#include "models/sketch/surface/visual_hull.h"

namespace geoprior::sketch {

/// A drawn stroke as a path of edges of the surface.
struct StrokePath {
  std::string id;                       ///< of the stroke
  int view = 0;                         ///< it was drawn in, of SketchSurface::views; -1: in none
  int number = 0;                       ///< among the strokes of its kind in that view
  std::vector<Eigen::Vector2d> points;  ///< as drawn, aligned (m); none of what was not drawn
  bool closed = false;                  ///< it ends where it begins
  DepthSide side = DepthSide::front;    ///< of the surface that it lies on
  std::vector<Edge> edges;              ///< lower vertex first, ascending
  double missed = 0;  ///< share of the stroke's length beside which there is no edge
  std::optional<double> fold_angle_deg = {}, fold_width = {};  ///< of the stroke
  std::optional<FoldSide> fold_side = {};                      ///< of the stroke
};

/// A stretch of the surface's border that a stroke asks for.
struct BorderPlace {
  std::string id;  ///< of the stroke
  int view = 0;
  std::vector<Eigen::Vector2d> points;  ///< the stroke, aligned (m)
  int number = 0;                       ///< among the borders of that view
  bool inside = false;                  ///< a slit or the border of a hole, not on the silhouette
};

/// The hull as a surface to work on: open where borders were drawn, with seams along its edges.
struct SketchSurface {
  VisualHull hull;
  std::vector<StrokePath> seams;
  std::vector<StrokePath> folds;     ///< drawn folds; edges that they cross
  std::vector<BorderPlace> borders;  ///< drawn borders
  std::vector<int> border_of;        ///< of each vertex: of `borders`, or -1
};

/// A border along the silhouette takes the end away that the hull closes there. One inside of it is
/// traced like a seam: an open line is a slit, whose two sides have vertices of their own; within a
/// closed line the triangles that face the line's side are taken out, and it may pass the
/// silhouette's borders, as the front of an open coat does.
///
/// @param aligned  of `align_views`
/// @param hull     of that drawing
/// @throws Error   naming stroke and view: a border that is not on the silhouette, a seam or fold
///                 that leaves the surface
SketchSurface sketch_surface(const Drawing& aligned, VisualHull hull);

/// Cuts a surface along further paths, which are one more seam, drawn in no view: its `points` stay
/// empty. Sets of paths are made one after the other (`SuggestedSeam::openings`).
/// @param X       n x 3, other positions of the vertices: new vertices are put between them too
/// @throws Error  when the triangles cannot be split so
void add_seam(SketchSurface& surface, Eigen::MatrixX3d& X,
              const std::vector<std::vector<SurfacePath>>& cuts, const std::string& id);

}  // namespace geoprior::sketch
