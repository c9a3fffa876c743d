#include "baselines/paper/pattern.h"

#include <gtest/gtest.h>

namespace geoprior {
namespace {

TEST(Pattern, AreaOfASquareIsPositiveCounterClockwise) {
  EXPECT_DOUBLE_EQ(signed_area({{{0, 0}, {2, 0}, {2, 2}, {0, 2}}}), 4);
}

}  // namespace
}  // namespace geoprior
