#include "testbed/formats/vtk/surface_cells.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

namespace geoprior {
namespace {

/// Which cells and points of the data are ghosts.
class Ghosts {
 public:
  explicit Ghosts(vtkPolyData& data)
      : cells_(ghost_array(*data.GetCellData())), points_(ghost_array(*data.GetPointData())) {}

  [[nodiscard]] bool any() const { return cells_ != nullptr || points_ != nullptr; }
  [[nodiscard]] bool holds(vtkIdType cell, vtkIdType size, const vtkIdType* points) const {
    constexpr int kGone = vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::REFINEDCELL |
                          vtkDataSetAttributes::HIDDENCELL;
    if (cells_ != nullptr && (bits(*cells_, cell) & kGone) != 0) return true;
    for (vtkIdType k = 0; points_ != nullptr && k < size; ++k) {
      if ((bits(*points_, points[k]) & vtkDataSetAttributes::HIDDENPOINT) != 0) return true;
    }
    return false;
  }

 private:
  static vtkDataArray* ghost_array(vtkDataSetAttributes& attributes) {
    vtkDataArray* array = attributes.GetArray(vtkDataSetAttributes::GhostArrayName());
    return array != nullptr && array->GetNumberOfComponents() == 1 ? array : nullptr;
  }
  static int bits(vtkDataArray& array, vtkIdType row) {
    const double value = array.GetComponent(row, 0);
    return value >= 0 && value < 256 ? static_cast<int>(value) : 0;
  }

  vtkDataArray *cells_, *points_;
};

std::string counted(vtkIdType count, const char* one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace

vtkSmartPointer<vtkPolyData> surface_cells(vtkPolyData& data, std::vector<std::string>& notes) {
  const Ghosts ghosts(data);
  const vtkIdType vertices = data.GetNumberOfVerts(), lines = data.GetNumberOfLines();
  if (vertices + lines == 0 && !ghosts.any()) return &data;
  auto kept = vtkSmartPointer<vtkPolyData>::New();
  kept->SetPoints(data.GetPoints());
  kept->GetPointData()->ShallowCopy(data.GetPointData());
  kept->GetFieldData()->ShallowCopy(data.GetFieldData());
  kept->GetCellData()->CopyAllOn();
  kept->GetCellData()->CopyAllocate(data.GetCellData());
  vtkIdType cell = vertices + lines, to = 0, left_out = 0;
  const auto copy = [&](vtkCellArray& from) {
    vtkNew<vtkCellArray> cells;
    for (vtkIdType c = 0; c < from.GetNumberOfCells(); ++c, ++cell) {
      vtkIdType size = 0;
      const vtkIdType* points = nullptr;
      from.GetCellAtId(c, size, points);
      if (ghosts.holds(cell, size, points)) {
        ++left_out;
        continue;
      }
      cells->InsertNextCell(size, points);
      kept->GetCellData()->CopyData(data.GetCellData(), cell, to++);
    }
    return vtkSmartPointer<vtkCellArray>(cells);
  };
  kept->SetPolys(copy(*data.GetPolys()));
  kept->SetStrips(copy(*data.GetStrips()));
  if (vertices > 0) notes.push_back(counted(vertices, "vertex cell") + " left out");
  if (lines > 0) notes.push_back(counted(lines, "line") + " left out");
  if (left_out > 0) notes.push_back(counted(left_out, "ghost cell") + " left out (vtkGhostType)");
  return kept;
}

}  // namespace geoprior
