#include "solvers/grammar/engine/derivation.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "core/error.h"

namespace geoprior::grammar {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A root with two arms of three beads each: element 1 and 5 are arms, the beads follow them.
Hierarchy two_arms() {
  Hierarchy h({{.name = "root"},
               {.name = "arm", .parameters = {{"length", "m", 0, 10}}},
               {.name = "bead",
                .parameters = {{"size", "1", 0, 2}},
                .keys = [](std::span<const double> p, std::vector<Eigen::Vector3d>& out) {
                  out.emplace_back(0, 0, p[0]);
                }}});
  h.add(0, -1, {});
  for (int a = 0; a < 2; ++a) {
    const int arm = h.add(1, 0, {{4. * a, 0, 0}}, std::array{3.});
    for (int b = 0; b < 3; ++b) h.add(2, arm, {{4. * a, 0, 1. + b}}, std::array{1.});
  }
  return h;
}

std::shared_ptr<const SpatialMap> shift_map(double x) {
  return std::make_shared<AffineMap>(Eigen::Affine3d(Eigen::Translation3d(x, 0, 0)));
}

std::vector<Eigen::Vector3d> positions(const Hierarchy& h) {
  std::vector<Eigen::Vector3d> out;
  for (int e = 0; e < h.size(); ++e) out.push_back(h.position(e));
  return out;
}

std::string message_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(GrammarDerivation, WithoutRulesElementsMoveRigidlyWithTheMap) {
  Hierarchy h = two_arms();
  Transaction undo(h);
  const auto report = derive(h, undo, RuleSet{}, {0, Delta::free(shift_map(2))});
  EXPECT_EQ(h.position(8), Eigen::Vector3d(6, 0, 3));
  EXPECT_EQ(report.rewrites, 10);  // nine down, and the root once on its way up
}

TEST(GrammarDerivation, AnEditClimbsToTheElementThatBoundsTheLocality) {
  Hierarchy h = two_arms();
  Transaction undo(h);
  RuleSet rules;
  rules.bound_locality("arm");
  const auto before = positions(h);
  const auto report = derive(h, undo, rules, {2, Delta::translate({0, 1, 0})});
  EXPECT_EQ(report.turned_at, 1);
  EXPECT_THAT(undo.touched(), ElementsAre(2, 1, 3, 4));
  for (int e = 5; e < 9; ++e) EXPECT_EQ(h.position(e), before[e]);
}

TEST(GrammarDerivation, ChildrenThatNoRuleMakesAreAnError) {
  Hierarchy h = two_arms();
  Transaction undo(h);
  const auto message = message_of([&] { derive(h, undo, RuleSet{}, {1, Delta::children(2)}); });
  EXPECT_THAT(message, HasSubstr("element 'arm-1'"));
  EXPECT_THAT(message, HasSubstr("children"));
}

TEST(GrammarDerivation, RewritesAreAtMostTwoAnElement) {
  Hierarchy h = two_arms();
  Transaction undo(h);
  for (int e = 0; e < h.size(); ++e) {
    const auto report = derive(h, undo, RuleSet{}, {e, Delta::translate({0, 0.5, 0})});
    EXPECT_LE(report.rewrites, 2 * static_cast<int>(undo.touched().size()));
  }
}

TEST(GrammarDerivation, ARuleThatAsksTwiceIsAnErrorAndTakesAllBack) {
  Hierarchy h = two_arms();
  const auto before = positions(h);
  Transaction undo(h);
  RuleSet rules;
  rules.add({"root moves all", {.type = "root", .phase = Phase::down}, [](RuleCall& c) {
               c.down(0, c.delta());
             }});
  rules.add({"arm asks twice", {.type = "arm"}, [](RuleCall& c) {
               for (const int arm : c.elements()) {
                 c.set_pose(arm, {{9, 9, 9}});
                 c.down(arm, c.delta());
                 c.down(arm, c.delta());
               }
             }});
  const std::string message = message_of([&] {
    derive(h, undo, rules, {0, Delta::free(shift_map(1))});
  });
  EXPECT_THAT(message, HasSubstr("asked a second time"));
  EXPECT_THAT(message, HasSubstr("'bead-"));
  EXPECT_EQ(positions(h), before);
}

TEST(GrammarDerivation, WritesBeyondTheBatchAreRefused) {
  Hierarchy h = two_arms();
  Transaction undo(h);
  RuleSet rules;
  rules.add({"bead moves its arm", {.type = "bead", .phase = Phase::down}, [](RuleCall& c) {
               c.set_pose(c.now().parent(c.elements()[0]), {{1, 1, 1}});
             }});
  EXPECT_THAT(message_of([&] {
                derive(h, undo, rules, {0, Delta::free(shift_map(1))});
              }),
              HasSubstr("rule 'bead moves its arm', element 'arm-1': is written out of its turn"));
}

TEST(GrammarDerivation, ValuesOutOfRangeOrNotFiniteAreErrorsThatNameTheRule) {
  for (const double value : {3., std::nan("")}) {
    Hierarchy h = two_arms();
    Transaction undo(h);
    RuleSet rules;
    rules.add({"grow", {.type = "bead", .phase = Phase::down}, [value](RuleCall& c) {
                 for (const int bead : c.elements()) c.set_parameter(bead, 0, value);
               }});
    const std::string message = message_of([&] {
      derive(h, undo, rules, {2, Delta::translate({0, 0, 1})});
    });
    EXPECT_THAT(message, HasSubstr("rule 'grow', element 'bead-1'"));
    EXPECT_EQ(h.parameter(2, 0), 1.);
  }
}

TEST(GrammarDerivation, SpawnedElementsVanishWhenTheDerivationIsTakenBack) {
  Hierarchy h = two_arms();
  Transaction undo(h);
  RuleSet rules;
  rules.add({"one more", {.type = "arm", .phase = Phase::down}, [](RuleCall& c) {
               for (const int arm : c.elements()) {
                 c.spawn(2, arm, {{0, 0, 7}}, std::array{0.5});
                 c.remove(c.now().children(arm)[0]);
               }
             }});
  const auto report = derive(h, undo, rules, {1, Delta::translate({0, 0, 0})});
  EXPECT_EQ(report.spawned, 2);  // both arms: the root bounds the locality
  EXPECT_EQ(report.removed, 2);
  EXPECT_EQ(h.present_count(), 9);
  undo.roll_back();
  EXPECT_EQ(h.size(), 9);
  EXPECT_EQ(h.present_count(), 9);
  EXPECT_EQ(h.children(1).size(), 3U);
}

TEST(GrammarDerivation, ATaggedElementFollowsItsParentRigidlyWithAllBelow) {
  Hierarchy h = two_arms();
  h.set_tag(1, {1, Tag::Follow::rigid});
  Transaction undo(h);
  RuleSet rules;
  rules.add({"root turns", {.type = "root", .phase = Phase::down}, [](RuleCall& c) {
               c.set_pose(0, {{1, 0, 0},
                              Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ()))});
               c.down(0, Delta::set(0, 5));
             }});
  const auto report = derive(h, undo, rules, {0, Delta::free(shift_map(1))});
  EXPECT_EQ(report.followed, 4);
  EXPECT_EQ(h.parameter(1, 0), 3.);
  EXPECT_EQ(h.parameter(5, 0), 5.);
  EXPECT_NEAR((h.position(2) - Eigen::Vector3d(1, 0, 1)).norm(), 0, 1e-15);
}

TEST(GrammarDerivation, ATagThatStopsKeepsEverythingBelowBitForBit) {
  Hierarchy h = two_arms();
  h.set_tag(1, {1, Tag::Follow::stop});
  const auto before = positions(h);
  Transaction undo(h);
  const auto report = derive(h, undo, RuleSet{}, {0, Delta::free(shift_map(0.1))});
  EXPECT_EQ(report.stopped, 1);
  for (int e = 1; e < 5; ++e) EXPECT_EQ(h.position(e), before[e]);
}

TEST(GrammarDerivation, IndependentEditsCommute) {
  RuleSet rules;
  rules.bound_locality("arm");
  Hierarchy a = two_arms(), b = two_arms();
  Transaction undo_a(a), undo_b(b);
  const Edit first{2, Delta::free(shift_map(0.3))}, second{6, Delta::translate({0, 0.7, 0})};
  derive(a, undo_a, rules, first);
  derive(a, undo_a, rules, second);
  derive(b, undo_b, rules, second);
  derive(b, undo_b, rules, first);
  EXPECT_EQ(positions(a), positions(b));
}

TEST(GrammarDerivation, TheIdentityChangesNothing) {
  Hierarchy h = two_arms();
  Transaction undo(h);
  derive(h, undo, RuleSet{}, {0, Delta::rigid(Eigen::Affine3d::Identity())});
  EXPECT_THAT(undo.changed(), IsEmpty());
}

TEST(GrammarDerivation, TheTraceIsATree) {
  Hierarchy h = two_arms();
  Transaction undo(h);
  const auto report = derive(h, undo, RuleSet{}, {2, Delta::free(shift_map(1))}, true);
  EXPECT_THAT(trace_text(h, report),
              testing::StartsWith("^ bead-1  free from user  [default]\n"
                                  "  ^ arm-1  free from child  [default]\n"
                                  "    ^ root-1  free from child  [default]\n"
                                  "      v root-1  free from child  [default]\n"
                                  "        v arm-1 and 1 more  free from parent  [default]\n"));
}

TEST(GrammarDerivation, StarsStandForAnyLetters) {
  EXPECT_TRUE(matches("*", ""));
  EXPECT_TRUE(matches("wheel*", "wheel-left"));
  EXPECT_TRUE(matches("*left", "wheel-left"));
  EXPECT_TRUE(matches("w*-*t", "wheel-left"));
  EXPECT_FALSE(matches("wheel", "wheel-left"));
  EXPECT_FALSE(matches("*right", "wheel-left"));
}

}  // namespace
}  // namespace geoprior::grammar
