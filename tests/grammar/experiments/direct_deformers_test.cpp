// Direct code of other topics in the scenes of this one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "experiments/grammar/processes/methods.h"
#include "experiments/grammar/scene/scene.h"
#include "tests/support/recording.h"

namespace geoprior::grammar {
namespace {

using testing::HasSubstr;

std::shared_ptr<GrammarScene> direct_scene(const GrammarSceneOptions& options) {
  return load_grammar_scene(options, GEOPRIOR_SOURCE_DIR "/experiments/grammar", 1);
}

test::Recording direct_frames(const GrammarScene& scene,
                              const std::optional<State>& from = std::nullopt) {
  test::Recording sink;
  RunContext context;
  deforming_process(scene, [&](RunContext&) {
    return direct_deformer(scene);
  })->run(sink, context, from);
  return sink;
}

std::string direct_refusal(const GrammarSceneOptions& options) {
  try {
    direct_frames(*direct_scene(options));
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

GrammarSceneOptions arm_scene() {
  GrammarSceneOptions options;
  options.object = Object::arm;
  options.edits = {
      {.element = "joint-3", .kind = EditOptions::Kind::turn, .axis = {0, 1, 0}, .angle_deg = 40},
      {.element = "part-1", .kind = EditOptions::Kind::turn, .axis = {1, 0, 1}, .angle_deg = 70},
      {.element = "joint-3", .kind = EditOptions::Kind::turn, .axis = {0, 0, 1}, .angle_deg = -20}};
  return options;
}

GrammarSceneOptions studs_scene() {
  GrammarSceneOptions options;
  options.object = Object::surface_set;
  options.surface_set.spacing = 0.4;
  options.gesture = GestureOptions{};
  options.gesture->file = "gestures/knead.gesture.toml";
  options.gesture->steps = 2;
  return options;
}

// A part's corners: 8 a part, each rigid with it, so that distances within it stay.
TEST(GrammarDirectDeformers, ArmsShowTheirPartsWhereTheyAreSkinnedTo) {
  const auto scene = direct_scene(arm_scene());
  const test::Recording run = direct_frames(*scene);
  ASSERT_EQ(run.frames.size(), 4U);
  const Part &rest = run.frames[0].require_part("surface"),
             &end = run.frames[3].require_part("surface");
  ASSERT_EQ(rest.points.rows(), 8 * 4);
  for (int v = 0; v < rest.points.rows(); ++v) {
    const int first = v - v % 8;
    EXPECT_NEAR((end.points.row(v) - end.points.row(first)).norm(),
                (rest.points.row(v) - rest.points.row(first)).norm(), 1e-15);
  }
  // The last joint is below all that is turned, the first head stays.
  const auto& elements = run.frames[3].require_part("elements");
  EXPECT_EQ(elements.points.row(1), Eigen::RowVector3d(0, 0, 0));
  EXPECT_EQ(elements.require_array("tagged", NamedArray::On::points).values.sum(), 2);
}

TEST(GrammarDirectDeformers, ARunGoesOnFromItsCheckpoint) {
  for (const GrammarSceneOptions& options : {arm_scene(), studs_scene()}) {
    const auto scene = direct_scene(options);
    const test::Recording whole = direct_frames(*scene);
    const test::Recording rest = direct_frames(*scene, whole.checkpoints.at(1));
    ASSERT_EQ(rest.frames.size() + 2, whole.frames.size());
    for (const char* part : {"elements", "keys", "surface"})
      EXPECT_EQ(rest.frames.back().require_part(part).points,
                whole.frames.back().require_part(part).points);
  }
}

TEST(GrammarDirectDeformers, SaysWhatItHasNoCodeFor) {
  GrammarSceneOptions options = studs_scene();
  options.gesture->element = "item-2";
  EXPECT_THAT(direct_refusal(options), HasSubstr("direct code for object 'surface-set': has a "
                                                 "gesture of one item"));
  options = studs_scene();
  options.object = Object::volume_set;
  EXPECT_THAT(direct_refusal(options), HasSubstr("direct code for object 'volume-set'"));
  options.gesture->file = "gestures/small.lattice.toml";
  EXPECT_EQ(direct_refusal(options), "");
  options = arm_scene();
  options.gesture = studs_scene().gesture;
  EXPECT_THAT(direct_refusal(options), HasSubstr("turns of joints alone"));
  options = arm_scene();
  options.edits[0].kind = EditOptions::Kind::translate;
  EXPECT_THAT(direct_refusal(options), HasSubstr("edit of 'joint-3' by direct code"));
}

}  // namespace
}  // namespace geoprior::grammar
