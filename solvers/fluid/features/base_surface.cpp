#include "solvers/fluid/features/base_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/disjoint_sets.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/numerics/sparse_ldlt.h"

namespace geoprior::fluid {
namespace {

constexpr double kCotangentLimit = 20;
constexpr double kSmallestMass = 0.01;       ///< of the mean mass
constexpr double kSmallestCotangent = 0.02;  ///< of harmonic coordinates: positive weights

using SparseMatrix = Eigen::SparseMatrix<double>;

/// The part of a mesh that the bed of a region depends on, with its own vertex numbers: first those
/// that move, then the ring around them (rows of L too), then the ring around that.
struct Patch {
  std::vector<int> vertices;      ///< of the mesh
  int moving = 0, with_ring = 0;  ///< how many move; and their ring
  std::vector<std::array<int, 3>> triangles;
};

/// Marks with 2 the vertices on a border of the mesh: those stay, and L has no row for them.
std::vector<char> marks_of(const TriMesh& mesh, const std::vector<char>& inside) {
  std::vector<char> marks(mesh.vertex_count(), 0);
  for (const Edge& e : boundary_edges(mesh.F)) {
    for (const int v : e) marks[v] = 2;
  }
  for (std::size_t v = 0; v < marks.size(); ++v) {
    if (inside[v] != 0 && marks[v] == 0) marks[v] = 1;
  }
  return marks;
}

/// Adds vertices of triangles that touch one in the patch.
void grow(const TriMesh& mesh, Patch& patch, std::vector<int>& local) {
  const auto before = static_cast<int>(patch.vertices.size());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    bool touches = false;
    for (int k = 0; k < 3; ++k) {
      const int id = local[mesh.F(t, k)];
      touches |= id >= 0 && id < before;
    }
    if (!touches) continue;
    for (int k = 0; k < 3; ++k) {
      int& id = local[mesh.F(t, k)];
      if (id >= 0) continue;
      id = static_cast<int>(patch.vertices.size());
      patch.vertices.push_back(mesh.F(t, k));
    }
  }
}

Patch patch_of(const TriMesh& mesh, const std::vector<char>& marks) {
  Patch patch;
  std::vector<int> local(marks.size(), -1);
  for (int v = 0; v < std::ssize(marks); ++v) {
    if (marks[v] != 1) continue;
    local[v] = static_cast<int>(patch.vertices.size());
    patch.vertices.push_back(v);
  }
  patch.moving = static_cast<int>(patch.vertices.size());
  grow(mesh, patch, local);
  patch.with_ring = static_cast<int>(patch.vertices.size());
  grow(mesh, patch, local);
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const std::array<int, 3> tri{local[mesh.F(t, 0)], local[mesh.F(t, 1)], local[mesh.F(t, 2)]};
    if (tri[0] >= 0 && tri[1] >= 0 && tri[2] >= 0) patch.triangles.push_back(tri);
  }
  return patch;
}

/// A system without anything that stays is singular: found by flooding from what stays.
void require_held(const TriMesh& mesh, const std::vector<char>& marks) {
  DisjointSets components(mesh.vertex_count());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    components.join(components.join(mesh.F(t, 0), mesh.F(t, 1)), mesh.F(t, 2));
  }
  std::vector<char> held(marks.size(), 0);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (marks[v] != 1) held[components.find(v)] = 1;
  }
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (held[components.find(v)] == 0) {
      throw Error("the region covers its whole component: no bed can be put under it",
                  "vertex " + std::to_string(v),
                  "regions that leave a vertex of every component outside");
    }
  }
}

Eigen::Vector3d position(const TriMesh& mesh, const Patch& patch, int local) {
  return mesh.V.row(patch.vertices[local]).transpose();
}

/// Cotangent weights (rows of the vertices that move and their ring) and masses.
struct Laplacian {
  SparseMatrix L;        ///< with_ring x vertices
  Eigen::VectorXd mass;  ///< with_ring
};

Laplacian laplacian_of(const TriMesh& mesh, const Patch& patch, double smallest, double largest) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(patch.triangles.size() * 12);
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(patch.with_ring);
  for (const auto& tri : patch.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = tri[k], b = tri[(k + 1) % 3], c = tri[(k + 2) % 3];
      const Eigen::Vector3d ab = position(mesh, patch, b) - position(mesh, patch, a);
      const Eigen::Vector3d ac = position(mesh, patch, c) - position(mesh, patch, a);
      const double twice_area = ab.cross(ac).norm();
      const double cotangent =
          twice_area > 0 ? std::clamp(ab.dot(ac) / twice_area, smallest, largest) : largest;
      if (a < patch.with_ring) mass[a] += twice_area / 6;
      for (const auto& [i, j] : {std::pair{b, c}, std::pair{c, b}}) {
        if (i >= patch.with_ring) continue;
        entries.emplace_back(i, j, -0.5 * cotangent);
        entries.emplace_back(i, i, 0.5 * cotangent);
      }
    }
  }
  Laplacian result;
  result.L.resize(patch.with_ring, patch.vertices.size());
  result.L.setFromTriplets(entries.begin(), entries.end());
  const double floor = kSmallestMass * mass.sum() / std::max(1, patch.with_ring);
  result.mass = mass.cwiseMax(std::max(floor, 1e-300));
  return result;
}

void require_solved(const SparseLdlt& solver, const Patch& patch) {
  if (solver.succeeded()) return;
  throw Error("the bed of the region has no unique solution",
              "vertex " + std::to_string(patch.vertices.front()),
              "a region of triangles with positive areas");
}

/// Solves for the columns of `x` that move; rows beyond are given.
/// @param weights  of the rows of L in the least squares; empty: L x = 0 for those that move
void solve(const SparseMatrix& L, const Eigen::VectorXd& weights, const Patch& patch,
           Eigen::MatrixXd& x) {
  const Eigen::Index m = patch.moving, all = std::ssize(patch.vertices);
  const SparseMatrix moving = L.leftCols(m), staying = L.rightCols(all - m);
  SparseMatrix A;
  Eigen::MatrixXd b;
  if (weights.size() == 0) {
    A = moving.topRows(m);
    b = -(staying * x.bottomRows(all - m)).topRows(m);
  } else {
    A = moving.transpose() * weights.asDiagonal() * moving;
    b = -(moving.transpose() * (weights.asDiagonal() * (staying * x.bottomRows(all - m))));
  }
  const SparseLdlt solver(A);
  require_solved(solver, patch);
  x.topRows(m) = solver.solve_columns(b);
}

Eigen::MatrixXd patch_positions(const TriMesh& mesh, const Patch& patch) {
  Eigen::MatrixXd x(patch.vertices.size(), 3);
  for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
    x.row(i) = mesh.V.row(patch.vertices[i]);
  }
  return x;
}

void check_sizes(const TriMesh& mesh, const std::vector<char>& inside) {
  if (std::ssize(inside) == mesh.vertex_count()) return;
  throw Error("a mark for every vertex is needed", std::to_string(inside.size()) + " marks",
              std::to_string(mesh.vertex_count()));
}

Eigen::Vector3d area_vector(const Eigen::MatrixXd& x, const std::array<int, 3>& t) {
  const Eigen::Vector3d a = x.row(t[0]), b = x.row(t[1]), c = x.row(t[2]);
  return (b - a).cross(c - a);
}

/// Whether triangles that move lie upside down against the mean of all.
bool folds(const Eigen::MatrixXd& x, const Patch& patch, const Eigen::Vector3d& normal) {
  return std::any_of(patch.triangles.begin(), patch.triangles.end(), [&](const auto& t) {
    const bool moves = t[0] < patch.moving || t[1] < patch.moving || t[2] < patch.moving;
    return moves && area_vector(x, t).dot(normal) <= 0;
  });
}

/// Biharmonic positions of the patch, which is not empty.
Eigen::MatrixXd biharmonic(const TriMesh& mesh, const std::vector<char>& marks,
                           const Patch& patch) {
  const Laplacian laplacian = laplacian_of(mesh, patch, -kCotangentLimit, kCotangentLimit);
  Eigen::VectorXd weights = laplacian.mass.cwiseInverse();
  for (int i = 0; i < patch.with_ring; ++i) {
    // A border's row holds the pull of the missing side: it says nothing of curvature.
    const int v = patch.vertices[i];
    if (marks[v] == 2) weights[i] = 0;
  }
  weights /= weights.maxCoeff();
  Eigen::MatrixXd x = patch_positions(mesh, patch);
  const Eigen::RowVector3d origin = x.row(0);
  x.rowwise() -= origin;
  solve(laplacian.L, weights, patch, x);
  x.rowwise() += origin;
  return x;
}

Eigen::MatrixX3d placed(const TriMesh& mesh, const Patch& patch, const Eigen::MatrixXd& x) {
  Eigen::MatrixX3d result = mesh.V;
  for (int i = 0; i < patch.moving; ++i) {
    result.row(patch.vertices[i]) = x.row(i);
  }
  return result;
}

}  // namespace

Eigen::MatrixX3d base_under(const TriMesh& mesh, const std::vector<char>& inside) {
  check_sizes(mesh, inside);
  const std::vector<char> marks = marks_of(mesh, inside);
  require_held(mesh, marks);
  const Patch patch = patch_of(mesh, marks);
  if (patch.moving == 0) return mesh.V;
  return placed(mesh, patch, biharmonic(mesh, marks, patch));
}

Eigen::MatrixX3d unfolded_base(const TriMesh& mesh, const std::vector<char>& inside) {
  check_sizes(mesh, inside);
  const std::vector<char> marks = marks_of(mesh, inside);
  require_held(mesh, marks);
  const Patch patch = patch_of(mesh, marks);
  if (patch.moving == 0) return mesh.V;
  Eigen::MatrixXd x = biharmonic(mesh, marks, patch);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const auto& t : patch.triangles) normal += area_vector(x, t);
  if (!normal.isZero(0) && folds(x, patch, normal.normalized())) {
    normal.normalize();
    const Laplacian flat = laplacian_of(mesh, patch, kSmallestCotangent, kCotangentLimit);
    Eigen::MatrixXd y = patch_positions(mesh, patch);
    const Eigen::RowVector3d origin = y.row(0);
    y.rowwise() -= origin;
    solve(flat.L, {}, patch, y);
    y.rowwise() += origin;
    for (int i = 0; i < patch.moving; ++i) {
      y.row(i) += (x.row(i) - y.row(i)).dot(normal) * normal.transpose();
    }
    x = y;
  }
  return placed(mesh, patch, x);
}

}  // namespace geoprior::fluid
