#include "baselines/fluid/ocean/ocean.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/context.h"
#include "core/error.h"
#include "core/parallel.h"
#include "tests/fluid/ocean/modes.h"

namespace geoprior::fluid {
namespace {

using Complex = std::complex<double>;

/// A sea in which every mode carries something.
OceanOptions all_directions(int samples, double size) {
  OceanOptions o;
  o.spectrum = SpectrumKind::pierson_moskowitz;
  o.spreading = SpreadingKind::none;
  o.samples = samples;
  o.size = size;
  return o;
}

struct Sample {
  double mean, error;  ///< of the mean
};

template <class Value>
Sample over_seeds(int seeds, const Value& value) {
  double sum = 0, squares = 0;
  for (int s = 0; s < seeds; ++s) {
    const double x = value(static_cast<std::uint64_t>(s) + 1);
    sum += x;
    squares += x * x;
  }
  const double mean = sum / seeds;
  return {mean, std::sqrt((squares / seeds - mean * mean) / (seeds - 1))};
}

// c(t - s) + c(t + s) = 2 cos(w s) c(t) for waves both ways: w from the heights at three times.
TEST(Ocean, EveryModeObeysTheDispersionRelation) {
  for (const double depth : {1e4, 2.0}) {
    OceanOptions o = all_directions(32, 50);
    o.depth = depth;
    const Ocean ocean(o, 7);
    const double t = 12.5, s = 0.3;
    const auto before = ocean_modes(ocean.heights(t - s), 32);
    const auto now = ocean_modes(ocean.heights(t), 32);
    const auto after = ocean_modes(ocean.heights(t + s), 32);
    int checked = 0;
    for (int j = 0; j < 32; ++j) {
      for (int i = 0; i < 32; ++i) {
        if (i == 16 || j == 16 || (i == 0 && j == 0)) continue;
        const double k = 2 * std::numbers::pi / 50 * std::hypot(waves_of(i, 32), waves_of(j, 32));
        const double exact = std::sqrt(9.81 * k * std::tanh(k * depth));
        const Complex c = (before(j, i) + after(j, i)) / (2.0 * now(j, i));
        EXPECT_NEAR(std::acos(c.real()) / s / exact, 1, 1e-6) << i << " " << j;
        EXPECT_NEAR(ocean.frequency(waves_of(i, 32), waves_of(j, 32)) / exact, 1, 1e-14);
        ++checked;
      }
    }
    EXPECT_EQ(checked, 31 * 31 - 1);
  }
}

// A wave along k is e^{i (k x - w t)}: the coefficient turns by -w t, so the phase moves at w/k.
TEST(Ocean, OneSidedSpectrumMovesDownwindAtPhaseSpeed) {
  OceanOptions o = all_directions(32, 50);
  o.spreading = SpreadingKind::one_sided;
  o.wind_direction_deg = 90;
  const Ocean ocean(o, 3);
  const double s = 0.2;
  const auto now = ocean_modes(ocean.heights(4), 32);
  const auto after = ocean_modes(ocean.heights(4 + s), 32);
  for (int j = 1; j < 16; ++j) {  // ky > 0: downwind
    for (int i = 0; i < 32; ++i) {
      if (i == 16) continue;
      const Complex turn = after(j, i) / now(j, i);
      const double omega = ocean.frequency(waves_of(i, 32), j);
      EXPECT_NEAR(std::abs(turn - std::polar(1.0, -omega * s)), 0, 1e-9) << i << " " << j;
    }
  }
}

TEST(Ocean, NyquistModesAndTheMeanCarryNothing) {
  const Ocean ocean(all_directions(16, 30), 5);
  const auto c = ocean_modes(ocean.heights(1.25), 16);
  EXPECT_NEAR(c.row(8).cwiseAbs().maxCoeff(), 0, 1e-15);
  EXPECT_NEAR(c.col(8).cwiseAbs().maxCoeff(), 0, 1e-15);
  EXPECT_NEAR(std::abs(c(0, 0)), 0, 1e-15);
}

TEST(Ocean, VarianceOfTheHeightsIsTheExpectedOne) {
  for (const auto spreading : {SpreadingKind::cosine_squared, SpreadingKind::none}) {
    OceanOptions o = all_directions(64, 400);
    o.spreading = spreading;
    const double expected = Ocean(o, 1).expected_variance();
    const Sample ratio = over_seeds(200, [&](std::uint64_t seed) {
      return Ocean(o, seed).heights(3).squaredNorm() / (64 * 64) / expected;
    });
    EXPECT_LT(ratio.error, 0.02);
    EXPECT_NEAR(ratio.mean, 1, 4 * ratio.error);
  }
}

// Each height is a sum of normal numbers: <h^4> = 3 <h^2>^2, <h^3> = 0 over the ensemble.
TEST(Ocean, HeightsAreGaussian) {
  const OceanOptions o = all_directions(64, 400);
  const double variance = Ocean(o, 1).expected_variance();
  const auto moment = [&](int power) {
    return over_seeds(200, [&](std::uint64_t seed) {
      return (Ocean(o, seed).heights(0).array() / std::sqrt(variance)).pow(power).mean();
    });
  };
  const Sample fourth = moment(4), third = moment(3);
  EXPECT_LT(fourth.error, 0.1);
  EXPECT_NEAR(fourth.mean, 3, 4 * fourth.error);
  EXPECT_LT(third.error, 0.05);
  EXPECT_NEAR(third.mean, 0, 4 * third.error);
}

TEST(Ocean, SameSeedSameBitsForAnyThreadCount) {
  const OceanOptions o = all_directions(64, 80);
  Eigen::MatrixX3d one, two;
  with_threads(1, [&] { one = Ocean(o, 9).displacements(1.5); });
  with_threads(2, [&] { two = Ocean(o, 9).displacements(1.5); });
  EXPECT_TRUE(one == two);
  EXPECT_FALSE(one == Ocean(o, 10).displacements(1.5));
}

TEST(Ocean, FinerPatchKeepsTheLongWaves) {
  OceanOptions o = all_directions(32, 100);
  o.smallest_wave = 25;  // e^-16 at the Nyquist length of the coarse patch
  const Eigen::VectorXd coarse = Ocean(o, 4).heights(2);
  o.samples = 64;
  const Eigen::VectorXd fine = Ocean(o, 4).heights(2);
  double largest = 0;
  for (int j = 0; j < 32; ++j) {
    for (int i = 0; i < 32; ++i) {
      largest = std::max(largest, std::abs(coarse(j * 32 + i) - fine(2 * j * 64 + 2 * i)));
    }
  }
  EXPECT_LT(largest, 1e-3 * std::sqrt(coarse.array().square().mean()));
}

TEST(Ocean, VelocitiesAreTheDerivativeOfTheDisplacements) {
  OceanOptions o = all_directions(32, 50);
  o.choppiness = 0.7;
  const Ocean ocean(o, 2);
  const double dt = 1e-4;
  const Eigen::MatrixX3d difference =
      (ocean.displacements(5 + dt) - ocean.displacements(5 - dt)) / (2 * dt);
  // Central differences err by (w dt)^2/6 < 5e-8 of the fastest mode.
  EXPECT_LT((difference - ocean.velocities(5)).cwiseAbs().maxCoeff(), 1e-6);
}

// Orbits of linear waves: under a crest water moves with the wave, <u h> = lambda sum w P, and
// points gather there, <h div D> = -lambda sum |k| P.
TEST(Ocean, WaterUnderCrestsMovesDownwindAndGathers) {
  OceanOptions o = all_directions(64, 100);
  o.spreading = SpreadingKind::cosine_squared;
  const Ocean ocean(o, 6);
  const Eigen::MatrixX3d d = ocean.displacements(1), v = ocean.velocities(1);
  EXPECT_GT(v.col(0).dot(d.col(2)), 0.5 * v.col(0).norm() * d.col(2).norm());
  const double cell = 100.0 / 64;
  double gather = 0;
  for (int j = 0; j < 64; ++j) {
    for (int i = 0; i < 64; ++i) {
      const auto at = [&](int x, int y) { return ((y + 64) % 64) * 64 + (x + 64) % 64; };
      const double divergence =
          (d(at(i + 1, j), 0) - d(at(i - 1, j), 0) + d(at(i, j + 1), 1) - d(at(i, j - 1), 1)) /
          (2 * cell);
      gather += divergence * d(at(i, j), 2);
    }
  }
  EXPECT_LT(gather, 0);
}

TEST(Ocean, AmplitudeIsTheSignificantHeight) {
  OceanOptions o;
  o.amplitude = 0.5;
  EXPECT_NEAR(4 * std::sqrt(Ocean(o, 1).expected_variance()), 0.5, 1e-12);
}

TEST(Ocean, TilesShareTheirSeams) {
  OceanOptions o = all_directions(16, 40);
  o.tiles = 2;
  o.mean_level = 3;
  const Ocean ocean(o, 8);
  Eigen::MatrixX3d velocity;
  const TriMesh mesh = ocean.surface(0.5, &velocity);
  ASSERT_EQ(mesh.vertex_count(), 33 * 33);
  ASSERT_EQ(mesh.triangle_count(), 2 * 32 * 32);
  for (int j = 0; j < 33; ++j) {
    for (int i = 0; i < 17; ++i) {
      const int left = j * 33 + i, right = left + 16;
      EXPECT_NEAR((mesh.V.row(right) - mesh.V.row(left) - Eigen::RowVector3d(40, 0, 0)).norm(), 0,
                  1e-12);
      EXPECT_TRUE(velocity.row(right) == velocity.row(left));
      const int below = i * 33 + j, above = below + 16 * 33;
      EXPECT_NEAR((mesh.V.row(above) - mesh.V.row(below) - Eigen::RowVector3d(0, 40, 0)).norm(), 0,
                  1e-12);
    }
  }
  const Eigen::RowVector3d middle = mesh.V.colwise().mean();
  EXPECT_NEAR(middle.x(), 0, 2);
  EXPECT_NEAR(middle.z(), 3, 0.5);
  EXPECT_GT(triangle_normals(mesh).col(2).minCoeff(), 0);
}

/// Keeps frames and the last state.
class Keep final : public FrameSink {
 public:
  void frame(Frame frame) override { frames.push_back(std::move(frame)); }
  void event(const Event&) override {}
  void artifact(Artifact) override {}
  void checkpoint(const State& s) override { states.push_back(s); }
  std::vector<Frame> frames;
  std::vector<State> states;
};

TEST(Ocean, ProcessPushesFramesAtTheTimesAndResumes) {
  OceanOptions o = all_directions(16, 40);
  const std::vector<double> times{0, 0.1, 0.2, 0.3};
  RunContext context(12);
  Keep whole, rest;
  make_ocean(o, times)->run(whole, context, std::nullopt);
  ASSERT_EQ(whole.frames.size(), 4U);
  EXPECT_DOUBLE_EQ(whole.frames[3].parameter, 0.3);
  const Part& surface = whole.frames[2].require_part("surface");
  EXPECT_TRUE(surface.points == Ocean(o, 12).surface(0.2).V);
  ASSERT_EQ(surface.arrays.size(), 1U);
  EXPECT_EQ(surface.arrays[0].name, "velocity");
  make_ocean(o, times)->run(rest, context, whole.states.at(1));
  ASSERT_EQ(rest.frames.size(), 2U);
  EXPECT_TRUE(rest.frames[0].require_part("surface").points == surface.points);
}

TEST(Ocean, RefusesWhatIsNoSea) {
  const auto refused = [](auto change, const std::string& option) {
    OceanOptions o;
    change(o);
    try {
      const Ocean ocean(o, 1);
      FAIL() << option << " was accepted";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(option), std::string::npos) << e.what();
    }
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  refused([](OceanOptions& o) { o.samples = 100; }, "samples is 100");
  refused([](OceanOptions& o) { o.samples = 0; }, "samples");
  refused([](OceanOptions& o) { o.samples = 8192; }, "samples");
  refused([](OceanOptions& o) { o.tiles = 0; }, "tiles");
  refused([](OceanOptions& o) { o.tiles = 100; }, "tiles");
  refused([](OceanOptions& o) { o.size = kNan; }, "size");
  refused([](OceanOptions& o) { o.wind_speed = 0; }, "wind_speed");
  refused([](OceanOptions& o) { o.wind_direction_deg = kNan; }, "wind_direction_deg");
  refused([](OceanOptions& o) { o.fetch = -1; }, "fetch");
  refused([](OceanOptions& o) { o.depth = 0; }, "depth");
  refused([](OceanOptions& o) { o.gravity = kNan; }, "gravity");
  refused([](OceanOptions& o) { o.amplitude = -1; }, "amplitude");
}

}  // namespace
}  // namespace geoprior::fluid
