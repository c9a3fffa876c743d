#pragma once

#include <Eigen/Core>
#include <span>

#include "core/options.h"
#include "experiments/details/drawing/drawn_details.h"
#include "models/details/surface_walk.h"

namespace geoprior::details {

/// Rays from the middle of a spike to its foot, and rings between foot and tip. Chosen for
/// pictures.
inline constexpr int kSpikeSectors = 12;
inline constexpr int kSpikeRings = 4;

enum class SpikeProfile {
  cone,  ///< straight sides
  dome,  ///< rounded: height 1 - s^2 at the share s of the radius
  thorn  ///< wide foot, thin tip, bent along the tangent direction
};
enum class WeightScales {
  size,   ///< height and radius
  height  ///< height alone
};

/// Procedural spikes: the surface displaced along the detail's normal by
/// weight x height x profile(geodesic distance / radius).
///
/// Every spike is a closed mesh of its own: points on straight rays from the anchor, so that its
/// foot lies on the surface however that is curved and however coarse; one more ring continues the
/// profile below the surface, and leaves no gap where the surface is hollow.
struct SpikeOptions {
  SpikeProfile profile = SpikeProfile::cone;
  double height = 0.8;
  double lean = 0.6;
  WeightScales weight_scales = WeightScales::size;
};
void describe(OptionVisitor& v, SpikeOptions& options);

/// @param radius, height  of a spike of weight 1 (m)
/// Those of weight below 1/1000 are not drawn.
DrawnDetails draw_spikes(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x,
                         std::span<const DrawnAnchor> anchors, const SpikeOptions& options,
                         double radius, double height);

}  // namespace geoprior::details
