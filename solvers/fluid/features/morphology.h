#pragma once

#include <vector>

#include "core/mesh.h"
#include "solvers/fluid/features/surface_graph.h"

namespace geoprior::fluid {

/// Vertex sets of one surface grown and shrunk by metric radii. Vertices that are not `active` are
/// in no set: they neither grow nor bound anything, distances do not run through them.
///
/// Distances run along edges (Dijkstra's algorithm from the set's rim, stopped at the radius), so
/// an operation costs as much as the vertices that it changes.
class Morphology {
 public:
  Morphology(const SurfaceGraph& graph, const std::vector<char>& active);
  /// Adds (erode: removes) active vertices within `radius` (m) of the set (of its complement).
  void dilate(std::vector<char>& set, double radius);
  void erode(std::vector<char>& set, double radius);
  /// Adds the active parts of the complement that the set alone surrounds (no border, nothing
  /// inactive) and whose area is at most `largest` (m^2). @param area  of the vertices
  void fill_holes(std::vector<char>& set, const std::vector<double>& area, double largest);

 private:
  struct Reached {
    double distance;
    int vertex;
  };
  void spread(std::vector<char>& set, char from, double radius);

  const SurfaceGraph& graph_;
  const std::vector<char>& active_;
  std::vector<double> distance_;  // infinite but during spread
  std::vector<Reached> heap_;
  std::vector<int> touched_;
};

/// Geodesic dilation and erosion of a vertex set by a metric radius (m). Distances run along edges,
/// so they exceed the true ones by up to about a tenth on irregular meshes. The border of an open
/// mesh does not erode.
std::vector<char> dilate(const TriMesh& mesh, const std::vector<char>& set, double radius);
std::vector<char> erode(const TriMesh& mesh, const std::vector<char>& set, double radius);

}  // namespace geoprior::fluid
