// Free-form deformation by a box of control points.

#include "experiments/grammar/maps/lattice.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/grammar/maps/sampled_map.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using geoprior::test::expect_error;

/// Control points over the box of the samples, x fastest, moved by `shift(position)`.
template <class Shift>
Lattice lattice_over_samples(const std::array<int, 3>& points, const Shift& shift) {
  Lattice out{samples::kSampledBox.min(), samples::kSampledBox.max(), points, {}};
  for (int k = 0; k < points[2]; ++k) {
    for (int j = 0; j < points[1]; ++j) {
      for (int i = 0; i < points[0]; ++i) {
        const Vector3d u(i / (points[0] - 1.0), j / (points[1] - 1.0), k / (points[2] - 1.0));
        out.shifts.push_back(shift(out.low + u.cwiseProduct(out.high - out.low)));
      }
    }
  }
  return out;
}

Lattice wavy_lattice() {
  return lattice_over_samples({4, 3, 5}, [](const Vector3d& p) -> Vector3d {
    return {0.3 * p.z() * p.y() / 8, 0.2 * p.x() * p.x() / 3, 0.1 * p.x() * p.y() * p.z() / 20};
  });
}

TEST(GrammarLattice, ReproducesAffineMaps) {
  Matrix3d A;
  A << 0.9, 0.2, -0.1, 0.05, 1.2, 0.3, 0.1, -0.2, 0.8;
  const Vector3d b(0.5, -1, 2);
  const Lattice lattice =
      lattice_over_samples({5, 4, 7}, [&](const Vector3d& p) -> Vector3d { return A * p + b - p; });
  const LatticeMap map(lattice, 1);
  for (const Vector3d& x : samples::points_in(samples::kSampledBox, 500, 1)) {
    const MappedPoint m = map.with_jacobian(x);
    EXPECT_LT((m.position - (A * x + b)).norm(), 1e-12);
    EXPECT_LT((m.jacobian - A).norm(), 1e-12);
  }
}

/// Of three control points the middle one has the polynomial 2 u (1 - u), which is 1/2 there.
TEST(GrammarLattice, MiddlePointMovesItsPlaceByAnEighth) {
  Lattice lattice =
      lattice_over_samples({3, 3, 3}, [](const Vector3d&) { return Vector3d(0, 0, 0); });
  lattice.shifts[13] = {1, 2, -3};
  const Vector3d centre = samples::kSampledBox.center();
  const Vector3d shift = LatticeMap(lattice, 1).at(centre) - centre;
  EXPECT_LT((shift - Vector3d(1, 2, -3) / 8).norm(), 1e-15);
}

TEST(GrammarLattice, JacobianIsTheDerivative) {
  const LatticeMap map(wavy_lattice(), 0.7);
  Eigen::AlignedBox3d inside = samples::kSampledBox;
  inside.min().array() += 0.01;
  inside.max().array() -= 0.01;
  EXPECT_LT(samples::jacobian_error(map, samples::points_in(inside, 500, 2)), 1e-8);
}

TEST(GrammarLattice, IdentityBitForBitOutsideTheBox) {
  const LatticeMap map(wavy_lattice(), 1);
  const Eigen::AlignedBox3d wide(Vector3d(-9, -9, -6), Vector3d(9, 9, 14));
  for (const Vector3d& x : samples::points_in(wide, 500, 3)) {
    if (map.support()->contains(x)) continue;
    EXPECT_EQ(map.at(x), x);
    EXPECT_EQ(map.with_jacobian(x).jacobian, Matrix3d::Identity());
  }
}

TEST(GrammarLattice, ShiftGrowsInProportionToTheFraction) {
  const Lattice lattice = wavy_lattice();
  const LatticeMap all(lattice, 1), part(lattice, 0.3);
  for (const Vector3d& x : samples::points_in(samples::kSampledBox, 100, 4))
    EXPECT_LT((part.at(x) - x - 0.3 * (all.at(x) - x)).norm(), 1e-14);
}

/// With a plane of control points carried past the next one, space is turned inside out between.
TEST(GrammarLattice, FoldHasANegativeDeterminant) {
  const Lattice folded = lattice_over_samples({2, 2, 2}, [](const Vector3d& p) -> Vector3d {
    return {-1.5 * p.x(), 0, 0};
  });
  EXPECT_LT(LatticeMap(folded, 1).with_jacobian({0, 0, 1}).jacobian.determinant(), 0);
}

TEST(GrammarLattice, RefusesWhatIsNoLattice) {
  const auto refuses = [](const auto& change, const std::string& part) {
    Lattice lattice = wavy_lattice();
    change(lattice);
    expect_error([&] { require_valid(lattice, "lattice 3"); }, {"lattice 3", part});
  };
  refuses([](Lattice& l) { l.high.y() = l.low.y(); }, "no volume");
  refuses([](Lattice& l) { l.points[1] = 1; }, "1 control points");
  refuses([](Lattice& l) { l.points[2] = 1000000; }, "1000000 control points");
  refuses([](Lattice& l) { l.shifts.pop_back(); }, "59 shifts");
  refuses([](Lattice& l) { l.shifts[4].x() = std::numeric_limits<double>::infinity(); }, "finite");
}

}  // namespace
}  // namespace geoprior::grammar
