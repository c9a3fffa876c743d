#include "testbed/formats/vtk/files.h"

#include <vtkCallbackCommand.h>
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
#include <vtkTriangleFilter.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/isolated_read.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/formats/vtk/checks.h"
#include "testbed/formats/vtk/part_bytes.h"
#include "testbed/formats/vtk/pieces.h"
#include "testbed/formats/vtk/points.h"
#include "testbed/formats/vtk/scan.h"
#include "testbed/formats/vtk/surface_cells.h"
#include "testbed/formats/vtk/value_names.h"

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
  add_value_names(part, *data.GetFieldData());
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
      check_index(part.triangles(t, corner), part, t);
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

/// Of zlib.
int level_of(Compression compression) {
  constexpr int kUsual = 5;  // VTK's own
  return compression == Compression::light ? 1 : kUsual;
}

template <class Writer, class Data>
std::string write_xml(Data& data, Compression compression) {
  vtkNew<Writer> writer;
  writer->SetInputData(&data);
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToZLib();
  writer->SetCompressionLevel(level_of(compression));
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

std::string part_to_vtk_xml(const Part& part, double parameter, Compression compression) {
  if (part.kind == Part::Kind::grid) {
    const auto image = to_image(part);
    add_arrays(part, *image);
    add_fields(part, parameter, *image);
    return write_xml<vtkXMLImageDataWriter>(*image, compression);
  }
  const auto data = to_poly_data(part);
  add_arrays(part, *data);
  add_fields(part, parameter, *data);
  return write_xml<vtkXMLPolyDataWriter>(*data, compression);
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
  out.reserve(cells.GetNumberOfCells());
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
  if (data.GetNumberOfPolys() + data.GetNumberOfStrips() > 0) return Part::Kind::triangles;
  const bool lines = data.GetNumberOfLines() > 0;
  if (lines && data.GetNumberOfVerts() > 0) {
    throw Error("mixes lines and vertex cells", where, "lines or vertices alone");
  }
  return lines ? Part::Kind::lines : Part::Kind::points;
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

Part from_poly_data(vtkPolyData& input, const std::string& where, std::vector<std::string>& notes) {
  check_cells(input, where);
  check_arrays(input, where);
  Part part;
  part.kind = kind_of(input, where);
  const auto data = part.kind == Part::Kind::triangles
                        ? only_triangles(*surface_cells(input, notes))
                        : vtkSmartPointer<vtkPolyData>(&input);
  part.points.resize(data->GetNumberOfPoints(), 3);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    part.points.row(i) = Eigen::Map<const Eigen::RowVector3d>(data->GetPoint(i));
  }
  if (part.kind == Part::Kind::triangles) {
    const auto triangles = cell_lists(*data->GetPolys());
    part.triangles.resize(triangles.size(), 3);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      part.triangles.row(t) = Eigen::Map<const Eigen::RowVector3i>(triangles[t].data());
    }
  }
  if (part.kind == Part::Kind::lines) part.lines = cell_lists(*data->GetLines());
  read_arrays(*data->GetPointData(), NamedArray::On::points, part);
  read_arrays(*data->GetCellData(), NamedArray::On::cells, part);
  read_value_names(*input.GetFieldData(), part, where);
  return part;
}

Part from_image(vtkImageData& data, const std::string& where) {
  check_arrays(data, where);
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
  read_value_names(*data.GetFieldData(), part, where);
  return part;
}

void keep_message(vtkObject*, unsigned long, void* client, void* text) {
  auto& message = *static_cast<std::string*>(client);
  if (message.empty() && text != nullptr) message = static_cast<const char*>(text);
}

/// The last line of VTK's message without the class and address that it begins with.
std::string last_line(std::string message) {
  while (!message.empty() && (message.back() == '\n' || message.back() == ' ')) message.pop_back();
  message.erase(0, message.rfind('\n') + 1);
  const std::size_t address = message.find(" (0x"), end = message.find("): ", address);
  return end == std::string::npos || address == std::string::npos ? message
                                                                  : message.substr(end + 3);
}

template <class Reader>
void update(Reader& reader, const std::string& bytes, const std::string& where) {
  std::string message;
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(keep_message);
  observer->SetClientData(&message);
  reader.SetReaderErrorObserver(observer);
  reader.SetParserErrorObserver(observer);
  reader.AddObserver(vtkCommand::ErrorEvent, observer);
  reader.ReadFromInputStringOn();
  reader.SetInputString(bytes);
  reader.Update();
  if (!message.empty() || reader.GetOutput() == nullptr) {
    throw Error("is no readable VTK file: " + last_line(message), where);
  }
}

std::optional<double> time_value(vtkDataSet& data) {
  vtkDataArray* time = data.GetFieldData()->GetArray("TimeValue");
  if (time == nullptr || time->GetNumberOfTuples() < 1) return std::nullopt;
  return time->GetComponent(0, 0);
}

ChildLimits limits_of(std::size_t bytes) {
  constexpr double kBytesASecond = 4e6;
  ChildLimits limits;
  limits.memory = (std::size_t{1} << 30) + 64 * bytes;
  limits.seconds = 60 + static_cast<double>(bytes) / kBytesASecond;
  return limits;
}

/// What a child makes of a request: bytes, extension and name of a file.
State parsed_reply(const State& request) {
  StateReader in(request);
  const std::string bytes = in.text(), extension = in.text(), where = in.text();
  const VtkFile file = parse_vtk_file(bytes, extension, where);
  StateWriter out;
  out.number(file.notes.size());
  for (const std::string& note : file.notes) out.text(note);
  out.bytes(part_to_bytes(file.part, file.parameter));
  return out.take();
}

void require_finite(const Part& part, std::optional<double> parameter, const std::string& where) {
  if (parameter && !std::isfinite(*parameter)) throw Error("its TimeValue is not finite", where);
  for (Eigen::Index i = 0; i < part.points.rows(); ++i) {
    if (part.points.row(i).allFinite()) continue;
    throw Error("point " + std::to_string(i) + " is not finite", where);
  }
}

void require_file(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) throw Error("is no file", file.string());
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
  require_file(file);
  return parse_vtk_part(read_whole_file(file), file.extension().string(), file.string(), parameter);
}

Part read_foreign_vtk_part(const std::filesystem::path& file, std::optional<double>& parameter) {
  require_file(file);
  return parse_foreign_vtk_part(read_whole_file(file), file.extension().string(), file.string(),
                                parameter);
}

Part parse_foreign_vtk_part(const std::string& bytes, const std::string& extension,
                            const std::string& where, std::optional<double>& parameter) {
  VtkFile file = parse_foreign_vtk_file(bytes, extension, where);
  parameter = file.parameter;
  return std::move(file.part);
}

VtkFile parse_foreign_vtk_file(const std::string& bytes, const std::string& extension,
                               const std::string& where) {
  StateWriter request;
  request.text(bytes);
  request.text(extension);
  request.text(where);
  thread_local ParsingChild child(parsed_reply);
  const State reply = child.parse(where, limits_of(bytes.size()), request.take());
  StateReader in(reply);
  VtkFile file;
  file.notes.resize(in.count(sizeof(std::size_t)));
  for (std::string& note : file.notes) note = in.text();
  const State part = in.bytes();
  in.require_end();
  file.part = part_from_bytes(part, file.parameter, where);
  require_finite(file.part, file.parameter, where);
  return file;
}

Part parse_vtk_part(const std::string& bytes, const std::string& extension,
                    const std::string& where, std::optional<double>& parameter) {
  VtkFile file = parse_vtk_file(bytes, extension, where);
  parameter = file.parameter;
  return std::move(file.part);
}

VtkFile parse_vtk_file(const std::string& bytes, const std::string& extension,
                       const std::string& where) {
  if (extension != ".vti" && extension != ".vtp") {
    throw Error("has the extension '" + extension + "'", where, ".vtp, .vti");
  }
  const std::string_view plain = without_byte_order_mark(bytes, where);
  if (plain.size() < bytes.size()) return parse_vtk_file(std::string(plain), extension, where);
  check_vtk_xml(bytes, where);
  VtkFile file;
  if (extension == ".vti") {
    vtkNew<vtkXMLImageDataReader> reader;
    update(*reader.Get(), bytes, where);
    file.parameter = time_value(*reader->GetOutput());
    file.part = from_image(*reader->GetOutput(), where);
    return file;
  }
  if (const std::vector<std::string> parted = parted_by_ghosts(bytes); !parted.empty()) {
    std::vector<VtkFile> pieces;
    for (const std::string& piece : parted)
      pieces.push_back(parse_vtk_file(piece, extension, where));
    return joined_pieces(std::move(pieces));
  }
  vtkNew<vtkXMLPolyDataReader> reader;
  update(*reader.Get(), bytes, where);
  file.parameter = time_value(*reader->GetOutput());
  file.part = from_poly_data(*reader->GetOutput(), where, file.notes);
  return file;
}

}  // namespace geoprior
