// Structures that are gone, that differ in a bit, and lists that say so.
#include "experiments/embryo/measures/changes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/embryo/experiments/planted.h"

namespace geoprior::embryo {
namespace {

using planted::add_shape;
using planted::add_surface;
using planted::box;
using planted::empty_frame;
using planted::scene_of;

TriMesh unit_box(double x) { return box({x, 0, 0}, {x + 1, 1, 1}); }

/// Three boxes on two days.
std::vector<Frame> healthy_days() {
  std::vector<Frame> frames{empty_frame(40), empty_frame(50)};
  for (Frame& frame : frames)
    for (int s = 0; s < 3; ++s) add_surface(frame, s, unit_box(2.0 * s));
  return frames;
}

EmbryoScene sided_scene() {
  EmbryoScene scene = scene_of({"left", "middle", "right"}, {"left", "median", "right"});
  Disease disease;
  disease.name = "d";
  disease.side = "left";
  scene.ontology.diseases = {disease};
  scene.disease = 0;
  return scene;
}

ChangeMeasures measured(const EmbryoScene& scene, const std::vector<Frame>& frames) {
  const FramesInMemory reference(healthy_days());
  return change_measures(scene, FramesInMemory(frames, {}, {}, &reference)).value();
}

TEST(EmbryoChanges, EqualDaysHaveNone) {
  const ChangeMeasures m = measured(sided_scene(), healthy_days());
  EXPECT_EQ(m.absent, 0);
  EXPECT_EQ(m.altered, 0);
  EXPECT_EQ(m.other_side.value(), 0);
  EXPECT_FALSE(m.absent_errors) << "there is no list";
}

TEST(EmbryoChanges, OneBitOnOneDayIsOne) {
  std::vector<Frame> frames = healthy_days();
  double& x = frames[1].parts.at(recorded::kSurface).points(16, 0);
  x = std::nextafter(x, 100);
  const ChangeMeasures m = measured(sided_scene(), frames);
  EXPECT_EQ(m.altered, 1);
  EXPECT_EQ(m.absent, 0);
  EXPECT_EQ(m.other_side.value(), 1) << "it is the right one";
}

TEST(EmbryoChanges, WhatIsNeverThereIsAbsentAndWhatGoesEarlyIsAltered) {
  EmbryoScene scene = sided_scene();
  std::vector<Frame> frames{empty_frame(40), empty_frame(50)};
  for (Frame& frame : frames) add_surface(frame, 2, unit_box(4));
  add_surface(frames[0], 1, unit_box(2));
  EXPECT_EQ(measured(scene, frames).absent, 1);
  EXPECT_EQ(measured(scene, frames).altered, 1);
  scene.expected = ExpectedChanges{{"left"}, {"middle"}};
  EXPECT_EQ(measured(scene, frames).absent_errors.value(), 0);
  EXPECT_EQ(measured(scene, frames).altered_errors.value(), 0);
  scene.expected = ExpectedChanges{{"left", "right"}, {}};
  EXPECT_EQ(measured(scene, frames).absent_errors.value(), 1) << "right is there";
  EXPECT_EQ(measured(scene, frames).altered_errors.value(), 1) << "middle was not expected";
}

TEST(EmbryoChanges, WithoutAReferenceThereAreNone) {
  EXPECT_FALSE(change_measures(sided_scene(), FramesInMemory(healthy_days())));
}

TEST(EmbryoChanges, DifferencesAreOverTheBodysLength) {
  const EmbryoScene scene = scene_of({"a", "b"});
  Frame one = empty_frame(40), other = empty_frame(40);
  add_surface(one, 0, unit_box(0));
  add_surface(other, 0, unit_box(0.25));
  add_surface(other, 1, unit_box(5));
  add_shape(one, 0, Primitive::ovoid, {0, 0, 0}, {1, 1, 1});
  add_shape(other, 0, Primitive::ovoid, {0.5, 0, 0}, {1, 1, 1});
  other.tables.at(recorded::kBody).rows(0, 0) = 2;
  const DifferenceMeasures m = difference_measures(scene, one, other).value();
  EXPECT_NEAR(m.surface.value(), 0.125, 1e-12);
  EXPECT_NEAR(m.state.value(), 0.25, 1e-12);
  EXPECT_EQ(m.unmatched, 1);
}

}  // namespace
}  // namespace geoprior::embryo
