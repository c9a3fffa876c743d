#include "experiments/details/drawing/hole_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/disjoint_sets.h"
#include "core/geometry/planar.h"

namespace geoprior::details {

HoleMesh::HoleMesh(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x,
                   std::span<const Eigen::Vector3d> normals)
    : x_(x.begin(), x.end()),
      normal_(normals.begin(), normals.end()),
      first_(x.size(), -1),
      corner_(surface.face),
      across_(surface.across) {}

void HoleMesh::add(int number, const HoleChart& chart) {
  const int hole = static_cast<int>(hole_.size());
  hole_.push_back({number, chart.radius, 0});
  for (const ChartVertex& v : chart.vertices) add_entry(v.vertex, hole, v.at);
  touched_.insert(touched_.end(), chart.faces.begin(), chart.faces.end());
}

const HoleMesh::Entry* HoleMesh::entry(int vertex, int hole) const {
  for (int e = first_[vertex]; e >= 0; e = entry_[e].next)
    if (entry_[e].hole == hole) return &entry_[e];
  return nullptr;
}

void HoleMesh::add_entry(int vertex, int hole, const Eigen::Vector2d& at) {
  entry_.push_back({hole, at, first_[vertex]});
  first_[vertex] = static_cast<int>(entry_.size()) - 1;
}

double HoleMesh::length2(int a, int b) const {
  // Both triangles of an edge must see the same bits, because bisection compares lengths.
  return (x_[std::max(a, b)] - x_[std::min(a, b)]).squaredNorm();
}

int HoleMesh::longest_edge(int t) const {
  const auto& c = corner_[t];
  const auto key = [&](int k) {
    const int a = c[k], b = c[(k + 1) % 3];
    return std::tuple(length2(a, b), std::min(a, b), std::max(a, b));
  };
  int longest = 0;
  for (const int k : {1, 2})
    if (key(k) > key(longest)) longest = k;
  return longest;
}

bool HoleMesh::crossed_by(int t, int hole) const {
  std::array<Eigen::Vector2d, 3> u;
  for (std::size_t k = 0; k < 3; ++k) {
    const Entry* e = entry(corner_[t][k], hole);
    if (e == nullptr) return false;
    u[k] = e->at;
  }
  const double radius = hole_[hole].radius;
  if (radius == 0) return false;  // given up
  if (std::max({u[0].norm(), u[1].norm(), u[2].norm()}) < radius) return false;
  int left = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto &a = u[k], &b = u[(k + 1) % 3];
    if (distance_to_segment(a, b) < radius) return true;
    left += cross(a, b) > 0 ? 1 : 0;
  }
  return left == 3 || left == 0;  // the disc lies inside
}

bool HoleMesh::too_large(int t) const {
  const int k = longest_edge(t);
  const double length = std::sqrt(length2(corner_[t][k], corner_[t][(k + 1) % 3]));
  for (int e = first_[corner_[t][0]]; e >= 0; e = entry_[e].next) {
    const int hole = entry_[e].hole;
    if (length > hole_[hole].longest && crossed_by(t, hole)) return true;
  }
  return false;
}

int HoleMesh::add_middle(int a, int b) {
  const int middle = static_cast<int>(x_.size());
  x_.push_back(0.5 * (x_[a] + x_[b]));
  normal_.push_back((normal_[a] + normal_[b]).stableNormalized());
  first_.push_back(-1);
  for (int e = first_[a]; e >= 0; e = entry_[e].next) {
    const int hole = entry_[e].hole;
    if (const Entry* other = entry(b, hole)) {
      const Eigen::Vector2d at = 0.5 * (entry_[e].at + other->at);
      add_entry(middle, hole, at);
    }
  }
  return middle;
}

/// Triangle a, b, c becomes a, m, c; the new one is m, b, c. Edge 0 of both is that on a-b.
int HoleMesh::halve(int t, int edge, int middle) {
  const auto c = corner_[t];
  const auto n = across_[t];
  const int k = edge, l = (k + 1) % 3, m = (k + 2) % 3;
  const int half = static_cast<int>(corner_.size());
  corner_[t] = {c[k], middle, c[m]};
  across_[t] = {-1, half, n[m]};
  corner_.push_back({middle, c[l], c[m]});
  across_.push_back({-1, n[l], t});
  if (n[l] >= 0) {
    auto& back = across_[n[l]];
    // By corners: two triangles may share more than one edge.
    for (std::size_t j = 0; j < 3; ++j)
      if (back[j] == t && corner_[n[l]][j] == c[m]) back[j] = half;
  }
  return half;
}

void HoleMesh::bisect(int t, std::vector<int>& changed) {
  for (;;) {
    const int k = longest_edge(t);
    const int a = corner_[t][k], b = corner_[t][(k + 1) % 3];
    const int g = across_[t][k];
    int l = 0;
    if (g >= 0) {
      l = longest_edge(g);
      if (corner_[g][l] != b || corner_[g][(l + 1) % 3] != a) {
        t = g;
        continue;
      }
    }
    const int middle = add_middle(a, b);
    const int t2 = halve(t, k, middle);
    changed.insert(changed.end(), {t, t2});
    if (g < 0) return;
    const int g2 = halve(g, l, middle);
    changed.insert(changed.end(), {g, g2});
    across_[t][0] = g2;
    across_[g2][0] = t;
    across_[t2][0] = g;
    across_[g][0] = t2;
    return;
  }
}

void HoleMesh::refine_borders(int segments, std::vector<int> stack) {
  // The border cuts triangles of longest edge h, halved again and again, about every h / 2.
  for (Hole& hole : hole_) hole.longest = 2.1 * 2 * std::numbers::pi * hole.radius / segments;
  while (!stack.empty()) {
    const int t = stack.back();
    stack.pop_back();
    if (!too_large(t)) continue;
    stack.push_back(t);
    bisect(t, stack);
  }
}

void HoleMesh::refine(int segments, double least) {
  std::vector<int> look_at(touched_.rbegin(), touched_.rend());
  for (bool settled = false; !settled;) {
    settled = true;
    refine_borders(segments, std::move(look_at));
    std::vector<int> inside = hole_of_vertices();
    keep_whole(inside);
    const std::vector<char> trouble = holes_in_trouble(inside);
    for (std::size_t i = 0; i < hole_.size(); ++i) {
      if (trouble[i] == 0 || hole_[i].radius == 0) continue;
      settled = false;
      hole_[i].radius *= 0.9;
      if (hole_[i].radius < least) hole_[i].radius = 0;
    }
    look_at.resize(corner_.size());
    std::iota(look_at.begin(), look_at.end(), 0);
  }
}

std::vector<int> HoleMesh::hole_of_vertices() const {
  std::vector<int> inside(x_.size(), -1);
  for (std::size_t v = 0; v < x_.size(); ++v) {
    for (int e = first_[v]; e >= 0; e = entry_[e].next) {
      const auto& [hole, place, next] = entry_[e];
      if (place.norm() < hole_[hole].radius) inside[v] = hole;
    }
  }
  return inside;
}

/// Every hole in one piece, and what remains too: of several pieces the largest stays what it is
/// (a chart that folds on a rough surface leaves single vertices behind).
void HoleMesh::keep_whole(std::vector<int>& inside) const {
  // Vertices joined by edges, within holes and in all; a set is named by its lowest vertex.
  DisjointSets pieces(static_cast<int>(x_.size())), whole(pieces.size());
  for (const auto& c : corner_) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = c[k], b = c[(k + 1) % 3];
      if (inside[a] == inside[b]) pieces.join(a, b);
      whole.join(a, b);
    }
  }
  std::vector<int> size(x_.size(), 0);
  for (int v = 0; v < std::ssize(x_); ++v) ++size[pieces.find(v)];
  // The largest piece of each hole, and of each connected surface.
  std::vector<int> largest(hole_.size() + x_.size(), -1);
  const auto owner = [&](int v) {
    const int hole = inside[v];
    return hole >= 0 ? hole : static_cast<int>(hole_.size()) + whole.find(v);
  };
  for (int v = 0; v < std::ssize(x_); ++v) {
    int& best = largest[owner(v)];
    if (pieces.find(v) == v && (best < 0 || size[v] > size[best])) best = v;
  }
  std::vector<int> corrected(x_.size(), -2);  // of strays: what they become
  for (const auto& c : corner_) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (const auto& [v, w] :
           {std::pair(c[k], c[(k + 1) % 3]), std::pair(c[(k + 1) % 3], c[k])}) {
        if (inside[v] == inside[w] || largest[owner(v)] == pieces.find(v)) continue;
        int& to = corrected[pieces.find(v)];
        to = std::max(to, inside[v] >= 0 ? -1 : inside[w]);
      }
    }
  }
  std::vector<int> result = inside;
  for (int v = 0; v < std::ssize(x_); ++v)
    if (const int to = corrected[pieces.find(v)]; to > -2) result[v] = to;
  inside = std::move(result);
}

/// Holes that share a vertex or an edge with another, reach the border of the surface, or are no
/// discs: the Euler characteristic of their vertices with all edges and triangles between them is
/// not 1.
std::vector<char> HoleMesh::holes_in_trouble(const std::vector<int>& inside) const {
  std::vector<char> trouble(hole_.size(), 0);
  std::vector<int> euler(hole_.size(), 0);
  for (std::size_t v = 0; v < x_.size(); ++v) {
    const int hole = inside[v];
    if (hole < 0) continue;
    ++euler[hole];
    for (int e = first_[v]; e >= 0; e = entry_[e].next) {
      const auto& [other, place, next] = entry_[e];
      if (other != hole && place.norm() < hole_[other].radius) trouble[hole] = trouble[other] = 1;
    }
  }
  for (std::size_t t = 0; t < corner_.size(); ++t) {
    const auto& c = corner_[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = inside[c[k]], b = inside[c[(k + 1) % 3]];
      if (a < 0) continue;
      if (b >= 0 && a != b) trouble[a] = trouble[b] = 1;
      if (across_[t][k] < 0) trouble[a] = 1;
      if (a == b && c[k] < c[(k + 1) % 3]) --euler[a];
      if (k == 0 && a == b && inside[c[2]] == a) ++euler[a];
    }
  }
  for (std::size_t i = 0; i < hole_.size(); ++i)
    if (euler[i] != 1) trouble[i] = 1;
  return trouble;
}

/// Share of the way from a vertex in a hole to one outside where the distance is the radius.
double HoleMesh::place_of_border(int in, int out, int hole) const {
  const Entry *a = entry(in, hole), *b = entry(out, hole);
  double t = 0.5;
  if (a != nullptr && b != nullptr) {
    const Eigen::Vector2d e = b->at - a->at;
    const double radius = hole_[hole].radius;
    const double half = a->at.dot(e), c = a->at.squaredNorm() - radius * radius;
    const double root = half * half - e.squaredNorm() * c;
    if (root > 0) t = (std::sqrt(root) - half) / e.squaredNorm();
  }
  return std::clamp(t, 1e-3, 1 - 1e-3);
}

/// Cuts triangle by triangle; border vertices are made when they are first met.
class HoleMesh::TriangleCutter {
 public:
  TriangleCutter(const HoleMesh& mesh, const std::vector<int>& inside,
                 const std::vector<int>& on_border, HoledMesh& cut)
      : mesh_(mesh),
        inside_(inside),
        on_border_(on_border),
        cut_(cut),
        made_(mesh.corner_.size(), {-1, -1, -1}) {}

  /// What is kept of a triangle: all of it, a piece, or two.
  void cut(int t) {
    const auto& c = mesh_.corner_[t];
    const auto in = [&](std::size_t k) { return inside_[c[k % 3]] >= 0; };
    const auto out = [&](std::size_t k) { return !in(k) && on_border_[c[k % 3]] < 0; };
    const int ins = in(0) + in(1) + in(2), outs = out(0) + out(1) + out(2);
    if (outs == 0) return;
    std::size_t k = 0;
    if (ins == 0) {
      cut_.triangle.push_back(c);
    } else if (ins + outs == 2) {  // one corner on the border, one on either side
      while (!in(k)) ++k;
      auto piece = c;
      piece[k] = border_vertex(t, out(k + 1) ? k : (k + 2) % 3);
      cut_.triangle.push_back(piece);
    } else {
      while (in(k) == in(k + 1) || in(k) == in(k + 2)) ++k;  // differs from the other two
      const int p = border_vertex(t, k), q = border_vertex(t, (k + 2) % 3);
      if (ins == 2)
        cut_.triangle.push_back({c[k], p, q});
      else
        add_quadrilateral(p, c[(k + 1) % 3], c[(k + 2) % 3], q);
    }
  }

 private:
  void add_quadrilateral(int a, int b, int c, int d) {
    const auto& x = cut_.x;
    if ((x[a] - x[c]).norm() < (x[b] - x[d]).norm())
      cut_.triangle.insert(cut_.triangle.end(), {{a, b, c}, {a, c, d}});
    else
      cut_.triangle.insert(cut_.triangle.end(), {{a, b, d}, {b, c, d}});
  }

  /// The vertex at which the hole's border crosses edge `k` of triangle `t`; makes it the first
  /// time.
  int border_vertex(int t, std::size_t k) {
    if (const int vertex = made_[t][k]; vertex >= 0) return vertex;
    int in = mesh_.corner_[t][k], out = mesh_.corner_[t][(k + 1) % 3];
    const int first = out;
    if (inside_[in] < 0) std::swap(in, out);
    const int hole = inside_[in];
    const double s = mesh_.place_of_border(in, out, hole);
    const int vertex = static_cast<int>(cut_.x.size());
    cut_.x.push_back((1 - s) * mesh_.x_[in] + s * mesh_.x_[out]);
    cut_.normal.push_back(
        ((1 - s) * mesh_.normal_[in] + s * mesh_.normal_[out]).stableNormalized());
    cut_.hole.push_back(mesh_.hole_[hole].number);
    made_[t][k] = vertex;
    if (const int g = mesh_.across_[t][k]; g >= 0) {
      for (std::size_t j = 0; j < 3; ++j)
        if (mesh_.across_[g][j] == t && mesh_.corner_[g][j] == first) made_[g][j] = vertex;
    }
    return vertex;
  }

  const HoleMesh& mesh_;
  const std::vector<int>&inside_, &on_border_;
  HoledMesh& cut_;
  std::vector<std::array<int, 3>> made_;
};

HoledMesh HoleMesh::cut() {
  std::vector<int> inside = hole_of_vertices(), on_border(x_.size(), -1);
  keep_whole(inside);
  snap_to_borders(inside, on_border);
  HoledMesh cut;
  cut.x = x_;
  cut.normal = normal_;
  cut.hole.assign(x_.size(), -1);
  for (std::size_t v = 0; v < x_.size(); ++v)
    if (on_border[v] >= 0) cut.hole[v] = hole_[on_border[v]].number;
  TriangleCutter cutter(*this, inside, on_border, cut);
  for (int t = 0; t < std::ssize(corner_); ++t) cutter.cut(t);
  return cut;
}

/// Moves vertices onto the borders, one by one, nearest first.
///
/// A vertex is then in a hole, outside, or on a border. A triangle counts as kept when a corner is
/// outside; one with corners on the border and inside only is dropped. The result is a manifold
/// when around every vertex on a border the kept triangles hang together; a move after which they
/// would not is refused.
class HoleMesh::Snapper {
 public:
  Snapper(HoleMesh& mesh, std::vector<int>& inside, std::vector<int>& on_border)
      : mesh_(mesh), inside_(inside), on_border_(on_border), triangle_of_(mesh.x_.size(), -1) {
    for (int t = 0; t < std::ssize(mesh.corner_); ++t)
      for (const int v : mesh.corner_[t]) triangle_of_[v] = t;
  }

  void run() {
    for (const Move& move : moves()) try_move(move);
  }

 private:
  struct Move {
    double share = 1;  ///< of the edge
    int vertex = -1;
    int toward = -1;
  };
  static constexpr double kFar = 0.3;         ///< largest share of an edge that a vertex moves
  static constexpr double kNeedle = 0.2;      ///< least shape of a triangle after a move
  static constexpr double kTurnCosine = 0.9;  ///< of a triangle by a move

  [[nodiscard]] bool is_in(int v) const { return inside_[v] >= 0; }
  [[nodiscard]] bool is_on(int v) const { return on_border_[v] >= 0; }
  [[nodiscard]] bool is_out(int v) const { return !is_in(v) && !is_on(v); }
  [[nodiscard]] const Eigen::Vector3d& x(int v) const { return mesh_.x_[v]; }

  /// The shortest way of each vertex to a border along an edge, where it is short enough.
  [[nodiscard]] std::vector<Move> moves() const {
    std::vector<Move> best(mesh_.x_.size());
    for (const auto& c : mesh_.corner_) {
      for (std::size_t k = 0; k < 3; ++k) {
        int a = c[k], b = c[(k + 1) % 3];
        if (is_in(a) == is_in(b)) continue;
        if (!is_in(a)) std::swap(a, b);
        const double s = mesh_.place_of_border(a, b, inside_[a]);
        if (s < kFar && s < best[a].share) best[a] = {s, a, b};
        if (1 - s < kFar && 1 - s < best[b].share) best[b] = {1 - s, b, a};
      }
    }
    std::erase_if(best, [](const Move& m) { return m.vertex < 0; });
    std::sort(best.begin(), best.end(), [](const Move& a, const Move& b) {
      return std::tie(a.share, a.vertex) < std::tie(b.share, b.vertex);
    });
    return best;
  }

  /// Neighbours in cyclic order; empty at a border of the surface.
  [[nodiscard]] std::vector<int> ring_of(int v) const {
    std::vector<int> ring;
    const int first = triangle_of_[v];
    int t = first;
    do {
      const auto& c = mesh_.corner_[t];
      const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
      ring.push_back(c[(k + 1) % 3]);
      t = mesh_.across_[t][(k + 2) % 3];
      if (t < 0) return {};
    } while (t != first);
    return ring;
  }

  /// Whether the triangles kept about a ring are one run with one gap.
  [[nodiscard]] bool is_simple(const std::vector<int>& ring) const {
    const std::size_t n = ring.size();
    int runs = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const int before = ring[(i + n - 1) % n], w = ring[i], after = ring[(i + 1) % n];
      const bool joined = !is_in(w) && (is_out(before) || is_out(w));
      if ((is_out(w) || is_out(after)) && !joined) ++runs;
    }
    return runs == 1;
  }

  /// Twice the area over the square of the longest edge: 0.87 for equal sides.
  static double shape(const Eigen::Vector3d& normal, const Eigen::Vector3d& a,
                      const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    return normal.norm() /
           std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  }

  /// Whether the pieces around `v` would keep their side and be no needles were it at `to`.
  [[nodiscard]] bool keeps_shape(int v, const std::vector<int>& ring,
                                 const Eigen::Vector3d& to) const {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const int a = ring[i], b = ring[(i + 1) % ring.size()];
      if (!is_out(a) && !is_out(b)) continue;
      const Eigen::Vector3d pa = is_in(a) ? border_between(a, b) : x(a);
      const Eigen::Vector3d pb = is_in(b) ? border_between(b, a) : x(b);
      const Eigen::Vector3d before = (x(a) - x(v)).cross(x(b) - x(v));
      const Eigen::Vector3d after = (pa - to).cross(pb - to);
      if (!is_in(a) && !is_in(b) &&
          shape(after, to, pa, pb) < std::min(kNeedle, 0.5 * shape(before, x(v), pa, pb)))
        return false;
      if (!(after.dot(before) > kTurnCosine * after.norm() * before.norm())) return false;
    }
    return true;
  }

  [[nodiscard]] Eigen::Vector3d border_between(int in, int out) const {
    const double s = mesh_.place_of_border(in, out, inside_[in]);
    return (1 - s) * x(in) + s * x(out);
  }

  void try_move(const Move& move) {
    const int v = move.vertex;
    const std::vector<int> ring = ring_of(v);
    if (ring.empty() || is_on(move.toward)) return;
    const int hole = inside_[is_in(v) ? v : move.toward], was_in = inside_[v];
    for (const int w : ring) {
      if ((is_in(w) && inside_[w] != hole) || (is_on(w) && on_border_[w] != hole)) return;
    }
    inside_[v] = -1;
    on_border_[v] = hole;
    const Eigen::Vector3d to = (1 - move.share) * x(v) + move.share * x(move.toward);
    const bool allowed = is_simple(ring) && keeps_shape(v, ring, to) &&
                         std::all_of(ring.begin(), ring.end(),
                                     [&](int w) { return !is_on(w) || is_simple(ring_of(w)); });
    if (allowed) {
      mesh_.x_[v] = to;
      mesh_.normal_[v] =
          ((1 - move.share) * mesh_.normal_[v] + move.share * mesh_.normal_[move.toward])
              .stableNormalized();
    } else {
      inside_[v] = was_in;
      on_border_[v] = -1;
    }
  }

  HoleMesh& mesh_;
  std::vector<int>& inside_;
  std::vector<int>& on_border_;
  std::vector<int> triangle_of_;
};

void HoleMesh::snap_to_borders(std::vector<int>& inside, std::vector<int>& on_border) {
  Snapper(*this, inside, on_border).run();
}

}  // namespace geoprior::details
