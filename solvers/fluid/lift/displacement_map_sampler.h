#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/fluid/feature.h"

namespace geoprior::fluid {

/// Displacements times alpha of a differential feature at one source time, to be looked up.
///
/// Cubic (Catmull-Rom) in space and, between frames of the feature, in time: no correspondence is
/// needed, and neither slopes nor speeds jump. Outside the map everything is 0.
class DisplacementSampler {
 public:
  using Value = Eigen::Array4d;  ///< alpha d (m, in the feature's axes), alpha
  using Texel = Eigen::Array4f;

  DisplacementSampler(const Feature& feature, double source_time);

  /// @param uv  in the moving frame, before any edit (m)
  [[nodiscard]] Value at(const Eigen::Vector2d& uv) const;
  /// False when nothing of the map lies in a box of the moving frame, a texel around it included.
  [[nodiscard]] bool occupied(const Eigen::Vector2d& low, const Eigen::Vector2d& high) const;
  /// Smallest det(I + grad(fade alpha d)) in the map's plane, over texels with alpha > 0.
  [[nodiscard]] double min_jacobian(double fade) const;
  [[nodiscard]] double texel() const { return extent_ / resolution_; }
  [[nodiscard]] double extent() const { return extent_; }

 private:
  [[nodiscard]] std::size_t padded(int i, int j) const {
    return static_cast<std::size_t>(j + kPad) * (resolution_ + 2 * kPad) + (i + kPad);
  }
  void blend(const Feature& feature, double source_time);
  void count_occupied();

  static constexpr int kPad = 3;
  int resolution_;
  double extent_;
  std::vector<Texel> texels_;  ///< with kPad zero texels around
  std::vector<int> table_;     ///< occupied texels below and left of each (N + 1 squared)
};

}  // namespace geoprior::fluid
