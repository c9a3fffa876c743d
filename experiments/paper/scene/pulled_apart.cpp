#include "experiments/paper/scene/pulled_apart.h"

#include <sstream>
#include <vector>

#include "core/geometry/planar.h"
#include "experiments/paper/scene/handle_motion.h"
#include "models/paper/sheet/handle_speed.h"

namespace geoprior::paper {
namespace {

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

}  // namespace

std::optional<PulledApart> worst_pulled_apart(const Sheet& sheet, double tolerance) {
  // Points of two handles that coincide are required to move as one (require_valid).
  constexpr double kSamePlace = 1e-9;
  if (!is_convex(sheet.pattern)) return std::nullopt;
  const std::vector<MovingAnchor> anchors = moving_anchors(sheet);
  std::optional<PulledApart> worst;
  double worst_ratio = 1 + tolerance;
  std::vector<Eigen::Vector3d> places(anchors.size());
  for (const double t : motion_times(sheet)) {
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      const MovingAnchor& a = anchors[i];
      places[i] = sheet.handles[a.handle].target(a.rest, a.centre, t);
      if (!sheet.handles[a.handle].is_active(t)) continue;
      for (std::size_t j = 0; j < i; ++j) {
        const MovingAnchor& b = anchors[j];
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
  text << handle_name(sheet, worst.first, where) << " and "
       << handle_name(sheet, worst.second, where) << " pull the sheet apart: at t = " << worst.time
       << " s two of their points are " << worst.apart << " m apart in space and "
       << worst.in_pattern << " m in the pattern, and paper does not stretch";
  return text.str();
}

}  // namespace geoprior::paper
