#pragma once

#include <cstdint>
#include <vector>

#include "baselines/fluid/liquid/grid/mac_grid.h"
#include "baselines/fluid/liquid/particles/particles.h"
#include "baselines/fluid/liquid/surface/options.h"

namespace geoprior::fluid {

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

/// What a kernel measures near a flat surface of liquid that fills a half space, turned into the
/// distance to it. Kernels are (1 - r^2)^3 over a radius of 1.
///
/// A measure that levels off inside the liquid would draw the linear interpolation of a contour
/// inwards, by a tenth of a cell; the distance does not.
class FlatSurfaceProfile {
 public:
  enum class Measure {
    mean_offset,  ///< |xbar - x|: 1 far outside, 0 inside
    density,      ///< 0 outside, 1 inside
  };
  explicit FlatSurfaceProfile(Measure measure);
  /// Distance over the kernel's radius, negative inside, never under -kDeepest: deeper down, noise
  /// of the particles is larger than the measure.
  [[nodiscard]] float distance(float measured) const;
  static constexpr float kDeepest = 0.5F;

 private:
  std::vector<float> distance_;  ///< at equal steps of the measure from 0 to 1
};

/// The two fields of `liquid_field`, without border and smoothing.
ScalarGrid zhu_bridson_field(const GridShape& shape, const LiquidParticles& particles,
                             const LiquidSurfaceOptions& options, const GridShape& field_shape);
ScalarGrid anisotropic_field(const GridShape& shape, const LiquidParticles& particles,
                             const LiquidSurfaceOptions& options, const GridShape& field_shape);

}  // namespace geoprior::fluid
