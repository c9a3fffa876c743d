#include "experiments/paper/scene/handle_motion.h"

#include <algorithm>

namespace geoprior::paper {

std::vector<double> motion_times(const Sheet& sheet) {
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

std::string handle_name(const Sheet& sheet, std::size_t i, const std::string& where) {
  const std::string& name = sheet.handles[i].name;
  return where + ".handles." + std::to_string(i) + (name.empty() ? "" : " '" + name + "'");
}

}  // namespace geoprior::paper
