#include "solvers/sketch/pattern/level_lines.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>

#include "core/connectivity.h"
#include "core/disjoint_sets.h"
#include "models/sketch/surface/cotangent_weights.h"
#include "models/sketch/surface/position_cholesky.h"

namespace geoprior::sketch {
namespace {

/// Of an edge's length, nearer than which no line comes to a vertex.
constexpr double kOffVertex = 1e-3;

/// Follows the line through triangles, from one crossed edge to the next.
class LevelTracer {
 public:
  LevelTracer(const TriMesh& mesh, const Eigen::VectorXd& value)
      : mesh_(mesh), value_(value), edges_(mesh.F), done_(edges_.edge_count(), 0) {}

  std::vector<SurfacePath> trace() {
    std::vector<SurfacePath> lines;
    for (const bool from_border : {true, false}) {
      for (int e = 0; e < edges_.edge_count(); ++e) {
        const bool at_border = edges_.half_edges(e).size() == 1;
        if (done_[e] || !is_crossed(e) || at_border != from_border) continue;
        lines.push_back(follow(e));
      }
    }
    return lines;
  }

 private:
  [[nodiscard]] bool is_crossed(int e) const {
    return (value_(edges_.edge(e)[0]) > 0) != (value_(edges_.edge(e)[1]) > 0);
  }

  [[nodiscard]] EdgePoint crossing(int e) const {
    const Edge edge = edges_.edge(e);
    const double a = value_(edge[0]), b = value_(edge[1]);
    return {edge, std::clamp(a / (a - b), kOffVertex, 1 - kOffVertex)};
  }

  [[nodiscard]] EdgePoint end(int e) const {
    const EdgePoint at = crossing(e);
    return at_vertex(at.edge[at.share > 0.5 ? 1 : 0]);
  }

  SurfacePath follow(int start) {
    const bool open = edges_.half_edges(start).size() == 1;
    SurfacePath line{open ? end(start) : crossing(start)};
    int edge = start, triangle = edges_.half_edges(start)[0] / 3;
    while (true) {
      done_[edge] = 1;
      int next = -1;
      for (int k = 0; k < 3; ++k) {
        const int other = edges_.edge_of(3 * triangle + k);
        if (other != edge && is_crossed(other)) next = other;
      }
      if (next < 0) return line;
      if (next == start) {
        line.push_back(line.front());
        return line;
      }
      edge = next;
      if (edges_.half_edges(edge).size() == 1) {
        done_[edge] = 1;
        line.push_back(end(edge));
        return line;
      }
      line.push_back(crossing(edge));
      const auto both = edges_.half_edges(edge);
      triangle = both[0] / 3 == triangle ? both[1] / 3 : both[0] / 3;
    }
  }

  const TriMesh& mesh_;
  const Eigen::VectorXd& value_;
  EdgeConnectivity edges_;
  std::vector<char> done_;
};

}  // namespace

std::vector<SurfacePath> level_lines(const TriMesh& mesh, const Eigen::VectorXd& value,
                                     double shortest) {
  std::vector<SurfacePath> lines = LevelTracer(mesh, value).trace();
  std::erase_if(lines, [&](const SurfacePath& line) {
    return line.size() < 3 || length(line, mesh.V) < shortest;
  });
  return lines;
}

Eigen::VectorXd smoothed_over(const TriMesh& mesh, const Eigen::VectorXd& value, double width) {
  const int n = mesh.vertex_count();
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(n);
  const Eigen::VectorXd areas = triangle_areas(mesh.V, mesh.F);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) mass(mesh.F(t, k)) += areas(t) / 3;
  }
  Eigen::SparseMatrix<double> A =
      width * width * cotangent_stiffness(mesh.F, corner_cotangents(mesh) / 2, n);
  const double least = 1e-12 * mass.maxCoeff();
  for (int v = 0; v < n; ++v) A.coeffRef(v, v) += std::max(mass(v), least);
  Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(n, 3);
  u.col(0) = mass.cwiseMax(least).cwiseProduct(value);
  PositionCholesky(A, "smoothing of parts").solve(u);
  return u.col(0);
}

std::vector<SurfacePath> faired_cut(const TriMesh& mesh, const std::vector<SurfacePath>& cut,
                                    double width) {
  const int n = mesh.vertex_count();
  const EdgeConnectivity edges(mesh.F);
  std::vector<char> on_cut(n, 0), crossed(edges.edge_count(), 0);
  for (const SurfacePath& path : cut) {
    for (const EdgePoint& point : path) {
      if (point.is_vertex()) {
        on_cut[point.edge[0]] = 1;
      } else {
        crossed[*edges.find(point.edge[0], point.edge[1])] = 1;
      }
    }
  }
  DisjointSets parts(n);
  for (int e = 0; e < edges.edge_count(); ++e) {
    const Edge edge = edges.edge(e);
    if (!crossed[e] && !on_cut[edge[0]] && !on_cut[edge[1]]) parts.join(edge[0], edge[1]);
  }
  std::map<int, int> size;
  for (int v = 0; v < n; ++v) {
    if (!on_cut[v]) ++size[parts.find(v)];
  }
  std::vector<std::pair<int, int>> largest;
  for (const auto& [part, count] : size) largest.emplace_back(-count, part);
  std::sort(largest.begin(), largest.end());
  // Single vertices between a path and a border are no parts.
  if (largest.size() < 2 || (largest.size() > 2 && -largest[2].first > 3)) return {};
  Eigen::VectorXd value = Eigen::VectorXd::Zero(n);
  for (int v = 0; v < n; ++v) {
    if (on_cut[v]) continue;
    const int part = parts.find(v);
    value(v) = part == largest[0].second ? 1 : part == largest[1].second ? -1 : 0;
  }
  return level_lines(mesh, smoothed_over(mesh, value, width), 4 * width);
}

}  // namespace geoprior::sketch
