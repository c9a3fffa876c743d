// Readings of a day, scores against the literature, mirrored sides, ends of ducts, motions.
#include "experiments/embryo/measures/organs.h"

#include <gtest/gtest.h>

#include <numbers>

#include "experiments/embryo/measures/answers.h"
#include "experiments/embryo/measures/motion.h"
#include "tests/embryo/experiments/planted.h"

namespace geoprior::embryo {
namespace {

using planted::add_line;
using planted::add_shape;
using planted::add_surface;
using planted::box;
using planted::empty_frame;
using planted::scene_of;

constexpr double kPi = std::numbers::pi;

TEST(EmbryoOrgans, PolesAndLengthsAreReadOffTheSurface) {
  const EmbryoScene scene = scene_of({"kidney"});
  Frame frame = empty_frame(40);
  add_surface(frame, 0, box({0, 0, 1}, {1, 1, 3}));
  add_shape(frame, 0, Primitive::ovoid, {0.5, 0.5, 2}, {0.5, 0.5, 1});
  EXPECT_EQ(reading(scene, RecordedDay(frame), "crown_rump_length", {}).value(), 1);
  EXPECT_EQ(reading(scene, RecordedDay(frame), "kidney_length", 0).value(), 2);
  EXPECT_EQ(reading(scene, RecordedDay(frame), "upper_pole_height", 0).value(), 3);
  EXPECT_EQ(reading(scene, RecordedDay(frame), "lower_pole_height", 0).value(), 1);
  EXPECT_FALSE(reading(scene, RecordedDay(frame), "upper_pole_height", {}));
  EXPECT_FALSE(reading(scene, RecordedDay(frame), "vertebral_level", 0))
      << "there are no vertebrae";
}

TEST(EmbryoOrgans, HilumTurnsFromVentralToMedial) {
  EmbryoScene scene = scene_of({"kidney"}, {"left"});
  Frame frame = empty_frame(40);
  add_surface(frame, 0, box({0, 0, 0}, {1, 1, 1}));
  add_shape(frame, 0, Primitive::ovoid, {0, 0, 0}, {1, 1, 1});
  auto quaternion = frame.tables.at(recorded::kShapes).rows.row(0).segment<4>(5);
  // Local x is turned by -90 degrees about z to -y, ventral; by 180 to -x, medial of a left one.
  quaternion << std::sqrt(0.5), 0, 0, -std::sqrt(0.5);
  EXPECT_NEAR(reading(scene, RecordedDay(frame), "hilum_angle", 0).value(), 0, 1e-12);
  quaternion << 0, 0, 0, 1;
  EXPECT_NEAR(reading(scene, RecordedDay(frame), "hilum_angle", 0).value(), kPi / 2, 1e-12);
  scene.ontology.structures[0].side = "right";
  quaternion << 1, 0, 0, 0;
  EXPECT_NEAR(reading(scene, RecordedDay(frame), "hilum_angle", 0).value(), kPi / 2, 1e-12);
}

TEST(EmbryoOrgans, LevelsCountVertebraeFromT12) {
  const EmbryoScene scene = scene_of({"L1", "L2", "L3", "L4", "L5", "S1", "T12", "kidney"});
  Frame frame = empty_frame(40);
  for (int i = 0; i < 6; ++i) add_shape(frame, i, Primitive::point, {0, 0, 5.0 - i}, {0, 0, 0});
  add_shape(frame, 6, Primitive::point, {0, 0, 6}, {0, 0, 0});
  add_shape(frame, 7, Primitive::ovoid, {0, 0, 3.5}, {1, 1, 1});
  EXPECT_NEAR(reading(scene, RecordedDay(frame), "vertebral_level", 7).value(), 14.5, 1e-12);
}

/// Two stages of days 40 to 42 and 42 to 44; crown-rump lengths in them.
EmbryoScene measured_scene() {
  EmbryoScene scene = scene_of({"a"});
  scene.options.parameter_set = "Ours";
  scene.ontology.stages = {{"S1", "first", 1, 40, 42}, {"S2", "second", 2, 42, 44}};
  Measurement one;
  one.quantity = "crown_rump_length";
  one.low = 0.8;
  one.high = 1.2;
  one.mean = 1;
  one.deviation = 0.2;
  one.stage = 0;
  Measurement other = one;
  other.stage = 1;
  scene.ontology.measurements = {one, other};
  return scene;
}

TEST(EmbryoScores, CountOnlyWhatTheSetWasNotAuthoredFrom) {
  EmbryoScene scene = measured_scene();
  std::vector<Frame> frames{empty_frame(41), empty_frame(43)};
  frames[1].tables.at(recorded::kBody).rows(0, 0) = 1.5;
  const ScoreMeasures both = score_measures(scene, FramesInMemory(frames)).value();
  EXPECT_EQ(both.scored, 2);
  EXPECT_EQ(both.inside, 1);
  EXPECT_NEAR(both.worst.value(), 2.5, 1e-12);
  EXPECT_NEAR(both.rms.value(), std::sqrt(2.5 * 2.5 / 2), 1e-12);
  scene.ontology.measurements[1].input_of = {"Ours"};
  const ScoreMeasures held_out = score_measures(scene, FramesInMemory(frames)).value();
  EXPECT_EQ(held_out.scored, 1);
  EXPECT_EQ(held_out.inputs, 1);
  EXPECT_EQ(held_out.rms.value(), 0);
}

TEST(EmbryoScores, AStageWithoutAFrameIsNotScored) {
  const ScoreMeasures m =
      score_measures(measured_scene(), FramesInMemory({empty_frame(41)})).value();
  EXPECT_EQ(m.scored, 1);
}

TEST(EmbryoMirror, APairThatIsOffByATenthIsSeen) {
  EmbryoScene scene = scene_of({"left", "right"}, {"left", "right"});
  scene.ontology.structures[1].mirror_of = 0;
  Frame frame = empty_frame(40);
  add_surface(frame, 0, box({1, 0, 0}, {2, 1, 1}));
  add_surface(frame, 1, box({-2.1, 0, 0}, {-1, 1, 1}));
  EXPECT_NEAR(mirror_error(scene, RecordedDay(frame)).value(), 0.1, 1e-12);
  scene.disease = 0;
  EXPECT_FALSE(mirror_error(scene, RecordedDay(frame)))
      << "nothing is said of symmetry under a disease";
}

TEST(EmbryoDucts, AnEndThatIsOffItsAnchorIsSeen) {
  EmbryoScene scene = scene_of({"ball", "duct"});
  Key key;
  key.day = 30;
  key.geometry.primitive = Primitive::duct;
  key.geometry.start = {0, Eigen::Vector3d(0, 0, 1)};
  scene.ontology.structures[1].keys = {key};
  Frame frame = empty_frame(40);
  add_shape(frame, 0, Primitive::ovoid, {0, 0, 0}, {1, 1, 2});
  add_shape(frame, 1, Primitive::duct, {0, 0, 0}, {0, 0, 0});
  Eigen::MatrixX3d line(2, 3);
  line << 0, 0, 2, 0, 0, 5;
  add_line(frame, 1, line, 0.1);
  EXPECT_EQ(duct_end_gap(scene, frame).value(), 0);
  frame.parts.at(recorded::kCentrelines).points(0, 1) = 0.25;
  EXPECT_NEAR(duct_end_gap(scene, frame).value(), 0.25, 1e-12);
}

/// One structure that moves along x by `way(day)`.
std::vector<Frame> moving(double (*way)(double), const std::vector<double>& days) {
  std::vector<Frame> frames;
  for (const double day : days) {
    Frame& frame = frames.emplace_back(empty_frame(day));
    add_shape(frame, 0, Primitive::ovoid, {way(day), 0, 0}, {1, 1, 1});
  }
  return frames;
}

TEST(EmbryoMotion, AKinkAtAStagesMiddleIsAJumpAndAParabolaIsNone) {
  EmbryoScene scene = measured_scene();
  constexpr double h = 1.0 / 8192;
  scene.options.border_step = h;
  const std::vector<double> days{40, 41 - 2 * h, 41 - h, 41, 41 + h, 41 + 2 * h, 42};
  const auto kink = moving([](double d) { return d < 41 ? d : 41 + 2 * (d - 41); }, days);
  EXPECT_GT(motion_measures(scene, FramesInMemory(kink)).velocity_jump.value(), 0.1);
  const auto parabola = moving([](double d) { return (d - 40) * (d - 40); }, days);
  EXPECT_LT(motion_measures(scene, FramesInMemory(parabola)).velocity_jump.value(), 1e-6);
}

TEST(EmbryoMotion, WhatShrinksIsAReversalUnlessItIsSaidToRegress) {
  EmbryoScene scene = scene_of({"a"});
  std::vector<Frame> frames{empty_frame(40), empty_frame(41)};
  add_surface(frames[0], 0, box({0, 0, 0}, {1, 1, 1}));
  add_surface(frames[1], 0, box({0, 0, 0}, {1, 1, 0.9}));
  EXPECT_EQ(motion_measures(scene, FramesInMemory(frames)).reversals, 1);
  scene.ontology.structures[0].regresses = true;
  EXPECT_EQ(motion_measures(scene, FramesInMemory(frames)).reversals, 0);
}

TEST(EmbryoAnswers, OtherRowsAreSeen) {
  const EmbryoScene scene = scene_of({"a"});
  Frame one = empty_frame(40);
  EXPECT_FALSE(answers_differing(scene, one, one));
  FrameTable& answers = one.tables[recorded::kAnswers];
  answers.columns = {"query [1]", "rows [1]", "hash_high [1]", "hash_low [1]"};
  answers.rows.resize(2, 4);
  answers.rows << 1, 5, 17, 18, 2, 3, 19, 20;
  Frame other = one;
  EXPECT_EQ(answers_differing(scene, one, other).value(), 0);
  EXPECT_EQ(answer_rows(scene, one).value(), 8);
  other.tables.at(recorded::kAnswers).rows(1, 3) = 21;
  EXPECT_EQ(answers_differing(scene, one, other).value(), 1);
}

}  // namespace
}  // namespace geoprior::embryo
