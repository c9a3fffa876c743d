#pragma once

#include <string>
#include <vector>

#include "testbed/formats/vtk/vtk_file.h"

namespace geoprior {

/// VTK's reader takes the arrays of a file's first piece: ghost cells (`vtkGhostType`) that only
/// later pieces have would be taken for others. The text of such a .vtp is parted here into one of
/// a piece each; of any other file nothing is returned.
/// @param text  what `check_vtk_xml` has passed
std::vector<std::string> parted_by_ghosts(const std::string& text);

/// Surfaces of pieces as one: points and triangles one after the other, arrays that all of them
/// have, notes with the number of the piece.
VtkFile joined_pieces(std::vector<VtkFile> pieces);

}  // namespace geoprior
