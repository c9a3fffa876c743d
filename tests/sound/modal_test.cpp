#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "baselines/sound/modal/eigenmodes.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "models/paper/shell/stepper.h"
#include "tests/paper/meshes.h"
#include "tests/paper/sheets.h"
#include "tests/paper/shell/plate_ritz.h"

// Eigenmodes of the dense shell against plates and panels whose frequencies are known.
namespace geoprior::sound {
namespace {

using ::testing::HasSubstr;

/// lambda = omega a^2 sqrt(rho_s / D) of frequencies of plates with side a.
Eigen::VectorXd parameters(const Eigen::VectorXd& frequency, const PaperMaterial& material,
                           double a) {
  return 2 * std::numbers::pi * a * a *
         std::sqrt(material.area_density / material.bending_stiffness()) * frequency;
}

/// Border edges with both ends at u = 0.
std::vector<Edge> left_edges(const ShellMesh& mesh) {
  std::vector<Edge> edges;
  for (const auto& [a, b] : boundary_edges(mesh.triangles)) {
    if (std::max(mesh.pattern(a, 0), mesh.pattern(b, 0)) < 1e-9) edges.push_back({a, b});
  }
  return edges;
}

ModalOptions lowest(int count) { return {.most = count}; }

Eigen::VectorXd free_frequencies(const ShellMesh& mesh, int count) {
  return eigenmodes({}, paper::meshes::flat_state(mesh), {}, lowest(count)).frequency;
}

/// Panel whose rulings run along u, on a cylinder of curvature `kappa`.
ShellState rolled_state(const ShellMesh& mesh, double kappa) {
  ShellState state = paper::meshes::flat_state(mesh);
  state.x = paper::meshes::rolled(mesh.pattern, kappa, std::numbers::pi / 2);
  return state;
}

double largest_error(const Eigen::VectorXd& found, const Eigen::VectorXd& exact) {
  return (found.array() / exact.head(found.size()).array() - 1).abs().maxCoeff();
}

void expect_second_order(const std::string& name, const Eigen::VectorXd& coarse,
                         const Eigen::VectorXd& fine, const Eigen::VectorXd& exact) {
  for (Eigen::Index i = 0; i < coarse.size(); ++i) {
    EXPECT_NEAR(std::log2(std::abs(coarse[i] - exact[i]) / std::abs(fine[i] - exact[i])), 2, 0.3)
        << name << ", mode " << i;
  }
}

constexpr double kSide = 0.1;

// NAFEMS FV12 (R0015) gives 1.622, 2.360 and 2.922 Hz for a = 10 m, h = 0.05 m, E = 200 GPa, rho =
// 8000 kg/m^3. Barton 1951 and Leissa 1973a have 13.49, 19.79, 24.43, 35.02 free and 3.492, 8.525,
// 21.43, 27.33, 31.11, 54.44 clamped at one side: Ritz values in beam functions, so upper bounds,
// up to 1 % above ours.
TEST(PlateRitz, AgreesWithPublishedPlates) {
  PaperMaterial steel;
  steel.thickness = 0.05;
  steel.young_modulus = 200e9;
  steel.area_density = 8000 * steel.thickness;
  const Eigen::VectorXd free = paper::ritz::plate(steel, 10, 10, false, 10);
  EXPECT_NEAR(free[0], 1.622, 5e-4);
  EXPECT_NEAR(free[1], 2.360, 1e-3);
  EXPECT_NEAR(free[2], 2.922, 5e-4);
  const Eigen::Vector4d leissa(13.49, 19.79, 24.43, 35.02);
  const Eigen::VectorXd lambda = parameters(free, steel, 10);
  const Eigen::VectorXd clamped = parameters(paper::ritz::plate(steel, 10, 10, true, 6), steel, 10);
  Eigen::VectorXd barton(6);
  barton << 3.492, 8.525, 21.43, 27.33, 31.11, 54.44;
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT(lambda[i], leissa[i]);
    EXPECT_GT(lambda[i], 0.99 * leissa[i]);
  }
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(clamped[i], barton[i]);
    EXPECT_GT(clamped[i], 0.99 * barton[i]);
  }
  // More polynomials change nothing.
  EXPECT_LT(largest_error(paper::ritz::plate(steel, 10, 10, false, 10, 17), free), 1e-6);
}

// A panel that is all but flat is a plate.
TEST(PlateRitz, PanelWithoutCurvatureIsAPlate) {
  EXPECT_LT(largest_error(paper::ritz::panel({}, 0.04, 0.04, 1e-3, 6),
                          paper::ritz::plate({}, 0.04, 0.04, false, 6)),
            1e-5);
}

TEST(Modes, FreeSquareHasThePublishedFrequencies) {
  const Eigen::VectorXd exact = paper::ritz::plate({}, kSide, kSide, false, 10);
  for (const bool random : {false, true}) {
    const int n = 36;
    const ShellMesh mesh = random ? paper::meshes::delaunay(n, n, kSide, kSide)
                                  : paper::meshes::grid(n, n, kSide, kSide, true);
    const Eigen::VectorXd found = free_frequencies(mesh, 10);
    EXPECT_LT(largest_error(found, exact), 0.01);
    EXPECT_NEAR(parameters(found, {}, kSide)[0], 13.49, 0.0135 * 13.49 / 3);
  }
}

TEST(Modes, FrequenciesOfTheFreeSquareConvergeWithSecondOrder) {
  const Eigen::VectorXd exact = paper::ritz::plate({}, kSide, kSide, false, 10);
  for (const bool alternating : {false, true}) {
    const auto found = [&](int n) {
      return free_frequencies(paper::meshes::grid(n, n, kSide, kSide, alternating), 10);
    };
    expect_second_order("free", found(14), found(28), exact);
  }
}

TEST(Modes, ClampedEdgeNeitherMovesNorTurns) {
  const Eigen::VectorXd exact = paper::ritz::plate({}, kSide, kSide, true, 6);
  const auto found = [&](const ShellMesh& mesh) {
    return eigenmodes({}, paper::meshes::flat_state(mesh), {.clamped = left_edges(mesh)}, lowest(6))
        .frequency;
  };
  const Eigen::VectorXd fine = found(paper::meshes::grid(32, 32, kSide, kSide, true));
  EXPECT_LT(largest_error(fine, exact), 0.01);
  expect_second_order("clamped", found(paper::meshes::grid(16, 16, kSide, kSide, true)), fine,
                      exact);
  EXPECT_LT(largest_error(found(paper::meshes::delaunay(32, 32, kSide, kSide)), exact), 0.01);
}

// f = pi/2 sqrt(D / rho_s) (m^2 / a^2 + n^2 / b^2).
TEST(Modes, HeldNormalsAreSimplySupported) {
  const PaperMaterial material;
  const double a = 0.02, b = 0.03;
  const ShellMesh mesh = paper::meshes::grid(32, 48, a, b, true);
  ModalSupports supports;
  const std::vector<bool> border = boundary_vertices(mesh.triangles, mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (border[v]) supports.holds.push_back({v, {0, 0, 2}});
  }
  std::vector<double> exact;
  for (int m = 1; m < 6; ++m)
    for (int n = 1; n < 6; ++n)
      exact.push_back(std::numbers::pi / 2 *
                      std::sqrt(material.bending_stiffness() / material.area_density) *
                      (m * m / (a * a) + n * n / (b * b)));
  std::sort(exact.begin(), exact.end());
  const Modes modes = eigenmodes(material, paper::meshes::flat_state(mesh), supports, lowest(6));
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(modes.frequency[i] / exact[i], 1, 0.01);
}

// omega ~ h / a^2 sqrt(E / rho): thickness at constant density of the material, so rho_s ~ h.
TEST(Modes, FrequenciesScaleAsThicknessOverAreaAndNothingElse) {
  const ShellMesh mesh = paper::meshes::delaunay(7, 6, 0.03, 0.025);
  const Eigen::VectorXd one = free_frequencies(mesh, 6);
  PaperMaterial card;
  card.thickness *= 3;
  card.area_density *= 3;
  EXPECT_LT(
      largest_error(eigenmodes(card, paper::meshes::flat_state(mesh), {}, lowest(6)).frequency,
                    3 * one),
      1e-7);
  ShellMesh larger = mesh;
  larger.pattern *= 2;
  EXPECT_LT(largest_error(free_frequencies(larger, 6), one / 4), 1e-7);
  PaperMaterial stiff;
  stiff.young_modulus *= 4;
  EXPECT_LT(
      largest_error(eigenmodes(stiff, paper::meshes::flat_state(mesh), {}, lowest(6)).frequency,
                    2 * one),
      1e-7);
  // Placed elsewhere in space and turned.
  ShellState moved = paper::meshes::flat_state(mesh);
  moved.x =
      (moved.x * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix()).rowwise() +
      Eigen::RowVector3d(0.1, -0.2, 0.3);
  EXPECT_LT(largest_error(eigenmodes({}, moved, {}, lowest(6)).frequency, one), 1e-7);
}

Eigen::VectorXd masses_by_component(const Modes& modes) {
  Eigen::VectorXd mass(3 * modes.mass.size());
  for (Eigen::Index v = 0; v < modes.mass.size(); ++v)
    mass.segment<3>(3 * v).setConstant(modes.mass[v]);
  return mass;
}

TEST(Modes, ShapesAreMassOrthonormalAndNotRigid) {
  const ShellMesh mesh = paper::meshes::grid(12, 12, 0.03, 0.03, true);
  for (const double kappa : {1e-9, 20.0}) {
    const Modes modes = eigenmodes({}, rolled_state(mesh, kappa), {}, lowest(60));
    const Eigen::VectorXd mass = masses_by_component(modes);
    const Eigen::MatrixXd gram = modes.shape.transpose() * mass.asDiagonal() * modes.shape;
    EXPECT_LT((gram - Eigen::MatrixXd::Identity(60, 60)).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_NEAR(mass.sum(), 3 * 0.08 * 0.03 * 0.03, 1e-12);
    // No momentum: orthogonal to translations.
    for (int k = 0; k < 60; ++k) {
      const Eigen::VectorXd weighted = mass.cwiseProduct(modes.shape.col(k));
      const Eigen::Map<const Eigen::Matrix3Xd> by_vertex(weighted.data(), 3, modes.mass.size());
      EXPECT_LT(by_vertex.rowwise().sum().norm(), 1e-9 * std::sqrt(mass.sum()));
    }
    EXPECT_GT(modes.frequency[0], 100);
    EXPECT_TRUE(std::is_sorted(modes.frequency.begin(), modes.frequency.end()));
  }
}

// The forces of the dense solver, differentiated along a shape: f'(x) phi = -omega^2 M phi.
TEST(Modes, AreThoseOfTheDenseSolversForces) {
  Sheet sheet = paper::sheets::free_sheet(0.04, 0.03);
  const ShellState rest = paper::sheets::at_rest(sheet, 150, paper::UniformLayout::delaunay);
  paper::ShellStepper stepper(sheet, {}, 1);
  stepper.set_mesh(rest);
  const Modes modes = eigenmodes(sheet.material, rest, {}, lowest(12));
  const auto forces = [&](Eigen::Index k, double amount) {
    ShellState moved = rest;
    for (Eigen::Index v = 0; v < moved.x.rows(); ++v)
      moved.x.row(v) += amount * modes.shape.col(k).segment<3>(3 * v).transpose();
    return stepper.elastic_forces(moved);
  };
  for (Eigen::Index k = 0; k < 12; ++k) {
    const double step = 1e-9 / modes.shape.col(k).cwiseAbs().maxCoeff();
    const Eigen::MatrixX3d rate = (forces(k, step) - forces(k, -step)) / (2 * step);
    const double square = std::pow(2 * std::numbers::pi * modes.frequency[k], 2);
    Eigen::MatrixX3d inertia(rate.rows(), 3);
    for (Eigen::Index v = 0; v < rate.rows(); ++v)
      inertia.row(v) = square * modes.mass[v] * modes.shape.col(k).segment<3>(3 * v).transpose();
    EXPECT_LT((rate + inertia).norm(), 1e-3 * inertia.norm()) << k;
  }
}

// The first three modes of a panel bend it without stretching it and do not feel twice the
// curvature; those that bend its rulings rise with it.
TEST(Modes, CylindricalPanelHasTheFrequenciesOfKoitersShell) {
  const double a = 0.04;
  const Eigen::VectorXd slightly = paper::ritz::panel({}, a, a, 10, 7);
  const Eigen::VectorXd strongly = paper::ritz::panel({}, a, a, 20, 7);
  EXPECT_LT(largest_error(strongly.head(3), slightly), 0.02);
  EXPECT_GT(strongly[5], 1.25 * slightly[5]);
  const auto found = [&](double kappa) {
    const ShellMesh mesh = paper::meshes::grid(40, 40, a, a, true);
    return eigenmodes({}, rolled_state(mesh, kappa), {}, lowest(7)).frequency;
  };
  EXPECT_LT(largest_error(found(10), slightly), 0.01);
  EXPECT_LT(largest_error(found(20), strongly), 0.01);
}

// Held along the border as a shallow shell on shear diaphragms (Donnell; Leissa 1973b,
// Vibration of Shells): rho_s omega^2 = D k^4 + E h kappa^2 (k_m / k)^4, k_m along the rulings. The
// shell's own theory differs by (kappa / k)^2.
TEST(Modes, CurvedFacetIsStiffenedAsDonnellSays) {
  const PaperMaterial material;
  const double a = 0.03, b = 0.02, kappa = 10;
  const ShellMesh mesh = paper::meshes::grid(42, 28, a, b, true);
  const ShellState state = rolled_state(mesh, kappa);
  ModalSupports supports;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double u = mesh.pattern(v, 0), s = mesh.pattern(v, 1);
    const Eigen::Vector3d ruling(1, 0, 0), arc(0, std::cos(kappa * s), std::sin(kappa * s));
    const bool across = std::min(u, a - u) < 1e-9, along = std::min(s, b - s) < 1e-9;
    if (across || along) supports.holds.push_back({v, ruling.cross(arc)});
    if (across) supports.holds.push_back({v, arc});
    if (along) supports.holds.push_back({v, ruling});
  }
  const auto donnell = [&](int m, int n, double curvature) {
    const double km = m * std::numbers::pi / a, kn = n * std::numbers::pi / b;
    const double k2 = km * km + kn * kn;
    return std::sqrt((material.bending_stiffness() * k2 * k2 +
                      material.young_modulus * material.thickness * curvature * curvature *
                          std::pow(km * km / k2, 2)) /
                     material.area_density) /
           (2 * std::numbers::pi);
  };
  const Modes modes = eigenmodes(material, state, supports, lowest(3));
  // (1, 2), (1, 1) and (2, 2); the facet (1, 1) would ring at 389 Hz were it flat.
  EXPECT_LT(donnell(1, 1, 0), 0.4 * donnell(1, 1, kappa));
  Eigen::Vector3d exact(donnell(1, 1, kappa), donnell(1, 2, kappa), donnell(2, 2, kappa));
  std::sort(exact.begin(), exact.end());
  EXPECT_LT(largest_error(modes.frequency, exact), 0.01);
}

// The rest shape is taken to be the shape: curvature that has become plastic changes nothing.
TEST(Modes, DoNotDependOnTheRestCurvature) {
  const ShellMesh mesh = paper::meshes::delaunay(8, 8, 0.03, 0.03);
  const ShellState bent = rolled_state(mesh, 20);
  ShellState creased = bent;
  creased.plastic_curvature.col(2).setConstant(20);
  EXPECT_EQ(eigenmodes({}, bent, {}, lowest(5)).frequency,
            eigenmodes({}, creased, {}, lowest(5)).frequency);
}

TEST(Modes, BelowAFrequencyAreAllOfThem) {
  const ShellMesh mesh = paper::meshes::grid(14, 14, 0.03, 0.03, true);
  const ShellState state = paper::meshes::flat_state(mesh);
  const Modes many = eigenmodes({}, state, {}, lowest(40));
  const double between = (many.frequency[24] + many.frequency[25]) / 2;
  const Modes below = eigenmodes({}, state, {}, {.most = 40, .up_to = between});
  ASSERT_EQ(below.frequency.size(), 25);
  EXPECT_LT(largest_error(below.frequency, many.frequency), 1e-7);
  EXPECT_EQ(eigenmodes({}, state, {}, {.most = 5, .up_to = between}).frequency.size(), 5);
  EXPECT_EQ(eigenmodes({}, state, {}, {.most = 5, .up_to = 1.0}).frequency.size(), 0);
}

// Lanczos' method and the dense solver, on either side of their threshold.
TEST(Modes, SparseAndDenseSolversAgree) {
  const ShellMesh mesh = paper::meshes::grid(10, 10, 0.03, 0.03, true);
  const ShellState state = rolled_state(mesh, 10);
  const int all = 3 * mesh.vertex_count() - 6;
  const Eigen::VectorXd dense = eigenmodes({}, state, {}, lowest(all)).frequency;
  EXPECT_LT(largest_error(eigenmodes({}, state, {}, lowest(50)).frequency, dense), 1e-7);
}

// Rigid motions that the supports leave are not among the modes: the sheet hung up along a line
// turns about it.
TEST(Modes, LeaveOutTheSwingOfASheetHungAlongALine) {
  const ShellMesh mesh = paper::meshes::grid(10, 10, 0.03, 0.03, true);
  const ShellState state = paper::meshes::flat_state(mesh);
  ModalSupports supports;
  for (const auto& [a, b] : left_edges(mesh)) {
    for (const int v : {a, b})
      for (int c = 0; c < 3; ++c) supports.holds.push_back({v, Eigen::Vector3d::Unit(c)});
  }
  // Plate with one side simply supported, three free: 6.648 (Leissa 1973a, SFFF).
  const Eigen::VectorXd found = eigenmodes({}, state, supports, lowest(3)).frequency;
  EXPECT_NEAR(parameters(found, {}, 0.03)[0], 6.648, 0.1);
}

TEST(Modes, AreTheSameAtAnyThreadCount) {
  const ShellState state = rolled_state(paper::meshes::delaunay(12, 12, 0.03, 0.03), 15);
  Modes one, two;
  with_threads(1, [&] { one = eigenmodes({}, state, {}, lowest(20)); });
  with_threads(2, [&] { two = eigenmodes({}, state, {}, lowest(20)); });
  EXPECT_EQ(one.frequency, two.frequency);
  EXPECT_EQ(one.shape, two.shape);
}

TEST(Modes, ResolvedFrequencyIsThatOfAWaveOfEightEdges) {
  const ShellMesh mesh = paper::meshes::equilateral(6, 6, 0.002);
  const PaperMaterial material;
  const double k = 2 * std::numbers::pi / 0.016;
  EXPECT_NEAR(resolved_frequency(material, mesh),
              k * k / (2 * std::numbers::pi) *
                  std::sqrt(material.bending_stiffness() / material.area_density),
              1e-6);
}

std::string refusal(const ShellState& state, const ModalSupports& supports = {}, int most = 3,
                    const PaperMaterial& material = {}) {
  try {
    eigenmodes(material, state, supports, lowest(most));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Modes, RefuseWhatIsNoSheet) {
  const ShellMesh mesh = paper::meshes::grid(2, 2, 0.02, 0.02, true);
  const ShellState good = paper::meshes::flat_state(mesh);
  EXPECT_EQ(refusal(good), "no error");
  EXPECT_THAT(refusal(ShellState{}), HasSubstr("has no triangles"));
  ShellState state = good;
  state.x(4, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(state), HasSubstr("vertex 4: place is not finite"));
  state = good;
  state.damage[2] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(state), HasSubstr("damage is not finite"));
  state = good;
  state.mesh.triangles(3, 0) = 9;
  EXPECT_THAT(refusal(state), HasSubstr("triangle 3: names a vertex that is not there"));
  state = good;
  state.x.conservativeResize(8, 3);
  EXPECT_THAT(refusal(state), HasSubstr("places of the vertices: has 8 rows (allowed: 9)"));
  state = good;
  state.mesh.triangles.row(5).reverseInPlace();
  EXPECT_THAT(refusal(state), HasSubstr("triangle 5"));
  state = good;
  state.mesh.triangles = good.mesh.triangles(std::vector<int>{0, 7}, Eigen::all);
  state.damage.conservativeResize(2);
  state.plastic_curvature.conservativeResize(2, 3);
  EXPECT_THAT(refusal(state), HasSubstr("2 parts"));
  PaperMaterial material;
  material.thickness = 0;
  EXPECT_THAT(refusal(good, {}, 3, material), HasSubstr("material.thickness"));
}

TEST(Modes, RefuseMoreThanTheMeshHasAndSupportsThatAreNone) {
  const ShellMesh mesh = paper::meshes::grid(2, 2, 0.02, 0.02, true);
  const ShellState state = paper::meshes::flat_state(mesh);
  EXPECT_EQ(refusal(state, {}, 21), "no error");
  EXPECT_THAT(refusal(state, {}, 22),
              HasSubstr("22 modes are asked for of a mesh with 9 vertices (allowed: at most 21)"));
  EXPECT_THAT(refusal(state, {}, 0), HasSubstr("most: 0 modes"));
  EXPECT_THAT(refusal(state, {.clamped = {{0, 4}}}), HasSubstr("edge 0-4: clamped edge does not"));
  EXPECT_THAT(refusal(state, {.holds = {{9, {0, 0, 1}}}}), HasSubstr("hold 0: names a vertex"));
  EXPECT_THAT(refusal(state, {.holds = {{1, {0, 0, 0}}}}), HasSubstr("hold 0: has no direction"));
  ModalSupports all;
  for (int v = 0; v < 9; ++v)
    for (int c = 0; c < 3; ++c) all.holds.push_back({v, Eigen::Vector3d::Unit(c)});
  EXPECT_THAT(refusal(state, all), HasSubstr("every vertex is held"));
}

}  // namespace
}  // namespace geoprior::sound
