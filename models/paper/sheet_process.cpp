#include "models/paper/sheet_process.h"

#include <utility>

#include "core/error.h"
#include "core/state_bytes.h"
#include "models/paper/obstacle_shape.h"
#include "models/paper/sheet_valid.h"

namespace geoprior::paper {
namespace {

/// What the loop itself remembers from frame to frame.
struct Loop {
  int next_frame = 0;
  double handle_work = 0;  ///< since the start (J)
  ShellState state;
};

/// Sums over the substeps of a frame.
struct FrameReport {
  int substeps = 0;
  int newton_iterations = 0;
  int halvings = 0;
  std::vector<Eigen::Vector3d> handle_force;  ///< mean (N)
};

State save(const Loop& loop, const SheetMesher& mesher) {
  StateWriter out;
  out.number(loop.next_frame);
  out.number(loop.handle_work);
  const ShellState& s = loop.state;
  out.matrix(s.mesh.pattern);
  out.matrix(s.mesh.triangles);
  out.matrix(s.x);
  out.matrix(s.v);
  out.matrix(s.plastic_curvature);
  out.matrix(s.damage);
  out.number(s.time);
  out.bytes(mesher.save());
  return out.take();
}

Loop load(const State& bytes, SheetMesher& mesher) {
  StateReader in(bytes);
  Loop loop;
  loop.next_frame = in.number<int>();
  loop.handle_work = in.number<double>();
  ShellState& s = loop.state;
  in.matrix(s.mesh.pattern);
  in.matrix(s.mesh.triangles);
  in.matrix(s.x);
  in.matrix(s.v);
  in.matrix(s.plastic_curvature);
  in.matrix(s.damage);
  s.time = in.number<double>();
  mesher.load(in.bytes());
  return loop;
}

void add(FrameReport& frame, const StepReport& step, int substeps) {
  ++frame.substeps;
  frame.newton_iterations += step.newton_iterations;
  frame.halvings += step.halvings;
  frame.handle_force.resize(step.handle_force.size(), Eigen::Vector3d::Zero());
  for (std::size_t h = 0; h < step.handle_force.size(); ++h) {
    frame.handle_force[h] += step.handle_force[h] / substeps;
  }
}

NamedArray array(std::string name, std::string unit, NamedArray::On on, Eigen::MatrixXd values) {
  return {std::move(name), std::move(unit), on, std::move(values)};
}

Part surface_part(const ShellState& state) {
  Part part;
  part.points = state.x;
  part.triangles = state.mesh.triangles;
  using On = NamedArray::On;
  part.arrays.push_back(array("pattern", "m", On::points, state.mesh.pattern));
  part.arrays.push_back(array("velocity", "m/s", On::points, state.v));
  part.arrays.push_back(array("plastic_curvature", "1/m", On::cells, state.plastic_curvature));
  part.arrays.push_back(array("damage", "1", On::cells, state.damage));
  return part;
}

/// The points held, each with an equal share of its handle's force.
Part handles_part(const ShellState& state, const std::vector<ShellStepper::Held>& held,
                  const FrameReport& report) {
  std::vector<int> count(report.handle_force.size(), 0);
  for (const auto& h : held) {
    if (h.handle < static_cast<int>(count.size())) ++count[h.handle];
  }
  Part part;
  part.kind = Part::Kind::points;
  const auto rows = static_cast<Eigen::Index>(held.size());
  part.points.resize(rows, 3);
  Eigen::MatrixXd handle(rows, 1), force = Eigen::MatrixXd::Zero(rows, 3);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto& h = held[i];
    const auto k = static_cast<std::size_t>(h.handle);
    part.points.row(i) = state.x.row(h.vertex);
    handle(i, 0) = h.handle;
    if (k < count.size()) force.row(i) = report.handle_force[k].transpose() / count[k];
  }
  part.arrays.push_back(array("handle", "1", NamedArray::On::points, handle));
  part.arrays.push_back(array("force", "N", NamedArray::On::points, force));
  return part;
}

Frame make_frame(const Sheet& sheet, const Loop& loop, const FrameReport& report,
                 const ShellStepper& stepper) {
  Frame frame;
  frame.parameter = sheet.frame_time(loop.next_frame);
  frame.parts["surface"] = surface_part(loop.state);
  frame.parts["handles"] = handles_part(loop.state, stepper.held(loop.state.time), report);
  if (std::optional<Part> shown = obstacle_part(sheet, frame.parameter)) {
    frame.parts["obstacles"] = std::move(*shown);
  }
  frame.diagnostics["triangles"] = loop.state.mesh.triangle_count();
  frame.diagnostics["vertices"] = loop.state.mesh.vertex_count();
  frame.diagnostics["substeps"] = report.substeps;
  frame.diagnostics["newton_iterations"] = report.newton_iterations;
  frame.diagnostics["halvings"] = report.halvings;
  frame.diagnostics["factor_nonzeros"] = static_cast<double>(stepper.factor_nonzeros());
  frame.diagnostics["handle_work"] = loop.handle_work;
  return frame;
}

/// One frame: substeps, then the mesher's turn.
FrameReport advance(const Sheet& sheet, Loop& loop, ShellStepper& stepper, SheetMesher& mesher,
                    RunContext& context) {
  const double start = sheet.frame_time(loop.next_frame - 1);
  const double dt = (sheet.frame_time(loop.next_frame) - start) / sheet.substeps;
  FrameReport report;
  {
    const Phase phase(context, "elastic");
    for (int i = 0; i < sheet.substeps; ++i) {
      // Times are not summed up, so that a resumed run has the same ones.
      loop.state.time = start + i * dt;
      const StepReport step = stepper.step(loop.state, dt, context);
      loop.handle_work += step.handle_work;
      add(report, step, sheet.substeps);
    }
    loop.state.time = sheet.frame_time(loop.next_frame);
  }
  if (mesher.adapt(sheet, stepper, loop.state, context)) {
    const Phase phase(context, "connectivity");
    stepper.set_mesh(loop.state);
  }
  return report;
}

}  // namespace

SheetProcess::SheetProcess(const Sheet& sheet, const StepperOptions& options,
                           std::unique_ptr<SheetMesher> mesher)
    : sheet_(sheet), options_(options), mesher_(std::move(mesher)) {
  require_valid(sheet_, "sheet");
}

void SheetProcess::run(FrameSink& sink, RunContext& context,
                       const std::optional<State>& resume_from) {
  Loop loop;
  if (resume_from) {
    loop = load(*resume_from, *mesher_);
  } else {
    loop.state = mesher_->start(sheet_, context);
  }
  ShellStepper stepper(sheet_, options_, context.seed());
  stepper.set_mesh(loop.state);
  const int count = sheet_.frame_count();
  for (; loop.next_frame < count; ++loop.next_frame) {
    if (context.stop_requested()) return;
    FrameReport report;
    if (loop.next_frame > 0) {
      report = advance(sheet_, loop, stepper, *mesher_, context);
    }
    Frame frame = make_frame(sheet_, loop, report, stepper);
    mesher_->annotate(loop.state, frame);
    sink.frame(std::move(frame));
    context.progress(static_cast<double>(loop.next_frame + 1) / count);
    Loop next = loop;
    ++next.next_frame;
    sink.checkpoint(save(next, *mesher_));
  }
}

}  // namespace geoprior::paper
