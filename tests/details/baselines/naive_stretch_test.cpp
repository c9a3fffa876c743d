#include "baselines/details/naive_stretch.h"

#include "baselines/details/shared/rest_density.h"
#include "models/details/point_grid.h"
#include "tests/details/baselines/baseline_runs.h"

namespace geoprior::details {
namespace {

using namespace detail_scenes;

TEST(NaiveStretch, KeepsDetailsAndScalesTheirSpacing) {
  // Area x 2.25 by uniform scaling: every edge grows by 1.5, nothing comes or goes.
  const TriMesh mesh = shapes::sphere(4);
  const auto s = scene(mesh, even_details(mesh, 300, 1), inflate(mesh, 10, 2.25));
  const auto method = make_naive_stretch(s, {});
  const std::vector<Detail> sites = method->details().site;
  // Chords, because an edge that was flipped keeps its unfolded length until the next step.
  const SpacingOverMotion change = spacing_over_motion(*method, s);
  const DetailMesh& d = method->details();
  EXPECT_EQ(d.detail_count(), 300);
  EXPECT_NEAR(change.all, 0.5, 1e-9);
  EXPECT_NEAR(change.visible, 0.5, 1e-9);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    EXPECT_EQ(d.site[i].at.face, sites[i].at.face);
    EXPECT_EQ(d.site[i].weight, 1);
  }
  expect_sound(d);
}

TEST(NaiveStretch, FlipsAsTheSurfaceIsSheared) {
  const TriMesh mesh = shapes::square(16);
  const auto s = scene(mesh, even_details(mesh, 200, 1), stretch(mesh, 20, 2));
  const auto method = make_naive_stretch(s, {});
  RunContext context;
  double flips = 0;
  for (int frame = 1; frame <= 20; ++frame) {
    method->step(s.motion->positions(frame), context);
    flips += diagnostic(*method, "flips");
  }
  EXPECT_GT(flips, 100);
  expect_sound(method->details());
}

TEST(NaiveStretch, SameForAnyThreadCountAndAfterAStop) {
  const TriMesh mesh = shapes::sphere(4);
  const auto s = scene(mesh, even_details(mesh, 2000, 1), stretch(mesh, 8, 2));
  expect_same_bytes_for_any_thread_count([&] { return make_naive_stretch(s, {}); }, s);
  expect_resumed_run_is_the_same([&] { return make_naive_stretch_process(s, {}); }, 3);
}

TEST(RestDensity, OfAnEvenPatternIsEvenAndFollowsTheArea) {
  // 400 evenly spread details: 400 per area of the square, within the noise of some 20 details.
  const TriMesh mesh = shapes::square(24);
  const double side = mesh.V.col(0).maxCoeff() - mesh.V.col(0).minCoeff();
  const DetailMesh d = build_detail_mesh(mesh, even_details(mesh, 400, 3));
  const RestDensity density(d);
  EXPECT_NEAR(density.expected(d), 400, 1e-9);
  for (int f = 0; f < d.surface->face_count(); ++f)
    EXPECT_NEAR(density.at(f) * side * side / 400, 1, 0.35) << f;
  DetailMesh wide = d;
  move_surface(wide, stretch(mesh, 1, 2)->positions(1), LengthRule::chord);
  EXPECT_NEAR(density.expected(wide), 800, 1e-9);
  EXPECT_NEAR(RestDensity::stretch(7, wide), 2, 1e-12);
}

TEST(RestDensity, FacesFarFromDetailsAreBare) {
  // Details in the left quarter only: spacing about side / 80, so the right half is bare.
  const TriMesh mesh = shapes::square(32);
  const double left = mesh.V.col(0).minCoeff(), side = mesh.V.col(0).maxCoeff() - left;
  std::vector<Detail> details = even_details(mesh, 1600, 1);
  std::erase_if(details, [&](const Detail& d) {
    return position_of(d.at, mesh.V, mesh.F).x() > left + side / 4;
  });
  const DetailMesh d = build_detail_mesh(mesh, details);
  const RestDensity density(d);
  int bare = 0;
  for (int f = 0; f < d.surface->face_count(); ++f) {
    const double x =
        (position_of({f, Eigen::Vector3d::Constant(1.0 / 3)}, *d.surface, d.x).x() - left) / side;
    if (x > 0.5) {
      EXPECT_EQ(density.at(f), 0) << f;
    }
    if (x < 0.25) {
      EXPECT_GT(density.at(f), 0) << f;
    }
    bare += density.at(f) == 0 ? 1 : 0;
  }
  EXPECT_LT(bare, 0.75 * d.surface->face_count());
}

TEST(PointGrid, FindsWhatASearchOfAllPointsFinds) {
  RandomStream random(1, "points");
  PointGrid grid(0.1, 50);  // fewer than come
  std::vector<Eigen::Vector3d> points;
  const auto draw = [&] { return Eigen::Vector3d(random.uniform(), random.uniform(), 0); };
  for (int i = 0; i < 500; ++i) {
    points.push_back(draw());
    grid.add(points.back(), Eigen::Vector3d::UnitZ());
  }
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p = draw();
    const double radius = 0.1 * random.uniform();
    int nearest = -1;
    for (int k = 0; k < std::ssize(points); ++k) {
      const double r = (points[k] - p).norm();
      if (r < radius && (nearest < 0 || r < (points[nearest] - p).norm())) nearest = k;
    }
    EXPECT_EQ(grid.nearest(p, Eigen::Vector3d::UnitZ(), radius), nearest);
    EXPECT_EQ(grid.is_free(p, Eigen::Vector3d::UnitZ(), radius), nearest < 0);
    // The other side of the sheet is not near.
    EXPECT_TRUE(grid.is_free(p, -Eigen::Vector3d::UnitZ(), radius));
  }
}

}  // namespace
}  // namespace geoprior::details
