#include "core/geometry/holes/loop_cap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <unordered_map>

#include "core/geometry/topology.h"

namespace geoprior {
namespace {

constexpr double kChordShare = 0.01;  // of the square of a chord, beside areas
constexpr double kNoArea = 1e-6;      // of a triangle over the square of its longest side
constexpr double kSlit = 1e-6;        // of a cap over the square of its loop's length
constexpr double kForbidden = std::numeric_limits<double>::infinity();

Eigen::Vector3d area_vector(const Eigen::MatrixX3d& V, const std::vector<int>& loop) {
  const Eigen::RowVector3d origin = V.row(loop[0]);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Eigen::Vector3d a = V.row(loop[i]) - origin;
    const Eigen::Vector3d b = V.row(loop[i + 1]) - origin;
    sum += a.cross(b) / 2;
  }
  return sum;
}

/// Three vertices in the order of the loop.
struct Ear {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  double longest_squared = 0;
  double chord_squared = 0;  ///< from the first to the last

  Ear(const Eigen::MatrixX3d& V, int a, int b, int c) {
    const Eigen::Vector3d ab = V.row(b) - V.row(a), ac = V.row(c) - V.row(a);
    area = ab.cross(ac) / 2;
    chord_squared = ac.squaredNorm();
    longest_squared = std::max({ab.squaredNorm(), (ac - ab).squaredNorm(), chord_squared});
  }
  [[nodiscard]] bool faces(const Eigen::Vector3d& way) const {
    return area.norm() > kNoArea * longest_squared && area.dot(way) > 0;
  }
  [[nodiscard]] double cost(const Eigen::Vector3d& way) const {
    return area.norm() + kChordShare * chord_squared + (faces(way) ? 0 : longest_squared);
  }
};

/// Cuts off every second vertex that may go, until `kExactLoop` are left.
bool shorten(const Eigen::MatrixX3d& V, const Eigen::Vector3d& way,
             const std::function<bool(int, int)>& is_edge, std::vector<int>& loop,
             std::vector<CapTriangle>& cap) {
  while (std::ssize(loop) > kExactLoop) {
    std::vector<int> left{loop[0]};
    for (std::size_t i = 1; i < loop.size(); ++i) {
      const int next = loop[(i + 1) % loop.size()];
      const bool is_cut = i + 1 < loop.size() && !is_edge(left.back(), next) &&
                          Ear(V, left.back(), loop[i], next).faces(way);
      if (is_cut) cap.push_back({left.back(), next, loop[i]});
      left.push_back(is_cut ? next : loop[i]);
      if (is_cut) ++i;
    }
    if (left.size() == loop.size()) return false;
    loop = std::move(left);
  }
  return true;
}

/// The least triangulation of the polygons that chords cut off a loop.
class ChordTable {
 public:
  ChordTable(const Eigen::MatrixX3d& V, const std::vector<int>& loop, const Eigen::Vector3d& way,
             const std::function<bool(int, int)>& is_edge)
      : loop_(loop), count_(std::ssize(loop)), cost_(count_ * count_, 0), apex_(cost_.size(), -1) {
    for (std::ptrdiff_t gap = 2; gap < count_; ++gap) {
      for (std::ptrdiff_t i = 0; i + gap < count_; ++i) {
        const std::ptrdiff_t k = i + gap;
        double& least = cost_[at(i, k)];
        least = kForbidden;
        if (gap + 1 < count_ && is_edge(loop[i], loop[k])) continue;
        for (std::ptrdiff_t j = i + 1; j < k; ++j) {
          const double rest = cost_[at(i, j)] + cost_[at(j, k)];
          if (!(rest < least)) continue;
          const double cost = rest + Ear(V, loop[i], loop[j], loop[k]).cost(way);
          if (!(cost < least)) continue;
          least = cost;
          apex_[at(i, k)] = static_cast<int>(j);
        }
      }
    }
  }

  [[nodiscard]] bool is_possible() const { return cost_[at(0, count_ - 1)] < kForbidden; }

  void write(std::vector<CapTriangle>& cap) const {
    std::vector<std::array<std::ptrdiff_t, 2>> open{{0, count_ - 1}};
    while (!open.empty()) {
      const auto [i, k] = open.back();
      open.pop_back();
      if (k - i < 2) continue;
      const std::ptrdiff_t j = apex_[at(i, k)];
      cap.push_back({loop_[i], loop_[k], loop_[j]});
      open.push_back({i, j});
      open.push_back({j, k});
    }
  }

 private:
  [[nodiscard]] std::size_t at(std::ptrdiff_t i, std::ptrdiff_t k) const { return i * count_ + k; }

  const std::vector<int>& loop_;
  std::ptrdiff_t count_;
  std::vector<double> cost_;  ///< of what chord (i, k), i < k, cuts off between them
  std::vector<int> apex_;     ///< third corner of the triangle at that chord
};

double length_of(const Eigen::MatrixX3d& V, const std::vector<int>& loop) {
  double length = (V.row(loop.front()) - V.row(loop.back())).norm();
  for (std::size_t i = 1; i < loop.size(); ++i)
    length += (V.row(loop[i]) - V.row(loop[i - 1])).norm();
  return length;
}

double area_of(const Eigen::MatrixX3d& V, const std::vector<CapTriangle>& triangles) {
  double area = 0;
  for (const auto& [a, b, c] : triangles) area += Ear(V, a, b, c).area.norm();
  return area;
}

/// Boundary edges by their start, each walked once.
class BoundaryWalk {
 public:
  explicit BoundaryWalk(const std::vector<Edge>& edges) {
    for (const auto& [from, to] : edges) ways_[from].push_back(to);
    for (auto& [from, to] : ways_) std::reverse(to.begin(), to.end());
  }

  /// Walks from a vertex until no way leads on.
  void walk(int start, BoundaryLoops& found) {
    std::vector<int> path{start};
    std::unordered_map<int, std::size_t> place{{start, 0}};
    for (;;) {
      const auto ways = ways_.find(path.back());
      if (ways == ways_.end() || ways->second.empty()) break;
      const int next = ways->second.back();
      ways->second.pop_back();
      const auto known = place.find(next);
      if (known == place.end()) {
        place[next] = path.size();
        path.push_back(next);
        continue;
      }
      const auto begin = path.begin() + static_cast<std::ptrdiff_t>(known->second);
      found.loops.emplace_back(begin, path.end());
      for (auto it = begin + 1; it != path.end(); ++it) place.erase(*it);
      path.erase(begin + 1, path.end());
    }
    found.stray_edges += static_cast<int>(path.size()) - 1;
  }

 private:
  std::unordered_map<int, std::vector<int>> ways_;
};

}  // namespace

BoundaryLoops boundary_loops(const Eigen::MatrixX3i& F) {
  const std::vector<Edge> edges = boundary_edges(F);
  BoundaryWalk walk(edges);
  BoundaryLoops found;
  for (const Edge& edge : edges) walk.walk(edge[0], found);
  return found;
}

std::vector<CapTriangle> cap_of_loop(const Eigen::MatrixX3d& V, const std::vector<int>& loop,
                                     const std::function<bool(int, int)>& is_edge) {
  const Eigen::Vector3d way = area_vector(V, loop);
  std::vector<int> left = loop;
  std::vector<CapTriangle> cap;
  if (!shorten(V, way, is_edge, left, cap)) return {};
  const ChordTable table(V, left, way, is_edge);
  if (!table.is_possible()) return {};
  table.write(cap);
  const double length = length_of(V, loop);
  if (!(area_of(V, cap) > kSlit * length * length)) return {};
  return cap;
}

}  // namespace geoprior
