#include "metrics/developability/crease_turning.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "core/connectivity.h"
#include "core/error.h"

namespace geoprior {
namespace {

/// Straight line y = a + b x of weighted points; its slope.
struct SlopeFit {
  double w = 0, x = 0, y = 0, xx = 0, xy = 0;
  int count = 0;
  void add(double weight, double at, double value) {
    w += weight;
    x += weight * at;
    y += weight * value;
    xx += weight * at * at;
    xy += weight * at * value;
    ++count;
  }
  /// 0 where the points do not tell it: fewer than three, or all at one place.
  [[nodiscard]] double slope(double scale) const {
    if (count < 3) return 0;
    const double spread = xx - x * x / w;
    return spread > 1e-4 * w * scale * scale ? (xy - x * y / w) / spread : 0;
  }
};

class EdgeTurns {
 public:
  EdgeTurns(const TriMesh& mesh, const std::vector<bool>& left_out)
      : mesh_(mesh),
        left_out_(left_out),
        edges_(mesh.F),
        normals_(triangle_normals(mesh)),
        centre_(mesh.F.rows(), 3),
        area_(mesh.F.rows()),
        seen_(mesh.F.rows(), -1) {
    for (int t = 0; t < mesh.F.rows(); ++t) {
      const Eigen::Vector3d a = vertex(mesh.F(t, 0)), b = vertex(mesh.F(t, 1)),
                            c = vertex(mesh.F(t, 2));
      centre_.row(t) = ((a + b + c) / 3).transpose();
      area_(t) = (b - a).cross(c - a).norm() / 2;
    }
    double length = 0;
    for (const auto& [a, b] : edges_.edges()) length += (vertex(a) - vertex(b)).norm();
    mean_edge_ = edges_.edge_count() > 0 ? length / edges_.edge_count() : 0;
  }

  [[nodiscard]] std::vector<EdgeTurn> all() {
    std::vector<EdgeTurn> turns(edges_.edge_count());
    for (int e = 0; e < edges_.edge_count(); ++e) turns[e] = turn(e);
    return turns;
  }
  [[nodiscard]] const EdgeConnectivity& edges() const { return edges_; }
  [[nodiscard]] bool counts(int edge) const {
    const std::span<const int> sides = edges_.half_edges(edge);
    const auto [a, b] = edges_.edge(edge);
    return sides.size() == 2 && (left_out_.empty() || !left_out_[a] || !left_out_[b]) &&
           area_(sides[0] / 3) > 0 && area_(sides[1] / 3) > 0;
  }

 private:
  [[nodiscard]] Eigen::Vector3d vertex(int v) const { return mesh_.V.row(v).transpose(); }
  [[nodiscard]] Eigen::Vector3d normal(int t) const { return normals_.row(t).transpose(); }

  /// Adds the triangles of one side, from one of the edge's own, to a fit of their angle about the
  /// edge against their distance from it.
  [[nodiscard]] double slope(int edge, int start, const Eigen::Vector3d& middle,
                             const Eigen::Vector3d& across, const Eigen::Vector3d& up) {
    const double reach = 2.5 * mean_edge_;
    SlopeFit fit;
    queue_.assign(1, start);
    seen_[start] = edge;
    const Eigen::Vector3d first = centre_.row(start).transpose() - middle;
    const double side = first.dot(across) < 0 ? -1 : 1;
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      const int t = queue_[i];
      const double at = (centre_.row(t).transpose() - middle).dot(across);
      const Eigen::Vector3d n = normal(t);
      fit.add(area_(t), at, std::atan2(n.dot(across), n.dot(up)));
      for (int k = 0; k < 3; ++k) {
        const int through = edges_.edge_of(3 * t + k), next = edges_.across(t, k);
        if (next < 0 || seen_[next] == edge || !counts(through)) continue;
        const Eigen::Vector3d away = centre_.row(next).transpose() - middle;
        if (away.norm() > reach || side * away.dot(across) <= 0) continue;
        seen_[next] = edge;
        queue_.push_back(next);
      }
    }
    return fit.slope(mean_edge_);
  }

  [[nodiscard]] EdgeTurn turn(int e) {
    if (!counts(e)) return {};
    const std::span<const int> sides = edges_.half_edges(e);
    const int left = sides[0] / 3, right = sides[1] / 3;
    const Eigen::Vector3d a = vertex(edges_.origin(sides[0])), b = vertex(edges_.tip(sides[0]));
    const Eigen::Vector3d n = normal(left), m = normal(right), along = b - a;
    const double length = along.norm();
    if (!(length > 0)) return {};
    // The left triangle lies to the left of a -> b seen from outside: across points to the right.
    const double angle = std::atan2(n.cross(m).dot(along) / length, n.dot(m));
    const Eigen::Vector3d sum = n + m;
    if (sum.norm() < 1e-9) return {angle, std::abs(angle)};
    const Eigen::Vector3d up = sum.normalized(), across = along.cross(up).normalized();
    const Eigen::Vector3d middle = (a + b) / 2;
    const double sign = angle < 0 ? -1 : 1;
    seen_[left] = seen_[right] = e;
    const double bend = std::max({0.0, sign * slope(e, left, middle, across, up),
                                  sign * slope(e, right, middle, across, up)});
    const double width = (area_(left) + area_(right)) / length;
    return {angle, std::max(0.0, std::abs(angle) - width * bend)};
  }

  const TriMesh& mesh_;
  const std::vector<bool>& left_out_;
  EdgeConnectivity edges_;
  Eigen::MatrixX3d normals_, centre_;
  Eigen::VectorXd area_;
  std::vector<int> seen_, queue_;  ///< edge that saw a triangle last; triangles of a side
  double mean_edge_ = 0;
};

void check_arguments(const TriMesh& mesh, double crease, const std::vector<bool>& left_out) {
  if (!(crease > 0))
    throw Error(std::to_string(crease) + " rad", "crease turning", "a positive angle");
  if (!left_out.empty() && std::ssize(left_out) != mesh.vertex_count())
    throw Error(std::to_string(left_out.size()) + " values", "crease turning", "one a vertex");
}

/// Edges of creases that run on in clean lines.
class CleanLines {
 public:
  CleanLines(const TriMesh& mesh, const EdgeConnectivity& edges, const std::vector<EdgeTurn>& turns,
             double crease)
      : mesh_(mesh), edges_(edges), at_(mesh.vertex_count()), turns_(turns) {
    for (int e = 0; e < edges.edge_count(); ++e) {
      if (turns[e].excess <= crease) continue;
      for (const int v : edges.edge(e)) at_[v].push_back(e);
    }
  }

  /// For each edge whether it is of a clean line.
  [[nodiscard]] std::vector<char> find() const {
    constexpr int kLeast = 4;
    std::vector<char> clean(edges_.edge_count(), 0), visited(edges_.edge_count(), 0);
    for (int e = 0; e < edges_.edge_count(); ++e) {
      const auto [a, b] = edges_.edge(e);
      const bool in = std::find(at_[a].begin(), at_[a].end(), e) != at_[a].end();
      if (!in || visited[e]) continue;
      std::vector<int> line{e};
      visited[e] = 1;
      walk(e, a, visited, line);
      walk(e, b, visited, line);
      if (std::ssize(line) >= kLeast) {
        for (const int of : line) clean[of] = 1;
      }
    }
    return clean;
  }

 private:
  [[nodiscard]] Eigen::Vector3d direction(int edge, int from) const {
    const auto [a, b] = edges_.edge(edge);
    const Eigen::Vector3d d = (mesh_.V.row(a == from ? b : a) - mesh_.V.row(from)).transpose();
    return d.normalized();
  }
  /// Follows a line through a vertex until it ends: freely, in a branch, or where it turns sharply
  /// or the other way.
  void walk(int edge, int vertex, std::vector<char>& visited, std::vector<int>& line) const {
    while (at_[vertex].size() == 2) {
      const std::vector<int>& here = at_[vertex];
      const int next = here[0] == edge ? here[1] : here[0];
      const double straight = -direction(edge, vertex).dot(direction(next, vertex));
      if (straight < std::cos(35 * kDegree) || turns_[edge].angle * turns_[next].angle < 0) return;
      if (visited[next]) return;
      visited[next] = 1;
      line.push_back(next);
      const auto [a, b] = edges_.edge(next);
      vertex = a == vertex ? b : a;
      edge = next;
    }
  }

  const TriMesh& mesh_;
  const EdgeConnectivity& edges_;
  std::vector<std::vector<int>> at_;  ///< edges of creases at each vertex
  const std::vector<EdgeTurn>& turns_;
};

/// What a share of the total weight stays under.
double length_quantile(std::vector<std::pair<double, double>>& value_weight, double share) {
  std::sort(value_weight.begin(), value_weight.end());
  double all = 0, sum = 0;
  for (const auto& [value, weight] : value_weight) all += weight;
  for (const auto& [value, weight] : value_weight) {
    sum += weight;
    if (sum >= share * all) return value;
  }
  return 0;
}

}  // namespace

std::vector<EdgeTurn> edge_turns(const TriMesh& mesh, const std::vector<bool>& left_out) {
  check_arguments(mesh, kCreaseTurn, left_out);
  return EdgeTurns(mesh, left_out).all();
}

CreaseMeasures crease_measures(const TriMesh& mesh, double crease,
                               const std::vector<bool>& left_out) {
  check_arguments(mesh, crease, left_out);
  EdgeTurns of(mesh, left_out);
  const std::vector<EdgeTurn> turns = of.all();
  const EdgeConnectivity& edges = of.edges();
  const std::vector<char> clean = CleanLines(mesh, edges, turns, crease).find();
  CreaseMeasures m;
  double saw = 0;
  std::vector<std::pair<double, double>> excesses;
  for (int e = 0; e < edges.edge_count(); ++e) {
    if (!of.counts(e)) continue;
    const auto [a, b] = edges.edge(e);
    const double length = (mesh.V.row(a) - mesh.V.row(b)).norm(), excess = turns[e].excess;
    excesses.emplace_back(excess, length);
    if (excess <= crease) continue;
    m.turning += length * excess;
    m.length += length;
    (clean[e] ? m.clean_length : saw) += clean[e] ? length : length * excess;
  }
  if (m.turning > 0) m.saw_share = saw / m.turning;
  m.rest_p95 = length_quantile(excesses, 0.95);
  return m;
}

}  // namespace geoprior
