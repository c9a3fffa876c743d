#pragma once

namespace geoprior {

/// A number with the interval that it lies in, of 95 % unless said otherwise.
struct Interval {
  double value = 0;
  double low = 0;
  double high = 0;
};

/// Resamples of every bootstrap.
inline constexpr int kResamples = 2000;

}  // namespace geoprior
