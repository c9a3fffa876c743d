#pragma once

#include <optional>
#include <string>

#include "models/paper/sheet/sheet.h"

namespace geoprior::paper {

/// Two points that moving handles hold farther apart in space than the pattern has them.
struct PulledApart {
  std::size_t first = 0, second = 0;  ///< indices of the handles
  double time = 0;                    ///< s
  double apart = 0;                   ///< in space (m)
  double in_pattern = 0;              ///< m
};

/// The worst stretch that the handles ask for: paper has none. Anchors of handles that move and are
/// active together are compared at `motion_times` (handle_motion.h). Empty when no ratio exceeds 1
/// + `tolerance`, and on a pattern that is not convex, where a straight line in space may be
/// shorter than any path in the sheet, so that distances in the plane bound nothing.
std::optional<PulledApart> worst_pulled_apart(const Sheet& sheet, double tolerance);

/// What a reader of the scene's file should know.
std::string warning_text(const Sheet& sheet, const PulledApart& worst, const std::string& where);

}  // namespace geoprior::paper
