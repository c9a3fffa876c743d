#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/details/scene.h"

namespace geoprior::details {

/// Details at the positions of a file: each at the nearest point of the surface.
///
/// - .csv (`CsvTable`): a first line that names the columns: x, y, z (m) and, if need be, weight
///   (0 … 1) and type (whole, not negative), in any order; others are not read. An empty weight or
///   type is that of a file without the column.
/// - a mesh file (`read_mesh_file`): its vertices, of weight 1.
///
/// @param max_distance  of a position from the surface (m)
/// @param warnings      added: what of the file is left out
/// @throws Error  naming file and line (or vertex): an unreadable file, a column that is missing or
///                is there twice, a word that is no number, a weight outside 0 … 1, a position off
///                the surface, two details in one place
std::vector<Detail> details_of_file(const std::filesystem::path& file, const TriMesh& surface,
                                    double max_distance, std::vector<std::string>& warnings);

}  // namespace geoprior::details
