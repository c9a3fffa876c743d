#pragma once

#include <vector>

#include "core/geometry/holes/loop_cap.h"
#include "core/mesh.h"

namespace geoprior {

/// What closes the holes of a mesh, and what stays open.
struct HoleCaps {
  /// A border loop that stays open.
  struct OpenLoop {
    std::vector<int> loop;
    bool is_sheet = false;  ///< the outline of a sheet; else no cap has an area (`cap_of_loop`)
  };
  std::vector<CapTriangle> triangles;    ///< on the mesh's own vertices
  std::vector<std::vector<int>> capped;  ///< loops
  std::vector<OpenLoop> open;
  int stray_edges = 0;  ///< as of `BoundaryLoops`
  /// Whether some component has an inside, of itself or by its caps. Of sheets alone no hole is to
  /// be told from their outline.
  bool has_inside = false;
};

/// Caps every border loop of a mesh that a cap closes (`cap_of_loop`).
///
/// Loops of a sheet stay open: of a component that would enclose less than a thousandth of its area
/// to the power of 3/2, caps included (a ball: 94 thousandths). Its border is its outline, no hole.
///
/// What it cannot do: a component that is curved more than that becomes a lens; one that faces
/// inwards is closed inside out; caps do not see other parts, which may stand through them.
HoleCaps cap_holes(const TriMesh& mesh);

}  // namespace geoprior
