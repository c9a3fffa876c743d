#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "models/grammar/objects/forest.h"
#include "models/grammar/objects/surface_set.h"
#include "models/grammar/objects/volume_set.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

std::vector<Hierarchy> all_sets(std::uint64_t seed) {
  SurfaceSetOptions torus;
  torus.shape = SurfaceSetOptions::Shape::torus;
  torus.height = 0.9;
  VolumeSetOptions bar;
  bar.shape = VolumeSetOptions::Shape::bar;
  ForestOptions forest;
  forest.apart = true;
  forest.elements = 300;
  std::vector<Hierarchy> out;
  out.push_back(make_surface_set({}, seed));
  out.push_back(make_surface_set(torus, seed));
  out.push_back(make_volume_set({}, seed));
  out.push_back(make_volume_set(bar, seed));
  out.push_back(make_forest(forest, seed));
  return out;
}

TEST(GrammarSets, ElementsAreAtTheirDistanceAndWhole) {
  for (const Hierarchy& h : all_sets(1)) {
    h.require_valid();
    const auto& children = h.children(0);
    EXPECT_GT(h.present_count(), 100);
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (!h.present(children[i])) continue;
      EXPECT_EQ(h.parameter(children[i], 0), 1);
      for (std::size_t j = 0; j < i; ++j) {
        if (!h.present(children[j])) continue;
        const double distance = (h.position(children[i]) - h.position(children[j])).norm();
        EXPECT_GE(distance, 2 * h.parameter(children[i], 1));
      }
    }
  }
}

TEST(GrammarSets, EachCandidateIsNearerThanTheDistanceToAnElement) {
  for (const Hierarchy& h : all_sets(2)) {
    int candidates = 0;
    for (const int e : h.children(0)) {
      if (h.present(e)) continue;
      ++candidates;
      double nearest = 1e9;
      for (const int other : h.children(0))
        if (h.present(other))
          nearest = std::min(nearest, (h.position(other) - h.position(e)).norm());
      EXPECT_LT(nearest, (2 + 1e-8) * h.parameter(e, 1));
    }
    EXPECT_GT(2 * candidates, h.present_count());
  }
}

TEST(GrammarSets, TheSameSeedGivesTheSameSet) {
  const auto a = all_sets(5), b = all_sets(5), other = all_sets(6);
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].size(), b[k].size());
    for (int e = 0; e < a[k].size(); ++e) EXPECT_EQ(a[k].position(e), b[k].position(e));
    EXPECT_NE(a[k].position(1), other[k].position(1));
  }
}

TEST(GrammarSets, ItemsStandOnTheirTriangleUpright) {
  const Hierarchy h = make_surface_set({}, 1);
  const auto points = h.points(0);
  const Eigen::MatrixX3i& F = h.type(0).triangles;
  for (const int e : h.children(0)) {
    const int t = static_cast<int>(h.parameter(e, ItemParameter::kTriangle));
    const TrianglePlace place{t, h.parameter(e, ItemParameter::kB0),
                              h.parameter(e, ItemParameter::kB1)};
    EXPECT_EQ(h.position(e), on_triangle(points, F, place));
    const Vector3d p = points[F(t, 0)];
    const Vector3d n = (points[F(t, 1)] - p).cross(points[F(t, 2)] - p).normalized();
    EXPECT_GT(n.dot(h.turn(e) * Vector3d::UnitZ()), 0.98);
  }
}

TEST(GrammarSets, ATriangleTurnsAsItsCornersDo) {
  const std::vector<Vector3d> before{{0, 0, 0}, {1, 0, 0}, {0.3, 2, 0}};
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()));
  std::vector<Vector3d> now;
  for (const Vector3d& x : before) now.push_back(turn * x + Vector3d(4, 5, 6));
  const Eigen::MatrixX3i F = Eigen::RowVector3i(0, 1, 2);
  EXPECT_NEAR(triangle_turn(before, now, F, 0).angularDistance(turn), 0, 1e-7);
}

TEST(GrammarSets, TheNearestPlaceOfASurfaceIsOnIt) {
  const Hierarchy h = make_surface_set({}, 1);
  const int e = h.children(0)[3];
  const Vector3d x = h.position(e);
  const TrianglePlace place = nearest_place(h.points(0), h.type(0).triangles, x);
  EXPECT_NEAR((on_triangle(h.points(0), h.type(0).triangles, place) - x).norm(), 0, 1e-9);
}

TEST(GrammarSets, AForestHasItsNumberOfConifersOnFlatGround) {
  ForestOptions o;
  o.elements = 5000;
  EXPECT_EQ(make_forest(o, 1).present_count(), 5001);
  o.apart = true;
  const Hierarchy h = make_forest(o, 1);
  EXPECT_NEAR(h.present_count() - 1, 5000, 300);
  EXPECT_EQ(h.parameter(0, kForestSpacing), o.distance);
  for (const int e : h.children(0)) EXPECT_EQ(h.position(e).z(), 0);
}

/// The yaw is the angle of the horizontal part's rotation, whatever its stretch.
TEST(GrammarSets, AnUprightTurnIsTheYawOfTheMap) {
  for (const double angle : {-3.1, -2.0, -0.4, 1e-9, 0.5, 1.7, 3.0}) {
    Eigen::Matrix3d m = 2 * Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
    m(2, 0) = 0.4;
    const Eigen::Quaterniond turn = upright_turn(m, Eigen::Quaterniond::Identity());
    EXPECT_NEAR(
        turn.angularDistance(Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitZ()))), 0,
        1e-7);
    EXPECT_EQ(turn.x(), 0);
    EXPECT_EQ(turn.y(), 0);
  }
  const Eigen::Quaterniond some(Eigen::AngleAxisd(1, Vector3d::UnitZ()));
  EXPECT_EQ(upright_turn(Eigen::Matrix3d::Identity(), some).coeffs(), some.coeffs());
}

TEST(GrammarSets, OptionsOutOfRangeAreErrors) {
  EXPECT_THROW(make_surface_set({.spacing = 3}, 1), Error);
  EXPECT_THROW(make_surface_set({.spacing = 1e-5}, 1), Error);
  EXPECT_THROW(make_volume_set({.width = -1}, 1), Error);
  EXPECT_THROW(make_volume_set({.spacing = 1e-4}, 1), Error);
  EXPECT_THROW(make_forest({.elements = 0}, 1), Error);
}

}  // namespace
}  // namespace geoprior::grammar
