#include "baselines/details/dart_throwing.h"

#include <algorithm>
#include <limits>

#include "baselines/details/naive_stretch.h"
#include "baselines/details/shared/rest_density.h"
#include "tests/details/baselines/baseline_runs.h"

namespace geoprior::details {
namespace {

using namespace detail_scenes;

/// Smallest distance of a detail that was born in the motion to any other, in units of
/// 1 / sqrt(density at rest) where it is.
double least_distance_of_newborn(const DetailMesh& d, const RestDensity& density) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < d.site.size(); ++i) {
    if (!d.is_detail(static_cast<int>(i)) || d.site[i].birth_frame == 0) continue;
    for (std::size_t j = 0; j < d.site.size(); ++j) {
      // Of two newborn the younger one kept the distance.
      if (i == j || !d.is_detail(static_cast<int>(j)) || d.site[j].birth > d.site[i].birth)
        continue;
      least = std::min(least,
                       (d.position[i] - d.position[j]).norm() / density.spacing(d.site[i].at.face));
    }
  }
  return least;
}

TEST(DartThrowing, KeepsTheMinimumDistanceAndOldDetails) {
  // In a plane that is only stretched, distances grow after a birth: the bound of the birth holds.
  const TriMesh mesh = shapes::square(30);
  const auto s = scene(mesh, even_details(mesh, 600, 1), stretch(mesh, 40, 2));
  const RestDensity density(build_detail_mesh(mesh, s.details));
  const auto method = make_dart_throwing(s, {}, 1);
  run_through(*method, s);
  const DetailMesh& d = method->details();
  EXPECT_GE(least_distance_of_newborn(d, density), 0.834 - 1e-9);
  for (int i = 0; i < 600; ++i) {
    EXPECT_EQ(d.site[i].birth, i);
    EXPECT_EQ(d.site[i].at.face, s.details[i].at.face);
  }
  expect_sound(d);
}

TEST(DartThrowing, SaturatesNearTheDensityAtRest) {
  // Random discs jam at the density at rest for radius 0.834 (Feder 1980); old details, which the
  // stretch has moved along one axis, keep gaps that are too narrow, so somewhat fewer fit.
  const TriMesh mesh = shapes::square(30);
  const auto s = scene(mesh, even_details(mesh, 600, 1), stretch(mesh, 60, 2));
  const auto method = make_dart_throwing(s, {}, 1);
  run_through(*method, s);
  EXPECT_NEAR(method->details().detail_count(), 1200, 120);
  EXPECT_GE(method->details().detail_count(), 600);
}

TEST(DartThrowing, SpacingBeatsNaiveStretch) {
  const TriMesh mesh = shapes::square(30);
  const auto s = scene(mesh, even_details(mesh, 600, 1), stretch(mesh, 60, 2));
  const double naive = spacing_over_motion(*make_naive_stretch(s, {}), s).all;
  const SpacingOverMotion change = spacing_over_motion(*make_dart_throwing(s, {}, 1), s);
  EXPECT_GT(naive, 0.35);
  EXPECT_LT(std::abs(change.all), naive / 2);
  EXPECT_GE(change.visible, change.all);  // details are born invisible
}

TEST(DartThrowing, ThrowsNothingWhereNothingIsStretched) {
  // The right half is stretched by 2, the left stands still: births are on the right.
  const TriMesh mesh = shapes::square(32);
  const double middle = 0.5 * (mesh.V.col(0).minCoeff() + mesh.V.col(0).maxCoeff());
  const auto s = scene(
      mesh, even_details(mesh, 400, 1), motion(mesh, 20, [&](const Eigen::Vector3d& p, double t) {
        return Eigen::Vector3d(p.x() + (p.x() > middle ? t * (p.x() - middle) : 0), p.y(), p.z());
      }));
  const auto method = make_dart_throwing(s, {}, 1);
  run_through(*method, s);
  const DetailMesh& d = method->details();
  EXPECT_GT(d.detail_count(), 500);
  for (int i = 0; i < std::ssize(d.site); ++i)
    if (d.is_detail(i) && d.site[i].birth_frame > 0) {
      EXPECT_GT(d.position[i].x(), middle);
    }
}

TEST(DartThrowing, WeightsGrowAtTheirRate) {
  const TriMesh mesh = shapes::sphere(4);
  const auto s = scene(mesh, even_details(mesh, 300, 1), inflate(mesh, 20, 2));
  const auto method = make_dart_throwing(s, {}, 1);
  RunContext context;
  double born = 0;
  for (int frame = 1; frame <= 20; ++frame) {
    method->step(s.motion->positions(frame), context);
    EXPECT_LE(diagnostic(*method, "max_weight_change"), 0.1 + 1e-12);
    born += diagnostic(*method, "inserted");
  }
  EXPECT_GT(born, 150);
  EXPECT_EQ(method->details().detail_count(), 300 + static_cast<int>(born));
  expect_sound(method->details());
}

TEST(DartThrowing, SameForAnyThreadCountAndAfterAStop) {
  const TriMesh mesh = shapes::sphere(5);
  const auto s = scene(mesh, even_details(mesh, 3000, 1), inflate(mesh, 12, 2));
  expect_same_bytes_for_any_thread_count([&] { return make_dart_throwing(s, {}, 1); }, s);
  const TriMesh coarse = shapes::sphere(4);
  const auto small = scene(coarse, even_details(coarse, 300, 1), inflate(coarse, 12, 2));
  expect_resumed_run_is_the_same([&] { return make_dart_throwing_process(small, {}); }, 6);
}

}  // namespace
}  // namespace geoprior::details
