#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace geoprior {

/// Root mean square angle between the rulings of a reconstruction and the generators of the cone
/// that it ought to be (rad): of each ruling the angle to the line from its middle to the apex,
/// without sense, 0 to pi / 2.
///
/// Says nothing of where along its generator a ruling lies, nor of how far the surface is from the
/// cone. Rulings without length are left out.
///
/// @param rulings  both ends of each (m)
/// @param shift    added to the middle of each: what the reconstruction cannot know of its place
/// @return         nothing without a ruling
std::optional<double> ruling_angle_rms(const std::vector<std::array<Eigen::Vector3d, 2>>& rulings,
                                       const Eigen::Vector3d& apex, const Eigen::Vector3d& shift);

}  // namespace geoprior
