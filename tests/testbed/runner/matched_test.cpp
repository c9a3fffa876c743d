#include "testbed/runner/judgement/matched.h"

#include <gtest/gtest.h>

#include <cmath>

namespace geoprior {
namespace {

/// Costs and errors of one case.
Matched matched(const Priced& method, const std::vector<std::vector<Priced>>& families) {
  return {method, families, {}};
}

// A rival whose error falls like one over its cost costs 4 at an error of 1/4.
TEST(Matched, CostIsInterpolatedInTheLogarithms) {
  const std::vector<Priced> rival{{{1}, {1}}, {{2}, {0.5}}, {{8}, {0.125}}};
  EXPECT_NEAR(matched_ratio(matched({{2}, {0.25}}, {rival})), 2, 1e-12);
  EXPECT_NEAR(matched_ratio(matched({{4}, {0.25}}, {rival})), 1, 1e-12);
  // Another that is there at once, at a cost of 3.
  EXPECT_NEAR(matched_ratio(matched({{2}, {0.25}}, {rival, {{{3}, {0.2}}}})), 1.5, 1e-12);
}

TEST(Matched, ARivalIsItsBestSoFarOrNever) {
  // The middle one costs more and errs more than the first: nobody would take it.
  const std::vector<Priced> rival{{{1}, {1}}, {{3}, {2}}, {{4}, {0.25}}};
  EXPECT_NEAR(matched_ratio(matched({{1}, {0.5}}, {rival})), 2, 1e-12);
  EXPECT_EQ(matched_ratio(matched({{2}, {1.5}}, {rival})), 0.5) << "the coarsest does";
  EXPECT_TRUE(std::isinf(matched_ratio(matched({{2}, {0.1}}, {rival}))));
  EXPECT_EQ(matched_ratio(matched({{2}, {0}}, {{{{1}, {1}}, {{5}, {0}}}})), 2.5);
}

// Halfway to the method's error the rival has kept 0.9: it counts where 0.1 less are allowed.
TEST(Matched, ARivalPaysWithNothingThatIsKept) {
  const std::vector<Priced> rival{{{1}, {1}, {1}}, {{4}, {0.25}, {0.8}}};
  Matched all = matched({{1}, {0.5}, {1}}, {rival});
  all.within = 0.11;
  EXPECT_NEAR(matched_ratio(all), 2, 1e-12);
  all.within = 0.09;
  EXPECT_TRUE(std::isinf(matched_ratio(all)));
  all.families.push_back({{{3}, {0.5}, {0.95}}});
  EXPECT_EQ(matched_ratio(all), 3) << "another keeps it";
  all.method.kept = {0.5};
  EXPECT_NEAR(matched_ratio(all), 2, 1e-12) << "more than the method has is no loss";
}

// Of sorted values: the method has the truth's in another order.
TEST(Matched, ErrorAgainstATruthIsThatOfDistributions) {
  EXPECT_EQ(error_of({{1, 1, 1}, {3, 1, 2}}, {1, 2, 3}), 0);
  EXPECT_EQ(error_of({{1, 1}, {1, 5}}, {4, 2}), 1);
  EXPECT_EQ(error_of({{1, 1}, {1, 5}}, {}), 3);
  EXPECT_EQ(cost_of({{1, 9, 2}, {0, 0, 0}}, Reduction::median), 2);
  EXPECT_EQ(cost_of({{1, 9, 2}, {0, 0, 0}}, Reduction::mean), 4);
}

TEST(Matched, IntervalIsOfTheCases) {
  const Matched all{{{1, 1, 1, 1}, {1, 2, 3, 4}},
                    {{{{2, 2, 3, 3}, {9, 9, 9, 9}}, {{4, 4, 5, 5}, {1, 1, 1, 1}}}},
                    {}};
  const Interval interval = matched_with_interval(all, RandomStream(1, "x"));
  EXPECT_LT(interval.low, interval.value);
  EXPECT_GT(interval.high, interval.value);
  EXPECT_EQ(matched_with_interval(all, RandomStream(1, "x")).low, interval.low);
  EXPECT_TRUE(std::isnan(
      matched_with_interval(matched({{1}, {1}}, {{{{2}, {1}}}}), RandomStream(1, "x")).low));
}

}  // namespace
}  // namespace geoprior
