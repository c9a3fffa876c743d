#include "core/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace geoprior {
namespace {

// Reference output of the PCG32 demo program (O'Neill 2014): seed 42, stream 54.
TEST(RandomStream, MatchesThePublishedPcg32Sequence) {
  RandomStream stream(42, std::uint64_t{54});
  for (const std::uint32_t expected :
       {0xa15c02b7U, 0x7b47f409U, 0xba1d3330U, 0x83d2f293U, 0xbfa4784bU, 0xcbed606eU}) {
    EXPECT_EQ(stream.next(), expected);
  }
}

TEST(SceneSeed, IsTheKeyOfTheSceneWhereTheExperimentHasTheFirstSeed) {
  for (const int own : {0, 1, 2, 1000003})
    EXPECT_EQ(scene_seed(1, own), static_cast<unsigned>(own));
  EXPECT_EQ(scene_seed(7), 7U);
  EXPECT_NE(scene_seed(2, 5), scene_seed(1, 5));
  EXPECT_NE(scene_seed(2, 5), scene_seed(2, 6));
}

TEST(RandomStream, UniformAndNormalHaveTheirMoments) {
  RandomStream stream(7, "moments");
  constexpr int kDraws = 200000;
  double sum_uniform = 0, sum_normal = 0, sum_normal_squared = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = stream.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum_uniform += u;
    const double z = stream.normal();
    sum_normal += z;
    sum_normal_squared += z * z;
  }
  EXPECT_NEAR(sum_uniform / kDraws, 0.5, 5 / std::sqrt(12.0 * kDraws));
  EXPECT_NEAR(sum_normal / kDraws, 0, 5 / std::sqrt(1.0 * kDraws));
  EXPECT_NEAR(sum_normal_squared / kDraws, 1, 5 * std::sqrt(2.0 / kDraws));
}

}  // namespace
}  // namespace geoprior
