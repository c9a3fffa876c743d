#include "baselines/details/delaunay_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baselines/details/naive_stretch.h"
#include "baselines/details/shared/density_moves.h"
#include "tests/details/baselines/baseline_runs.h"

namespace geoprior::details {
namespace {

using namespace detail_scenes;

/// Place of a point of M_d on a flat scene.
Eigen::Vector3d place_of(const MeshPoint& p, const DetailMesh& d) {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  const auto corner = d.mesh.corners(p.triangle);
  for (std::size_t k = 0; k < 3; ++k) x += p.barycentric[k] * d.position[corner[k]];
  return x;
}

TEST(Circumcentre, IsTheCentreOfTheEmptyCircleInThePlane) {
  // Circumcircles of a Delaunay triangulation are empty: the distance from the centre to all three
  // corners is the circumradius, and no point is nearer. Absent only beyond the border.
  const TriMesh mesh = shapes::square(16);
  const DetailMesh d = build_detail_mesh(mesh, random_details(mesh, 300, 1));
  int found = 0, elsewhere = 0;
  for (int t = 0; t < d.mesh.triangle_slots(); ++t) {
    if (!d.mesh.triangle_alive(t)) continue;
    const auto place = circumcentre(d.mesh, t);
    if (!place) continue;
    ++found;
    elsewhere += place->triangle != t ? 1 : 0;
    EXPECT_GE(place->barycentric.minCoeff(), 0);
    const Eigen::Vector3d x = place_of(*place, d);
    const double radius = circumradius(d.mesh, t);
    for (const int c : d.mesh.corners(t)) {
      EXPECT_NEAR((d.position[c] - x).norm(), radius, 1e-7 * radius);
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < d.site_slots(); ++i)
      nearest = std::min(nearest, (d.position[i] - x).norm());
    EXPECT_NEAR(nearest, radius, 1e-7 * radius);
  }
  EXPECT_GT(found, 500);
  EXPECT_GT(elsewhere, 100);  // those of obtuse triangles lie outside
}

TEST(DelaunayRefinement, KeepsTheSpacingOfAPlaneThatIsStretched) {
  // +45 % without insertions. Two details of a patch of 48 are half an edge per cent each.
  const TriMesh mesh = shapes::square(30);
  const auto s = scene(mesh, even_details(mesh, 600, 1), stretch(mesh, 120, 2));
  const double naive = spacing_over_motion(*make_naive_stretch(s, {}), s).all;
  const auto method = make_delaunay_refinement(s, {});
  const SpacingOverMotion change = spacing_over_motion(*method, s);
  EXPECT_GT(naive, 0.35);
  EXPECT_LT(std::abs(change.all), 0.04);
  EXPECT_LT(std::abs(change.visible), 0.04);
  EXPECT_NEAR(method->details().detail_count(), 1200, 24);
  expect_sound(method->details());
}

TEST(DelaunayRefinement, NewDetailsKeepAwayFromAllOthers) {
  // In a plane that is only stretched distances grow after a birth, at which the circumradius was
  // above that of the lattice: 0.620 / sqrt(density), read where the newborn is.
  const TriMesh mesh = shapes::square(30);
  const auto s = scene(mesh, even_details(mesh, 600, 1), stretch(mesh, 60, 2));
  const RestDensity density(build_detail_mesh(mesh, s.details));
  const auto method = make_delaunay_refinement(s, {});
  run_through(*method, s);
  const DetailMesh& d = method->details();
  for (std::size_t i = 0; i < d.site.size(); ++i) {
    if (!d.is_detail(static_cast<int>(i)) || d.site[i].birth_frame == 0) continue;
    for (std::size_t j = 0; j < d.site.size(); ++j) {
      if (i == j || !d.is_detail(static_cast<int>(j)) || d.site[j].birth > d.site[i].birth)
        continue;
      // A newborn on the rim of a triangle is moved inside by a thousandth of it.
      EXPECT_GT((d.position[i] - d.position[j]).norm(),
                0.98 * kLatticeRadius * density.spacing(d.site[i].at.face));
    }
  }
}

TEST(DelaunayRefinement, FadesDetailsWhenSqueezed) {
  // Half the area asks for half the details; -27 % of mean edge without.
  const TriMesh mesh = shapes::sphere(4);
  const auto s = scene(mesh, even_details(mesh, 600, 1), inflate(mesh, 120, 0.5));
  const auto method = make_delaunay_refinement(s, {});
  const double naive = spacing_over_motion(*make_naive_stretch(s, {}), s).all;
  EXPECT_LT(naive, -0.25);
  const SpacingOverMotion change = spacing_over_motion(*method, s);
  EXPECT_LT(std::abs(change.all), 0.04);
  EXPECT_LT(std::abs(change.visible), 0.04);
  RunContext context;
  for (int frame = 0; frame < 12; ++frame) {  // those that fade leave
    method->step(s.motion->positions(120), context);
    expect_sound(method->details());
  }
  EXPECT_NEAR(method->details().detail_count(), 300, 12);
}

TEST(DelaunayRefinement, ActsWhereTheSurfaceIsStretched) {
  // The right half is stretched by 2, the left stands still; patches reach over the middle by some
  // seven details. Some twenty patches, each within 0.6 of its number when it does not ask ahead.
  const TriMesh mesh = shapes::square(32);
  const double left = mesh.V.col(0).minCoeff(), side = mesh.V.col(0).maxCoeff() - left;
  const double middle = left + side / 2;
  const auto s = scene(
      mesh, even_details(mesh, 900, 1), motion(mesh, 40, [&](const Eigen::Vector3d& p, double t) {
        return Eigen::Vector3d(p.x() + (p.x() > middle ? t * (p.x() - middle) : 0), p.y(), p.z());
      }));
  DelaunayRefinementOptions options;
  options.anticipate = false;
  const auto method = make_delaunay_refinement(s, options);
  run_through(*method, s);
  const DetailMesh& d = method->details();
  EXPECT_NEAR(d.detail_count(), 1350, 15);
  for (int i = 0; i < std::ssize(d.site); ++i)
    if (d.is_detail(i) && d.site[i].birth_frame > 0) {
      EXPECT_GT(d.position[i].x(), middle - 7 * side / 30);
    }
}

TEST(DelaunayRefinement, ChangesNothingAtRest) {
  const TriMesh mesh = shapes::sphere(4);
  const auto s = scene(mesh, random_details(mesh, 500, 1), inflate(mesh, 1, 1));
  const auto method = make_delaunay_refinement(s, {});
  RunContext context;
  for (int frame = 0; frame < 5; ++frame) {
    method->step(s.motion->positions(0), context);
    for (const char* what : {"inserted", "revived", "fading", "flips", "max_weight_change"})
      EXPECT_EQ(diagnostic(*method, what), 0) << what;
  }
  EXPECT_EQ(method->details().births, 500);
}

TEST(DelaunayRefinement, ReturnsToTheNumberItHad) {
  const TriMesh mesh = shapes::square(24);
  const auto s =
      scene(mesh, even_details(mesh, 500, 1), motion(mesh, 160, [](const auto& p, double t) {
              const double factor = 1 + 0.5 * (1 - std::cos(4 * std::acos(-1.0) * t));
              return Eigen::Vector3d(factor * p.x(), p.y(), p.z());
            }));
  const auto method = make_delaunay_refinement(s, {});
  run_through(*method, s);
  RunContext context;
  for (int frame = 0; frame < 30; ++frame) method->step(s.motion->positions(160), context);
  EXPECT_NEAR(method->details().detail_count(), 500, 15);
  expect_sound(method->details());
}

TEST(DelaunayRefinement, WeightsGrowAtTheirRate) {
  const TriMesh mesh = shapes::sphere(4);
  const auto s = scene(mesh, even_details(mesh, 300, 1), inflate(mesh, 20, 2));
  DelaunayRefinementOptions options;
  options.weight_rate = 0.05;
  const auto method = make_delaunay_refinement(s, options);
  RunContext context;
  double born = 0, largest = 0;
  for (int frame = 1; frame <= 20; ++frame) {
    method->step(s.motion->positions(frame), context);
    largest = std::max(largest, diagnostic(*method, "max_weight_change"));
    born += diagnostic(*method, "inserted");
    expect_sound(method->details());
  }
  EXPECT_NEAR(largest, 0.05, 1e-12);
  EXPECT_GT(born, 250);
  EXPECT_EQ(method->details().detail_count(), 300 + static_cast<int>(born));
}

TEST(DelaunayRefinement, SameForAnyThreadCountAndAfterAStop) {
  const TriMesh mesh = shapes::sphere(5);
  const auto s = scene(mesh, even_details(mesh, 3000, 1), inflate(mesh, 12, 2));
  expect_same_bytes_for_any_thread_count([&] { return make_delaunay_refinement(s, {}); }, s);
  const TriMesh coarse = shapes::sphere(4);
  for (const double factor : {2.0, 0.5}) {
    const auto small = scene(coarse, even_details(coarse, 300, 1), inflate(coarse, 16, factor));
    expect_resumed_run_is_the_same([&] { return make_delaunay_refinement_process(small, {}); }, 6);
  }
}

}  // namespace
}  // namespace geoprior::details
