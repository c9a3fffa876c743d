#include "baselines/fluid/liquid/process.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "baselines/fluid/liquid/particles/transfer.h"
#include "baselines/fluid/liquid/parts.h"
#include "core/error.h"
#include "core/frame_loop.h"

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

class LiquidFrames final : public FrameModel {
 public:
  LiquidFrames(const Tank& tank, const LiquidOptions& options, std::uint64_t seed)
      : tank_(tank), options_(options), liquid_(tank, options, seed) {}

  [[nodiscard]] int frame_count() const override { return tank_.frame_count(); }

  void advance(int frame, FrameSink& /*sink*/, RunContext& context) override {
    const double end = tank_.frame_time(frame);
    report_ = {};
    for (;;) {
      const double rest = end - liquid_.time();
      const LiquidStepReport step = liquid_.step(rest, context);
      add(report_, step, tank_.cell);
      if (step.dt >= rest) return;
      if (report_.substeps >= options_.max_substeps) {
        throw Error("frame " + std::to_string(frame) + " needs more than " +
                        std::to_string(options_.max_substeps) +
                        " substeps: " + std::to_string(step.max_speed) + " m/s at " +
                        std::to_string(liquid_.time()) + " s",
                    "liquid", "larger max_substeps or cfl, slower liquid, solids and sources");
      }
    }
  }

  void record(int number, FrameSink& sink, RunContext& context) override {
    Frame frame;
    frame.parameter = tank_.frame_time(number);
    auto& d = frame.diagnostics;
    {
      const Phase phase(context, "surface");
      Part part;
      Eigen::MatrixX3d velocity;
      TriMesh mesh = liquid_.surface(&velocity);
      d["surface_volume"] = signed_volume(mesh.V, mesh.F);
      part.points = std::move(mesh.V);
      part.triangles = std::move(mesh.F);
      part.arrays.push_back({"velocity", "m/s", NamedArray::On::points, std::move(velocity)});
      frame.parts["surface"] = std::move(part);
    }
    if (!tank_.solids.empty()) frame.parts["solids"] = solids_part(tank_, liquid_.solids());
    if (options_.record_particles && number % options_.record_particles_every == 0)
      frame.parts["particles"] = particles_part(tank_, liquid_.particles());
    measure_particles(tank_, options_.particles_per_cell, liquid_.shape(), liquid_.particles(), d);
    d["substeps"] = report_.substeps;
    d["cfl"] = report_.cfl;
    d["pressure_iterations"] = report_.iterations;
    d["pressure_converged"] = report_.converged ? 1 : 0;
    d["max_divergence"] = report_.max_divergence;
    if (number > 0) d["liquid_volume"] = report_.liquid_volume;
    sink.frame(std::move(frame));
  }

  void save(StateWriter& out) const override { out.bytes(liquid_.save()); }
  void load(StateReader& in, int /*next_frame*/) override { liquid_.load(in.bytes()); }

 private:
  const Tank& tank_;
  const LiquidOptions& options_;
  Liquid liquid_;
  FrameReport report_;  ///< of the last `advance`
};

}  // namespace

std::unique_ptr<Process> make_liquid(const Tank& tank, const LiquidOptions& options) {
  require_valid(tank, options.particles_per_cell, std::numeric_limits<double>::infinity(), "tank");
  return frame_process([tank, options](RunContext& context) {
    return std::make_unique<LiquidFrames>(tank, options, context.seed());
  });
}

}  // namespace geoprior::fluid
