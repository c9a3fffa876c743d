#include "baselines/fluid/liquid/process.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <optional>

#include "baselines/fluid/liquid/particles/reseed.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "tests/fluid/liquid/fixture.h"

namespace geoprior::fluid {
namespace {

using tanks::at_rest;
using tanks::ball;
using tanks::box_between;
using tanks::column_tank;
using tanks::run_until;
using tanks::tank_of;

/// Everything at once: a column, a moving ball, a spout.
Tank busy_tank() {
  Tank tank = column_tank(16);
  TankSolid solid;
  solid.name = "ball";
  solid.shape = ball({0.7, 0.25, 0.2}, 0.1);
  Keyframe end;
  end.time = 0.5;
  end.shift = {-0.3, 0, 0};
  solid.motion = Trajectory{{Keyframe{}, end}};
  tank.solids.push_back(solid);
  LiquidSource source;
  source.name = "spout";
  source.shape = ball({0.8, 0.25, 0.8}, 0.1);
  source.velocity = {0, 0, -1};
  source.until = 1;
  tank.sources.push_back(source);
  tank.duration = 0.2;
  tank.frame_interval = 0.04;
  return tank;
}

class Collector final : public FrameSink {
 public:
  void frame(Frame frame) override { frames.push_back(std::move(frame)); }
  void event(const Event&) override {}
  void artifact(Artifact) override {}
  void checkpoint(const State& state) override { states.push_back(state); }
  std::vector<Frame> frames;
  std::vector<State> states;
};

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(LiquidStart, AFullCellHasItsParticlesOneInEachPart) {
  Tank tank = tank_of({4, 4, 4}, 0.25);
  tank.volumes.push_back(at_rest(box_between({0, 0, 0}, {0.5, 0.5, 0.5})));
  const Liquid liquid(tank, LiquidOptions{}, 1);
  const LiquidParticles& p = liquid.particles();
  ASSERT_EQ(p.size(), 64U);
  std::vector<int> count(512, 0);
  for (const Eigen::Vector3f& x : p.position) {
    const Eigen::Vector3i part = (x * 8).array().floor().cast<int>();
    ++count[part.x() + 8 * (part.y() + 8 * part.z())];
  }
  EXPECT_EQ(std::count(count.begin(), count.end(), 1), 64);
}

TEST(LiquidStart, OverlappingVolumesFillOnceTheFirstOneWins) {
  Tank tank = tank_of({8, 8, 8}, 0.125);
  LiquidVolume first = at_rest(box_between({0, 0, 0}, {0.6, 1, 0.5}));
  first.velocity = {1, 0, 0};
  tank.volumes = {first, at_rest(box_between({0.4, 0, 0}, {1, 1, 0.5}))};
  const Liquid liquid(tank, LiquidOptions{}, 1);
  EXPECT_EQ(liquid.particles().size(), 8U * 8 * 8 * 4);
  for (std::size_t p = 0; p < liquid.particles().size(); ++p) {
    const bool in_first = liquid.particles().position[p].x() < 0.6F;
    EXPECT_EQ(liquid.particles().velocity[p].x(), in_first ? 1 : 0);
  }
}

TEST(LiquidStart, ParticlesKeepOutOfSolids) {
  Tank tank = tank_of({16, 16, 16}, 1.0 / 16);
  tank.volumes.push_back(at_rest(box_between({0, 0, 0}, {1, 1, 0.6})));
  TankSolid solid;
  solid.shape = ball({0.5, 0.5, 0.3}, 0.2);
  tank.solids.push_back(solid);
  Liquid liquid(tank, LiquidOptions{}, 1);
  const double ball_volume = 4.0 / 3 * std::numbers::pi * 0.008;
  EXPECT_NEAR(static_cast<double>(liquid.particles().size()) / 8 / 4096, 0.6 - ball_volume, 3e-3);
  run_until(liquid, 0.3);
  for (const Eigen::Vector3f& x : liquid.particles().position) {
    // Distances are linear between nodes: h^2 / (8 R) short of the sphere.
    EXPECT_GT((x.cast<double>() - Eigen::Vector3d(0.5, 0.5, 0.3)).norm(), 0.2 - 4e-3);
  }
}

// A spout of a cell's cross-section gives A v t of liquid, whatever the step.
TEST(LiquidSource, PoursItsAreaTimesItsSpeed) {
  Tank tank = tank_of({12, 12, 24}, 0.1);
  tank.gravity.setZero();
  LiquidSource source;
  source.name = "spout";
  source.shape = box_between({0.4, 0.4, 1.8}, {0.8, 0.8, 2.2});
  source.velocity = {0, 0, -1.5};
  source.until = 10;
  tank.sources.push_back(source);
  LiquidOptions options;
  options.reseed = false;
  options.volume_correction = VolumeCorrection::none;
  Liquid liquid(tank, options, 1);
  run_until(liquid, 0.8);
  const double volume = static_cast<double>(liquid.particles().size()) * 1e-3 / 8;
  // The source itself (0.4 m high) is full, and a column as long as the way has left it. What a
  // cell lacks when its last particle has not left yet is less than a cell's height.
  EXPECT_NEAR(volume, 0.16 * (0.4 + 1.5 * 0.8), 0.16 * 0.1 * 1.5);
}

TEST(LiquidReseed, KeepsCountsWithinBoundsAndAddsAsMuchAsItRemoves) {
  const GridShape shape = tanks::grid_of({8, 8, 8}, 1.0 / 8);
  LiquidParticles particles;
  SeedRule rule;
  RandomStream random(3, "counts");
  for (int k = 0; k < 8; ++k)
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 8; ++i) {
        const std::uint32_t count = random.below(2) == 0 ? 1 : 18;
        for (std::uint32_t p = 0; p < count; ++p) {
          const Eigen::Vector3d x(i + random.uniform(), j + random.uniform(), k + random.uniform());
          particles.position.push_back((x / 8).cast<float>());
          particles.velocity.push_back(Eigen::Vector3f::Zero());
        }
      }
  sort_by_cell(shape, particles);
  const std::size_t before = particles.size();
  const ScalarGrid distance({8, 8, 8}, -1.0F / 8);
  std::int64_t balance = 0;
  EXPECT_TRUE(reseed(MacGrid(shape), distance, rule, balance, particles));
  EXPECT_EQ(static_cast<std::int64_t>(particles.size()) - static_cast<std::int64_t>(before),
            balance);
  sort_by_cell(shape, particles);
  for (std::size_t c = 0; c < 512; ++c) {
    EXPECT_GE(particles.cell_begin[c + 1] - particles.cell_begin[c], 3U);
    EXPECT_LE(particles.cell_begin[c + 1] - particles.cell_begin[c], 16U);
  }
  // Added 2 a sparse cell, removed 2 to 6 a crowded one: near zero, not a tenth of what it was.
  EXPECT_LT(std::abs(balance), 16);
}

TEST(LiquidProcess, FramesHaveTheirTimesPartsAndDiagnostics) {
  Collector sink;
  RunContext context;
  LiquidOptions options;
  options.record_particles = true;
  options.record_particles_every = 2;
  const Tank tank = busy_tank();
  make_liquid(tank, options)->run(sink, context, std::nullopt);
  ASSERT_EQ(sink.frames.size(), 6U);
  EXPECT_EQ(sink.states.size(), 6U);
  for (std::size_t f = 0; f < sink.frames.size(); ++f) {
    const Frame& frame = sink.frames[f];
    EXPECT_DOUBLE_EQ(frame.parameter, 0.04 * static_cast<double>(f));
    const Part& surface = frame.require_part("surface");
    TriMesh mesh{surface.points, surface.triangles};
    EXPECT_NO_THROW(require_closed_manifold(mesh, "surface", "frame"));
    EXPECT_GT(signed_volume(mesh.V, mesh.F), 0);
    EXPECT_EQ(surface.arrays.at(0).name, "velocity");
    EXPECT_EQ(surface.arrays.at(0).values.rows(), mesh.V.rows());
    EXPECT_TRUE(surface.arrays.at(0).values.allFinite());
    const Part& solids = frame.require_part("solids");
    TriMesh body{solids.points, solids.triangles};
    // A ball of 32 x 16 facets lacks 1 - 1.3 % of its volume.
    EXPECT_NEAR(signed_volume(body.V, body.F), 4.0 / 3 * std::numbers::pi * 1e-3, 1.3e-4);
    const auto& d = frame.diagnostics;
    const Part* particles = frame.find_part("particles");
    ASSERT_EQ(particles != nullptr, f % 2 == 0) << f;
    if (particles != nullptr) {
      EXPECT_EQ(static_cast<double>(particles->points.rows()), d.at("particles"));
    }
    EXPECT_NEAR(d.at("particle_volume"), d.at("particles") / 8 / 4096, 1e-12);
    EXPECT_EQ(d.at("pressure_converged"), 1) << f;
    if (f > 0) {
      EXPECT_LE(d.at("cfl"), 3);
      EXPECT_GE(d.at("substeps"), 1);
    }
  }
  EXPECT_LT(sink.frames[5].require_part("solids").points.col(0).mean(),
            sink.frames[0].require_part("solids").points.col(0).mean());
}

TEST(LiquidProcess, ARunResumedFromAnyFrameHasTheSameBytes) {
  Collector whole;
  RunContext context;
  LiquidOptions options;
  options.transfer = TransferKind::apic;
  const Tank tank = busy_tank();
  make_liquid(tank, options)->run(whole, context, std::nullopt);
  for (const std::size_t at : {1U, 3U}) {
    Collector rest;
    make_liquid(tank, options)->run(rest, context, whole.states[at]);
    ASSERT_EQ(rest.frames.size(), whole.frames.size() - at - 1);
    EXPECT_EQ(rest.states.back(), whole.states.back());
    for (std::size_t f = 0; f < rest.frames.size(); ++f) {
      const Frame &a = rest.frames[f], &b = whole.frames[f + at + 1];
      EXPECT_EQ(a.diagnostics, b.diagnostics);
      EXPECT_EQ(a.require_part("surface").points, b.require_part("surface").points);
      EXPECT_EQ(a.require_part("surface").arrays[0].values,
                b.require_part("surface").arrays[0].values);
    }
  }
}

TEST(LiquidProcess, SameBytesWithOneAndTwoThreads) {
  std::array<State, 2> states;
  for (int t = 0; t < 2; ++t) {
    with_threads(t + 1, [&] {
      Liquid liquid(busy_tank(), LiquidOptions{}, 7);
      run_until(liquid, 0.3, 0.04);
      states[t] = liquid.save();
    });
  }
  EXPECT_EQ(states[0], states[1]);
}

TEST(LiquidProcess, PressureIterationsOfAFrameAreTheSumOfItsSubsteps) {
  Tank tank = column_tank(8);
  tank.duration = 0.2;
  tank.frame_interval = 0.1;
  LiquidOptions options;
  options.cfl = 0.1;
  Collector sink;
  RunContext context;
  make_liquid(tank, options)->run(sink, context, std::nullopt);
  Liquid liquid(tank, options, context.seed());
  int substeps = 0;
  for (int frame = 1; frame < tank.frame_count(); ++frame) {
    int iterations = 0;
    for (bool done = false; !done; ++substeps) {
      const double rest = tank.frame_time(frame) - liquid.time();
      const LiquidStepReport step = liquid.step(rest, context);
      iterations += step.pressure.iterations;
      done = step.dt >= rest;
    }
    EXPECT_EQ(sink.frames[frame].diagnostics.at("pressure_iterations"), iterations) << frame;
  }
  EXPECT_GT(substeps, 2 * tank.frame_count());
}

TEST(LiquidProcess, AnotherSeedIsAnotherJitter) {
  const Liquid a(column_tank(8), LiquidOptions{}, 1), b(column_tank(8), LiquidOptions{}, 2);
  EXPECT_FALSE(same_bytes(a.particles().position, b.particles().position));
}

TEST(LiquidProcess, AnOpenTopLetsLiquidLeaveAClosedOneDoesNot) {
  for (const bool open : {true, false}) {
    Tank tank = tank_of({8, 8, 8}, 0.125);
    tank.open_top = open;
    LiquidVolume drop = at_rest(ball({0.5, 0.5, 0.7}, 0.2));
    drop.velocity = {0, 0, 6};
    tank.volumes.push_back(drop);
    LiquidOptions options;
    options.reseed = false;
    Liquid liquid(tank, options, 1);
    const std::int64_t start = liquid.particles().size();
    run_until(liquid, 0.2);
    const std::int64_t left = liquid.particles().size();
    EXPECT_EQ(liquid.removed(), start - left);
    EXPECT_EQ(left == start, !open);
  }
}

TEST(LiquidProcess, ATooFastFrameEndsTheRunAndKeepsTheFrames) {
  Tank tank = column_tank(16);
  LiquidOptions options;
  options.max_substeps = 1;
  options.cfl = 0.5;
  Collector sink;
  RunContext context;
  try {
    make_liquid(tank, options)->run(sink, context, std::nullopt);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("more than 1 substeps"), std::string::npos);
  }
  EXPECT_GE(sink.frames.size(), 1U);
}

TEST(LiquidProcess, AVelocityThatIsNotFiniteIsAnErrorWithItsTime) {
  Liquid liquid(column_tank(8), LiquidOptions{}, 1);
  RunContext context;
  liquid.step(0.01, context);
  liquid.particles().velocity[5].y() = std::numeric_limits<float>::quiet_NaN();
  try {
    liquid.step(0.01, context);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("time 0.01"), std::string::npos);
  }
}

TEST(LiquidProcess, AHarmedCheckpointIsRefused) {
  Liquid liquid(column_tank(8), LiquidOptions{}, 1);
  State state = liquid.save();
  state.resize(state.size() / 2);
  EXPECT_THROW(liquid.load(state), Error);
}

TEST(LiquidProcess, ACheckpointOfAnotherTransferIsRefused) {
  LiquidOptions apic;
  apic.transfer = TransferKind::apic;
  const Liquid from(column_tank(8), LiquidOptions{}, 1);
  Liquid to(column_tank(8), apic, 1);
  EXPECT_THROW(to.load(from.save()), Error);
}

// Two spouts over the same cells fill them once: 27 cells of 8 particles.
TEST(LiquidSource, SourcesThatOverlapFillACellOnce) {
  Tank tank = tank_of({8, 8, 8}, 0.125);
  tank.gravity.setZero();
  LiquidSource source;
  source.shape = box_between({0.25, 0.25, 0.25}, {0.625, 0.625, 0.625});
  source.until = 1;
  tank.sources = {source, source};
  Liquid liquid(tank, LiquidOptions{}, 1);
  RunContext context;
  liquid.step(0.01, context);
  EXPECT_EQ(liquid.particles().size(), 27U * 8);
}

// A paddle that pushes liquid: particles in front of it have its speed, none is behind its face.
TEST(LiquidProcess, AMovingSolidPushesLiquid) {
  Tank tank = tank_of({32, 4, 16}, 1.0 / 32);
  tank.volumes.push_back(at_rest(box_between({0.2, 0, 0}, {1, 0.125, 0.25})));
  TankSolid paddle;
  paddle.name = "paddle";
  paddle.shape = box_between({-0.2, -0.1, -0.1}, {0.2, 0.225, 0.6});
  Keyframe middle, end;
  middle.time = 0.2;
  middle.shift = {0.1, 0, 0};
  end.time = 0.4;
  end.shift = {0.2, 0, 0};
  paddle.motion = Trajectory{{Keyframe{}, middle, end}};
  tank.solids.push_back(paddle);
  std::optional<Liquid> liquid;
  liquid.emplace(tank, LiquidOptions{}, 1);
  const double start = tanks::momentum(liquid->particles()).x();
  run_until(*liquid, 0.25, 0.02);
  EXPECT_GT(tanks::momentum(liquid->particles()).x() - start, 0);
  const double face = 0.2 + paddle.motion->at(0.25).shift.x();
  double speed = 0;
  int beside = 0;
  const LiquidParticles& particles = liquid->particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double x = particles.position[p].x();
    EXPECT_GT(x, face - 0.1 / 32);
    if (x > face + 1.0 / 32) continue;
    speed += static_cast<double>(particles.velocity[p].x());
    ++beside;
  }
  ASSERT_GT(beside, 0);
  RecordProperty("speed_beside_the_face", std::to_string(speed / beside));
  const double paddle_speed =
      (paddle.motion->at(0.251).shift.x() - paddle.motion->at(0.249).shift.x()) / 0.002;
  EXPECT_NEAR(speed / beside, paddle_speed, 0.05 * paddle_speed);
}

}  // namespace
}  // namespace geoprior::fluid
