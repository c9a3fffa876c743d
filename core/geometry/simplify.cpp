#include "core/geometry/simplify.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <queue>
#include <string>
#include <tuple>
#include <vector>

#include "core/error.h"
#include "core/geometry/topology.h"

namespace geoprior {
namespace {

using Quadric = Eigen::Matrix4d;

/// Share of a border edge's squared length with which its upright plane counts.
constexpr double kBorderWeight = 10;
/// Least cosine between a triangle's normals before and after a collapse: about 80 degrees.
constexpr double kLeastTurnCosine = 0.2;
/// Least quality 4 sqrt(3) area / (sum of squared edges) of a triangle that a collapse makes,
/// unless its worst one was no better before.
constexpr double kLeastQuality = 0.05;

Quadric plane_quadric(const Eigen::Vector3d& normal, const Eigen::Vector3d& through,
                      double weight) {
  const Eigen::Vector4d plane(normal.x(), normal.y(), normal.z(), -normal.dot(through));
  return weight * plane * plane.transpose();
}

struct Collapse {
  double error;
  int keep;
  int drop;
  std::array<int, 2> version;  ///< of both vertices when this was computed
  Eigen::Vector3d position;
  /// Ties break by index, so that the result does not depend on the queue.
  bool operator<(const Collapse& other) const {
    return std::tie(other.error, other.keep, other.drop) < std::tie(error, keep, drop);
  }
};

double quality(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double edges = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return edges > 0 ? 2 * std::sqrt(3.0) * (b - a).cross(c - a).norm() / edges : 0;
}

class Simplifier {
 public:
  explicit Simplifier(const TriMesh& mesh);
  TriMesh run(int target_vertices);

 private:
  [[nodiscard]] Eigen::Vector3d corner(int triangle, int k) const {
    return positions_[F_(triangle, k)];
  }
  [[nodiscard]] std::vector<int> ring(int v) const;
  [[nodiscard]] bool on_border(int a) const;
  [[nodiscard]] Collapse candidate(int a, int b) const;
  [[nodiscard]] bool keeps_manifold(const Collapse& c) const;
  [[nodiscard]] bool keeps_shape(const Collapse& c) const;
  void push_edges_of(int v);
  void apply(const Collapse& c);
  [[nodiscard]] TriMesh result() const;

  Eigen::MatrixX3i F_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Quadric> quadrics_;
  std::vector<std::vector<int>> fans_;  ///< living triangles of each vertex
  std::vector<bool> triangle_lives_;
  std::vector<int> version_;  ///< changes when a vertex or its surroundings do; -1: gone
  std::priority_queue<Collapse> queue_;
  int vertices_ = 0;
};

Simplifier::Simplifier(const TriMesh& mesh) : F_(mesh.F) {
  const std::size_t n = mesh.vertex_count();
  quadrics_.assign(n, Quadric::Zero());
  fans_.resize(n);
  version_.assign(n, -1);
  triangle_lives_.assign(F_.rows(), true);
  for (std::size_t v = 0; v < n; ++v) positions_.emplace_back(mesh.V.row(v));
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::Vector3d normal = (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
    const double area = 0.5 * normal.norm();
    for (int k = 0; k < 3; ++k) {
      const int v = F_(t, k);
      fans_[v].push_back(t);
      if (version_[v] < 0) ++vertices_;
      version_[v] = 0;
      if (area > 0) quadrics_[v] += plane_quadric(normal / (2 * area), corner(t, 0), area);
    }
  }
  for (const Edge& e : boundary_edges(F_)) {
    const int a = e[0], b = e[1];
    const Eigen::Vector3d along = positions_[b] - positions_[a];
    for (const int t : fans_[a]) {
      if (F_(t, 0) != e[1] && F_(t, 1) != e[1] && F_(t, 2) != e[1]) continue;
      const Eigen::Vector3d normal =
          (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
      const Eigen::Vector3d upright = along.cross(normal);
      if (!(upright.norm() > 0)) continue;
      const Quadric q =
          plane_quadric(upright.normalized(), positions_[a], kBorderWeight * along.squaredNorm());
      quadrics_[a] += q;
      quadrics_[b] += q;
    }
  }
}

std::vector<int> Simplifier::ring(int v) const {
  std::vector<int> neighbours;
  for (const int t : fans_[v]) {
    for (int k = 0; k < 3; ++k) {
      if (F_(t, k) != v) neighbours.push_back(F_(t, k));
    }
  }
  std::sort(neighbours.begin(), neighbours.end());
  neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
  return neighbours;
}

/// A vertex of an inner fan has as many triangles as neighbours.
bool Simplifier::on_border(int v) const { return ring(v).size() != fans_[v].size(); }

/// The point of least error for the edge: the minimum of the summed quadric where that is well
/// determined and near the edge, else the best of both ends and the middle.
Collapse Simplifier::candidate(int a, int b) const {
  const Quadric q = quadrics_[a] + quadrics_[b];
  const auto error = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector4d h = p.homogeneous();
    return std::max(0.0, h.dot(q * h));
  };
  Collapse c{0, a, b, {version_[a], version_[b]}, 0.5 * (positions_[a] + positions_[b])};
  const double length = (positions_[a] - positions_[b]).norm();
  const Eigen::Matrix3d A = q.topLeftCorner<3, 3>();
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(A);
  if (lu.rcond() > 1e-4) {
    const Eigen::Vector3d best = -lu.solve(q.topRightCorner<3, 1>());
    if ((best - c.position).norm() <= length) {
      c.position = best;
      c.error = error(best);
      return c;
    }
  }
  c.error = error(c.position);
  for (const Eigen::Vector3d& end : {positions_[a], positions_[b]}) {
    if (error(end) < c.error) {
      c.position = end;
      c.error = error(end);
    }
  }
  return c;
}

/// Link condition: the ends share exactly the vertices opposite to the edge, and a chord between
/// two border vertices is not collapsed.
bool Simplifier::keeps_manifold(const Collapse& c) const {
  const std::vector<int> ring_a = ring(c.keep), ring_b = ring(c.drop);
  std::vector<int> common;
  std::set_intersection(ring_a.begin(), ring_a.end(), ring_b.begin(), ring_b.end(),
                        std::back_inserter(common));
  std::size_t shared_triangles = 0;
  for (const int t : fans_[c.keep]) {
    for (int k = 0; k < 3; ++k) shared_triangles += F_(t, k) == c.drop ? 1 : 0;
  }
  if (common.size() != shared_triangles) return false;
  if (shared_triangles == 2 && on_border(c.keep) && on_border(c.drop)) return false;
  // A tetrahedron (or a lone triangle) has nothing to give.
  const std::size_t around = ring_a.size() + ring_b.size() - 2 - common.size();
  return around >= 3 || (shared_triangles == 1 && around >= 2);
}

bool Simplifier::keeps_shape(const Collapse& c) const {
  double worst_before = 1, worst_after = 1;
  for (const int v : {c.keep, c.drop}) {
    const int other = v == c.keep ? c.drop : c.keep;
    for (const int t : fans_[v]) {
      if (F_(t, 0) == other || F_(t, 1) == other || F_(t, 2) == other) continue;
      std::array<Eigen::Vector3d, 3> p{corner(t, 0), corner(t, 1), corner(t, 2)};
      const Eigen::Vector3d before = (p[1] - p[0]).cross(p[2] - p[0]);
      worst_before = std::min(worst_before, quality(p[0], p[1], p[2]));
      for (int k = 0; k < 3; ++k) {
        if (F_(t, k) == v) p[k] = c.position;
      }
      const Eigen::Vector3d after = (p[1] - p[0]).cross(p[2] - p[0]);
      if (before.dot(after) < kLeastTurnCosine * before.norm() * after.norm()) return false;
      worst_after = std::min(worst_after, quality(p[0], p[1], p[2]));
    }
  }
  return worst_after >= std::min(kLeastQuality, worst_before);
}

void Simplifier::push_edges_of(int v) {
  for (const int u : ring(v)) queue_.push(candidate(std::min(u, v), std::max(u, v)));
}

void Simplifier::apply(const Collapse& c) {
  std::vector<int> touched;
  for (const int t : fans_[c.drop]) {
    const bool dies = F_(t, 0) == c.keep || F_(t, 1) == c.keep || F_(t, 2) == c.keep;
    if (dies) {
      triangle_lives_[t] = false;
      for (int k = 0; k < 3; ++k) {
        if (F_(t, k) != c.drop) std::erase(fans_[F_(t, k)], t);
      }
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      if (F_(t, k) == c.drop) F_(t, k) = c.keep;
    }
    fans_[c.keep].push_back(t);
  }
  fans_[c.drop].clear();
  version_[c.drop] = -1;
  positions_[c.keep] = c.position;
  quadrics_[c.keep] += quadrics_[c.drop];
  ++version_[c.keep];
  --vertices_;
  push_edges_of(c.keep);
}

TriMesh Simplifier::result() const {
  TriMesh mesh;
  std::vector<int> index(positions_.size(), -1);
  mesh.V.resize(vertices_, 3);
  int next = 0;
  for (std::size_t v = 0; v < positions_.size(); ++v) {
    if (version_[v] < 0) continue;
    mesh.V.row(next) = positions_[v];
    index[v] = next++;
  }
  mesh.F.resize(std::count(triangle_lives_.begin(), triangle_lives_.end(), true), 3);
  Eigen::Index row = 0;
  for (int t = 0; t < F_.rows(); ++t) {
    if (!triangle_lives_[t]) continue;
    for (int k = 0; k < 3; ++k) mesh.F(row, k) = index[F_(t, k)];
    ++row;
  }
  return mesh;
}

TriMesh Simplifier::run(int target_vertices) {
  for (int v = 0; v < std::ssize(positions_); ++v) {
    for (const int u : ring(v)) {
      if (u > v) queue_.push(candidate(v, u));
    }
  }
  while (vertices_ > target_vertices && !queue_.empty()) {
    const Collapse c = queue_.top();
    queue_.pop();
    if (version_[c.keep] != c.version[0] || version_[c.drop] != c.version[1]) continue;
    if (keeps_manifold(c) && keeps_shape(c)) apply(c);
  }
  return result();
}

}  // namespace

TriMesh simplify(const TriMesh& mesh, int target_vertices) {
  if (target_vertices < 4)
    throw Error("simplification to " + std::to_string(target_vertices) + " vertices", "", ">= 4");
  if (const std::vector<Edge> bad = non_manifold_edges(mesh.F); !bad.empty()) {
    throw Error("simplification needs a manifold mesh",
                "edge " + std::to_string(bad[0][0]) + "-" + std::to_string(bad[0][1]),
                "two triangles of opposite direction at every edge");
  }
  return Simplifier(mesh).run(target_vertices);
}

}  // namespace geoprior
