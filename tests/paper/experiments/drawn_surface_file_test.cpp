// What a run records of what it shows.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/paper/scene/drawn_surface.h"
#include "experiments/paper/topic.h"
#include "testbed/runner/execute.h"
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

using DrawnSurfaceInAFile = RunTest;

Part part_of(const OpenedRun& run, const FrameRecord& frame, const std::string& name) {
  for (const StoredFile& file : frame.files) {
    if (file.name.find("/" + name + "_") != std::string::npos) return run.part(file);
  }
  ADD_FAILURE() << "no part " << name;
  return {};
}

TEST_F(DrawnSurfaceInAFile, IsRecordedBesideTheMeshOfEveryMethod) {
  const std::vector<Topic> topics{make_topic()};
  ExecuteRequest request;
  request.out = folder() / "run";
  request.timing = false;
  request.only_declared = true;
  execute(load_experiment(write_experiment("paper/bent", kBent), topics, {}), topics, request);
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

}  // namespace
}  // namespace geoprior::paper
