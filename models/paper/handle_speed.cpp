#include "models/paper/handle_speed.h"

#include <algorithm>
#include <cmath>

namespace geoprior::paper {
namespace {

/// A handle that leaps across the room in a frame is a mistake, not a reason to run for a year.
constexpr int kMostSubsteps = 1000;

/// Longest way of an anchor from one time to the other (m).
double longest_move(const Handle& handle, const std::vector<Eigen::Vector3d>& rest,
                    const Eigen::Vector3d& centre, double from, double to) {
  double longest = 0;
  for (const Eigen::Vector3d& place : rest) {
    const Eigen::Vector3d move =
        handle.target(place, centre, to) - handle.target(place, centre, from);
    longest = std::max(longest, move.norm());
  }
  return longest;
}

}  // namespace

double handle_speed(const Sheet& sheet, double start, double end, int parts) {
  double fastest = 0;
  const double dt = (end - start) / parts;
  for (const Handle& handle : sheet.handles) {
    if (!handle.motion) continue;
    std::vector<Eigen::Vector3d> rest;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const Eigen::Vector2d& anchor : handle.anchors()) {
      // Without the seeded waves of the start: they are no part of the motion.
      rest.push_back(sheet.placement * Eigen::Vector3d(anchor.x(), anchor.y(), 0));
      centre += rest.back();
    }
    centre /= static_cast<double>(std::max<std::size_t>(1, rest.size()));
    for (int i = 0; i < parts; ++i) {
      const double from = start + i * dt, to = start + (i + 1) * dt;
      if (!handle.is_active(from) || !handle.is_active(to)) continue;
      fastest = std::max(fastest, longest_move(handle, rest, centre, from, to) / dt);
    }
  }
  return fastest;
}

int substeps_of_frame(const Sheet& sheet, double start, double end) {
  const double way = handle_speed(sheet, start, end, sheet.substeps) * (end - start);
  // Round-off of a motion at exactly the bound takes no further step.
  const double wanted = std::ceil(way / sheet.handle_step - 1e-6);
  const int most = std::max(sheet.substeps, kMostSubsteps);
  return wanted >= most ? most : std::max(sheet.substeps, static_cast<int>(wanted));
}

}  // namespace geoprior::paper
