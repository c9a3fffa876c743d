#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/sketch/fabrication/fabrication.h"
#include "models/sketch/pattern/pattern.h"

namespace geoprior::sketch {

/// What a cloth simulator needs of a garment:
///
/// - `garment.obj`: the pieces as they lie on the surface, each with vertices of its own. `v` is a
///   point in space, the `vt` of the same number the same point of the flat pattern, its material
///   coordinates; both in metres at true scale, so rest lengths are distances of `vt`. A group for
///   each piece, named as in the pattern.
/// - `garment.json`: which vertices are sewn together, seam by seam, as pairs of numbers of
///   vertices (from 0); the two coincide in `garment.obj`. A vertex where several seams meet is in
///   several pairs.
///
/// @param surface  n x 3, points that the pieces' `surface_vertex` count (m)
/// @throws Error   when a piece counts a vertex that the surface does not have
std::vector<FabricationFile> cloth_files(const Pattern& pattern, const Eigen::MatrixX3d& surface);

}  // namespace geoprior::sketch
