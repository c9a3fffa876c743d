// Deformation by the mean value coordinates of a closed cage.

#include "experiments/grammar/maps/cage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/grammar/maps/sampled_map.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using geoprior::test::expect_error;

/// A prism of `sides` sides about the box of the samples, in rings of radius 6 from z = -1 to 9,
/// the ring of number `waist` of half that radius.
TriMesh prism_cage(int sides, int rings, int waist = -1) {
  TriMesh out;
  out.V.resize(sides * rings + 2, 3);
  for (int k = 0; k < rings; ++k) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides, r = k == waist ? 3 : 6;
      out.V.row(k * sides + i) << r * std::cos(angle), r * std::sin(angle),
          -1 + 10.0 * k / (rings - 1);
    }
  }
  const int bottom = sides * rings, top = bottom + 1;
  out.V.row(bottom) << 0, 0, -1;
  out.V.row(top) << 0, 0, 9;
  out.F.resize(2 * sides * rings, 3);
  int row = 0;
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    out.F.row(row++) << bottom, next, i;
    for (int k = 0; k + 1 < rings; ++k) {
      const int below = k * sides, above = below + sides;
      out.F.row(row++) << below + i, below + next, above + next;
      out.F.row(row++) << below + i, above + next, above + i;
    }
    out.F.row(row++) << top, (rings - 1) * sides + i, (rings - 1) * sides + next;
  }
  return out;
}

Cage squeezed_cage() {
  Cage cage{prism_cage(8, 4), {}};
  cage.moved = cage.rest.V;
  for (Eigen::Index i = 8; i < 24; ++i) cage.moved.row(i).head<2>() *= 0.7;
  return cage;
}

/// To round-off in a convex cage. The planes of a concave one's triangles go through its inside;
/// near them digits cancel.
TEST(GrammarCage, ReproducesAffineMaps) {
  Matrix3d A;
  A << 0.9, 0.2, -0.1, 0.05, 1.2, 0.3, 0.1, -0.2, 0.8;
  const Vector3d b(0.5, -1, 2);
  for (const bool convex : {true, false}) {
    Cage cage{prism_cage(7, 5, convex ? -1 : 2), {}};
    cage.moved = (cage.rest.V * A.transpose()).rowwise() + b.transpose();
    const CageMap map(cage, 1);
    for (const Vector3d& x : samples::points_in(samples::kSampledBox, 300, 1))
      EXPECT_LT((map.at(x) - (A * x + b)).norm(), convex ? 1e-12 : 1e-9) << x.transpose();
  }
}

TEST(GrammarCage, CarriesItsVerticesAndTriangles) {
  const Cage cage = squeezed_cage();
  const CageMap map(cage, 1);
  for (Eigen::Index i = 0; i < cage.rest.V.rows(); ++i)
    EXPECT_LT((map.at(cage.rest.V.row(i)) - cage.moved.row(i).transpose()).norm(), 1e-12);
  for (Eigen::Index t = 0; t < cage.rest.F.rows(); ++t) {
    const auto middle = [&](const Eigen::MatrixX3d& V) -> Vector3d {
      return 0.2 * V.row(cage.rest.F(t, 0)) + 0.3 * V.row(cage.rest.F(t, 1)) +
             0.5 * V.row(cage.rest.F(t, 2));
    };
    EXPECT_LT((map.at(middle(cage.rest.V)) - middle(cage.moved)).norm(), 1e-6) << "triangle " << t;
  }
}

/// By symmetry: opposite vertices have equal weights and opposite shifts.
TEST(GrammarCage, CentreOfAPrismStaysWhenItIsSqueezedFromAllSides) {
  const Cage cage = squeezed_cage();
  const Vector3d centre(0, 0, 4), shift = CageMap(cage, 1).at(centre) - centre;
  EXPECT_LT(shift.norm(), 1e-12);
}

TEST(GrammarCage, PushesWhatIsInsideInwards) {
  const CageMap map(squeezed_cage(), 1);
  EXPECT_LT(map.at({4, 0, 4}).x(), 4 * 0.85);
  EXPECT_GT(map.at({4, 0, 4}).x(), 4 * 0.6);
  EXPECT_EQ(map.support(), std::nullopt);
}

TEST(GrammarCage, JacobianByDifferencesIsTheDerivative) {
  const CageMap map(squeezed_cage(), 1);
  EXPECT_LT(samples::jacobian_error(map, samples::points_in(samples::kSampledBox, 100, 2)), 1e-6);
  EXPECT_GT(samples::least_determinant(map, samples::points_in(samples::kSampledBox, 100, 3)), 0.2);
}

TEST(GrammarCage, GrowsFromRestWithItsFraction) {
  const Cage cage = squeezed_cage();
  const CageMap none(cage, 0), part(cage, 0.25), all(cage, 1);
  for (const Vector3d& x : samples::points_in(samples::kSampledBox, 100, 4)) {
    EXPECT_LT((none.at(x) - x).norm(), 1e-12);
    EXPECT_LT((part.at(x) - x - 0.25 * (all.at(x) - x)).norm(), 1e-12);
  }
}

/// Planes of the waist's triangles go through the inside; the map has no jump there.
TEST(GrammarCage, HasNoJumpAtThePlanesOfItsTriangles) {
  Cage cage{prism_cage(8, 5, 2), {}};
  cage.moved = cage.rest.V;
  cage.moved.col(0) += 0.3 * cage.rest.V.col(2).array().sin().matrix();
  const CageMap map(cage, 1);
  for (Eigen::Index t = 0; t < cage.rest.F.rows(); ++t) {
    const Vector3d a = cage.rest.V.row(cage.rest.F(t, 0)), b = cage.rest.V.row(cage.rest.F(t, 1)),
                   c = cage.rest.V.row(cage.rest.F(t, 2));
    const Vector3d normal = (b - a).cross(c - a).normalized();
    for (const Vector3d& p : samples::points_in(samples::kSampledBox, 5, static_cast<int>(t))) {
      const Vector3d on_plane = p - normal.dot(p - a) * normal;
      if (on_plane.head<2>().norm() > 2 || std::abs(on_plane.z() - 4) > 3.5) continue;
      const Vector3d there = map.at(on_plane);
      for (const double off : {1e-13, 1e-11, 1e-9, 1e-7})
        EXPECT_LT((map.at(on_plane + off * normal) - there).norm(), 1e-6)
            << "triangle " << t << " at " << on_plane.transpose() << " off by " << off;
    }
  }
}

TEST(GrammarCage, RefusesWhatIsNoCage) {
  const auto refuses = [](const auto& change, const std::string& part) {
    Cage cage = squeezed_cage();
    change(cage);
    expect_error([&] { CageMap(cage, 1); }, {part});
  };
  refuses([](Cage& c) { c.rest.F = c.rest.F.topRows(c.rest.F.rows() - 1).eval(); }, "edge");
  refuses([](Cage& c) { c.rest.F.row(3).reverseInPlace(); }, "edge");
  refuses([](Cage& c) { c.moved = c.moved.topRows(5).eval(); }, "5 moved");
  refuses([](Cage& c) { c.moved(3, 1) = std::numeric_limits<double>::quiet_NaN(); }, "finite");
  refuses([](Cage& c) { c.rest.V(3, 1) = std::numeric_limits<double>::infinity(); }, "finite");
}

}  // namespace
}  // namespace geoprior::grammar
