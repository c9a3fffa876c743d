#include "solvers/fluid/lift/exponential_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>

namespace geoprior::fluid {
namespace {

/// The surface near the anchor, with its own vertex numbers (ascending in the old ones).
struct Neighbourhood {
  std::vector<int> vertices;
  std::vector<Eigen::Vector3d> x, normal;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> offset, neighbours;  ///< one rings, compressed; an edge may be listed twice
};

/// A distance along the surface is at least the straight one: a ball holds all that is reached.
Neighbourhood within_ball(std::span<const Eigen::Vector3d> positions,
                          std::span<const std::array<int, 3>> triangles,
                          const Eigen::Vector3d& anchor, int triangle, double radius) {
  Neighbourhood near;
  std::vector<int> local(positions.size(), -1);
  const auto is_near = [&](int v) {
    return (positions[v] - anchor).squaredNorm() <= radius * radius;
  };
  std::vector<std::size_t> kept;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& f = triangles[t];
    if (static_cast<int>(t) != triangle && !is_near(f[0]) && !is_near(f[1]) && !is_near(f[2])) {
      continue;
    }
    kept.push_back(t);
    for (const int v : f) local[v] = 0;
  }
  for (int v = 0; v < std::ssize(local); ++v) {
    if (local[v] < 0) continue;
    local[v] = static_cast<int>(near.vertices.size());
    near.vertices.push_back(v);
    near.x.push_back(positions[v]);
  }
  for (const std::size_t t : kept) {
    const auto& f = triangles[t];
    near.triangles.push_back({local[f[0]], local[f[1]], local[f[2]]});
  }
  return near;
}

void add_rings(Neighbourhood& near) {
  near.offset.assign(near.vertices.size() + 1, 0);
  for (const auto& f : near.triangles) {
    for (const int v : f) near.offset[v + 1] += 2;
  }
  std::partial_sum(near.offset.begin(), near.offset.end(), near.offset.begin());
  near.neighbours.resize(near.offset.back());
  std::vector<int> next(near.offset.begin(), near.offset.end() - 1);
  for (const auto& f : near.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      int& at = next[f[k]];
      near.neighbours[at++] = f[(k + 1) % 3];
      near.neighbours[at++] = f[(k + 2) % 3];
    }
  }
}

void add_normals(Neighbourhood& near) {
  near.normal.assign(near.x.size(), Eigen::Vector3d::Zero());
  for (const auto& f : near.triangles) {
    const Eigen::Vector3d& a = near.x[f[0]];
    const Eigen::Vector3d n = (near.x[f[1]] - a).cross(near.x[f[2]] - a);
    for (const int v : f) near.normal[v] += n;
  }
  for (Eigen::Vector3d& n : near.normal) n.normalize();
}

class Unrolling {
 public:
  Unrolling(const Neighbourhood& near, double radius)
      : near_(near),
        radius_(radius),
        distance_(near.x.size(), std::numeric_limits<double>::infinity()),
        settled_(near.x.size(), 0),
        uv_(near.x.size(), Eigen::Vector2d::Zero()),
        axes_(near.x.size(), Eigen::Matrix3d::Identity()) {}

  /// The anchor acts as a settled neighbour of its triangle's corners.
  void start(const std::array<int, 3>& corners, const Eigen::Vector3d& anchor,
             const Eigen::Matrix3d& axes) {
    for (const int v : corners) {
      uv_[v] = unrolled(near_.x[v] - anchor, axes);
      axes_[v] = turned_to(axes, near_.normal[v]);
      distance_[v] = (near_.x[v] - anchor).norm();
      settled_[v] = 1;
    }
    for (const int v : corners) expand(v);
  }

  void run() {
    while (!queue_.empty()) {
      const auto [distance, v] = queue_.top();
      queue_.pop();
      if (settled_[v] != 0) continue;
      settle(v);
      if (distance <= radius_) expand(v);
    }
  }

  [[nodiscard]] ExponentialMap result() const {
    ExponentialMap map;
    for (std::size_t i = 0; i < settled_.size(); ++i) {
      if (settled_[i] == 0) continue;
      map.vertices.push_back(near_.vertices[i]);
      map.uv.push_back(uv_[i]);
      map.axes.push_back(axes_[i]);
    }
    return map;
  }

 private:
  /// Coordinates of an edge laid into the tangent plane with its length kept.
  static Eigen::Vector2d unrolled(const Eigen::Vector3d& edge, const Eigen::Matrix3d& axes) {
    const Eigen::Vector2d flat(edge.dot(axes.col(0)), edge.dot(axes.col(1)));
    const double length = flat.norm();
    return length > 0 ? Eigen::Vector2d(flat * (edge.norm() / length)) : flat;
  }

  [[nodiscard]] std::span<const int> ring(int v) const {
    const std::size_t begin = near_.offset[v];
    const std::size_t end = near_.offset[v + 1];
    return {near_.neighbours.data() + begin, end - begin};
  }

  void expand(int v) {
    for (const int w : ring(v)) {
      const double distance = distance_[v] + (near_.x[w] - near_.x[v]).norm();
      if (settled_[w] != 0 || distance >= distance_[w]) continue;
      distance_[w] = distance;
      queue_.emplace(distance, w);
    }
  }

  void settle(int v) {
    Eigen::Vector2d uv = Eigen::Vector2d::Zero();
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    double sum = 0;
    for (const int w : ring(v)) {
      if (settled_[w] == 0) continue;
      const Eigen::Vector3d edge = near_.x[v] - near_.x[w];
      const double weight = 1 / std::max(edge.norm(), 1e-300);
      uv += weight * (uv_[w] + unrolled(edge, axes_[w]));
      first += weight * turned_to(axes_[w], near_.normal[v]).col(0);
      sum += weight;
    }
    uv_[v] = uv / sum;
    const Eigen::Vector3d& n = near_.normal[v];
    axes_[v].col(0) = (first - first.dot(n) * n).normalized();
    axes_[v].col(1) = n.cross(axes_[v].col(0));
    axes_[v].col(2) = n;
    settled_[v] = 1;
  }

  const Neighbourhood& near_;
  double radius_;
  std::vector<double> distance_;
  std::vector<char> settled_;
  std::vector<Eigen::Vector2d> uv_;
  std::vector<Eigen::Matrix3d> axes_;
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

Eigen::Matrix3d turned_to(const Eigen::Matrix3d& axes, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d z = axes.col(2);
  // Rodrigues' formula for the rotation z -> normal, c = cos, v = axis times sin.
  const double c = z.dot(normal);
  if (c < -1 + 1e-12) {  // opposite: half a turn about the first axis
    Eigen::Matrix3d result = -axes;
    result.col(0) = axes.col(0);
    return result;
  }
  const Eigen::Vector3d v = z.cross(normal);
  Eigen::Matrix3d result;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d a = axes.col(k);
    result.col(k) = c * a + v.cross(a) + v * (v.dot(a) / (1 + c));
  }
  return result;
}

ExponentialMap exponential_map(std::span<const Eigen::Vector3d> positions,
                               std::span<const std::array<int, 3>> triangles, int triangle,
                               const Eigen::Vector3d& anchor, const Eigen::Matrix3d& axes,
                               double radius) {
  Neighbourhood near = within_ball(positions, triangles, anchor, triangle, radius);
  add_rings(near);
  add_normals(near);
  std::array<int, 3> corners{};
  for (std::size_t k = 0; k < 3; ++k) {
    const int v = triangles[triangle][k];
    corners[k] = static_cast<int>(std::lower_bound(near.vertices.begin(), near.vertices.end(), v) -
                                  near.vertices.begin());
  }
  // Vertex normals weighted by nearness in the triangle: smooth as the anchor moves.
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) {
    edges.col(k) = near.x[corners[k]];
  }
  const Eigen::Vector3d flat = (edges.col(1) - edges.col(0)).cross(edges.col(2) - edges.col(0));
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d b = edges.col((k + 1) % 3) - anchor, c = edges.col((k + 2) % 3) - anchor;
    const double weight = std::max(0.0, b.cross(c).dot(flat));
    normal += weight * near.normal[corners[k]];
  }
  normal = normal.squaredNorm() > 0 ? normal.normalized() : flat.normalized();
  Unrolling unrolling(near, radius);
  unrolling.start(corners, anchor, turned_to(axes, normal));
  unrolling.run();
  return unrolling.result();
}

}  // namespace geoprior::fluid
