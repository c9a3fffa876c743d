#include "baselines/fluid/liquid_process.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "baselines/fluid/liquid_parts.h"
#include "core/error.h"
#include "core/state_bytes.h"
#include "models/fluid/transfer.h"

namespace geoprior::fluid {
namespace {

/// What the substeps of a frame left.
struct FrameReport {
  int substeps = 0;
  int iterations = 0;
  double max_divergence = 0;
  double cfl = 0;
  double liquid_volume = 0;
  bool converged = true;
};

void add(FrameReport& frame, const LiquidStepReport& step, double cell) {
  ++frame.substeps;
  frame.iterations += step.pressure.iterations;
  frame.max_divergence = std::max(frame.max_divergence, step.pressure.max_divergence);
  frame.cfl = std::max(frame.cfl, step.max_speed * step.dt / cell);
  frame.liquid_volume = step.liquid_volume;
  frame.converged = frame.converged && step.pressure.converged;
}

/// Energy and momentum of the particles, each with an equal share of a full cell's mass.
void measure_particles(const Tank& tank, int per_cell, const GridShape& shape,
                       const LiquidParticles& particles, std::map<std::string, double>& out) {
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  double potential = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Eigen::Vector3d v = particles.velocity[p].cast<double>();
    momentum += v;
    potential -= tank.gravity.dot(tank.origin + particles.position[p].cast<double>());
  }
  const double volume = std::pow(tank.cell, 3) / per_cell, mass = tank.density * volume;
  out["particles"] = static_cast<double>(particles.size());
  out["particle_volume"] = volume * static_cast<double>(particles.size());
  out["kinetic_energy"] = mass * kinetic_energy(shape, particles);
  out["potential_energy"] = mass * potential;
  out["momentum_x"] = mass * momentum.x();
  out["momentum_y"] = mass * momentum.y();
  out["momentum_z"] = mass * momentum.z();
}

class LiquidProcess final : public Process {
 public:
  LiquidProcess(const Tank& tank, const LiquidOptions& options) : tank_(tank), options_(options) {
    require_valid(tank_, options_.particles_per_cell, std::numeric_limits<double>::infinity(),
                  "tank");
  }

  void run(FrameSink& sink, RunContext& context, const std::optional<State>& resume_from) override {
    Liquid liquid(tank_, options_, context.seed());
    int frame = 0;
    if (resume_from) {
      StateReader in(*resume_from);
      frame = in.number<int>();
      liquid.load(in.bytes());
    }
    const int count = tank_.frame_count();
    for (; frame < count; ++frame) {
      if (context.stop_requested()) return;
      FrameReport report;
      if (frame > 0) report = advance(liquid, frame, context);
      sink.frame(make_frame(liquid, frame, report, context));
      context.progress(static_cast<double>(frame + 1) / count);
      StateWriter out;
      out.number(frame + 1);
      out.bytes(liquid.save());
      sink.checkpoint(out.take());
    }
  }

 private:
  FrameReport advance(Liquid& liquid, int frame, RunContext& context) const {
    const double end = tank_.frame_time(frame);
    FrameReport report;
    for (;;) {
      const double rest = end - liquid.time();
      const LiquidStepReport step = liquid.step(rest, context);
      add(report, step, tank_.cell);
      if (step.dt >= rest) return report;
      if (report.substeps >= options_.max_substeps) {
        throw Error("frame " + std::to_string(frame) + " needs more than " +
                        std::to_string(options_.max_substeps) +
                        " substeps: " + std::to_string(step.max_speed) + " m/s at " +
                        std::to_string(liquid.time()) + " s",
                    "liquid", "larger max_substeps or cfl, slower liquid, solids and sources");
      }
    }
  }

  Frame make_frame(const Liquid& liquid, int number, const FrameReport& report,
                   RunContext& context) const {
    Frame frame;
    frame.parameter = tank_.frame_time(number);
    auto& d = frame.diagnostics;
    {
      const Phase phase(context, "surface");
      Part part;
      Eigen::MatrixX3d velocity;
      TriMesh mesh = liquid.surface(&velocity);
      d["surface_volume"] = signed_volume(mesh.V, mesh.F);
      part.points = std::move(mesh.V);
      part.triangles = std::move(mesh.F);
      part.arrays.push_back({"velocity", "m/s", NamedArray::On::points, std::move(velocity)});
      frame.parts["surface"] = std::move(part);
    }
    if (!tank_.solids.empty()) frame.parts["solids"] = solids_part(tank_, liquid.solids());
    if (options_.record_particles)
      frame.parts["particles"] = particles_part(tank_, liquid.particles());
    measure_particles(tank_, options_.particles_per_cell, liquid.shape(), liquid.particles(), d);
    d["substeps"] = report.substeps;
    d["cfl"] = report.cfl;
    d["pressure_iterations"] = report.iterations;
    d["pressure_converged"] = report.converged ? 1 : 0;
    d["max_divergence"] = report.max_divergence;
    if (number > 0) d["liquid_volume"] = report.liquid_volume;
    return frame;
  }

  Tank tank_;
  LiquidOptions options_;
};

}  // namespace

std::unique_ptr<Process> make_liquid(const Tank& tank, const LiquidOptions& options) {
  return std::make_unique<LiquidProcess>(tank, options);
}

}  // namespace geoprior::fluid
