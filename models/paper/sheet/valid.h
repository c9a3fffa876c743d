#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "models/paper/sheet/sheet.h"

namespace geoprior::paper {

/// Throws Error naming what is wrong and where ("scene.handles.1.keys.2.t" for `where` = "scene"):
/// a pattern that is not simple, a material out of range, a handle outside the pattern, two handles
/// that move one point differently at one time, key times that do not increase, an obstacle that
/// contains the sheet's start, a value that is not finite.
void require_valid(const Sheet& sheet, const std::string& where);

/// The same of a material alone.
void require_valid(const PaperMaterial& material, const std::string& where);

/// A pattern point whose place on the flat start, without imperfection, has a signed distance below
/// `distance` (m; negative is inside) to the obstacle at t = 0; absent when there is none, but for
/// spots narrower than a 512th of the pattern.
std::optional<Eigen::Vector2d> start_nearer_than(const Sheet& sheet, const Obstacle& obstacle,
                                                 double distance);

}  // namespace geoprior::paper
