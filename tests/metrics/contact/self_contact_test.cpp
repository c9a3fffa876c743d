#include "metrics/contact/self_contact.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "core/error.h"
#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

double orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   const Eigen::Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// Whether the segment crosses the triangle, both in general position.
bool crosses(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d* t) {
  if (orientation(t[0], t[1], t[2], p) * orientation(t[0], t[1], t[2], q) > 0) return false;
  const double a = orientation(p, q, t[0], t[1]);
  const double b = orientation(p, q, t[1], t[2]);
  const double c = orientation(p, q, t[2], t[0]);
  return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

/// Pairs by definition: an edge of one crosses the other; no shared vertices between a and b.
int brute_force(const TriMesh& m, int triangles_of_first) {
  int count = 0;
  for (int i = 0; i < triangles_of_first; ++i) {
    for (int j = triangles_of_first; j < m.triangle_count(); ++j) {
      Eigen::Vector3d a[3];
      Eigen::Vector3d b[3];
      for (int k = 0; k < 3; ++k) {
        a[k] = m.V.row(m.F(i, k)).transpose();
        b[k] = m.V.row(m.F(j, k)).transpose();
      }
      bool meet = false;
      for (int k = 0; k < 3; ++k) {
        meet |= crosses(a[k], a[(k + 1) % 3], b) || crosses(b[k], b[(k + 1) % 3], a);
      }
      count += meet ? 1 : 0;
    }
  }
  return count;
}

TriMesh crossing_boxes() {
  TriMesh second = shapes::box({-0.41, -0.52, -0.63}, {0.47, 0.58, 0.69});
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  second.V = (second.V * R.transpose()).rowwise() + Eigen::RowVector3d(0.9, 0.8, 0.77);
  return shapes::together(shapes::box({0, 0, 0}, {1, 1, 1}), second);
}

TEST(IntersectingPairs, OfCrossingBoxesAgreeWithBruteForce) {
  const TriMesh m = crossing_boxes();
  const int expected = brute_force(m, 12);
  EXPECT_GT(expected, 6);
  EXPECT_EQ(intersecting_pairs(m.V, m.F), expected);
}

TEST(IntersectingPairs, OfTwoSpheresAgreeWithBruteForce) {
  const TriMesh first = shapes::sphere(1, {0, 0, 0}, 3);
  const TriMesh m = shapes::together(first, shapes::sphere(0.8, {0.63, 0.41, 0.29}, 3));
  EXPECT_EQ(intersecting_pairs(m.V, m.F), brute_force(m, first.triangle_count()));
}

TEST(IntersectingPairs, EmbeddedSurfacesHaveNone) {
  const TriMesh sphere = shapes::sphere(1, {0, 0, 0}, 3);
  const TriMesh torus = shapes::torus(1, 0.3, 40, 20);
  EXPECT_EQ(intersecting_pairs(sphere.V, sphere.F), 0);
  EXPECT_EQ(intersecting_pairs(torus.V, torus.F), 0);
}

TEST(IntersectingPairs, OfARegionNeedOneTriangleInIt) {
  const TriMesh m = crossing_boxes();
  JointRegion first;
  JointRegion second;
  for (int t = 0; t < 12; ++t) first.triangles.push_back(t);
  for (int t = 12; t < 24; ++t) second.triangles.push_back(t);
  const std::vector<std::array<int, 2>> pairs = intersecting_triangles(m.V, m.F);
  const int all = intersecting_pairs(m.V, m.F);
  // Every pair has one triangle of either box.
  EXPECT_EQ(pairs_in_region(pairs, first), all);
  EXPECT_EQ(pairs_in_region(pairs, second), all);
  EXPECT_EQ(pairs_in_region(pairs, JointRegion{}), 0);
  JointRegion low;
  JointRegion high;
  for (int t = 0; t < 12; ++t) (t < 6 ? low : high).triangles.push_back(t);
  EXPECT_EQ(pairs_in_region(pairs, low) + pairs_in_region(pairs, high), all);
}

TEST(IntersectingPairs, NeighboursCountOnlyBeyondWhatTheyShare) {
  TriMesh m;
  m.V.resize(5, 3);
  m.F.resize(2, 3);
  // A common edge: open, and folded flat onto itself.
  m.F << 0, 1, 2, 1, 0, 3;
  m.V << 0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.5, 0.8, 0.1, 9, 9, 9;
  EXPECT_EQ(intersecting_pairs(m.V, m.F), 0);
  m.V(3, 2) = 0;
  EXPECT_EQ(intersecting_pairs(m.V, m.F), 1);
  // A common vertex: apart, and the opposite edge through the other triangle.
  m.F << 0, 1, 2, 0, 3, 4;
  m.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 1, -1, 0.5, -1;
  EXPECT_EQ(intersecting_pairs(m.V, m.F), 0);
  m.V.row(3) << 0.5, 0.2, 1;
  m.V.row(4) << 0.3, 0.2, -1;
  EXPECT_EQ(intersecting_pairs(m.V, m.F), 1);
}

TEST(IntersectingPairs, DegenerateTrianglesAreLeftOut) {
  TriMesh m = shapes::box({0, 0, 0}, {1, 1, 1});
  m.F.conservativeResize(13, 3);
  m.F.row(12) << 0, 7, 7;
  EXPECT_EQ(intersecting_pairs(m.V, m.F), 0);
}

TEST(IntersectingPairs, NamesTheVertexThatIsNotFinite) {
  TriMesh m = shapes::box({0, 0, 0}, {1, 1, 1});
  m.V(5, 1) = std::numeric_limits<double>::quiet_NaN();
  try {
    intersecting_pairs(m.V, m.F);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("vertex 5"), std::string::npos);
  }
}

TEST(PairsBetweenLayers, LeaveOutThoseOfOneLayer) {
  const std::vector<std::array<int, 2>> pairs{{0, 1}, {0, 2}, {1, 3}, {2, 3}};
  const std::vector<int> layer{1, 1, 2, 2};
  const std::vector<std::array<int, 2>> between{{0, 2}, {1, 3}};
  EXPECT_EQ(pairs_between_layers(pairs, layer), between);
}

}  // namespace
}  // namespace geoprior
