#pragma once

#include <Eigen/Core>
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
/// the area stays. A loop that has no such line is returned as it was, bit for bit. Cuts stay.
/// Where the new outline would touch itself, distances are halved until it does not.
///
/// @param pattern  simple
/// @param kept     ends of cuts, anchors of handles; those off the outline are ignored
Pattern resampled(const Pattern& pattern, double edge, const std::vector<Eigen::Vector2d>& kept);

/// The sheet with its outline resampled for a mesh of this edge length. What its handles hold stays
/// in the pattern.
Sheet with_outline(Sheet sheet, double edge);

}  // namespace geoprior::paper
