#include "models/details/intrinsic_triangulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/parallel.h"

namespace geoprior::details {
namespace {

constexpr std::size_t kBlock = 4096;
/// Opposite angles may exceed pi by this much (rad): round-off of four equal lengths.
constexpr double kAngleSlack = 1e-10;

/// Height of the apex of a triangle over its edge of length `base`, and the foot of the height.
Eigen::Vector2d apex(double base, double from_start, double from_end) {
  const double x = (base * base + (from_start - from_end) * (from_start + from_end)) / (2 * base);
  return {x, std::sqrt(std::max(0.0, (from_start - x) * (from_start + x)))};
}

double kahan_area(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (b < c) std::swap(b, c);
  if (a < b) std::swap(a, b);
  const double s = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return 0.25 * std::sqrt(std::max(0.0, s));
}

/// cot a + cot b = sin(a + b) / (sin a sin b), and 1 + cot^2 = 1 / sin^2: a bound on the angle.
bool opposite_angles_fit(double cot_a, double cot_b) {
  return cot_a + cot_b >= -kAngleSlack * (1 + std::max(cot_a * cot_a, cot_b * cot_b));
}

}  // namespace

/// The diagonal that a flip would make.
struct IntrinsicTriangulation::Diagonal {
  double length = 0;
  bool convex = false;
};

IntrinsicTriangulation::IntrinsicTriangulation(std::span<const std::array<int, 3>> triangles,
                                               std::span<const Eigen::Vector3d> position)
    : origin_(3 * triangles.size()),
      twin_(3 * triangles.size(), -1),
      length_(3 * triangles.size()),
      density_(triangles.size(), 0.0),
      out_(position.size(), -1),
      border_(position.size(), 0),
      live_triangles_(static_cast<int>(triangles.size())) {
  link(triangles);
  measure(position);
}

void IntrinsicTriangulation::link(std::span<const std::array<int, 3>> triangles) {
  const EdgeConnectivity edges(triangles);
  for (int h = 0; h < edges.half_edge_count(); ++h) {
    origin_[h] = edges.origin(h);
    twin_[h] = edges.twin(h);
  }
  for (int h = 0; h < std::ssize(twin_); ++h) {
    if (twin_[h] >= 0) continue;
    border_[origin_[h]] = 1;
    border_[tip(h)] = 1;
  }
  for (int t = 0; t < triangle_slots(); ++t) refresh_outgoing(t);
}

double IntrinsicTriangulation::area(int t) const {
  return kahan_area(length_[3 * t], length_[3 * t + 1], length_[3 * t + 2]);
}

void IntrinsicTriangulation::neighbours(int v, std::vector<int>& into) const {
  into.clear();
  const int start = out_[v];
  for (int h = start;;) {
    into.push_back(tip(h));
    const int back = previous(h), g = twin_[back];
    if (g == start) return;
    if (g < 0) {
      into.push_back(origin(back));
      return;
    }
    h = g;
  }
}

int IntrinsicTriangulation::degree(int v) const {
  int count = 0;
  const int start = out_[v];
  for (int h = start; h >= 0;) {
    ++count;
    h = twin_[previous(h)];
    if (h == start) break;
  }
  return count;
}

int IntrinsicTriangulation::find_edge(int a, int b) const {
  const int start = out_[a];
  for (int h = start; h >= 0;) {
    if (tip(h) == b) return h;
    h = twin_[previous(h)];
    if (h == start) break;
  }
  return -1;
}

bool IntrinsicTriangulation::adjacent(int a, int b) const {
  return find_edge(a, b) >= 0 || find_edge(b, a) >= 0;
}

void IntrinsicTriangulation::measure(std::span<const Eigen::Vector3d> position) {
  parallel_blocks(density_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (origin_[3 * t] < 0) continue;
      const Eigen::Vector3d& a = position[origin_[3 * t]];
      const Eigen::Vector3d& b = position[origin_[3 * t + 1]];
      const Eigen::Vector3d& c = position[origin_[3 * t + 2]];
      length_[3 * t] = (b - a).norm();
      length_[3 * t + 1] = (c - b).norm();
      length_[3 * t + 2] = (a - c).norm();
    }
  });
}

void IntrinsicTriangulation::set_length(int h, double length) {
  length_[h] = length;
  if (twin_[h] >= 0) length_[twin_[h]] = length;
}

double IntrinsicTriangulation::cotangent(int h) const {
  const double a = length_[h], b = length_[next(h)], c = length_[previous(h)];
  return (b * b + c * c - a * a) / std::max(4 * kahan_area(a, b, c), 1e-300);
}

bool IntrinsicTriangulation::delaunay(int h) const {
  return opposite_angles_fit(cotangent(h), cotangent(twin_[h]));
}

IntrinsicTriangulation::Diagonal IntrinsicTriangulation::other_diagonal(int h) const {
  const int g = twin_[h];
  const double base = length_[h];
  const Eigen::Vector2d c = apex(base, length_[previous(h)], length_[next(h)]);
  const Eigen::Vector2d d = apex(base, length_[next(g)], length_[previous(g)]);
  const double height = c.y() + d.y();
  if (!(height > 0)) return {};
  const double crossing = (c.x() * d.y() + d.x() * c.y()) / height;
  return {std::hypot(c.x() - d.x(), height),
          crossing > 1e-12 * base && crossing < (1 - 1e-12) * base};
}

void IntrinsicTriangulation::set_triangle(int t, const std::array<int, 3>& corner,
                                          const std::array<double, 3>& length,
                                          const std::array<int, 3>& twin) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t h = (3 * t) + k;
    origin_[h] = corner[k];
    length_[h] = length[k];
    twin_[h] = twin[k];
    if (twin[k] >= 0) twin_[twin[k]] = static_cast<int>(h);
  }
}

void IntrinsicTriangulation::refresh_outgoing(int t) {
  for (int h = 3 * t; h < 3 * t + 3; ++h) {
    const std::size_t v = origin_[h];
    if (border_[v] == 0 || twin_[h] < 0) out_[v] = h;
  }
}

bool IntrinsicTriangulation::flip(int h) {
  const int g = twin_[h];
  if (g < 0) return false;
  const int a = origin(h), b = origin(g), c = origin(previous(h)), d = origin(previous(g));
  if (c == d || adjacent(c, d)) return false;
  const Diagonal diagonal = other_diagonal(h);
  if (!diagonal.convex) return false;
  const int t = h / 3, s = g / 3;
  const double mass = density(t) * area(t) + density(s) * area(s);
  const auto edge = [&](int e) { return std::pair(length_[e], twin_[e]); };
  const auto [ad, twin_ad] = edge(next(g));
  const auto [db, twin_db] = edge(previous(g));
  const auto [bc, twin_bc] = edge(next(h));
  const auto [ca, twin_ca] = edge(previous(h));
  set_triangle(t, {a, d, c}, {ad, diagonal.length, ca}, {twin_ad, 3 * s + 2, twin_ca});
  set_triangle(s, {d, b, c}, {db, bc, diagonal.length}, {twin_db, twin_bc, 3 * t + 1});
  refresh_outgoing(t);
  refresh_outgoing(s);
  const double both = area(t) + area(s);
  density_[t] = density_[s] = both > 0 ? mass / both : 0;
  return true;
}

void IntrinsicTriangulation::push_edges(int t, std::vector<int>& stack) const {
  for (int h = 3 * t; h < 3 * t + 3; ++h)
    if (twin_[h] >= 0) stack.push_back(h);
}

int IntrinsicTriangulation::settle(std::vector<int>& stack) {
  // Lawson's argument bounds the flips in exact arithmetic; the limit stands against round-off.
  const int limit = 64 * live_triangles_ + 4096;
  int flips = 0, flips_at_retry = 0;
  refused_.clear();
  while (flips < limit) {
    if (stack.empty()) {
      // What stood in the way of a refused flip may have been flipped itself since.
      if (refused_.empty() || flips == flips_at_retry) break;
      flips_at_retry = flips;
      stack.swap(refused_);
    }
    const int h = stack.back();
    stack.pop_back();
    if (origin_[h] < 0) continue;
    const int g = twin_[h];
    if (g < 0 || delaunay(h)) continue;
    if (!flip(h)) {
      refused_.push_back(h);
      continue;
    }
    ++flips;
    push_edges(h / 3, stack);
    push_edges(g / 3, stack);
  }
  refused_flips_ += static_cast<std::int64_t>(refused_.size());
  stack.clear();
  return flips;
}

int IntrinsicTriangulation::flip_to_delaunay() {
  cotangents_.resize(length_.size());
  parallel_blocks(density_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t h = 3 * begin; h < 3 * end; h += 3) {
      if (origin_[h] < 0) continue;
      const double a = length_[h], b = length_[h + 1], c = length_[h + 2];
      const double scale = 1 / std::max(4 * kahan_area(a, b, c), 1e-300);
      cotangents_[h] = (b * b + c * c - a * a) * scale;
      cotangents_[h + 1] = (c * c + a * a - b * b) * scale;
      cotangents_[h + 2] = (a * a + b * b - c * c) * scale;
    }
  });
  std::vector<char> wanting(density_.size(), 0);
  parallel_blocks(density_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t h = 3 * begin; h < 3 * end; ++h) {
      if (origin_[h] < 0 || twin_[h] < static_cast<int>(h)) continue;
      if (!opposite_angles_fit(cotangents_[h], cotangents_[twin_[h]])) wanting[h / 3] = 1;
    }
  });
  stack_.clear();
  for (int t = 0; t < std::ssize(wanting); ++t)
    if (wanting[t] != 0) push_edges(t, stack_);
  return settle(stack_);
}

int IntrinsicTriangulation::flip_around(std::span<const int> vertices) {
  stack_.clear();
  for (const int v : vertices) {
    const int start = out_[v];
    for (int h = start; h >= 0;) {
      push_edges(h / 3, stack_);
      h = twin_[previous(h)];
      if (h == start) break;
    }
  }
  return settle(stack_);
}

int IntrinsicTriangulation::insert(int t, const Eigen::Vector3d& barycentric, bool flips) {
  const auto [a, b, c] = corners(t);
  const auto edge = [&](int k) { return std::pair(length_[3 * t + k], twin_[3 * t + k]); };
  const auto [ab, twin_ab] = edge(0);
  const auto [bc, twin_bc] = edge(1);
  const auto [ca, twin_ca] = edge(2);
  const Eigen::Vector2d at_b(ab, 0), at_c = apex(ab, ca, bc);
  const Eigen::Vector2d p = barycentric[1] * at_b + barycentric[2] * at_c;
  const double pa = p.norm(), pb = (p - at_b).norm(), pc = (p - at_c).norm();
  const double density_here = density(t);
  const int v = new_vertex(), r = new_triangle(), s = new_triangle();
  set_triangle(t, {a, b, v}, {ab, pb, pa}, {twin_ab, 3 * r + 2, 3 * s + 1});
  set_triangle(r, {b, c, v}, {bc, pc, pb}, {twin_bc, 3 * s + 2, 3 * t + 1});
  set_triangle(s, {c, a, v}, {ca, pa, pc}, {twin_ca, 3 * t + 2, 3 * r + 1});
  for (const int u : {t, r, s}) {
    density_[u] = density_here;
    refresh_outgoing(u);
  }
  if (flips) {
    stack_ = {3 * s, 3 * r, 3 * t};
    settle(stack_);
  }
  return v;
}

int IntrinsicTriangulation::new_triangle() {
  ++live_triangles_;
  if (!free_triangles_.empty()) {
    const int t = free_triangles_.back();
    free_triangles_.pop_back();
    return t;
  }
  for (int k = 0; k < 3; ++k) {
    origin_.push_back(-1);
    twin_.push_back(-1);
    length_.push_back(0);
  }
  density_.push_back(0);
  return triangle_slots() - 1;
}

int IntrinsicTriangulation::new_vertex() {
  if (!free_vertices_.empty()) {
    const int v = free_vertices_.back();
    free_vertices_.pop_back();
    return v;
  }
  out_.push_back(-1);
  border_.push_back(0);
  return vertex_slots() - 1;
}

void IntrinsicTriangulation::free_triangle(int t) {
  for (int h = 3 * t; h < 3 * t + 3; ++h) origin_[h] = twin_[h] = -1;
  free_triangles_.push_back(t);
  --live_triangles_;
}

std::vector<std::array<int, 3>> IntrinsicTriangulation::triangles() const {
  std::vector<std::array<int, 3>> result;
  result.reserve(live_triangles_);
  for (int t = 0; t < triangle_slots(); ++t)
    if (triangle_alive(t)) result.push_back(corners(t));
  return result;
}

void IntrinsicTriangulation::renumber(std::span<const int> number) {
  for (int& v : origin_)
    if (v >= 0) v = number[v];
  std::vector<int> out;
  std::vector<char> border;
  for (std::size_t v = 0; v < out_.size(); ++v) {
    if (out_[v] < 0) continue;
    const std::size_t w = number[v];
    if (out.size() <= w) {
      out.resize(w + 1, -1);
      border.resize(w + 1, 0);
    }
    out[w] = out_[v];
    border[w] = border_[v];
  }
  out_ = std::move(out);
  border_ = std::move(border);
  free_vertices_.clear();
}

void IntrinsicTriangulation::save(StateWriter& out) const {
  out.items(origin_);
  out.items(twin_);
  out.items(length_);
  out.items(density_);
  out.items(out_);
  out.items(border_);
  out.items(free_triangles_);
  out.items(free_vertices_);
  out.number(live_triangles_);
  out.number(refused_flips_);
}

void IntrinsicTriangulation::load(StateReader& in) {
  in.items(origin_);
  in.items(twin_);
  in.items(length_);
  in.items(density_);
  in.items(out_);
  in.items(border_);
  in.items(free_triangles_);
  in.items(free_vertices_);
  live_triangles_ = in.number<int>();
  refused_flips_ = in.number<std::int64_t>();
}

bool IntrinsicTriangulation::flip_down_to_three(int v, std::vector<int>& touched) {
  for (int left = degree(v); left > 3; --left) {
    bool flipped = false;
    const int start = out_[v];
    for (int h = start; !flipped;) {
      const int along = previous(h), g = twin_[along];  // the next spoke; v is interior
      const int other = twin_[h] / 3;
      if (flip(h)) {
        flipped = true;
        touched.push_back(h / 3);
        touched.push_back(other);
      } else if (g == start) {
        return false;
      } else {
        h = g;
      }
    }
  }
  return true;
}

bool IntrinsicTriangulation::merge_three(int v, std::vector<int>& touched) {
  std::array<int, 3> spoke{}, corner{}, twin{};
  std::array<double, 3> length{};
  int h = out_[v];
  double mass = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    spoke[k] = h;
    const int outer = next(h);
    corner[k] = origin(outer);
    length[k] = length_[outer];
    twin[k] = twin_[outer];
    mass += density(h / 3) * area(h / 3);
    h = twin_[previous(h)];
  }
  const bool pillow = twin[0] >= 0 && twin[0] / 3 == twin[1] / 3 && twin[0] / 3 == twin[2] / 3;
  const double longest = std::max({length[0], length[1], length[2]});
  if (pillow || !(length[0] + length[1] + length[2] > 2 * longest * (1 + 1e-9))) return false;
  const int t = spoke[0] / 3;
  free_triangle(spoke[1] / 3);
  free_triangle(spoke[2] / 3);
  set_triangle(t, corner, length, twin);
  refresh_outgoing(t);
  const double here = area(t);
  density_[t] = here > 0 ? mass / here : 0;
  out_[v] = -1;
  free_vertices_.push_back(v);
  touched.push_back(t);
  return true;
}

bool IntrinsicTriangulation::remove(int v, std::span<const Eigen::Vector3d> position) {
  if (border_vertex(v) || live_triangles_ <= 4) return false;
  std::vector<int> touched;
  const bool removed = flip_down_to_three(v, touched) && merge_three(v, touched);
  stack_.clear();
  for (const int t : touched)
    if (triangle_alive(t)) push_edges(t, stack_);
  settle(stack_);
  if (removed) return true;
  std::vector<std::pair<double, int>> ring;  // length, tip
  const int start = out_[v];
  for (int h = start;;) {
    ring.emplace_back(length_[h], tip(h));
    h = twin_[previous(h)];
    if (h == start) break;
  }
  std::sort(ring.begin(), ring.end());
  return std::any_of(ring.begin(), ring.end(), [&](const auto& spoke) {
    return collapse(find_edge(v, spoke.second), position);
  });
}

bool IntrinsicTriangulation::can_collapse(int h) const {
  const int v = origin(h), w = tip(h);
  if (border_vertex(v) || live_triangles_ <= 4) return false;
  std::vector<int> of_v, of_w;
  neighbours(v, of_v);
  neighbours(w, of_w);
  int common = 0;
  for (const int u : of_v) common += std::find(of_w.begin(), of_w.end(), u) != of_w.end() ? 1 : 0;
  return common == 2;
}

bool IntrinsicTriangulation::collapse(int h, std::span<const Eigen::Vector3d> position) {
  if (!can_collapse(h)) return false;
  const int v = origin(h), w = tip(h), g = twin_[h];
  std::vector<int> star;  // half-edges that leave v
  const int start = out_[v];
  double mass = 0;
  for (int e = start;;) {
    star.push_back(e);
    mass += density(e / 3) * area(e / 3);
    e = twin_[previous(e)];
    if (e == start) break;
  }
  // The edges v-c and w-c become one, and so do v-d and w-d.
  const std::array<std::pair<int, int>, 2> joined{std::pair(twin_[previous(h)], twin_[next(h)]),
                                                  std::pair(twin_[next(g)], twin_[previous(g)])};
  const std::array<double, 2> kept{length_[next(h)], length_[previous(g)]};
  for (const int e : star) {
    if (e / 3 == h / 3 || e / 3 == g / 3) continue;
    origin_[e] = w;
    const double chord = (position[w] - position[tip(e)]).norm();
    set_length(e, chord);
    set_length(previous(e), (position[w] - position[origin(previous(e))]).norm());
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const auto [inner, outer] = joined[side];
    twin_[inner] = outer;
    length_[inner] = kept[side];
    if (outer >= 0) twin_[outer] = inner;
  }
  free_triangle(h / 3);
  free_triangle(g / 3);
  out_[v] = -1;
  free_vertices_.push_back(v);
  double left = 0;
  stack_.clear();
  for (const int e : star) {
    if (!triangle_alive(e / 3)) continue;
    refresh_outgoing(e / 3);
    left += area(e / 3);
    push_edges(e / 3, stack_);
  }
  for (const int e : star)
    if (triangle_alive(e / 3)) density_[e / 3] = left > 0 ? mass / left : 0;
  settle(stack_);
  return true;
}

namespace {

/// Angle opposite to an edge of length a.
double angle(double a, double b, double c, double area) {
  return std::atan2(4 * area, b * b + c * c - a * a);
}

}  // namespace

TriangulationReport IntrinsicTriangulation::check() const {
  TriangulationReport report;
  std::vector<int> corners_of(out_.size(), 0);
  std::vector<std::pair<int, int>> edges;
  int edge_count = 0;
  for (int t = 0; t < triangle_slots(); ++t) {
    if (!triangle_alive(t)) continue;
    ++report.triangles;
    const auto l = [&](int h) { return length_[h]; };
    const double longest = std::max({l(3 * t), l(3 * t + 1), l(3 * t + 2)});
    if (!(l(3 * t) + l(3 * t + 1) + l(3 * t + 2) >= 2 * longest * (1 - 1e-12)))
      ++report.broken_triangles;
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      ++corners_of[origin(h)];
      const int g = twin(h);
      if (g < 0) {
        ++report.border_edges;
        ++edge_count;
        edges.emplace_back(std::min(origin(h), tip(h)), std::max(origin(h), tip(h)));
        continue;
      }
      if (twin(g) != h || origin(g) != tip(h) || tip(g) != origin(h)) ++report.broken_links;
      if (l(g) != l(h)) ++report.broken_triangles;
      if (g < h) continue;
      ++edge_count;
      edges.emplace_back(std::min(origin(h), tip(h)), std::max(origin(h), tip(h)));
      const double sum = angle(l(h), l(next(h)), l(previous(h)), area(t)) +
                         angle(l(g), l(next(g)), l(previous(g)), area(g / 3));
      report.worst_angle_sum = std::max(report.worst_angle_sum, sum);
      if (sum <= std::numbers::pi + 1e-8) continue;
      ++(adjacent(origin(previous(h)), origin(previous(g))) ? report.blocked : report.not_delaunay);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges[i].first == edges[i].second || (i > 0 && edges[i] == edges[i - 1]))
      ++report.repeated_edges;
  }
  for (int v = 0; v < vertex_slots(); ++v) {
    if (!vertex_alive(v)) {
      report.broken_vertices += corners_of[v] > 0 ? 1 : 0;
      continue;
    }
    ++report.vertices;
    if (origin(out_[v]) != v || degree(v) != corners_of[v]) ++report.broken_vertices;
  }
  report.euler = report.vertices - edge_count + report.triangles;
  return report;
}

}  // namespace geoprior::details
