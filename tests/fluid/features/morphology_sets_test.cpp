#include <gtest/gtest.h>

#include <algorithm>

#include "solvers/fluid/features/morphology.h"
#include "solvers/fluid/features/regions.h"
#include "tests/fluid/liquid/test_surfaces.h"

namespace geoprior::fluid {
namespace {

TriMesh flat(int n) {
  return surfaces::graph(1, n, 0.25, [](double, double) { return 0.0; });
}
std::vector<char> disc(const TriMesh& mesh, double radius) {
  std::vector<char> set(mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) set[v] = mesh.V.row(v).norm() < radius;
  return set;
}
double area_of(const TriMesh& mesh, const std::vector<char>& set) {
  const std::vector<double> area = surface_shape(surface_graph(mesh), {}).area;
  double sum = 0;
  for (std::size_t v = 0; v < set.size(); ++v) sum += set[v] != 0 ? area[v] : 0;
  return sum;
}
std::size_t count(const std::vector<char>& set) { return std::count(set.begin(), set.end(), 1); }

// Paths along edges are longer than straight ones: a disc of 0.3 grown by 0.2 reaches less than
// 0.5, by up to a tenth of the way and an edge.
TEST(Morphology, DilationGrowsADiscByAMetricRadius) {
  for (const int n : {40, 80}) {
    const TriMesh mesh = flat(n);
    const std::vector<char> grown = dilate(mesh, disc(mesh, 0.3), 0.2);
    const double radius = std::sqrt(area_of(mesh, grown) / std::numbers::pi);
    EXPECT_GT(radius, 0.5 - 0.02 - 2.0 / n);
    EXPECT_LT(radius, 0.5 + 1.0 / n);
  }
}

TEST(Morphology, ErosionIsTheDilationOfTheComplement) {
  const TriMesh mesh = flat(50);
  const std::vector<char> set = disc(mesh, 0.5);
  std::vector<char> complement = set;
  for (char& c : complement) c = c == 0;
  std::vector<char> expected = dilate(mesh, complement, 0.15);
  for (char& c : expected) c = c == 0;
  EXPECT_EQ(erode(mesh, set, 0.15), expected);
}

TEST(Morphology, OpeningShrinksAndClosingGrowsAndBothAreIdempotent) {
  const TriMesh mesh = flat(50);
  RandomStream random(3, "blobs");
  std::vector<char> set(mesh.vertex_count());
  for (char& c : set) c = random.uniform() < 0.3;
  const auto open = [&](const auto& s) { return dilate(mesh, erode(mesh, s, 0.05), 0.05); };
  const auto close = [&](const auto& s) { return erode(mesh, dilate(mesh, s, 0.05), 0.05); };
  const std::vector<char> opened = open(set), closed = close(set);
  for (std::size_t v = 0; v < set.size(); ++v) {
    EXPECT_LE(opened[v], set[v]);
    EXPECT_GE(closed[v], set[v]);
  }
  EXPECT_EQ(open(opened), opened);
  EXPECT_EQ(close(closed), closed);
  EXPECT_LT(count(opened), count(set));
  EXPECT_GT(count(closed), count(set));
}

TEST(Morphology, TheBorderOfTheMeshDoesNotErode) {
  const TriMesh mesh = flat(30);
  const std::vector<char> all(mesh.vertex_count(), 1);
  EXPECT_EQ(erode(mesh, all, 0.5), all);
}

TEST(Morphology, VerticesThatAreNotActiveNeitherGrowNorErode) {
  const TriMesh mesh = flat(40);
  const SurfaceGraph graph = surface_graph(mesh);
  std::vector<char> active(graph.x.size()), set = disc(mesh, 0.5);
  for (std::size_t v = 0; v < active.size(); ++v) active[v] = graph.x[v].x() > 0;
  for (std::size_t v = 0; v < set.size(); ++v) set[v] = set[v] != 0 && active[v] != 0;
  Morphology morphology(graph, active);
  std::vector<char> eroded = set, dilated = set;
  morphology.erode(eroded, 0.2);
  morphology.dilate(dilated, 0.2);
  for (std::size_t v = 0; v < set.size(); ++v) {
    EXPECT_TRUE(active[v] != 0 || dilated[v] == 0);
    // The half disc's straight side lies at inactive vertices: it stays.
    EXPECT_TRUE(active[v] == 0 || graph.x[v].norm() >= 0.2 || eroded[v] == 1);
  }
}

TEST(Morphology, FillsHolesUpToAnAreaAndNoBays) {
  const TriMesh mesh = flat(60);
  const SurfaceGraph graph = surface_graph(mesh);
  const std::vector<char> active(graph.x.size(), 1);
  const std::vector<double> area = surface_shape(graph, {}).area;
  std::vector<char> ring = disc(mesh, 0.6);
  const std::vector<char> hole = disc(mesh, 0.4);
  for (std::size_t v = 0; v < ring.size(); ++v) ring[v] = ring[v] != 0 && hole[v] == 0;
  Morphology morphology(graph, active);
  const double hole_area = area_of(mesh, hole);
  std::vector<char> filled = ring;
  morphology.fill_holes(filled, area, 0.95 * hole_area);
  EXPECT_EQ(filled, ring);
  morphology.fill_holes(filled, area, 1.05 * hole_area);
  EXPECT_EQ(filled, disc(mesh, 0.6));
  // Opened to the outside, and by the border of the mesh.
  std::vector<char> bay = ring;
  for (std::size_t v = 0; v < bay.size(); ++v) {
    if (graph.x[v].x() > 0 && std::abs(graph.x[v].y()) < 0.1) bay[v] = 0;
  }
  filled = bay;
  morphology.fill_holes(filled, area, 100);
  EXPECT_EQ(filled, bay);
}

}  // namespace
}  // namespace geoprior::fluid
