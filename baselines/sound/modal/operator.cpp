#include "baselines/sound/modal/operator.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/numerics/jacobi_svd.h"
#include "models/paper/sheet/valid.h"
#include "models/paper/shell/dynamics.h"
#include "models/paper/tear/lips.h"

namespace geoprior::sound {
namespace {

constexpr const char* kWho = "modes of a sheet";
/// Singular values below this part of the largest are none.
constexpr double kRankTolerance = 1e-9;

void require_rows(Eigen::Index rows, int wanted, const std::string& what) {
  if (rows == wanted) return;
  throw Error("has " + std::to_string(rows) + " rows", what, std::to_string(wanted));
}

void require_state(const ShellState& state) {
  const ShellMesh& mesh = state.mesh;
  if (mesh.triangle_count() == 0) throw Error("has no triangles", kWho, "one or more");
  const int n = mesh.vertex_count();
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.triangles.row(t).minCoeff() < 0 || mesh.triangles.row(t).maxCoeff() >= n)
      throw Error("names a vertex that is not there", "triangle " + std::to_string(t));
  }
  require_rows(state.x.rows(), n, "places of the vertices");
  require_rows(state.plastic_curvature.rows(), mesh.triangle_count(), "plastic curvature");
  require_rows(state.damage.rows(), mesh.triangle_count(), "damage");
  for (int v = 0; v < n; ++v) {
    if (!mesh.pattern.row(v).allFinite() || !state.x.row(v).allFinite())
      throw Error("place is not finite", "vertex " + std::to_string(v));
  }
  if (!state.plastic_curvature.allFinite() || !state.damage.allFinite())
    throw Error("plastic curvature or damage is not finite", kWho);
  const int parts = paper::part_count(mesh.triangles);
  if (parts > 1)
    throw Error("the mesh is in " + std::to_string(parts) + " parts", kWho, "one part");
}

/// Half-edges of the border at the clamped edges, each once, ascending.
std::set<int> clamped_half_edges(const Eigen::MatrixX3i& triangles,
                                 const std::vector<Edge>& clamped) {
  const EdgeConnectivity edges(triangles);
  std::set<int> found;
  for (const auto& [u, v] : clamped) {
    const std::optional<int> edge = edges.find(u, v);
    if (!edge || edges.half_edges(*edge).size() != 1) {
      throw Error("clamped edge does not lie on the border",
                  "edge " + std::to_string(u) + "-" + std::to_string(v), "edges of one triangle");
    }
    found.insert(edges.half_edges(*edge)[0]);
  }
  return found;
}

/// Reflection of a triangle's displacements over its edge from corner k: turns round what lies in
/// its plane across the edge.
Eigen::Matrix3d mirror_turn(const Eigen::Vector3d& edge, const Eigen::Vector3d& to_third) {
  const Eigen::Vector3d across = (to_third - to_third.dot(edge) / edge.squaredNorm() * edge);
  return Eigen::Matrix3d::Identity() - 2 * across * across.transpose() / across.squaredNorm();
}

/// Puts mirror images beyond the sheet's border.
class Mirrors {
 public:
  Mirrors(const ShellState& sheet, std::vector<ModalOperator::Node>& nodes)
      : sheet_(sheet), edges_(sheet.mesh.triangles), nodes_(nodes) {}

  /// The triangle of a half-edge of the border and those beside it, over that edge.
  void add(int half_edge) {
    const int t = half_edge / 3, k = half_edge % 3;
    const Eigen::Vector3i corner = sheet_.mesh.triangles.row(t);
    const int a = corner[k], b = corner[(k + 1) % 3], c = corner[(k + 2) % 3];
    const Eigen::Vector2d p = sheet_.mesh.pattern.row(a);
    const Eigen::Vector2d along = (sheet_.mesh.pattern.row(b).transpose() - p).normalized();
    const Eigen::Matrix3d turn =
        mirror_turn(sheet_.x.row(b) - sheet_.x.row(a), sheet_.x.row(c) - sheet_.x.row(a));
    std::map<int, int> image{{a, a}, {b, b}};
    const auto image_of = [&](int v) {
      const auto [at, is_new] = image.try_emplace(v, static_cast<int>(nodes_.size()));
      if (is_new) {
        const Eigen::Vector2d q = sheet_.mesh.pattern.row(v).transpose() - p;
        const Eigen::Vector3d arm = sheet_.x.row(v) - sheet_.x.row(a);
        nodes_.push_back({v, turn});
        pattern_.push_back(p + 2 * q.dot(along) * along - q);
        x_.push_back(sheet_.x.row(a).transpose() + turn * arm);
      }
      return at->second;
    };
    for (const int near : {t, edges_.across(t, (k + 1) % 3), edges_.across(t, (k + 2) % 3)}) {
      if (near < 0) continue;
      const Eigen::Vector3i v = sheet_.mesh.triangles.row(near);
      triangles_.emplace_back(image_of(v[0]), image_of(v[2]), image_of(v[1]));
    }
  }

  /// The sheet, and the images behind it.
  [[nodiscard]] ShellState state() const {
    ShellState state = sheet_;
    append(pattern_, state.mesh.pattern);
    append(triangles_, state.mesh.triangles);
    append(x_, state.x);
    const Eigen::Index added = triangles_.size();
    state.plastic_curvature.conservativeResize(state.mesh.triangle_count(), 3);
    state.plastic_curvature.bottomRows(added).setZero();
    state.damage.conservativeResize(state.mesh.triangle_count());
    state.damage.tail(added).setZero();
    return state;
  }

 private:
  template <class Row, class Matrix>
  static void append(const std::vector<Row>& rows, Matrix& matrix) {
    const Eigen::Index before = matrix.rows();
    matrix.conservativeResize(before + rows.size(), matrix.cols());
    for (std::size_t i = 0; i < rows.size(); ++i) matrix.row(before + i) = rows[i].transpose();
  }

  const ShellState& sheet_;
  EdgeConnectivity edges_;
  std::vector<ModalOperator::Node>& nodes_;
  std::vector<Eigen::Vector2d> pattern_;
  std::vector<Eigen::Vector3i> triangles_;
  std::vector<Eigen::Vector3d> x_;
};

/// The sheet with mirror images over every clamped edge; `nodes` says what moves with what.
ShellState with_mirrors(const ShellState& sheet, const std::vector<Edge>& clamped,
                        std::vector<ModalOperator::Node>& nodes) {
  for (int v = 0; v < sheet.mesh.vertex_count(); ++v)
    nodes.push_back({v, Eigen::Matrix3d::Identity()});
  Mirrors mirrors(sheet, nodes);
  for (const int h : clamped_half_edges(sheet.mesh.triangles, clamped)) mirrors.add(h);
  return mirrors.state();
}

/// Orthonormal directions in which a vertex with these holds still moves.
void free_directions(const std::vector<Eigen::Vector3d>& held, ModalOperator::Freedom& freedom) {
  freedom.size = 3;
  freedom.basis.setIdentity();
  if (held.empty()) return;
  Eigen::Matrix3Xd directions(3, held.size());
  for (std::size_t i = 0; i < held.size(); ++i) directions.col(i) = held[i].normalized();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(directions), Eigen::ComputeFullU);
  const auto rank = (svd.singularValues().array() > kRankTolerance).count();
  freedom.size = 3 - static_cast<int>(rank);
  freedom.basis.leftCols(freedom.size) = svd.matrixU().rightCols(freedom.size);
}

std::vector<std::vector<Eigen::Vector3d>> held_directions(const ModalSupports& supports,
                                                          int vertices) {
  std::vector<std::vector<Eigen::Vector3d>> held(vertices);
  for (std::size_t i = 0; i < supports.holds.size(); ++i) {
    const auto& [vertex, direction] = supports.holds[i];
    const std::string where = "hold " + std::to_string(i);
    if (vertex < 0 || vertex >= vertices) throw Error("names a vertex that is not there", where);
    if (!direction.allFinite() || !(direction.norm() > 0))
      throw Error("has no direction", where, "a finite vector other than 0");
    held[vertex].push_back(direction);
  }
  for (const Edge& edge : supports.clamped) {
    for (const int v : edge) {
      for (int c = 0; c < 3; ++c) held[v].push_back(Eigen::Vector3d::Unit(c));
    }
  }
  return held;
}

const ShellState& checked(const PaperMaterial& material, const ShellState& state) {
  require_valid(material, "material");
  require_state(state);
  return state;
}

}  // namespace

std::vector<Edge> sorted_edges(const std::vector<Edge>& edges) {
  std::vector<Edge> sorted;
  for (const auto& [a, b] : edges) sorted.push_back(undirected(a, b));
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

ModalOperator::ModalOperator(const PaperMaterial& material, const ShellState& sheet,
                             const ModalSupports& supports, const paper::BendingLaw& law)
    : state(with_mirrors(checked(material, sheet), supports.clamped, nodes)),
      elements(state.mesh, material, law),
      triangles(sheet.mesh.triangle_count()),
      mass(lumped_masses(sheet.mesh, material.area_density)) {
  free_vertices(supports);
  assemble();
  find_rigid_motions(supports);
}

void ModalOperator::free_vertices(const ModalSupports& supports) {
  const auto held = held_directions(supports, static_cast<int>(mass.size()));
  freedoms.resize(held.size());
  for (std::size_t v = 0; v < held.size(); ++v) {
    free_directions(held[v], freedoms[v]);
    freedoms[v].first = unknowns;
    unknowns += freedoms[v].size;
  }
  if (unknowns == 0) throw Error("every vertex is held", kWho, "one that moves");
}

void ModalOperator::assemble() {
  std::vector<Eigen::Triplet<double>> triplets;
  paper::ShellElements::Local local;
  for (int e = 0; e < triangles; ++e) {
    elements.evaluate(e, state, state.x, paper::ShellElements::Order::material_hessian, local);
    const auto members = elements.nodes(e);
    const auto map = [&](std::size_t i, const Freedom& f) -> Eigen::Matrix3d {
      const Node& node = nodes[members[i]];
      return node.turn * f.basis / std::sqrt(mass[node.vertex]);
    };
    for (std::size_t i = 0; i < members.size(); ++i) {
      const Freedom& row = freedoms[nodes[members[i]].vertex];
      const Eigen::Matrix3d left = map(i, row);
      for (std::size_t j = 0; j < members.size(); ++j) {
        const Freedom& column = freedoms[nodes[members[j]].vertex];
        if (column.first > row.first) continue;
        const Eigen::Matrix3d block =
            left.transpose() * local.hessian.block<3, 3>(3 * i, 3 * j) * map(j, column);
        for (int r = 0; r < row.size; ++r) {
          for (int c = 0; c < column.size; ++c) {
            if (column.first + c <= row.first + r)
              triplets.emplace_back(row.first + r, column.first + c, block(r, c));
          }
        }
      }
    }
  }
  stiffness.resize(unknowns, unknowns);
  stiffness.setFromTriplets(triplets.begin(), triplets.end());
}

void ModalOperator::find_rigid_motions(const ModalSupports& supports) {
  rigid.resize(unknowns, 0);
  if (!supports.clamped.empty()) return;
  const Eigen::Index n = mass.size();
  const Eigen::RowVector3d centre = state.x.topRows(n).colwise().mean();
  const double size = (state.x.topRows(n).rowwise() - centre).rowwise().norm().maxCoeff();
  Eigen::MatrixXd motions(3 * n, 6);
  for (Eigen::Index v = 0; v < n; ++v) {
    const Eigen::Vector3d arm = (state.x.row(v) - centre) / size;
    for (int c = 0; c < 3; ++c) {
      motions.block<3, 1>(3 * v, c) = Eigen::Vector3d::Unit(c);
      motions.block<3, 1>(3 * v, 3 + c) = Eigen::Vector3d::Unit(c).cross(arm);
    }
  }
  Eigen::MatrixXd held =
      Eigen::MatrixXd::Zero(std::max<Eigen::Index>(6, std::ssize(supports.holds)), 6);
  for (std::size_t i = 0; i < supports.holds.size(); ++i) {
    const auto& [vertex, direction] = supports.holds[i];
    held.row(i) = direction.normalized().transpose() * motions.middleRows<3>(3 * vertex);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(held, Eigen::ComputeFullV);
  const auto rank = (svd.singularValues().array() > kRankTolerance).count();
  if (rank == 6) return;
  motions = motions * svd.matrixV().rightCols(6 - rank);
  Eigen::MatrixXd scaled(unknowns, motions.cols());
  for (Eigen::Index v = 0; v < n; ++v) {
    const Freedom& f = freedoms[v];
    scaled.middleRows(f.first, f.size) =
        std::sqrt(mass[v]) * f.basis.leftCols(f.size).transpose() * motions.middleRows<3>(3 * v);
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(scaled);
  rigid = qr.householderQ() * Eigen::MatrixXd::Identity(unknowns, motions.cols());
}

Eigen::MatrixXd ModalOperator::displacements(const Eigen::MatrixXd& scaled) const {
  Eigen::MatrixXd u(3 * mass.size(), scaled.cols());
  for (Eigen::Index v = 0; v < mass.size(); ++v) {
    const Freedom& f = freedoms[v];
    u.middleRows<3>(3 * v) =
        f.basis.leftCols(f.size) * scaled.middleRows(f.first, f.size) / std::sqrt(mass[v]);
  }
  return u;
}

Eigen::VectorXd ModalOperator::curvature_load(const Eigen::MatrixX3d& change) const {
  require_rows(change.rows(), triangles, "change of curvature");
  if (!change.allFinite()) throw Error("change of curvature is not finite", kWho);
  // The energy is quadratic in the rest curvature, its gradient linear.
  ShellState before = state, after = state;
  before.plastic_curvature.setZero();
  after.plastic_curvature.setZero();
  after.plastic_curvature.topRows(triangles) = change;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * mass.size());
  paper::ShellElements::Local without, with;
  for (int e = 0; e < triangles; ++e) {
    elements.evaluate(e, before, state.x, paper::ShellElements::Order::gradient, without);
    elements.evaluate(e, after, state.x, paper::ShellElements::Order::gradient, with);
    const auto members = elements.nodes(e);
    for (std::size_t i = 0; i < members.size(); ++i) {
      const Node& node = nodes[members[i]];
      const auto at = 3 * i;
      load.segment<3>(3 * node.vertex) +=
          node.turn.transpose() * (without.gradient.segment<3>(at) - with.gradient.segment<3>(at));
    }
  }
  return load;
}

}  // namespace geoprior::sound
