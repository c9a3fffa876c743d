#include <algorithm>
#include <cmath>
#include <numeric>

#include "baselines/details/hole_mesh.h"

namespace geoprior {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Sets of vertices that are joined by edges; a set is named by its smallest vertex.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int of(int v) {
    while (parent_[at(v)] != v) {
      parent_[at(v)] = parent_[at(parent_[at(v)])];
      v = parent_[at(v)];
    }
    return v;
  }
  void join(int a, int b) {
    a = of(a);
    b = of(b);
    parent_[at(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace

std::vector<int> HoleMesh::hole_of_vertices() const {
  std::vector<int> inside(x_.size(), -1);
  for (std::size_t v = 0; v < x_.size(); ++v) {
    for (int e = first_[v]; e >= 0; e = entry_[index(e)].next) {
      const auto& [hole, place, next] = entry_[index(e)];
      if (place.norm() < hole_[index(hole)].radius) inside[v] = hole;
    }
  }
  return inside;
}

/// Every hole in one piece, and what remains too: of several pieces the largest stays what it is
/// (a chart that folds on a rough surface leaves single vertices behind).
void HoleMesh::keep_whole(std::vector<int>& inside) const {
  Sets pieces(x_.size()), whole(x_.size());
  for (const auto& c : corner_) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = c[k], b = c[(k + 1) % 3];
      if (inside[index(a)] == inside[index(b)]) pieces.join(a, b);
      whole.join(a, b);
    }
  }
  std::vector<int> size(x_.size(), 0);
  for (int v = 0; v < static_cast<int>(x_.size()); ++v) ++size[index(pieces.of(v))];
  // The largest piece of each hole, and of each connected surface.
  std::vector<int> largest(hole_.size() + x_.size(), -1);
  const auto owner = [&](int v) {
    const int hole = inside[index(v)];
    return hole >= 0 ? index(hole) : hole_.size() + index(whole.of(v));
  };
  for (int v = 0; v < static_cast<int>(x_.size()); ++v) {
    int& best = largest[owner(v)];
    if (pieces.of(v) == v && (best < 0 || size[index(v)] > size[index(best)])) best = v;
  }
  std::vector<int> corrected(x_.size(), -2);  // of strays: what they become
  for (const auto& c : corner_) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (const auto& [v, w] :
           {std::pair(c[k], c[(k + 1) % 3]), std::pair(c[(k + 1) % 3], c[k])}) {
        if (inside[index(v)] == inside[index(w)] || largest[owner(v)] == pieces.of(v)) continue;
        int& to = corrected[index(pieces.of(v))];
        to = std::max(to, inside[index(v)] >= 0 ? -1 : inside[index(w)]);
      }
    }
  }
  std::vector<int> result = inside;
  for (int v = 0; v < static_cast<int>(x_.size()); ++v)
    if (const int to = corrected[index(pieces.of(v))]; to > -2) result[index(v)] = to;
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
    ++euler[index(hole)];
    for (int e = first_[v]; e >= 0; e = entry_[index(e)].next) {
      const auto& [other, place, next] = entry_[index(e)];
      if (other != hole && place.norm() < hole_[index(other)].radius)
        trouble[index(hole)] = trouble[index(other)] = 1;
    }
  }
  for (std::size_t t = 0; t < corner_.size(); ++t) {
    const auto& c = corner_[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = inside[index(c[k])], b = inside[index(c[(k + 1) % 3])];
      if (a < 0) continue;
      if (b >= 0 && a != b) trouble[index(a)] = trouble[index(b)] = 1;
      if (across_[t][k] < 0) trouble[index(a)] = 1;
      if (a == b && c[k] < c[(k + 1) % 3]) --euler[index(a)];
      if (k == 0 && a == b && inside[index(c[2])] == a) ++euler[index(a)];
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
    const double radius = hole_[index(hole)].radius;
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
    const auto& c = mesh_.corner_[index(t)];
    const auto in = [&](std::size_t k) { return inside_[index(c[k % 3])] >= 0; };
    const auto out = [&](std::size_t k) { return !in(k) && on_border_[index(c[k % 3])] < 0; };
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
    if ((x[index(a)] - x[index(c)]).norm() < (x[index(b)] - x[index(d)]).norm())
      cut_.triangle.insert(cut_.triangle.end(), {{a, b, c}, {a, c, d}});
    else
      cut_.triangle.insert(cut_.triangle.end(), {{a, b, d}, {b, c, d}});
  }

  /// On edge `k` of triangle `t`.
  int border_vertex(int t, std::size_t k) {
    if (const int vertex = made_[index(t)][k]; vertex >= 0) return vertex;
    int in = mesh_.corner_[index(t)][k], out = mesh_.corner_[index(t)][(k + 1) % 3];
    const int first = out;
    if (inside_[index(in)] < 0) std::swap(in, out);
    const int hole = inside_[index(in)];
    const double s = mesh_.place_of_border(in, out, hole);
    const int vertex = static_cast<int>(cut_.x.size());
    cut_.x.push_back((1 - s) * mesh_.x_[index(in)] + s * mesh_.x_[index(out)]);
    cut_.normal.push_back(
        ((1 - s) * mesh_.normal_[index(in)] + s * mesh_.normal_[index(out)]).stableNormalized());
    cut_.hole.push_back(mesh_.hole_[index(hole)].number);
    made_[index(t)][k] = vertex;
    if (const int g = mesh_.across_[index(t)][k]; g >= 0) {
      for (std::size_t j = 0; j < 3; ++j)
        if (mesh_.across_[index(g)][j] == t && mesh_.corner_[index(g)][j] == first)
          made_[index(g)][j] = vertex;
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
    if (on_border[v] >= 0) cut.hole[v] = hole_[index(on_border[v])].number;
  TriangleCutter cutter(*this, inside, on_border, cut);
  for (int t = 0; t < static_cast<int>(corner_.size()); ++t) cutter.cut(t);
  return cut;
}

}  // namespace geoprior
