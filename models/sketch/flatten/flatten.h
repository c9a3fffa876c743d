#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "core/options.h"
#include "models/sketch/flatten/rigid_layout.h"

namespace geoprior::sketch {

struct FlattenOptions {
  int iterations = 300;
  double tolerance = 1e-9;
  int mixing = 6;
  bool unflip = true;
};
void describe(OptionVisitor& v, FlattenOptions& options);

/// How a piece was laid flat and what is wrong with it.
struct FlattenReport {
  int iterations = 0;          ///< of as-rigid-as-possible
  int flipped_at_first = 0;    ///< triangles turned over in the conformal start
  int flipped_when_rigid = 0;  ///< … after as-rigid-as-possible
  int unflip_iterations = 0;   ///< Newton steps that replaced it; 0: they were not needed
  double length_error = 0;     ///< largest of kept lengths, relative
  double strain = 0;           ///< root mean square of |J - R| over the area: 0 for an isometry
  std::vector<int> flipped;    ///< triangles turned over in the result
  std::vector<std::array<int, 2>> overlaps;  ///< pairs of triangles that cover a common area
};

struct Flattening {
  Eigen::MatrixX2d points;  ///< n x 2, true scale, about the centre of area (m)
  FlattenReport report;
};

/// Lays a piece of surface flat with its lengths kept as well as they can be, at true scale.
///
/// 1. The spectral conformal map, scaled to the surface's area: what is developable is isometric
///    already (`spectral_conformal_map`).
/// 2. As-rigid-as-possible from there: local turns and one prefactored global system
///    (`RigidLayout`).
/// 3. When triangles are turned over in the result: the conformal map, or where that has turned
///    triangles over too a convex layout, and from it the symmetric Dirichlet energy, which turns
///    none over (`lower_symmetric_dirichlet`).
///
/// A piece with several borders (an annulus) is laid flat as it is: well around a hole in something
/// flat, badly for a tube, which has to be cut open first (`shortest_cut`). Far parts of a piece
/// may come to lie over each other, which is reported and not mended. Serial; the same bytes
/// whatever runs beside it.
///
/// @param piece   connected, of genus 0, with a border, every vertex in a triangle; of length m
/// @throws Error  on a piece without triangles, without border or with a handle, and on a triangle
///                whose corners coincide (names it)
/// Source: Liu et al. 2008; Mullen et al. 2008; Smith and Schaefer 2015.
Flattening flatten(const TriMesh& piece, const FlattenOptions& options = {});

/// Brings parts of the border to given lengths at the cost of what is beside them: the two sides of
/// a seam have to be equally long, on a surface that is not quite developable too. Where that would
/// turn triangles over or make them overlap the layout stays as it is, and its report says by how
/// much lengths are off (`length_error`).
void hold_lengths(const TriMesh& piece, std::span<const KeptLength> kept,
                  const FlattenOptions& options, Flattening& flat);

}  // namespace geoprior::sketch
