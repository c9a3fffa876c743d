#include "models/paper/sheet/process.h"

#include <cstdint>
#include <utility>

#include "core/error.h"
#include "core/frame_loop.h"
#include "models/paper/contact/obstacle_shape.h"
#include "models/paper/sheet/handle_speed.h"
#include "models/paper/sheet/valid.h"

namespace geoprior::paper {
namespace {

/// Sums over the substeps of a frame.
struct FrameReport {
  int substeps = 0;
  int newton_iterations = 0;
  int halvings = 0;
  std::vector<Eigen::Vector3d> handle_force;  ///< mean (N)
};

void add(FrameReport& frame, const StepReport& step, int substeps) {
  ++frame.substeps;
  frame.newton_iterations += step.newton_iterations;
  frame.halvings += step.halvings;
  frame.handle_force.resize(step.handle_force.size(), Eigen::Vector3d::Zero());
  for (std::size_t h = 0; h < step.handle_force.size(); ++h) {
    frame.handle_force[h] += step.handle_force[h] / substeps;
  }
}

Part surface_part(const ShellState& state) {
  Part part;
  part.points = state.x;
  part.triangles = state.mesh.triangles;
  using On = NamedArray::On;
  part.arrays.push_back({"pattern", "m", On::points, state.mesh.pattern});
  part.arrays.push_back({"velocity", "m/s", On::points, state.v});
  part.arrays.push_back({"plastic_curvature", "1/m", On::cells, state.plastic_curvature});
  part.arrays.push_back({"damage", "1", On::cells, state.damage});
  return part;
}

/// The points held, each with an equal share of its handle's force.
Part handles_part(const ShellState& state, const std::vector<ShellStepper::Held>& held,
                  const FrameReport& report) {
  std::vector<int> count(report.handle_force.size(), 0);
  for (const auto& h : held) {
    if (h.handle < std::ssize(count)) ++count[h.handle];
  }
  Part part;
  part.kind = Part::Kind::points;
  const Eigen::Index rows = held.size();
  part.points.resize(rows, 3);
  Eigen::MatrixXd handle(rows, 1), force = Eigen::MatrixXd::Zero(rows, 3);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto& h = held[i];
    const std::size_t k = h.handle;
    part.points.row(i) = state.x.row(h.vertex);
    handle(i, 0) = h.handle;
    if (k < count.size()) force.row(i) = report.handle_force[k].transpose() / count[k];
  }
  part.arrays.push_back({"handle", "1", NamedArray::On::points, handle});
  part.arrays.push_back({"force", "N", NamedArray::On::points, force});
  return part;
}

void save(const ShellState& s, StateWriter& out) {
  out.matrix(s.mesh.pattern);
  out.matrix(s.mesh.triangles);
  out.items(s.mesh.rulings);
  out.matrix(s.x);
  out.matrix(s.v);
  out.matrix(s.plastic_curvature);
  out.matrix(s.damage);
  out.number(s.time);
}

void load(ShellState& s, StateReader& in) {
  in.matrix(s.mesh.pattern);
  in.matrix(s.mesh.triangles);
  in.items(s.mesh.rulings);
  in.matrix(s.x);
  in.matrix(s.v);
  in.matrix(s.plastic_curvature);
  in.matrix(s.damage);
  s.time = in.number<double>();
}

class SheetFrames final : public FrameModel {
 public:
  SheetFrames(const Sheet& sheet, const StepperOptions& options, SheetMesher& mesher,
              std::uint64_t seed)
      : sheet_(sheet), mesher_(mesher), stepper_(sheet, options, seed) {}

  [[nodiscard]] int frame_count() const override { return sheet_.frame_count(); }

  void start(RunContext& context) override { state_ = mesher_.start(sheet_, context); }

  void begin(FrameSink& /*sink*/, RunContext& /*context*/) override { stepper_.set_mesh(state_); }

  /// Substeps, then the mesher's turn.
  void advance(int frame, FrameSink& /*sink*/, RunContext& context) override {
    const double start = sheet_.frame_time(frame - 1);
    const int substeps = substeps_of_frame(sheet_, start, sheet_.frame_time(frame));
    const double dt = (sheet_.frame_time(frame) - start) / substeps;
    report_ = {};
    {
      const Phase phase(context, "elastic");
      for (int i = 0; i < substeps; ++i) {
        // Times are not summed up, so that a resumed run has the same ones.
        state_.time = start + i * dt;
        const StepReport step = stepper_.step(state_, dt, context);
        handle_work_ += step.handle_work;
        add(report_, step, substeps);
        mesher_.stepped(sheet_, stepper_, state_, context);
      }
      state_.time = sheet_.frame_time(frame);
    }
    const double energy = stepper_.energies(state_).strain();
    if (!mesher_.adapt(sheet_, stepper_, state_, context)) return;
    analyse(context);
    const bool stays =
        mesher_.settle(sheet_, stepper_, state_, context) && goes_on(energy, dt, context);
    if (!stays && mesher_.take_back(sheet_, state_, context)) analyse(context);
  }

  void record(int number, FrameSink& sink, RunContext& /*context*/) override {
    Frame frame;
    frame.parameter = sheet_.frame_time(number);
    frame.parts["surface"] = surface_part(state_);
    frame.parts["handles"] = handles_part(state_, stepper_.held(state_.time), report_);
    if (std::optional<Part> shown = obstacle_part(sheet_, frame.parameter)) {
      frame.parts["obstacles"] = std::move(*shown);
    }
    frame.diagnostics["triangles"] = state_.mesh.triangle_count();
    frame.diagnostics["vertices"] = state_.mesh.vertex_count();
    frame.diagnostics["substeps"] = report_.substeps;
    frame.diagnostics["newton_iterations"] = report_.newton_iterations;
    frame.diagnostics["halvings"] = report_.halvings;
    frame.diagnostics["factor_nonzeros"] = static_cast<double>(stepper_.factor_nonzeros());
    frame.diagnostics["handle_work"] = handle_work_;
    mesher_.annotate(state_, frame);
    sink.frame(std::move(frame));
  }

  void save(StateWriter& out) const override {
    out.number(handle_work_);
    paper::save(state_, out);
    mesher_.save(out);
  }

  void load(StateReader& in, int /*next_frame*/) override {
    handle_work_ = in.number<double>();
    paper::load(state_, in);
    mesher_.load(sheet_, in);
  }

 private:
  void analyse(RunContext& context) {
    const Phase phase(context, "connectivity");
    stepper_.set_mesh(state_);
  }

  /// Whether the sheet can take a step from its new mesh. Where that folds slivers over, no step
  /// converges; such a mesh has far more energy than the one before, and only then is it tried.
  bool goes_on(double energy_before, double dt, RunContext& context) {
    constexpr double kSpike = 2;
    if (stepper_.energies(state_).strain() <= kSpike * energy_before) return true;
    ShellState next = state_;
    try {
      stepper_.step(next, dt, context);
    } catch (const Error&) {
      return false;
    }
    return true;
  }

  const Sheet& sheet_;
  SheetMesher& mesher_;
  ShellStepper stepper_;
  ShellState state_;
  double handle_work_ = 0;  ///< since the start (J)
  FrameReport report_;      ///< of the last `advance`
};

}  // namespace

SheetProcess::SheetProcess(const Sheet& sheet, const StepperOptions& options,
                           std::unique_ptr<SheetMesher> mesher)
    : sheet_(sheet), options_(options), mesher_(std::move(mesher)) {
  require_valid(sheet_, "sheet");
}

void SheetProcess::run(FrameSink& sink, RunContext& context,
                       const std::optional<State>& resume_from) {
  SheetFrames frames(sheet_, options_, *mesher_, context.seed());
  run_frames(frames, sink, context, resume_from);
}

}  // namespace geoprior::paper
