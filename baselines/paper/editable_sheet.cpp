#include "baselines/paper/editable_sheet.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "baselines/paper/planar.h"
#include "core/error.h"

namespace geoprior {
namespace {

constexpr int kNext[3] = {1, 2, 0};
constexpr int kPrevious[3] = {2, 0, 1};

}  // namespace

EditableSheet::EditableSheet(const ShellState& state) {
  const int n = state.mesh.vertex_count(), m = state.mesh.triangle_count();
  vertices_.resize(static_cast<std::size_t>(n));
  changed_.assign(static_cast<std::size_t>(n), false);
  for (int v = 0; v < n; ++v) {
    Vertex& vertex = vertices_[static_cast<std::size_t>(v)];
    vertex.pattern = state.mesh.pattern.row(v);
    vertex.x = state.x.row(v);
    vertex.v = state.v.row(v);
  }
  struct Half {
    int low, high, triangle, k;
  };
  std::vector<Half> halves;
  halves.reserve(static_cast<std::size_t>(3 * m));
  triangles_.resize(static_cast<std::size_t>(m));
  for (int f = 0; f < m; ++f) {
    Triangle& t = triangles_[static_cast<std::size_t>(f)];
    t.neighbour = {-1, -1, -1};
    t.plastic_curvature = state.plastic_curvature.row(f);
    t.damage = state.damage[f];
    for (int k = 0; k < 3; ++k) {
      const int a = state.mesh.triangles(f, k), b = state.mesh.triangles(f, kNext[k]);
      t.vertex[static_cast<std::size_t>(k)] = a;
      vertices_[static_cast<std::size_t>(a)].triangle = f;
      halves.push_back({std::min(a, b), std::max(a, b), f, k});
    }
  }
  std::sort(halves.begin(), halves.end(), [](const Half& p, const Half& q) {
    if (p.low != q.low) return p.low < q.low;
    if (p.high != q.high) return p.high < q.high;
    return p.triangle < q.triangle;
  });
  const auto same = [&](std::size_t i, std::size_t j) {
    return j < halves.size() && halves[i].low == halves[j].low && halves[i].high == halves[j].high;
  };
  for (std::size_t i = 0; i < halves.size(); ++i) {
    if (!same(i, i + 1)) continue;
    if (same(i, i + 2)) {
      throw Error("edge has more than two triangles", "edge " + std::to_string(halves[i].low) +
                                                          " to " + std::to_string(halves[i].high));
    }
    const Half &p = halves[i], &q = halves[i + 1];
    triangles_[static_cast<std::size_t>(p.triangle)].neighbour[static_cast<std::size_t>(p.k)] =
        q.triangle;
    triangles_[static_cast<std::size_t>(q.triangle)].neighbour[static_cast<std::size_t>(q.k)] =
        p.triangle;
  }
}

ShellState EditableSheet::state(double time) const {
  ShellState s;
  s.time = time;
  std::vector<int> row(vertices_.size(), -1);
  int n = 0, m = 0;
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    if (vertices_[v].triangle >= 0) row[v] = n++;
  }
  for (const Triangle& t : triangles_) m += t.vertex[0] >= 0 ? 1 : 0;
  s.mesh.pattern.resize(n, 2);
  s.x.resize(n, 3);
  s.v.resize(n, 3);
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    if (row[v] < 0) continue;
    s.mesh.pattern.row(row[v]) = vertices_[v].pattern;
    s.x.row(row[v]) = vertices_[v].x;
    s.v.row(row[v]) = vertices_[v].v;
  }
  s.mesh.triangles.resize(m, 3);
  s.plastic_curvature.resize(m, 3);
  s.damage.resize(m);
  int f = 0;
  for (const Triangle& t : triangles_) {
    if (t.vertex[0] < 0) continue;
    for (int k = 0; k < 3; ++k) {
      s.mesh.triangles(f, k) = row[static_cast<std::size_t>(t.vertex[static_cast<std::size_t>(k)])];
    }
    s.plastic_curvature.row(f) = t.plastic_curvature;
    s.damage[f] = t.damage;
    ++f;
  }
  return s;
}

std::vector<bool> EditableSheet::changed() const {
  std::vector<bool> result;
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    if (vertices_[v].triangle >= 0) result.push_back(changed_[v]);
  }
  return result;
}

int EditableSheet::corner_of(int triangle, int v) const {
  const auto& t = triangles_[static_cast<std::size_t>(triangle)].vertex;
  return t[0] == v ? 0 : t[1] == v ? 1 : 2;
}

void EditableSheet::star(int v, std::vector<int>& triangles) const {
  triangles.clear();
  const int first = vertices_[static_cast<std::size_t>(v)].triangle;
  if (first < 0) return;
  // Clockwise to the border, or once around.
  int begin = first;
  for (;;) {
    const int next = across(begin, corner_of(begin, v));
    if (next < 0 || next == first) break;
    begin = next;
  }
  if (across(begin, corner_of(begin, v)) == first) begin = first;
  for (int t = begin; t >= 0;) {
    triangles.push_back(t);
    t = across(t, kPrevious[corner_of(t, v)]);
    if (t == begin) break;
  }
}

void EditableSheet::ring(int v, std::vector<int>& neighbours) const {
  neighbours.clear();
  std::vector<int> triangles;
  star(v, triangles);
  for (const int t : triangles) neighbours.push_back(corner(t, kNext[corner_of(t, v)]));
  if (triangles.empty()) return;
  const int last = triangles.back();
  if (across(last, kPrevious[corner_of(last, v)]) < 0) {
    neighbours.push_back(corner(last, kPrevious[corner_of(last, v)]));
  }
}

EditableSheet::Side EditableSheet::find(int a, int b) const {
  if (vertices_[static_cast<std::size_t>(a)].triangle < 0) return {};
  std::vector<int> triangles;
  star(a, triangles);
  for (const int t : triangles) {
    const int k = corner_of(t, a);
    if (corner(t, kNext[k]) == b) return {t, k};
  }
  if (triangles.empty()) return {};
  const int last = triangles.back(), k = kPrevious[corner_of(last, a)];
  return corner(last, k) == b ? Side{last, k} : Side{};
}

EditableSheet::Side EditableSheet::opposite(Side s) const {
  const int other = across(s.triangle, s.k);
  if (other < 0) return {};
  return {other, corner_of(other, end(s))};
}

bool EditableSheet::is_held(Side s) const {
  const int segment = vertices_[static_cast<std::size_t>(start(s))].segment;
  return segment >= 0 && segment == vertices_[static_cast<std::size_t>(end(s))].segment;
}

double EditableSheet::twice_area(int triangle) const {
  const auto& t = triangles_[static_cast<std::size_t>(triangle)].vertex;
  return cross(point(t[1]) - point(t[0]), point(t[2]) - point(t[0]));
}

/// Smallest altitude over the longest edge, negative when turned over.
double EditableSheet::altitude_ratio(int a, int b, int c) const {
  const Eigen::Vector2d ab = point(b) - point(a), bc = point(c) - point(b),
                        ca = point(a) - point(c);
  return cross(ab, -ca) / std::max({ab.squaredNorm(), bc.squaredNorm(), ca.squaredNorm()});
}

/// Relative change of an edge's length.
double EditableSheet::strain(int a, int b) const {
  const Vertex &p = vertices_[static_cast<std::size_t>(a)],
               &q = vertices_[static_cast<std::size_t>(b)];
  return std::abs((p.x - q.x).norm() / (p.pattern - q.pattern).norm() - 1);
}

void EditableSheet::replace_neighbour(int triangle, int old, int now) {
  if (triangle < 0) return;
  for (int& n : triangles_[static_cast<std::size_t>(triangle)].neighbour) {
    if (n == old) {
      n = now;
      return;
    }
  }
}

void EditableSheet::place_triangle(int triangle, const std::array<int, 3>& vertex,
                                   const std::array<int, 3>& neighbour) {
  Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
  t.vertex = vertex;
  t.neighbour = neighbour;
  for (const int v : vertex) {
    vertices_[static_cast<std::size_t>(v)].triangle = triangle;
    changed_[static_cast<std::size_t>(v)] = true;
  }
}

}  // namespace geoprior
