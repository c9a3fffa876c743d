#include "models/sound/resonators/panel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "baselines/sound/modal/modal.h"
#include "baselines/sound/modal/operator.h"
#include "core/error.h"
#include "models/sound/resonators/shape.h"
#include "models/sound/voices/ring.h"

namespace geoprior::sound {
namespace {

double integral(const auto& f) {
  constexpr int kCount = 20000;
  double sum = 0;
  for (int i = 0; i < kCount; ++i) sum += f((i + 0.5) / kCount) / kCount;
  return sum;
}

TEST(BeamMode, SolvesTheBeamsEquationWithItsEnds) {
  using enum BeamEnds;
  for (const BeamEnds ends : {free_free, clamped_clamped, clamped_free}) {
    for (const int n : {0, 1, 2, 3, 6, 25, 39}) {
      const BeamMode mode(ends, n);
      const BeamMode other(ends, n + 1);
      EXPECT_NEAR(integral([&](double x) { return std::pow(mode.value(x), 2); }), 1, 2e-4);
      EXPECT_NEAR(integral([&](double x) { return mode.value(x) * other.value(x); }), 0, 2e-4);
      const double b = std::max(mode.beta(), 1.0);
      // Slope and bend are the derivatives of value and slope.
      const double h = 1e-6 / b, x = 0.37;
      EXPECT_NEAR((mode.value(x + h) - mode.value(x - h)) / (2 * h), mode.slope(x), 1e-6 * b);
      EXPECT_NEAR((mode.slope(x + h) - mode.slope(x - h)) / (2 * h), mode.bend(x), 1e-5 * b * b);
      for (const double end : {0.0, 1.0}) {
        const bool clamped = ends == clamped_clamped || (ends == clamped_free && end == 0);
        EXPECT_NEAR(clamped ? mode.value(end) : mode.bend(end) / (b * b), 0, 1e-7);
        if (clamped) {
          EXPECT_NEAR(mode.slope(end) / b, 0, 1e-7);
        }
      }
    }
  }
  // Blevins 1979, table 8-1.
  EXPECT_NEAR(BeamMode(clamped_free, 0).beta(), 1.87510407, 1e-8);
  EXPECT_NEAR(BeamMode(free_free, 2).beta(), 4.73004074, 1e-8);
}

TEST(SoundPanel, ClampedSquareRingsWhereThePlateDoes) {
  SoundPanel panel{.length = 0.03, .width = 0.03, .along = BeamEnds::clamped_clamped};
  panel.along_to = panel.across_to = 0.6;
  const PaperMaterial material;
  const std::vector<PanelMode> modes = panel_modes(panel, material, 1e-5, 16000, 400);
  ASSERT_FALSE(modes.empty());
  // 35.99 sqrt(D / rho_s) / (2 pi a^2), Leissa 1969; beam functions give 36.11.
  const double c = std::sqrt(material.bending_stiffness() / material.area_density);
  const double wanted = 35.99 * c / (2 * std::numbers::pi * 0.03 * 0.03);
  EXPECT_NEAR(modes[0].frequency, wanted, 0.005 * wanted);
}

TEST(SoundPanel, AFlipOfAllOfAStripStrikesSymmetricModesOfFreeEndsOnly) {
  // Free of creases, bent across: its turn at both ends is the same, so that odd modes get nothing.
  const SoundPanel panel{.length = 0.02, .width = 0.1, .across = BeamEnds::free_free};
  const PaperMaterial material;
  const std::vector<PanelMode> modes = panel_modes(panel, material, 1e-5, 3000, 400);
  const double c = std::sqrt(material.bending_stiffness() / material.area_density);
  double loudest = 0, energy = 0;
  for (const PanelMode& mode : modes) {
    if (mode.energy > energy) {
      energy = mode.energy;
      loudest = mode.frequency;
    }
  }
  EXPECT_NEAR(loudest, 22.373 * c / (2 * std::numbers::pi * 0.01), 0.01 * loudest);
  double odd = 0;
  for (const PanelMode& mode : modes) {
    const double second = 61.673 * c / (2 * std::numbers::pi * 0.01);
    if (std::abs(mode.frequency - second) < 0.001 * second) odd += mode.energy;
  }
  EXPECT_LT(odd, 1e-20 * energy);
}

TEST(SoundPanel, FrequenciesGoAsOneOverTheSquareOfTheSize) {
  const PaperMaterial material;
  const auto loudest = [&](double scale) {
    const SoundPanel panel{.length = 0.03 * scale, .width = 0.04 * scale};
    return panel_modes(panel, material, 1e-9, 1e5, 10).front().frequency;
  };
  EXPECT_NEAR(loudest(2), loudest(1) / 4, 1e-9 * loudest(1));
}

/// A flat rectangle of cells.
ResonatorShape flat_cells(int columns, int rows, double spacing) {
  ResonatorShape shape;
  shape.spacing = spacing;
  using Side = ResonatorShape::Side;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      ResonatorShape::Cell& cell = shape.cells.emplace_back();
      cell.column = c;
      cell.row = r;
      cell.place.setZero();
      cell.place.col(0) << spacing * (c + 0.5), spacing * (r + 0.5), 0;
      cell.place(0, 1) = cell.place(1, 2) = spacing;
      cell.sides = {c + 1 < columns ? Side::inside : Side::free,
                    r + 1 < rows ? Side::inside : Side::free, c > 0 ? Side::inside : Side::clamped,
                    r > 0 ? Side::inside : Side::free};
    }
  }
  return shape;
}

TEST(ResonatorShape, MeshCoversItsCellsAndIsClampedWhereTheyAre) {
  const ResonatorShape shape = flat_cells(5, 3, 2e-3);
  for (const int s : {1, 3}) {
    const ResonatorMesh mesh = mesh_of(shape, s);
    EXPECT_EQ(mesh.state.mesh.vertex_count(), (5 * s + 1) * (3 * s + 1));
    double area = 0;
    for (int t = 0; t < mesh.state.mesh.triangle_count(); ++t) {
      area += pattern_area(mesh.state.mesh, t);
      EXPECT_GT(pattern_area(mesh.state.mesh, t), 0);
    }
    EXPECT_NEAR(area, shape.area(), 1e-12);
    EXPECT_EQ(mesh.clamped.size(), static_cast<std::size_t>(3 * s));
    for (const Edge& edge : mesh.clamped) {
      for (const int v : edge) EXPECT_NEAR(mesh.state.x(v, 0), 0, 1e-15);
    }
  }
  EXPECT_THROW(mesh_of({}, 1), Error);
  EXPECT_THROW(mesh_of(shape, 0), Error);
}

TEST(ResonatorShape, SurvivesItsBytes) {
  const ResonatorShape shape = flat_cells(4, 2, 3e-3);
  StateWriter out;
  save(shape, out);
  const State bytes = out.take();
  StateReader in(bytes);
  const ResonatorShape back = load_resonator_shape(in);
  in.require_end();
  ASSERT_EQ(back.cells.size(), shape.cells.size());
  EXPECT_EQ(back.cells[5].place, shape.cells[5].place);
  EXPECT_EQ(back.cells[5].sides, shape.cells[5].sides);
}

TEST(ModalSound, ASmallSheetThatSwingsAsOneIsADipole) {
  // Pressure k F cos(theta) / (4 pi r): the mean of its square over the sphere is a third of that
  // at theta = 0. F of a stiff disc is 8/3 rho a^3 omega^2.
  const ResonatorMesh piece = mesh_of(flat_cells(4, 4, 1e-3), 1);
  Modes modes;
  modes.frequency = Eigen::VectorXd::Constant(1, 500.0);
  modes.shape = Eigen::MatrixXd::Zero(3 * piece.state.x.rows(), 1);
  for (Eigen::Index v = 0; v < piece.state.x.rows(); ++v) modes.shape(3 * v + 2, 0) = 1;
  const double omega = 2 * std::numbers::pi * 500, k = omega / 343;
  const double a = std::sqrt(16e-6 / std::numbers::pi);
  const double force = 8. / 3 * 1.204 * a * a * a * omega * omega;
  const double wanted = k / (4 * std::numbers::pi) * force / std::sqrt(3);
  EXPECT_NEAR(radiated_pressure(piece.state, modes, 500)[0], wanted, 2e-3 * wanted);
}

TEST(ModalSound, WavesOfAMeshAreThoseOfItsSine) {
  // sin(q x) over five half waves: the jump is that of the wave number q.
  const ResonatorMesh piece = mesh_of(flat_cells(50, 6, 1e-3), 1);
  Modes modes;
  modes.frequency = Eigen::VectorXd::Constant(1, 500.0);
  modes.shape = Eigen::MatrixXd::Zero(3 * piece.state.x.rows(), 1);
  const double q = 5 * std::numbers::pi / 0.05, omega = 2 * std::numbers::pi * 500;
  for (Eigen::Index v = 0; v < piece.state.x.rows(); ++v)
    modes.shape(3 * v + 2, 0) = std::sin(q * piece.state.x(v, 0));
  const double volume = 2 / q * 6e-3;  // of the one half wave that is left
  const double k = omega / 343;
  const double wanted = k / (4 * std::numbers::pi) * 2 * 1.204 * omega * omega /
                        std::sqrt(q * q - k * k) * volume / std::sqrt(3);
  EXPECT_NEAR(radiated_pressure(piece.state, modes, 500)[0], wanted, 0.03 * wanted);
}

/// What a bank says of a panel and what the shell says of the same piece of paper: one crease, all
/// of it flips. Two programs of the same rules, beam functions there, finite elements here; of the
/// modes that have next to no energy, where beam functions are no modes of a plate with free edges,
/// they say different things.
TEST(ModalSound, APanelOfTheBankRingsAndRadiatesAsItsMeshDoes) {
  const PaperMaterial material;
  constexpr int kColumns = 12, kRows = 8;
  constexpr double kCell = 2.5e-3, kTau = 2e-4, kHighest = 3000;
  const SoundPanel panel{.length = kRows * kCell,
                         .width = kColumns * kCell,
                         .along = BeamEnds::free_free,
                         .across = BeamEnds::clamped_free};
  const ResonatorMesh piece = mesh_of(flat_cells(kColumns, kRows, kCell), 4);
  const ModalSupports supports{piece.clamped, {}};
  const Modes modes = eigenmodes(material, piece.state, supports, {60, kHighest, {}});
  Eigen::MatrixX3d change = Eigen::MatrixX3d::Zero(piece.change.rows(), 3);
  change.col(0).setOnes();
  const ModalOperator shell(material, piece.state, supports, {});
  const Eigen::VectorXd force = modes.shape.transpose() * shell.curvature_load(change);
  const Eigen::VectorXd radiated = radiated_pressure(piece.state, modes, 400);
  const auto energy_of = [&](Eigen::Index m) {
    const double omega = 2 * std::numbers::pi * modes.frequency[m];
    return std::pow(force[m] / omega * pulse_spectrum(modes.frequency[m], kTau), 2) / 2;
  };
  double of_mesh = 0, of_panel = 0;
  for (Eigen::Index m = 0; m < modes.frequency.size(); ++m) of_mesh += energy_of(m);
  const std::vector<PanelMode> bank = panel_modes(panel, material, kTau, kHighest, 400);
  for (const PanelMode& mode : bank) of_panel += mode.energy;
  // Pressures of the bank are relative: the lowest mode sets their scale.
  double scale = 0;
  int compared = 0;
  for (const PanelMode& mode : bank) {
    constexpr double kHeard = 0.05;  // of the energy
    if (mode.energy < kHeard * of_panel) continue;
    Eigen::Index m = 0;
    for (Eigen::Index other = 0; other < modes.frequency.size(); ++other) {
      if (energy_of(other) < kHeard / 4 * of_mesh) continue;
      const double now = std::abs(std::log(modes.frequency[other] / mode.frequency));
      if (now < std::abs(std::log(modes.frequency[m] / mode.frequency))) m = other;
    }
    EXPECT_NEAR(modes.frequency[m], mode.frequency, 0.05 * mode.frequency);
    const double pressure = std::sqrt(2 * energy_of(m)) /
                            (2 * std::numbers::pi * modes.frequency[m]) * radiated[m] /
                            std::sqrt(of_mesh);
    const double wanted = mode.pressure / std::sqrt(of_panel);
    if (compared++ == 0) scale = pressure / wanted;
    EXPECT_NEAR(20 * std::log10(pressure / (scale * wanted)), 0, 1.5) << mode.frequency;
  }
  EXPECT_GE(compared, 2);
}

TEST(SoundPanel, BeingBentRaisesWhatWavesAlongTheRulings) {
  const PaperMaterial material;
  SoundPanel panel{.length = 0.03, .width = 0.04, .along = BeamEnds::clamped_clamped};
  const double flat = panel_modes(panel, material, 1e-5, 16000, 400).front().frequency;
  EXPECT_NEAR(lowest_frequency(panel, 4.73, 4.73, material), flat, 0.15 * flat);
  panel.bow = 15;
  const double bent = panel_modes(panel, material, 1e-5, 16000, 400).front().frequency;
  EXPECT_GT(bent, 2 * flat);
  EXPECT_NEAR(lowest_frequency(panel, 4.73, 4.73, material), bent, 0.15 * bent);
  // Rulings that stay straight do not feel it.
  panel.along = BeamEnds::free_free;
  const double free = panel_modes(panel, material, 1e-5, 16000, 400).front().frequency;
  panel.bow = 0;
  EXPECT_EQ(panel_modes(panel, material, 1e-5, 16000, 400).front().frequency, free);
}

}  // namespace
}  // namespace geoprior::sound
