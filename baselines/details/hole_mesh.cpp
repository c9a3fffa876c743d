#include "baselines/details/hole_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

namespace geoprior {

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
  for (int e = first_[index(vertex)]; e >= 0; e = entry_[index(e)].next)
    if (entry_[index(e)].hole == hole) return &entry_[index(e)];
  return nullptr;
}

void HoleMesh::add_entry(int vertex, int hole, const Eigen::Vector2d& at) {
  entry_.push_back({hole, at, first_[index(vertex)]});
  first_[index(vertex)] = static_cast<int>(entry_.size()) - 1;
}

double HoleMesh::length2(int a, int b) const {
  // The same bits from both sides: bisection compares lengths.
  return (x_[index(std::max(a, b))] - x_[index(std::min(a, b))]).squaredNorm();
}

int HoleMesh::longest_edge(int t) const {
  const auto& c = corner_[index(t)];
  const auto key = [&](int k) {
    const int a = c[index(k)], b = c[index((k + 1) % 3)];
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
    const Entry* e = entry(corner_[index(t)][k], hole);
    if (e == nullptr) return false;
    u[k] = e->at;
  }
  const double radius = hole_[index(hole)].radius;
  if (radius == 0) return false;  // given up
  if (std::max({u[0].norm(), u[1].norm(), u[2].norm()}) < radius) return false;
  int left = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto &a = u[k], &b = u[(k + 1) % 3];
    if (distance_to_segment(a, b) < radius) return true;
    left += a.x() * b.y() - a.y() * b.x() > 0 ? 1 : 0;
  }
  return left == 3 || left == 0;  // the disc lies inside
}

bool HoleMesh::too_large(int t) const {
  const int k = longest_edge(t);
  const double length =
      std::sqrt(length2(corner_[index(t)][index(k)], corner_[index(t)][index((k + 1) % 3)]));
  for (int e = first_[index(corner_[index(t)][0])]; e >= 0; e = entry_[index(e)].next) {
    const int hole = entry_[index(e)].hole;
    if (length > hole_[index(hole)].longest && crossed_by(t, hole)) return true;
  }
  return false;
}

int HoleMesh::add_middle(int a, int b) {
  const int middle = static_cast<int>(x_.size());
  x_.push_back(0.5 * (x_[index(a)] + x_[index(b)]));
  normal_.push_back((normal_[index(a)] + normal_[index(b)]).stableNormalized());
  first_.push_back(-1);
  for (int e = first_[index(a)]; e >= 0; e = entry_[index(e)].next) {
    const int hole = entry_[index(e)].hole;
    if (const Entry* other = entry(b, hole)) {
      const Eigen::Vector2d at = 0.5 * (entry_[index(e)].at + other->at);
      add_entry(middle, hole, at);
    }
  }
  return middle;
}

/// Triangle a, b, c becomes a, m, c; the new one is m, b, c. Edge 0 of both is that on a-b.
int HoleMesh::halve(int t, int edge, int middle) {
  const auto c = corner_[index(t)];
  const auto n = across_[index(t)];
  const auto k = index(edge), l = (k + 1) % 3, m = (k + 2) % 3;
  const int half = static_cast<int>(corner_.size());
  corner_[index(t)] = {c[k], middle, c[m]};
  across_[index(t)] = {-1, half, n[m]};
  corner_.push_back({middle, c[l], c[m]});
  across_.push_back({-1, n[l], t});
  if (n[l] >= 0) {
    auto& back = across_[index(n[l])];
    // By corners: two triangles may share more than one edge.
    for (std::size_t j = 0; j < 3; ++j)
      if (back[j] == t && corner_[index(n[l])][j] == c[m]) back[j] = half;
  }
  return half;
}

void HoleMesh::bisect(int t, std::vector<int>& changed) {
  for (;;) {
    const int k = longest_edge(t);
    const int a = corner_[index(t)][index(k)], b = corner_[index(t)][index((k + 1) % 3)];
    const int g = across_[index(t)][index(k)];
    int l = 0;
    if (g >= 0) {
      l = longest_edge(g);
      if (corner_[index(g)][index(l)] != b || corner_[index(g)][index((l + 1) % 3)] != a) {
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
    across_[index(t)][0] = g2;
    across_[index(g2)][0] = t;
    across_[index(t2)][0] = g;
    across_[index(g)][0] = t2;
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

}  // namespace geoprior
