#include <algorithm>
#include <limits>
#include <sstream>

#include "baselines/paper/sheet_checks.h"
#include "core/error.h"

namespace geoprior::sheet_checks {
namespace {

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
  if (!contains(pattern, p, 1e-9 * width(pattern))) {
    throw Error("point " + text(p) + " lies outside the pattern", where, "points of the pattern");
  }
}

void require_shape(const Handle& handle, const Pattern& pattern, const std::string& where) {
  if (handle.segment) {
    if (!handle.points.empty() || handle.disc_radius) {
      throw Error("has more than one shape", where, "points, segment or disc");
    }
    require_inside(pattern, handle.segment->first, inside(where, "segment"));
    require_inside(pattern, handle.segment->second, inside(where, "segment"));
    if (handle.segment->first == handle.segment->second) {
      throw Error("has no length", inside(where, "segment"), "two different ends");
    }
    return;
  }
  if (handle.disc_radius) {
    if (handle.points.size() != 1) throw Error("has no centre", inside(where, "disc"), "one point");
    require_range(*handle.disc_radius, 0, std::numeric_limits<double>::infinity(), true,
                  inside(where, "disc.radius"));
    require_inside(pattern, handle.points[0], inside(where, "disc"));
    if (nearest_on_border(pattern, handle.points[0]).distance < *handle.disc_radius - kSamePlace) {
      throw Error("reaches over the border of the pattern", inside(where, "disc"),
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

}  // namespace

void require_handles(const Sheet& sheet, const std::string& where) {
  for (std::size_t i = 0; i < sheet.handles.size(); ++i) {
    const std::string at = place_of(sheet, i, where);
    require_shape(sheet.handles[i], sheet.pattern, at);
    require_drive(sheet.handles[i], at);
    for (std::size_t j = 0; j < i; ++j) require_agreement(sheet, j, i, where);
  }
}

}  // namespace geoprior::sheet_checks
