#include "models/paper/sheet/valid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "core/error.h"
#include "core/limits.h"

namespace geoprior::paper {
namespace {

/// Most handles, and most obstacles: every pair of handles is looked at, and every obstacle by
/// every vertex in every step.
constexpr double kMostBodies = 1000;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string text(double x) {
  std::ostringstream out;
  out << x;
  return out.str();
}

/// "where.key", or the key alone.
std::string inside(const std::string& where, const std::string& key) {
  return where.empty() ? key : where + "." + key;
}

void require_finite(double x, const std::string& where) {
  if (!std::isfinite(x)) throw Error("is not finite", where, "a finite number");
}

/// Finite, and low <= x <= high; `open` excludes `low`.
void require_range(double x, double low, double high, bool open, const std::string& where) {
  require_finite(x, where);
  if ((open ? x > low : x >= low) && x <= high) return;
  std::string allowed = (open ? "more than " : "at least ") + text(low);
  if (high < kInfinity) allowed += ", at most " + text(high);
  throw Error(text(x) + " is out of range", where, allowed);
}

/// What depends on the grain needs its direction.
void require_grain(const std::optional<double>& grain_deg, double ratio, const std::string& key,
                   const std::string& where) {
  require_range(ratio, 0, kInfinity, true, inside(where, key));
  if (grain_deg) require_finite(*grain_deg, inside(where, "grain_deg"));
  if (ratio != 1 && !grain_deg) {
    throw Error("differs from 1, but the grain has no direction", inside(where, key),
                "grain_deg beside it");
  }
}

/// Finite keys with times that increase.
void require_trajectory(const Trajectory& trajectory, const std::string& where) {
  if (trajectory.keys.empty()) throw Error("has no key", where, "at least one");
  for (std::size_t i = 0; i < trajectory.keys.size(); ++i) {
    const Keyframe& key = trajectory.keys[i];
    const std::string at = where + "." + std::to_string(i);
    require_finite(key.time, inside(at, "t"));
    for (int c = 0; c < 3; ++c) require_finite(key.shift[c], inside(at, "move"));
    for (int c = 0; c < 4; ++c) require_finite(key.turn.coeffs()[c], inside(at, "turn_deg"));
    if (std::abs(key.turn.norm() - 1) > 1e-6) {
      throw Error("is no rotation", inside(at, "turn_deg"), "a unit quaternion");
    }
    if (i > 0 && key.time <= trajectory.keys[i - 1].time) {
      throw Error(
          "time " + text(key.time) + " does not follow " + text(trajectory.keys[i - 1].time),
          inside(at, "t"), "strictly increasing times");
    }
  }
}

/// Places closer than this are one (m).
constexpr double kSamePlace = 1e-9;

std::string text(const Eigen::Vector2d& p) {
  std::ostringstream out;
  out << "(" << p.x() << ", " << p.y() << ") m";
  return out.str();
}

std::string place_of(const Sheet& sheet, std::size_t i, const std::string& where) {
  const std::string& name = sheet.handles[i].name;
  return where + "." + std::to_string(i) + (name.empty() ? "" : " '" + name + "'");
}

void require_inside(const Pattern& pattern, const Eigen::Vector2d& p, const std::string& where) {
  if (!p.allFinite()) throw Error("is not finite", where, "finite coordinates");
  if (contains(pattern, p, 1e-9 * width(pattern))) return;
  const Pattern border{pattern.border};
  throw Error(
      "point " + text(p) +
          (contains(border, p) ? " lies in a hole of the pattern" : " lies outside the pattern"),
      where, "points of the pattern");
}

void require_shape(const Handle& handle, const Pattern& pattern, const std::string& where) {
  if (handle.segment) {
    if (!handle.points.empty() || handle.disc_radius) {
      throw Error("has more than one shape", where, "points, segment or disc");
    }
    require_inside(pattern, handle.segment->first, inside(where, "segment"));
    require_inside(pattern, handle.segment->second, inside(where, "segment"));
    const auto& [a, b] = *handle.segment;
    if (a == b) throw Error("has no length", inside(where, "segment"), "two different ends");
    if (const auto out = leaves_pattern(pattern, a, b, 1e-9 * width(pattern))) {
      throw Error("leaves the pattern at " + text(*out), inside(where, "segment"),
                  "a segment of the pattern, over no hole");
    }
    return;
  }
  if (handle.disc_radius) {
    if (handle.points.size() != 1) throw Error("has no centre", inside(where, "disc"), "one point");
    require_range(*handle.disc_radius, 0, std::numeric_limits<double>::infinity(), true,
                  inside(where, "disc.radius"));
    require_inside(pattern, handle.points[0], inside(where, "disc"));
    if (nearest_on_border(pattern, handle.points[0]).distance < *handle.disc_radius - kSamePlace) {
      throw Error("reaches over the border of the pattern, or over a hole", inside(where, "disc"),
                  "a disc of the pattern");
    }
    return;
  }
  if (handle.points.empty()) throw Error("has no shape", where, "points, segment or disc");
  for (std::size_t i = 0; i < handle.points.size(); ++i) {
    require_inside(pattern, handle.points[i], inside(where, "points." + std::to_string(i)));
  }
}

void require_drive(const Handle& handle, const std::string& where) {
  if (handle.motion.has_value() == handle.force.has_value()) {
    throw Error(handle.motion ? "has both keys and a force" : "has neither keys nor a force", where,
                "one of keys, force");
  }
  if (handle.motion) require_trajectory(*handle.motion, inside(where, "keys"));
  if (handle.stiffness) {
    if (!handle.motion) {
      throw Error("is of a hand that follows keys, and there are none", inside(where, "stiffness"),
                  "keys beside it, or only a force");
    }
    require_range(*handle.stiffness, 0, kInfinity, true, inside(where, "stiffness"));
  }
  if (handle.force) {
    for (int c = 0; c < 3; ++c) require_finite((*handle.force)[c], inside(where, "force"));
  }
  for (std::size_t i = 0; i < handle.active.size(); ++i) {
    const std::string at = inside(where, "active." + std::to_string(i));
    require_finite(handle.active[i].first, at);
    require_finite(handle.active[i].second, at);
    if (handle.active[i].second <= handle.active[i].first) {
      throw Error("ends before it begins", at, "from < to");
    }
  }
}

/// Points that both handles may hold: every anchor of one that the other covers, where two segments
/// cross, where two discs meet.
std::vector<Eigen::Vector2d> shared_points(const Handle& a, const Handle& b) {
  std::vector<Eigen::Vector2d> candidates = a.anchors();
  for (const Eigen::Vector2d& p : b.anchors()) candidates.push_back(p);
  if (a.segment && b.segment) {
    Eigen::Matrix2d m;
    m << a.segment->second - a.segment->first, b.segment->first - b.segment->second;
    if (m.determinant() != 0) {
      const Eigen::Vector2d st = m.inverse() * (b.segment->first - a.segment->first);
      candidates.push_back(a.segment->first + st.x() * (a.segment->second - a.segment->first));
    }
  }
  if (a.disc_radius && b.disc_radius) {
    const double sum = *a.disc_radius + *b.disc_radius;
    candidates.push_back(a.points[0] + *a.disc_radius / sum * (b.points[0] - a.points[0]));
  }
  std::erase_if(candidates, [&](const Eigen::Vector2d& p) {
    return !a.covers(p, kSamePlace) || !b.covers(p, kSamePlace);
  });
  return candidates;
}

/// Times at which the two could disagree: keys, ends of activity, and the middle between each two.
std::vector<double> times_of(const Sheet& sheet, const Handle& a, const Handle& b) {
  std::vector<double> times{0, sheet.duration};
  for (const Handle* handle : {&a, &b}) {
    for (const Keyframe& key : handle->motion->keys) times.push_back(key.time);
    for (const auto& [from, to] : handle->active) {
      times.push_back(from);
      times.push_back(to);
    }
  }
  std::erase_if(times, [&](double t) { return t < 0 || t > sheet.duration; });
  std::sort(times.begin(), times.end());
  const std::size_t count = times.size();
  for (std::size_t i = 0; i + 1 < count; ++i) times.push_back((times[i] + times[i + 1]) / 2);
  return times;
}

Eigen::Vector3d centre_of(const Sheet& sheet, const Handle& handle) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  const std::vector<Eigen::Vector2d> anchors = handle.anchors();
  for (const Eigen::Vector2d& p : anchors) {
    centre += sheet.placement * Eigen::Vector3d(p.x(), p.y(), 0);
  }
  return centre / static_cast<double>(anchors.size());
}

void require_agreement(const Sheet& sheet, std::size_t i, std::size_t j, const std::string& where) {
  const Handle &a = sheet.handles[i], &b = sheet.handles[j];
  if (!a.motion || !b.motion) return;
  const std::vector<Eigen::Vector2d> shared = shared_points(a, b);
  if (shared.empty()) return;
  const Eigen::Vector3d centre_a = centre_of(sheet, a), centre_b = centre_of(sheet, b);
  for (const double t : times_of(sheet, a, b)) {
    if (!a.is_active(t) || !b.is_active(t)) continue;
    for (const Eigen::Vector2d& p : shared) {
      const Eigen::Vector3d rest = sheet.placement * Eigen::Vector3d(p.x(), p.y(), 0);
      const double apart = (a.target(rest, centre_a, t) - b.target(rest, centre_b, t)).norm();
      if (apart <= kSamePlace) continue;
      std::ostringstream problem;
      problem << "moves the point " << text(p) << " otherwise than " << place_of(sheet, i, where)
              << " at t = " << t << " s (" << apart << " m apart)";
      throw Error(problem.str(), place_of(sheet, j, where),
                  "one motion for a point, or active times apart");
    }
  }
}

/// Shapes inside the pattern, one kind of drive each, no point that two of them move differently.
void require_handles(const Sheet& sheet, const std::string& where) {
  require_count(static_cast<double>(sheet.handles.size()), "handles", kMostBodies, where);
  for (std::size_t i = 0; i < sheet.handles.size(); ++i) {
    const std::string at = place_of(sheet, i, where);
    require_shape(sheet.handles[i], sheet.pattern, at);
    require_drive(sheet.handles[i], at);
    for (std::size_t j = 0; j < i; ++j) require_agreement(sheet, j, i, where);
  }
}

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
    for (const Eigen::Vector2d& p : corners(sheet_.pattern)) {
      if (distance(p) < limit_) return p;
    }
    const Eigen::AlignedBox2d box = bounding_box(sheet_.pattern);
    return search(box.center(), box.sizes().maxCoeff() / 2, 0);
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

/// Shapes that exist, and a start of the sheet outside all of them.
void require_obstacles(const Sheet& sheet, const std::string& where) {
  require_count(static_cast<double>(sheet.obstacles.size()), "obstacles", kMostBodies, where);
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

void require_toughness(const Toughness& toughness, const std::string& where) {
  require_range(toughness.energy, 0, 1e9, false, inside(where, "energy"));
  require_range(toughness.noise, 0, 1 - 1e-9, false, inside(where, "noise"));
  require_range(toughness.noise_length, 0, kInfinity, true, inside(where, "noise_length"));
  require_range(toughness.across, 0, 1e6, true, inside(where, "across"));
  require_grain(toughness.grain_deg, toughness.across, "across", where);
}

}  // namespace

std::optional<Eigen::Vector2d> start_nearer_than(const Sheet& sheet, const Obstacle& obstacle,
                                                 double distance) {
  return StartSearch(sheet, obstacle, distance).near_point();
}

void require_valid(const PaperMaterial& material, const std::string& where) {
  const auto positive = [&](double x, const char* key) {
    require_range(x, 0, kInfinity, true, inside(where, key));
  };
  const auto not_negative = [&](double x, const char* key) {
    require_range(x, 0, kInfinity, false, inside(where, key));
  };
  positive(material.thickness, "thickness");
  positive(material.young_modulus, "young_modulus");
  require_range(material.poisson_ratio, 0, 0.499, false, inside(where, "poisson_ratio"));
  positive(material.area_density, "area_density");
  positive(material.yield_curvature, "yield_curvature");
  not_negative(material.weakening, "weakening");
  not_negative(material.friction, "friction");
  not_negative(material.damping, "damping");
  require_grain(material.grain_deg, material.along, "along", where);
}

void require_valid(const Sheet& sheet, const std::string& where) {
  require_simple(sheet.pattern, inside(where, "pattern"));
  require_valid(sheet.material, inside(where, "material"));
  require_toughness(sheet.toughness, inside(where, "toughness"));
  for (int c = 0; c < 3; ++c) require_finite(sheet.gravity[c], inside(where, "gravity"));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) {
      require_finite(sheet.placement.matrix()(i, j), inside(where, "placement"));
    }
  }
  require_range(sheet.imperfection, 0, width(sheet.pattern), false, inside(where, "imperfection"));
  require_range(sheet.duration, 0, 1e6, true, inside(where, "duration"));
  require_range(sheet.frame_interval, 0, sheet.duration, true, inside(where, "frame_interval"));
  require_frames(sheet.duration, sheet.frame_interval, inside(where, "duration"));
  require_range(sheet.substeps, 1, 1e6, false, inside(where, "substeps"));
  require_range(sheet.handle_step, 0, 1e6, true, inside(where, "handle_step"));
  require_handles(sheet, inside(where, "handles"));
  require_obstacles(sheet, inside(where, "obstacles"));
}

}  // namespace geoprior::paper
