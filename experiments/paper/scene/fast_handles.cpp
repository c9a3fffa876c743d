#include "experiments/paper/scene/fast_handles.h"

#include <algorithm>
#include <iomanip>
#include <map>
#include <sstream>

#include "experiments/paper/scene/handle_motion.h"
#include "models/paper/sheet/handle_speed.h"

namespace geoprior::paper {

std::vector<FastHandle> greatest_speeds(const Sheet& sheet) {
  const std::vector<double> times = motion_times(sheet);
  std::map<std::size_t, FastHandle> fastest;
  for (const MovingAnchor& anchor : moving_anchors(sheet)) {
    const Handle& handle = sheet.handles[anchor.handle];
    FastHandle& known = fastest[anchor.handle];
    known.handle = anchor.handle;
    Eigen::Vector3d before = handle.target(anchor.rest, anchor.centre, times.front());
    for (std::size_t i = 1; i < times.size(); ++i) {
      const Eigen::Vector3d place = handle.target(anchor.rest, anchor.centre, times[i]);
      const double middle = (times[i - 1] + times[i]) / 2;
      const double speed = (place - before).norm() / (times[i] - times[i - 1]);
      before = place;
      if (!handle.is_active(middle) || speed <= known.speed) continue;
      known.speed = speed;
      known.time = middle;
    }
  }
  std::vector<FastHandle> speeds;
  for (const auto& [index, handle] : fastest) speeds.push_back(handle);
  return speeds;
}

std::optional<std::string> fast_handle_warning(const Sheet& sheet, const std::string& where) {
  const double limit = kWidthsPerSecond * width(sheet.pattern);
  std::vector<FastHandle> fast = greatest_speeds(sheet);
  std::erase_if(fast, [&](const FastHandle& handle) { return handle.speed <= limit; });
  if (fast.empty()) return std::nullopt;
  std::stable_sort(fast.begin(), fast.end(),
                   [](const FastHandle& a, const FastHandle& b) { return a.speed > b.speed; });
  std::ostringstream text;
  text << std::setprecision(3) << handle_name(sheet, fast.front().handle, where) << " moves at "
       << fast.front().speed << " m/s at t = " << fast.front().time << " s: beyond " << limit
       << " m/s, the sheet's width in a second, inertia decides what is seen, and the hybrid's "
       << "structure is that of a sheet near rest";
  for (std::size_t i = 1; i < fast.size(); ++i) {
    text << (i == 1 ? "; too fast as well: " : ", ") << handle_name(sheet, fast[i].handle, where)
         << " (" << fast[i].speed << " m/s at " << fast[i].time << " s)";
  }
  return text.str();
}

}  // namespace geoprior::paper
