#pragma once

#include <filesystem>
#include <vector>

#include "models/details/scene.h"

namespace geoprior::details {

/// Details at the positions of a file: each at the nearest point of the surface.
///
/// - .csv: a first line that names the columns, separated by commas: x, y, z (m) and, if need be,
///   weight (0 … 1) and type (whole, not negative), in any order; others are not read. `#` begins a
///   comment.
/// - a mesh file (.obj, .ply, .off, .vtp): its vertices, of weight 1.
///
/// @param max_distance  of a position from the surface (m)
/// @throws Error  naming file and line (or vertex): an unreadable file, a column that is missing or
///                is there twice, a word that is no number, a weight outside 0 … 1, a position off
///                the surface, two details in one place
std::vector<Detail> details_of_file(const std::filesystem::path& file, const TriMesh& surface,
                                    double max_distance);

}  // namespace geoprior::details
