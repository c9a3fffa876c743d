#include "models/details/process.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "solvers/details/self_replicating.h"
#include "tests/details/detail_scenes.h"

namespace geoprior::details {
namespace {

using namespace detail_scenes;

struct Collector final : FrameSink {
  std::vector<Frame> frames;
  std::vector<State> states;
  void frame(Frame f) override { frames.push_back(std::move(f)); }
  void event(const Event&) override {}
  void artifact(Artifact) override {}
  void checkpoint(const State& s) override { states.push_back(s); }
};

const NamedArray& array(const Part& part, const std::string& name) {
  return part.require_array(name, NamedArray::On::points);
}

DetailScene stretched_square(int frames) {
  const TriMesh mesh = shapes::square(16);
  return scene(mesh, even_details(mesh, 150, 1), stretch(mesh, frames, 2));
}

TEST(DetailProcess, FramesHoldWhatMetricsRead) {
  const DetailScene s = stretched_square(20);
  Collector sink;
  RunContext context;
  make_self_replicating_process(s, {})->run(sink, context, {});
  ASSERT_EQ(sink.frames.size(), 21u);
  for (const Frame& f : sink.frames) {
    const Part& details = f.require_part("details");
    const Part& mesh = f.require_part("detail_mesh");
    const Eigen::Index n = details.points.rows();
    EXPECT_EQ(f.diagnostics.at("details"), static_cast<double>(n));
    EXPECT_EQ(mesh.points.topRows(n), details.points);
    EXPECT_EQ(array(mesh, "ghost").values.sum(), static_cast<double>(mesh.points.rows() - n));
    // The anchor gives the point.
    const Part& surface = f.require_part("surface");
    for (Eigen::Index i = 0; i < n; ++i) {
      const SurfacePoint at{static_cast<int>(array(details, "face").values(i, 0)),
                            array(details, "barycentric").values.row(i).transpose()};
      const Eigen::Vector3d p = position_of(at, surface.points, surface.triangles);
      EXPECT_LT((p - details.points.row(i).transpose()).norm(), 1e-12);
    }
  }
  EXPECT_EQ(sink.frames[0].diagnostics.at("details"), 150);
  EXPECT_GT(sink.frames[20].diagnostics.at("details"), 280);
  EXPECT_GT(sink.frames[0].diagnostics.at("triplets"), 0);
}

TEST(DetailProcess, AResumedRunMakesTheSameFrames) {
  const DetailScene s = stretched_square(20);
  for (const bool histogram : {false, true}) {
    SelfReplicatingOptions options;
    options.copies.histogram = histogram;
    Collector whole, rest;
    RunContext context;
    make_self_replicating_process(s, options)->run(whole, context, {});
    make_self_replicating_process(s, options)->run(rest, context, whole.states[9]);
    ASSERT_EQ(rest.frames.size(), 11u);
    for (std::size_t i = 0; i < rest.frames.size(); ++i) {
      const Frame &a = whole.frames[i + 10], &b = rest.frames[i];
      EXPECT_EQ(a.parameter, b.parameter);
      EXPECT_EQ(a.require_part("detail_mesh").points, b.require_part("detail_mesh").points);
      EXPECT_EQ(a.require_part("detail_mesh").triangles, b.require_part("detail_mesh").triangles);
      EXPECT_EQ(array(a.require_part("details"), "weight").values,
                array(b.require_part("details"), "weight").values);
      EXPECT_EQ(a.diagnostics, b.diagnostics);
    }
  }
}

TEST(DetailProcess, FramesBeforeABadOneStay) {
  DetailScene s = stretched_square(4);
  std::vector<Eigen::MatrixX3d> positions;
  for (int i = 0; i < 4; ++i) positions.push_back(s.motion->positions(i));
  positions[3].row(100).swap(positions[3].row(101));
  s.motion = std::make_shared<StoredMotion>(positions, std::vector<double>{0, 1, 2, 3});
  Collector sink;
  RunContext context;
  try {
    make_self_replicating_process(s, {})->run(sink, context, {});
    FAIL() << "no Error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("scene, frame 3: triangle"), std::string::npos)
        << error.what();
  }
  EXPECT_EQ(sink.frames.size(), 3u);
}

}  // namespace
}  // namespace geoprior::details
