#include <cstring>

#include "baselines/fluid/ocean.h"
#include "core/error.h"

namespace geoprior {
namespace {

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
  OceanProcess(const OceanOptions& options, std::vector<double> times)
      : options_(options), times_(std::move(times)) {
    require_valid(options_, "ocean");
  }

  void run(FrameSink& sink, RunContext& context, const std::optional<State>& resume) override {
    const Ocean ocean(options_, context.seed());
    const int count = static_cast<int>(times_.size());
    for (int i = resume ? frame_in(*resume) : 0; i < count; ++i) {
      if (context.stop_requested()) return;
      sink.frame(frame(ocean, times_[static_cast<std::size_t>(i)], context));
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

  [[nodiscard]] Frame frame(const Ocean& ocean, double time, RunContext& context) const {
    Frame frame;
    frame.parameter = time;
    Eigen::MatrixX3d velocity;
    TriMesh mesh;
    {
      const Phase phase(context, "synthesis");
      mesh = ocean.surface(time, &velocity);
      frame.parts["samples"] = samples(ocean, time);
    }
    frame.diagnostics["folded_triangles"] = folded_triangles(mesh);
    Part& part = frame.parts["surface"];
    part.points = std::move(mesh.V);
    part.triangles = std::move(mesh.F);
    part.arrays.push_back({"velocity", "m/s", NamedArray::On::points, std::move(velocity)});
    frame.tables["sea"] = sea(ocean);
    return frame;
  }

  [[nodiscard]] Part samples(const Ocean& ocean, double time) const {
    const double spacing = options_.size / options_.samples;
    Part grid;
    grid.kind = Part::Kind::grid;
    grid.grid_size = {options_.samples, options_.samples, 1};
    grid.grid_origin = {0, 0, options_.mean_level};
    grid.grid_spacing = {spacing, spacing, 1};
    grid.arrays.push_back({"height", "m", NamedArray::On::points, ocean.heights(time)});
    grid.arrays.push_back({"rate", "m/s", NamedArray::On::points, ocean.velocities(time).col(2)});
    return grid;
  }

  [[nodiscard]] FrameTable sea(const Ocean& ocean) const {
    FrameTable table;
    table.columns = {"depth [m]", "gravity [m/s^2]", "wind_direction [deg]",
                     "expected_variance [m^2]"};
    table.rows.resize(1, 4);
    table.rows << options_.depth, options_.gravity, options_.wind_direction_deg,
        ocean.expected_variance();
    return table;
  }

  OceanOptions options_;
  std::vector<double> times_;
};

}  // namespace

std::unique_ptr<Process> make_ocean(const OceanOptions& options, std::vector<double> times) {
  return std::make_unique<OceanProcess>(options, std::move(times));
}

}  // namespace geoprior
