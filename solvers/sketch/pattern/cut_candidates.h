#pragma once

#include <optional>
#include <vector>

#include "models/sketch/surface/cut_surface.h"
#include "models/sketch/surface/path.h"

namespace geoprior::sketch {

/// The plane x = at or z = at about which a surface is its own mirror image.
struct MirrorAxis {
  int axis = 0;
  double at = 0;  ///< m

  [[nodiscard]] Eigen::RowVector3d mirrored(Eigen::RowVector3d x) const {
    x[axis] = 2 * at - x[axis];
    return x;
  }
};

/// Left and right alike (x), otherwise front and back (z); nothing when a vertex's mirror image is
/// farther than 1.5 % of the diagonal from the surface.
std::optional<MirrorAxis> mirror_axis(const TriMesh& surface);

struct CutCandidateOptions {
  std::optional<MirrorAxis> mirror = {};
  bool fair = true;  ///< false: cuts stay where they were found
};

/// Cuts that may make a piece developable, each a set of paths to be cut together.
///
/// Places are the extremes of the conformal scale (`conformal_scale`). From each place there are
/// stars of 1, 2, 3, 4, 6 and 8 paths to points that divide the border evenly; a single one goes to
/// the nearest border as well. Closed cuts are each the shortest one that parts the two sides of a
/// ring: between two values of the scale, around a place, and between two distances from the
/// longest border, where most curvature lies (a crease parallel to a hem). These are weighted:
/// cheaper along lines of concentrated angle defect, by 1 / (1 + 0.3 d), d the density of
/// |defect| over its mean; paths of stars are straight on the surface.
///
/// Further cuts go around parts of constant slope (`slope_parts`), which can be laid flat by
/// themselves, and along the planes through the middle of the piece's box. What parts the piece in
/// two is a fair line (`level_lines.h`).
///
/// With a mirror plane a place near the plane is moved to it and its star begins there; the star of
/// any other place comes together with its mirror image.
///
/// @param piece  with a border; its vertices are those of the paths
std::vector<std::vector<SurfacePath>> cut_candidates(const CutPiece& piece,
                                                     const CutCandidateOptions& options);

/// The mirror image of a cut of a piece, on the other piece that is its mirror image: vertex by
/// vertex where the two meshes are each other's image, otherwise along paths whose price grows with
/// the distance from the image, made fair where they part the other piece in two.
/// @param options  with a mirror plane
/// @return         empty when a path cannot be found
std::vector<SurfacePath> mirrored_cut(const CutPiece& piece, const CutPiece& other,
                                      const std::vector<SurfacePath>& cut,
                                      const CutCandidateOptions& options);

/// A path from one border of a piece to another, which makes a disc of a ring; along the mirror
/// plane, at the back, where there is one.
/// @return  empty when there is no second border
SurfacePath bridge(const CutPiece& piece, const std::optional<MirrorAxis>& mirror);

}  // namespace geoprior::sketch
