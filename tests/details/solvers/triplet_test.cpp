#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/error.h"
#include "models/details/area_budget.h"
#include "solvers/details/local_chart.h"
#include "solvers/details/pair_correlation.h"
#include "solvers/details/triplet_table.h"
#include "tests/details/detail_scenes.h"

namespace geoprior::details {
namespace {

using namespace detail_scenes;

Eigen::Vector3d at(const DetailMesh& d, int site) { return d.position[site]; }

TEST(LocalChart, InThePlaneItIsAnIsometry) {
  const TriMesh mesh = shapes::square(12);
  const DetailMesh d = build_detail_mesh(mesh, random_details(mesh, 300, 1));
  LocalChart chart;
  for (const int source : {0, 100, 299}) {
    const auto points = chart.around(d.mesh, source, 0.2);
    std::set<int> reached;
    for (const ChartPoint& p : points) {
      EXPECT_NEAR(p.at.norm(), (at(d, p.vertex) - at(d, source)).norm(), 1e-10);
      for (const ChartPoint& q : points)
        EXPECT_NEAR((p.at - q.at).norm(), (at(d, p.vertex) - at(d, q.vertex)).norm(), 1e-10);
      reached.insert(p.vertex);
    }
    for (int i = 0; i < d.site_slots(); ++i) {
      if ((at(d, i) - at(d, source)).norm() > 0.15) continue;
      EXPECT_EQ(reached.count(i), 1u) << i;
    }
  }
}

TripletOptions small_table() {
  TripletOptions options;
  options.cell_capacity = 1024;
  return options;
}

TEST(TripletTable, AllTripletsAreNChooseThree) {
  const TriMesh mesh = shapes::square(12);
  const DetailMesh d = build_detail_mesh(mesh, random_details(mesh, 40, 2));
  TripletOptions options = small_table();
  options.all = true;
  EXPECT_EQ(TripletTable(d, options, 1).met(), 40 * 39 * 38 / 6);
  const DetailMesh many = build_detail_mesh(mesh, random_details(mesh, 401, 2));
  EXPECT_THROW(TripletTable(many, options, 1), Error);
}

TEST(TripletTable, InteriorDetailsLieWhereTheirCoordinatesSay) {
  const TriMesh mesh = shapes::square(12);
  const DetailMesh d = build_detail_mesh(mesh, random_details(mesh, 200, 3));
  const TripletTable table(d, small_table(), 1);
  const double reach = 3 * mean_edge(d);
  ASSERT_GT(table.size(), 1000);
  for (int t = 0; t < table.size(); ++t) {
    const auto& c = table.corners(t);
    EXPECT_LE((at(d, c[0]) - at(d, c[1])).norm(), reach + 1e-9);
    EXPECT_LE((at(d, c[2]) - at(d, c[0])).norm(), reach + 1e-9);
    ASSERT_FALSE(table.interior(t).empty());
    for (const TripletInterior& inside : table.interior(t)) {
      const Eigen::Vector3d b = inside.barycentric();
      const Eigen::Vector3d p = b[0] * at(d, c[0]) + b[1] * at(d, c[1]) + b[2] * at(d, c[2]);
      EXPECT_LT((p - at(d, inside.detail)).norm(), 1e-6);
    }
  }
}

TEST(TripletTable, ATripletFindsItselfInAnyOrderOfItsCorners) {
  const TriMesh mesh = shapes::square(12);
  const DetailMesh d = build_detail_mesh(mesh, random_details(mesh, 200, 4));
  const TripletTable table(d, small_table(), 1);
  std::vector<TripletMatch> found;
  for (int t = 0; t < table.size(); t += 97) {
    std::array<int, 3> corner = table.corners(t);
    std::sort(corner.begin(), corner.end());
    do {
      const auto edge = [&](std::size_t k) {
        return (at(d, corner[k]) - at(d, corner[(k + 1) % 3])).norm();
      };
      table.closest({edge(0), edge(1), edge(2)}, 8, 1, found);
      ASSERT_EQ(found.size(), 1u);
      EXPECT_LT(found[0].edge_difference, 1e-6);
      const auto& same = table.corners(found[0].triplet);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(same[found[0].order[k]], corner[k]);
      // Mirrored exactly when the corners of the query run clockwise in the plane.
      const Eigen::Vector3d u = at(d, corner[1]) - at(d, corner[0]);
      const Eigen::Vector3d v = at(d, corner[2]) - at(d, corner[0]);
      EXPECT_EQ(found[0].mirrored, u.x() * v.y() - u.y() * v.x() < 0);
    } while (std::next_permutation(corner.begin(), corner.end()));
  }
}

TEST(AreaBudget, AsksForTheFactorOfTheArea) {
  const TriMesh mesh = shapes::sphere(4);
  DetailMesh d = build_detail_mesh(mesh, even_details(mesh, 500, 1));
  AreaBudget budget(d, 48);
  EXPECT_GE(budget.patch_count(), 5);
  EXPECT_LE(budget.patch_count(), 25);
  for (int p = 0; p < budget.patch_count(); ++p) EXPECT_NEAR(budget.deficit(p), 0, 1e-9);
  move_surface(d, 1.5 * mesh.V, LengthRule::chord);
  budget.update(d);
  EXPECT_NEAR(budget.total_target(), 2.25 * 500, 1e-6);
}

TEST(AreaBudget, BareSurfaceAsksForNothing) {
  // Details on the left third only; the right half grows.
  const TriMesh mesh = shapes::square(40);
  auto details = even_details(mesh, 900, 1);
  std::erase_if(details,
                [&](const Detail& d) { return position_of(d.at, mesh.V, mesh.F).x() > 0.3; });
  DetailMesh d = build_detail_mesh(mesh, details);
  AreaBudget budget(d, 48);
  Eigen::MatrixX3d V = mesh.V;
  for (Eigen::Index v = 0; v < V.rows(); ++v) V(v, 0) += 3 * std::max(0.0, V(v, 0) - 0.5);
  move_surface(d, V, LengthRule::chord);
  budget.update(d);
  EXPECT_NEAR(budget.total_target(), static_cast<double>(details.size()), 1e-6);
}

TEST(PairCorrelation, OfAPoissonProcessIsOne) {
  const TriMesh mesh = shapes::sphere(5);
  const DetailMesh d = build_detail_mesh(mesh, random_details(mesh, 6000, 1));
  PairCorrelation correlation(mean_edge(d), {});
  const Eigen::VectorXd g = correlation.of(d);
  // Bins hold some 10^4 pairs each, 1 %; below two bandwidths the kernel is cut at 0.
  for (Eigen::Index i = 4; i < g.size(); ++i) EXPECT_NEAR(g[i], 1, 0.06) << i;
}

}  // namespace
}  // namespace geoprior::details
