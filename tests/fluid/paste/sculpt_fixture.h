#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/inputs/surface_sequence.h"
#include "core/method.h"
#include "tests/core/geometry/shapes.h"
#include "tests/fluid/features/map_waves.h"

namespace geoprior::fluid::sculpt_fixture {

/// Keeps all that a process pushes.
struct Sink final : FrameSink {
  void frame(Frame f) override { frames.push_back(std::move(f)); }
  void event(const Event& e) override { events.push_back(e); }
  void artifact(Artifact a) override { artifacts.push_back(std::move(a)); }
  void checkpoint(const State& s) override { states.push_back(s); }
  std::vector<Frame> frames;
  std::vector<Event> events;
  std::vector<Artifact> artifacts;
  std::vector<State> states;
};

/// Asks to stop after some frames.
struct Stopping final : RunContext {
  explicit Stopping(const Sink& s, std::size_t n) : sink(s), frames(n) {}
  [[nodiscard]] bool stop_requested() const override { return sink.frames.size() >= frames; }
  const Sink& sink;
  std::size_t frames;
};

/// A pool that lies calm at first; then a hill stands in it that grows, and a drop above it falls.
inline std::shared_ptr<StoredSequence> splash() {
  const int n = 64;
  const TriMesh rest = waves::tank(n, 2, 1, 0.2);
  std::vector<SurfaceFrame> frames;
  for (int f = 0; f < 12; ++f) {
    SurfaceFrame frame;
    frame.time = 0.04 * f;
    frame.mesh = rest;
    const double height = f < 4 ? 0 : 0.06 + 0.01 * f;
    for (Eigen::Index v = 0; v < (n + 1) * (n + 1); ++v) {
      const double r = std::hypot(rest.V(v, 0) - 1, rest.V(v, 1) - 1) / 0.12;
      frame.mesh.V(v, 2) += height * std::exp(-0.5 * r * r);
    }
    TriMesh drop = shapes::sphere(2);
    drop.V = (0.1 * drop.V).rowwise() +
             Eigen::RowVector3d(1.5, 0.5, 1.2 - 0.5 * 9.81 * frame.time * frame.time);
    const Eigen::Index vertices = frame.mesh.V.rows(), triangles = frame.mesh.F.rows();
    frame.mesh.V.conservativeResize(vertices + drop.V.rows(), 3);
    frame.mesh.V.bottomRows(drop.V.rows()) = drop.V;
    frame.mesh.F.conservativeResize(triangles + drop.F.rows(), 3);
    frame.mesh.F.bottomRows(drop.F.rows()) = drop.F.array() + static_cast<int>(vertices);
    frames.push_back(std::move(frame));
  }
  return std::make_shared<StoredSequence>(std::move(frames), "splash");
}

}  // namespace geoprior::fluid::sculpt_fixture
