#include "testbed/formats/svg/clip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/planar.h"

namespace geoprior {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Larger side of the box about the points of all lines.
double extent_of(const std::vector<SvgSubpath>& lines) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Vector2d low(kInfinity, kInfinity), high = -low;
  for (const SvgSubpath& line : lines) {
    for (const Eigen::Vector2d& p : line.points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  return low.x() <= high.x() ? (high - low).maxCoeff() : 0;
}

/// Distance to the left of the side of a region that begins at its corner i, negative outside.
double inside_of_side(const Points& region, std::size_t i, const Eigen::Vector2d& p) {
  const Eigen::Vector2d& a = region[i];
  const Eigen::Vector2d along = region[(i + 1) % region.size()] - a;
  const double length = along.norm();
  return length > 0 ? cross(along, p - a) / length : 0;
}

}  // namespace

std::vector<Eigen::Vector2d> convex_region(const std::vector<SvgSubpath>& lines) {
  if (lines.size() != 1) return {};
  Points region = lines[0].points;
  while (region.size() > 1 && region.front() == region.back()) region.pop_back();
  const std::size_t n = region.size();
  if (n < 3) return {};
  double turned = 0;
  bool left = false, right = false;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle =
        signed_angle(region[(i + 1) % n] - region[i], region[(i + 2) % n] - region[(i + 1) % n]);
    turned += angle;
    left = left || angle > 0;
    right = right || angle < 0;
  }
  constexpr double kNoise = 1e-3;
  if (left == right || std::abs(std::abs(turned) - 2 * std::numbers::pi) > kNoise) return {};
  if (right) std::reverse(region.begin(), region.end());
  return region;
}

bool hides_part_of(const SvgClip& clip, const std::vector<SvgSubpath>& lines) {
  if (clip.region.empty()) return true;
  const double noise = 1e-9 * extent_of(lines);
  return std::any_of(lines.begin(), lines.end(), [&](const SvgSubpath& line) {
    return std::any_of(line.points.begin(), line.points.end(), [&](const Eigen::Vector2d& p) {
      for (std::size_t i = 0; i < clip.region.size(); ++i) {
        if (inside_of_side(clip.region, i, p) < -noise) return true;
      }
      return false;
    });
  });
}

std::vector<Eigen::Vector2d> clipped_loop(std::vector<Eigen::Vector2d> loop,
                                          const std::vector<Eigen::Vector2d>& region) {
  for (std::size_t side = 0; side < region.size(); ++side) {
    Points inside;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Eigen::Vector2d& p = loop[i];
      const Eigen::Vector2d& q = loop[i + 1 == loop.size() ? 0 : i + 1];
      const double at_p = inside_of_side(region, side, p), at_q = inside_of_side(region, side, q);
      if (at_p >= 0) inside.push_back(p);
      if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0))
        inside.emplace_back(p + at_p / (at_p - at_q) * (q - p));
    }
    loop = std::move(inside);
  }
  return loop;
}

}  // namespace geoprior
