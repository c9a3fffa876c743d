#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "metrics/isometry/elastica.h"
#include "tests/paper/meshes.h"
#include "tests/paper/sheets.h"

// The whole solver against Euler's elastica: a strip pushed end to end.
namespace geoprior::paper {
namespace {

constexpr double kStripLength = 0.2, kStripWidth = 0.05;

/// The strip bent so that its slope is phi cos(pi s / L), its ends `distance` apart: near the
/// elastica and free of strain, so that the solver starts in the right buckling mode.
Eigen::MatrixX3d arch(const Eigen::MatrixX2d& pattern, double distance) {
  constexpr int kSteps = 400;
  const auto point = [](double phi, double s) {
    Eigen::Vector2d p(0, 0);
    for (int i = 0; i < kSteps; ++i) {
      const double slope = phi * std::cos(std::numbers::pi * s / kStripLength * (i + 0.5) / kSteps);
      p += s / kSteps * Eigen::Vector2d(std::cos(slope), std::sin(slope));
    }
    return p;
  };
  double low = 0, high = 2;
  for (int i = 0; i < 50; ++i) {
    const double phi = (low + high) / 2;
    (point(phi, kStripLength).x() > distance ? low : high) = phi;
  }
  Eigen::MatrixX3d x(pattern.rows(), 3);
  for (Eigen::Index v = 0; v < pattern.rows(); ++v) {
    const Eigen::Vector2d p = point(low, pattern(v, 0) + kStripLength / 2);
    x.row(v) << p.x() - distance / 2, pattern(v, 1), p.y();
  }
  return x;
}

struct Bent {
  double height = 0;   ///< of the highest vertex (m)
  double bending = 0;  ///< J
};

/// Equilibrium of a strip of no Poisson's ratio (a beam) with pinned ends `distance` apart.
Bent push(ShellMesh mesh, double distance) {
  mesh.pattern.col(0).array() -= kStripLength / 2;
  mesh.pattern.col(1).array() -= kStripWidth / 2;
  Sheet sheet = sheets::free_sheet(kStripLength, kStripWidth);
  sheet.material.poisson_ratio = 0;
  for (const int side : {-1, 1}) {
    Handle end;
    end.name = side < 0 ? "left" : "right";
    end.segment = {{side * kStripLength / 2, -kStripWidth / 2},
                   {side * kStripLength / 2, kStripWidth / 2}};
    end.motion = Trajectory{{{.shift = {-side * (kStripLength - distance) / 2, 0, 0}}}};
    sheet.handles.push_back(end);
  }
  StepperOptions options;
  options.integration = Integration::newton;
  options.plasticity = false;
  options.newton_iterations = 200;
  ShellStepper stepper(sheet, options, 1);
  ShellState state = meshes::flat_state(mesh);
  state.x = arch(mesh.pattern, distance);
  stepper.set_mesh(state);
  // Implicit Euler with steps of many periods comes to rest.
  sheets::advance(stepper, state, 1, 12);
  EXPECT_LT(stepper.energies(state).kinetic, 1e-15);
  return {state.x.col(2).maxCoeff(), stepper.energies(state).bending};
}

/// Bending energy of the elastica: with k = sin(half the slope at the ends) and K, E the complete
/// elliptic integrals, D/2 int kappa^2 = 8 D K (E - (1 - k^2) K) / L for each metre of width.
double elastica_energy(double distance) {
  double low = 0, high = 0.95;
  for (int i = 0; i < 60; ++i) {
    const EllipticIntegrals e = elliptic_integrals((low + high) / 2);
    (2 * e.second / e.first - 1 > distance / kStripLength ? low : high) = (low + high) / 2;
  }
  const EllipticIntegrals e = elliptic_integrals(low);
  PaperMaterial material;
  material.poisson_ratio = 0;
  return material.bending_stiffness() * kStripWidth * 8 * e.first *
         (e.second - (1 - low * low) * e.first) / kStripLength;
}

// Second order: a polygon of equal edges stands for the curve.
TEST(Elastica, HeightConvergesWithSecondOrder) {
  using Maker = ShellMesh (*)(int);
  const std::vector<std::pair<std::string, Maker>> kinds = {
      {"strips", [](int n) { return meshes::ruling_strips(n, kStripLength, kStripWidth); }},
      {"grid", [](int n) { return meshes::grid(n, n / 4, kStripLength, kStripWidth, false); }},
      {"alternating grid",
       [](int n) { return meshes::grid(n, n / 4, kStripLength, kStripWidth, true); }}};
  for (const double ratio : {0.9, 0.7})
    for (const auto& [name, make] : kinds) {
      const double exact = elastica_height(kStripLength, ratio * kStripLength);
      const auto error = [&](int n) {
        return std::abs(push(make(n), ratio * kStripLength).height / exact - 1);
      };
      const double coarse = error(24), fine = error(48);
      EXPECT_LT(fine, 5e-4) << name << " at " << ratio;
      EXPECT_NEAR(std::log2(coarse / fine), 2, 0.2) << name << " at " << ratio;
    }
}

// A mesh that hid part of the bending in wiggles would have less, one that locks more.
TEST(Elastica, EnergyIsThatOfTheCurveOnStripsAndGrids) {
  const double exact = elastica_energy(0.7 * kStripLength);
  EXPECT_NEAR(
      push(meshes::ruling_strips(32, kStripLength, kStripWidth), 0.7 * kStripLength).bending, exact,
      1e-3 * exact);
  for (const bool alternating : {false, true})
    EXPECT_NEAR(
        push(meshes::grid(32, 8, kStripLength, kStripWidth, alternating), 0.7 * kStripLength)
            .bending,
        exact, 1e-3 * exact);
}

// Flat triangles whose edges are no rulings bend by stretching or by zigzags: at the thickness of
// paper an irregular mesh is stiffer than the plate, by 6 % at 32 edges a length, falling with the
// edge length. The height does not care.
TEST(Elastica, IrregularMeshesLockALittle) {
  const double exact = elastica_energy(0.7 * kStripLength);
  const Bent bent = push(meshes::delaunay(32, 8, kStripLength, kStripWidth, 3), 0.7 * kStripLength);
  EXPECT_NEAR(bent.height, elastica_height(kStripLength, 0.7 * kStripLength), 5e-3 * bent.height);
  EXPECT_GT(bent.bending, exact);
  EXPECT_LT(bent.bending, 1.08 * exact);
}

}  // namespace
}  // namespace geoprior::paper
