#include "baselines/assembly/wave_collapse.h"

#include <gtest/gtest.h>

#include <set>

#include "models/assembly/isomorphism/canonical.h"
#include "models/assembly/search/rules.h"
#include "tests/assembly/assemblies.h"

namespace geoprior::assembly {
namespace {

/// Rows of straights between two caps, standing on the floor by their caps.
AssemblyInput capped_rows() {
  AssemblyInput out;
  out.set.types = {straight_track("cap", 0.1), straight_track("straight", 0.2),
                   straight_track("half", 0.1)};
  out.set.types[0].ports.pop_back();
  out.set.types[0].ports[0].frame = plane_pose(0.1, 0, 0);
  for (PartType& type : out.set.types) {
    type.ways.clear();
    type.boxes = {{plane_pose(0.05, 0, 0, 0.02), {0.05, 0.02, 0.02}}};
  }
  Assembly row;
  row.name = "row";
  for (const int kind : {0, 1, 2, 1, 0}) row.parts.push_back({kind, Pose::Identity()});
  row.connections = {{{0, 0}, {1, 0}}, {{1, 1}, {2, 0}}, {{2, 1}, {3, 0}}, {{3, 1}, {4, 0}}};
  place_parts(row, out.set.types);
  out.set.models = {row};
  out.rules.grounded = {"cap"};
  out.rules.parts = 9;
  return out;
}

WaveCollapseOptions few_waves() {
  WaveCollapseOptions out;
  out.count = 3;
  return out;
}

TEST(WaveCollapse, MakesValidDistinctAssembliesThatAreNoInputs) {
  const AssemblyInput input = capped_rows();
  const auto run = recorded(*make_wave_collapse(input, few_waves()));
  ASSERT_EQ(run.frames.size(), 4);
  std::set<CanonicalKey> keys;
  for (const Frame& frame : run.frames) {
    Assembly made = variation_of(frame).assembly;
    EXPECT_EQ(first_broken(made, input.set.types, input.rules), Filter::none);
    EXPECT_TRUE(keys.insert(canonical_key(made, input.set.types, true)).second);
  }
}

TEST(WaveCollapse, JoinsOnlyWhatSomeModelJoins) {
  const AssemblyInput input = capped_rows();
  const Compatibility compatibility(input.set, true);
  for (const Frame& frame : recorded(*make_wave_collapse(input, few_waves())).frames) {
    const Assembly made = variation_of(frame).assembly;
    for (const auto& [a, b] : made.connections)
      EXPECT_TRUE(compatibility.observed(compatibility.port_class(made, a),
                                         compatibility.port_class(made, b)));
  }
}

TEST(WaveCollapse, RepeatsWithItsSeedAndGoesOnFromACheckpoint) {
  const AssemblyInput input = capped_rows();
  const auto whole = recorded(*make_wave_collapse(input, few_waves()), 5);
  const auto again = recorded(*make_wave_collapse(input, few_waves()), 5, whole.checkpoints.at(1));
  ASSERT_EQ(again.frames.size() + 2, whole.frames.size());
  for (std::size_t i = 0; i < again.frames.size(); ++i)
    expect_same_frame(again.frames[i], whole.frames[i + 2]);
}

}  // namespace
}  // namespace geoprior::assembly
