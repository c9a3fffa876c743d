#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "models/embryo/motion/monotone.h"
#include "models/embryo/shape/curve.h"

namespace geoprior::embryo {

/// A way through key places: the curve of models/embryo/shape/curve.h, followed by the length of
/// its arc at a pace that is monotone, so that what moves never turns back between two keys, and
/// begins and ends at rest.
///
/// The velocity is continuous, since the tangent and the pace are. Where the keys turn by an angle
/// t the pace is slowed by max(cos t, 0): at a right angle or more the motion comes to rest, as it
/// must where it goes back the way that it came and the tangent turns over. Linear: straight from
/// key to key at an even pace.
class KeyPath {
 public:
  KeyPath() = default;
  /// @param days    ascending, one or more
  /// @param places  of the days, of any unit; equal neighbours are a stay
  /// @throws Error  otherwise, or on a number that is not finite
  KeyPath(std::vector<double> days, std::vector<Eigen::Vector3d> places,
          Interpolation interpolation);

  /// At the first and the last key's place before and after them.
  [[nodiscard]] Eigen::Vector3d at(double day) const;

 private:
  std::vector<Eigen::Vector3d> places_;
  std::vector<int> span_;  ///< of each interval of keys: the curve's; -1: a stay
  std::optional<Curve> curve_;
  MonotoneCurve pace_;  ///< fraction of the arc; the places themselves where motion is linear
  Interpolation interpolation_ = Interpolation::monotone;
};

}  // namespace geoprior::embryo
