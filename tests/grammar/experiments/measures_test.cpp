#include "experiments/grammar/measures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "experiments/grammar/measures/asked.h"
#include "experiments/grammar/measures/distribution.h"
#include "experiments/grammar/measures/fidelity.h"
#include "experiments/grammar/measures/motion.h"
#include "experiments/grammar/measures/persistence.h"
#include "tests/grammar/experiments/small_objects.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using samples::kStay;
using samples::lattice_set;
using samples::moved_frame;
using samples::moved_state;
using samples::scaled;
using samples::shifted;
using samples::small_tree;

std::shared_ptr<const SpatialMap> shared(const AffineMap& map) {
  return std::make_shared<AffineMap>(map);
}

/// Moves what is in a box.
class BoxShift final : public SpatialMap {
 public:
  BoxShift(const Eigen::AlignedBox3d& box, const Vector3d& by) : box_(box), by_(by) {}
  [[nodiscard]] Vector3d at(const Vector3d& x) const override {
    return box_.contains(x) ? Vector3d(x + by_) : x;
  }
  [[nodiscard]] std::optional<Eigen::AlignedBox3d> support() const override { return box_; }

 private:
  Eigen::AlignedBox3d box_;
  Vector3d by_;
};

TEST(GrammarMeasures, DeviationIsTheRootMeanSquareOverElements) {
  const Hierarchy h = small_tree();
  const RecordedState rest(h);
  const AskedPlaces asked(h, {}, shared(shifted(3, 0, 4)), 0);
  const Deviation nothing = *deviation_of(rest, rest, asked);
  EXPECT_DOUBLE_EQ(nothing.of_state, 5);
  EXPECT_DOUBLE_EQ(nothing.of_nothing, 5);
  const RecordedState followed = moved_state(h, shifted(3, 0, 4));
  EXPECT_NEAR(deviation_of(followed, rest, asked)->of_state, 0, 1e-15);
  // One of four elements is off by 1 m at one of its two ends.
  Hierarchy longer = h;
  longer.set_parameter(3, BranchParameter::kLength, 2);
  const AskedPlaces stay(h, {}, nullptr, 0);
  EXPECT_DOUBLE_EQ(deviation_of(RecordedState(longer), rest, stay)->of_state, std::sqrt(0.5 / 4));
}

TEST(GrammarMeasures, LostElementsDoNotCountInTheDeviation) {
  Hierarchy h = small_tree();
  const RecordedState rest(h);
  const AskedPlaces asked(h, {}, shared(shifted(1, 0, 0)), 0);
  h.set_present(3, false);
  const RecordedState state(h);
  EXPECT_DOUBLE_EQ(deviation_of(state, rest, asked)->of_state, 1);
  const ElementChanges changes = element_changes(state, rest);
  EXPECT_EQ(changes.lost, 1);
  EXPECT_EQ(changes.touched, 1);
  EXPECT_EQ(element_changes(rest, state).added, 1);
}

TEST(GrammarMeasures, UnservedIsWhatBreaksAConstraintOrIsGone) {
  const Hierarchy h = small_tree();
  const RecordedState rest(h);
  const AskedPlaces asked(h, {}, shared(shifted(3, 0, 4)), 0);
  const auto unserved = [&](const RecordedState& state, const std::set<int>& broken) {
    const Deviation out = *unserved_deviation_of(state, rest, asked, broken);
    EXPECT_DOUBLE_EQ(out.of_nothing, 5);
    return out.of_state;
  };
  const RecordedState followed = moved_state(h, shifted(3, 0, 4));
  EXPECT_DOUBLE_EQ(unserved(rest, {}), 5);
  EXPECT_NEAR(unserved(followed, {}), 0, 1e-15);
  // One of four elements counts as if it had stayed.
  EXPECT_DOUBLE_EQ(unserved(followed, {3}), std::sqrt(25. / 4));
  EXPECT_DOUBLE_EQ(unserved(followed, {0, 1, 2, 3}), 5);
  // What breaks a constraint and goes the wrong way is as far as it is.
  const RecordedState away = moved_state(h, shifted(-3, 0, -4));
  EXPECT_DOUBLE_EQ(unserved(away, {0, 1, 2, 3}), 10);
  Hierarchy fewer = h;
  fewer.set_present(3, false);
  EXPECT_DOUBLE_EQ(unserved(moved_state(fewer, shifted(3, 0, 4)), {}), std::sqrt(25. / 4));
}

TEST(GrammarMeasures, AskedPlacesAreEditsThenTheMap) {
  const Hierarchy h = small_tree();
  const std::vector<Edit> edits{{1, Delta::translate({0, 1, 0})},
                                {3, Delta::set(BranchParameter::kLength, 2)},
                                {2, Delta::extrude(BranchParameter::kLength, 0.5)}};
  const AskedPlaces asked(h, edits, shared(shifted(0, 0, 10)), 3);
  EXPECT_EQ(asked.keys(0).at(0), Vector3d(0, 0, 0));
  EXPECT_EQ(asked.keys(1).at(1), Vector3d(0, 1, 1));
  EXPECT_EQ(asked.keys(2).at(1), Vector3d(0, 1, 2.5));
  // The map is asked of element 3 alone.
  EXPECT_LT((asked.keys(3).at(1) - Vector3d(2, 1, 10.5)).norm(), 1e-15);
}

TEST(GrammarMeasures, AChangeOfOneBitIsATouch) {
  Hierarchy h = small_tree();
  const RecordedState rest(h);
  EXPECT_EQ(element_changes(rest, rest).touched, 0);
  h.set_parameter(3, BranchParameter::kRadius,
                  std::nextafter(h.parameter(3, BranchParameter::kRadius), 1));
  EXPECT_EQ(element_changes(RecordedState(h), rest).touched, 1);
  const std::vector<int> others{0, 1, 2}, all{0, 1, 2, 3};
  EXPECT_EQ(changed_among(others, RecordedState(h), rest), 0);
  EXPECT_EQ(changed_among(all, RecordedState(h), rest), 1);
}

TEST(GrammarMeasures, SizesThatShrinkAreNotKept) {
  Hierarchy h = lattice_set(2);
  const RecordedState rest(h);
  EXPECT_EQ(*kept_size(rest, rest), 1);
  h.set_parameter(1, 0, 0.5);
  h.set_present(2, false);
  EXPECT_DOUBLE_EQ(*kept_size(RecordedState(h), rest), 6.5 / 8);
  const Hierarchy tree = small_tree();
  EXPECT_FALSE(kept_size(RecordedState(tree), RecordedState(tree)));
}

TEST(GrammarMeasures, OutOfReachIsWhatNoElementAboveIsReachedOf) {
  const Hierarchy h = small_tree();
  const RecordedState rest(h);
  // At the tip of the side branch, at the upper trunk, at the root, which is never out of reach.
  const auto box_at = [](double x, double y, double z) {
    const Vector3d centre(x, y, z), half(0.1, 0.1, 0.1);
    return BoxShift({Eigen::AlignedBox3d(centre - half, centre + half)}, {0, 1, 0});
  };
  EXPECT_EQ(out_of_reach(rest, box_at(1, 0, 0.5)), (std::vector<int>{1, 2}));
  EXPECT_EQ(out_of_reach(rest, box_at(0, 0, 1.7)), (std::vector<int>{1, 3}));
  EXPECT_TRUE(out_of_reach(rest, box_at(0, 0, 0)).empty());
  EXPECT_TRUE(out_of_reach(rest, shifted(1, 0, 0)).empty());
}

TEST(GrammarMeasures, PopsAreOverTheSizeOfTheElement) {
  const Hierarchy h = small_tree();
  const RecordedState rest(h);
  const AskedPlaces before(h, {}, nullptr, 0), after(h, {}, shared(shifted(0.1, 0, 0)), 0);
  PopMeter meter;
  EXPECT_FALSE(meter.largest());
  meter.add(rest, before, moved_state(h, shifted(0.1, 0, 0)), after);
  EXPECT_NEAR(*meter.largest(), 0, 1e-15);
  Hierarchy popped = h;
  popped.set_position(3, h.position(3) + Vector3d(0, 0.5, 0));
  meter.add(rest, before, RecordedState(popped), before);
  EXPECT_DOUBLE_EQ(*meter.largest(), 0.5);
  EXPECT_DOUBLE_EQ(*meter.largest_over_size(), 0.5);
  // What comes at its full size pops by that.
  popped.set_present(2, false);
  meter.add(RecordedState(popped), before, RecordedState(h), before);
  EXPECT_DOUBLE_EQ(*meter.largest_over_size(), 1);
}

TEST(GrammarMeasures, AGrainThatGrowsMovesItsSurface) {
  Hierarchy h = lattice_set(1);
  const RecordedState rest(h);
  const AskedPlaces stay(h, {}, nullptr, 0);
  h.set_parameter(1, 0, 0.25);
  PopMeter meter;
  meter.add(RecordedState(h), stay, rest, stay);
  EXPECT_DOUBLE_EQ(*meter.largest(), 0.375);  // of a radius of 0.5 m
  EXPECT_DOUBLE_EQ(*meter.largest_over_size(), 0.375);
}

// A candidate that is just there is carried along by the map: it moves far over what is seen of it,
// but as it is asked to.
TEST(GrammarMeasures, ACandidateIsAskedToFollowAndComesWithItsExtent) {
  Hierarchy h = lattice_set(2);
  h.set_present(5, false);
  h.set_parameter(5, 0, 0);
  const Hierarchy rest = h;
  const AskedPlaces stay(rest, {}, nullptr, 0), asked(rest, {}, shared(shifted(0.5, 0, 0)), 0);
  h.set_present(5, true);
  h.set_parameter(5, 0, 0.01);
  PopMeter meter;
  meter.add(RecordedState(rest), stay, RecordedState(h), stay);
  EXPECT_DOUBLE_EQ(*meter.largest(), 0.01);
  EXPECT_DOUBLE_EQ(*meter.largest_over_size(), 0.01);
  meter.add(RecordedState(h), stay, moved_state(h, shifted(0.5, 0, 0)), asked);
  EXPECT_DOUBLE_EQ(*meter.largest(), 0.01);
}

TEST(GrammarMeasures, AReturnIsToTheSamePlaces) {
  Hierarchy h = small_tree();
  const RecordedState rest(h);
  EXPECT_EQ(return_gap(rest, rest), 0);
  h.set_position(3, h.position(3) + Vector3d(0, 3e-3, 4e-3));
  EXPECT_NEAR(return_gap(rest, RecordedState(h)), 5e-3, 1e-15);
  h.set_present(2, false);
  EXPECT_DOUBLE_EQ(return_gap(rest, RecordedState(h)), 1);
}

TEST(GrammarMeasures, TaggedElementsMayFollowRigidly) {
  const Hierarchy h = small_tree();
  PersistenceMeter meter;
  meter.remember(RecordedState(h), 3);
  EXPECT_FALSE(meter.lost());
  const Eigen::Affine3d motion =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.5, Vector3d::UnitY());
  meter.compare(moved_state(h, AffineMap(motion)));
  EXPECT_NEAR(*meter.distance(), 0, 1e-14);
  EXPECT_EQ(*meter.parameter(), 0);
  EXPECT_EQ(*meter.lost(), 0);
  // Free-form deformation stretches it, and leaves its parameters.
  meter.compare(moved_state(h, scaled(1.5, 1.5, 1.5)));
  EXPECT_DOUBLE_EQ(*meter.distance(), 0.5);
  EXPECT_EQ(*meter.parameter(), 0);
  EXPECT_EQ(*meter.lost(), 1);
}

TEST(GrammarMeasures, AnElementThatIsGoneIsALostEdit) {
  Hierarchy h = small_tree();
  PersistenceMeter meter;
  meter.remember(RecordedState(h), 3);
  meter.remember(RecordedState(h), 2);
  h.set_present(3, false);
  h.set_parameter(2, BranchParameter::kRadius, 0.06);
  meter.compare(RecordedState(h));
  EXPECT_NEAR(*meter.parameter(), 0.01, 1e-16);
  EXPECT_EQ(*meter.lost(), 2);
}

TEST(GrammarMeasures, DistributionsOfATreeChangeAsItsBranchesDo) {
  Hierarchy h = small_tree();
  const RecordedState rest(h);
  EXPECT_EQ(*tree_distributions(rest, rest).lengths, 0);
  EXPECT_EQ(*tree_distributions(rest, rest).angles, 0);
  // One of three is longer, one of the two that hang on a branch is turned.
  h.set_parameter(1, BranchParameter::kLength, 1.25);
  EXPECT_DOUBLE_EQ(*tree_distributions(RecordedState(h), rest).lengths, 1. / 3);
  h.set_pose(2, {h.position(2), Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Vector3d::UnitX()))});
  EXPECT_DOUBLE_EQ(*tree_distributions(RecordedState(h), rest).angles, 0.5);
}

TEST(GrammarMeasures, HolesOfAStretchedLatticeGrow) {
  const Hierarchy h = lattice_set(3);
  const RecordedState rest(h);
  const AskedPlaces stay(h, {}, nullptr, 0);
  const SetDistribution at_rest = set_distribution(rest, rest, stay);
  EXPECT_EQ(*at_rest.spread, 0);
  // Of two grains within 1.5 spacings: the middle of a square's diagonal.
  EXPECT_DOUBLE_EQ(*at_rest.hole, std::sqrt(0.5));
  const AskedPlaces asked(h, {}, shared(scaled(2, 2, 2)), 0);
  const RecordedState moved = moved_state(h, scaled(2, 2, 2));
  EXPECT_DOUBLE_EQ(*set_distribution(moved, rest, asked).hole, 2 * std::sqrt(0.5));
}

TEST(GrammarMeasures, DifferencesAreByNumberNotByRow) {
  Hierarchy h = small_tree();
  Frame frame = moved_frame(h, kStay), turned = frame;
  Part& keys = turned.parts.at("keys");
  keys.points = keys.points.colwise().reverse().eval();
  for (NamedArray& array : keys.arrays) array.values = array.values.colwise().reverse().eval();
  const RecordedState state(frame, h.types()), other(turned, h.types());
  EXPECT_EQ(*difference_of(state, other).largest, 0);
  EXPECT_EQ(difference_of(state, other).unmatched, 0);
  h.set_present(3, false);
  EXPECT_EQ(difference_of(state, RecordedState(h)).unmatched, 1);
}

TEST(GrammarMeasures, RefuseFramesThatAreNone) {
  const Hierarchy h = small_tree();
  const auto expect_refusal = [&](const std::function<void(Frame&)>& spoil, const char* text) {
    Frame frame = moved_frame(h, kStay);
    spoil(frame);
    geoprior::test::expect_error([&] { (void)RecordedState(frame, h.types()); }, {text});
  };
  expect_refusal([](Frame& f) { f.parts.erase("keys"); }, "keys");
  expect_refusal([](Frame& f) { f.parts.at("elements").arrays[0].values(1, 0) = 2; },
                 "is there twice");
  expect_refusal([](Frame& f) { f.parts.at("elements").arrays[1].values(1, 0) = 9; },
                 "is of type 9");
  expect_refusal([](Frame& f) { f.parts.at("keys").arrays[0].values(0, 0) = 7; },
                 "a key point is of element 7");
  expect_refusal([](Frame& f) { f.parts.at("keys").arrays[1].values(1, 0) = 1; },
                 "key point 1 comes after 0 others");
}

/// A tree, an edit of its side branch, then a gesture to and fro in four steps.
GrammarScene scene_to_and_fro() {
  GrammarScene scene;
  scene.rest = small_tree();
  scene.edits = {{{3, Delta::translate({0.25, 0, 0})}, Tag{1, Tag::Follow::rigid}}};
  Stroke pull;
  pull.path = {{0, 0, 2}, {0.4, 0, 2}};
  pull.radius = 1.2;
  scene.gesture.strokes = {pull};
  scene.steps = {{}, {Step::Kind::edit, 0}};
  for (const auto& [before, fraction] :
       {std::pair(0.0, 0.5), std::pair(0.5, 1.0), std::pair(1.0, 0.5), std::pair(0.5, 0.0)})
    scene.steps.push_back({Step::Kind::gesture, 0, fraction, before});
  return scene;
}

/// Frames of free-form deformation.
std::vector<Frame> free_form_frames(const GrammarScene& scene) {
  std::vector<Frame> out{moved_frame(scene.rest, kStay, 0)};
  Hierarchy edited = scene.rest;
  edited.set_position(3, edited.position(3) + Vector3d(0.25, 0, 0));
  out.push_back(moved_frame(edited, kStay, 1));
  for (std::size_t step = 2; step < scene.steps.size(); ++step)
    out.push_back(moved_frame(edited, *scene.asked_map(step), static_cast<int>(step)));
  return out;
}

TEST(GrammarMeasures, OfFreeFormDeformationAreThoseOfTheGesture) {
  const GrammarScene scene = scene_to_and_fro();
  const std::vector<Frame> frames = free_form_frames(scene);
  for (const Frame& frame : frames)
    EXPECT_NEAR(fidelity_measures(scene, frame)->deviation, 0, 1e-14);
  EXPECT_FALSE(fidelity_measures(scene, frames[0])->ratio);
  // Of four elements one was to move by 0.25 m.
  EXPECT_DOUBLE_EQ(fidelity_measures(scene, frames[1])->of_nothing, 0.125);
  EXPECT_NEAR(constraint_measures(scene, frames[1])->tree.attachment.worst.value(), 0.25, 1e-14);
  EXPECT_EQ(change_measures(scene, frames[1])->touched_share, 0.25);
  const MotionMeasures motion = motion_measures(scene, FramesInMemory(frames));
  EXPECT_NEAR(*motion.pop, 0, 1e-14);
  EXPECT_EQ(*motion.return_gap, 0);
  const LocalityMeasures locality = locality_measures(scene, FramesInMemory(frames));
  EXPECT_EQ(*locality.stray_of_gestures, 0);
  EXPECT_EQ(*locality.tagged_parameter_change, 0);
  const SuiteMeasures suite = *suite_measures(scene, FramesInMemory(frames));
  EXPECT_EQ(suite.gestures, 4);
  EXPECT_EQ(*suite.broken_gestures, 4);
  EXPECT_NEAR(*suite.mean_deviation_ratio, 0, 1e-14);
  // The side branch, one of four elements, is off its parent all the while, and was to move 0.25 m.
  EXPECT_EQ(constraint_measures(scene, frames.back())->broken_elements(), std::set<int>{3});
  double asked = 0;
  for (std::size_t step = 2; step < frames.size(); ++step)
    asked += fidelity_measures(scene, frames[step])->of_nothing;
  EXPECT_NEAR(*suite.unserved_ratio, 4 * 0.125 / asked, 1e-12);
  // Doing nothing breaks nothing.
  std::vector<Frame> at_rest;
  for (std::size_t step = 0; step < frames.size(); ++step)
    at_rest.push_back(moved_frame(scene.rest, kStay, static_cast<int>(step)));
  EXPECT_EQ(*suite_measures(scene, FramesInMemory(at_rest))->unserved_ratio, 1);
}

TEST(GrammarMeasures, SeeWhatASingleFrameDoes) {
  const GrammarScene scene = scene_to_and_fro();
  std::vector<Frame> frames = free_form_frames(scene);
  // In the last frame the tagged branch, beside the gesture, is 1 m aside and 2 m long.
  Part& keys = frames.back().parts.at("keys");
  const Eigen::Index base = keys.points.rows() - 2, tip = base + 1;
  keys.points.row(base) += Eigen::RowVector3d(0, 1, 0);
  keys.points.row(tip) += Eigen::RowVector3d(1, 1, 0);
  const MotionMeasures motion = motion_measures(scene, FramesInMemory(frames));
  EXPECT_NEAR(*motion.pop, std::sqrt(2), 0.01);
  EXPECT_NEAR(*motion.pop_ratio, std::sqrt(2) / 2, 0.01);
  EXPECT_NEAR(*motion.return_gap, std::sqrt(2), 1e-14);
  const LocalityMeasures locality = locality_measures(scene, FramesInMemory(frames));
  EXPECT_NEAR(*locality.tagged_change, 1, 1e-14);
  EXPECT_EQ(*locality.lost_edits, 1);
  const ReferenceMeasures reference =
      reference_measures(scene, frames.back(), free_form_frames(scene).back());
  EXPECT_NEAR(*reference.difference, std::sqrt(2), 1e-14);
  EXPECT_EQ(reference.unmatched, 0);
}

TEST(GrammarMeasures, WhatTheGestureHasReachedIsNotStray) {
  GrammarScene scene = scene_to_and_fro();
  // Far from the trunk's tip, where the gesture is.
  scene.rest = small_tree();
  scene.rest.add(1, 0, {{9, 0, 0}, Eigen::Quaterniond::Identity()},
                 std::array{1.0, 0.05, 0.0, 0.0, 1.0, 1.0});
  std::vector<Frame> frames = free_form_frames(scene);
  const auto stray_when_moved = [&](int element) {
    std::vector<Frame> moved = frames;
    Part& keys = moved.back().parts.at("keys");
    // The root has one key point, all others have two.
    keys.points(2 * element, 0) += 1e-9;
    return *locality_measures(scene, FramesInMemory(moved)).stray_of_gestures;
  };
  EXPECT_EQ(stray_when_moved(2), 0);
  EXPECT_EQ(stray_when_moved(4), 1);
}

TEST(GrammarMeasures, OfASampleAreThoseOfItsElementsAlone) {
  GrammarScene scene = scene_to_and_fro();
  scene.record = GrammarSceneOptions::Record::sample;
  Hierarchy sample = scene.rest;
  sample.set_present(1, false);
  const Frame frame = moved_frame(sample, kStay, 1);
  EXPECT_FALSE(constraint_measures(scene, frame));
  EXPECT_FALSE(change_measures(scene, frame));
  scene.steps[1] = {Step::Kind::gesture, 0, 1.0, 0.0};
  EXPECT_FALSE(suite_measures(scene, FramesInMemory({frame}))->unserved_ratio);
  scene.steps[1] = {Step::Kind::edit, 0};
  // Of three elements one was to move by 0.25 m.
  EXPECT_DOUBLE_EQ(fidelity_measures(scene, frame)->deviation, 0.25 / std::sqrt(3));
}

}  // namespace
}  // namespace geoprior::grammar
