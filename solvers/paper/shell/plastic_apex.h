#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"
#include "solvers/paper/sheet/structure.h"

namespace geoprior::paper {

/// Plastic yielding at singular points: what keeps a crease where it once was.
///
/// The curvature of a cone grows towards its apex as 1 / r, but a triangle of the coarse mesh only
/// knows its mean. From a triangle with one corner at the apex and elastic curvature S at its
/// centroid, at distance R, the curvature within r_p is S R / r_p. Where that exceeds the yield
/// curvature, the excess e = 1 - yield / (|S| R / r_p) becomes plastic in the share of the
/// triangle's bending energy that lies within r_p: the energy of a cone is the same in every octave
/// of r, from the thickness h outwards, so the share is ln(r_p / h) / ln(R / h).
/// The point's weakening w grows by e, and the damage of the triangle so that its energy falls by
/// 1 / (1 + w) within r_p, if the material weakens at all.
void yield_at_apexes(const PaperMaterial& material, double radius,
                     const std::vector<int>& singular_vertices, const Eigen::MatrixX3d& curvature,
                     ShellState& state, PaperStructure& structure);

}  // namespace geoprior::paper
