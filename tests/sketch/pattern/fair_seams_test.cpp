#include "solvers/sketch/pattern/fair_seams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "metrics/developability/line_turning.h"
#include "solvers/sketch/pattern/level_lines.h"
#include "solvers/sketch/pattern/slope_parts.h"
#include "tests/sketch/pattern/flat_surfaces.h"

namespace geoprior::sketch {
namespace {

constexpr double kPi = std::numbers::pi;

TriMesh unit_square(int cells) {
  return flats::grid(cells, cells, [cells](int i, int j) {
    return Eigen::Vector3d(1.0 * i / cells, 1.0 * j / cells, 0);
  });
}

TEST(LevelLines, OfALinearValueIsStraight) {
  const TriMesh square = unit_square(12);
  const Eigen::VectorXd value = square.V.col(0) + 0.3 * square.V.col(1) -
                                Eigen::VectorXd::Constant(square.vertex_count(), 0.61);
  const auto lines = level_lines(square, value, 0.1);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].front().is_vertex() && lines[0].back().is_vertex()) << "at the border";
  for (std::size_t i = 1; i + 1 < lines[0].size(); ++i) {
    const Eigen::RowVector3d x = lines[0][i].position(square.V);
    EXPECT_NEAR(x.x() + 0.3 * x.y(), 0.61, 1e-3);
  }
}

TEST(LevelLines, AroundADiscIsItsCircle) {
  const TriMesh square = unit_square(40);
  const Eigen::VectorXd value =
      0.3 - (square.V.rowwise() - Eigen::RowVector3d(0.5, 0.5, 0)).rowwise().norm().array();
  const auto lines = level_lines(square, value, 0.1);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(length(lines[0], square.V), 2 * kPi * 0.3, 0.01);
  EXPECT_TRUE(level_lines(square, value, 2).empty()) << "shorter than asked for";
}

// A cut in steps of edges, which turns by 90 degrees at each, becomes the diagonal.
TEST(FairedCut, OfAStaircaseIsStraight) {
  const TriMesh square = unit_square(24);
  SurfacePath stairs;
  for (int i = 0; i <= 24; ++i) {
    stairs.push_back(at_vertex(25 * i + i));
    if (i < 24) stairs.push_back(at_vertex(25 * i + i + 1));
  }
  const auto fair = faired_cut(square, {stairs}, 2.0 / 24);
  ASSERT_EQ(fair.size(), 1U);
  EXPECT_LT(length(fair[0], square.V), 1.05 * std::sqrt(2.0));
  SurfacePath dart(stairs.begin(), stairs.begin() + 20);
  EXPECT_TRUE(faired_cut(square, {dart}, 2.0 / 24).empty()) << "it parts nothing";
}

TEST(SlopeParts, OfACanAreItsWallAndItsLid) {
  // A tube of radius 0.5, and its lid: a fan about the middle of the upper rim.
  TriMesh can = flats::tube(0.5, 0.5, 1, 32, 8);
  const auto wall = static_cast<std::size_t>(can.triangle_count());
  double top = can.V.col(1).maxCoeff();
  std::vector<int> rim;
  for (int v = 0; v < can.vertex_count(); ++v) {
    if (can.V(v, 1) > top - 1e-9) rim.push_back(v);
  }
  std::sort(rim.begin(), rim.end(), [&](int a, int b) {
    return std::atan2(can.V(a, 0), can.V(a, 2)) < std::atan2(can.V(b, 0), can.V(b, 2));
  });
  const int middle = can.vertex_count();
  can.V.conservativeResize(middle + 1, 3);
  can.V.row(middle) << 0, top, 0;
  can.F.conservativeResize(can.F.rows() + std::ssize(rim), 3);
  for (std::size_t i = 0; i < rim.size(); ++i)
    can.F.row(wall + i) << middle, rim[i], rim[(i + 1) % rim.size()];
  const auto divisions = slope_parts(can, 2);
  ASSERT_EQ(divisions.size(), 1U);
  const std::vector<int>& part = divisions[0];
  std::size_t right = 0;
  const int of_wall = part[wall / 2];
  for (std::size_t t = 0; t < part.size(); ++t) right += (part[t] == of_wall) == (t < wall) ? 1 : 0;
  EXPECT_GT(static_cast<double>(right), 0.85 * static_cast<double>(part.size()));
}

TEST(FairedLine, OfANoisyLineHasItsEndsAndHardlyTurns) {
  Eigen::MatrixX3d noisy(101, 3);
  for (int i = 0; i <= 100; ++i) noisy.row(i) << 0.01 * i, 0.004 * ((i * 7) % 5 - 2), 0;
  const Eigen::MatrixX3d fair = faired_line(noisy, 0.2);
  EXPECT_EQ(fair.row(0), noisy.row(0));
  EXPECT_EQ(fair.row(fair.rows() - 1), noisy.row(100));
  EXPECT_LT(line_turning(fair, false).turning, 0.05 * line_turning(noisy, false).turning);
}

TEST(FairedLine, OfACircleIsTheCircle) {
  Eigen::MatrixX3d circle(65, 3);
  for (int i = 0; i <= 64; ++i)
    circle.row(i) << std::cos(2 * kPi * (i % 64) / 64), std::sin(2 * kPi * (i % 64) / 64), 0;
  const Eigen::MatrixX3d fair = faired_line(circle, 0.2);
  EXPECT_EQ(fair.row(0), fair.row(fair.rows() - 1)) << "closed";
  EXPECT_LT((fair.rowwise().norm().array() - 1).abs().maxCoeff(), 0.01);
}

TEST(FairSeams, StraightenASeamOnAPlaneAndTurnNoTriangle) {
  const TriMesh square = unit_square(24);
  std::vector<int> path;
  for (int i = 0; i <= 24; ++i)
    path.push_back(25 * i + 12 + (i % 4 == 1 ? 1 : i % 4 == 3 ? -1 : 0));
  std::vector<int> along{path[0]};
  for (std::size_t i = 1; i < path.size(); ++i) along.push_back(path[i]);
  std::vector<SeamEdge> seam;
  const EdgeConnectivity edges(square.F);
  std::vector<int> chain{along[0]};
  for (std::size_t i = 1; i < along.size(); ++i) {
    if (!edges.find(chain.back(), along[i])) {  // across a cell: by its other corner
      const int corner = along[i] > chain.back() ? chain.back() + 25 : along[i] + 25;
      seam.push_back({{chain.back(), corner}, 0});
      chain.push_back(corner);
    }
    seam.push_back({{chain.back(), along[i]}, 0});
    chain.push_back(along[i]);
  }
  const TriMesh fair = fair_seams(square, seam, {});
  const Eigen::MatrixX3d& X = fair.V;
  const LineTurning before = line_turning(square.V(chain, Eigen::all), false);
  const LineTurning after = line_turning(X(chain, Eigen::all), false);
  EXPECT_LT(after.turning, 0.3 * before.turning);
  EXPECT_LT(X.col(2).cwiseAbs().maxCoeff(), 1e-12) << "on the plane";
  EXPECT_GT((triangle_normals(fair).col(2)).minCoeff(), 0.99);
  EXPECT_EQ(X.row(chain.front()), square.V.row(chain.front()));
}

// What is rough shortens when it is made fair: what is straight behind it stays where it is.
TEST(FairSeams, LeaveWhatIsStraight) {
  const TriMesh square = unit_square(24);
  const EdgeConnectivity edges(square.F);
  std::vector<SeamEdge> seam;
  int at = 12;  // along x = 1/2, to and fro by a cell as far as the middle
  const auto go = [&](int to) {
    ASSERT_TRUE(edges.find(at, to));
    seam.push_back({{at, to}, 0});
    at = to;
  };
  for (int i = 0; i < 24; ++i) {
    if (i < 12 && i % 2 == 1) go(at % 25 == 12 ? at + 1 : at - 1);
    go(at + 25);
  }
  const TriMesh fair = fair_seams(square, seam, {});
  double moved = 0, smoothed = 0;
  for (int i = 0; i <= 24; ++i) {
    const int v = 25 * i + 12;
    const double by = (fair.V.row(v) - square.V.row(v)).norm() * 24;  // cells
    (i > 14 ? moved : smoothed) = std::max(i > 14 ? moved : smoothed, by);
  }
  EXPECT_GT(smoothed, 0.2);
  EXPECT_LT(moved, 0.1);
}

}  // namespace
}  // namespace geoprior::sketch
