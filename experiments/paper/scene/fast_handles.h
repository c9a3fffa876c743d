#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "models/paper/sheet/sheet.h"

namespace geoprior::paper {

/// A handle at the moment when it is fastest.
struct FastHandle {
  std::size_t handle = 0;  ///< index
  double speed = 0;        ///< greatest of its anchors' (m/s)
  double time = 0;         ///< s
};

/// Widths of the pattern that a handle may move in a second before it is too fast to be followed
/// quietly.
///
/// A sheet of office paper of 0.21 m that is held at one edge swings once in 1.1 s (the first mode
/// of a plate strip, 3.52 / (2 pi L^2) sqrt(D / rho_s)): a handle that crosses the sheet in less
/// than a second moves faster than the sheet can bend out of its way. What is seen then is decided
/// by inertia, and the hybrid's structure is that of a sheet near rest, made anew once a frame.
inline constexpr double kWidthsPerSecond = 1;

/// The greatest speed of every handle that moves, while it is active, in the order of the handles:
/// mean speeds between neighbouring `motion_times` (handle_motion.h), a thousandth below the peak.
std::vector<FastHandle> greatest_speeds(const Sheet& sheet);

/// What a reader of the scene's file should know of handles that are faster than `kWidthsPerSecond`
/// widths a second: the fastest by its name, with speed, time and limit, then the others. Empty
/// when there is none. @param where  "scene"
std::optional<std::string> fast_handle_warning(const Sheet& sheet, const std::string& where);

}  // namespace geoprior::paper
