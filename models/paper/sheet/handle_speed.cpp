#include "models/paper/sheet/handle_speed.h"

#include <algorithm>
#include <cmath>

namespace geoprior::paper {
namespace {

/// A handle that leaps across the room in a frame is a mistake, not a reason to run for a year.
constexpr int kMostSubsteps = 1000;

}  // namespace

std::vector<MovingAnchor> moving_anchors(const Sheet& sheet) {
  std::vector<MovingAnchor> anchors;
  for (std::size_t i = 0; i < sheet.handles.size(); ++i) {
    if (!sheet.handles[i].motion) continue;
    const std::size_t first = anchors.size();
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const Eigen::Vector2d& p : sheet.handles[i].anchors()) {
      const Eigen::Vector3d rest = sheet.placement * Eigen::Vector3d(p.x(), p.y(), 0);
      anchors.push_back({i, p, rest, rest});
      centre += rest;
    }
    centre /= static_cast<double>(anchors.size() - first);
    for (std::size_t k = first; k < anchors.size(); ++k) anchors[k].centre = centre;
  }
  return anchors;
}

double handle_speed(const Sheet& sheet, double start, double end, int parts) {
  const double dt = (end - start) / parts;
  double longest = 0;
  for (const MovingAnchor& anchor : moving_anchors(sheet)) {
    const Handle& handle = sheet.handles[anchor.handle];
    for (int i = 0; i < parts; ++i) {
      const double from = start + i * dt, to = start + (i + 1) * dt;
      if (!handle.is_active(from) || !handle.is_active(to)) continue;
      const Eigen::Vector3d way = handle.target(anchor.rest, anchor.centre, to) -
                                  handle.target(anchor.rest, anchor.centre, from);
      longest = std::max(longest, way.norm());
    }
  }
  return longest / dt;
}

int substeps_of_frame(const Sheet& sheet, double start, double end) {
  const double way = handle_speed(sheet, start, end, sheet.substeps) * (end - start);
  // Round-off of a motion at exactly the bound takes no further step.
  const double wanted = std::ceil(way / sheet.handle_step - 1e-6);
  const int most = std::max(sheet.substeps, kMostSubsteps);
  return wanted >= most ? most : std::max(sheet.substeps, static_cast<int>(wanted));
}

}  // namespace geoprior::paper
