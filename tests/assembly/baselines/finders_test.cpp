// The finders that are compared with the exact one: none makes up a replacement.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "baselines/assembly/brute_force.h"
#include "baselines/assembly/growth.h"
#include "baselines/assembly/random_replacement.h"
#include "baselines/assembly/single_exchange.h"
#include "tests/assembly/assemblies.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::assembly {
namespace {

/// A host and a donor, small enough for brute force, and what brute force finds.
struct SmallModels {
  AssemblySet set;
  Compatibility compatibility;
  DonorSet donors;
  MatchingOptions match{4, 1000, true, Matching::observed};
  std::set<Swap> all;

  explicit SmallModels(int seed) : set(drawn(seed)), compatibility(set, true) {
    donors = all_donors(set, compatibility);
    const std::vector<Swap> list = swaps_of(*make_brute_force(donors, {match}), host());
    all = {list.begin(), list.end()};
  }
  [[nodiscard]] const Assembly& host() const { return set.models[0]; }

 private:
  static AssemblySet drawn(int seed) {
    test::Dice dice(seed, "small models");
    AssemblySet out;
    out.types = four_abstract_types();
    out.models = {random_graph(dice, out.types, 5, 7), random_graph(dice, out.types, 5, 7)};
    return out;
  }
};

/// How many replacements of a finder there are; each must be one of brute force.
std::size_t checked_swaps(ReplacementFinder& finder, const SmallModels& models) {
  const std::vector<Swap> list = swaps_of(finder, models.host());
  const std::set<Swap> found(list.begin(), list.end());
  EXPECT_TRUE(std::includes(models.all.begin(), models.all.end(), found.begin(), found.end()));
  return found.size();
}

TEST(AssemblyBaselines, FindNothingThatBruteForceDoesNot) {
  std::size_t grown = 0, exchanged = 0, drawn = 0, all = 0;
  for (int seed = 0; seed < 12; ++seed) {
    const SmallModels models(seed);
    all += models.all.size();
    grown += checked_swaps(*make_growth(models.donors, {models.match}), models);
    exchanged +=
        checked_swaps(*make_single_exchange(models.donors, {4, true, Matching::observed}), models);
    drawn += checked_swaps(
        *make_random_replacement(models.donors, {models.match, 200}, RandomStream(1, "drawn")),
        models);
  }
  for (const std::size_t some : {grown, exchanged, drawn}) {
    EXPECT_GT(some, 30);
    EXPECT_LT(some, all);
  }
}

TEST(AssemblyBaselines, SingleExchangeIsBruteForceWithSubstructuresOfOnePart) {
  for (int seed = 0; seed < 6; ++seed) {
    const SmallModels models(seed);
    std::set<Swap> single;
    for (const Swap& swap : models.all)
      if (std::get<0>(swap).parts.size() == 1 && std::get<2>(swap).parts.size() == 1)
        single.insert(swap);
    const auto list = swaps_of(*make_single_exchange(models.donors, {4, true, Matching::observed}),
                               models.host());
    EXPECT_EQ(std::set<Swap>(list.begin(), list.end()), single);
  }
}

TEST(AssemblyBaselines, RandomReplacementRepeatsWithItsSeed) {
  const SmallModels models(3);
  const auto drawn = [&](std::uint64_t seed) {
    return swaps_of(
        *make_random_replacement(models.donors, {models.match, 500}, RandomStream(seed, "drawn")),
        models.host());
  };
  EXPECT_FALSE(drawn(1).empty());
  EXPECT_EQ(drawn(1), drawn(1));
  EXPECT_NE(drawn(1), drawn(2));
}

TEST(AssemblyBaselines, BruteForceRefusesMoreThanFortyParts) {
  AssemblySet set;
  const Compatibility compatibility(set, true);
  const auto finder = make_brute_force(DonorSet{&set, &compatibility, {}}, {});
  EXPECT_NO_THROW((void)finder->substructures(path_graph(kMostBruteForceParts)));
  test::expect_error([&] { (void)finder->substructures(path_graph(kMostBruteForceParts + 1)); },
                     {"41 parts", "at most 40"});
}

TEST(Growth, InARingGoesOnToAllButOne) {
  AssemblySet set;
  set.types = {abstract_type("link", 2)};
  Assembly m;
  m.parts.resize(6);
  for (int i = 0; i < 6; ++i) m.connections.push_back({{i, 1}, {(i + 1) % 6, 0}});
  set.models = {m};
  const Compatibility compatibility(set, true);
  int largest = 0;
  for (const auto& s : swaps_of(*make_growth(all_donors(set, compatibility), {}), m))
    largest = std::max(largest, std::get<0>(s).parts.size());
  EXPECT_EQ(largest, 5);
}

TEST(Exact, StrictLosesNoAssemblyWhenOneOfAlikeSubstructuresIsKept) {
  // a-x-p-q-p-y-b, and c-x-p-q-p-y-d with its q the other way round: q of the first can be turned
  // only by the p-q-p of the second, between the same x and y.
  AssemblySet set;
  for (const char* one : {"a", "b", "c", "d"}) set.types.push_back(abstract_type(one, 1));
  for (const char* two : {"x", "y", "p", "q"}) set.types.push_back(abstract_type(two, 2));
  const auto row = [](int first, int last, int q) {
    Assembly m;
    for (const int t : {first, 4, 6, 7, 6, 5, last}) m.parts.push_back({t, Pose::Identity()});
    m.connections = {{{0, 0}, {1, 0}},     {{1, 1}, {2, 0}}, {{2, 1}, {3, q}},
                     {{3, 1 - q}, {4, 1}}, {{4, 0}, {5, 0}}, {{5, 1}, {6, 0}}};
    return m;
  };
  set.models = {row(0, 1, 0), row(2, 3, 1)};
  const Compatibility compatibility(set, true);
  const auto outputs = [&](bool keep_alike) {
    std::set<CanonicalKey> out;
    make_exact_finder(all_donors(set, compatibility), {{2, 1000, true, Matching::strict}, true},
                      keep_alike)
        ->find(set.models[0], [&](const Replacement& r) {
          out.insert(canonical_key(replace(set.models[0], set.models[r.donor], r).assembly,
                                   set.types, true));
          return true;
        });
    return out;
  };
  EXPECT_EQ(outputs(false), outputs(true));
  EXPECT_TRUE(outputs(true).contains(canonical_key(row(0, 1, 1), set.types, true)));
  EXPECT_TRUE(outputs(false).contains(canonical_key(row(0, 1, 1), set.types, true)));
}

}  // namespace
}  // namespace geoprior::assembly
