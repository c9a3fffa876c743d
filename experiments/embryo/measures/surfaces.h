#pragma once

#include <optional>

#include "experiments/embryo/frames/recorded.h"
#include "experiments/embryo/scene/scene.h"

namespace geoprior::embryo {

/// What is measured on the surface of a day.
struct SurfaceMeasures {
  double structures = 0;       ///< with triangles
  double least_triangles = 0;  ///< of a structure; 0 without one
  double triangles = 0;        ///< of all
  double defects = 0;          ///< edges and vertices at which a piece is no closed manifold
  double not_spheres = 0;      ///< pieces whose Euler number is not 2
  double pieces = 0;           ///< connected ones
  std::optional<double> kidney_pieces;  ///< pieces with kidneys
  std::optional<double> cloaca_pieces;  ///< pieces with a cloaca or what it divides into
  std::optional<double> surface_error;  ///< from the recorded shape, over its smallest radius
  std::optional<double> overlap;        ///< m
  std::optional<double> seam_deg;       ///< deg
};

SurfaceMeasures surface_measures(const EmbryoScene& scene, const Frame& frame);

/// Largest distance of a vertex from the solid of its structure's recorded shape, over the smallest
/// radius; of structures with a piece of their own that no division cuts. Absent without any.
std::optional<double> surface_error(const EmbryoScene& scene, const Frame& frame,
                                    const std::vector<RecordedPiece>& pieces);

/// How deep a piece is in another, where the ontology declares no contact (m).
std::optional<double> undeclared_overlap(const EmbryoScene& scene,
                                         const std::vector<RecordedPiece>& pieces);

/// Angle of two triangles of different structures at a common edge (deg): root mean square over the
/// length of these edges. Absent where no piece has two structures.
std::optional<double> seam_angle(const std::vector<RecordedPiece>& pieces);

}  // namespace geoprior::embryo
