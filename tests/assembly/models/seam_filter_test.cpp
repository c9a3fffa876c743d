// What is found out before an assembly is built must be so of the built one.

#include "models/assembly/search/seam_filter.h"

#include <gtest/gtest.h>

#include <map>

#include "experiments/assembly/processes/process.h"
#include "models/assembly/search/variation.h"
#include "tests/assembly/assemblies.h"

namespace geoprior::assembly {
namespace {

using Verdict = SeamFilter::Verdict;

/// Builds whatever the filter rejects of a host, and counts its verdicts.
std::map<Verdict, int> checked_verdicts(const AssemblyInput& input, const Assembly& host,
                                        SeamFilter& filter) {
  filter.begin(host);
  const Compatibility compatibility(input.set, true);
  const auto finder = make_exact_finder(all_donors(input.set, compatibility),
                                        {{2, 1000, true, Matching::observed}, true}, false);
  const std::vector<PartType>& types = input.set.types;
  const CanonicalKey host_key = canonical_key(host, types, true);
  std::map<Verdict, int> out;
  finder->find(host, [&](const Replacement& r) {
    const Verdict verdict = filter.look(host, r);
    ++out[verdict];
    if (verdict == Verdict::passes) return true;
    Replaced made = replace(host, input.set.models[r.donor], r);
    const bool is_host = canonical_key(made.assembly, types, true) == host_key;
    if (verdict == Verdict::same) {
      EXPECT_TRUE(is_host);
    } else if (!is_host) {
      embed(made, types);
      put_on_floor(made.assembly, types, input.rules);
      EXPECT_NE(first_broken(made.assembly, types, input.rules), Filter::none)
          << "verdict " << static_cast<int>(verdict);
    }
    return !::testing::Test::HasFailure();
  });
  return out;
}

TEST(SeamFilter, RejectsNoNewValidVariationOfTheMarbleRun) {
  const AssemblyInput& input = marble_run();
  SeamFilter filter(input, input.rules.tolerance, true);
  auto verdicts = checked_verdicts(input, input.set.models[0], filter);
  EXPECT_GT(verdicts[Verdict::passes], 0);
  EXPECT_GT(verdicts[Verdict::floor], 0);
  EXPECT_GT(verdicts[Verdict::same], 0);
}

TEST(SeamFilter, RejectsNoNewValidVariationOfAVariation) {
  const AssemblyInput& input = marble_run();
  SearchOptions options;
  options.count = 2;
  const auto run = recorded(*replacement_process(input, exact_factory(2), true, options));
  SeamFilter filter(input, input.rules.tolerance, true);
  const Assembly made = variation_of(run.frames.at(2)).assembly;
  auto verdicts = checked_verdicts(input, made, filter);
  EXPECT_GT(verdicts[Verdict::passes], 0);
  EXPECT_GT(verdicts[Verdict::same], 0);
}

TEST(SeamFilter, RejectsNoNewValidVariationOfOvals) {
  AssemblyInput input = oval_input();
  input.rules.parts = 10;
  input.rules.bill = {{"half", 5}};
  SeamFilter filter(input, input.rules.tolerance, true);
  for (const Assembly& host : input.set.models) {
    auto verdicts = checked_verdicts(input, host, filter);
    EXPECT_GT(verdicts[Verdict::passes], 0);
    EXPECT_GT(verdicts[Verdict::seams], 0);
    EXPECT_GT(verdicts[Verdict::same], 0);
    EXPECT_GT(verdicts[Verdict::counts], 0);
  }
}

TEST(SeamFilter, AgreesWithEmbeddingWhereOnePieceIsBetweenSeamsOfAnother) {
  AssemblyInput in;
  const double e = 0.01;
  auto fork = [&](const char* label, double turn) {
    PartType t;
    t.label = label;
    t.ports = {{"a", plane_pose(0, 0.5, std::numbers::pi + turn)},
               {"b", plane_pose(0, 0, std::numbers::pi)},
               {"c", plane_pose(0, -0.5, std::numbers::pi)}};
    return t;
  };
  PartType back;
  back.label = "back";  // piece B, joined with seams 0 and 2
  back.ports = {{"a", plane_pose(0, 0.5, 0)}, {"c", plane_pose(0, -0.5, 0)}};
  in.set.types = {fork("x", 0), fork("x2", e), back, straight_track("s", 1)};
  Assembly m;
  m.parts = {{0, Pose::Identity()},
             {2, Pose::Identity()},
             {3, plane_pose(-1, 0, 0)},
             {3, plane_pose(-2, 0, 0)}};
  m.connections = {{{0, 0}, {1, 0}}, {{0, 1}, {2, 1}}, {{0, 2}, {1, 1}}, {{2, 0}, {3, 1}}};
  Assembly d = m;
  d.parts[0].type = 1;
  in.set.models = {m, d};
  in.rules.tolerance = {1e-3, 1};
  in.rules.collisions = false;
  Substructure out = substructure_of(m, part_set(4, {0})),
               put = substructure_of(d, part_set(4, {0}));
  const std::vector<int> match{0, 1, 2};
  const Replacement r{out, 1, 1, put, 1, match};
  Replaced made = replace(m, d, r);
  embed(made, in.set.types);
  const Misfit w = largest(joint_misfits(made.assembly, in.set.types));
  SeamFilter filter(in, in.rules.tolerance, true);
  filter.begin(m);
  const bool valid = first_broken(made.assembly, in.set.types, in.rules) == Filter::none;
  EXPECT_EQ(filter.look(m, r) == SeamFilter::Verdict::passes, valid)
      << w.translation << " " << w.angle;
}

TEST(SeamFilter, KnowsAnotherHostAtTheSameAddress) {
  AssemblyInput in = oval_input();
  in.rules.parts = 8;
  Assembly host = in.set.models[0];  // 9 parts
  SeamFilter filter(in, in.rules.tolerance, true);
  const auto look = [&](const Assembly& model, int number) {
    host = model;
    filter.begin(host);
    Substructure out = substructure_of(host, part_set(static_cast<int>(host.parts.size()), {0}));
    Substructure put = substructure_of(in.set.models[0], part_set(9, {3}));
    const std::vector<int> match{0, 1};
    return filter.look(host, {out, number, 0, put, 1, match});
  };
  EXPECT_EQ(look(in.set.models[0], 7), SeamFilter::Verdict::counts);
  EXPECT_NE(look(oval(in.set.types, {1}, {1}, 4), 1), SeamFilter::Verdict::counts);
}

}  // namespace
}  // namespace geoprior::assembly
