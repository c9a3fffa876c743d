#pragma once

#include <Eigen/Core>
#include <span>

#include "core/mesh.h"
#include "models/sketch/pattern/suggested_seam.h"
#include "models/sketch/surface/cut_surface.h"

namespace geoprior::sketch {

/// A line made fair: of x(s) with the ends of the line, the least
///
///   sum |x_i - p_i|^2 + w^4 sum |x_(i-1) - 2 x_i + x_(i+1)|^2,
///
/// p evenly spaced on the line at a quarter of `width`, w = 4: what is shorter than `width` is
/// smoothed. A closed line (its last row is its first) has no ends.
/// @param line  rows along it (m)
Eigen::MatrixX3d faired_line(const Eigen::MatrixX3d& line, double width);

/// The lines with their normals, which turn evenly between those that they had.
CutLines faired_lines(const CutLines& lines, double width);

/// Slides the vertices of seams along a surface towards fair lines on it in small steps; those near
/// to them move by the mean of what their neighbours move by. The surface keeps its shape to what
/// its triangles can follow: all vertices lie on it as it was; in the end those of seams leave it
/// for their fair lines, by a tenth of a mean edge at most. Ends of seams, borders and places where
/// seams meet stay, edges about them that are neither seams nor sharp are flipped as
/// triangles are stretched, and a step that would still turn one over is not made there: a seam
/// keeps a corner where that happens in every step. A seam that slides off a sharp edge of the
/// surface has triangles that cut the edge off.
///
/// @param seams  edges that may slide
/// @param kept   further edges whose vertices stay
/// @return       with the same vertices, as many triangles, and all edges of seams
TriMesh fair_seams(const TriMesh& surface, std::span<const SeamEdge> seams,
                   std::span<const SeamEdge> kept);

}  // namespace geoprior::sketch
