// The exact finder against brute force, and what it may leave out.

#include "solvers/assembly/exact.h"

#include <gtest/gtest.h>

#include <set>

#include "baselines/assembly/brute_force.h"
#include "models/assembly/isomorphism/canonical.h"
#include "tests/assembly/assemblies.h"

namespace geoprior::assembly {
namespace {

/// Graphs with more replacements than this are skipped: brute force takes too long.
constexpr std::size_t kMostSwaps = 4000;

std::set<Swap> distinct_swaps(ReplacementFinder& finder, const Assembly& host) {
  std::set<Swap> out;
  finder.find(host, [&](const Replacement& r) {
    out.emplace(r.removed, r.donor, r.inserted, std::vector<int>(r.match.begin(), r.match.end()));
    return out.size() < kMostSwaps;
  });
  return out;
}

TEST(ExactFinder, FindsTheReplacementsOfBruteForceAndNoOthers) {
  test::Dice dice(7, "exact");
  std::size_t compared = 0;
  for (int i = 0; i < 24; ++i) {
    AssemblySet set;
    set.types = four_abstract_types();
    set.models = {random_graph(dice, set.types, 5, 10), random_graph(dice, set.types, 4, 8)};
    for (int k = 0; k < 16; ++k) {
      const MatchingOptions match{1 + k / 4, 1000, k % 2 == 0,
                                  k / 2 % 2 == 0 ? Matching::observed : Matching::strict};
      const Compatibility compatibility(set, match.symmetries);
      const DonorSet donors = all_donors(set, compatibility);
      const auto exact = make_exact_finder(donors, {match, true}, true);
      const auto oracle = make_brute_force(donors, {match});
      const std::set<Swap> found = distinct_swaps(*exact, set.models[0]);
      const std::set<Swap> expected = distinct_swaps(*oracle, set.models[0]);
      if (expected.size() >= kMostSwaps) continue;
      ASSERT_EQ(found, expected) << "graph " << i << ", options " << k;
      compared += expected.size();
    }
  }
  EXPECT_GT(compared, 10000);
}

TEST(ExactFinder, TellsReplacementsInOneOrder) {
  const AssemblyInput input = oval_input();
  const Compatibility compatibility(input.set, true);
  const DonorSet donors = all_donors(input.set, compatibility);
  const auto list = [&] {
    return swaps_of(*make_exact_finder(donors, {{2, 3, true, Matching::observed}, true}, true),
                    input.set.models[0]);
  };
  const std::vector<Swap> first = list();
  EXPECT_GT(first.size(), 100);
  EXPECT_EQ(first, list());
}

TEST(ExactFinder, LosesNoAssemblyWhenOneOfAlikeSubstructuresIsKept) {
  test::Dice dice(9, "alike");
  std::size_t outcomes = 0;
  for (int i = 0; i < 12; ++i) {
    AssemblySet set;
    set.types = four_abstract_types();
    set.models = {random_graph(dice, set.types, 5, 7), random_graph(dice, set.types, 5, 7)};
    const Compatibility compatibility(set, true);
    const DonorSet donors = all_donors(set, compatibility);
    const auto outputs = [&](bool keep_alike) {
      std::set<CanonicalKey> out;
      const auto finder =
          make_exact_finder(donors, {{2, 1000, true, Matching::observed}, true}, keep_alike);
      finder->find(set.models[0], [&](const Replacement& r) {
        out.insert(canonical_key(replace(set.models[0], set.models[r.donor], r).assembly, set.types,
                                 true));
        return true;
      });
      return out;
    };
    const std::set<CanonicalKey> all = outputs(true);
    EXPECT_EQ(outputs(false), all) << "graph " << i;
    outcomes += all.size();
  }
  EXPECT_GT(outcomes, 100);
}

}  // namespace
}  // namespace geoprior::assembly
