#include "experiments/paper/pulled_apart.h"

#include <algorithm>
#include <sstream>
#include <vector>

#include "core/planar.h"

namespace geoprior::paper {
namespace {

/// A point of the pattern that a handle moves.
struct Anchor {
  std::size_t handle;
  Eigen::Vector2d pattern;
  Eigen::Vector3d rest, centre;
};

/// The imperfection of another seed moves no two points by as much as a ten-thousandth.
constexpr std::uint64_t kSeed = 1;

std::vector<Anchor> moving_anchors(const Sheet& sheet) {
  std::vector<Anchor> anchors;
  for (std::size_t i = 0; i < sheet.handles.size(); ++i) {
    if (!sheet.handles[i].motion) continue;
    const std::vector<Eigen::Vector2d> points = sheet.handles[i].anchors();
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const Eigen::Vector2d& p : points) {
      centre += sheet.rest_place(p, kSeed) / static_cast<double>(points.size());
    }
    for (const Eigen::Vector2d& p : points) {
      anchors.push_back({i, p, sheet.rest_place(p, kSeed), centre});
    }
  }
  return anchors;
}

std::vector<double> sample_times(const Sheet& sheet) {
  std::vector<double> ends{0, sheet.duration};
  for (const Handle& handle : sheet.handles) {
    if (!handle.motion) continue;
    for (const Keyframe& key : handle.motion->keys) ends.push_back(key.time);
    for (const auto& [from, to] : handle.active) {
      ends.push_back(from);
      ends.push_back(to);
    }
  }
  std::erase_if(ends, [&](double t) { return t < 0 || t > sheet.duration; });
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<double> times{ends.front()};
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    for (int k = 1; k <= kTimesBetween; ++k) {
      times.push_back(ends[i] + (ends[i + 1] - ends[i]) * k / (kTimesBetween + 1));
    }
    times.push_back(ends[i + 1]);
  }
  return times;
}

bool is_convex(const Pattern& pattern) {
  if (!pattern.holes.empty()) return false;
  const std::size_t n = pattern.border.size();
  const double tolerance = 1e-12 * width(pattern) * width(pattern);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d a = pattern.border[(i + 1) % n] - pattern.border[i];
    const Eigen::Vector2d b = pattern.border[(i + 2) % n] - pattern.border[(i + 1) % n];
    if (cross(a, b) < -tolerance) return false;
  }
  return true;
}

std::string name_of(const Sheet& sheet, std::size_t i, const std::string& where) {
  const std::string& name = sheet.handles[i].name;
  return where + ".handles." + std::to_string(i) + (name.empty() ? "" : " '" + name + "'");
}

}  // namespace

std::optional<PulledApart> worst_pulled_apart(const Sheet& sheet, double tolerance) {
  // Points of two handles that coincide are required to move as one (require_valid).
  constexpr double kSamePlace = 1e-9;
  if (!is_convex(sheet.pattern)) return std::nullopt;
  const std::vector<Anchor> anchors = moving_anchors(sheet);
  std::optional<PulledApart> worst;
  double worst_ratio = 1 + tolerance;
  std::vector<Eigen::Vector3d> places(anchors.size());
  for (const double t : sample_times(sheet)) {
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      const Anchor& a = anchors[i];
      places[i] = sheet.handles[a.handle].target(a.rest, a.centre, t);
      if (!sheet.handles[a.handle].is_active(t)) continue;
      for (std::size_t j = 0; j < i; ++j) {
        const Anchor& b = anchors[j];
        const double in_pattern = (a.pattern - b.pattern).norm();
        if (a.handle == b.handle || in_pattern <= kSamePlace) continue;
        if (!sheet.handles[b.handle].is_active(t)) continue;
        const double apart = (places[i] - places[j]).norm();
        if (apart <= worst_ratio * in_pattern) continue;
        worst_ratio = apart / in_pattern;
        worst = PulledApart{b.handle, a.handle, t, apart, in_pattern};
      }
    }
  }
  return worst;
}

std::string warning_text(const Sheet& sheet, const PulledApart& worst, const std::string& where) {
  std::ostringstream text;
  text << name_of(sheet, worst.first, where) << " and " << name_of(sheet, worst.second, where)
       << " pull the sheet apart: at t = " << worst.time << " s two of their points are "
       << worst.apart << " m apart in space and " << worst.in_pattern
       << " m in the pattern, and paper does not stretch";
  return text.str();
}

}  // namespace geoprior::paper
