#pragma once

#include <Eigen/Core>
#include <span>

#include "models/sketch/flatten/flat_triangles.h"

namespace geoprior::sketch {

/// Lays a surface of genus 0 with at least one border into a round disc without turning a triangle
/// over: the outer border on a circle by its lengths, every other vertex at a mean of its
/// neighbours with mean-value weights, each hole closed by a vertex of its own.
///
/// Positive weights on a triangulated disc with a convex border turn none over (Tutte 1963, Floater
/// 1997); in floating point thin protrusions may lose their area, so ask `flipped_triangles`. The
/// disc has the area of the surface.
///
/// @param border  the outer one: its vertices counter-clockwise
/// Source: Floater, Mean value coordinates, 2003.
Eigen::VectorXcd convex_layout(const TriMesh& mesh, std::span<const FlatTriangle> triangles,
                               std::span<const int> border);

}  // namespace geoprior::sketch
