#pragma once

#include "models/paper/shell/elements.h"
#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// Plastic flow of one step: where the elastic part of the shape operator S_el = S - S_p exceeds
/// the yield curvature k_y in Frobenius norm, S_p takes the excess,
///
///   S_p += S_el (1 - k_y / |S_el|),   damage += |S_el| / k_y - 1,
///
/// so that |S_el| = k_y afterwards. The membrane does not yield: paper creases long before it
/// stretches. Source: Narain, Pfaff, O'Brien 2013, section 4, as their public code does it.
///
/// @return  triangles that yielded
int flow_plastically(const ShellElements& elements, double yield_curvature, ShellState& state);

/// Frobenius norm of a shape operator S_uu, S_uv, S_vv.
double curvature_norm(const Eigen::Vector3d& s);

}  // namespace geoprior::paper
