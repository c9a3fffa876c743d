#include "core/geometry/curved/curved_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/connectivity.h"
#include "core/error.h"

namespace geoprior {
namespace {

using Eigen::Vector3d;

/// An edge as a triangle sees it: its ends and the normals there.
struct CurvedEdge {
  Vector3d a, b;
  Vector3d p, q;
};

/// Where an edge is bent to, and its normal there.
struct Middle {
  Vector3d rise;  ///< from the middle of the chord (m)
  Vector3d normal;
};

/// Sums are such that the edge from b to a has the same bits.
Middle middle_of(const CurvedEdge& edge) {
  constexpr double kMostFactor = 2;  // of normals 100 degrees apart; beyond there is no arc
  if (edge.p == edge.q) return {Vector3d::Zero(), edge.p};
  const Vector3d d = edge.b - edge.a;
  const double cosine = std::sqrt(std::max(0.0, (1 + edge.p.dot(edge.q)) / 2));
  const double factor = std::min(kMostFactor, 2 / std::max(1e-12, cosine * (1 + cosine)));
  const Vector3d s = (edge.p + edge.q) / 2;
  const double square = d.squaredNorm();
  const Vector3d normal = square > 0 ? Vector3d(s - 1.5 * d.dot(s) / square * d) : s;
  return {factor * (d.dot(edge.q) * edge.q - d.dot(edge.p) * edge.p) / 8,
          normal.squaredNorm() > 0 ? normal.normalized() : edge.p};
}

struct Corner {
  int vertex = 0;
  Vector3d next;      ///< normal of the edge to the next corner, here
  Vector3d previous;  ///< of the edge from the previous one, here
};

struct Triangle {
  std::array<Corner, 3> corners;
  std::array<bool, 3> settled{};  ///< whether the edge from corner k is as short as it will be
  int parent = 0;

  [[nodiscard]] bool is_settled() const { return settled[0] && settled[1] && settled[2]; }
};

/// Normal, at a corner, of a new line from it to a point of the triangle with that normal.
Vector3d normal_towards(const Corner& corner, const Vector3d& end) {
  return corner.next == corner.previous ? corner.next : end;
}

class Sampler {
 public:
  Sampler(const TriMesh& mesh, const EdgeNormals& normals, const CurvedSampling& sampling)
      : sampling_(sampling), least_cosine_(std::cos(sampling.angle / 2)) {
    for (const auto& row : mesh.V.rowwise()) place_.emplace_back(row);
    flat_ = place_;
    active_.resize(mesh.triangle_count());
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      active_[t].parent = t;
      for (int k = 0; k < 3; ++k) {
        active_[t].corners[k] = {mesh.F(t, k), normals.origin.row(3 * t + k),
                                 normals.tip.row(3 * t + (k + 2) % 3)};
      }
    }
  }

  /// Halves the edges that are bent too much. @return  whether there may be more
  bool refine() {
    if (active_.empty()) return false;
    const EdgeConnectivity edges(vertices());
    middles_.assign(edges.half_edge_count(), {});
    middle_vertex_.assign(edges.edge_count(), -1);
    for (int e = 0; e < edges.edge_count(); ++e) {
      const auto half_edges = edges.half_edges(e);
      if (settled(half_edges[0]) || halve(edges, e)) continue;
      for (const int h : half_edges) settled(h) = true;
    }
    std::vector<Triangle> before;
    before.swap(active_);
    active_.reserve(2 * before.size());
    for (std::size_t t = 0; t < before.size(); ++t) {
      parent_now_ = before[t].parent;
      divide(before[t], static_cast<int>(t), edges);
    }
    return true;
  }

  [[nodiscard]] CurvedSurface surface() const;

 private:
  [[nodiscard]] std::vector<std::array<int, 3>> vertices() const {
    std::vector<std::array<int, 3>> out;
    out.reserve(active_.size());
    for (const Triangle& t : active_) {
      out.push_back({t.corners[0].vertex, t.corners[1].vertex, t.corners[2].vertex});
    }
    return out;
  }

  bool& settled(int half_edge) { return active_[half_edge / 3].settled[half_edge % 3]; }

  /// Gives an edge its middle, if it is bent. Decides from the edge alone: all its triangles have
  /// the middle, or none.
  bool halve(const EdgeConnectivity& edges, int e) {
    const auto [a, b] = edges.edge(e);
    if ((place_[b] - place_[a]).squaredNorm() <= sampling_.shortest * sampling_.shortest) {
      return false;
    }
    Vector3d rise = Vector3d::Zero();
    double cosine = 1;
    const auto half_edges = edges.half_edges(e);
    for (const int h : half_edges) {
      const auto& corners = active_[h / 3].corners;
      const Corner& from = corners[h % 3];
      const Corner& to = corners[(h + 1) % 3];
      middles_[h] = middle_of({place_[from.vertex], place_[to.vertex], from.next, to.previous});
      rise += middles_[h].rise / static_cast<double>(half_edges.size());
      cosine = std::min(
          {cosine, from.next.dot(middles_[h].normal), to.previous.dot(middles_[h].normal)});
    }
    if (rise.norm() <= sampling_.tolerance && cosine >= least_cosine_) return false;
    middle_vertex_[e] = static_cast<int>(place_.size());
    place_.emplace_back((place_[a] + place_[b]) / 2 + rise);
    flat_.emplace_back((flat_[a] + flat_[b]) / 2);
    return true;
  }

  /// A triangle of three corners; settled edges are those of the one that is divided.
  void add(const std::array<Corner, 3>& corners, const std::array<bool, 3>& settled) {
    const Triangle triangle{corners, settled, parent_now_};
    (triangle.is_settled() ? done_ : active_).push_back(triangle);
  }

  void divide(const Triangle& t, int number, const EdgeConnectivity& edges) {
    std::array<int, 3> split{};  // middles of the edges, numbered as the corners
    int count = 0;
    for (int k = 0; k < 3; ++k) {
      split[k] = middle_vertex_[edges.edge_of(3 * number + k)];
      count += split[k] < 0 ? 0 : 1;
    }
    const Middle* m = middles_.data() + 3L * number;
    if (count == 0) return add(t.corners, t.settled);
    if (count == 3) return quarter(t, split, m);
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      if (count == 1 && split[k] >= 0) return halve_triangle(t, k, split[k], m[k].normal);
      if (count == 2 && split[k] >= 0 && split[next] >= 0) {
        return cut_corner(t, k, {split[k], split[next]}, {m[k].normal, m[next].normal});
      }
    }
  }

  /// Edge k has a middle: a line from it to the corner opposite.
  void halve_triangle(const Triangle& t, int k, int middle, const Vector3d& normal) {
    const Corner &a = t.corners[k], &b = t.corners[(k + 1) % 3], &c = t.corners[(k + 2) % 3];
    const Vector3d n = normal_towards(c, normal);
    const Corner m{middle, normal, normal};
    add({a, m, Corner{c.vertex, c.next, n}}, {false, false, t.settled[(k + 2) % 3]});
    add({m, b, Corner{c.vertex, n, c.previous}}, {false, t.settled[(k + 1) % 3], false});
  }

  /// Edge k and the next one have middles: the corner between them is cut off, the rest divided
  /// along its shorter diagonal.
  void cut_corner(const Triangle& t, int k, const std::array<int, 2>& middle,
                  const std::array<Vector3d, 2>& normal) {
    const Corner &a = t.corners[k], &b = t.corners[(k + 1) % 3], &c = t.corners[(k + 2) % 3];
    const Corner m{middle[0], normal[0], normal[0]}, n{middle[1], normal[1], normal[1]};
    const bool is_settled = t.settled[(k + 2) % 3];  // from c to a
    add({m, b, n}, {});
    const double from_a = (place_[a.vertex] - place_[n.vertex]).squaredNorm();
    const double from_c = (place_[c.vertex] - place_[m.vertex]).squaredNorm();
    if (from_a <= from_c) {
      const Vector3d at_a = normal_towards(a, n.next);
      add({Corner{a.vertex, a.next, at_a}, m, n}, {});
      add({Corner{a.vertex, at_a, a.previous}, n, c}, {false, false, is_settled});
    } else {
      const Vector3d at_c = normal_towards(c, m.next);
      add({a, m, Corner{c.vertex, c.next, at_c}}, {false, false, is_settled});
      add({m, n, Corner{c.vertex, at_c, c.previous}}, {});
    }
  }

  void quarter(const Triangle& t, const std::array<int, 3>& split, const Middle* middle) {
    std::array<Corner, 3> inner;
    for (int k = 0; k < 3; ++k) inner[k] = {split[k], middle[k].normal, middle[k].normal};
    for (int k = 0; k < 3; ++k) add({t.corners[k], inner[k], inner[(k + 2) % 3]}, {});
    add(inner, {});
  }

  /// A displacement from the flat triangle, kept within the bound.
  [[nodiscard]] Vector3d bounded(const Vector3d& u) const {
    if (!sampling_.farthest) return u;
    const double square = u.squaredNorm() / (*sampling_.farthest * *sampling_.farthest);
    return u / std::sqrt(std::sqrt(std::sqrt(1 + square * square * square * square)));
  }

  CurvedSampling sampling_;
  double least_cosine_;  ///< of half the turn that an edge may have
  std::vector<Vector3d> place_;
  std::vector<Vector3d> flat_;    ///< of the same points: where they lie on the flat triangles
  std::vector<Triangle> active_;  ///< those with edges that may have to be halved
  std::vector<Triangle> done_;
  // Of one refinement.
  std::vector<Middle> middles_;     ///< of each half-edge of an edge that may be halved
  std::vector<int> middle_vertex_;  ///< of each edge; -1: it is not halved
  int parent_now_ = -1;
};

/// Vertices, once for every normal that they have.
class SplitVertices {
 public:
  struct Point {
    int vertex;
    Vector3d normal;
    int earlier;  ///< the point of the same vertex before; -1: none
  };

  explicit SplitVertices(std::size_t vertices) : last_(vertices, -1) {}

  int find(int vertex, const Vector3d& normal) {
    for (int i = last_[vertex]; i >= 0; i = points_[i].earlier) {
      if (points_[i].normal == normal) return i;
    }
    points_.push_back({vertex, normal, last_[vertex]});
    return last_[vertex] = static_cast<int>(points_.size()) - 1;
  }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }

 private:
  std::vector<Point> points_;
  std::vector<int> last_;  ///< of each vertex; -1: none
};

CurvedSurface Sampler::surface() const {
  CurvedSurface out;
  std::vector<Vector3d> places(place_.size());
  for (std::size_t v = 0; v < place_.size(); ++v) {
    const Vector3d u = bounded(place_[v] - flat_[v]);
    out.distance = std::max(out.distance, u.norm());
    places[v] = flat_[v] + u;
  }
  SplitVertices vertices(places.size());
  out.mesh.F.resize(done_.size() + active_.size(), 3);
  for (const std::vector<Triangle>* triangles : {&done_, &active_}) {
    for (const Triangle& t : *triangles) {
      const auto row = std::ssize(out.parent);
      for (int k = 0; k < 3; ++k) {
        const Corner& corner = t.corners[k];
        const Vector3d sum = corner.next + corner.previous;
        const bool is_even = corner.next == corner.previous || sum.squaredNorm() == 0;
        out.mesh.F(row, k) =
            vertices.find(corner.vertex, is_even ? corner.next : Vector3d(sum.normalized()));
      }
      out.parent.push_back(t.parent);
    }
  }
  out.mesh.V.resize(vertices.points().size(), 3);
  out.normals.resize(vertices.points().size(), 3);
  for (int i = 0; i < std::ssize(vertices.points()); ++i) {
    out.mesh.V.row(i) = places[vertices.points()[i].vertex];
    out.normals.row(i) = vertices.points()[i].normal;
  }
  return out;
}

}  // namespace

EdgeNormals EdgeNormals::zero(Eigen::Index triangles) {
  return {Eigen::MatrixX3d::Zero(3 * triangles, 3), Eigen::MatrixX3d::Zero(3 * triangles, 3)};
}

CurvedSurface curved_surface(const TriMesh& mesh, const EdgeNormals& normals,
                             const CurvedSampling& sampling) {
  const Eigen::Index half_edges = 3 * mesh.F.rows();
  if (normals.origin.rows() != half_edges || normals.tip.rows() != half_edges) {
    throw Error("has " + std::to_string(normals.origin.rows()) + " and " +
                    std::to_string(normals.tip.rows()) + " normals",
                "curved_surface", std::to_string(half_edges) + " half-edges");
  }
  constexpr int kMostSteps = 12;
  Sampler sampler(mesh, normals, sampling);
  for (int step = 0; step < kMostSteps && sampler.refine(); ++step) {
  }
  return sampler.surface();
}

}  // namespace geoprior
