#pragma once

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkPolyData;

namespace geoprior {

/// The polygons and strips of polygonal data with their arrays; the points stay as they are. Left
/// out are vertex cells, lines, cells that `vtkGhostType` calls duplicates of another piece's,
/// refined or hidden, and cells at a point that it hides.
///
/// @param data   checked by `check_cells` and `check_arrays`; returned itself when all of it stays
/// @param notes  added: how many cells of each kind are left out
vtkSmartPointer<vtkPolyData> surface_cells(vtkPolyData& data, std::vector<std::string>& notes);

}  // namespace geoprior
