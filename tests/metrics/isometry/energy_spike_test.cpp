#include "metrics/isometry/energy_spike.h"

#include <gtest/gtest.h>

#include <vector>

namespace geoprior {
namespace {

TEST(EnergySpike, IsTheRatioToTheGreaterNeighbour) {
  EXPECT_DOUBLE_EQ(energy_spike(std::vector<double>{1, 2, 12, 4, 5}, 0.1), 3);
}

TEST(EnergySpike, SteadyGrowthHasNone) {
  EXPECT_LE(energy_spike(std::vector<double>{1, 2, 4, 8, 16}, 0), 1);
}

/// A fold of a microjoule beside one of a joule is no event.
TEST(EnergySpike, SmallEnergiesDoNotCount) {
  const std::vector<double> energies{1e-6, 1e-3, 1e-6, 1, 1};
  EXPECT_LE(energy_spike(energies, 0.1), 1);
  EXPECT_GT(energy_spike(energies, 0), 900);
}

TEST(EnergySpike, TwoFramesHaveNone) {
  EXPECT_EQ(energy_spike(std::vector<double>{1, 2}, 0), 0);
  EXPECT_EQ(energy_spike({}, 0), 0);
}

}  // namespace
}  // namespace geoprior
