#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"
#include "models/paper/tear/tip_pull.h"

namespace geoprior::paper {

/// Where the border of a hole is stretched most.
struct HoopPeak {
  Eigen::Vector2d place;  ///< on the border, at a corner or between two (m)
  double tension = 0;     ///< along the border (N/m), averaged
  int vertex = 0;         ///< of the mesh on the border, the nearest
};

/// The place of a hole's border with the greatest tension along the border, above 0.
///
/// A triangle at the border has one tension along its edge; what a polygon makes of that at its
/// corners is no property of the hole. So tensions are averaged over half the hole's outline, those
/// near a place counting more: T(s) = integral of t(s') w(s' - s) ds', w a raised cosine of a
/// quarter of the outline to either side. T has no corners, and where it is greatest does not
/// depend on where the edges end. It is looked for in 720 places. A pattern of two waves around the
/// hole, which a pull has (Kirsch 1898), keeps its place and half of its height over the mean
/// exactly; the mean stays.
///
/// What it cannot do: tell a sharp corner of a hole from one of its polygon.
///
/// @param loop  of the hole; edges of the mesh with both ends on it are its border
/// @return      absent when it is nowhere under tension, or the mesh has no such edges
std::optional<HoopPeak> greatest_hoop_tension(const Sheet& sheet, const ShellState& state,
                                              const MeshNeighbours& neighbours,
                                              const std::vector<Eigen::Vector2d>& loop);

}  // namespace geoprior::paper
