#pragma once

#include <cstdint>
#include <vector>

#include "baselines/fluid/liquid_surface.h"

namespace geoprior {

/// What a node of the field finds within reach.
enum class NodeSurroundings : std::uint8_t { empty, mixed, full };

/// Looks at the cells within `reach` (in cells of the simulation) of every node of the field along
/// each axis, clipped to the domain: none of them, some or all hold particles.
std::vector<NodeSurroundings> node_surroundings(const GridShape& shape,
                                                const LiquidParticles& particles,
                                                const GridShape& field_shape, double reach);

/// Cells of one axis that reach of a place: first and one past the last, clipped to the domain.
struct CellRange {
  int begin = 0, end = 0;
};
CellRange cells_in_reach(double place, double reach, int cells);

/// The two fields of `liquid_field`, without border and smoothing.
ScalarGrid zhu_bridson_field(const GridShape& shape, const LiquidParticles& particles,
                             const LiquidSurfaceOptions& options, const GridShape& field_shape);
ScalarGrid anisotropic_field(const GridShape& shape, const LiquidParticles& particles,
                             const LiquidSurfaceOptions& options, const GridShape& field_shape);

}  // namespace geoprior
