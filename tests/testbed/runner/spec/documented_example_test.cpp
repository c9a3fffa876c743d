// The experiment in the documentation of the file format.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testbed/runner/spec/spec_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::ElementsAre;

class SpecExample : public SpecTest {};

/// The topic of the experiment in the documentation of the file format, as far as it needs one.
struct KneeScene {
  std::string character, skeleton;
  struct Motion {
    std::string joint, axis;
    double from_deg = 0, to_deg = 0;
    int frames = 2;
  } motion;
};

void describe(OptionVisitor& v, KneeScene& o) {
  v.value("character", o.character, {.doc = "character"});
  v.value("skeleton", o.skeleton, {.doc = "skeleton"});
  v.group("motion", {.doc = "motion"}, [&] {
    v.value("joint", o.motion.joint, {.doc = "joint"});
    v.value("axis", o.motion.axis, {.doc = "axis"});
    v.value("from_deg", o.motion.from_deg, {.doc = "first", .unit = "deg"});
    v.value("to_deg", o.motion.to_deg, {.doc = "last", .unit = "deg"});
    v.value("frames", o.motion.frames, {.doc = "frames", .min = 1});
  });
}

struct NoKneeOptions {};

void describe(OptionVisitor&, NoKneeOptions&) {}

struct ImplicitLike {
  std::string blend;
  double step = 0.2, stop_angle_deg = 45;
};

void describe(OptionVisitor& v, ImplicitLike& o) {
  v.value("blend", o.blend, {.doc = "operator"});
  v.value("step", o.step, {.doc = "step"});
  v.value("stop_angle_deg", o.stop_angle_deg, {.doc = "angle", .unit = "deg"});
}

Topic knee_topic() {
  Topic topic;
  topic.name = "skinning";
  topic.default_scene = [] { return std::make_unique<TypedOptions<KneeScene>>(); };
  MethodEntry baseline{"dual-quaternion", true, "", "", {}, {}},
      implicit{"implicit", false, "", "", {}, {}};
  baseline.default_options = [] { return std::make_unique<TypedOptions<NoKneeOptions>>(); };
  implicit.default_options = [] { return std::make_unique<TypedOptions<ImplicitLike>>(); };
  topic.methods = {baseline, implicit};
  topic.metrics.emplace_back().rows.emplace_back().name = "overlap_volume";
  return topic;
}

constexpr const char* kKnee = R"(
title  = "Knee flexion: linear blend, dual quaternion, delta mush and implicit skinning"
figure = "3.2"                 # of the thesis; empty for a study of our own
topic  = "skinning"
seed   = 1
[scene]                        # typed by the topic; inputs may be any file the topic reads
character = "human"
skeleton  = "human.skeleton.toml"
motion    = { joint = "knee-left", axis = "flexion", from_deg = 0, to_deg = 120, frames = 25 }
[[variant]]
name = "dual-quaternion"
method = "dual-quaternion"
role = "baseline"
[[variant]]
name = "implicit"
method = "implicit"
options = { blend = "gradient-controlled", step = 0.35, stop_angle_deg = 55 }
[[claim]]                      # a statement that the runner can decide
text   = "implicit skinning removes the self-contact that dual quaternions leave"
metric = "overlap_volume"
variant = "implicit"
of     = "dual-quaternion"
at     = { angle_deg = 90 }    # or reduce = "max" | "median" over the frames
is     = "<="
factor = 0.2
[[sweep]]                      # each makes further cases; grid = true for the product with other sweeps
key    = "variant.implicit.options.stop_angle_deg"     # any dotted key
values = [26, 55, 80]
[timing]
repetitions = 5                # processes: whole runs, default 1, and labelled so
[quick]                        # what tests and --quick override (coarser, fewer frames)
"scene.motion.frames" = 4
[figure_view]                  # camera, colour map, which frame: how the picture is drawn
)";

TEST_F(SpecExample, TheDocumentedExampleLoads) {
  const auto file = home_.write("experiments/skinning/knee.toml", kKnee);
  const Experiment e = load_experiment(file, {knee_topic()}, {});
  EXPECT_EQ(e.id, "skinning/knee");
  EXPECT_EQ(e.figure, "3.2");
  EXPECT_THAT(case_names(e), ElementsAre("default", "stop_angle_deg=26", "stop_angle_deg=55",
                                         "stop_angle_deg=80"));
  ASSERT_EQ(e.claims.size(), 1U);
  EXPECT_EQ(e.claims[0].at_parameter, 90);
  EXPECT_EQ(e.claims[0].at_key, "angle_deg");
  EXPECT_EQ(e.claims[0].factor, 0.2);
  EXPECT_EQ(e.timing_repetitions, 5);
  EXPECT_EQ(options(e, 3, 1)["stop_angle_deg"], 80);
  const Experiment quick = load_experiment(file, {knee_topic()}, sized(true));
  EXPECT_EQ(json::parse(quick.cases[0].scene_json)["motion"]["frames"], 4);
}

}  // namespace
}  // namespace geoprior::test
