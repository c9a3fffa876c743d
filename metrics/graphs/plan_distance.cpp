#include "metrics/graphs/plan_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace geoprior {
namespace {

using PlanLine = std::vector<Eigen::Vector2d>;

double segment_distance(const Eigen::Vector2d& x, const Eigen::Vector2d& a,
                        const Eigen::Vector2d& b) {
  const Eigen::Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((x - a).dot(ab) / length2, 0., 1.) : 0.;
  return (x - a - t * ab).norm();
}

double distance_to(const Eigen::Vector2d& x, const std::vector<PlanLine>& lines) {
  double least = std::numeric_limits<double>::infinity();
  for (const PlanLine& line : lines)
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
      least = std::min(least, segment_distance(x, line[i], line[i + 1]));
  return least;
}

/// Mean over the length of lines: midpoints of pieces of each segment, weighted by their length.
double mean_distance(const std::vector<PlanLine>& from, const std::vector<PlanLine>& to,
                     double spacing) {
  double sum = 0, length = 0;
  for (const PlanLine& line : from)
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d step = line[i + 1] - line[i];
      const int n = std::max(1, static_cast<int>(std::ceil(step.norm() / spacing)));
      for (int k = 0; k < n; ++k) {
        sum += step.norm() / n * distance_to(line[i] + step * ((k + 0.5) / n), to);
        length += step.norm() / n;
      }
    }
  if (!(length > 0)) throw Error("have no length", "lines in plan");
  return sum / length;
}

PlanLine closed(const std::vector<Eigen::Vector2d>& corners) {
  if (corners.size() < 3) throw Error("has fewer than three corners", "closed line in plan");
  PlanLine out = corners;
  out.push_back(corners.front());
  return out;
}

/// Winding number of a closed line about a point.
int winding(const Eigen::Vector2d& x, const PlanLine& line) {
  int number = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector2d a = line[i] - x, b = line[i + 1] - x;
    const double cross = a.x() * b.y() - a.y() * b.x();
    if (a.y() <= 0 && b.y() > 0 && cross > 0) ++number;
    if (a.y() > 0 && b.y() <= 0 && cross < 0) --number;
  }
  return number;
}

}  // namespace

PlanDistance plan_distance(const std::vector<PlanLine>& lines,
                           const std::vector<Eigen::Vector2d>& corners, double spacing) {
  const std::vector<PlanLine> target{closed(corners)};
  return {mean_distance(lines, target, spacing), mean_distance(target, lines, spacing)};
}

double plan_fill(const std::vector<PlanLine>& lines, const std::vector<Eigen::Vector2d>& corners,
                 double spacing, double reach) {
  const PlanLine target = closed(corners);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& x : target) box.extend(x);
  int inside = 0, near = 0;
  for (double y = box.min().y() + spacing / 2; y < box.max().y(); y += spacing)
    for (double x = box.min().x() + spacing / 2; x < box.max().x(); x += spacing) {
      if (winding({x, y}, target) == 0) continue;
      ++inside;
      if (distance_to({x, y}, lines) <= reach) ++near;
    }
  if (inside == 0) throw Error("holds no point of the lattice", "closed line in plan");
  return static_cast<double>(near) / inside;
}

}  // namespace geoprior
