#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace geoprior {

/// How quietly points move: second differences |x_{i+1} - 2 x_i + x_{i-1}| of their places over
/// frames of equal steps, given one after the other; three are kept.
///
/// Of smooth motion they fall as the step squared; points that jump by J show J once in each of
/// two frames. Rigid motion counts too. A quantile says what most points do most of the time: it
/// does not see a pop of a few points.
class SecondDifferences {
 public:
  /// @param x  places of the same points in the next frame (n x 3, m)
  void add(const Eigen::MatrixX3d& x);
  /// What the given share of all points and frames stays under (m); absent for fewer than three
  /// frames, and without points.
  [[nodiscard]] std::optional<double> quantile(int percent) const;

 private:
  std::array<Eigen::MatrixX3d, 3> x_;
  std::size_t frames_ = 0;
  std::vector<double> differences_;
};

}  // namespace geoprior
