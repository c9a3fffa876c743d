#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "baselines/paper/sheet_checks.h"
#include "baselines/paper/sheet_start.h"
#include "core/error.h"

namespace geoprior::sheet_checks {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void require_shape(const Obstacle& obstacle, const std::string& where) {
  const bool round = obstacle.kind != Obstacle::Kind::plane;
  for (int c = 0; c < 3; ++c) {
    require_finite(obstacle.centre[c], inside(where, "centre"));
    require_finite(obstacle.axis[c], inside(where, "axis"));
  }
  if (std::abs(obstacle.axis.norm() - 1) > 1e-9) {
    throw Error("is no unit vector", inside(where, "axis"), "a direction");
  }
  if (round) require_range(obstacle.radius, 0, kInfinity, true, inside(where, "radius"));
  if (obstacle.kind == Obstacle::Kind::torus) {
    require_range(obstacle.tube_radius, 0, obstacle.radius, true, inside(where, "tube_radius"));
  }
  require_range(obstacle.half_length, 0, kInfinity, false, inside(where, "half_length"));
  if (obstacle.motion) require_trajectory(*obstacle.motion, inside(where, "keys"));
  for (std::size_t i = 0; i < obstacle.radii.size(); ++i) {
    const std::string at = inside(where, "radii." + std::to_string(i));
    require_finite(obstacle.radii[i].first, at + ".t");
    require_range(obstacle.radii[i].second, 0, kInfinity, true, at + ".radius");
    if (i > 0 && obstacle.radii[i].first <= obstacle.radii[i - 1].first) {
      throw Error("does not follow the time before it", at + ".t", "strictly increasing times");
    }
  }
}

/// Looks for a point of the flat start that is nearer than `limit` to an obstacle: squares of the
/// pattern are divided until the distance at their centre, which changes no faster than the place,
/// excludes them.
class StartSearch {
 public:
  StartSearch(const Sheet& sheet, const Obstacle& obstacle, double limit)
      : sheet_(sheet), at_start_(obstacle, 0), limit_(limit) {}

  [[nodiscard]] std::optional<Eigen::Vector2d> near_point() const {
    Eigen::Vector2d low = sheet_.pattern.border.front(), high = low;
    for (const Eigen::Vector2d& p : sheet_.pattern.border) {
      if (distance(p) < limit_) return p;
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    return search((low + high) / 2, (high - low).maxCoeff() / 2, 0);
  }

 private:
  static constexpr int kDepth = 8;

  [[nodiscard]] double distance(const Eigen::Vector2d& p) const {
    return at_start_.contact(sheet_.placement * Eigen::Vector3d(p.x(), p.y(), 0)).distance;
  }

  [[nodiscard]] std::optional<Eigen::Vector2d> search(const Eigen::Vector2d& centre, double half,
                                                      int depth) const {
    const double here = distance(centre);
    if (here - std::sqrt(2.0) * half > limit_) return std::nullopt;
    if (here < limit_ && contains(sheet_.pattern, centre)) return centre;
    if (depth == kDepth) return std::nullopt;
    for (const double du : {-0.5, 0.5}) {
      for (const double dv : {-0.5, 0.5}) {
        if (auto found = search(centre + half * Eigen::Vector2d(du, dv), half / 2, depth + 1)) {
          return found;
        }
      }
    }
    return std::nullopt;
  }

  const Sheet& sheet_;
  ObstacleAt at_start_;
  double limit_;
};

}  // namespace

void require_obstacles(const Sheet& sheet, const std::string& where) {
  const double tolerance = std::max(sheet.imperfection, 1e-9);
  for (std::size_t i = 0; i < sheet.obstacles.size(); ++i) {
    const Obstacle& obstacle = sheet.obstacles[i];
    const std::string at =
        where + "." + std::to_string(i) + (obstacle.name.empty() ? "" : " '" + obstacle.name + "'");
    require_shape(obstacle, at);
    const auto deep = start_nearer_than(sheet, obstacle, -tolerance);
    if (!deep) continue;
    std::ostringstream problem;
    problem << "contains the start of the sheet at the pattern point (" << deep->x() << ", "
            << deep->y() << ") m";
    throw Error(problem.str(), at, "a sheet that starts outside every obstacle");
  }
}

}  // namespace geoprior::sheet_checks

namespace geoprior {

std::optional<Eigen::Vector2d> start_nearer_than(const Sheet& sheet, const Obstacle& obstacle,
                                                 double distance) {
  return sheet_checks::StartSearch(sheet, obstacle, distance).near_point();
}

}  // namespace geoprior
