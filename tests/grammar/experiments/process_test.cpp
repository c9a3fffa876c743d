// What the frames of a scene are, whatever the method.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "experiments/grammar/processes/methods.h"
#include "tests/grammar/experiments/loaded.h"
#include "tests/support/recording.h"

namespace geoprior::grammar {
namespace {

using testing::HasSubstr;

/// A small tree and a gesture of four steps that returns, or of some random ones.
GrammarSceneOptions small_tree_scene() {
  GrammarSceneOptions options;
  options.tree.branches = 60;
  options.record = GrammarSceneOptions::Record::keys;
  options.gesture = GestureOptions{};
  options.gesture->file = "gestures/lean.gesture.toml";
  options.gesture->steps = 4;
  options.gesture->course = GestureOptions::Course::back;
  return options;
}

test::Recording recorded(const GrammarScene& scene, const GrammarMethodOptions& options = {},
                         const std::optional<State>& from = std::nullopt) {
  geoprior::test::Recording sink;
  RunContext context;
  deforming_process(scene, [&](RunContext& c) {
    return grammar_deformer(scene, options, c);
  })->run(sink, context, from);
  return sink;
}

Eigen::MatrixX3d keys_of(const Frame& frame) { return frame.require_part("keys").points; }

std::string refused(const GrammarSceneOptions& options) {
  try {
    loaded(options);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(GrammarProcess, AGestureThatReturnsIsTheIdentityBitForBit) {
  const auto scene = loaded(small_tree_scene());
  const geoprior::test::Recording run = recorded(*scene);
  ASSERT_EQ(run.frames.size(), 5U);
  EXPECT_EQ(keys_of(run.frames[4]), keys_of(run.frames[0]));
  EXPECT_NE(keys_of(run.frames[2]), keys_of(run.frames[0]));
  // The first and the third step ask for the same.
  EXPECT_EQ(keys_of(run.frames[1]), keys_of(run.frames[3]));
}

TEST(GrammarProcess, ARunGoesOnFromItsCheckpointInBothModes) {
  auto options = small_tree_scene();
  options.edits.push_back({.element = "branch-3", .kind = EditOptions::Kind::turn, .angle_deg = 5});
  const auto scene = loaded(options);
  for (const auto mode : {GrammarOptions::Mode::from_start, GrammarOptions::Mode::incremental}) {
    GrammarMethodOptions method;
    method.grammar.mode = mode;
    const geoprior::test::Recording whole = recorded(*scene, method);
    const geoprior::test::Recording rest = recorded(*scene, method, whole.checkpoints.at(2));
    ASSERT_EQ(rest.frames.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(keys_of(rest.frames[i]), keys_of(whole.frames[3 + i]));
      EXPECT_EQ(rest.frames[i]
                    .require_part("elements")
                    .require_array("parameters", NamedArray::On::points)
                    .values,
                whole.frames[3 + i]
                    .require_part("elements")
                    .require_array("parameters", NamedArray::On::points)
                    .values);
    }
  }
}

TEST(GrammarProcess, BaselinesMakeTheSameFrames) {
  const auto scene = loaded(small_tree_scene());
  for (const auto make :
       {nothing_deformer, free_form_deformer, frames_deformer, regenerating_deformer}) {
    geoprior::test::Recording sink;
    RunContext context;
    deforming_process(*scene, [&](RunContext&) {
      return make(*scene);
    })->run(sink, context, std::nullopt);
    ASSERT_EQ(sink.frames.size(), 5U);
    EXPECT_EQ(sink.frames[2].parameter, 2);
    EXPECT_EQ(keys_of(sink.frames[0]), keys_of(recorded(*scene).frames[0]));
  }
}

TEST(GrammarProcess, ADerivationIsRecordedAsTextAndDrawing) {
  auto options = small_tree_scene();
  options.gesture.reset();
  options.edits.push_back({.element = "branch-9", .by = {0.1, 0, 0}});
  GrammarMethodOptions method;
  method.trace = true;
  const geoprior::test::Recording run = recorded(*loaded(options), method);
  ASSERT_EQ(run.artifacts.size(), 2U);
  EXPECT_EQ(run.artifacts[0].name, "derivation-001.svg");
  EXPECT_EQ(run.artifacts[1].name, "derivation-001.txt");
}

TEST(GrammarScenes, AreRefusedWhereTheyNameWhatIsNotThere) {
  auto options = small_tree_scene();
  options.edits.push_back({.element = "branch-999999"});
  EXPECT_THAT(refused(options), HasSubstr("scene.edits[0].element: there is no element "
                                          "'branch-999999' (allowed: tree-1, branch-1 to branch-"));
  options.edits[0] = {.element = "branch-2", .kind = EditOptions::Kind::set, .parameter = "girth"};
  EXPECT_THAT(refused(options), HasSubstr("has no parameter 'girth'"));
  options.edits[0] = {.element = "branch-2", .kind = EditOptions::Kind::turn, .axis = {0, 0, 0}};
  EXPECT_THAT(refused(options), HasSubstr("scene.edits[0].axis: has no direction"));
  options.edits.clear();
  options.random = RandomGestureOptions{};
  EXPECT_THAT(refused(options), HasSubstr("scene.random"));
  options.random.reset();
  options.rules = "rules/no-such-file.lua";
  EXPECT_THAT(refused(options), HasSubstr("no-such-file.lua"));
}

TEST(GrammarScenes, AScriptThatIsNotThereCannotBeUsed) {
  const auto scene = loaded(small_tree_scene());
  GrammarMethodOptions method;
  method.rules = GrammarMethodOptions::Rules::script;
  try {
    recorded(*scene, method);
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("scene.rules: a script is to be used"));
  }
}

}  // namespace
}  // namespace geoprior::grammar
