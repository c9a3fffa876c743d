#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "models/sketch/surface/cut_surface.h"
#include "models/sketch/surface/path.h"

namespace geoprior::sketch {

/// Cuts as they lie on a surface.
struct CutLines {
  std::vector<Eigen::MatrixX3d> points;   ///< rows along each cut (m)
  std::vector<Eigen::MatrixX3d> normals;  ///< of the surface there
  double length = 0;                      ///< of all of them (m)

  void append(const CutLines& more) {
    points.insert(points.end(), more.points.begin(), more.points.end());
    normals.insert(normals.end(), more.normals.begin(), more.normals.end());
    length += more.length;
  }
};

/// Cuts that a surface is to get before it is laid flat.
struct SuggestedSeam {
  bool is_dart = false;  ///< it parts no piece in two
  /// Paths that are split and cut together; in the numbers of the vertices after the cuts of the
  /// suggestions before.
  std::vector<SurfacePath> cut;
  CutLines lines;
  /// What opens the rings that there are then, so that all can be laid flat, in the numbers after
  /// this cut; one set after the other. The next suggestion does without.
  std::vector<std::vector<SurfacePath>> openings;
  CutLines opening_lines;
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
