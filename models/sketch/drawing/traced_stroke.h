#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/connectivity.h"
#include "core/mesh.h"
#include "models/sketch/drawing/stroke.h"
#include "models/sketch/surface/visual_hull.h"

namespace geoprior::sketch {

/// A stroke of a view as it lies on the surface.
struct TracedStroke {
  std::vector<Edge> edges;  ///< lower vertex first, ascending
  double missed = 0;        ///< share of the stroke's length beside which there is no edge
};

/// Puts a stroke onto the triangles that face its view (from the front, from the back, or both): it
/// is carried along the view direction, triangles that it crosses are split. Where it passes nearer
/// to a vertex than a sixth of the edge, the vertex stands in for the crossing: slivers would spoil
/// the surface.
///
/// Of parts of the surface behind each other, all of which face the view, the stroke lies on the
/// nearest for `front`, on the farthest for `back`. At its ends a stroke goes on straight for at
/// most `reach`, so that it meets a silhouette or another stroke that it was drawn up to.
///
/// @param points  of the stroke, two or more
/// @param mesh    is split: vertices are appended, triangles change
/// @param kept    paths of edges that are split along with the mesh
/// @param reach   m
TracedStroke trace_stroke(const std::vector<Eigen::Vector2d>& points, DepthSide side,
                          const OutlinedView& view, double reach, TriMesh& mesh,
                          std::vector<std::vector<Edge>*> kept);

}  // namespace geoprior::sketch
