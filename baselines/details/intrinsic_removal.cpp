#include <algorithm>
#include <utility>

#include "baselines/details/intrinsic_triangulation.h"

namespace geoprior {

bool IntrinsicTriangulation::flip_down_to_three(int v, std::vector<int>& touched) {
  for (int left = degree(v); left > 3; --left) {
    bool flipped = false;
    const int start = out_[index(v)];
    for (int h = start; !flipped;) {
      const int along = previous(h), g = twin_[index(along)];  // the next spoke; v is interior
      const int other = twin_[index(h)] / 3;
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
  int h = out_[index(v)];
  double mass = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    spoke[k] = h;
    const int outer = next(h);
    corner[k] = origin(outer);
    length[k] = length_[index(outer)];
    twin[k] = twin_[index(outer)];
    mass += density(h / 3) * area(h / 3);
    h = twin_[index(previous(h))];
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
  density_[index(t)] = here > 0 ? mass / here : 0;
  out_[index(v)] = -1;
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
  const int start = out_[index(v)];
  for (int h = start;;) {
    ring.emplace_back(length_[index(h)], tip(h));
    h = twin_[index(previous(h))];
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
  const int v = origin(h), w = tip(h), g = twin_[index(h)];
  std::vector<int> star;  // half-edges that leave v
  const int start = out_[index(v)];
  double mass = 0;
  for (int e = start;;) {
    star.push_back(e);
    mass += density(e / 3) * area(e / 3);
    e = twin_[index(previous(e))];
    if (e == start) break;
  }
  // The edges v-c and w-c become one, and so do v-d and w-d.
  const std::array<std::pair<int, int>, 2> joined{
      std::pair(twin_[index(previous(h))], twin_[index(next(h))]),
      std::pair(twin_[index(next(g))], twin_[index(previous(g))])};
  const std::array<double, 2> kept{length_[index(next(h))], length_[index(previous(g))]};
  for (const int e : star) {
    if (e / 3 == h / 3 || e / 3 == g / 3) continue;
    origin_[index(e)] = w;
    const double chord = (position[index(w)] - position[index(tip(e))]).norm();
    set_length(e, chord);
    set_length(previous(e), (position[index(w)] - position[index(origin(previous(e)))]).norm());
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const auto [inner, outer] = joined[side];
    twin_[index(inner)] = outer;
    length_[index(inner)] = kept[side];
    if (outer >= 0) twin_[index(outer)] = inner;
  }
  free_triangle(h / 3);
  free_triangle(g / 3);
  out_[index(v)] = -1;
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
    if (triangle_alive(e / 3)) density_[index(e / 3)] = left > 0 ? mass / left : 0;
  settle(stack_);
  return true;
}

}  // namespace geoprior
