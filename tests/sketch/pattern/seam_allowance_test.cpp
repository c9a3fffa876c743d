#include "experiments/sketch/pattern/seam_allowance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/random.h"
#include "tests/sketch/drawing/panel_check.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

using ::testing::HasSubstr;

AllowanceBorder even_border(const PlaneLoop& points, double allowance) {
  return {points, std::vector<double>(points.size(), allowance)};
}

std::vector<PlaneLoop> cut_evenly(const PlaneLoop& points, double allowance, double limit = 2.5) {
  return cut_lines({even_border(points, allowance)}, limit, "piece");
}

/// Even-odd over all loops.
bool loops_cover(const std::vector<PlaneLoop>& loops, const Eigen::Vector2d& p) {
  bool inside = false;
  for (const PlaneLoop& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Eigen::Vector2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      if (a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > p.x()) inside = !inside;
    }
  }
  return inside;
}

bool loop_crosses_itself(const PlaneLoop& loop) {
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j + 1 == n) continue;
      if (segments_meet(loop[i], loop[i + 1], loop[j], loop[(j + 1) % n])) return true;
    }
  }
  return false;
}

/// A star-shaped polygon with spikes and bays.
PlaneLoop random_star_loop(RandomStream& random, int corners) {
  PlaneLoop loop;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    const double radius = 0.03 + 0.12 * random.below(1000) / 1000.0;
    loop.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return loop;
}

const PlaneLoop kAllowanceSquare{{0, 0}, {0.1, 0}, {0.1, 0.1}, {0, 0.1}};

TEST(SeamAllowance, OfASquareIsALargerSquare) {
  const auto loops = cut_evenly(kAllowanceSquare, 0.01);
  ASSERT_EQ(loops.size(), 1U);
  const PlaneLoop expected{{-0.01, -0.01}, {0.11, -0.01}, {0.11, 0.11}, {-0.01, 0.11}};
  ASSERT_EQ(loops[0].size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((loops[0][i] - expected[i]).norm(), 1e-15);
}

TEST(SeamAllowance, OfNothingIsTheBorderPointForPoint) {
  const PlaneLoop hole{{0.02, 0.02}, {0.02, 0.05}, {0.05, 0.05}};
  const auto loops =
      cut_lines({even_border(kAllowanceSquare, 0), even_border(hole, 0)}, 2.5, "piece");
  EXPECT_EQ(loops, (std::vector<PlaneLoop>{kAllowanceSquare, hole}));
}

// A regular polygon with in-radius r becomes the same polygon with in-radius r + a.
TEST(SeamAllowance, OfARegularPolygonKeepsItsShape) {
  for (const int n : {5, 48, 700}) {
    PlaneLoop loop;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      loop.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle));
    }
    const auto loops = cut_evenly(loop, 0.007);
    ASSERT_EQ(loops.size(), 1U);
    ASSERT_EQ(loops[0].size(), loop.size());
    const double grown = 0.1 + 0.007 / std::cos(std::numbers::pi / n);
    for (const Eigen::Vector2d& p : loops[0]) EXPECT_NEAR(p.norm(), grown, 1e-14);
  }
}

// The cut never comes nearer to the border than asked, loops_cover the piece, does not cross
// itself, and reaches no further than the limit of mitres.
TEST(SeamAllowance, IsAtLeastAsWideAsAskedEverywhere) {
  RandomStream random(3, "stars");
  for (int round = 0; round < 200; ++round) {
    const PlaneLoop star = random_star_loop(random, 5 + static_cast<int>(random.below(40)));
    const double allowance = 0.001 + 0.02 * random.below(1000) / 1000.0;
    const double limit = 1 + 3.0 * random.below(1000) / 1000.0;
    const auto loops = cut_evenly(star, allowance, limit);
    ASSERT_FALSE(loops.empty());
    EXPECT_GT(loop_area(loops[0]), loop_area(star));
    for (std::size_t k = 0; k < loops.size(); ++k) {
      EXPECT_GE(test::distance_of_closed(loops[k], star), allowance - 1e-12) << round;
      EXPECT_FALSE(loop_crosses_itself(loops[k])) << round;
      EXPECT_EQ(loop_area(loops[k]) > 0, k == 0) << round;
      for (const Eigen::Vector2d& p : loops[k]) {
        // A corner of a straight cap: the cap's middle is at the limit, its half width less.
        EXPECT_LE(test::distance_to_closed(p, star), std::hypot(limit, 1) * allowance + 1e-12)
            << round;
      }
    }
    for (const Eigen::Vector2d& p : star) EXPECT_TRUE(loops_cover(loops, p));
  }
}

// Teeth of up to 3 mm and segments much shorter than the allowance.
TEST(SeamAllowance, PassesOverSmallTeeth) {
  RandomStream random(9, "teeth");
  for (int round = 0; round < 30; ++round) {
    PlaneLoop rough;
    for (int i = 0; i < 150; ++i) {
      const double angle = 2 * std::numbers::pi * i / 150;
      const double radius = 0.03 + 0.003 * random.below(1000) / 1000.0;
      rough.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    const auto loops = cut_evenly(rough, 0.007);
    EXPECT_GE(test::distance_of_closed(loops[0], rough), 0.007 - 1e-12) << round;
  }
}

// A bay of 6 mm radius, narrower than its allowance of 7 mm, is closed.
TEST(SeamAllowance, ClosesNarrowBays) {
  PlaneLoop plate{{0, 0}, {0.1, 0}, {0.1, 0.06}};
  for (int i = 0; i <= 40; ++i) {
    const double angle = std::numbers::pi * i / 40;
    plate.emplace_back(0.05 + 0.006 * std::cos(angle), 0.06 - 0.006 * std::sin(angle));
  }
  plate.emplace_back(0, 0.06);
  const auto loops = cut_evenly(plate, 0.007);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_GE(test::distance_of_closed(loops[0], plate), 0.007 - 1e-12);
  EXPECT_TRUE(loops_cover(loops, {0.05, 0.06}));
}

// Each segment's own strip is covered, whatever its neighbours' allowances are, none included.
TEST(SeamAllowance, CoversTheStripOfEachSegment) {
  RandomStream random(4, "strips");
  for (int round = 0; round < 100; ++round) {
    AllowanceBorder border{random_star_loop(random, 5 + static_cast<int>(random.below(20))), {}};
    const std::size_t n = border.points.size();
    for (std::size_t i = 0; i < n; ++i) {
      border.allowance.push_back(random.below(3) == 0 ? 0 : 0.02 * random.below(1000) / 1000.0);
    }
    const auto loops = cut_lines({border}, 2, "piece");
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d a = border.points[i], b = border.points[(i + 1) % n];
      const Eigen::Vector2d d = (b - a).normalized(), outward(d.y(), -d.x());
      for (const double t : {0.01, 0.5, 0.99}) {
        const double width = border.allowance[i] * (1 - 1e-9) - 1e-12;
        EXPECT_TRUE(loops_cover(loops, a + t * (b - a) + width * outward)) << round << " " << i;
      }
    }
  }
}

// A step of 1 mm, with 7 mm before and on it and none behind: below the step the strip before it
// is the only one.
TEST(SeamAllowance, KeepsAStripBesideASmallStep) {
  const PlaneLoop step{{0, 0}, {0.05, 0}, {0.05, -0.001}, {0.1, -0.001}, {0.1, 0.05}, {0, 0.05}};
  const auto loops = cut_lines({{step, {0.007, 0.007, 0, 0, 0, 0}}}, 2.5, "piece");
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_NEAR(loop_area(loops[0]), loop_area(step) + 0.05 * 0.007, 1e-15);
}

// A strip of 10 mm beside sides that are cut on the line: only one side moves.
TEST(SeamAllowance, ProlongsALineThatHasNone) {
  const auto loops = cut_lines({{kAllowanceSquare, {0.01, 0, 0, 0}}}, 2.5, "piece");
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_NEAR(loop_area(loops[0]), 0.1 * 0.11, 1e-15);
  EXPECT_EQ(loops[0].size(), 4U);
}

// Two strips of a straight side, 10 and 4 mm wide, meet in a step.
TEST(SeamAllowance, StepsWhereItChangesOnAStraightLine) {
  const PlaneLoop square{{0, 0}, {0.05, 0}, {0.1, 0}, {0.1, 0.1}, {0, 0.1}};
  const auto loops = cut_lines({{square, {0.01, 0.004, 0, 0, 0}}}, 2.5, "piece");
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_NEAR(loop_area(loops[0]), 0.01 + 0.05 * 0.014, 1e-15);
}

// Corner of 2 atan(1/10): its mitre would reach 10 allowances far, the cap is at twice.
TEST(SeamAllowance, CutsSharpCornersAcross) {
  const PlaneLoop spike{{0, -0.01}, {0.1, 0}, {0, 0.01}};
  const auto right = [](const PlaneLoop& loop) {
    double most = 0;
    for (const Eigen::Vector2d& p : loop) most = std::max(most, p.x());
    return most;
  };
  EXPECT_NEAR(right(cut_evenly(spike, 0.005, 2)[0]), 0.1 + 2 * 0.005, 1e-14);
  const double mitre = 0.005 * std::hypot(1, 0.1) / 0.1;
  EXPECT_NEAR(right(cut_evenly(spike, 0.005, 20)[0]), 0.1 + mitre, 1e-14);
}

// A dart of 4 mm between allowances of 7 mm is closed; one of 40 mm leaves a notch of 26 mm.
TEST(SeamAllowance, ClosesNarrowDarts) {
  const auto with_dart = [](double width) {
    return PlaneLoop{
        {0, 0},  {0.2, 0}, {0.2, 0.1}, {0.1 + width / 2, 0.1}, {0.1, 0.04}, {0.1 - width / 2, 0.1},
        {0, 0.1}};
  };
  const auto closed = cut_evenly(with_dart(0.004), 0.007);
  ASSERT_EQ(closed.size(), 1U);
  EXPECT_NEAR(loop_area(closed[0]), 0.214 * 0.114, 1e-4);
  EXPECT_TRUE(loops_cover(closed, {0.1, 0.08}));
  const auto open = cut_evenly(with_dart(0.08), 0.007);
  ASSERT_EQ(open.size(), 1U);
  EXPECT_FALSE(loops_cover(open, {0.1, 0.08}));
}

// A ring with a slit of 10 mm: allowances of 7 mm close the slit, what is left inside is a hole of
// 60 - 14 mm.
TEST(SeamAllowance, LeavesAHoleBehindAClosedSlit) {
  const PlaneLoop c{{0, 0},        {0.1, 0},     {0.1, 0.045}, {0.08, 0.045},
                    {0.08, 0.02},  {0.02, 0.02}, {0.02, 0.08}, {0.08, 0.08},
                    {0.08, 0.055}, {0.1, 0.055}, {0.1, 0.1},   {0, 0.1}};
  const auto loops = cut_evenly(c, 0.007);
  ASSERT_EQ(loops.size(), 2U);
  EXPECT_NEAR(loop_area(loops[0]), 0.114 * 0.114, 2e-5) << "a groove is left at the slit's mouth";
  EXPECT_NEAR(loop_area(loops[1]), -0.046 * 0.046, 1e-15);
}

TEST(SeamAllowance, NarrowsHolesUntilTheyAreGone) {
  const PlaneLoop hole{{0.03, 0.03}, {0.03, 0.06}, {0.06, 0.06}, {0.06, 0.03}};
  const auto with_hole = [&](double allowance) {
    return cut_lines({even_border(kAllowanceSquare, 0), even_border(hole, allowance)}, 2.5,
                     "piece");
  };
  const auto loops = with_hole(0.005);
  ASSERT_EQ(loops.size(), 2U);
  EXPECT_NEAR(loop_area(loops[0]), 0.01, 1e-15);
  EXPECT_NEAR(loop_area(loops[1]), -0.02 * 0.02, 1e-15);
  EXPECT_EQ(with_hole(0.016).size(), 1U);
}

TEST(SeamAllowance, NamesWhatCannotBeCut) {
  const auto refusal = [](const std::vector<AllowanceBorder>& borders, double limit = 2) {
    return test::error_of([&] { cut_lines(borders, limit, "piece 3 'sleeve'"); });
  };
  const PlaneLoop bow{{0, 0}, {0.1, 0.1}, {0.1, 0}, {0, 0.2}};
  EXPECT_THAT(refusal({even_border(bow, 0.01)}), HasSubstr("piece 3 'sleeve'"));
  EXPECT_THAT(refusal({even_border(bow, 0.01)}), HasSubstr("meets itself"));
  EXPECT_THAT(refusal({even_border({{0, 0}, {0.1, 0}, {0.05, 0}, {0.05, 0.1}}, 0)}),
              HasSubstr("segment 0 of loop 0"));
  PlaneLoop turned = kAllowanceSquare;
  std::reverse(turned.begin(), turned.end());
  EXPECT_THAT(refusal({even_border(turned, 0)}), HasSubstr("wrong way"));
  EXPECT_THAT(refusal({even_border({{0, 0}, {1, 0}}, 0)}), HasSubstr("three points"));
  EXPECT_THAT(refusal({even_border(kAllowanceSquare, -1)}), HasSubstr("allowance of segment 0"));
  EXPECT_THAT(refusal({even_border(kAllowanceSquare, NAN)}), HasSubstr("allowance of segment 0"));
  EXPECT_THAT(refusal({even_border(kAllowanceSquare, 0.01)}, 0.5), HasSubstr("miter limit"));
  EXPECT_THAT(refusal({even_border({{0, 0}, {1, 0}, {1, 0}, {0, 1}}, 0)}), HasSubstr("repeats"));
}

}  // namespace
}  // namespace geoprior::sketch
