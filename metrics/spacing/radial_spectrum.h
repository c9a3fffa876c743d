#pragma once

#include <Eigen/Core>

namespace geoprior {

/// Frequencies are in cycles per unit, the unit being the spacing given.
struct RadialSpectrumOptions {
  double highest = 3;  ///< frequency
  int bins = 30;       ///< equal intervals of frequency
};

/// Power of a planar point pattern by frequency. Independent points have power 1 and spread 1
/// everywhere; patterns with a least distance have little power at low frequencies and a ring near
/// 1 / spacing; a grid has spots.
struct RadialSpectrum {
  Eigen::VectorXd frequency;   ///< middles of the bins
  Eigen::VectorXd power;       ///< mean over the directions; 0 in a bin without frequencies
  Eigen::VectorXd anisotropy;  ///< variance of the power over the directions / mean^2 (Ulichney
                               ///< 1987, who gives 10 log10 of it); 0 where there is no power
  /// |sum P exp(2 i angle)| / sum P: 0 when no axis is preferred, 1 when all power lies along one.
  /// A pattern that is stretched along an axis has it, a grid has not.
  Eigen::VectorXd elongation;
  Eigen::VectorXi count;  ///< frequencies of a bin; f and -f are one
  double step = 0;        ///< width of a bin
};

/// Periodogram P(f) = |sum_j exp(-2 pi i f . x_j)|^2 / n at the frequencies f = (k / width,
/// l / height) other than 0, averaged over rings.
///
/// At these frequencies the transform of the rectangle itself vanishes, so that neither the mean
/// nor the rectangle shows, and no window is needed. It takes the pattern as one that repeats:
/// where opposite borders do not fit, a pattern's spots and rings leak into their neighbourhood;
/// compare patterns of one rectangle.
///
/// Cost: points x frequencies, which is about pi / 2 x points x (highest x width / unit) x (highest
/// x height / unit). The same bytes for any number of threads.
///
/// @param points  n x 2 (m)
/// @param low     corner of the rectangle (m)
/// @param high    opposite corner (m)
/// @param unit    spacing (m): that of the original pattern
/// @throws Error  on no points, a point outside the rectangle (names it), an empty rectangle, or a
///                unit or options that are not positive
RadialSpectrum radial_spectrum(const Eigen::MatrixX2d& points, const Eigen::Vector2d& low,
                               const Eigen::Vector2d& high, double unit,
                               const RadialSpectrumOptions& options = {});

/// Integral of |P_a - P_b| over the frequency.
/// @throws Error  when they have different bins
double radial_spectrum_distance(const RadialSpectrum& a, const RadialSpectrum& b);

/// Mean elongation over the frequencies below `highest` (middles of bins): how much one axis is
/// preferred by the spacings that a pattern keeps.
/// @throws Error  without such frequencies
double mean_elongation(const RadialSpectrum& spectrum, double highest);

}  // namespace geoprior
