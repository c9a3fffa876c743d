#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/embryo/motion/ease.h"

namespace geoprior::embryo {

/// What a curve does at its first and last key, and outside of its keys.
enum class Ends {
  rest,   ///< it begins and ends at rest, and stays there
  fading  ///< it goes on as it was going, by ever less: h (1 - exp(-x/h)) times the slope at
          ///< distance x, h the days between the last two keys
};

/// Values over days, through given keys: a cubic between two of them whose slopes keep each value
/// monotone wherever its keys are, with a continuous first derivative everywhere.
///
/// The slope at a key between secants d0 (over h0 days) and d1 (over h1) is 0 where they differ in
/// sign, otherwise their weighted harmonic mean
///     (w0 + w1) / (w0 / d0 + w1 / d1),  w0 = h0 + 2 h1,  w1 = 2 h0 + h1,
/// so that values on a line stay on it. Fading ends have the slope of the parabola through three
/// keys, bounded to keep its sign and three times the secant. Linear: straight between the keys,
/// constant outside; its velocity jumps at every key.
/// Source: Fritsch and Carlson 1980, "Monotone piecewise cubic interpolation"; Fritsch and Butland
/// 1984 for the mean.
class MonotoneCurve {
 public:
  MonotoneCurve() = default;
  /// @param days    ascending, one or more
  /// @param values  finite; row i at day i
  /// @throws Error  otherwise
  MonotoneCurve(std::vector<double> days, Eigen::MatrixXd values, Interpolation interpolation,
                Ends ends);

  /// All values of a day. At a key they are the key's, bit for bit.
  [[nodiscard]] Eigen::VectorXd at(double day) const;
  /// Multiplies the slopes at a key by a number from 0 to 1: the curve stays monotone.
  void damp(int key, double factor) { slopes_.row(key) *= factor; }
  /// The key that an interval with this day in it begins with; the first or the last interval for
  /// days outside, 0 for a single key.
  [[nodiscard]] int interval(double day) const;
  [[nodiscard]] const std::vector<double>& days() const { return days_; }

 private:
  [[nodiscard]] Eigen::VectorXd beyond(double day) const;

  std::vector<double> days_;
  Eigen::MatrixXd values_, slopes_;
  Interpolation interpolation_ = Interpolation::monotone;
};

}  // namespace geoprior::embryo
