#include "models/paper/contact/contact.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/planar.h"
#include "core/parallel.h"

namespace geoprior::paper {
namespace {

/// A point fixed to the sheet: a vertex, or inside a triangle.
struct Sample {
  std::array<int, 3> vertex;
  std::array<double, 3> weight;
  int count;
  double area;  ///< m^2
};

Eigen::Vector3d combine(const Sample& s, const Eigen::MatrixX3d& x) {
  Eigen::Vector3d p = s.weight[0] * x.row(s.vertex[0]).transpose();
  for (int k = 1; k < s.count; ++k) {
    p += s.weight[k] * x.row(s.vertex[k]).transpose();
  }
  return p;
}

class ObstacleContact final : public ContactTerm {
 public:
  ObstacleContact(const std::vector<Obstacle>& obstacles, const ShellMesh& mesh,
                  const ObstacleContactOptions& options)
      : obstacles_(obstacles), options_(options) {
    corner_area_.setZero(mesh.vertex_count());
    for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) sample_triangle(mesh, t);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      samples_.push_back({{v, v, v}, {1, 0, 0}, 1, corner_area_[v]});
    }
  }

  void find(const ContactQuery& query, std::vector<ContactPoint>& out) const override {
    std::vector<ObstacleAt> now;
    for (const Obstacle& obstacle : obstacles_) now.emplace_back(obstacle, query.time);
    const std::size_t n = samples_.size();
    constexpr std::size_t kBlock = 512;
    std::vector<std::vector<ContactPoint>> found((n + kBlock - 1) / kBlock);
    parallel_blocks(n, kBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        test(samples_[i], query, now, found[begin / kBlock]);
      }
    });
    for (const auto& points : found) out.insert(out.end(), points.begin(), points.end());
  }

 private:
  /// Composite trapezoidal rule on the triangle cut into m x m: corner points of the small
  /// triangles, each with a third of the area of those that meet there.
  void sample_triangle(const ShellMesh& mesh, Eigen::Index t) {
    const Eigen::Vector3i v = mesh.triangles.row(t);
    const auto p = [&](int k) { return Eigen::Vector2d(mesh.pattern.row(v[k]).transpose()); };
    const Eigen::Vector2d b = p(1) - p(0), c = p(2) - p(0);
    const double area = cross(b, c) / 2;
    const double longest = std::max({b.norm(), c.norm(), (c - b).norm()});
    const int m = static_cast<int>(std::clamp(std::ceil(longest / options_.spacing), 1.0,
                                              static_cast<double>(options_.most_divisions)));
    const double small = area / (m * m);
    for (const int i : v) corner_area_[i] += small / 3;
    for (int i = 0; i <= m; ++i) {
      for (int j = 0; i + j <= m; ++j) {
        const int k = m - i - j;
        if (i == m || j == m || k == m) continue;
        const bool on_edge = i == 0 || j == 0 || k == 0;
        samples_.push_back(
            {{v[0], v[1], v[2]},
             {static_cast<double>(i) / m, static_cast<double>(j) / m, static_cast<double>(k) / m},
             3,
             on_edge ? small : 2 * small});
      }
    }
  }

  void test(const Sample& sample, const ContactQuery& query, const std::vector<ObstacleAt>& now,
            std::vector<ContactPoint>& out) const {
    const Eigen::Vector3d p = combine(sample, query.x);
    for (const ObstacleAt& obstacle : now) {
      const Obstacle::Contact contact = obstacle.contact(p);
      double reach = contact.distance;
      if (query.displacement != nullptr) {
        reach = std::min(reach, reach + contact.normal.dot(combine(sample, *query.displacement)));
      }
      if (!(reach < options_.distance)) continue;
      ContactPoint point;
      point.count = sample.count;
      for (int k = 0; k < sample.count; ++k) {
        point.vertex[k] = sample.vertex[k];
        point.weight[k] = sample.weight[k];
      }
      point.normal = contact.normal;
      point.surface_velocity = contact.velocity;
      point.gap = contact.distance;
      point.stiffness = options_.stiffness * sample.area;
      out.push_back(point);
    }
  }

  std::vector<Obstacle> obstacles_;
  ObstacleContactOptions options_;
  std::vector<Sample> samples_;
  Eigen::VectorXd corner_area_;
};

}  // namespace

std::unique_ptr<ContactTerm> make_obstacle_contact(const std::vector<Obstacle>& obstacles,
                                                   const ShellMesh& mesh,
                                                   const ObstacleContactOptions& options) {
  return std::make_unique<ObstacleContact>(obstacles, mesh, options);
}

double contact_energy(const std::vector<ContactPoint>& points, double distance) {
  double energy = 0;
  for (const ContactPoint& point : points) {
    const double depth = std::max(0.0, distance - point.gap);
    energy += point.stiffness / 2 * depth * depth;
  }
  return energy;
}

}  // namespace geoprior::paper
