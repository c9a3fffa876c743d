#include "metrics/spacing/pair_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "tests/metrics/sampled_surfaces.h"
#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

using sampled::on_cells;
using std::numbers::pi;
using Places = std::vector<SurfacePoint>;

/// 30 x 30 units in cells of different size and shape; density 1 has 900 points.
TriMesh border_sheet() { return sampled::sheet(30, 30, 25, 25, 0.3); }

/// Mean of |g - 1| / error over the radii: sqrt(2 / pi) = 0.80 for normal deviations.
double mean_deviation(const PairCurve& curve) {
  return ((curve.g.array() - 1).abs() / curve.error.array()).mean();
}

/// Independent points of density 1 have g = 1 at all radii: each of `seeds` curves deviates as its
/// standard error says, their mean (a bias would stay) by sqrt(seeds) less.
void expect_one_for_independent_points(const TriMesh& mesh, int seeds) {
  const int count = static_cast<int>(std::lround(triangle_areas(mesh.V, mesh.F).sum()));
  Eigen::VectorXd mean, error;
  double deviation = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const PairCurve curve =
        pair_curve(mesh, sampled::uniform(mesh, count, static_cast<std::uint64_t>(seed)), 1);
    ASSERT_EQ(curve.sources, count);
    deviation += mean_deviation(curve) / seeds;
    if (seed == 0) mean.setZero(curve.g.size());
    mean += curve.g / seeds;
    error = curve.error;
  }
  EXPECT_NEAR(deviation, std::sqrt(2 / pi), 0.2);
  EXPECT_LT(((mean.array() - 1).abs() / error.array()).maxCoeff(), 3.5 / std::sqrt(seeds));
}

TEST(PairCurve, IsOneForIndependentPointsOnASheetWithABorder) {
  expect_one_for_independent_points(border_sheet(), 8);
}

// Radius 5: the annulus at r = 3 is sin(0.6) / 0.6 = 0.94 of the planar one.
TEST(PairCurve, IsOneForIndependentPointsOnASphere) {
  expect_one_for_independent_points(shapes::sphere(5, {0, 0, 0}, 4), 12);
}

// Curved either way; the tube's circumference is 15.7, farther than the distances measured.
TEST(PairCurve, IsOneForIndependentPointsOnATorus) {
  expect_one_for_independent_points(shapes::torus(7, 2.5, 80, 30), 8);
}

/// A hexagonal grid of constant 1 on a strip `columns` around and `rows` of it high, stretched.
struct HexagonalGrid {
  TriMesh mesh;
  Places places;
};
HexagonalGrid hexagonal_grid(int columns, int rows, double stretch) {
  const double rise = std::sqrt(0.75), around = columns, height = rows * rise * stretch;
  const int n = 37, m = 29;  // so that triangles do not repeat with the grid
  HexagonalGrid grid{sampled::prism(around, height, n, m), {}};
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      grid.places.push_back(on_cells(i + 0.25 + 0.5 * (j % 2), (j + 0.5) * rise * stretch,
                                     around / n, height / m, n, m));
    }
  }
  return grid;
}

/// Gaussian-smoothed pair correlation of a grid of density rho with `count` neighbours at distance
/// `at`, ...: sum count k(r - at) / (rho integral of k(r - t) 2 pi t dt).
struct Shell {
  double at;
  int count;
};
double grid_curve(double r, double sigma, double rho, const std::vector<Shell>& shells) {
  const auto gauss = [](double z) { return std::exp(-z * z / 2) / std::sqrt(2 * pi); };
  double sum = 0;
  for (const Shell& s : shells) sum += s.count * gauss((r - s.at) / sigma) / sigma;
  const double below = std::erfc(-r / sigma / std::sqrt(2)) / 2;
  return sum / (rho * 2 * pi * (r * below + sigma * gauss(r / sigma)));
}

// Neighbours of the hexagonal grid: 6 at 1, 6 at sqrt 3, 6 at 2, 12 at sqrt 7, 6 at 3, 6 at sqrt
// 12, 12 at sqrt 13, 6 at 4, 12 at sqrt 19, 12 at sqrt 21.
TEST(PairCurve, OfAHexagonalGridAroundAPrismIsThatOfTheGrid) {
  const HexagonalGrid grid = hexagonal_grid(40, 40, 1);
  const PairCurve curve = pair_curve(grid.mesh, grid.places, 1);
  const std::vector<Shell> shells{{1, 6},
                                  {std::sqrt(3.), 6},
                                  {2, 6},
                                  {std::sqrt(7.), 12},
                                  {3, 6},
                                  {std::sqrt(12.), 6},
                                  {std::sqrt(13.), 12},
                                  {4, 6},
                                  {std::sqrt(19.), 12},
                                  {std::sqrt(21.), 12}};
  for (Eigen::Index k = 0; k < curve.g.size(); ++k) {
    const double expected = grid_curve(curve.radius(k), 0.1, 1 / std::sqrt(0.75), shells);
    EXPECT_NEAR(curve.g(k), expected, 0.02 + 0.02 * expected) << "r " << curve.radius(k);
  }
}

// Neighbours of the square grid: 4 at 1, 4 at sqrt 2, 4 at 2, 8 at sqrt 5, 4 at sqrt 8, 4 at 3, 8
// at sqrt 10. Away from the border they lie there, and the border itself must not show.
TEST(PairCurve, OfASquareGridOnASheetHasItsPeaks) {
  const int n = 40;
  Places places;
  for (int k = 0; k < n * n; ++k) {
    places.push_back(on_cells(k % n + 0.5, k / n + 0.5, n / 33., n / 33., 33, 33));
  }
  PairCurveOptions options;
  options.reach = 3.2;
  options.bins = 64;
  options.bandwidth = 0.05;
  const PairCurve curve = pair_curve(sampled::sheet(n, n, 33, 33, 0), places, 1, options);
  const std::vector<Shell> shells{{1, 4},
                                  {std::sqrt(2.), 4},
                                  {2, 4},
                                  {std::sqrt(5.), 8},
                                  {std::sqrt(8.), 4},
                                  {3, 4},
                                  {std::sqrt(10.), 8},
                                  {std::sqrt(13.), 8}};
  for (Eigen::Index k = 0; k < curve.g.size(); ++k) {
    const double expected = grid_curve(curve.radius(k), 0.05, 1, shells);
    EXPECT_NEAR(curve.g(k), expected, 0.02 + 0.03 * expected) << "r " << curve.radius(k);
  }
}

/// Uniform places, each at least `least` from those before, until `count` are there.
template <class Distance>
Places darts(const UnfoldedSurface& surface, int count, double least, const Distance& distance) {
  sampled::UniformPlaces uniform(surface.mesh(), 4);
  Places kept;
  for (int trial = 0; trial < 200000 && std::ssize(kept) < count; ++trial) {
    const SurfacePoint place = uniform.next();
    bool is_free = true;
    for (const SurfacePoint& other : kept) {
      is_free = is_free && distance(surface.position(place), surface.position(other)) >= least;
    }
    if (is_free) kept.push_back(place);
  }
  EXPECT_EQ(static_cast<int>(kept.size()), count);
  return kept;
}

/// g of a Poisson-disk pattern of radius 1 is 0 below it, jumps above 1 there and ends at 1.
void expect_disk_of_radius_one(const PairCurve& curve) {
  double peak = 0, at = 0;
  for (Eigen::Index k = 0; k < curve.g.size(); ++k) {
    const double r = curve.radius(k);
    // Four bandwidths below, and 2 % for the distances.
    if (r < 0.58) {
      EXPECT_EQ(curve.g(k), 0);
    }
    if (curve.g(k) > peak) {
      peak = curve.g(k);
      at = r;
    }
    if (r > 2.5) {
      EXPECT_LT(std::abs(curve.g(k) - 1), 5 * curve.error(k));
    }
  }
  EXPECT_GT(peak, 1.2);
  EXPECT_NEAR(at, 1.1, 0.1);
}

TEST(PairCurve, OfAPoissonDiskPatternIsZeroBelowItsRadius) {
  const auto chord = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - b).norm();
  };
  const UnfoldedSurface sheet(border_sheet());
  expect_disk_of_radius_one(pair_curve(sheet.mesh(), darts(sheet, 560, 1, chord), 1));
  const auto angle = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return 8 * std::atan2(a.cross(b).norm(), a.dot(b));
  };
  const UnfoldedSurface sphere(shapes::sphere(8, {0, 0, 0}, 4));
  expect_disk_of_radius_one(pair_curve(sphere.mesh(), darts(sphere, 500, 1, angle), 1));
}

// Thomas process: parents of density kappa, each with children spread by a Gaussian of deviation s.
// g = 1 + exp(-r^2 / (4 s^2)) / (4 pi s^2 kappa).
TEST(PairCurve, OfThomasClustersIsKnown) {
  const double s = 0.6, kappa = 0.25, margin = 3;
  const int n = 20;
  const TriMesh mesh = sampled::sheet(30, 30, n, n, 0);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(30);
  PairCurve curve;
  const int seeds = 12;
  for (int seed = 0; seed < seeds; ++seed) {
    RandomStream random(static_cast<std::uint64_t>(seed), "thomas");
    Places places;
    const double side = 30 + 2 * margin;
    for (int parent = 0; parent < static_cast<int>(kappa * side * side); ++parent) {
      const double x = side * random.uniform() - margin, y = side * random.uniform() - margin;
      // Poisson number of children of mean 4 (Knuth: uniforms multiplied until below exp(-4)).
      for (double p = random.uniform(); p > std::exp(-4.); p *= random.uniform()) {
        const double u = x + s * random.normal(), v = y + s * random.normal();
        if (u > 0 && v > 0 && u < 30 && v < 30) {
          places.push_back(on_cells(u, v, 30.0 / n, 30.0 / n, n, n));
        }
      }
    }
    curve = pair_curve(mesh, places, 1);
    mean += curve.g / seeds;
  }
  for (Eigen::Index k = 3; k < mean.size(); ++k) {
    const double r = curve.radius(k);
    const double g = 1 + std::exp(-r * r / (4 * s * s)) / (4 * pi * s * s * kappa);
    EXPECT_NEAR(mean(k), g, 0.05 * g) << "r " << r;
  }
}

// Twice as long with the same spacing: the same curve, but for the borders. Stretched by 2: not.
TEST(PairCurve, IsThatOfTheSpacingAndNotOfTheSize) {
  const auto curve = [](int rows, double stretch) {
    const HexagonalGrid grid = hexagonal_grid(30, rows, stretch);
    return pair_curve(grid.mesh, grid.places, 1);
  };
  const PairCurve original = curve(30, 1);
  EXPECT_LT(pair_curve_distance(original, curve(60, 1)), 0.05);
  EXPECT_GT(pair_curve_distance(original, curve(30, 2)), 1);
  EXPECT_EQ(pair_curve_distance(original, original), 0);
}

TEST(PairCurve, CountsWhatTheMaskSays) {
  const TriMesh mesh = border_sheet();
  const Places places = sampled::uniform(mesh, 600, 2);
  std::vector<double> weights, halves(places.size(), 0.5);
  Places visible;
  for (std::size_t i = 0; i < places.size(); ++i) {
    weights.push_back(i % 3 == 0 ? 0 : 1);
    if (i % 3 != 0) visible.push_back(places[i]);
  }
  const PairCurve masked = pair_curve(mesh, places, 1, {}, {weights, {}});
  const PairCurve alone = pair_curve(mesh, visible, 1);
  EXPECT_EQ(masked.g, alone.g);
  EXPECT_EQ(masked.error, alone.error);
  const PairCurve all = pair_curve(mesh, places, 1);
  const PairCurve scaled = pair_curve(mesh, places, 1, {}, {halves, {}});
  EXPECT_TRUE(scaled.g.isApprox(all.g, 1e-12));
  EXPECT_TRUE(scaled.error.isApprox(all.error, 1e-12));
}

// Independent points on one half: 1 within that half; twice as many as expected nearby when the
// whole sheet counts.
TEST(PairCurve, OfAPatternOnAPartIsMeasuredInThatPart) {
  const TriMesh mesh = sampled::sheet(30, 30, 30, 30, 0);
  std::vector<char> region;
  for (int f = 0; f < mesh.triangle_count(); ++f) region.push_back((f / 2) % 30 < 15 ? 1 : 0);
  Places places;
  for (const SurfacePoint& p : sampled::uniform(mesh, 2000, 9)) {
    if (region[p.face] != 0) places.push_back(p);
  }
  const PairCurve part = pair_curve(mesh, places, 1, {}, {{}, region});
  EXPECT_LT(((part.g.array() - 1).abs() / part.error.array()).maxCoeff(), 4);
  EXPECT_NEAR(pair_curve(mesh, places, 1).g(9), 2, 0.15);
}

TEST(PairCurve, OfSomeSourcesIsThatOfAllWithinItsError) {
  const TriMesh mesh = border_sheet();
  const Places places = sampled::uniform(mesh, 900, 21);
  PairCurveOptions options;
  options.sources = 300;
  const PairCurve some = pair_curve(mesh, places, 1, options), all = pair_curve(mesh, places, 1);
  EXPECT_EQ(some.sources, 300);
  EXPECT_LT(((some.g - all.g).array().abs() / some.error.array()).maxCoeff(), 4);
  // A third of the sources: half the pairs are lost that are seen twice by all.
  EXPECT_NEAR(some.error(20) / all.error(20), std::sqrt(3 * (4. / 3) / 2), 0.05);
}

TEST(PairCurve, IsTheSameForAnyNumberOfThreads) {
  const TriMesh mesh = border_sheet();
  const Places places = sampled::uniform(mesh, 500, 1);
  PairCurve one, two;
  with_threads(1, [&] { one = pair_curve(mesh, places, 1); });
  with_threads(2, [&] { two = pair_curve(mesh, places, 1); });
  EXPECT_EQ(one.g, two.g);
  EXPECT_EQ(one.error, two.error);
}

// Curves of two independent Poisson patterns differ by normal deviations of variance 2 error^2:
// the mean of |difference| is 2 error / sqrt(pi), which the noise floor integrates over r.
TEST(PairCurveNoise, OfIndependentPointsIsThatOfTheirErrors) {
  const TriMesh mesh = border_sheet();
  std::vector<PairCurve> curves;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    curves.push_back(pair_curve(mesh, sampled::uniform(mesh, 900, 30 + seed), 1));
  }
  const PairNoise noise = pair_curve_noise(curves);
  const double expected = curves[0].step * 2 / std::sqrt(pi) * curves[0].error.sum();
  EXPECT_NEAR(noise.mean, expected, 0.2 * expected);
  EXPECT_GE(noise.largest, noise.mean);
  EXPECT_LT(noise.largest, 2 * noise.mean);
}

TEST(PairCurve, NamesWhatIsWrong) {
  const TriMesh mesh = sampled::sheet(1, 1, 2, 2, 0);
  const Places places = sampled::uniform(mesh, 4, 1);
  EXPECT_THROW(pair_curve(mesh, places, 0), Error);
  EXPECT_THROW(pair_curve(mesh, Places{places[0]}, 1), Error);
  EXPECT_THROW(pair_curve(mesh, Places{{0, {1, 0, 0}}, {9, {1, 0, 0}}}, 1), Error);
  const std::vector<double> few{1}, negative{1, 1, -1, 1}, alone{1, 0, 0, 0};
  EXPECT_THROW(pair_curve(mesh, places, 1, {}, {few, {}}), Error);
  EXPECT_THROW(pair_curve(mesh, places, 1, {}, {negative, {}}), Error);
  EXPECT_THROW(pair_curve(mesh, places, 1, {}, {alone, {}}), Error);
  const std::vector<char> flags{1};
  EXPECT_THROW(pair_curve(mesh, places, 1, {}, {{}, flags}), Error);
  PairCurveOptions options;
  options.bins = 0;
  EXPECT_THROW(pair_curve(mesh, places, 1, options), Error);
  options.bins = 20;
  const PairCurve a = pair_curve(mesh, places, 1), b = pair_curve(mesh, places, 1, options);
  EXPECT_THROW(pair_curve_distance(a, b), Error);
  EXPECT_THROW(pair_curve_noise(std::vector<PairCurve>{a}), Error);
}

}  // namespace
}  // namespace geoprior
