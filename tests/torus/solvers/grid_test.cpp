#include "solvers/torus/grid/grid.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "solvers/torus/exact/exact.h"
#include "solvers/torus/grid/grid_rows.h"
#include "tests/support/recording.h"
#include "tests/torus/torus_inputs.h"

namespace geoprior::torus {
namespace {

/// Largest distance of a grid's points to those of the exact mode after the last corrugation, in
/// its first 16 rows.
double distance_to_exact(const TorusInput& input, int n) {
  const int corrugations = static_cast<int>(input.corrugations.size()), rows = 16;
  std::vector<GridRows> stages(corrugations + 1);
  BadNode bad;
  corrugate_band(input, n, 0, rows, stages, bad);
  EXPECT_LT(bad.corrugation, 0);
  Eigen::MatrixX2d at(n * rows, 2);
  for (int r = 0; r < rows; ++r)
    for (int i = 0; i < n; ++i) at.row(r * n + i) << double(i) / n, double(r) / n;
  const Eigen::MatrixX3d exact = exact_points(input, corrugations, at, false).points;
  double largest = 0;
  for (int r = 0; r < rows; ++r)
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < 3; ++c)
        largest = std::max(largest, std::abs(stages.back().row(c, r)[i] - exact(r * n + i, c)));
  return largest;
}

TEST(Grid, ConvergesToTheExactModeWithFourthOrder) {
  const TorusInput input = published_input({4, 12, 36});
  const double coarse = distance_to_exact(input, 1000), fine = distance_to_exact(input, 2000);
  EXPECT_NEAR(std::log2(coarse / fine), 4, 0.5);
  EXPECT_LT(fine, 1e-5);
}

TEST(Grid, BandsAreThoseOfTheWhole) {
  const TorusInput input = published_input({4, 12, 36});
  const int n = 200;
  std::vector<GridRows> whole(4), band(4);
  BadNode bad;
  corrugate_band(input, n, 0, n, whole, bad);
  corrugate_band(input, n, 64, 128, band, bad);
  for (int r = 64; r < 128; ++r)
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(whole[3].row(c, r)[i], band[3].row(c, r)[i]);
}

TEST(Grid, FramesAreTheSameAtAnyNumberOfThreads) {
  TorusInput input = published_input({4, 12, 36});
  input.sampling.surface = 40;
  input.sampling.windows = 8;
  std::array<test::Recording, 2> runs;
  for (const int threads : {1, 2})
    with_threads(threads, [&] {
      RunContext context;
      make_grid_torus(input, {.points = 300})->run(runs[threads - 1], context, std::nullopt);
    });
  ASSERT_EQ(runs[0].frames.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    for (const auto& [name, part] : runs[0].frames[i].parts)
      EXPECT_EQ(part.points, runs[1].frames[i].require_part(name).points) << i << " " << name;
}

}  // namespace
}  // namespace geoprior::torus
