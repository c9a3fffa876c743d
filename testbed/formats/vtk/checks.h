#pragma once

#include <string>

class vtkDataSet;
class vtkPolyData;

namespace geoprior {

/// VTK's readers take offsets and connectivity as they are, and its filters follow them without a
/// look: these are the looks.
///
/// @throws Error  naming file and cell: offsets that do not start at zero, fall or leave the
///                connectivity; polygons and strips of fewer than 3 points, lines of fewer than 2,
///                empty vertices; an index that is no point; more points than an index of 32 bits
///                names
void check_cells(vtkPolyData& data, const std::string& where);

/// @throws Error  naming file and array: not one row a point, or a cell
void check_arrays(vtkDataSet& data, const std::string& where);

}  // namespace geoprior
