#include <cmath>
#include <cstring>

#include "baselines/fluid/ocean.h"
#include "core/error.h"

namespace geoprior {
namespace {

/// Frames at 0, interval, …, the last not after the duration (but for round-off).
int frame_count(const OceanOptions& options) {
  constexpr double kRoundOff = 1e-9;
  return static_cast<int>(std::floor(options.duration / options.frame_interval + kRoundOff)) + 1;
}

double significant_height(const Eigen::VectorXd& heights) {
  const double mean = heights.mean();
  return 4 * std::sqrt((heights.array() - mean).square().mean());
}

double folded_triangles(const TriMesh& mesh) {
  int folded = 0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Eigen::RowVector3d a = mesh.V.row(mesh.F(t, 0));
    const Eigen::RowVector3d u = mesh.V.row(mesh.F(t, 1)) - a, v = mesh.V.row(mesh.F(t, 2)) - a;
    if (!(u.x() * v.y() - u.y() * v.x() > 0)) ++folded;
  }
  return folded;
}

class OceanProcess final : public Process {
 public:
  explicit OceanProcess(const OceanOptions& options) : options_(options) {
    require_valid(options_, "ocean");
  }

  void run(FrameSink& sink, RunContext& context, const std::optional<State>& resume) override {
    const Ocean ocean(options_, context.seed());
    const int count = frame_count(options_);
    for (int i = resume ? frame_in(*resume) : 0; i < count; ++i) {
      if (context.stop_requested()) return;
      sink.frame(frame(ocean, i * options_.frame_interval, context));
      context.progress(static_cast<double>(i + 1) / count);
      sink.checkpoint(state_of(i + 1));
    }
  }

 private:
  static State state_of(int next_frame) {
    State state(sizeof next_frame);
    std::memcpy(state.data(), &next_frame, sizeof next_frame);
    return state;
  }

  static int frame_in(const State& state) {
    int next_frame = 0;
    if (state.size() != sizeof next_frame) throw Error("is no state of an ocean", "checkpoint");
    std::memcpy(&next_frame, state.data(), sizeof next_frame);
    return next_frame;
  }

  static Frame frame(const Ocean& ocean, double time, RunContext& context) {
    Frame frame;
    frame.parameter = time;
    Eigen::MatrixX3d velocity;
    TriMesh mesh;
    {
      const Phase phase(context, "synthesis");
      mesh = ocean.surface(time, &velocity);
      frame.diagnostics["significant_height"] = significant_height(ocean.heights(time));
    }
    frame.diagnostics["folded_triangles"] = folded_triangles(mesh);
    Part& part = frame.parts["surface"];
    part.points = std::move(mesh.V);
    part.triangles = std::move(mesh.F);
    part.arrays.push_back({"velocity", "m/s", NamedArray::On::points, std::move(velocity)});
    return frame;
  }

  OceanOptions options_;
};

}  // namespace

std::unique_ptr<Process> make_ocean(const OceanOptions& options) {
  return std::make_unique<OceanProcess>(options);
}

}  // namespace geoprior
