#include "baselines/paper/editable_sheet.h"

#include <algorithm>
#include <cmath>

#include "baselines/paper/planar.h"
#include "baselines/paper/triangle_neighbours.h"

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
  const auto neighbours = triangle_neighbours(state.mesh.triangles, n);
  triangles_.resize(static_cast<std::size_t>(m));
  for (int f = 0; f < m; ++f) {
    Triangle& t = triangles_[static_cast<std::size_t>(f)];
    t.neighbour = neighbours[static_cast<std::size_t>(f)];
    t.plastic_curvature = state.plastic_curvature.row(f);
    t.damage = state.damage[f];
    for (int k = 0; k < 3; ++k) {
      t.vertex[static_cast<std::size_t>(k)] = state.mesh.triangles(f, k);
      vertices_[static_cast<std::size_t>(state.mesh.triangles(f, k))].triangle = f;
    }
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

void EditableSheet::star(int v, std::vector<int>& triangles) const {
  triangles.clear();
  around(v, [&](int t, int) {
    triangles.push_back(t);
    return false;
  });
}

void EditableSheet::ring(int v, std::vector<int>& neighbours) const {
  neighbours.clear();
  int last = -1;
  around(v, [&](int t, int k) {
    neighbours.push_back(corner(t, kNext[k]));
    last = across(t, kPrevious[k]) < 0 ? corner(t, kPrevious[k]) : -1;
    return false;
  });
  if (last >= 0) neighbours.push_back(last);
}

EditableSheet::Side EditableSheet::find(int a, int b) const {
  Side side;
  around(a, [&](int t, int k) {
    if (corner(t, kNext[k]) == b) {
      side = {t, k};
    } else if (across(t, kPrevious[k]) < 0 && corner(t, kPrevious[k]) == b) {
      side = {t, kPrevious[k]};
    }
    return side.triangle >= 0;
  });
  return side;
}

EditableSheet::Side EditableSheet::find(int a, int b, Side hint) const {
  return start(hint) == a && end(hint) == b ? hint : find(a, b);
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
