#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "models/sketch/cut_surface.h"
#include "models/sketch/surface_path.h"

namespace geoprior::sketch {

/// Cuts that a surface is to get before it is laid flat.
struct SuggestedSeam {
  bool is_dart = false;  ///< it parts no piece in two
  /// Paths that are split and cut together, one set after the other: each set refers to the
  /// vertices of the surface that all sets before it, of earlier suggestions too, have split.
  std::vector<std::vector<SurfacePath>> cuts;
  std::vector<Eigen::MatrixX3d> lines;    ///< the same paths in space (rows: points, m)
  std::vector<Eigen::MatrixX3d> normals;  ///< of the surface at their points
  double length = 0;                      ///< of all of them (m)
  /// Share of the surface's area that is stretched by less than the tolerance in the pattern, and
  /// the mean over the area of |log stretch|: measured, before and after.
  double share_before = 0, share_after = 0;
  double strain_before = 0, strain_after = 0;
};

/// A surface with the seams that it is cut along.
struct SeamedSurface {
  TriMesh mesh;
  std::vector<SeamEdge> seams;

  /// Splits the mesh along paths and cuts it there.
  /// @return  whether that was possible; otherwise nothing has changed
  bool cut(std::span<const SurfacePath> paths, int seam);
};

}  // namespace geoprior::sketch
