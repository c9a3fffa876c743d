#include "experiments/fluid/injected/contour.h"

#include <algorithm>
#include <array>
#include <utility>

namespace geoprior::fluid {
namespace {

constexpr double kLeast = 0.02;  // of an edge between a crossing and a node: no triangle collapses

std::uint64_t mixed(std::uint64_t key) {
  key ^= key >> 31;
  key *= 0x9E3779B97F4A7C15ULL;
  return key ^ (key >> 29);
}

Eigen::Vector3i corner_offset(int corner) {
  return {corner & 1, (corner >> 1) & 1, (corner >> 2) & 1};
}

}  // namespace

LatticeContour::LatticeContour(const Eigen::Vector3d& origin, double spacing)
    : origin_(origin), spacing_(spacing), slots_(1 << 12) {}

void LatticeContour::grow() {
  std::vector<Slot> old(slots_.size() * 2);
  old.swap(slots_);
  for (const Slot& slot : old) {
    if (slot.vertex < 0) continue;
    std::size_t at = mixed(slot.key) & (slots_.size() - 1);
    while (slots_[at].vertex >= 0) at = (at + 1) & (slots_.size() - 1);
    slots_[at] = slot;
  }
}

/// The vertex on the lattice edge between corners a and b, where `values` changes sign.
int LatticeContour::vertex(const Eigen::Vector3i& cell, int a, int b, const double (&values)[8]) {
  if (a > b) std::swap(a, b);  // a's bits are a part of b's along every edge used
  const Eigen::Vector3i node = cell + corner_offset(a);
  const auto part = [&](int axis) { return static_cast<std::uint64_t>(node[axis]) & 0x1FFFFF; };
  const std::uint64_t key =
      (((part(0) << 20 | part(1)) << 20 | part(2)) << 3) | static_cast<std::uint64_t>(a ^ b);
  std::size_t at = mixed(key) & (slots_.size() - 1);
  while (slots_[at].vertex >= 0) {
    if (slots_[at].key == key) return slots_[at].vertex;
    at = (at + 1) & (slots_.size() - 1);
  }
  const int index = static_cast<int>(vertices_.size());
  slots_[at] = {key, index};
  const double t = std::clamp(values[a] / (values[a] - values[b]), kLeast, 1 - kLeast);
  const Eigen::Vector3d along = (corner_offset(b) - corner_offset(a)).cast<double>();
  vertices_.emplace_back(origin_ + spacing_ * (node.cast<double>() + t * along));
  if (vertices_.size() * 2 > slots_.size()) grow();
  return index;
}

/// @param even  the corners, in order, span a positive volume
void LatticeContour::add_tetrahedron(const Eigen::Vector3i& cell, const int (&corner)[4], bool even,
                                     const double (&values)[8]) {
  std::array<int, 4> order{};  // inside first; keeps track of the permutation's sign
  int inside = 0;
  for (int c = 0; c < 4; ++c) {
    if (values[corner[c]] < 0) order[inside++] = c;
  }
  if (inside == 0 || inside == 4) return;
  int next = inside;
  for (int c = 0; c < 4; ++c) {
    if (!(values[corner[c]] < 0)) order[next++] = c;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) even = order[i] > order[j] ? !even : even;
  }
  const auto at = [&](std::size_t i, std::size_t j) {
    return vertex(cell, corner[order[i]], corner[order[j]], values);
  };
  const auto add = [&](int a, int b, int c) {
    if (even) {
      triangles_.emplace_back(a, b, c);
    } else {
      triangles_.emplace_back(a, c, b);
    }
  };
  if (inside == 1) {
    add(at(0, 1), at(0, 2), at(0, 3));
  } else if (inside == 3) {
    // Away from the outer corner is inwards; an odd move brings it to the front: both turn it.
    add(at(0, 3), at(1, 3), at(2, 3));
  } else {
    const int a = at(0, 2), b = at(0, 3), c = at(1, 3), d = at(1, 2);
    add(a, b, c);
    add(a, c, d);
  }
}

void LatticeContour::add_cell(int i, int j, int k, const double (&values)[8]) {
  int negative = 0;
  for (const double value : values) negative += value < 0 ? 1 : 0;
  if (negative == 0 || negative == 8) return;
  const Eigen::Vector3i cell(i, j, k);
  static constexpr int kAxes[6][2] = {{0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}};
  for (int t = 0; t < 6; ++t) {
    const int a = 1 << kAxes[t][0], b = 1 << kAxes[t][1];
    add_tetrahedron(cell, {0, a, a | b, 7}, t < 3, values);
  }
}

TriMesh LatticeContour::mesh() const {
  TriMesh mesh;
  mesh.V.resize(vertices_.size(), 3);
  for (std::size_t v = 0; v < vertices_.size(); ++v) mesh.V.row(v) = vertices_[v].transpose();
  mesh.F.resize(triangles_.size(), 3);
  for (std::size_t t = 0; t < triangles_.size(); ++t) mesh.F.row(t) = triangles_[t].transpose();
  return mesh;
}

}  // namespace geoprior::fluid
