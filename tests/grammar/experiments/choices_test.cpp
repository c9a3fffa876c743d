// Options whose turning no metric shows: what a script may take, and the record of a derivation.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "experiments/grammar/processes/methods.h"
#include "experiments/grammar/scene/scene.h"
#include "tests/support/recording.h"

namespace geoprior::grammar {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Items that a script carries along on a lump that leans.
std::shared_ptr<GrammarScene> carried_items() {
  GrammarSceneOptions options;
  options.object = Object::surface_set;
  options.surface_set.spacing = 0.45;
  options.record = GrammarSceneOptions::Record::keys;
  options.rules = "rules/carried-details.lua";
  options.gesture = GestureOptions{};
  options.gesture->file = "gestures/lean.gesture.toml";
  options.gesture->scale = 0.3;
  options.gesture->steps = 1;
  return load_grammar_scene(options, GEOPRIOR_SOURCE_DIR "/experiments/grammar", 1);
}

test::Recording run_of(const GrammarScene& scene, const GrammarMethodOptions& options) {
  test::Recording sink;
  RunContext context;
  deforming_process(scene, [&](RunContext& c) {
    return grammar_deformer(scene, options, c);
  })->run(sink, context, std::nullopt);
  return sink;
}

/// What the script says when it may take no more than this; "" where that is enough.
std::string script_failure(const LuaLimits& limits) {
  const auto scene = carried_items();
  GrammarMethodOptions options;
  options.rules = GrammarMethodOptions::Rules::script;
  options.limits = limits;
  try {
    run_of(*scene, options);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(GrammarChoices, InstructionsOfAScriptEndWhereTheMethodSaysSo) {
  EXPECT_EQ(script_failure({}), "");
  EXPECT_THAT(script_failure({.instructions = 1000, .instructions_per_element = 0}),
              AllOf(HasSubstr("carried-details.lua"), HasSubstr("runs on")));
}

/// The surface's own thousands of points are one element, whose call needs far more.
TEST(GrammarChoices, ElementsAreAllowedInstructionsMore) {
  const LuaLimits few{.instructions = 1000, .instructions_per_element = 1'000'000};
  EXPECT_EQ(script_failure(few), "");
}

TEST(GrammarChoices, MemoryOfAScriptEndsWhereTheMethodSaysSo) {
  EXPECT_THAT(script_failure({.memory = 20'000}), HasSubstr("memory"));
}

TEST(GrammarChoices, ATraceAddsFilesAndChangesNoFrame) {
  const auto scene = carried_items();
  GrammarMethodOptions options;
  const test::Recording plain = run_of(*scene, options);
  options.trace = true;
  const test::Recording traced = run_of(*scene, options);
  EXPECT_TRUE(plain.artifacts.empty());
  EXPECT_EQ(traced.artifacts.size(), 2U);
  ASSERT_EQ(plain.frames.size(), 2U);
  ASSERT_EQ(traced.frames.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(plain.frames[i].require_part("keys").points,
              traced.frames[i].require_part("keys").points);
}

}  // namespace
}  // namespace geoprior::grammar
