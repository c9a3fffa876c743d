#include "baselines/fluid/liquid/liquid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "baselines/fluid/liquid/grid/advection.h"
#include "baselines/fluid/liquid/grid/extrapolation.h"
#include "baselines/fluid/liquid/particles/reseed.h"
#include "baselines/fluid/liquid/particles/transfer.h"
#include "baselines/fluid/liquid/particles/volume_correction.h"
#include "baselines/fluid/liquid/pressure/solid_fractions.h"
#include "baselines/fluid/liquid/speed.h"
#include "baselines/fluid/liquid/surface/isosurface.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/state_bytes.h"

namespace geoprior::fluid {
namespace {

GridShape grid_of(const Tank& tank) {
  GridShape shape;
  shape.cells = tank.cells;
  shape.origin = tank.origin;
  shape.cell = tank.cell;
  return shape;
}

std::optional<OpenSide> open_side(const Tank& tank) {
  if (!tank.open_top) return std::nullopt;
  const DomainSide top = top_side(tank.gravity);
  return OpenSide{top.axis, top.upper};
}

void subtract(const ScalarGrid& a, const ScalarGrid& b, ScalarGrid& difference) {
  parallel_blocks(a.values.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) difference.values[i] = a.values[i] - b.values[i];
  });
}

const Tank& valid(const Tank& tank, const LiquidOptions& options) {
  require_valid(tank, options.particles_per_cell, std::numeric_limits<double>::infinity(), "tank");
  if (tank.cells.minCoeff() < 2) throw Error("one cell on an axis", "tank.cells", "2 or more");
  return tank;
}

}  // namespace

struct Liquid::Data {
  Tank tank;
  LiquidOptions options;
  std::uint64_t seed;
  GridShape shape;
  std::optional<OpenSide> open;
  std::vector<ShapeDistance> solid_shapes, source_shapes;
  bool solids_move = false;

  double time = 0;
  double last_dt = 0;  ///< of the step before; 0: none
  std::uint64_t steps = 0;
  std::int64_t balance = 0;  ///< particles that reseeding added minus those it removed
  std::int64_t removed = 0;
  LiquidParticles particles;

  CellSorter sorter;
  ParticleToGrid to_grid;
  PressureSolver solver;
  SolidSampler sampler;
  SolidFractions solids;
  SolidFractions resting;  ///< the same fractions, velocity 0: displacements do not follow solids
  ScalarGrid rest;         ///< density of full liquid beside solids
  Extrapolator extrapolator;

  MacGrid velocity;
  MacGrid before;  ///< from particles, before forces
  MacGrid change;  ///< by gravity and pressure
  MacGrid shift;   ///< displacement a second that evens the density out
  std::array<std::vector<char>, 3> touched, known, reached;
  ScalarGrid density, distance, target;
  std::vector<std::uint8_t> left;

  Data(const Tank& t, const LiquidOptions& o, std::uint64_t s)
      : tank(valid(t, o)),
        options(o),
        seed(s),
        shape(grid_of(t)),
        open(open_side(t)),
        to_grid(shape),
        solver(shape),
        sampler(tank, shape),
        velocity(shape),
        before(shape),
        change(shape),
        shift(shape) {
    for (const TankSolid& solid : tank.solids) {
      solid_shapes.emplace_back(solid.shape, tank.cell);
      solids_move = solids_move || solid.motion.has_value();
    }
    for (const LiquidSource& source : tank.sources)
      source_shapes.emplace_back(source.shape, tank.cell);
  }

  [[nodiscard]] bool affine() const { return options.transfer == TransferKind::apic; }
  [[nodiscard]] SeedRule rule() const {
    return {options.particles_per_cell, seed, steps, affine()};
  }
  [[nodiscard]] const ScalarGrid* rest_or_null() const {
    return tank.solids.empty() ? nullptr : &rest;
  }
  [[nodiscard]] const ScalarGrid* solids_or_null() const {
    return tank.solids.empty() ? nullptr : &solids.distance;
  }
  [[nodiscard]] int layers() const { return static_cast<int>(std::ceil(options.cfl)) + 2; }
  [[nodiscard]] std::vector<PlacedSolid> placed(double at, double dt) const {
    std::vector<PlacedSolid> result;
    for (std::size_t i = 0; i < solid_shapes.size(); ++i)
      result.push_back(place_solid(tank.solids[i], solid_shapes[i], at, dt));
    return result;
  }

  void place_solids(double at, double dt);
  void fill();
  void pour();
  void first_velocity();
  double step_length(double dt_max, double speed) const;
  void particles_to_grid();
  void find_liquid();
  PressureReport correct_volume(double dt);
  PressureReport project(double dt);
  void continue_velocity();
  void to_particles();
  void advect(double dt, bool corrected);
};

void Liquid::Data::place_solids(double at, double dt) {
  const bool first = solids.distance.values.empty();
  if (!first && !solids_move) return;
  sampler.sample(placed(at, dt), solids);
  if (tank.solids.empty()) return;
  rest = rest_density(solids, shape);
  resting.open = solids.open;
  resting.distance = solids.distance;
  for (std::size_t a = 0; a < 3; ++a)
    resting.velocity[a] = ScalarGrid(solids.velocity[a].size, 0.0F);
}

/// The initial volumes; where several overlap, the first one has the liquid.
void Liquid::Data::fill() {
  std::vector<ShapeDistance> bodies;
  std::vector<std::uint8_t> taken;
  for (const LiquidVolume& volume : tank.volumes) {
    bodies.emplace_back(volume.shape, tank.cell);
    const std::size_t first = particles.size();
    fill_shape(shape, bodies.back(), volume.velocity, solids_or_null(), false, rule(), particles);
    taken.assign(particles.size(), 0);
    for (std::size_t p = first; p < particles.size(); ++p) {
      const Eigen::Vector3d x = shape.origin + particles.position[p].cast<double>();
      for (std::size_t b = 0; b + 1 < bodies.size() && taken[p] == 0; ++b)
        taken[p] = bodies[b](x) < 0 ? 1 : 0;
    }
    if (bodies.size() > 1) remove_particles(taken, particles);
  }
  sorter.sort(shape, particles);
}

void Liquid::Data::pour() {
  for (std::size_t s = 0; s < tank.sources.size(); ++s) {
    const LiquidSource& source = tank.sources[s];
    if (time < source.from || time >= source.until) continue;
    set_velocity_inside(shape, source_shapes[s], source.velocity, particles);
    const std::size_t added = fill_shape(shape, source_shapes[s], source.velocity, solids_or_null(),
                                         true, rule(), particles);
    // Sorted before the next source asks which cells are empty.
    if (added > 0) sorter.sort(shape, particles);
  }
}

/// Grid velocity of particles that were just put there or loaded.
void Liquid::Data::first_velocity() {
  to_grid.gather(particles, options.particles_per_cell, velocity, touched, density);
  known = touched;
  extrapolator.extrapolate(layers(), velocity, known);
}

/// Largest step of which a whole number makes `dt_max`.
double Liquid::Data::step_length(double dt_max, double speed) const {
  const double reach = options.cfl * tank.cell, g = tank.gravity.norm();
  for (const PlacedSolid& solid : placed(time, dt_max))
    speed = std::max(speed, fastest_point(solid));
  // v dt + g dt^2 = reach, in the form that survives g = 0.
  const double root = speed + std::sqrt(speed * speed + 4 * g * reach);
  double dt = root > 0 ? 2 * reach / root : dt_max;
  for (const LiquidSource& source : tank.sources) {
    if (time + dt_max <= source.from || time >= source.until) continue;
    if (source.velocity.norm() > 0) dt = std::min(dt, tank.cell / source.velocity.norm());
  }
  return dt_max / std::max(1.0, std::ceil(dt_max / dt - 1e-9));
}

void Liquid::Data::particles_to_grid() {
  to_grid.gather(particles, options.particles_per_cell, velocity, touched, density);
  before = velocity;
}

void Liquid::Data::find_liquid() {
  liquid_distance(density, rest_or_null(), shape, distance);
  if (!tank.solids.empty()) extend_into_solids(solids, shape, distance);
}

/// Displacement per second that evens the density out, in `shift`.
PressureReport Liquid::Data::correct_volume(double dt) {
  PressureOptions loose = options.pressure;
  loose.tolerance = std::max(loose.tolerance, 0.05);
  const double strength = std::min(1.0, options.volume_rate * dt);
  density_target(density, rest_or_null(), distance, strength / dt, 0.1 / dt, target);
  for (ScalarGrid& face : shift.face) std::fill(face.values.begin(), face.values.end(), 0.0F);
  const PressureReport report = solver.project(tank.solids.empty() ? solids : resting, distance,
                                               &target, dt, tank.density, loose, shift, reached);
  extrapolator.extrapolate(2, shift, reached);
  return report;
}

/// Gravity, then the projection. Velocities live in the middle of steps (leapfrog), so that gravity
/// acts for half of the step before and half of this one: a falling drop is exact.
PressureReport Liquid::Data::project(double dt) {
  for (int a = 0; a < 3; ++a) {
    const auto gain = static_cast<float>(tank.gravity[a] * 0.5 * (last_dt + dt));
    if (gain == 0) continue;
    for (float& u : velocity.face[a].values) u += gain;
  }
  return solver.project(solids, distance, nullptr, dt, tank.density, options.pressure, velocity,
                        known);
}

/// Velocity beyond the faces that the projection gave. Faces that particles reach beside the liquid
/// change as the liquid does (at rest they stay at rest); those farther off fall freely; the rest
/// continues them.
void Liquid::Data::continue_velocity() {
  reached = known;
  for (std::size_t a = 0; a < 3; ++a) subtract(velocity.face[a], before.face[a], change.face[a]);
  extrapolator.extrapolate(2, change, reached);
  for (std::size_t a = 0; a < 3; ++a) {
    std::vector<float>& u = velocity.face[a].values;
    const std::vector<float>&u0 = before.face[a].values, &du = change.face[a].values;
    const std::vector<float>& open_part = solids.open[a].values;
    for (std::size_t i = 0; i < u.size(); ++i) {
      if (known[a][i] != 0 || touched[a][i] == 0 || !(open_part[i] > 0)) continue;
      if (reached[a][i] != 0) u[i] = u0[i] + du[i];
      known[a][i] = 1;
    }
  }
  extrapolator.extrapolate(layers(), velocity, known);
  constrain_to_solids(solids, known, velocity);
}

void Liquid::Data::to_particles() {
  if (options.transfer != TransferKind::flip) {
    grid_to_particles(velocity, 0, affine(), particles);
    return;
  }
  const auto pic = static_cast<float>(options.pic_fraction);
  for (std::size_t a = 0; a < 3; ++a) {
    const std::vector<float>& u = velocity.face[a].values;
    std::vector<float>& field = before.face[a].values;
    for (std::size_t i = 0; i < u.size(); ++i) field[i] = u[i] - (1 - pic) * field[i];
  }
  grid_to_particles(before, 1 - pic, false, particles);
}

void Liquid::Data::advect(double dt, bool corrected) {
  const MacGrid* field = &velocity;
  if (corrected) {
    for (std::size_t a = 0; a < 3; ++a) {
      std::vector<float>& moved = shift.face[a].values;
      const std::vector<float>& u = velocity.face[a].values;
      for (std::size_t i = 0; i < u.size(); ++i) moved[i] = u[i] + moved[i];
    }
    field = &shift;
  }
  advect_particles(*field, dt, solids_or_null(), open, particles, left);
  const std::int64_t gone = std::count(left.begin(), left.end(), 1);
  if (gone > 0) remove_particles(left, particles);
  removed += gone;
}

Liquid::Liquid(const Tank& tank, const LiquidOptions& options, std::uint64_t seed)
    : data_(std::make_unique<Data>(tank, options, seed)) {
  data_->place_solids(0, tank.frame_interval);
  data_->fill();
  data_->first_velocity();
}

Liquid::~Liquid() = default;

LiquidStepReport Liquid::step(double dt_max, RunContext& context) {
  Data& d = *data_;
  LiquidStepReport report;
  {
    const Phase phase(context, "sort");
    d.pour();
  }
  report.max_speed = fastest_particle(d.particles, d.time);
  report.dt = d.step_length(dt_max, report.max_speed);
  const double dt = report.dt;
  const bool corrects = d.options.volume_correction == VolumeCorrection::density;
  {
    const Phase phase(context, "solids");
    d.place_solids(d.time + dt, dt);
  }
  {
    const Phase phase(context, "to_grid");
    d.particles_to_grid();
    d.find_liquid();
    report.liquid_volume = liquid_volume(d.distance, d.shape);
  }
  if (corrects) {
    const Phase phase(context, "volume");
    report.correction = d.correct_volume(dt);
  }
  {
    const Phase phase(context, "pressure");
    report.pressure = d.project(dt);
  }
  {
    const Phase phase(context, "extrapolate");
    d.continue_velocity();
  }
  {
    const Phase phase(context, "to_particles");
    d.to_particles();
  }
  if (d.options.reseed) {
    const Phase phase(context, "reseed");
    reseed(d.velocity, d.distance, d.rule(), d.balance, d.particles);
  }
  {
    const Phase phase(context, "advect");
    d.advect(dt, corrects);
  }
  {
    const Phase phase(context, "sort");
    d.sorter.sort(d.shape, d.particles);
  }
  d.time += dt;
  d.last_dt = dt;
  ++d.steps;
  return report;
}

double Liquid::time() const { return data_->time; }
const LiquidParticles& Liquid::particles() const { return data_->particles; }
LiquidParticles& Liquid::particles() { return data_->particles; }
const MacGrid& Liquid::velocity() const { return data_->velocity; }
const GridShape& Liquid::shape() const { return data_->shape; }
std::vector<PlacedSolid> Liquid::solids() const { return data_->placed(data_->time, 0); }
std::int64_t Liquid::removed() const { return data_->removed; }

State Liquid::save() const {
  const Data& d = *data_;
  StateWriter out;
  out.number(d.time);
  out.number(d.last_dt);
  out.number(d.steps);
  out.number(d.balance);
  out.number(d.removed);
  out.items(d.particles.position);
  out.items(d.particles.velocity);
  out.items(d.particles.affine);
  return out.take();
}

void Liquid::load(const State& state) {
  Data& d = *data_;
  StateReader in(state);
  d.time = in.number<double>();
  d.last_dt = in.number<double>();
  d.steps = in.number<std::uint64_t>();
  d.balance = in.number<std::int64_t>();
  d.removed = in.number<std::int64_t>();
  in.items(d.particles.position);
  in.items(d.particles.velocity);
  in.items(d.particles.affine);
  const std::size_t n = d.particles.size();
  if (d.particles.velocity.size() != n || d.particles.affine.size() != (d.affine() ? n : 0))
    throw Error("particles of another kind of transfer", "checkpoint", "one of the same options");
  // Particles were sorted when they were saved, and the sort is stable.
  d.sorter.sort(d.shape, d.particles);
  d.place_solids(d.time, d.tank.frame_interval);
  d.first_velocity();
}

TriMesh Liquid::surface(Eigen::MatrixX3d* velocity) const {
  GridShape grid;
  ScalarGrid field = liquid_field(data_->shape, data_->particles, data_->options.surface, grid);
  if (!data_->tank.solids.empty()) meet_solids(data_->shape, data_->solids, grid, field);
  TriMesh mesh = isosurface(field, grid.origin, grid.cell);
  if (velocity != nullptr) *velocity = surface_velocity(data_->velocity, mesh.V);
  return mesh;
}

namespace {

constexpr std::array<std::string_view, 3> kTransferNames{"pic", "flip", "apic"};
constexpr std::array<std::string_view, 2> kCorrectionNames{"none", "density"};

}  // namespace

void describe(OptionVisitor& v, LiquidOptions& o) {
  describe_choice(
      v, "transfer", o.transfer, kTransferNames,
      {.doc = "what particles take from the grid: velocity, its change, or velocity and gradient"});
  v.value("pic_fraction", o.pic_fraction,
          {.doc = "share of PIC in the FLIP update", .min = 0, .max = 1});
  v.value("particles_per_cell", o.particles_per_cell,
          {.doc = "particles of a full cell at the start", .min = 1, .max = 64});
  v.value("cfl", o.cfl,
          {.doc = "cells that the fastest particle may cross in a substep", .min = 0.1, .max = 20});
  v.value(
      "max_substeps", o.max_substeps,
      {.doc = "most substeps of a frame; one that needs more ends the run", .min = 1, .max = 1e6});
  describe_choice(
      v, "volume_correction", o.volume_correction, kCorrectionNames,
      {.doc = "what keeps the volume: nothing, or moves of particles that even their density"});
  v.value("volume_rate", o.volume_rate,
          {.doc = "rate at which deviations of the particles' density decay",
           .unit = "1/s",
           .min = 0,
           .max = 1e4});
  v.value("reseed", o.reseed,
          {.doc = "keeps 3 to 2 x particles_per_cell particles in a full cell"});
  describe_group(v, "pressure", o.pressure, {.doc = "solver of the pressure"});
  describe_group(v, "surface", o.surface, {.doc = "surface that is recorded"});
  v.value("record_particles", o.record_particles,
          {.doc = "records the particles, as the part \"particles\" of a frame"});
  v.value("record_particles_every", o.record_particles_every,
          {.doc = "frames from one with recorded particles to the next", .min = 1});
}

}  // namespace geoprior::fluid
