#include "metrics/spacing/radial_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"

namespace geoprior {
namespace {

/// Square grid of spacing 1, a row and a column a unit, off the corner.
Eigen::MatrixX2d square_grid(int n) {
  Eigen::MatrixX2d x(n * n, 2);
  for (int k = 0; k < n * n; ++k) x.row(k) << k % n + 0.25, k / n + 0.25;
  return x;
}

Eigen::MatrixX2d independent(int count, double side, std::uint64_t seed) {
  RandomStream random(seed, "independent points");
  Eigen::MatrixX2d x(count, 2);
  for (int k = 0; k < count; ++k) {
    x(k, 0) = side * random.uniform();
    x(k, 1) = side * random.uniform();
  }
  return x;
}

/// Darts at least 1 apart in a square whose opposite sides are joined, until `count` lie.
Eigen::MatrixX2d darts(int count, double side) {
  RandomStream random(3, "darts");
  Eigen::MatrixX2d x(count, 2);
  int kept = 0;
  for (int trial = 0; trial < 200000 && kept < count; ++trial) {
    const Eigen::RowVector2d p(side * random.uniform(), side * random.uniform());
    bool is_free = true;
    for (int i = 0; i < kept && is_free; ++i) {
      const Eigen::Array2d d = (x.row(i) - p).array().abs();
      is_free = d.min(side - d).matrix().norm() >= 1;
    }
    if (is_free) x.row(kept++) = p;
  }
  EXPECT_EQ(kept, count);
  return x;
}

// All n^2 points are in phase at whole frequencies, where the power is n^2, and cancel at all
// others. Of each pair f, -f one counts: 2 at |f| = 1, 2 at sqrt 2, 2 at 2, 4 at sqrt 5, 2 at sqrt
// 8; the two axes are alike, so no axis is preferred.
TEST(RadialSpectrum, OfASquareGridHasItsSpotsAndNothingElse) {
  const int n = 20;
  RadialSpectrumOptions options;
  options.highest = 2.95;
  options.bins = 59;
  const RadialSpectrum s = radial_spectrum(square_grid(n), {0, 0}, {n, n}, 1, options);
  const double spots[][2] = {
      {1, 2}, {std::sqrt(2.), 2}, {2, 2}, {std::sqrt(5.), 4}, {std::sqrt(8.), 2}};
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(options.bins);
  for (const auto& [f, count] : spots) {
    expected(static_cast<Eigen::Index>(f / s.step + 1e-9)) += count * n * n;
  }
  for (Eigen::Index b = 0; b < expected.size(); ++b) {
    EXPECT_NEAR(s.power(b) * s.count(b), expected(b), 1e-8) << s.frequency(b);
  }
  const auto one = static_cast<Eigen::Index>(1 / s.step + 1e-9);
  EXPECT_NEAR(s.elongation(one), 0, 1e-9);
  // 2 of m frequencies have all the power: variance / mean^2 is m / 2 - 1.
  EXPECT_NEAR(s.anisotropy(one), s.count(one) / 2. - 1, 1e-6);
}

// Powers of independent points are independent exponential variables of mean 1: so is their
// variance / mean^2, and each bin's mean deviates by 1 / sqrt(count).
TEST(RadialSpectrum, OfIndependentPointsIsOne) {
  const RadialSpectrum s = radial_spectrum(independent(900, 30, 5), {0, 0}, {30, 30}, 1);
  double spread = 0;
  for (Eigen::Index b = 1; b < s.power.size(); ++b) {
    EXPECT_LT(std::abs(s.power(b) - 1) * std::sqrt(s.count(b)), 3.5) << s.frequency(b);
    spread += s.anisotropy(b) / static_cast<double>(s.power.size() - 1);
  }
  EXPECT_NEAR(spread, 1, 0.1);
  // Half the frequencies of a disk: pi 3^2 30^2 / 2, to the points of the lattice at its border.
  EXPECT_NEAR(s.count.sum(), std::numbers::pi * 9 * 900 / 2, 60);
}

// Darts at least 1 apart: little power below the ring at about 1 / spacing, 1 far above, no axis
// preferred, and the powers of a bin spread like those of independent points.
TEST(RadialSpectrum, OfAPoissonDiskPatternHasARing) {
  const Eigen::MatrixX2d x = darts(560, 30);
  const RadialSpectrum s = radial_spectrum(x, {0, 0}, {30, 30}, 1);
  EXPECT_LT(s.power.head(4).maxCoeff(), 0.2);
  Eigen::Index ring = 0;
  EXPECT_GT(s.power.maxCoeff(&ring), 1.3);
  EXPECT_NEAR(s.frequency(ring), 1.1, 0.2);
  EXPECT_NEAR(s.power.tail(5).mean(), 1, 0.1);
  EXPECT_NEAR(s.anisotropy(ring), 1, 0.4);
  EXPECT_LT(s.elongation(ring), 0.2);
}

// Stretched by 2 along x, the grid's spots at frequency 1 along x come to 1/2, those along y stay.
TEST(RadialSpectrum, OfAStretchedGridLiesAlongTheStretch) {
  const int n = 20;
  Eigen::MatrixX2d x = square_grid(n);
  const RadialSpectrum original = radial_spectrum(x, {0, 0}, {n, n}, 1);
  x.col(0) *= 2;
  const RadialSpectrum stretched = radial_spectrum(x, {0, 0}, {2 * n, n}, 1);
  EXPECT_NEAR(stretched.power(5) * stretched.count(5), n * n, 1e-8);
  EXPECT_NEAR(stretched.elongation(5), 1, 1e-9);
  EXPECT_NEAR(original.power(5), 0, 1e-9);
  EXPECT_GT(radial_spectrum_distance(original, stretched), 0.1);
  EXPECT_EQ(radial_spectrum_distance(original, original), 0);
}

// Where a pattern lies and in which unit it is given does not matter.
TEST(RadialSpectrum, DependsOnThePatternAlone) {
  const Eigen::MatrixX2d x = independent(300, 20, 8);
  const RadialSpectrum s = radial_spectrum(x, {0, 0}, {20, 20}, 1);
  const Eigen::MatrixX2d moved = (0.5 * x).rowwise() + Eigen::RowVector2d(3, -7);
  const RadialSpectrum m = radial_spectrum(moved, {3, -7}, {13, 3}, 0.5);
  EXPECT_EQ(m.count, s.count);
  EXPECT_TRUE(m.power.isApprox(s.power, 1e-9));
}

TEST(RadialSpectrum, IsTheSameForAnyNumberOfThreads) {
  const Eigen::MatrixX2d x = independent(300, 20, 8);
  RadialSpectrum one, two;
  with_threads(1, [&] { one = radial_spectrum(x, {0, 0}, {20, 20}, 1); });
  with_threads(2, [&] { two = radial_spectrum(x, {0, 0}, {20, 20}, 1); });
  EXPECT_EQ(one.power, two.power);
  EXPECT_EQ(one.anisotropy, two.anisotropy);
}

TEST(RadialSpectrum, NamesWhatIsWrong) {
  const Eigen::MatrixX2d x = square_grid(3);
  EXPECT_THROW(radial_spectrum(x, {0, 0}, {2, 3}, 1), Error);
  EXPECT_THROW(radial_spectrum(x, {0, 0}, {3, 0}, 1), Error);
  EXPECT_THROW(radial_spectrum(x, {0, 0}, {3, 3}, 0), Error);
  EXPECT_THROW(radial_spectrum(Eigen::MatrixX2d(0, 2), {0, 0}, {3, 3}, 1), Error);
  RadialSpectrumOptions options;
  options.bins = 3;
  const RadialSpectrum a = radial_spectrum(x, {0, 0}, {3, 3}, 1);
  EXPECT_THROW(radial_spectrum_distance(a, radial_spectrum(x, {0, 0}, {3, 3}, 1, options)), Error);
}

}  // namespace
}  // namespace geoprior
