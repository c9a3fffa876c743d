// What a substep of a liquid spends its time on, for a million particles: sorting, transfers,
// advection; a whole substep of a dam break by its number of particles; a surface.
//
//   geoprior_kernels --benchmark_filter=liquid

#include <benchmark/benchmark.h>

#include <memory>

#include "baselines/fluid/liquid/grid/advection.h"
#include "baselines/fluid/liquid/liquid.h"
#include "baselines/fluid/liquid/particles/transfer.h"

namespace geoprior::fluid {
namespace {

/// A column of 42 % of a unit tank, half as high; 64 cells: 440 000 particles.
Tank dam(int cells) {
  Tank tank;
  tank.cells = {cells, cells, cells};
  tank.cell = 1.0 / cells;
  LiquidVolume column;
  column.name = "column";
  column.shape.centre = {0.21, 0.5, 0.25};
  column.shape.half_size = {0.21, 0.5, 0.25};
  tank.volumes.push_back(column);
  return tank;
}

/// A dam break that has begun to move: a million particles.
const Liquid& moving() {
  static const auto liquid = [] {
    auto result = std::make_unique<Liquid>(dam(84), LiquidOptions{}, 1);
    RunContext context;
    while (result->time() < 0.2) result->step(1.0 / 30, context);
    return result;
  }();
  return *liquid;
}

void liquid_sort(benchmark::State& state) {
  LiquidParticles particles = moving().particles();
  CellSorter sorter;
  for (auto _ : state) sorter.sort(moving().shape(), particles);
}
BENCHMARK(liquid_sort)->Unit(benchmark::kMillisecond)->UseRealTime();

void liquid_to_grid(benchmark::State& state) {
  ParticleToGrid to_grid(moving().shape());
  MacGrid velocity(moving().shape());
  std::array<std::vector<char>, 3> touched;
  ScalarGrid density;
  for (auto _ : state) to_grid.gather(moving().particles(), 8, velocity, touched, density);
}
BENCHMARK(liquid_to_grid)->Unit(benchmark::kMillisecond)->UseRealTime();

void liquid_to_particles(benchmark::State& state) {
  LiquidParticles particles = moving().particles();
  for (auto _ : state) grid_to_particles(moving().velocity(), 0.97F, false, particles);
}
BENCHMARK(liquid_to_particles)->Unit(benchmark::kMillisecond)->UseRealTime();

void liquid_advect(benchmark::State& state) {
  LiquidParticles particles = moving().particles();
  std::vector<std::uint8_t> left;
  for (auto _ : state)
    advect_particles(moving().velocity(), 1e-4, nullptr, std::nullopt, particles, left);
}
BENCHMARK(liquid_advect)->Unit(benchmark::kMillisecond)->UseRealTime();

void liquid_surface(benchmark::State& state) {
  const Liquid& liquid = moving();  // made before the clock runs
  Eigen::MatrixX3d velocity;
  for (auto _ : state) benchmark::DoNotOptimize(liquid.surface(&velocity));
}
BENCHMARK(liquid_surface)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Steps from t = 0.2 s on of tanks of 32 to 84 cells: 55 000 to 1 000 000 particles.
void liquid_step(benchmark::State& state) {
  Liquid liquid(dam(static_cast<int>(state.range(0))), LiquidOptions{}, 1);
  RunContext context;
  while (liquid.time() < 0.2) liquid.step(1.0 / 30, context);
  for (auto _ : state) liquid.step(0.004, context);
  state.counters["particles"] = static_cast<double>(liquid.particles().size());
}
BENCHMARK(liquid_step)
    ->Arg(32)
    ->Arg(48)
    ->Arg(64)
    ->Arg(84)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Whole frames at 25 a second from t = 0.2 s on, at 64 cells, each with its surface.
void liquid_frame(benchmark::State& state) {
  Liquid liquid(dam(64), LiquidOptions{}, 1);
  RunContext context;
  while (liquid.time() < 0.2) liquid.step(1.0 / 30, context);
  Eigen::MatrixX3d velocity;
  const double start = liquid.time();
  int frames = 0;
  for (auto _ : state) {
    const double end = start + 0.04 * ++frames;
    while (liquid.time() < end - 1e-9) liquid.step(end - liquid.time(), context);
    benchmark::DoNotOptimize(liquid.surface(&velocity));
  }
  state.counters["particles"] = static_cast<double>(liquid.particles().size());
}
BENCHMARK(liquid_frame)->Iterations(10)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace geoprior::fluid
