// Where replaced pieces come to, and how misfits are spread.

#include "models/assembly/exchange/embedding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "models/assembly/exchange/boundary_types.h"
#include "tests/assembly/assemblies.h"

namespace geoprior::assembly {
namespace {

/// A replacement that owns what it refers to.
struct OwnedSwap {
  Substructure removed, inserted;
  std::vector<int> match;

  OwnedSwap(const Assembly& host, PartSet out, const Assembly& donor, PartSet in)
      : removed(substructure_of(host, std::move(out))),
        inserted(substructure_of(donor, std::move(in))) {
    for (std::size_t i = 0; i < removed.boundary.size(); ++i) match.push_back(static_cast<int>(i));
  }
  [[nodiscard]] Replacement get() const { return {removed, 1, 0, inserted, 1, match}; }
};

/// The piece at each seam.
std::vector<int> pieces_at_seams(const Assembly& host, const Substructure& removed) {
  const std::vector<int> pieces = pieces_outside(host, removed.parts);
  std::vector<int> out;
  for (const int c : removed.boundary)
    out.push_back(pieces[outside_end(host.connections[c], removed.parts).part]);
  return out;
}

Misfit residual_of(const Assembly& host, const Assembly& donor, const std::vector<PartType>& types,
                   const OwnedSwap& swap) {
  return seam_residual(host, donor, types, swap.get(), pieces_at_seams(host, swap.removed));
}

TEST(SeamResidual, IsZeroWherePosesAreEqual) {
  const std::vector<PartType> types = oval_types();
  // Straights are parts 8 and 9, and two halves that are as long as one.
  const Assembly host = oval(types, {1, 1}, {1, 1}), donor = oval(types, {2, 2, 1}, {1, 1});
  const OwnedSwap swap(host, part_set(20, {8}), donor, part_set(21, {8, 9}));
  const Misfit m = residual_of(host, donor, types, swap);
  EXPECT_LT(m.translation, 1e-14);
  EXPECT_LT(m.angle, 1e-14);
}

TEST(SeamResidual, IsTheExcessOfALongerStraightInARing) {
  const std::vector<PartType> types = oval_types();
  const Assembly host = oval(types, {1, 1}, {1, 1}), donor = oval(types, {1, 2}, {1, 2});
  const OwnedSwap swap(host, part_set(20, {8}), donor, part_set(20, {8, 9}));
  const Misfit m = residual_of(host, donor, types, swap);
  EXPECT_NEAR(m.translation, 0.1, 1e-14);
  EXPECT_LT(m.angle, 1e-14);
  Replaced made = replace(host, donor, swap.get());
  embed(made, types);
  EXPECT_NEAR(largest(joint_misfits(made.assembly, types)).translation, 0.1, 1e-14);
}

TEST(SeamResidual, IsTheTurnOfACurveInPlaceOfAStraight) {
  const std::vector<PartType> types = oval_types();
  const Assembly host = oval(types, {1, 1}, {1, 1});
  const OwnedSwap swap(host, part_set(20, {8}), host, part_set(20, {3}));
  EXPECT_NEAR(residual_of(host, host, types, swap).angle, std::numbers::pi / 8, 1e-14);
}

TEST(SeamResidual, IsZeroForBridges) {
  const std::vector<PartType> types = oval_types();
  const Assembly row = track_row({1, 1, 0, 1}, types, false);
  const OwnedSwap swap(row, part_set(4, {1}), row, part_set(4, {2}));
  const Misfit m = residual_of(row, row, types, swap);
  EXPECT_EQ(m.translation, 0);
  EXPECT_EQ(m.angle, 0);
}

TEST(Embedding, ClosesEverySeamOfBridgesAndLeavesTheLargestPiece) {
  const std::vector<PartType> types = oval_types();
  const Assembly row = track_row({1, 1, 0, 1, 1, 1}, types, false);
  const OwnedSwap swap(row, part_set(6, {1}), row, part_set(6, {2, 3}));
  Replaced made = replace(row, row, swap.get());
  EXPECT_EQ(made.kept, 5);
  ASSERT_EQ(made.seams.size(), 2);
  embed(made, types);
  const Misfit worst = largest(joint_misfits(made.assembly, types));
  EXPECT_LT(worst.translation, 1e-14);
  EXPECT_LT(worst.angle, 1e-14);
  // Parts 2 to 5 of the row stay: they are 1 to 4 of the new one.
  for (int i = 1; i < 5; ++i)
    EXPECT_TRUE(made.assembly.parts[i].pose.isApprox(row.parts[i + 1].pose, 0));
}

TEST(Embedding, OfATreeClosesWhateverIsExchanged) {
  const AssemblyInput& input = marble_run();
  const Assembly& run = input.set.models[0];
  const Compatibility compatibility(input.set, true);
  const auto finder = make_exact_finder(all_donors(input.set, compatibility),
                                        {{2, 3, true, Matching::observed}, true}, false);
  int count = 0;
  finder->find(run, [&](const Replacement& r) {
    Replaced made = replace(run, run, r);
    embed(made, input.set.types);
    EXPECT_LT(largest(joint_misfits(made.assembly, input.set.types)).translation, 1e-12);
    return ++count < 500;
  });
  EXPECT_GT(count, 100);
}

/// A ring of sixteen curves with a straight of length `gap` too much.
Assembly ring_with_gap(std::vector<PartType>& types, double gap) {
  types = {curved_track("curve", 0.5, std::numbers::pi / 8), straight_track("excess", gap)};
  std::vector<int> kinds(16, 0);
  kinds.push_back(1);
  return track_row(kinds, types, true);
}

TEST(Relaxation, SpreadsAGapEquallyOverStiffJoints) {
  std::vector<PartType> types;
  const double gap = 1e-3;
  Assembly ring = ring_with_gap(types, gap);
  EXPECT_NEAR(largest(joint_misfits(ring, types)).translation, gap, 1e-12);
  // Angles that cost a thousand times more than the gap: all of 17 joints take a share.
  const Misfit worst = relax(ring, types, {1e-3, 1e-6});
  EXPECT_NEAR(worst.translation, gap / 17, 1e-3 * gap);
  EXPECT_LT(worst.angle, 1e-6);
}

TEST(Relaxation, MakesGapsSmallerStillWhereJointsTurn) {
  std::vector<PartType> types;
  Assembly ring = ring_with_gap(types, 1e-3);
  const Misfit worst = relax(ring, types, {1e-3, 1});
  EXPECT_LT(worst.translation, 1e-3 / 17);
  EXPECT_GT(worst.angle, 1e-6);
}

TEST(Relaxation, OfATreeClosesAllJointsAndLeavesTheFirstPart) {
  const std::vector<PartType> types = oval_types();
  Assembly row = track_row({1, 0, 2, 0, 0}, types, false);
  test::Dice dice(1, "relaxation");
  for (PlacedPart& part : row.parts) {
    part.pose.pretranslate(dice.vector(0.01));
    part.pose.rotate(Eigen::AngleAxisd(dice.uniform(0, 0.05), dice.vector(1).normalized()));
  }
  const Pose first = row.parts[0].pose;
  EXPECT_GT(largest(joint_misfits(row, types)).translation, 1e-3);
  const Misfit worst = relax(row, types, {});
  EXPECT_LT(worst.translation, 1e-9);
  EXPECT_LT(worst.angle, 1e-9);
  EXPECT_TRUE(row.parts[0].pose.isApprox(first, 0));
}

TEST(JointTolerance, HoldsForBothTranslationAndAngle) {
  const JointTolerance tolerance{1e-3, 2};
  const double degree = std::numbers::pi / 180;
  EXPECT_TRUE(within({1e-3, 1.99 * degree}, tolerance));
  EXPECT_FALSE(within({1.1e-3, 0}, tolerance));
  EXPECT_FALSE(within({0, 2.01 * degree}, tolerance));
  const Misfit worst = largest({{1, 0.1}, {0.5, 3}});
  EXPECT_EQ(worst.translation, 1);
  EXPECT_EQ(worst.angle, 3);
}

}  // namespace
}  // namespace geoprior::assembly
