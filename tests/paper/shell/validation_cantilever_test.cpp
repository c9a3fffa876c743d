#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/paper/meshes.h"
#include "tests/paper/sheets.h"
#include "tests/support/long_tests.h"

// The whole solver against a heavy strip clamped at one end.
namespace geoprior::paper {
namespace {

constexpr double kLength = 0.15, kWidth = 0.03;

PaperMaterial beam() {
  PaperMaterial material;
  material.poisson_ratio = 0;
  return material;
}

/// How far the tip of an inextensible strip hangs below its clamp (m): D phi'' = q (L - s) cos phi,
/// phi(0) = 0, phi'(L) = 0, phi the slope and q the weight for each metre. Integrated from the tip
/// with its slope found by bisection; fourth order, 2,000 steps (1e-11).
double exact_sag(double stiffness, double weight) {
  constexpr int kSteps = 2000;
  const double h = kLength / kSteps;
  const auto shoot = [&](double tip_slope, double& sag) {
    // y = (phi, phi', drop) over the distance t = L - s from the tip.
    Eigen::Vector3d y(tip_slope, 0, 0);
    const auto rate = [&](double t, const Eigen::Vector3d& z) {
      return Eigen::Vector3d(z[1], weight / stiffness * t * std::cos(z[0]), std::sin(z[0]));
    };
    for (int i = 0; i < kSteps; ++i) {
      const double t = i * h;
      const Eigen::Vector3d k1 = rate(t, y), k2 = rate(t + h / 2, y + h / 2 * k1),
                            k3 = rate(t + h / 2, y + h / 2 * k2), k4 = rate(t + h, y + h * k3);
      y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    sag = -y[2];
    return y[0];  // slope at the clamp
  };
  double low = -std::numbers::pi / 2, high = 0, sag = 0;
  for (int i = 0; i < 60; ++i) {
    const double slope = (low + high) / 2;
    (shoot(slope, sag) < 0 ? low : high) = slope;
  }
  return sag;
}

/// Sag of a mesh over [0, 2 L] x [0, width]: two cantilevers back to back, held along the middle
/// line only, where symmetry keeps the slope at zero. (A clamp that holds a whole row of cells is
/// stiffer than a clamp at either line: curvature is constant up to the end of the mesh.)
double sag(ShellMesh mesh) {
  mesh.pattern.col(0).array() -= kLength;
  mesh.pattern.col(1).array() -= kWidth / 2;
  Sheet sheet;
  sheet.pattern = rectangle_pattern(2 * kLength, kWidth);
  sheet.imperfection = 0;
  sheet.material = beam();
  Handle line;
  line.name = "middle";
  line.segment = {{0, -kWidth / 2}, {0, kWidth / 2}};
  line.motion = Trajectory{{Keyframe{}}};
  sheet.handles.push_back(line);
  StepperOptions options;
  options.integration = Integration::newton;
  options.plasticity = false;
  options.newton_iterations = 200;
  ShellStepper stepper(sheet, options, 1);
  ShellState state = meshes::flat_state(mesh);
  stepper.set_mesh(state);
  sheets::advance(stepper, state, 1, 12);
  EXPECT_LT(stepper.energies(state).kinetic, 1e-12);
  double tip = 0;
  int count = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.pattern(v, 0) > kLength - 1e-9) {
      tip -= state.x(v, 2);
      ++count;
    }
  return tip / count;
}

TEST(Cantilever, OdeAgreesWithTheLinearBeamUnderALittleWeight) {
  EXPECT_NEAR(exact_sag(1, 1e-3), 1e-3 * std::pow(kLength, 4) / 8, 1e-12);
}

/// Second order: on half as many cells the error is four times as large. On `cells` and twice as
/// many it falls below 2e-3; by default on half of both, four times that.
void expect_second_order(const std::function<double(int)>& sag_of, int cells) {
  const PaperMaterial material = beam();
  const double exact = exact_sag(material.bending_stiffness(), material.area_density * 9.81);
  EXPECT_GT(exact, 0.4 * kLength);  // far from the linear beam
  const int n = test::at_length() ? cells : cells / 2;
  const double coarse = sag_of(n) / exact - 1, fine = sag_of(2 * n) / exact - 1;
  EXPECT_LT(std::abs(fine), test::at_length() ? 2e-3 : 8e-3);
  EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 2, 0.2) << coarse << " " << fine;
}

TEST(LongCantilever, SagConvergesWithSecondOrderOnStrips) {
  expect_second_order([](int n) { return sag(meshes::ruling_strips(n, 2 * kLength, kWidth)); }, 32);
}

TEST(LongCantilever, SagConvergesWithSecondOrderOnAnAlternatingGrid) {
  expect_second_order([](int n) { return sag(meshes::grid(n, n / 12, 2 * kLength, kWidth, true)); },
                      24);
}

}  // namespace
}  // namespace geoprior::paper
