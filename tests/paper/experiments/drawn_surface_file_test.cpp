// What a run records of what it shows.

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "experiments/paper/scene/drawn_surface.h"
#include "experiments/paper/topic.h"
#include "testbed/runner/execute.h"
#include "testbed/runner/judgement/measured_run.h"
#include "testbed/runner/opened_run.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::paper {
namespace {

using namespace test;

/// A strip of paper whose ends approach, as each method has it.
const std::string kBent = R"(title = "Bent"
topic = "paper"
[scene]
pattern        = { kind = "rectangle", width = 0.1, height = 0.04 }
gravity        = [0, 0, 0]
duration       = 0.2
frame_interval = 0.1
substeps       = 4
handle_step    = 1e-3
handles        = [
  { segment = [-0.05, -0.02, -0.05, 0.02], keys = [{ t = 0 }, { t = 0.2, move = [0.015, 0, 0] }] },
  { segment = [0.05, -0.02, 0.05, 0.02], keys = [{ t = 0 }, { t = 0.2, move = [-0.015, 0, 0] }] },
]
[[variant]]
name = "dense"
method = "dense"
options = { triangles = 100 }
[[variant]]
name = "adaptive"
method = "adaptive"
[[variant]]
name = "hybrid"
method = "hybrid"
)";

class DrawnSurfaceInAFile : public RunTest {
 protected:
  void SetUp() override {
    RunTest::SetUp();
    ExecuteRequest request;
    request.out = folder() / "run";
    request.timing = false;
    request.only_declared = true;
    execute(load_experiment(write_experiment("paper/bent", kBent), topics_, {}), topics_, request);
  }

  /// The topic, with a metric that remembers the parts it is shown.
  [[nodiscard]] Topic observed_topic() {
    Topic topic = make_topic();
    const auto see = [this](const Frame& frame) {
      for (const auto& [name, part] : frame.parts) seen_.insert(name);
    };
    MetricGroup of_frame;
    of_frame.rows = {{.name = "seen", .unit = "1", .definition = "nothing", .tolerance = {}}};
    of_frame.of_frame = [see](const Scene&, const Frame& frame, const Frame*) {
      see(frame);
      return MetricValues{0};
    };
    MetricGroup of_sequence;
    of_sequence.rows = {
        {.name = "seen_in_all", .unit = "1", .definition = "nothing", .tolerance = {}}};
    of_sequence.of_sequence = [see](const Scene&, const FrameSequence& frames) {
      for (std::size_t i = 0; i < frames.size(); ++i) see(*frames.frame(i));
      return MetricValues{0};
    };
    topic.metrics.push_back(of_frame);
    topic.metrics.push_back(of_sequence);
    return topic;
  }

  std::set<std::string> seen_;
  const std::vector<Topic> topics_{observed_topic()};
};

Part part_of(const OpenedRun& run, const FrameRecord& frame, const std::string& name) {
  for (const StoredFile& file : frame.files) {
    if (file.name.find("/" + name + "_") != std::string::npos) return run.part(file);
  }
  ADD_FAILURE() << "no part " << name;
  return {};
}

TEST_F(DrawnSurfaceInAFile, IsRecordedBesideTheMeshOfEveryMethod) {
  const OpenedRun run(folder() / "run");
  ASSERT_EQ(run.record().cases.at(0).variants.size(), 3U);
  for (const VariantRecord& variant : run.record().cases[0].variants) {
    ASSERT_EQ(variant.frames.size(), 3U) << variant.name;
    const std::vector<double>& distances = variant.diagnostics.at("drawn_distance").values;
    for (std::size_t i = 0; i < variant.frames.size(); ++i) {
      const FrameRecord& frame = variant.frames[i];
      const double distance = distances.at(i);
      EXPECT_LE(distance, DrawnSurface::kFarthest) << variant.name;
      // It is what the recorded mesh says: nothing of the method's own memory is in it.
      Frame again;
      again.parts["surface"] = part_of(run, frame, "surface");
      if (variant.name == "hybrid") again.parts["rulings"] = part_of(run, frame, "rulings");
      add_drawn_surface(again);
      EXPECT_EQ(part_of(run, frame, "drawn").points, again.parts["drawn"].points) << variant.name;
      EXPECT_EQ(again.diagnostics.at("drawn_distance"), distance) << variant.name;
    }
    EXPECT_GT(distances.back(), 1e-6) << variant.name;
    const Part drawn = part_of(run, variant.frames.back(), "drawn");
    EXPECT_EQ(drawn.find_array("kind") != nullptr, variant.name == "hybrid");
  }
}

TEST_F(DrawnSurfaceInAFile, NothingThatIsMeasuredSeesIt) {
  EXPECT_TRUE(seen_.contains("surface"));
  EXPECT_FALSE(seen_.contains("drawn")) << "while it runs";
  seen_.clear();
  measure_again(OpenedRun(folder() / "run"), topics_);
  EXPECT_TRUE(seen_.contains("surface"));
  EXPECT_FALSE(seen_.contains("drawn")) << "read from its files";
}

}  // namespace
}  // namespace geoprior::paper
