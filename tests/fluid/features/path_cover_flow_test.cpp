#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "core/random.h"
#include "metrics/tracks/optimal_assignment.h"
#include "solvers/fluid/tracking/path_cover.h"
#include "solvers/fluid/tracking/tracking.h"

namespace geoprior::fluid {
namespace {

double cost_of(const std::vector<int>& successor, const std::vector<PathLink>& links,
               double new_path_cost) {
  double cost = new_path_cost * static_cast<double>(successor.size());
  for (int i = 0; i < std::ssize(successor); ++i) {
    if (successor[i] < 0) continue;
    const auto it = std::find_if(links.begin(), links.end(), [&](const PathLink& l) {
      return l.from == i && l.to == successor[i];
    });
    EXPECT_NE(it, links.end());
    cost += it->cost - new_path_cost;
  }
  return cost;
}

/// Every node's successor, all combinations.
double brute_force(int nodes, const std::vector<PathLink>& links, double new_path_cost,
                   std::size_t at = 0, unsigned left = 0, unsigned entered = 0) {
  if (at == links.size()) return nodes * new_path_cost;
  double best = brute_force(nodes, links, new_path_cost, at + 1, left, entered);
  const unsigned from = 1U << links[at].from, to = 1U << links[at].to;
  if ((left & from) == 0 && (entered & to) == 0) {
    best = std::min(
        best, links[at].cost - new_path_cost +
                  brute_force(nodes, links, new_path_cost, at + 1, left | from, entered | to));
  }
  return best;
}

std::vector<PathLink> random_links(RandomStream& random, int nodes, double density) {
  std::vector<PathLink> links;
  for (int i = 0; i < nodes; ++i) {
    for (int j = i + 1; j < nodes; ++j) {
      if (random.uniform() < density) links.push_back({i, j, 14 * random.uniform()});
    }
  }
  return links;
}

void expect_disjoint(const std::vector<int>& successor) {
  std::vector<char> entered(successor.size(), 0);
  for (int i = 0; i < std::ssize(successor); ++i) {
    if (successor[i] < 0) continue;
    EXPECT_GT(successor[i], i);
    char& e = entered[successor[i]];
    EXPECT_EQ(e, 0);
    e = 1;
  }
}

TEST(PathCover, IsTheBestOfAllCoversOfUpToEightNodes) {
  RandomStream random(7, "covers");
  for (int trial = 0; trial < 400; ++trial) {
    const int nodes = 1 + static_cast<int>(random.below(8));
    std::vector<PathLink> links = random_links(random, nodes, 0.6);
    links.resize(std::min<std::size_t>(links.size(), 16));  // 2^16 covers at most
    const std::vector<int> successor = cover_by_paths(nodes, links, 10);
    expect_disjoint(successor);
    // Costs are rounded to 1e-4 each.
    EXPECT_NEAR(cost_of(successor, links, 10), brute_force(nodes, links, 10), 1e-3);
  }
}

// Links between consecutive frames only: paths cost a constant each, so the cover of all frames is
// the assignments of its pairs of frames, one by one.
TEST(PathCover, FallsIntoAssignmentsWhenLinksSpanOneFrame) {
  RandomStream random(11, "frames");
  constexpr int kFrames = 8, kPerFrame = 7;
  std::vector<PathLink> links;
  double assigned = 10.0 * kFrames * kPerFrame;
  for (int f = 0; f + 1 < kFrames; ++f) {
    Eigen::MatrixXd gain = Eigen::MatrixXd::Zero(kPerFrame, kPerFrame);
    for (int i = 0; i < kPerFrame; ++i) {
      for (int j = 0; j < kPerFrame; ++j) {
        if (random.uniform() < 0.4) continue;
        const double cost = 12 * random.uniform();
        links.push_back({f * kPerFrame + i, (f + 1) * kPerFrame + j, cost});
        gain(i, j) = std::max(0.0, 10 - cost);
      }
    }
    const std::vector<int> column = optimal_assignment(gain);
    for (int i = 0; i < kPerFrame; ++i) assigned -= gain(i, column[i]);
  }
  const std::vector<int> successor = cover_by_paths(kFrames * kPerFrame, links, 10);
  expect_disjoint(successor);
  EXPECT_NEAR(cost_of(successor, links, 10), assigned, 1e-2);
}

// Nodes 0 and 1, then 2, then 3: the cheap link 0-2 leaves 1 alone, the cover takes 1-2 and 0-3.
TEST(PathCover, SeesGapsThatTheCheapestLinkDoesNot) {
  const std::vector<PathLink> links{{0, 2, 1.0}, {1, 2, 2.0}, {0, 3, 3.0}};
  EXPECT_EQ(cover_by_paths(4, links, 10), (std::vector<int>{3, 2, -1, -1}));
}

TEST(PathCover, LeavesLinksThatCostAtLeastANewPath) {
  EXPECT_EQ(cover_by_paths(3, {{0, 1, 10.0}, {1, 2, 9.999}}, 10), (std::vector<int>{-1, 2, -1}));
}

TEST(PathCover, DoesNotDependOnTheOrderOfLinksEvenWithTies) {
  RandomStream random(5, "ties");
  std::vector<PathLink> links = random_links(random, 40, 0.3);
  for (PathLink& link : links) link.cost = std::floor(link.cost / 4);
  const std::vector<int> first = cover_by_paths(40, links, 10);
  for (int trial = 0; trial < 5; ++trial) {
    for (std::size_t i = links.size(); i > 1; --i)
      std::swap(links[i - 1], links[random.below(static_cast<std::uint32_t>(i))]);
    EXPECT_EQ(cover_by_paths(40, links, 10), first);
  }
}

TEST(PathCover, TenThousandNodesInOnePart) {
  // A chain of nodes each linked to its next three: one connected part of 30 000 links, whose best
  // cover is the chain itself.
  constexpr int kNodes = 10'000;
  std::vector<PathLink> links;
  for (int i = 0; i < kNodes; ++i) {
    for (int g = 1; g <= 3 && i + g < kNodes; ++g) links.push_back({i, i + g, 1.0 + g});
  }
  const std::vector<int> successor = cover_by_paths(kNodes, links, 10);
  for (int i = 0; i + 1 < kNodes; ++i) ASSERT_EQ(successor[i], i + 1);
}

TEST(PathCover, RefusesLinksBackInTime) {
  EXPECT_THROW(cover_by_paths(3, {{2, 1, 1.0}}, 10), Error);
  EXPECT_THROW(cover_by_paths(3, {{1, 3, 1.0}}, 10), Error);
}

}  // namespace
}  // namespace geoprior::fluid
