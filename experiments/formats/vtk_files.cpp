#include "experiments/formats/vtk_files.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>

#include <set>

#include "core/error.h"
#include "experiments/formats/vtk_points.h"

namespace geoprior {

namespace {

vtkSmartPointer<vtkDoubleArray> to_vtk(const NamedArray& array) {
  auto out = vtkSmartPointer<vtkDoubleArray>::New();
  const Eigen::MatrixXd& values = array.values;
  out->SetName(array.name.c_str());
  out->SetNumberOfComponents(static_cast<int>(values.cols()));
  out->SetNumberOfTuples(values.rows());
  double* to = out->GetPointer(0);
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    for (Eigen::Index column = 0; column < values.cols(); ++column) *to++ = values(row, column);
  }
  if (!array.unit.empty()) {
    out->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), array.unit.c_str());
  }
  return out;
}

void add_arrays(const Part& part, vtkDataSet& data) {
  std::set<std::string> seen;
  for (const NamedArray& array : part.arrays) {
    const bool on_points = array.on == NamedArray::On::points;
    const std::string where = "array '" + array.name + "'";
    const vtkIdType expected = on_points ? data.GetNumberOfPoints() : data.GetNumberOfCells();
    if (array.name.empty()) throw Error("an array of a part has no name");
    if (!seen.insert((on_points ? "p" : "c") + array.name).second) {
      throw Error("appears twice in a part", where);
    }
    if (array.values.cols() < 1) throw Error("has no components", where);
    if (array.values.rows() != expected) {
      throw Error("has " + std::to_string(array.values.rows()) + " rows", where,
                  std::to_string(expected) + ", one a " + (on_points ? "point" : "cell"));
    }
    (on_points ? static_cast<vtkDataSetAttributes*>(data.GetPointData())
               : static_cast<vtkDataSetAttributes*>(data.GetCellData()))
        ->AddArray(to_vtk(array));
  }
}

void add_fields(const Part& part, double parameter, vtkDataSet& data) {
  vtkNew<vtkDoubleArray> time;
  time->SetName("TimeValue");
  time->InsertNextValue(parameter);
  data.GetFieldData()->AddArray(time);
  vtkNew<vtkIntArray> kind;
  kind->SetName("PartKind");
  kind->InsertNextValue(static_cast<int>(part.kind));
  data.GetFieldData()->AddArray(kind);
}

void check_index(Eigen::Index index, const Part& part, std::size_t cell) {
  if (index < 0 || index >= part.points.rows()) {
    throw Error("refers to point " + std::to_string(index), "cell " + std::to_string(cell),
                "0 to " + std::to_string(part.points.rows() - 1));
  }
}

vtkSmartPointer<vtkCellArray> triangle_cells(const Part& part) {
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->AllocateExact(part.triangles.rows(), 3 * part.triangles.rows());
  for (Eigen::Index t = 0; t < part.triangles.rows(); ++t) {
    cells->InsertNextCell(3);
    for (int corner = 0; corner < 3; ++corner) {
      check_index(part.triangles(t, corner), part, static_cast<std::size_t>(t));
      cells->InsertCellPoint(part.triangles(t, corner));
    }
  }
  return cells;
}

vtkSmartPointer<vtkCellArray> line_cells(const Part& part) {
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  for (std::size_t l = 0; l < part.lines.size(); ++l) {
    if (part.lines[l].size() < 2) {
      throw Error("has " + std::to_string(part.lines[l].size()) + " points",
                  "poly-line " + std::to_string(l), "2 or more");  // VTK crashes on shorter ones
    }
    cells->InsertNextCell(static_cast<int>(part.lines[l].size()));
    for (const int index : part.lines[l]) {
      check_index(index, part, l);
      cells->InsertCellPoint(index);
    }
  }
  return cells;
}

vtkSmartPointer<vtkPolyData> to_poly_data(const Part& part) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(to_vtk_points(part.points));
  if (part.kind == Part::Kind::triangles) data->SetPolys(triangle_cells(part));
  if (part.kind == Part::Kind::lines) data->SetLines(line_cells(part));
  if (part.kind == Part::Kind::points) {
    vtkNew<vtkCellArray> vertices;
    for (vtkIdType i = 0; i < part.points.rows(); ++i) vertices->InsertNextCell(1, &i);
    data->SetVerts(vertices);
  }
  return data;
}

vtkSmartPointer<vtkImageData> to_image(const Part& part) {
  auto data = vtkSmartPointer<vtkImageData>::New();
  for (const int n : part.grid_size) {
    if (n < 1)
      throw Error("a grid has " + std::to_string(n) + " points along an axis", "", "1 or more");
  }
  data->SetDimensions(part.grid_size.data());
  data->SetOrigin(part.grid_origin.data());
  data->SetSpacing(part.grid_spacing.data());
  return data;
}

template <class Writer, class Data>
std::string write_xml(Data& data) {
  vtkNew<Writer> writer;
  writer->SetInputData(&data);
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToZLib();
  writer->SetByteOrderToLittleEndian();
  writer->SetHeaderTypeToUInt32();
  writer->WriteToOutputStringOn();
  if (writer->Write() == 0) throw Error("the VTK library could not encode a part");
  return writer->GetOutputString();
}

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace

std::string part_extension(const Part& part) {
  return part.kind == Part::Kind::grid ? ".vti" : ".vtp";
}

std::string part_to_vtk_xml(const Part& part, double parameter) {
  if (part.kind == Part::Kind::grid) {
    const auto image = to_image(part);
    add_arrays(part, *image);
    add_fields(part, parameter, *image);
    return write_xml<vtkXMLImageDataWriter>(*image);
  }
  const auto data = to_poly_data(part);
  add_arrays(part, *data);
  add_fields(part, parameter, *data);
  return write_xml<vtkXMLPolyDataWriter>(*data);
}

std::string pvd_text(const std::vector<PvdEntry>& entries) {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (const PvdEntry& entry : entries) {
    char number[40];
    std::snprintf(number, sizeof number, "%.17g", entry.parameter);
    text += std::string("    <DataSet timestep=\"") + number + "\" part=\"0\" name=\"" +
            xml_escaped(entry.part) + "\" file=\"" + xml_escaped(entry.file) + "\"/>\n";
  }
  return text + "  </Collection>\n</VTKFile>\n";
}

}  // namespace geoprior
