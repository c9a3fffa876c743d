#include "testbed/formats/vtk/checks.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <limits>

#include "core/error.h"

namespace geoprior {
namespace {

/// Cells of one kind.
struct CellList {
  vtkCellArray* cells;
  const char* name;
  vtkIdType fewest;  ///< points of a cell
};

/// Offsets and connectivity in either of their widths.
struct CheckCells {
  template <class State>
  void operator()(State& state, const CellList& list, vtkIdType points,
                  const std::string& where) const {
    const auto& offsets = *state.GetOffsets();
    const auto& connectivity = *state.GetConnectivity();
    const vtkIdType cells = offsets.GetNumberOfValues() - 1;
    if (cells < 0 || offsets.GetValue(0) != 0) {
      throw Error(std::string("the offsets of its ") + list.name + "s do not begin at 0", where);
    }
    for (vtkIdType c = 0; c < cells; ++c) {
      const vtkIdType begin = offsets.GetValue(c), end = offsets.GetValue(c + 1);
      const auto cell = [&] { return std::string(list.name) + " " + std::to_string(c); };
      if (end < begin || end > connectivity.GetNumberOfValues()) {
        throw Error(
            cell() + " has the offset " + std::to_string(end), where,
            std::to_string(begin) + " to " + std::to_string(connectivity.GetNumberOfValues()));
      }
      if (end - begin < list.fewest) {
        throw Error(cell() + " has " + std::to_string(end - begin) + " points", where,
                    std::to_string(list.fewest) + " or more");
      }
      for (vtkIdType k = begin; k < end; ++k) {
        const vtkIdType point = connectivity.GetValue(k);
        if (point >= 0 && point < points) continue;
        throw Error(cell() + " refers to point " + std::to_string(point), where,
                    "0 to " + std::to_string(points - 1));
      }
    }
  }
};

void check_rows(vtkDataSetAttributes& attributes, vtkIdType rows, const char* element,
                const std::string& where) {
  for (int i = 0; i < attributes.GetNumberOfArrays(); ++i) {
    vtkAbstractArray& array = *attributes.GetAbstractArray(i);
    if (array.GetNumberOfTuples() == rows) continue;
    const char* name = array.GetName();
    throw Error("array '" + std::string(name == nullptr ? "" : name) + "' has " +
                    std::to_string(array.GetNumberOfTuples()) + " rows",
                where, std::to_string(rows) + ", one a " + element);
  }
}

}  // namespace

void check_cells(vtkPolyData& data, const std::string& where) {
  const vtkIdType points = data.GetNumberOfPoints();
  if (points > std::numeric_limits<int>::max()) {
    throw Error("has " + std::to_string(points) + " points", where,
                "at most " + std::to_string(std::numeric_limits<int>::max()));
  }
  if (points > 0 && data.GetPoints()->GetData()->GetNumberOfComponents() != 3) {
    throw Error("has points of another dimension", where, "3 numbers a point");
  }
  for (const CellList& list :
       {CellList{data.GetVerts(), "vertex cell", 1}, CellList{data.GetLines(), "line", 2},
        CellList{data.GetPolys(), "polygon", 3}, CellList{data.GetStrips(), "strip", 3}}) {
    list.cells->Visit(CheckCells{}, list, points, where);
  }
}

void check_arrays(vtkDataSet& data, const std::string& where) {
  check_rows(*data.GetPointData(), data.GetNumberOfPoints(), "point", where);
  check_rows(*data.GetCellData(), data.GetNumberOfCells(), "cell", where);
}

}  // namespace geoprior
