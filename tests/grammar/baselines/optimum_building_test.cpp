#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "baselines/grammar/optimum/building.h"
#include "experiments/grammar/maps/gesture.h"
#include "experiments/grammar/scene/building.h"
#include "models/grammar/objects/building_layout.h"
#include "solvers/grammar/engine/derivation.h"
#include "solvers/grammar/rules/building_stack.h"
#include "solvers/grammar/rules/rules.h"

namespace geoprior::grammar {
namespace {

double building_deviation(const Hierarchy& rest, const Hierarchy& state, const SpatialMap& map) {
  double sum = 0;
  int elements = 0;
  for (int e = 0; e < rest.size(); ++e) {
    if (!rest.present(e) || !state.present(e)) continue;
    std::vector<Eigen::Vector3d> before, after;
    rest.keys(e, before);
    state.keys(e, after);
    double own = 0;
    for (std::size_t k = 0; k < before.size(); ++k)
      own += (after[k] - map.at(before[k])).squaredNorm();
    sum += own / static_cast<double>(before.size());
    ++elements;
  }
  return std::sqrt(sum / elements);
}

TEST(GrammarOptimumBuilding, FindsAMotionThatTheBuildingCanFollow) {
  const Hierarchy rest = make_building({.storeys = 3}, 2);
  Eigen::Affine3d motion(Eigen::Translation3d(1, 2, 0.5));
  motion.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  const OptimumResult found = optimise_building(rest, rest, AffineMap(motion));
  EXPECT_LT(found.deviation, 1e-5);
  EXPECT_LE(found.gradient, 1e-6);
}

TEST(GrammarOptimumBuilding, NoWorseThanTheRulesAndWithinTheLimits) {
  const Hierarchy rest = make_building({.storeys = 4}, 2);
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-6, -5, 0), Eigen::Vector3d(6, 5, 16));
  for (int number = 0; number < 4; ++number) {
    const auto map = map_of(random_gesture(21, number, box), 1);
    Hierarchy grammar = rest;
    Transaction transaction(grammar);
    derive(grammar, transaction, building_rules(), {0, Delta::free(map)});
    const OptimumResult found = optimise_building(rest, grammar, *map);
    found.state.require_valid();
    EXPECT_NEAR(found.deviation, building_deviation(rest, found.state, *map), 1e-12);
    // The optimum keeps a margin of 1e-5 m of all limits.
    EXPECT_LE(found.deviation, building_deviation(rest, grammar, *map) + 1e-4);
    EXPECT_LE(found.gradient, 1e-6);
    const std::vector<int> storeys = storeys_of(found.state, 0);
    for (std::size_t i = 1; i < storeys.size(); ++i) {
      const auto of = [&](int s) {
        const Hierarchy& h = found.state;
        return storey_box(h.pose(s), h.parameter(s, 0), h.parameter(s, 1), h.parameter(s, 2));
      };
      EXPECT_LE(overhang(of(storeys[i - 1]), of(storeys[i])), kMostOverhang);
    }
  }
}

// All storeys are asked to be 6 m high: the nearest ones that are allowed are 4.5 m, in the middle.
TEST(GrammarOptimumBuilding, HeightsEndAtTheirLimit) {
  const Hierarchy rest = make_building({.storeys = 2, .storey_height = 3, .variety = 0}, 1);
  const AffineMap map(Eigen::Affine3d(Eigen::Scaling(1., 1., 2.)));
  const OptimumResult found = optimise_building(rest, rest, map);
  for (const int storey : storeys_of(found.state, 0))
    EXPECT_NEAR(found.state.parameter(storey, StoreyParameter::height), kMostStoreyHeight, 1e-4);
}

}  // namespace
}  // namespace geoprior::grammar
