#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTriangleFilter.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>

#include "core/error.h"
#include "experiments/formats/vtk_files.h"

namespace geoprior {

namespace {

NamedArray from_vtk(vtkDataArray& array, NamedArray::On on, int index) {
  NamedArray out;
  out.on = on;
  out.name = array.GetName() != nullptr ? array.GetName() : "array" + std::to_string(index);
  if (array.HasInformation() && array.GetInformation()->Has(vtkDataArray::UNITS_LABEL()) != 0) {
    out.unit = array.GetInformation()->Get(vtkDataArray::UNITS_LABEL());
  }
  out.values.resize(array.GetNumberOfTuples(), array.GetNumberOfComponents());
  for (Eigen::Index row = 0; row < out.values.rows(); ++row) {
    for (Eigen::Index column = 0; column < out.values.cols(); ++column) {
      out.values(row, column) = array.GetComponent(row, static_cast<int>(column));
    }
  }
  return out;
}

void read_arrays(vtkDataSetAttributes& attributes, NamedArray::On on, Part& part) {
  for (int i = 0; i < attributes.GetNumberOfArrays(); ++i) {
    if (vtkDataArray* array = attributes.GetArray(i))
      part.arrays.push_back(from_vtk(*array, on, i));
  }
}

std::vector<std::vector<int>> cell_lists(vtkCellArray& cells) {
  std::vector<std::vector<int>> out;
  out.reserve(static_cast<std::size_t>(cells.GetNumberOfCells()));
  for (vtkIdType c = 0; c < cells.GetNumberOfCells(); ++c) {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    cells.GetCellAtId(c, size, ids);
    std::vector<int>& list = out.emplace_back();
    std::transform(ids, ids + size, std::back_inserter(list),
                   [](vtkIdType id) { return static_cast<int>(id); });
  }
  return out;
}

/// The field PartKind where the file has it, else what cells there are.
Part::Kind kind_of(vtkPolyData& data, const std::string& where) {
  if (vtkDataArray* kind = data.GetFieldData()->GetArray("PartKind");
      kind != nullptr && kind->GetNumberOfTuples() == 1) {
    const double value = kind->GetComponent(0, 0);
    if (value == 0) return Part::Kind::triangles;
    if (value == 1) return Part::Kind::lines;
    if (value == 2) return Part::Kind::points;
    throw Error("PartKind is " + std::to_string(value), where, "0, 1, 2");
  }
  const bool faces = data.GetNumberOfPolys() + data.GetNumberOfStrips() > 0;
  const bool lines = data.GetNumberOfLines() > 0;
  if (static_cast<int>(faces) + static_cast<int>(lines) +
          static_cast<int>(data.GetNumberOfVerts() > 0) >
      1) {
    throw Error("mixes cells of several kinds", where, "polygons, lines or vertices alone");
  }
  if (faces) return Part::Kind::triangles;
  return lines ? Part::Kind::lines : Part::Kind::points;
}

void check_cells(vtkCellArray& cells, vtkIdType points, const std::string& where) {
  for (vtkIdType c = 0; c < cells.GetNumberOfCells(); ++c) {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    cells.GetCellAtId(c, size, ids);
    for (vtkIdType k = 0; k < size; ++k) {
      if (ids[k] < 0 || ids[k] >= points) {
        throw Error("cell " + std::to_string(c) + " refers to point " + std::to_string(ids[k]),
                    where, "0 to " + std::to_string(points - 1));
      }
    }
  }
}

vtkSmartPointer<vtkPolyData> only_triangles(vtkPolyData& data) {
  vtkCellArray& polys = *data.GetPolys();
  if (data.GetNumberOfStrips() == 0 &&
      (polys.GetNumberOfCells() == 0 || polys.IsHomogeneous() == 3)) {
    return &data;
  }
  vtkNew<vtkTriangleFilter> filter;
  filter->SetInputData(&data);
  filter->PassLinesOff();
  filter->PassVertsOff();
  filter->Update();
  return filter->GetOutput();
}

Part from_poly_data(vtkPolyData& input, const std::string& where) {
  for (vtkCellArray* cells : {input.GetPolys(), input.GetLines(), input.GetVerts()}) {
    check_cells(*cells, input.GetNumberOfPoints(), where);
  }
  Part part;
  part.kind = kind_of(input, where);
  const auto data = part.kind == Part::Kind::triangles ? only_triangles(input)
                                                       : vtkSmartPointer<vtkPolyData>(&input);
  part.points.resize(data->GetNumberOfPoints(), 3);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    part.points.row(i) = Eigen::Map<const Eigen::RowVector3d>(data->GetPoint(i));
  }
  if (part.kind == Part::Kind::triangles) {
    const auto triangles = cell_lists(*data->GetPolys());
    part.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      part.triangles.row(static_cast<Eigen::Index>(t)) =
          Eigen::Map<const Eigen::RowVector3i>(triangles[t].data());
    }
  }
  if (part.kind == Part::Kind::lines) part.lines = cell_lists(*data->GetLines());
  read_arrays(*data->GetPointData(), NamedArray::On::points, part);
  read_arrays(*data->GetCellData(), NamedArray::On::cells, part);
  return part;
}

Part from_image(vtkImageData& data) {
  Part part;
  part.kind = Part::Kind::grid;
  data.GetDimensions(part.grid_size.data());
  // The first point of the extent, should a file not start it at zero.
  int extent[6];
  data.GetExtent(extent);
  for (int axis = 0; axis < 3; ++axis) {
    part.grid_spacing[axis] = data.GetSpacing()[axis];
    part.grid_origin[axis] = data.GetOrigin()[axis] + extent[2 * axis] * data.GetSpacing()[axis];
  }
  read_arrays(*data.GetPointData(), NamedArray::On::points, part);
  read_arrays(*data.GetCellData(), NamedArray::On::cells, part);
  return part;
}

void keep_message(vtkObject*, unsigned long, void* client, void* text) {
  auto& message = *static_cast<std::string*>(client);
  if (message.empty() && text != nullptr) message = static_cast<const char*>(text);
}

/// VTK's message without its "ERROR: In file, line" and with one line only.
std::string last_line(std::string message) {
  while (!message.empty() && (message.back() == '\n' || message.back() == ' ')) message.pop_back();
  const std::size_t begin = message.rfind('\n');
  return begin == std::string::npos ? message : message.substr(begin + 1);
}

template <class Reader>
void update(Reader& reader, const std::filesystem::path& file) {
  std::string message;
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(keep_message);
  observer->SetClientData(&message);
  reader.SetReaderErrorObserver(observer);
  reader.SetParserErrorObserver(observer);
  reader.AddObserver(vtkCommand::ErrorEvent, observer);
  reader.SetFileName(file.c_str());
  reader.Update();
  if (!message.empty() || reader.GetOutput() == nullptr) {
    throw Error("is no readable VTK file: " + last_line(message), file.string());
  }
}

std::optional<double> time_value(vtkDataSet& data) {
  vtkDataArray* time = data.GetFieldData()->GetArray("TimeValue");
  if (time == nullptr || time->GetNumberOfTuples() < 1) return std::nullopt;
  return time->GetComponent(0, 0);
}

}  // namespace

Part read_vtk_part(const std::filesystem::path& file, double* parameter) {
  std::optional<double> time;
  Part part = read_vtk_part(file, time);
  if (parameter != nullptr) {
    if (!time) throw Error("has no field array TimeValue", file.string());
    *parameter = *time;
  }
  return part;
}

Part read_vtk_part(const std::filesystem::path& file, std::optional<double>& parameter) {
  const std::string where = file.string();
  const std::string extension = file.extension().string();
  if (!std::filesystem::is_regular_file(file)) throw Error("is no file", where);
  if (extension == ".vti") {
    vtkNew<vtkXMLImageDataReader> reader;
    update(*reader.Get(), file);
    parameter = time_value(*reader->GetOutput());
    return from_image(*reader->GetOutput());
  }
  if (extension == ".vtp") {
    vtkNew<vtkXMLPolyDataReader> reader;
    update(*reader.Get(), file);
    parameter = time_value(*reader->GetOutput());
    return from_poly_data(*reader->GetOutput(), where);
  }
  throw Error("has the extension '" + extension + "'", where, ".vtp, .vti");
}

}  // namespace geoprior
