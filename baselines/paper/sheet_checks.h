#pragma once

#include <string>

#include "baselines/paper/sheet.h"

// The parts of require_valid, one a file.

namespace geoprior::sheet_checks {

/// "where.key", or the key alone.
std::string inside(const std::string& where, const std::string& key);

void require_finite(double x, const std::string& where);
/// Finite, and low <= x <= high; `open` excludes `low`.
void require_range(double x, double low, double high, bool open, const std::string& where);

void require_material(const PaperMaterial& material, const std::string& where);
/// Finite keys with times that increase.
void require_trajectory(const Trajectory& trajectory, const std::string& where);
/// Shapes inside the pattern, one kind of drive each, no point that two of them move differently.
void require_handles(const Sheet& sheet, const std::string& where);
/// Shapes that exist, and a start of the sheet outside all of them.
void require_obstacles(const Sheet& sheet, const std::string& where);

}  // namespace geoprior::sheet_checks
