#include "models/paper/shell/elements.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "tests/paper/meshes.h"

namespace geoprior::paper {
namespace {

using Order = ShellElements::Order;
using meshes::flat_state;

/// Membrane and bending of like size on a mesh of edges of a tenth, so that each is seen.
PaperMaterial thick() {
  PaperMaterial material;
  material.thickness = 0.1;
  material.young_modulus = 10;
  return material;
}

struct Assembled {
  double membrane = 0, bending = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

Assembled assemble(const ShellElements& elements, const ShellState& state,
                   const Eigen::MatrixX3d& x, Order order) {
  const Eigen::Index n = 3 * x.rows();
  Assembled sum;
  sum.gradient = Eigen::VectorXd::Zero(n);
  if (order == Order::hessian) sum.hessian = Eigen::MatrixXd::Zero(n, n);
  ShellElements::Local local;
  for (int e = 0; e < elements.size(); ++e) {
    elements.evaluate(e, state, x, order, local);
    sum.membrane += local.membrane;
    sum.bending += local.bending;
    if (order == Order::energy) continue;
    const auto nodes = elements.nodes(e);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Eigen::Index row = 3 * i;
      sum.gradient.segment<3>(3 * nodes[i]) += local.gradient.segment<3>(row);
      if (order != Order::hessian) continue;
      for (std::size_t j = 0; j < nodes.size(); ++j)
        sum.hessian.block<3, 3>(3 * nodes[i], 3 * nodes[j]) +=
            local.hessian.block<3, 3>(row, 3 * j);
    }
  }
  return sum;
}

/// Rolled on a cylinder, then every vertex moved by up to `noise`.
Eigen::MatrixX3d crumpled(const ShellMesh& mesh, double noise, std::uint64_t seed) {
  Eigen::MatrixX3d x = meshes::rolled(mesh.pattern, 1.5, 0.4);
  RandomStream random(seed, "crumpled");
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += noise * (2 * random.uniform() - 1);
  return x;
}

void randomise_memory(ShellState& state, std::uint64_t seed) {
  RandomStream random(seed, "memory");
  for (Eigen::Index i = 0; i < state.plastic_curvature.size(); ++i)
    state.plastic_curvature.data()[i] = random.normal();
  for (Eigen::Index i = 0; i < state.damage.size(); ++i) state.damage[i] = random.uniform();
}

struct Kind {
  std::string name;
  ShellMesh mesh;
  BendingModel model;
};

std::vector<Kind> small_sheets() {
  std::vector<Kind> kinds;
  for (const BendingModel model : {BendingModel::shape_operator, BendingModel::hinge}) {
    const std::string by = model == BendingModel::hinge ? " (hinge)" : "";
    kinds.push_back({"grid" + by, meshes::grid(3, 3, 0.3, 0.3, false), model});
    kinds.push_back({"equilateral" + by, meshes::equilateral(3, 4, 0.1), model});
    kinds.push_back({"Delaunay" + by, meshes::delaunay(4, 4, 0.4, 0.4, 2), model});
    kinds.push_back({"strips" + by, meshes::ruling_strips(4, 0.4, 0.3, 0.3), model});
    kinds.push_back({"cone" + by, meshes::cone_strips(4, 0.1, 0.4, 1.2), model});
  }
  return kinds;
}

/// Derivative along unit vector i by central differences.
template <class Function>
auto difference(const Function& f, Eigen::MatrixX3d x, Eigen::Index i, double step) {
  // Degrees of freedom run vertex by vertex.
  double& value = x(i / 3, i % 3);
  const double at = value;
  value = at + step;
  const auto after = f(x);
  value = at - step;
  const auto before = f(x);
  return decltype(after)((after - before) / (2 * step));
}

TEST(ShellElements, GradientsAreDerivativesOfTheEnergies) {
  for (const auto& [name, mesh, model] : small_sheets()) {
    PaperMaterial material = thick();
    material.weakening = 2;
    const ShellElements elements(mesh, material, BendingLaw{model});
    ShellState state = flat_state(mesh);
    randomise_memory(state, 3);
    for (const std::uint64_t seed : {1, 2, 3}) {
      const Eigen::MatrixX3d x = crumpled(mesh, 0.03, seed);
      const Assembled at = assemble(elements, state, x, Order::gradient);
      const double typical = at.gradient.cwiseAbs().maxCoeff();
      for (Eigen::Index i = 0; i < at.gradient.size(); ++i) {
        const auto energy = [&](const Eigen::MatrixX3d& y) {
          const Assembled a = assemble(elements, state, y, Order::energy);
          return a.membrane + a.bending;
        };
        EXPECT_NEAR(at.gradient[i], difference(energy, x, i, 1e-6), 1e-7 * typical) << name;
      }
    }
  }
}

/// Membrane energy of the header: A Y/2 [(1-nu) |G|^2 + nu tr(G)^2], G = (F'F - I) / 2.
double membrane_energy(const ShellMesh& mesh, const PaperMaterial& material, int t, double area,
                       const Eigen::MatrixX3d& x) {
  const Eigen::RowVector3i v = mesh.triangles.row(t);
  Eigen::Matrix2d flat;
  Eigen::Matrix<double, 3, 2> bent;
  for (int k = 0; k < 2; ++k) {
    flat.col(k) = mesh.pattern.row(v[k + 1]) - mesh.pattern.row(v[0]);
    bent.col(k) = x.row(v[k + 1]) - x.row(v[0]);
  }
  const Eigen::Matrix<double, 3, 2> F = bent * flat.inverse();
  const Eigen::Matrix2d G = 0.5 * (F.transpose() * F - Eigen::Matrix2d::Identity());
  const double nu = material.poisson_ratio;
  return area * material.membrane_stiffness() / 2 *
         ((1 - nu) * G.squaredNorm() + nu * G.trace() * G.trace());
}

/// Bending energy of the header, of an element without residual:
/// A D/2 [(1-nu) |S|^2 + nu tr(S)^2] / (1 + weakening damage), S the elastic shape operator.
double plate_energy(const PaperMaterial& material, double area, const Eigen::Vector3d& S,
                    double damage) {
  const double nu = material.poisson_ratio, trace = S[0] + S[2];
  const double square = S[0] * S[0] + 2 * S[1] * S[1] + S[2] * S[2];
  return area * material.bending_stiffness() / 2 * ((1 - nu) * square + nu * trace * trace) /
         (1 + material.weakening * damage);
}

/// Half of the header's energy of the hinges at a triangle, calibration 4.
double hinge_energy(const CurvatureFit& fit, const ShellMesh& mesh, const PaperMaterial& material,
                    int t, const ShellState& state, const Eigen::MatrixX3d& x) {
  double sum = 0;
  for (int i = 0; i < fit.own[t]; ++i) {
    const CurvatureFit::Hinge& h = fit.hinges[fit.terms[t][i].hinge];
    const double l2 = (mesh.pattern.row(h.b) - mesh.pattern.row(h.a)).squaredNorm();
    const double bent = dihedral_angle(x, h) - h.jump.dot(state.plastic_curvature.row(t));
    sum += 4 * material.bending_stiffness() / 4 * l2 / (fit.area[h.left] + fit.area[h.right]) *
           bent * bent / 2 / 2;
  }
  return sum / (1 + material.weakening * state.damage[t]);
}

TEST(ShellElements, EnergiesAreTheFormulasOfTheHeader) {
  PaperMaterial material = thick();
  material.weakening = 2;
  int plates = 0;
  for (const auto& [name, mesh, model] : small_sheets()) {
    const ShellElements elements(mesh, material, BendingLaw{model});
    const CurvatureFit& fit = elements.curvature_fit();
    ShellState state = flat_state(mesh);
    randomise_memory(state, 3);
    const Eigen::MatrixX3d x = crumpled(mesh, 0.03, 1);
    ShellElements::Local local;
    for (int t = 0; t < elements.size(); ++t) {
      elements.evaluate(t, state, x, Order::energy, local);
      const double membrane = membrane_energy(mesh, material, t, fit.area[t], x);
      EXPECT_NEAR(local.membrane, membrane, 1e-12 * membrane) << name << t;
      double bending = local.bending;
      if (model == BendingModel::hinge) {
        bending = hinge_energy(fit, mesh, material, t, state, x);
      } else if (fit.own[t] == 3 && fit.rank[t] == 3) {
        ++plates;
        bending = plate_energy(material, fit.area[t], elements.elastic_curvature(t, state, x),
                               state.damage[t]);
      }
      EXPECT_NEAR(local.bending, bending, 1e-12 * bending) << name << t;
    }
  }
  EXPECT_GT(plates, 10);
}

/// Largest difference between the Hessian and the differences of gradients, relative.
double hessian_error(const ShellElements& elements, const ShellState& state,
                     const Eigen::MatrixX3d& x) {
  const Assembled at = assemble(elements, state, x, Order::hessian);
  Eigen::MatrixXd differences(at.hessian.rows(), at.hessian.cols());
  const auto gradient = [&](const Eigen::MatrixX3d& y) -> Eigen::VectorXd {
    return assemble(elements, state, y, Order::gradient).gradient;
  };
  for (Eigen::Index i = 0; i < differences.cols(); ++i)
    differences.col(i) = difference(gradient, x, i, 1e-6);
  return (at.hessian - differences).cwiseAbs().maxCoeff() / at.hessian.cwiseAbs().maxCoeff();
}

TEST(ShellElements, HessianIsExactAtRest) {
  for (const auto& [name, mesh, model] : small_sheets()) {
    const ShellState state = flat_state(mesh);
    EXPECT_LT(hessian_error(ShellElements(mesh, thick(), BendingLaw{model}), state, state.x), 1e-7)
        << name;
  }
}

TEST(ShellElements, MembraneHessianIsExactInTension) {
  Eigen::MatrixX2d pattern(3, 2);
  pattern << 0, 0, 1, 0.1, 0.3, 0.8;
  const ShellMesh mesh{pattern, Eigen::RowVector3i(0, 1, 2)};
  const ShellElements elements(mesh, thick(), BendingLaw());
  Eigen::MatrixX3d x(3, 3);
  x << 0.1, 0, 0, 1.2, 0.3, 0.4, 0.2, 1.1, -0.3;
  EXPECT_LT(hessian_error(elements, flat_state(mesh), x), 1e-8);
  // … and not in compression, where the true one is indefinite.
  EXPECT_GT(hessian_error(elements, flat_state(mesh), 0.5 * x), 0.1);
}

// An infinitesimal rotation strains nothing, but turns the tension.
TEST(ShellElements, MaterialHessianKnowsNoTension) {
  Eigen::MatrixX2d pattern(3, 2);
  pattern << 0, 0, 1, 0.1, 0.3, 0.8;
  const ShellMesh mesh{pattern, Eigen::RowVector3i(0, 1, 2)};
  const ShellElements elements(mesh, thick(), BendingLaw());
  const ShellState state = flat_state(mesh);
  const Eigen::MatrixX3d x = 1.1 * state.x;
  Eigen::Matrix<double, 9, 1> turned;
  for (int k = 0; k < 3; ++k)
    turned.segment<3>(3 * k) =
        Eigen::Vector3d(1, 2, 3).cross(Eigen::Vector3d(x.row(k).transpose()));
  const auto turning = [&](ShellElements::Order order) {
    ShellElements::Local local;
    elements.evaluate(0, state, x, order, local);
    return turned.dot(local.hessian.topLeftCorner<9, 9>() * turned) /
           (turned.squaredNorm() * local.hessian.topLeftCorner<9, 9>().norm());
  };
  EXPECT_NEAR(turning(Order::material_hessian), 0, 1e-14);
  EXPECT_GT(turning(Order::hessian), 1e-2);
}

// Gauss-Newton drops moment times second derivative: nothing where the moments vanish.
TEST(ShellElements, BendingHessianIsExactWhereTheSheetIsBentWithoutMoment) {
  const ShellMesh mesh = meshes::equilateral(4, 5, 0.1);
  PaperMaterial material = thick();
  material.thickness = 1e3;  // bending outweighs the membrane by 1e8
  const ShellElements elements(mesh, material, BendingLaw());
  ShellState state = flat_state(mesh);
  // Constant curvature on a mesh of congruent triangles: no residual of the fit either.
  const Eigen::MatrixX3d x = meshes::rolled(mesh.pattern, 2, 0);
  for (int e = 0; e < elements.size(); ++e)
    state.plastic_curvature.row(e) = elements.elastic_curvature(e, state, x);
  const Assembled at = assemble(elements, state, x, Order::energy);
  const Assembled unrolled = assemble(elements, state, state.x, Order::energy);
  EXPECT_LT(at.bending, 1e-4 * unrolled.bending);
  EXPECT_LT(hessian_error(elements, state, x), 1e-2);
}

TEST(ShellElements, HessianIsPositiveSemidefinite) {
  for (const auto& [name, mesh, model] : small_sheets()) {
    const ShellElements elements(mesh, thick(), BendingLaw{model});
    ShellState state = flat_state(mesh);
    randomise_memory(state, 4);
    const Eigen::MatrixX3d x = crumpled(mesh, 0.05, 7);
    ShellElements::Local local;
    for (int e = 0; e < elements.size(); ++e) {
      elements.evaluate(e, state, x, Order::hessian, local);
      const Eigen::Index n = 3 * elements.nodes(e).size();
      const Eigen::MatrixXd H = local.hessian.topLeftCorner(n, n);
      EXPECT_LT((H - H.transpose()).cwiseAbs().maxCoeff(), 1e-13 * H.norm()) << name;
      const Eigen::VectorXd values =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(H).eigenvalues();
      EXPECT_GT(values[0], -1e-12 * values[n - 1]) << name;
    }
  }
}

TEST(ShellElements, RigidMotionsChangeNothing) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  for (const auto& [name, mesh, model] : small_sheets()) {
    const ShellElements elements(mesh, thick(), BendingLaw{model});
    const ShellState state = flat_state(mesh);
    const Eigen::MatrixX3d x = crumpled(mesh, 0.03, 5);
    const Eigen::MatrixX3d moved = (x * R.transpose()).rowwise() + Eigen::RowVector3d(3, -1, 2);
    const Assembled a = assemble(elements, state, x, Order::gradient);
    const Assembled b = assemble(elements, state, moved, Order::gradient);
    EXPECT_NEAR(b.membrane, a.membrane, 1e-11 * a.membrane) << name;
    EXPECT_NEAR(b.bending, a.bending, 1e-11 * a.bending) << name;
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = force;
    for (Eigen::Index v = 0; v < x.rows(); ++v) {
      const Eigen::Vector3d f = a.gradient.segment<3>(3 * v);
      EXPECT_LT((R * f - b.gradient.segment<3>(3 * v)).norm(), 1e-10 * a.gradient.norm()) << name;
      force += f;
      torque += Eigen::Vector3d(x.row(v)).cross(f);
    }
    EXPECT_LT(force.norm() + torque.norm(), 1e-11 * a.gradient.norm()) << name;
  }
}

TEST(ShellElements, RestHasNeitherEnergyNorForce) {
  for (const auto& [name, mesh, model] : small_sheets()) {
    const ShellState state = flat_state(mesh);
    const Assembled a =
        assemble(ShellElements(mesh, thick(), BendingLaw{model}), state, state.x, Order::gradient);
    EXPECT_LT(a.membrane + a.bending, 1e-28) << name;
    EXPECT_LT(a.gradient.norm(), 1e-13) << name;
  }
}

/// Dimension of the null space of bending about the flat state.
int free_modes(const ShellMesh& mesh, BendingModel model) {
  PaperMaterial material = thick();
  material.thickness = 1e6;  // the membrane is lost in round-off
  const ShellState state = flat_state(mesh);
  const Assembled a =
      assemble(ShellElements(mesh, material, BendingLaw{model}), state, state.x, Order::hessian);
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a.hessian).eigenvalues();
  return static_cast<int>((values.array() < 1e-9 * values.maxCoeff()).count());
}

// Out of plane only the rigid motions are free: every interior edge is resisted, whatever the fit
// could not see.
TEST(ShellElements, FlatSheetsBendFreelyInNoWayButRigidly) {
  std::vector<meshes::NamedMesh> kinds = meshes::every_kind();
  kinds.push_back({"two triangles", meshes::grid(1, 1, 1, 1, false)});
  kinds.push_back({"one row", meshes::grid(7, 1, 1, 0.1, true)});
  kinds.push_back({"narrow", meshes::delaunay(9, 2, 1, 0.2)});
  for (const auto& [name, mesh] : kinds)
    for (const BendingModel model : {BendingModel::shape_operator, BendingModel::hinge})
      EXPECT_EQ(free_modes(mesh, model), 2 * mesh.vertex_count() + 3) << name;
}

// E = A Y/2 [(1-nu) |G|^2 + nu tr(G)^2] with G = diag((1.1^2-1)/2, (0.95^2-1)/2).
TEST(ShellElements, MembraneOfAUniformStretch) {
  const ShellMesh mesh = meshes::delaunay(4, 4, 2, 1);
  ShellState state = flat_state(mesh);
  state.x.col(0) *= 1.1;
  state.x.col(1) *= 0.95;
  const PaperMaterial material = thick();
  const double g = (1.1 * 1.1 - 1) / 2, k = (0.95 * 0.95 - 1) / 2, nu = material.poisson_ratio;
  const double expected =
      2 * material.membrane_stiffness() / 2 * ((1 - nu) * (g * g + k * k) + nu * (g + k) * (g + k));
  const Assembled a =
      assemble(ShellElements(mesh, material, BendingLaw()), state, state.x, Order::energy);
  EXPECT_NEAR(a.membrane, expected, 1e-12 * expected);
  EXPECT_EQ(a.bending, 0);
}

double total_area(const ShellMesh& mesh) {
  double area = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    area +=
        meshes::twice_area(mesh, mesh.triangles(t, 0), mesh.triangles(t, 1), mesh.triangles(t, 2)) /
        2;
  return area;
}

/// Bending energy of the sheet rolled on a cylinder over that of the plate, D/2 kappa^2 A.
double cylinder_ratio(const ShellMesh& mesh, BendingModel model, double kappa, double degrees) {
  const PaperMaterial material;
  const Assembled a = assemble(
      ShellElements(mesh, material, BendingLaw{model}), flat_state(mesh),
      meshes::rolled(mesh.pattern, kappa, degrees * std::numbers::pi / 180), Order::energy);
  return a.bending / (material.bending_stiffness() / 2 * kappa * kappa * total_area(mesh));
}

// Sheets of 1 m on a cylinder of 1 m radius, 8, 16 and 32 edges a side.
struct Refinement {
  std::string name;
  std::array<std::vector<ShellMesh>, 3> levels;  ///< errors are averaged over a level's meshes
};

std::vector<Refinement> refinements() {
  std::vector<Refinement> all(4);
  all[0].name = "grid";
  all[1].name = "alternating grid";
  all[2].name = "equilateral";
  all[3].name = "random Delaunay";
  for (std::size_t level = 0; level < 3; ++level) {
    const int n = 8 << level;
    all[0].levels[level] = {meshes::grid(n, n, 1, 1, false)};
    all[1].levels[level] = {meshes::grid(n, n, 1, 1, true)};
    all[2].levels[level] = {meshes::equilateral(n, n + n / 8, 1.0 / n)};
    for (std::uint64_t seed = 1; seed <= 8; ++seed)
      all[3].levels[level].push_back(meshes::delaunay(n, n, 1, 1, seed));
  }
  return all;
}

TEST(ShellElements, BendsAsThePlateWhateverTheMeshAndDirection) {
  for (const auto& [name, levels] : refinements())
    for (const double degrees : {0.0, 30.0, 45.0, 90.0}) {
      std::array<double, 3> error{};
      for (std::size_t level = 0; level < 3; ++level)
        for (const ShellMesh& mesh : levels[level]) {
          const double one =
              std::abs(cylinder_ratio(mesh, BendingModel::shape_operator, 1, degrees) - 1);
          EXPECT_LT(one, 0.02) << name << " at " << degrees;
          error[level] += one / static_cast<double>(levels[level].size());
        }
      if (error[0] < 1e-10) continue;  // exact: lines of the mesh are rulings
      // Arc for chord, and the turning of normals along an edge: second order.
      EXPECT_NEAR(std::log2(error[0] / error[2]) / 2, 2, 0.2)
          << name << " at " << degrees << ": " << testing::PrintToString(error);
    }
}

// The patch test for forces: a constant moment is in equilibrium at every vertex away from the
// border. A fit that is exact for angles alone fails it, and bends with less than the plate's
// energy.
TEST(ShellElements, ConstantMomentsAreInEquilibrium) {
  PaperMaterial material = thick();
  material.thickness = 10;  // bending outweighs the membrane
  for (const auto& [name, levels] : refinements()) {
    const ShellMesh& mesh = levels[1].front();
    ShellState state = flat_state(mesh);
    const Eigen::MatrixX2d& u = mesh.pattern;
    state.x.col(2) =
        1e-6 * (0.7 * u.col(0).array().square() - 0.9 * u.col(0).array() * u.col(1).array() +
                0.4 * u.col(1).array().square());
    const Assembled a =
        assemble(ShellElements(mesh, material, BendingLaw()), state, state.x, Order::gradient);
    const Eigen::RowVector2d low = u.colwise().minCoeff(), high = u.colwise().maxCoeff();
    int inside = 0;
    double largest = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      const double away = std::min((u.row(v) - low).minCoeff(), (high - u.row(v)).minCoeff());
      if (away < 4.5 / 16) continue;
      ++inside;
      largest = std::max(largest, std::abs(a.gradient[3 * v + 2]));
    }
    EXPECT_GT(inside, 25) << name;
    EXPECT_LT(largest, 1e-8 * a.gradient.cwiseAbs().maxCoeff()) << name;
  }
}

TEST(ShellElements, StripsAlongRulingsBendAsThePlate) {
  for (const double slant : {0.0, 0.4})
    for (const int count : {4, 16, 64}) {
      const double degrees = -std::atan(slant) * 180 / std::numbers::pi;
      EXPECT_NEAR(cylinder_ratio(meshes::ruling_strips(count, 1, 1, slant),
                                 BendingModel::shape_operator, 1, degrees),
                  1, 1e-12);
    }
}

// Rulings fold one way and the edges that divide their strips the other: the sum of folds all but
// vanishes, and with it the energy of strips whose rulings nobody named.
TEST(ShellElements, DividersOfStripsDoNotFoldBackForNothing) {
  const PaperMaterial material;
  ShellMesh mesh = meshes::ruling_strips(16, 0.1, 0.1);
  ShellState state = flat_state(mesh);
  // A helicoid: every second edge folds back.
  for (int v = 0; v < mesh.vertex_count(); ++v)
    state.x(v, 2) = 2 * mesh.pattern(v, 0) * mesh.pattern(v, 1);
  const auto energy = [&] {
    return assemble(ShellElements(mesh, material, BendingLaw()), state, state.x, Order::energy)
        .bending;
  };
  const double unnamed = energy();
  for (int i = 1; i < 16; ++i) mesh.rulings.push_back({i, i + 17});
  state.mesh = mesh;
  EXPECT_GT(energy(), 10 * unnamed);
}

TEST(ShellElements, NamedRulingsChangeNothingForACylinderOverThem) {
  const PaperMaterial material;
  ShellMesh mesh = meshes::ruling_strips(16, 0.1, 0.1);
  ShellState state = flat_state(mesh);
  const double radius = 0.05;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double angle = mesh.pattern(v, 0) / radius;
    state.x.row(v) << radius * std::sin(angle), mesh.pattern(v, 1), radius * (1 - std::cos(angle));
  }
  const auto energy = [&] {
    return assemble(ShellElements(mesh, material, BendingLaw()), state, state.x, Order::energy)
        .bending;
  };
  const double unnamed = energy();
  for (int i = 1; i < 16; ++i) mesh.rulings.push_back({i, i + 17});
  EXPECT_NEAR(energy() / unnamed, 1, 1e-9);
}

/// Bending energy of a sector bent to a cone, over D/2 curvature^2 angle.
double cone_energy(const ShellMesh& mesh, double angle) {
  const PaperMaterial material;
  const double curvature = 0.01;
  const Assembled a = assemble(ShellElements(mesh, material, BendingLaw()), flat_state(mesh),
                               meshes::coned(mesh.pattern, curvature), Order::energy);
  return a.bending / (material.bending_stiffness() / 2 * curvature * curvature * angle);
}

// The curvature of a cone is k/r, its energy D/2 k^2 angle ln(outer / inner). One S a strip takes
// the mean width of a strip for all of it: 2 (outer - inner) / (outer + inner). Rows of strips
// approach the logarithm; a fan is a cone without the innermost e^-2 of its radius.
TEST(ShellElements, ConesOverTheirRulingsTakeTheMeanWidthOfAStrip) {
  const double angle = 1.5;
  EXPECT_NEAR(cone_energy(meshes::cone_strips(24, 0.2, 1, angle), angle), 2 * 0.8 / 1.2, 0.02);
  EXPECT_NEAR(cone_energy(meshes::cone_strips(24, 0.5, 1, angle), angle), std::log(2), 0.03);
  // 0.04 of it resists the residual: each of a fan's edges sees half the curvature of the sum.
  EXPECT_NEAR(cone_energy(meshes::fan(24, 1, angle), angle), 2 + 0.04, 0.005);
}

// Why the hinge is no plate: its stiffness depends on mesh and direction, and refinement does not
// help. With the calibration 4 equilateral meshes agree with the plate; the border, which has no
// hinge, is missing on the order of one row.
TEST(ShellElements, HingesDependOnMeshAndDirection) {
  const auto ratio = [](const ShellMesh& mesh, double degrees) {
    return cylinder_ratio(mesh, BendingModel::hinge, 0.5, degrees);
  };
  for (const double degrees : {0.0, 30.0, 45.0, 90.0})
    EXPECT_NEAR(ratio(meshes::equilateral(64, 72, 1.0 / 64), degrees), 1, 0.03) << degrees;
  const ShellMesh grid = meshes::grid(64, 64, 1, 1, false);
  EXPECT_NEAR(ratio(grid, 0), 1, 0.03);
  EXPECT_NEAR(ratio(grid, 45), 3, 0.06);
  EXPECT_NEAR(ratio(grid, -45), 1, 0.06);
  const ShellMesh alternating = meshes::grid(64, 64, 1, 1, true);
  EXPECT_NEAR(ratio(alternating, 0), 1, 0.03);
  EXPECT_NEAR(ratio(alternating, 45), 1.5, 0.03);
}

TEST(ShellElements, PlasticCurvatureIsTheNewRest) {
  const ShellMesh mesh = meshes::delaunay(8, 8, 1, 1);
  for (const BendingModel model : {BendingModel::shape_operator, BendingModel::hinge}) {
    const ShellElements elements(mesh, PaperMaterial(), BendingLaw{model});
    ShellState state = flat_state(mesh);
    const Eigen::MatrixX3d x = meshes::rolled(mesh.pattern, 0.2, 0.3);
    const double before = assemble(elements, state, x, Order::energy).bending;
    const Eigen::Vector2d across(std::cos(0.3), std::sin(0.3));
    state.plastic_curvature.rowwise() =
        0.2 * Eigen::RowVector3d(across.x() * across.x(), across.x() * across.y(),
                                 across.y() * across.y());
    EXPECT_LT(assemble(elements, state, x, Order::energy).bending, 1e-4 * before);
    EXPECT_LT(elements.elastic_curvature(17, state, x).norm(), 1e-2 * 0.2);
  }
}

TEST(ShellElements, DamageWeakensBending) {
  const ShellMesh mesh = meshes::grid(4, 4, 1, 1, true);
  PaperMaterial material;
  material.weakening = 3;
  const ShellElements elements(mesh, material, BendingLaw());
  ShellState state = flat_state(mesh);
  const Eigen::MatrixX3d x = meshes::rolled(mesh.pattern, 0.2, 0.3);
  const Assembled sound = assemble(elements, state, x, Order::energy);
  state.damage.setConstant(1.5);
  const Assembled damaged = assemble(elements, state, x, Order::energy);
  EXPECT_NEAR(damaged.bending, sound.bending / (1 + 3 * 1.5), 1e-12 * sound.bending);
  EXPECT_DOUBLE_EQ(damaged.membrane, sound.membrane);
}

TEST(ShellElements, NodesBeginWithTheTriangle) {
  const ShellMesh mesh = meshes::delaunay(6, 6, 1, 1);
  const ShellElements elements(mesh, PaperMaterial(), BendingLaw());
  ASSERT_EQ(elements.size(), mesh.triangle_count());
  for (int e = 0; e < elements.size(); ++e) {
    ASSERT_LE(elements.nodes(e).size(), static_cast<std::size_t>(ShellElements::kMostNodes));
    for (int k = 0; k < 3; ++k) EXPECT_EQ(elements.nodes(e)[k], mesh.triangles(e, k));
  }
}

}  // namespace
}  // namespace geoprior::paper
