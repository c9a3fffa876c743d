#include "metrics/isometry/buckled_sector.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "metrics/tracks/weighted_quantile.h"

namespace geoprior {
namespace {

constexpr double kLevel = 0.2;            // of the rise, where the width is taken
constexpr double kSectorOfWidth = 1.653;  // at that level
constexpr double kLeastRise = 0.5;        // of the depth of the apex: 2.8 in theory
/// Of a profile that goes all the way round (rad).
constexpr double kWidestGap = std::numbers::pi / 6;

/// Height over the apex where the circle crosses an edge.
struct Crossing {
  double angle, height;
};

/// Points of the edge a-b at `radius` from the origin: a + t (b - a), t in [0, 1).
void add_crossings(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double height_a,
                   double height_b, double radius, std::vector<Crossing>& out) {
  const Eigen::Vector2d d = b - a;
  const double half_linear = a.dot(d);
  const double quadratic = d.squaredNorm();
  const double discriminant =
      half_linear * half_linear - quadratic * (a.squaredNorm() - radius * radius);
  if (!(discriminant >= 0) || !(quadratic > 0)) return;
  for (const double sign : {-1.0, 1.0}) {
    const double t = (-half_linear + sign * std::sqrt(discriminant)) / quadratic;
    if (!(t >= 0 && t < 1)) continue;
    const Eigen::Vector2d p = a + t * d;
    out.push_back({std::atan2(p(1), p(0)), height_a + t * (height_b - height_a)});
  }
}

/// Heights around the circle, ascending in angle; interior edges appear twice, which does no harm.
std::vector<Crossing> profile(const Eigen::MatrixX2d& from_apex, const Eigen::VectorXd& height,
                              const Eigen::MatrixX3i& triangles, double radius) {
  std::vector<Crossing> crossings;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      // From the lower index, so that both triangles at an edge find the same points.
      const int a = std::min(triangles(t, k), triangles(t, (k + 1) % 3));
      const int b = std::max(triangles(t, k), triangles(t, (k + 1) % 3));
      add_crossings(from_apex.row(a).transpose(), from_apex.row(b).transpose(), height(a),
                    height(b), radius, crossings);
    }
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& p, const Crossing& q) {
    return p.angle < q.angle || (p.angle == q.angle && p.height < q.height);
  });
  return crossings;
}

/// Angle from crossing `i` to the next (rad).
double gap(const std::vector<Crossing>& p, std::size_t i) {
  return i + 1 < p.size() ? p[i + 1].angle - p[i].angle
                          : p[0].angle + 2 * std::numbers::pi - p[i].angle;
}

/// Median over the circle: the height of the ring, as most of the circle lies on it.
double median_height(const std::vector<Crossing>& p) {
  const Eigen::Index n = p.size();
  Eigen::VectorXd height(n);
  Eigen::VectorXd weight(n);
  for (std::size_t i = 0; i < p.size(); ++i) {
    height(i) = p[i].height;
    weight(i) = (gap(p, i) + gap(p, i == 0 ? p.size() - 1 : i - 1)) / 2;
  }
  return weighted_quantile(height, weight, 0.5);
}

/// Angle from the peak to where the profile falls to `level`, going up (`step` 1) or down (-1).
double reach(const std::vector<Crossing>& p, std::size_t peak, int step, double level) {
  double angle = 0;
  std::size_t i = peak;
  for (std::size_t walked = 0; walked < p.size(); ++walked) {
    const std::size_t next = step > 0 ? (i + 1) % p.size() : (i + p.size() - 1) % p.size();
    const double width = step > 0 ? gap(p, i) : gap(p, next);
    if (p[next].height < level) {
      return angle + width * (p[i].height - level) / (p[i].height - p[next].height);
    }
    angle += width;
    i = next;
  }
  return angle;
}

/// Separate parts of the circle above the level.
int rises(const std::vector<Crossing>& p, double level) {
  int count = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i].height < level && p[(i + 1) % p.size()].height >= level) ++count;
  }
  return count;
}

}  // namespace

std::optional<double> buckled_sector(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3d& x,
                                     const Eigen::MatrixX3i& triangles, const Eigen::Vector2d& apex,
                                     double radius, const Eigen::Vector3d& axis) {
  if (pattern.rows() == 0) return std::nullopt;
  const Eigen::MatrixX2d from_apex = pattern.rowwise() - apex.transpose();
  Eigen::Index tip = 0;
  from_apex.rowwise().squaredNorm().minCoeff(&tip);
  Eigen::VectorXd height = (x.rowwise() - x.row(tip)) * axis.normalized();
  std::vector<Crossing> p = profile(from_apex, height, triangles, radius);
  if (p.empty()) return std::nullopt;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (gap(p, i) > kWidestGap) return std::nullopt;
  }
  double ring = median_height(p);
  if (ring < 0) {  // the axis points the way the apex was pushed
    for (Crossing& c : p) c.height = -c.height;
    ring = -ring;
  }
  const auto peak = std::max_element(
      p.begin(), p.end(), [](const Crossing& a, const Crossing& b) { return a.height < b.height; });
  const double rise = peak->height - ring;
  if (!(ring > 0) || rise < kLeastRise * ring) return std::nullopt;
  const std::size_t at = peak - p.begin();
  const double level = ring + kLevel * rise;
  if (rises(p, level) != 1) return std::nullopt;
  return kSectorOfWidth * (reach(p, at, 1, level) + reach(p, at, -1, level)) * 180 /
         std::numbers::pi;
}

}  // namespace geoprior
