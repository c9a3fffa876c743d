#pragma once

#include <string>
#include <vector>

#include "models/paper/sheet/sheet.h"

namespace geoprior::paper {

/// Times at which motions are looked at (s, increasing): those of keys, the ends of activity, start
/// and end of the scene, and `kTimesBetween` times between each two of them.
std::vector<double> motion_times(const Sheet& sheet);
inline constexpr int kTimesBetween = 31;

/// "scene.handles.1 'left'", for messages. @param where  "scene"
std::string handle_name(const Sheet& sheet, std::size_t i, const std::string& where);

}  // namespace geoprior::paper
