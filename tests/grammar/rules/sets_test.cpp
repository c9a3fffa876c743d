#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "experiments/grammar/maps/gesture.h"
#include "models/grammar/objects/forest.h"
#include "models/grammar/objects/spacing.h"
#include "models/grammar/objects/surface_set.h"
#include "models/grammar/objects/volume_set.h"
#include "solvers/grammar/grammar.h"
#include "solvers/grammar/rules/rules.h"
#include "tests/grammar/rules/deformed_objects.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using samples::deformed;
using samples::deviation;
using samples::is_same;
using samples::key_box;

/// The same map, of which nobody knows where it is the identity.
class UnboundedMap final : public SpatialMap {
 public:
  explicit UnboundedMap(std::shared_ptr<const SpatialMap> map) : map_(std::move(map)) {}
  [[nodiscard]] Vector3d at(const Vector3d& x) const override { return map_->at(x); }
  [[nodiscard]] MappedPoint with_jacobian(const Vector3d& x) const override {
    return map_->with_jacobian(x);
  }

 private:
  std::shared_ptr<const SpatialMap> map_;
};

Hierarchy spaced_forest(int elements) {
  ForestOptions o;
  o.apart = true;
  o.elements = elements;
  return make_forest(o, 1);
}

std::vector<Hierarchy> sets() {
  std::vector<Hierarchy> out;
  out.push_back(make_surface_set({}, 1));
  out.push_back(make_volume_set({}, 1));
  out.push_back(spaced_forest(400));
  return out;
}

std::shared_ptr<const SpatialMap> inflation(const Vector3d& centre, double radius, double amount,
                                            double fraction = 1) {
  Gesture gesture;
  gesture.strokes.push_back({Stroke::Kind::inflate, {centre}, radius});
  gesture.strokes[0].amount = amount;
  return map_of(gesture, fraction);
}

double size_of(const Hierarchy& h, int e) { return h.present(e) ? h.parameter(e, 0) : 0; }

int pairs_too_close(const Hierarchy& h) {
  int out = 0;
  std::vector<int> there;
  for (const int e : h.children(0)) {
    if (!h.present(e)) continue;
    for (const int other : there) {
      const double least =
          h.parameter(e, 0) * h.parameter(e, 1) + h.parameter(other, 0) * h.parameter(other, 1);
      if ((h.position(e) - h.position(other)).norm() < least) ++out;
    }
    there.push_back(e);
  }
  return out;
}

int nearest_element(const Hierarchy& h, int element) {
  const auto distance = [&](int e) {
    return e == element || !h.present(e) ? 1e9 : (h.position(e) - h.position(element)).norm();
  };
  return *std::min_element(h.children(0).begin(), h.children(0).end(),
                           [&](int a, int b) { return distance(a) < distance(b); });
}

TEST(GrammarSetRules, ElementsKeepTheirDistanceAndFollowTheMap) {
  for (const Hierarchy& rest : sets()) {
    const auto box = key_box(rest);
    double ratio = 0;
    constexpr int kSetGestures = 25;
    for (int g = 0; g < kSetGestures; ++g) {
      const auto map = map_of(random_gesture(7, g, box), 1);
      const Hierarchy h = deformed(rest, set_rules(), map);
      h.require_valid();
      EXPECT_EQ(pairs_too_close(h), 0) << rest.type(0).name << " gesture " << g;
      ratio += deviation(rest, h, *map) / deviation(rest, rest, *map) / kSetGestures;
    }
    EXPECT_LT(ratio, 0.5) << rest.type(0).name;
  }
}

TEST(GrammarSetRules, TheIdentityChangesNothing) {
  const auto identity = std::make_shared<AffineMap>(Eigen::Affine3d::Identity());
  for (const Hierarchy& rest : sets()) {
    const Hierarchy h = deformed(rest, set_rules(), identity);
    for (int e = 0; e < rest.size(); ++e) EXPECT_TRUE(is_same(rest, h, e));
  }
}

TEST(GrammarSetRules, CandidatesGrowWhereItIsStretchedElementsShrinkWhereItIsSqueezed) {
  for (const Hierarchy& rest : sets()) {
    const Vector3d centre = rest.position(rest.children(0)[0]);
    const double radius = 0.4 * key_box(rest).diagonal().norm();
    const Hierarchy wide = deformed(rest, set_rules(), inflation(centre, radius, 1.2));
    const Hierarchy narrow = deformed(rest, set_rules(), inflation(centre, radius, -0.5));
    double grown = 0, shrunk = 0;
    for (const int e : rest.children(0)) {
      if (!rest.present(e)) grown += size_of(wide, e);
      if (rest.present(e)) shrunk += 1 - size_of(narrow, e);
    }
    EXPECT_GT(grown, 1) << rest.type(0).name;
    EXPECT_GT(shrunk, 1) << rest.type(0).name;
  }
}

TEST(GrammarSetRules, NothingPopsFromFrameToFrame) {
  for (const Hierarchy& rest : sets()) {
    const Vector3d centre = rest.position(rest.children(0)[0]);
    const double radius = 0.4 * key_box(rest).diagonal().norm();
    Hierarchy before = rest;
    for (int frame = 1; frame <= 20; ++frame) {
      const Hierarchy now =
          deformed(rest, set_rules(), inflation(centre, radius, 0.5, frame / 60.));
      for (const int e : rest.children(0))
        EXPECT_LT(std::abs(size_of(now, e) - size_of(before, e)), 0.3) << frame;
      before = now;
    }
  }
}

/// What is beyond the support is not touched, and what is near it has the size that it would have
/// if all of the set were looked at.
TEST(GrammarSetRules, ALocalGestureIsTheSameAsOneOnAll) {
  for (const Hierarchy& rest : {make_volume_set({}, 1), spaced_forest(3000)}) {
    const auto box = key_box(rest);
    const auto map = inflation(box.center(), 0.12 * box.diagonal().norm(), -0.4);
    Hierarchy local = rest;
    Transaction undo(local);
    derive(local, undo, set_rules(), {0, Delta::free(map)});
    const Hierarchy whole = deformed(rest, set_rules(), std::make_shared<UnboundedMap>(map));
    int changed = 0;
    for (const int e : rest.children(0)) {
      EXPECT_TRUE(is_same(local, whole, e));
      changed += is_same(local, rest, e) ? 0 : 1;
    }
    EXPECT_GT(changed, 5);
    EXPECT_LT(undo.touched().size(), 0.5 * rest.size());
  }
}

TEST(GrammarSetRules, RewritesOfALocalGestureDoNotGrowWithTheForest) {
  std::vector<int> rewrites;
  for (const int elements : {2500, 22500}) {
    ForestOptions o;
    o.elements = elements;
    Hierarchy h = make_forest(o, 1);
    Transaction undo(h);
    const Vector3d middle(0, 0, 0);
    rewrites.push_back(
        derive(h, undo, set_rules(), {0, Delta::free(inflation(middle, 20, 0.3))}).rewrites);
  }
  EXPECT_NEAR(rewrites[0], rewrites[1], 0.1 * rewrites[0]);
}

TEST(GrammarSetRules, BytesDoNotDependOnThreads) {
  const Hierarchy rest = spaced_forest(6000);
  const auto map = map_of(random_gesture(3, 1, key_box(rest)), 1);
  std::vector<Hierarchy> out(2);
  for (const int threads : {1, 2})
    with_threads(threads, [&] { out[threads - 1] = deformed(rest, set_rules(), map); });
  for (int e = 0; e < rest.size(); ++e) EXPECT_TRUE(is_same(out[0], out[1], e));
}

TEST(GrammarSetRules, ItemsStayAtTheirPlaceOfTheSurface) {
  const Hierarchy rest = make_surface_set({}, 1);
  const Hierarchy h = deformed(rest, set_rules(), map_of(random_gesture(7, 3, key_box(rest)), 1));
  for (const int e : rest.children(0)) {
    const TrianglePlace place{static_cast<int>(h.parameter(e, ItemParameter::kTriangle)),
                              h.parameter(e, ItemParameter::kB0),
                              h.parameter(e, ItemParameter::kB1)};
    EXPECT_EQ(place.triangle, rest.parameter(e, ItemParameter::kTriangle));
    EXPECT_EQ(h.position(e), on_triangle(h.points(0), h.type(0).triangles, place));
  }
}

TEST(GrammarSetRules, ConifersStayUprightOnTheGround) {
  const Hierarchy rest = spaced_forest(400);
  for (int g = 0; g < 10; ++g) {
    const Hierarchy h = deformed(rest, set_rules(), map_of(random_gesture(7, g, key_box(rest)), 1));
    for (const int e : h.children(0)) {
      EXPECT_EQ(h.position(e).z(), 0);
      EXPECT_EQ(h.turn(e).x(), 0);
      EXPECT_EQ(h.turn(e).y(), 0);
    }
  }
}

TEST(GrammarSetRules, NeighboursMakeRoomForAnEditedElement) {
  for (const Hierarchy& rest : sets()) {
    Hierarchy h = rest;
    Transaction undo(h);
    const int e = h.children(0)[5], other = nearest_element(h, e);
    const Vector3d shift = 0.7 * (h.position(other) - h.position(e));
    derive(h, undo, set_rules(), {e, Delta::translate(shift)});
    EXPECT_EQ(h.parameter(e, 0), 1);
    EXPECT_NE(h.position(e), rest.position(e));
    EXPECT_LT(size_of(h, other), 1) << rest.type(0).name;
    EXPECT_EQ(pairs_too_close(h), 0);
    int changed = 0;
    for (const int all : h.children(0)) changed += is_same(h, rest, all) ? 0 : 1;
    EXPECT_LT(changed, 60);
  }
}

TEST(GrammarSetRules, ALargerRadiusIsKeptAndNeighboursShrink) {
  for (const Hierarchy& rest : sets()) {
    DeformationGrammar grammar(rest, set_rules(), {});
    const int e = rest.children(0)[9];
    const double radius = 1.6 * rest.parameter(e, 1);
    grammar.edit({e, Delta::set(1, radius)}, Tag{1, Tag::Follow::rigid});
    EXPECT_EQ(pairs_too_close(grammar.state()), 0);
    const auto map = map_of(random_gesture(7, 2, key_box(rest)), 1);
    grammar.gesture(0, map, map);
    const Hierarchy& h = grammar.state();
    EXPECT_EQ(pairs_too_close(h), 0);
    EXPECT_EQ(h.parameter(e, 1), radius);
    EXPECT_EQ(h.parameter(e, 0), 1);
    EXPECT_NE(h.position(e), rest.position(e));
  }
}

TEST(GrammarSetRules, AnElementThatIsHeldStays) {
  const Hierarchy rest = make_volume_set({}, 1);
  DeformationGrammar grammar(rest, set_rules(), {});
  const int e = rest.children(0)[0];
  grammar.edit({e, Delta::translate({0.02, 0, 0})}, Tag{1, Tag::Follow::stop});
  const Vector3d held = grammar.state().position(e);
  const auto map = std::make_shared<AffineMap>(Eigen::Affine3d(Eigen::Scaling(0.9, 0.8, 1.0)));
  grammar.gesture(0, map, map);
  EXPECT_EQ(grammar.state().position(e), held);
  EXPECT_EQ(pairs_too_close(grammar.state()), 0);
}

TEST(GrammarSetRules, AnEditOntoAnotherEditIsRefusedAndTakenBack) {
  const Hierarchy rest = make_volume_set({}, 1);
  DeformationGrammar grammar(rest, set_rules(), {});
  const int first = rest.children(0)[0], second = rest.children(0)[1];
  grammar.edit({first, Delta::translate({0.01, 0, 0})}, Tag{1, Tag::Follow::rigid});
  const Hierarchy before = grammar.state();
  const Vector3d onto = before.position(first) - before.position(second);
  EXPECT_THROW(grammar.edit({second, Delta::translate(onto)}, {}), Error);
  for (int e = 0; e < before.size(); ++e) EXPECT_TRUE(is_same(before, grammar.state(), e));
  EXPECT_THROW(grammar.edit({second, Delta::set(GrainParameter::kCandidate, 1)}, {}), Error);
}

/// What is stretched and brought back step by step ends as it began, but for rounding.
TEST(GrammarSetRules, StepsThereAndBackEndAtTheStart) {
  for (const Hierarchy& rest : sets()) {
    Hierarchy h = rest;
    Transaction undo(h);
    const RuleSet rules = set_rules();
    const Eigen::Affine3d wider(Eigen::Scaling(1.25, 1.1, 1.0));
    for (const Eigen::Affine3d& step : {wider, wider, wider.inverse(), wider.inverse()})
      derive(h, undo, rules, {0, Delta::free(std::make_shared<AffineMap>(step))});
    for (const int e : rest.children(0)) {
      EXPECT_NEAR((h.position(e) - rest.position(e)).norm(), 0, 1e-9);
      EXPECT_NEAR(size_of(h, e), size_of(rest, e), 1e-9);
    }
  }
}

}  // namespace
}  // namespace geoprior::grammar
