#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "models/paper/sheet/pattern.h"
#include "models/paper/sheet/sheet.h"

namespace geoprior::paper {

/// The pattern with corners about `edge` apart (m) where those of a curved line were nearer: a
/// drawn circle has as many corners as its program gave it, and a mesh must not depend on them.
///
/// Where the outline turns by more than 20 degrees at a corner, at sides as long as `edge`, and at
/// `kept` points of the outline, it stays what it is; between them a line of shorter sides gets new
/// corners at equal distances, more where it turns sharply, each moved outwards or inwards so that
/// the area stays (by a quarter of an edge at most). A loop that has no such line is returned as it
/// was, bit for bit. Cuts stay. Where the new outline would touch itself, or is not accepted,
/// distances are halved until it does not, and is.
///
/// @param pattern  simple
/// @param kept     ends of cuts, anchors of handles; those off the outline are ignored
/// @param accepts  what else must hold of the new pattern
Pattern resampled(
    const Pattern& pattern, double edge, const std::vector<Eigen::Vector2d>& kept,
    const std::function<bool(const Pattern&)>& accepts = [](const Pattern&) { return true; });

/// The sheet with its outline resampled for a mesh of this edge length; a sheet that was valid
/// stays so, with all that its handles hold.
Sheet with_outline(Sheet sheet, double edge);

}  // namespace geoprior::paper
