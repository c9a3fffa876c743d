#include "models/paper/shell/elements.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <type_traits>
#include <utility>

#include "core/angles.h"
#include "core/connectivity.h"
#include "core/geometry/curvature_fit.h"
#include "models/paper/shell/hinge.h"
#include "models/paper/shell/shape_gradients.h"

namespace geoprior::paper {
namespace {

constexpr int kMostTerms = CurvatureFit::kMostTerms;
constexpr int kMostRows = kMostTerms;
constexpr int kMostColumns = 3 * ShellElements::kMostNodes;
static_assert(CurvatureFit::kMostVertices == ShellElements::kMostNodes);

/// L with (1-nu) |S|^2 + nu tr(S)^2 = |L S|^2 for S = (uu, uv, vv). Fibres along g that bend
/// `along` times as stiffly add (along - 1) (g'S g)^2.
Eigen::Matrix3d root_of(const PaperMaterial& material) {
  const double nu = material.poisson_ratio;
  Eigen::Matrix3d M;
  M << 1, 0, nu, 0, 2 * (1 - nu), 0, nu, 0, 1;
  if (material.grain_deg) {
    const double c = std::cos(*material.grain_deg * kDegree);
    const double s = std::sin(*material.grain_deg * kDegree);
    const Eigen::Vector3d bend(c * c, 2 * c * s, s * s);
    M += (material.along - 1) * bend * bend.transpose();
  }
  return M.llt().matrixU();
}

/// Bending of one element is k/2 |R theta - T S_p|^2 over its first `terms` hinges.
struct Element {
  int first_node = 0, first_hinge = 0;
  int nodes = 3;       ///< of the energy
  int hinges = 0;      ///< of the energy
  int fit_hinges = 0;  ///< of the shape operator
  int rows = 0;        ///< of R
  int dividers = 0;    ///< of them: the last, each of one hinge
  int first_row = 0;   ///< in `coefficients`: R by columns
  double area = 0;
  double stiffness = 0;                     ///< k
  std::array<Eigen::Vector2d, 3> gradient;  ///< of the three shape functions (1/m)
};

/// A hinge as an element sees it.
struct LocalHinge {
  std::array<std::uint8_t, 4> node{};  ///< local a, b, c, d
  Eigen::Vector3d fit;                 ///< what it contributes to S per rad
};

using Root = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostRows, kMostTerms>;
using PlasticRows = Eigen::Matrix<double, kMostRows, 3>;

/// Rows for the folds of strips and fans that are no rulings: a sheet bends about its rulings, and
/// the edges between them, which only divide the strip, fold against the stiffness of a plate bent
/// over the two triangles beside them, D/2 l^2 theta^2 / (A1 + A2), half of it here. The sum of
/// folds alone would let them fold back what the rulings fold. Nothing for a cylinder over its
/// rulings.
Root divider_rows(const ShellMesh& mesh, const CurvatureFit& fit, int t, PlasticRows& plastic,
                  int first_plastic) {
  const auto& terms = fit.terms[t];
  if (mesh.rulings.empty()) return {};
  const auto is_ruling = [&](const CurvatureFit::Hinge& h) {
    return std::binary_search(mesh.rulings.begin(), mesh.rulings.end(), undirected(h.a, h.b));
  };
  std::vector<int> dividers;
  for (int k = 0; k < fit.own[t]; ++k) {
    if (!is_ruling(fit.hinges[terms[k].hinge])) dividers.push_back(k);
  }
  if (fit.rank[t] == 3 && std::ssize(dividers) == fit.own[t]) return {};
  Root rows = Root::Zero(dividers.size(), terms.size());
  for (std::size_t r = 0; r < dividers.size(); ++r) {
    const auto& h = fit.hinges[terms[dividers[r]].hinge];
    const double length = (mesh.pattern.row(h.b) - mesh.pattern.row(h.a)).norm();
    const double areas = fit.area[h.left] + fit.area[h.right];
    const double stiffness = length / std::sqrt(2 * areas * fit.area[t]);
    rows(r, dividers[r]) = stiffness;
    plastic.row(first_plastic + r) = stiffness * h.jump;
  }
  return rows;
}

/// R of the plate: the shape operator's energy, then the residual where S may miss an edge.
Root plate_rows(const CurvatureFit& fit, int t, const Eigen::Matrix3d& root,
                double residual_share) {
  const auto& terms = fit.terms[t];
  const Eigen::Index n = terms.size();
  if (n == 0) return {};
  Eigen::MatrixXd fitted(3, n), jumps(n, 3);
  Eigen::VectorXd curvature(n);  // per angle, of an edge alone
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& term = terms[i];
    const Eigen::Vector3d& jump = fit.hinges[term.hinge].jump;
    fitted.col(i) = term.coefficient;
    jumps.row(i) = jump;
    curvature[i] = 1 / Eigen::Vector3d(jump[0], jump[1] / std::sqrt(2.0), jump[2]).norm();
  }
  const Eigen::MatrixXd plate = root * fitted;
  const int own = fit.own[t];
  if (own == 3 && fit.rank[t] == 3) return plate;
  Eigen::MatrixXd residual = std::sqrt(residual_share / own) * curvature.asDiagonal() *
                             (Eigen::MatrixXd::Identity(n, n) - jumps * fitted);
  residual.bottomRows(n - own).setZero();
  // The residual is written with as few rows as it has dimensions.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(residual.transpose() * residual);
  const auto spare = (eigen.eigenvalues().array() > 1e-12 * plate.squaredNorm()).count();
  assert(3 + spare <= kMostRows);
  Root rows(3 + spare, n);
  rows.topRows(3) = plate;
  rows.bottomRows(spare) = eigen.eigenvalues().tail(spare).cwiseSqrt().asDiagonal() *
                           eigen.eigenvectors().rightCols(spare).transpose();
  return rows;
}

/// Tensile part of a symmetric matrix: eigenvalues below zero become zero.
Eigen::Matrix2d tensile_part(const Eigen::Matrix2d& S) {
  const double mean = 0.5 * (S(0, 0) + S(1, 1)), half = 0.5 * (S(0, 0) - S(1, 1));
  const double radius = std::sqrt(half * half + S(0, 1) * S(0, 1));
  if (mean >= radius) return S;
  if (mean <= -radius) return Eigen::Matrix2d::Zero();
  // (mean + radius) times the projector on the eigenvector of the larger eigenvalue.
  const double scale = 0.5 * (mean + radius) / radius;
  Eigen::Matrix2d positive;
  positive << radius + half, S(0, 1), S(0, 1), radius - half;
  return scale * positive;
}

/// Rows whose outer products add up to a Hessian.
using Rows = double[kMostRows][kMostColumns];
template <int value>
using Constant = std::integral_constant<int, value>;

/// Adds sum_r rows_r rows_r' to the top left `n` x `n` of `hessian`; `n` constant where it is
/// known.
template <class Size>
void add_outer_products(const Rows& rows, int count, Size n,
                        Eigen::Matrix<double, kMostColumns, kMostColumns>& hessian) {
  for (int j = 0; j < n; ++j) {
    double* column = hessian.data() + static_cast<std::ptrdiff_t>(j) * kMostColumns;
    for (int r = 0; r < count; ++r) {
      const double factor = rows[r][j];
      for (int i = 0; i < n; ++i) column[i] += factor * rows[r][i];
    }
  }
}

}  // namespace

struct ShellElements::Impl {
  double membrane_stiffness = 0, poisson_ratio = 0, weakening = 0;
  Eigen::Matrix3d root;        ///< of the membrane
  Eigen::Matrix3d plate_root;  ///< of the plate
  std::vector<Element> elements;
  std::vector<int> nodes;
  std::vector<LocalHinge> hinges;
  std::vector<double> coefficients;  ///< R of each element, by columns
  std::vector<PlasticRows> plastic;  ///< T of each element
  CurvatureFit fit;

  void add_element(const ShellMesh& mesh, int t, double bending_stiffness, const BendingLaw& law);
  int add_hinges(const ShellMesh& mesh, int t, Element& element);
  void membrane(const Element& element, const Eigen::Vector3d* p, Order order, Local& out,
                Rows& rows) const;
  [[nodiscard]] double bending(std::size_t index, double stiffness, const Eigen::Vector3d& rest,
                               const HingeAngle* angle, double* moments) const;
  void bending_rows(const Element& e, double stiffness, const HingeAngle* angle, Rows& rows) const;
};

/// Appends the hinges and the vertices they touch; returns the vertices that the triangle's own
/// hinges touch.
int ShellElements::Impl::add_hinges(const ShellMesh& mesh, int t, Element& element) {
  element.first_node = static_cast<int>(nodes.size());
  element.first_hinge = static_cast<int>(hinges.size());
  for (int k = 0; k < 3; ++k) nodes.push_back(mesh.triangles(t, k));
  int own_nodes = 3;
  const auto& terms = fit.terms[t];
  for (int i = 0; i < std::ssize(terms); ++i) {
    const CurvatureFit::Hinge& h = fit.hinges[terms[i].hinge];
    LocalHinge local;
    local.fit = terms[i].coefficient;
    const std::array<int, 4> vertices = {h.a, h.b, h.c, h.d};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto begin = nodes.begin() + element.first_node;
      const auto at = std::find(begin, nodes.end(), vertices[k]) - begin;
      if (begin + at == nodes.end()) nodes.push_back(vertices[k]);
      local.node[k] = static_cast<std::uint8_t>(at);
    }
    hinges.push_back(local);
    if (i < fit.own[t]) own_nodes = static_cast<int>(nodes.size()) - element.first_node;
  }
  return own_nodes;
}

void ShellElements::Impl::add_element(const ShellMesh& mesh, int t, double bending_stiffness,
                                      const BendingLaw& law) {
  Element element;
  element.area = fit.area[t];
  element.gradient = shape_gradients(mesh, t, element.area);
  const int own_nodes = add_hinges(mesh, t, element);
  element.fit_hinges = static_cast<int>(fit.terms[t].size());
  element.nodes = static_cast<int>(nodes.size()) - element.first_node;
  Root rows;
  PlasticRows plastic_rows = PlasticRows::Zero();
  if (law.model == BendingModel::shape_operator) {
    const Root plate = plate_rows(fit, t, plate_root, law.fit_residual);
    plastic_rows.topRows(3) = plate_root;
    const Root dividers = divider_rows(mesh, fit, t, plastic_rows, static_cast<int>(plate.rows()));
    rows.resize(plate.rows() + dividers.rows(), plate.cols());
    rows.topRows(plate.rows()) = plate;
    if (dividers.rows() > 0) rows.bottomRows(dividers.rows()) = dividers;
    element.dividers = static_cast<int>(dividers.rows());
    element.hinges = element.fit_hinges;
    element.stiffness = bending_stiffness * element.area;
  } else {
    element.hinges = fit.own[t];
    rows = Root::Zero(element.hinges, element.hinges);
    for (int k = 0; k < element.hinges; ++k) {
      const auto& h = fit.hinges[fit.terms[t][k].hinge];
      const double length = (mesh.pattern.row(h.b) - mesh.pattern.row(h.a)).norm();
      const double areas = fit.area[h.left] + fit.area[h.right];
      // Half of k D/4 l^2/(2 a) theta^2: the other half is the neighbour's.
      rows(k, k) = length * std::sqrt(law.hinge_calibration / (8 * areas));
      plastic_rows.row(k) = rows(k, k) * h.jump;
    }
    element.stiffness = bending_stiffness;
    element.nodes = own_nodes;
  }
  element.rows = static_cast<int>(rows.rows());
  element.first_row = static_cast<int>(coefficients.size());
  coefficients.insert(coefficients.end(), rows.data(), rows.data() + rows.size());
  elements.push_back(element);
  plastic.push_back(plastic_rows);
}

ShellElements::ShellElements(const ShellMesh& mesh, const PaperMaterial& material,
                             const BendingLaw& law) {
  auto impl = std::make_shared<Impl>();
  impl->membrane_stiffness = material.membrane_stiffness();
  impl->poisson_ratio = material.poisson_ratio;
  impl->weakening = material.weakening;
  PaperMaterial even = material;
  even.along = 1;
  impl->root = root_of(even);
  impl->plate_root = root_of(material);
  impl->fit = fit_curvature(mesh.pattern, mesh.triangles);
  for (int t = 0; t < mesh.triangle_count(); ++t)
    impl->add_element(mesh, t, material.bending_stiffness(), law);
  impl_ = std::move(impl);
}

const CurvatureFit& ShellElements::curvature_fit() const { return impl_->fit; }

int ShellElements::size() const { return static_cast<int>(impl_->elements.size()); }

std::span<const int> ShellElements::nodes(int element) const {
  const Element& e = impl_->elements[element];
  return {impl_->nodes.data() + e.first_node, static_cast<std::size_t>(e.nodes)};
}

/// Adds energy and gradient, the geometric Hessian of the tensile stress, and writes three `rows`
/// whose outer products are the rest of the Hessian.
void ShellElements::Impl::membrane(const Element& element, const Eigen::Vector3d* p, Order order,
                                   Local& out, Rows& rows) const {
  const auto& b = element.gradient;
  Eigen::Matrix<double, 3, 2> F = Eigen::Matrix<double, 3, 2>::Zero();
  for (std::size_t k = 1; k < 3; ++k) F += (p[k] - p[0]) * b[k].transpose();
  Eigen::Matrix2d G = 0.5 * (F.transpose() * F);
  G.diagonal().array() -= 0.5;
  const double nu = poisson_ratio;
  Eigen::Matrix2d stress = membrane_stiffness * (1 - nu) * G;
  stress.diagonal().array() += membrane_stiffness * nu * G.trace();
  out.membrane = 0.5 * element.area * stress.cwiseProduct(G).sum();
  if (order == Order::energy) return;
  const Eigen::Matrix<double, 3, 2> P = element.area * F * stress;
  for (int k = 0; k < 3; ++k) out.gradient.segment<3>(3 * k) += P * b[k];
  if (order == Order::gradient) return;
  Eigen::Matrix2d tensile = Eigen::Matrix2d::Zero();
  if (order == Order::hessian) tensile = element.area * tensile_part(stress);
  const Eigen::Matrix3d L = std::sqrt(element.area * membrane_stiffness) * root;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d& bk = b[k];
    Eigen::Matrix3d strain;  // of (uu, uv, vv) per displacement of vertex k
    strain.row(0) = bk.x() * F.col(0);
    strain.row(1) = 0.5 * (bk.x() * F.col(1) + bk.y() * F.col(0));
    strain.row(2) = bk.y() * F.col(1);
    const Eigen::Matrix3d part = L * strain;
    for (int r = 0; r < 3; ++r)
      for (int i = 0; i < 3; ++i) rows[r][3 * k + i] = part(r, i);
    for (int l = 0; l < 3; ++l) {
      const double s = bk.dot(tensile * b[l]);
      for (int i = 0; i < 3; ++i) out.hessian(3 * k + i, 3 * l + i) += s;
    }
  }
}

/// Energy of bending; `moments` get stiffness R'(R theta - T S_p), the derivative by each angle.
double ShellElements::Impl::bending(std::size_t index, double stiffness,
                                    const Eigen::Vector3d& rest, const HingeAngle* angle,
                                    double* moments) const {
  const Element& e = elements[index];
  const double* R = coefficients.data() + e.first_row;
  double energy = 0;
  std::fill_n(moments, e.hinges, 0.0);
  for (int r = 0; r < e.rows; ++r) {
    double kept = plastic[index].row(r).dot(rest);
    if (r >= e.rows - e.dividers) {
      // Beyond a full turn it is no fold: S of a stencil of slivers knows no bounds.
      double per_angle = 0;
      for (int i = 0; i < e.hinges; ++i) per_angle += R[i * e.rows + r];
      const double most = 2 * std::numbers::pi * per_angle;
      kept = std::clamp(kept, -most, most);
    }
    double excess = -kept;
    for (int i = 0; i < e.hinges; ++i) excess += R[i * e.rows + r] * angle[i].angle;
    energy += 0.5 * stiffness * excess * excess;
    for (int i = 0; i < e.hinges; ++i) moments[i] += stiffness * R[i * e.rows + r] * excess;
  }
  return energy;
}

/// Gauss-Newton: sum over the rows of sqrt(stiffness) R d theta.
void ShellElements::Impl::bending_rows(const Element& e, double stiffness, const HingeAngle* angle,
                                       Rows& rows) const {
  const double* R = coefficients.data() + e.first_row;
  const LocalHinge* hinge = hinges.data() + e.first_hinge;
  const double scale = std::sqrt(stiffness);
  for (int r = 0; r < e.rows; ++r) {
    std::fill_n(rows[r], 3 * e.nodes, 0.0);
    for (int i = 0; i < e.hinges; ++i)
      for (std::size_t k = 0; k < 4; ++k)
        for (int c = 0; c < 3; ++c)
          rows[r][3 * hinge[i].node[k] + c] += scale * R[i * e.rows + r] * angle[i].gradient[k][c];
  }
}

void ShellElements::evaluate(int element, const ShellState& state, const Eigen::MatrixX3d& x,
                             Order order, Local& out) const {
  const std::size_t index = element;
  const Element& e = impl_->elements[index];
  const int columns = 3 * e.nodes;
  std::array<Eigen::Vector3d, kMostNodes> p;
  const int* node = impl_->nodes.data() + e.first_node;
  for (int k = 0; k < e.nodes; ++k) p[k] = x.row(node[k]);
  if (order != Order::energy) out.gradient.head(columns).setZero();
  const bool with_hessian = order == Order::hessian || order == Order::material_hessian;
  if (with_hessian) out.hessian.topLeftCorner(columns, columns).setZero();
  Rows rows;
  impl_->membrane(e, p.data(), order, out, rows);
  if (with_hessian) add_outer_products(rows, 3, Constant<9>(), out.hessian);

  std::array<HingeAngle, kMostTerms> angle;
  const LocalHinge* hinge = impl_->hinges.data() + e.first_hinge;
  for (int i = 0; i < e.hinges; ++i) {
    const auto& v = hinge[i].node;
    HingeAngle& h = angle[i];
    h = order == Order::energy ? HingeAngle::of<false>(p[v[0]], p[v[1]], p[v[2]], p[v[3]])
                               : HingeAngle::of<true>(p[v[0]], p[v[1]], p[v[2]], p[v[3]]);
  }
  const double stiffness = e.stiffness / (1 + impl_->weakening * state.damage[element]);
  std::array<double, kMostTerms> moments;
  out.bending = impl_->bending(index, stiffness, state.plastic_curvature.row(element), angle.data(),
                               moments.data());
  if (order == Order::energy) return;
  for (int i = 0; i < e.hinges; ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      out.gradient.segment<3>(3 * hinge[i].node[k]) += moments[i] * angle[i].gradient[k];
    }
  if (order == Order::gradient) return;
  impl_->bending_rows(e, stiffness, angle.data(), rows);
  if (e.nodes == 6)
    add_outer_products(rows, e.rows, Constant<18>(), out.hessian);
  else
    add_outer_products(rows, e.rows, columns, out.hessian);
}

Eigen::Vector3d ShellElements::elastic_curvature(int element, const ShellState& state,
                                                 const Eigen::MatrixX3d& x) const {
  const Element& e = impl_->elements[element];
  const int* node = impl_->nodes.data() + e.first_node;
  Eigen::Vector3d S = -state.plastic_curvature.row(element).transpose();
  for (int i = 0; i < e.fit_hinges; ++i) {
    const LocalHinge& h = impl_->hinges[e.first_hinge + i];
    const auto at = [&](int k) -> Eigen::Vector3d { return x.row(node[h.node[k]]); };
    S += h.fit * HingeAngle::of<false>(at(0), at(1), at(2), at(3)).angle;
  }
  return S;
}

}  // namespace geoprior::paper
