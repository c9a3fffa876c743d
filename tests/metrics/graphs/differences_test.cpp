#include "metrics/graphs/differences.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using HistogramBins = std::vector<double>;
using GraphEdges = std::vector<std::array<int, 2>>;

Eigen::VectorXd spectrum_of(std::initializer_list<double> values) {
  const std::vector<double> copy(values);
  return Eigen::Map<const Eigen::VectorXd>(copy.data(), static_cast<Eigen::Index>(copy.size()));
}

TEST(HistogramDistance, ComparesShares) {
  EXPECT_EQ(histogram_distance(HistogramBins{1, 3}, HistogramBins{1, 3}), 0);
  EXPECT_EQ(histogram_distance(HistogramBins{1, 3}, HistogramBins{2, 6, 0}), 0);
  EXPECT_EQ(histogram_distance(HistogramBins{1, 0}, HistogramBins{0, 5}), 1);
  EXPECT_EQ(histogram_distance(HistogramBins{1}, HistogramBins{0, 5}), 1);
  // Shares 1/2, 1/2, 0 and 0, 1/2, 1/2: half of each is in common.
  EXPECT_DOUBLE_EQ(histogram_distance(HistogramBins{2, 2}, HistogramBins{0, 4, 4}), 0.5);
}

TEST(HistogramDistance, RefusesWhatIsNoHistogram) {
  test::expect_error(
      [] {
        (void)histogram_distance(HistogramBins{0, 0}, HistogramBins{1});
      },
      {"is empty"});
  test::expect_error([] { (void)histogram_distance(HistogramBins{1}, HistogramBins{}); },
                     {"is empty"});
  test::expect_error(
      [] {
        (void)histogram_distance(HistogramBins{1}, HistogramBins{2, -1});
      },
      {"bin 1", "negative"});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  test::expect_error([&] { (void)histogram_distance(HistogramBins{nan}, HistogramBins{1}); },
                     {"bin 0"});
}

TEST(LaplacianSpectrum, OfACompleteGraphIsZeroAndNOverNMinusOne) {
  for (const int n : {2, 3, 6}) {
    GraphEdges edges;
    for (int i = 0; i < n; ++i)
      for (int j = i + 1; j < n; ++j) edges.push_back({i, j});
    const Eigen::VectorXd spectrum = laplacian_spectrum(n, edges);
    ASSERT_EQ(spectrum.size(), n);
    EXPECT_NEAR(spectrum[0], 0, 1e-14);
    for (int i = 1; i < n; ++i) EXPECT_NEAR(spectrum[i], n / (n - 1.), 1e-14);
  }
}

TEST(LaplacianSpectrum, OfACycleIsOneMinusCosines) {
  constexpr int n = 7;
  GraphEdges edges;
  std::vector<double> expected;
  for (int k = 0; k < n; ++k) {
    edges.push_back({k, (k + 1) % n});
    expected.push_back(1 - std::cos(2 * std::numbers::pi * k / n));
  }
  std::sort(expected.begin(), expected.end());
  const Eigen::VectorXd spectrum = laplacian_spectrum(n, edges);
  for (int k = 0; k < n; ++k) EXPECT_NEAR(spectrum[k], expected[k], 1e-14);
}

TEST(LaplacianSpectrum, HasAZeroForEachPieceAndLeavesLoopsOut) {
  // Two pairs, one joined twice, with a loop, and a node alone.
  const GraphEdges edges{{0, 1}, {2, 3}, {3, 2}, {0, 0}};
  const Eigen::VectorXd spectrum = laplacian_spectrum(5, edges);
  EXPECT_TRUE(spectrum.isApprox(spectrum_of({0, 0, 0, 2, 2}), 1e-14)) << spectrum.transpose();
}

TEST(LaplacianSpectrum, NamesAnEdgeThatEndsAtNoNode) {
  test::expect_error(
      [] {
        (void)laplacian_spectrum(2, GraphEdges{{0, 1}, {1, 2}});
      },
      {"edge 1", "0 to 1"});
  test::expect_error([] { (void)laplacian_spectrum(2, GraphEdges{{-1, 1}}); }, {"edge 0"});
}

TEST(SpectralDistance, ComparesListsOfDifferentLengths) {
  EXPECT_EQ(spectral_distance(spectrum_of({0, 0.5, 2}), spectrum_of({0, 0.5, 2})), 0);
  EXPECT_EQ(spectral_distance(spectrum_of({0}), spectrum_of({0, 0})), 0);
  EXPECT_EQ(spectral_distance(spectrum_of({0}), spectrum_of({1})), 1);
  // Of {0, 2} and {0, 1, 2} the quantile functions differ by 1 from 1/3 to 1/2 and on to 2/3.
  EXPECT_NEAR(spectral_distance(spectrum_of({0, 2}), spectrum_of({0, 1, 2})), 1 / 3., 1e-15);
  EXPECT_NEAR(spectral_distance(spectrum_of({0, 1, 2}), spectrum_of({0, 2})), 1 / 3., 1e-15);
  test::expect_error([] { (void)spectral_distance(spectrum_of({}), spectrum_of({1})); },
                     {"is empty"});
}

TEST(LaplacianSpectrum, OfNoNodesIsEmpty) { EXPECT_EQ(laplacian_spectrum(0, {}).size(), 0); }

}  // namespace
}  // namespace geoprior
