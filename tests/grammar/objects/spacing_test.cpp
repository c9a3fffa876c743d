#include "models/grammar/objects/spacing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

/// Elements at random in a box, denser than they can be, of all kinds and states.
SpacedSet crowded_set(std::uint64_t seed, int n, const Vector3d& sides) {
  RandomStream random(seed);
  SpacedSet set;
  for (int i = 0; i < n; ++i) {
    const Vector3d x(random.uniform(), random.uniform(), random.uniform());
    const std::uint32_t kind = random.below(20), state = random.below(8);
    set.add(x.cwiseProduct(sides), 0.6 + 0.5 * random.uniform(), random.uniform(),
            kind == 0   ? SpacedKind::fixed
            : kind < 12 ? SpacedKind::element
                        : SpacedKind::candidate,
            state == 0   ? SpacedState::known
            : state == 1 ? SpacedState::kept
            : state < 5  ? SpacedState::asked
                         : SpacedState::moved);
  }
  return set;
}

/// Elements and candidates at rest in a square, mapped.
template <class Map>
SpacedSet mapped_rest(const Map& map) {
  RandomStream random(3);
  std::vector<Vector3d> points(8000);
  for (Vector3d& x : points) x = {20 * random.uniform(), 20 * random.uniform(), 0};
  const Eigen::AlignedBox3d box(Vector3d::Zero(), Vector3d(20, 20, 0));
  const DiskSampling disk = sample_disks(
      8000, [&](int i) { return points[i]; }, box, 1.0);
  SpacedSet set;
  for (const Vector3d& x : disk.elements)
    set.add(map(x), 0.5, 1, SpacedKind::element, SpacedState::moved);
  for (const Vector3d& x : disk.candidates)
    set.add(map(x), 0.5, 0, SpacedKind::candidate, SpacedState::moved);
  return set;
}

int pairs_too_close(const SpacedSet& set, const std::vector<double>& size) {
  int out = 0;
  for (int i = 0; i < set.count(); ++i)
    for (int j = 0; j < i; ++j) {
      if (size[i] == 0 || size[j] == 0) continue;
      const double least = size[i] * set.radius[i] + size[j] * set.radius[j];
      if ((set.x[i] - set.x[j]).norm() < least) ++out;
    }
  return out;
}

TEST(GrammarSpacing, TheGridGivesTheFormulasSizesBitForBit) {
  for (const Vector3d& sides : {Vector3d(300, 0, 0), Vector3d(20, 20, 0), Vector3d(9, 9, 9)})
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const SpacedSet set = crowded_set(seed, 400, sides);
      EXPECT_EQ(spaced_sizes(set), spaced_sizes_plainly(set)) << sides.transpose();
    }
}

TEST(GrammarSpacing, SizesAreTheSameAtAnyThreadCount) {
  const SpacedSet set = crowded_set(7, 30000, {150, 150, 0});
  std::vector<double> one, two;
  with_threads(1, [&] { one = spaced_sizes(set); });
  with_threads(2, [&] { two = spaced_sizes(set); });
  EXPECT_EQ(one, two);
}

TEST(GrammarSpacing, AtRestAllElementsAreWholeAndNoCandidateIsThere) {
  const SpacedSet set = mapped_rest([](const Vector3d& x) { return x; });
  const std::vector<double> size = spaced_sizes(set);
  for (int i = 0; i < set.count(); ++i)
    EXPECT_EQ(size[i], set.kind[i] == SpacedKind::element ? 1 : 0);
}

TEST(GrammarSpacing, DistancesHoldUnderAnyMap) {
  for (const double squeeze : {0.05, 0.3, 0.7, 1.2, 2.5}) {
    const SpacedSet set = mapped_rest(
        [&](const Vector3d& x) { return Vector3d(squeeze * x.x(), x.y() + std::sin(x.x()), 0); });
    EXPECT_EQ(pairs_too_close(set, spaced_sizes(set)), 0) << squeeze;
  }
}

/// Twice the length along x: the area doubles, and holes of over a spacing are filled.
TEST(GrammarSpacing, CandidatesFillWhatIsStretched) {
  const SpacedSet set =
      mapped_rest([](const Vector3d& x) { return Vector3d(2 * x.x(), x.y(), 0); });
  const std::vector<double> size = spaced_sizes(set);
  int whole = 0, grown = 0;
  for (int i = 0; i < set.count(); ++i) {
    if (set.kind[i] == SpacedKind::element) whole += size[i] == 1 ? 1 : 0;
    if (set.kind[i] == SpacedKind::candidate) grown += size[i] > 0.5 ? 1 : 0;
  }
  const auto elements = std::count(set.kind.begin(), set.kind.end(), SpacedKind::element);
  EXPECT_EQ(whole, elements);
  EXPECT_GT(grown, 0.2 * static_cast<double>(elements));
}

/// A size is a minimum of distances over a radius, less sizes before: where all places move by at
/// most d, it changes by a small multiple of 2 d / R, or of that over the band of a candidate.
TEST(GrammarSpacing, SizesAreContinuousInPlaces) {
  const auto sizes_at = [](double squeeze) {
    return spaced_sizes(mapped_rest(
        [&](const Vector3d& x) { return Vector3d(squeeze * x.x(), (2 - squeeze) * x.y(), 0); }));
  };
  constexpr double kStep = 1e-7, kMoved = 20 * kStep;
  for (const double squeeze : {0.6, 0.85, 0.97}) {
    const std::vector<double> a = sizes_at(squeeze), b = sizes_at(squeeze + kStep);
    double jump = 0;
    for (std::size_t i = 0; i < a.size(); ++i) jump = std::max(jump, std::abs(a[i] - b[i]));
    EXPECT_GT(jump, 0);
    EXPECT_LT(jump, 100 * kMoved / 0.5) << squeeze;
  }
}

TEST(GrammarSpacing, WhatIsFarFromWhatMovedKeepsItsSize) {
  SpacedSet set = mapped_rest([](const Vector3d& x) { return Vector3d(0.8 * x.x(), x.y(), 0); });
  set.size = spaced_sizes(set);
  // A size that no formula gives, of an element that nobody asks.
  std::fill(set.state.begin(), set.state.end(), SpacedState::kept);
  set.size[0] = 0.123;
  set.state[1] = SpacedState::asked;
  EXPECT_EQ(spaced_sizes(set), set.size);
}

TEST(GrammarSpacing, CirclesThatMeetArePushedApartTheOthersStay) {
  std::vector<SpacedCircle> circles{{{0, 0}, 1, false}, {{1, 0}, 1, true}, {{0, 5}, 1, false}};
  EXPECT_TRUE(push_circles_apart(circles));
  EXPECT_NEAR((circles[0].centre - Eigen::Vector2d(-1, 0)).norm(), 0, 1e-5);
  EXPECT_EQ(circles[1].centre, Eigen::Vector2d(1, 0));
  EXPECT_EQ(circles[2].centre, Eigen::Vector2d(0, 5));
  EXPECT_FALSE(circles_meet(circles[0], circles[1]));
}

/// A straight path of so many stones at rest, with three candidates after each but the last.
std::vector<PathStone> path_at_rest(int stones) {
  std::vector<PathStone> out;
  const int n = 4 * (stones - 1);
  for (int i = 0; i <= n; ++i)
    out.push_back({1. * i / n, {i / 4., 0, 0}, i % 4 == 0 ? 1. : 0., i % 4 != 0, false});
  return out;
}

std::optional<Vector3d> flat_ground(const Vector3d& x) { return Vector3d(x.x(), x.y(), 0); }

TEST(GrammarSpacing, APathAtRestStaysBitForBit) {
  const std::vector<PathStone> rest = path_at_rest(20);
  std::vector<PathStone> stones = rest;
  space_path(stones, 1, flat_ground);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    EXPECT_EQ(stones[i].size, rest[i].size);
    EXPECT_EQ(stones[i].x, rest[i].x);
  }
}

TEST(GrammarSpacing, StepsOfAPathStayInTheirRange) {
  for (const double stretch : {0.1, 0.45, 0.7, 1.0, 1.3, 1.7, 2.9, 3.6}) {
    std::vector<PathStone> stones = path_at_rest(30);
    // More at one end than at the other.
    for (PathStone& s : stones) {
      const double u = s.x.x();
      s.x = {stretch * (u + 0.008 * u * u), std::sin(0.2 * u), 0};
    }
    space_path(stones, 1, flat_ground);
    EXPECT_FALSE(broken_step(stones, 1)) << stretch;
  }
}

TEST(GrammarSpacing, StonesOfAPathDoNotPop) {
  std::vector<double> before;
  for (int frame = 0; frame <= 400; ++frame) {
    std::vector<PathStone> stones = path_at_rest(12);
    for (PathStone& s : stones) s.x *= 1 + 0.005 * (frame - 200) / 1.3;
    space_path(stones, 1, flat_ground);
    std::vector<double> size;
    for (const PathStone& s : stones) size.push_back(s.size);
    // The length of two pitches changes by 0.008 a frame, a size by that over 0.2.
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_LT(std::abs(size[i] - before[i]), 0.2) << frame;
    before = std::move(size);
  }
}

TEST(GrammarSpacing, AMovedStoneTakesItsNeighboursAlongUpToTheNextFixedOne) {
  std::vector<PathStone> stones = path_at_rest(21);
  const std::vector<PathStone> rest = stones;
  stones[40].x.y() += 1;
  stones[40].is_fixed = stones[48].is_fixed = true;
  bend_path(stones, 40, {0, 1, 0}, 1, flat_ground);
  space_path(stones, 1, flat_ground);
  EXPECT_FALSE(broken_step(stones, 1));
  EXPECT_GT(stones[36].x.y(), 0.5);
  EXPECT_EQ(stones[48].x, rest[48].x);
  EXPECT_EQ(stones[80].x, rest[80].x);
}

}  // namespace
}  // namespace geoprior::grammar
