#include "metrics/tracks/tear_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/geometry/planar.h"

namespace geoprior {
namespace {

using Eigen::Vector2d;

double distance_to_path(const Vector2d& p, const TearPath& path) {
  double nearest = (p - path.front()).norm();
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vector2d along = path[i] - path[i - 1];
    const double squared = along.squaredNorm();
    const double t = squared > 0 ? std::clamp((p - path[i - 1]).dot(along) / squared, 0.0, 1.0) : 0;
    nearest = std::min(nearest, (p - path[i - 1] - t * along).norm());
  }
  return nearest;
}

void require_points(const TearPath& path) {
  if (path.empty()) throw Error("path of a tear has no point", "tear path", "at least one");
}

}  // namespace

double path_length(const TearPath& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

const TearPath* longest_path(const std::vector<TearPath>& paths) {
  const TearPath* best = nullptr;
  double most = 0;
  for (const TearPath& path : paths) {
    const double length = path_length(path);
    if (length <= most) continue;
    most = length;
    best = &path;
  }
  return best;
}

TearPath first_part(const TearPath& path, double length) {
  require_points(path);
  TearPath result{path.front()};
  for (std::size_t i = 1; i < path.size() && length > 0; ++i) {
    const double step = (path[i] - path[i - 1]).norm();
    if (!(step > 0)) continue;
    result.push_back(path[i - 1] + std::min(1.0, length / step) * (path[i] - path[i - 1]));
    length -= step;
  }
  return result;
}

double focal_drift(const TearPath& path, const Vector2d& a, const Vector2d& b) {
  require_points(path);
  const double distance = (b - a).norm();
  if (!(distance > 0)) throw Error("both pulls are at one point", "tear path", "two points");
  const auto difference = [&](const Vector2d& c) { return (c - a).norm() - (c - b).norm(); };
  double most = 0;
  for (const Vector2d& c : path) {
    most = std::max(most, std::abs(difference(c) - difference(path.front())));
  }
  return most / distance;
}

double chord_angle_deg(const TearPath& path, const Vector2d& direction) {
  require_points(path);
  const Vector2d chord = path.back() - path.front();
  if (chord.isZero(0)) return 0;
  return std::abs(signed_angle(direction, chord)) * 180 / std::numbers::pi;
}

double path_bow(const TearPath& path) {
  require_points(path);
  const Vector2d chord = path.back() - path.front();
  const double length = chord.norm();
  if (!(length > 0)) return 0;
  double most = 0;
  for (const Vector2d& p : path) {
    most = std::max(most, std::abs(cross(chord, p - path.front())) / length);
  }
  return most / length;
}

double path_distance(const TearPath& p, const TearPath& q) {
  require_points(p);
  require_points(q);
  double most = 0;
  for (const Vector2d& x : p) most = std::max(most, distance_to_path(x, q));
  for (const Vector2d& x : q) most = std::max(most, distance_to_path(x, p));
  return most;
}

PathComparison compare_paths(const TearPath& path, const TearPath& reference) {
  const double length = std::min(path_length(path), path_length(reference));
  if (!(length > 0)) throw Error("path of a tear has no length", "tear path", "above 0 m");
  const TearPath p = first_part(path, length), q = first_part(reference, length);
  PathComparison result;
  result.distance = path_distance(p, q);
  for (const Vector2d& x : p) result.drift = std::max(result.drift, distance_to_path(x, q));
  result.drift /= length;
  result.deviation = chord_angle_deg(p, q.back() - q.front());
  return result;
}

double fracture_energy(const std::vector<TearPath>& paths, const TearToughness& toughness,
                       double thickness) {
  double sum = 0;
  for (const TearPath& path : paths) {
    for (std::size_t i = 1; i < path.size(); ++i) {
      const Eigen::Vector2d way = path[i] - path[i - 1];
      if (way.isZero(0)) continue;
      sum += toughness(path[i - 1] + way / 2, way.normalized()) * way.norm() * thickness;
    }
  }
  return sum;
}

Vector2d bisector_direction(const Vector2d& c, const Vector2d& a, const Vector2d& b) {
  const Vector2d sum = (a - c).normalized() + (b - c).normalized();
  const double norm = sum.norm();
  return norm > 1e-12 ? Vector2d(-sum / norm) : Vector2d(Vector2d::Zero());
}

TearPath bisector_path(const Vector2d& start, const Vector2d& a, const Vector2d& b, double length,
                       double step) {
  if (bisector_direction(start, a, b).isZero(0)) {
    throw Error("tear starts on the line between its pulls", "tear path", "a point beside it");
  }
  TearPath path{start};
  const auto steps = static_cast<int>(std::lround(length / step));
  for (int i = 0; i < steps; ++i) {
    const Vector2d& c = path.back();
    const Vector2d middle = c + step / 2 * bisector_direction(c, a, b);
    path.push_back(c + step * bisector_direction(middle, a, b));
  }
  return path;
}

double onset_force(const Vector2d& c, const Vector2d& a, const Vector2d& b, double toughness,
                   double thickness) {
  const double theta = std::abs(signed_angle(a - c, b - c));
  return toughness * thickness / (2 * std::cos(theta / 2));
}

}  // namespace geoprior
