#include "solvers/sketch/pattern/slide_seams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/connectivity.h"
#include "solvers/sketch/pattern/fair_seams.h"
#include "tests/sketch/pattern/flat_surfaces.h"

namespace geoprior::sketch {
namespace {

constexpr int kCells = 24;

/// Of a cell of the plan, how far out it is: 0 in the middle, 1 at the border.
double outwards(const Eigen::RowVector3d& x) { return std::max(std::abs(x.x()), std::abs(x.y())); }

/// A square, flat in its inner half, from whose rim it falls by `slope` to all four sides.
TriMesh mesa(double slope) {
  return flats::grid(kCells, kCells, [slope](int i, int j) {
    const Eigen::Vector3d x(2.0 * i / kCells - 1, 2.0 * j / kCells - 1, 0);
    return Eigen::Vector3d(x.x(), x.y(), -slope * std::max(0.0, outwards(x.transpose()) - 0.5));
  });
}

/// A seam along the rim.
std::vector<SeamEdge> rim(const TriMesh& mesh) {
  std::vector<SeamEdge> seam;
  const auto on_rim = [&](int v) { return std::abs(outwards(mesh.V.row(v)) - 0.5) < 1e-9; };
  const EdgeConnectivity edges(mesh.F);
  for (const Edge& e : edges.edges()) {
    const Eigen::RowVector3d middle = (mesh.V.row(e[0]) + mesh.V.row(e[1])) / 2;
    if (on_rim(e[0]) && on_rim(e[1]) && std::abs(outwards(middle) - 0.5) < 1e-9)
      seam.push_back({e, 3});
  }
  return seam;
}

double moved(const TriMesh& mesh, const TriMesh& to) {
  return (to.V - mesh.V).rowwise().norm().maxCoeff();
}

TEST(SlideSeams, RoundsTheCornersOfASeamOnSomethingFlat) {
  const TriMesh flat = mesa(0);
  EXPECT_GT(moved(flat, slide_seams(flat, rim(flat), {}, {}, {})), 0.02);
}

// What slides off the rim of something bent cuts the rim off.
TEST(SlideSeams, LeavesASeamOnASharpEdge) {
  const TriMesh bent = mesa(1);
  const std::vector<SeamEdge> seam = rim(bent);
  ASSERT_EQ(seam.size(), 4U * kCells / 2);
  EXPECT_GT(moved(bent, fair_seams(bent, seam, {})), 0.02) << "it would slide";
  EXPECT_EQ(moved(bent, slide_seams(bent, seam, {}, {}, {})), 0);
  EXPECT_GT(moved(bent, slide_seams(bent, seam, {}, {.share = 0}, {})), 0.02)
      << "nothing of the pattern need be right";
}

}  // namespace
}  // namespace geoprior::sketch
