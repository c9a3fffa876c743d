#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "metrics/spacing/detail_spacing.h"
#include "models/details/process.h"
#include "tests/details/detail_scenes.h"

namespace geoprior::details::detail_scenes {

/// Steps the method through the motion of the scene.
inline void run_through(DetailMethod& method, const DetailScene& s) {
  RunContext context;
  for (int frame = 1; frame < s.motion->frame_count(); ++frame)
    method.step(s.motion->positions(frame), context);
}

/// M_d is a manifold, Delaunay, and has the topology of the surface.
inline void expect_sound(const DetailMesh& d) {
  const TriangulationReport report = d.mesh.check();
  EXPECT_TRUE(report.manifold());
  EXPECT_EQ(report.not_delaunay, 0) << report.worst_angle_sum;
  EXPECT_EQ(report.euler, d.surface->euler);
}

inline double diagnostic(const DetailMethod& method, const char* name) {
  std::map<std::string, double> all;
  method.diagnose(all);
  return all.at(name);
}

/// Spacing in one part of a recorded frame: "detail_mesh" or "visible_mesh".
inline DetailSpacing spacing_in(const Frame& frame, const char* name) {
  const Part& part = frame.require_part(name);
  std::vector<char> ghosts;
  for (const double ghost : part.require_array("ghost", NamedArray::On::points, 1).values.col(0))
    ghosts.push_back(ghost > 0.5 ? 1 : 0);
  return detail_spacing(part.points, part.triangles, ghosts);
}

/// Largest relative change of the mean edge over the motion, signed.
struct SpacingOverMotion {
  double all = 0;      ///< in M_d
  double visible = 0;  ///< among details of weight above 1/2
};

inline SpacingOverMotion spacing_over_motion(DetailMethod& method, const DetailScene& s) {
  std::vector<DetailSpacing> all, visible;
  RunContext context;
  for (int frame = 0; frame < s.motion->frame_count(); ++frame) {
    if (frame > 0) method.step(s.motion->positions(frame), context);
    const Frame recorded = detail_frame(method.details(), frame);
    all.push_back(spacing_in(recorded, "detail_mesh"));
    visible.push_back(spacing_in(recorded, "visible_mesh"));
  }
  return {worst_mean_change(all).change, worst_mean_change(visible).change};
}

using MakeMethod = std::function<std::unique_ptr<DetailMethod>()>;

/// 1 and 2 threads end in the same bytes.
inline void expect_same_bytes_for_any_thread_count(const MakeMethod& make, const DetailScene& s) {
  std::vector<State> states;
  for (const int threads : {1, 2}) {
    StateWriter out;
    with_threads(threads, [&] {
      const auto method = make();
      run_through(*method, s);
      method->save(out);
    });
    states.push_back(out.take());
  }
  EXPECT_TRUE(states[0] == states[1]);
}

struct CollectedRun final : FrameSink {
  std::vector<Frame> frames;
  std::vector<State> states;
  void frame(Frame f) override { frames.push_back(std::move(f)); }
  void event(const Event&) override {}
  void artifact(Artifact) override {}
  void checkpoint(const State& s) override { states.push_back(s); }
};

/// A run that goes on from the checkpoint after frame `stop` makes the frames of the whole run.
inline void expect_resumed_run_is_the_same(const std::function<std::unique_ptr<Process>()>& make,
                                           std::size_t stop) {
  CollectedRun whole, rest;
  RunContext context;
  make()->run(whole, context, {});
  make()->run(rest, context, whole.states[stop]);
  ASSERT_EQ(rest.frames.size(), whole.frames.size() - stop - 1);
  for (std::size_t i = 0; i < rest.frames.size(); ++i) {
    const Frame &a = whole.frames[i + stop + 1], &b = rest.frames[i];
    EXPECT_EQ(a.require_part("detail_mesh").points, b.require_part("detail_mesh").points);
    EXPECT_EQ(a.require_part("detail_mesh").triangles, b.require_part("detail_mesh").triangles);
    const auto &x = a.require_part("details").arrays, &y = b.require_part("details").arrays;
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t k = 0; k < x.size(); ++k) EXPECT_EQ(x[k].values, y[k].values) << x[k].name;
    EXPECT_EQ(a.diagnostics, b.diagnostics);
  }
}

}  // namespace geoprior::details::detail_scenes
