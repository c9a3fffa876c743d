#include "baselines/paper/adaptive/editable_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/planar.h"
#include "models/paper/contact/overlap.h"

namespace geoprior::paper {
namespace {

constexpr int kNext[3] = {1, 2, 0};
constexpr int kPrevious[3] = {2, 0, 1};

}  // namespace

EditableSheet::EditableSheet(const ShellState& state) {
  const int n = state.mesh.vertex_count(), m = state.mesh.triangle_count();
  vertices_.resize(n);
  changed_.assign(n, false);
  for (int v = 0; v < n; ++v) {
    Vertex& vertex = vertices_[v];
    vertex.pattern = state.mesh.pattern.row(v);
    vertex.x = state.x.row(v);
    vertex.v = state.v.row(v);
  }
  const EdgeConnectivity edges(state.mesh.triangles);
  if (const auto h = edges.first_repeated()) {
    throw Error(
        "two triangles run the same way along an edge",
        "edge " + std::to_string(edges.origin(*h)) + " to " + std::to_string(edges.tip(*h)));
  }
  const auto neighbours = edges.across();
  triangles_.resize(m);
  for (int f = 0; f < m; ++f) {
    Triangle& t = triangles_[f];
    t.neighbour = neighbours[f];
    t.plastic_curvature = state.plastic_curvature.row(f);
    t.damage = state.damage[f];
    for (int k = 0; k < 3; ++k) {
      t.vertex[k] = state.mesh.triangles(f, k);
      vertices_[state.mesh.triangles(f, k)].triangle = f;
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
      s.mesh.triangles(f, k) = row[t.vertex[k]];
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
  const int segment = vertices_[start(s)].segment;
  return segment >= 0 && segment == vertices_[end(s)].segment;
}

double EditableSheet::twice_area(int triangle) const {
  const auto& t = triangles_[triangle].vertex;
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
  const Vertex &p = vertices_[a], &q = vertices_[b];
  return std::abs((p.x - q.x).norm() / (p.pattern - q.pattern).norm() - 1);
}

void EditableSheet::replace_neighbour(int triangle, int old, int now) {
  if (triangle < 0) return;
  for (int& n : triangles_[triangle].neighbour) {
    if (n == old) {
      n = now;
      return;
    }
  }
}

void EditableSheet::place_triangle(int triangle, const std::array<int, 3>& vertex,
                                   const std::array<int, 3>& neighbour) {
  Triangle& t = triangles_[triangle];
  t.vertex = vertex;
  t.neighbour = neighbour;
  for (const int v : vertex) {
    vertices_[v].triangle = triangle;
    changed_[v] = true;
  }
}

namespace {

EditableSheet::Vertex middle(const EditableSheet::Vertex& a, const EditableSheet::Vertex& b,
                             bool on_border) {
  EditableSheet::Vertex m;
  m.pattern = (a.pattern + b.pattern) / 2;
  m.x = (a.x + b.x) / 2;
  m.v = (a.v + b.v) / 2;
  m.size = (a.size + b.size) / 2;
  m.kind = on_border ? EditableSheet::Kind::side : EditableSheet::Kind::inside;
  m.segment = a.segment == b.segment ? a.segment : -1;
  m.is_new = true;
  return m;
}

}  // namespace

// Triangle (a, b, c) becomes (a, m, c) and (m, b, c); the one across, (b, a, d), becomes (m, a, d)
// and (b, m, d).
int EditableSheet::split(Side s) {
  const int t = s.triangle, a = start(s), b = end(s), c = apex(s);
  const Side o = opposite(s);
  const int u = o.triangle;
  const int bc = across(t, kNext[s.k]), ca = across(t, kPrevious[s.k]);
  const int m = static_cast<int>(vertices_.size());
  vertices_.push_back(middle(vertices_[a], vertices_[b], u < 0));
  changed_.push_back(true);
  const int t2 = static_cast<int>(triangles_.size());
  triangles_.push_back(triangles_[t]);
  const int u2 = u < 0 ? -1 : t2 + 1;
  if (u >= 0) {
    triangles_.push_back(triangles_[u]);
    const int d = apex(o), ad = across(u, kNext[o.k]), db = across(u, kPrevious[o.k]);
    place_triangle(u, {m, a, d}, {t, ad, u2});
    place_triangle(u2, {b, m, d}, {t2, u, db});
    replace_neighbour(db, u, u2);
  }
  place_triangle(t, {a, m, c}, {u, t2, ca});
  place_triangle(t2, {m, b, c}, {u2, bc, t});
  replace_neighbour(bc, t, t2);
  return m;
}

bool EditableSheet::can_flip(Side s, double least_altitude) const {
  const Side o = opposite(s);
  if (o.triangle < 0 || is_held(s)) return false;
  const int a = start(s), b = end(s), c = apex(s), d = apex(o);
  const double old = std::min(altitude_ratio(a, b, c), altitude_ratio(b, a, d));
  const double now = std::min(altitude_ratio(a, d, c), altitude_ratio(d, b, c));
  return now > 0 && (now >= least_altitude || now > old);
}

// Triangles (a, b, c) and (b, a, d) become (a, d, c) and (d, b, c). The new diagonal divides each
// of the old triangles in the same ratio, so both new ones get the area-weighted mean of creases.
void EditableSheet::flip(Side s) {
  const Side o = opposite(s);
  const int t = s.triangle, u = o.triangle;
  const int a = start(s), b = end(s), c = apex(s), d = apex(o);
  const int bc = across(t, kNext[s.k]), ca = across(t, kPrevious[s.k]);
  const int ad = across(u, kNext[o.k]), db = across(u, kPrevious[o.k]);
  Triangle &p = triangles_[t], &q = triangles_[u];
  const double share = twice_area(t) / (twice_area(t) + twice_area(u));
  p.plastic_curvature = share * p.plastic_curvature + (1 - share) * q.plastic_curvature;
  p.damage = share * p.damage + (1 - share) * q.damage;
  q.plastic_curvature = p.plastic_curvature;
  q.damage = p.damage;
  place_triangle(t, {a, d, c}, {ad, u, ca});
  place_triangle(u, {d, b, c}, {db, bc, t});
  replace_neighbour(ad, u, t);
  replace_neighbour(bc, t, u);
}

/// The neighbours that both have are exactly those opposite to their edge.
bool EditableSheet::keeps_disc(int v, int w) const {
  std::vector<int> of_v, of_w;
  ring(v, of_v);
  ring(w, of_w);
  const Side s = find(v, w);
  if (s.triangle < 0 || of_v.size() < 3) return false;
  const auto shared = std::count_if(of_v.begin(), of_v.end(), [&](int r) {
    return std::find(of_w.begin(), of_w.end(), r) != of_w.end();
  });
  return shared == (opposite(s).triangle < 0 ? 1 : 2);
}

bool EditableSheet::keeps_border(int v, int w) const {
  const Vertex& p = vertices_[v];
  const Side s = find(v, w);
  if (s.triangle < 0 || p.kind == Kind::fixed) return false;
  if (p.segment >= 0 && !is_held(s)) return false;
  return p.kind == Kind::inside || opposite(s).triangle < 0;
}

bool EditableSheet::can_collapse(int v, int w, double least_altitude, double most_strain) const {
  if (!keeps_border(v, w) || !keeps_disc(v, w)) return false;
  std::vector<int> triangles;
  star(v, triangles);
  double flattest = std::numeric_limits<double>::infinity(), strained = 0, worst = 0;
  for (const int t : triangles) {
    const int k = corner_of(t, v), r = corner(t, kNext[k]), q = corner(t, kPrevious[k]);
    flattest = std::min(flattest, altitude_ratio(v, r, q));
    strained = std::max({strained, strain(v, r), strain(v, q)});
  }
  for (const int t : triangles) {
    const int k = corner_of(t, v), r = corner(t, kNext[k]), q = corner(t, kPrevious[k]);
    if (r == w || q == w) continue;
    const double ratio = altitude_ratio(w, r, q);
    if (!(ratio > 0) || (ratio < least_altitude && ratio < flattest)) return false;
    worst = std::max({worst, strain(w, r), strain(w, q)});
  }
  return worst <= most_strain || worst <= strained;
}

void EditableSheet::collapse(int v, int w) {
  std::vector<int> about, kept;
  star(v, about);
  std::vector<Triangle> old;
  for (const int t : about) old.push_back(triangles_[t]);
  for (const int t : about) {
    const int k = corner_of(t, v);
    const bool first = corner(t, kNext[k]) == w, second = corner(t, kPrevious[k]) == w;
    if (!first && !second) {
      kept.push_back(t);
      continue;
    }
    // The triangle (v, w, p) or (v, p, w) goes: what lies across its edges w p and p v become
    // neighbours.
    const int outer = across(t, kNext[k]), inner = across(t, first ? kPrevious[k] : k);
    const int p = corner(t, first ? kPrevious[k] : kNext[k]);
    replace_neighbour(outer, t, inner);
    replace_neighbour(inner, t, outer);
    for (const int r : {w, p}) {
      vertices_[r].triangle = outer >= 0 ? outer : inner;
      changed_[r] = true;
    }
    triangles_[t].vertex = {-1, -1, -1};
  }
  for (const int t : kept) {
    Triangle now = triangles_[t];
    now.vertex[corner_of(t, v)] = w;
    place_triangle(t, now.vertex, now.neighbour);
  }
  carry_creases(old, kept);
  vertices_[v].triangle = -1;
}

/// Spreads the creases of old triangles over those that now cover the same polygon.
void EditableSheet::carry_creases(const std::vector<Triangle>& old, const std::vector<int>& now) {
  if (std::all_of(old.begin(), old.end(), [](const Triangle& t) {
        return t.damage == 0 && t.plastic_curvature.isZero(0);
      })) {
    return;
  }
  const auto corners = [&](const Triangle& t) {
    return PlaneTriangle{point(t.vertex[0]), point(t.vertex[1]), point(t.vertex[2])};
  };
  for (const int f : now) {
    Triangle& t = triangles_[f];
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (const Triangle& o : old) {
      const double shared = overlap_area(corners(t), corners(o));
      sum.head<3>() += shared * o.plastic_curvature;
      sum[3] += shared * o.damage;
    }
    sum /= 0.5 * twice_area(f);
    t.plastic_curvature = sum.head<3>();
    t.damage = sum[3];
  }
}

}  // namespace geoprior::paper
