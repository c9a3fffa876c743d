#include "testbed/formats/vtk/part_bytes.h"

#include <limits>

#include "testbed/formats/vtk/value_names.h"

namespace geoprior {
namespace {

/// Least bytes of an array: two texts, where it is, rows, columns and how many names it has.
constexpr std::size_t kArrayBytes = 5 * sizeof(std::size_t) + 1;

void write_array(const NamedArray& array, StateWriter& out) {
  out.text(array.name);
  out.text(array.unit);
  out.number(array.on == NamedArray::On::points ? char{1} : char{0});
  out.matrix(array.values);
  out.number(array.names.size());
  for (const std::string& name : array.names) out.text(name);
}

NamedArray read_array(StateReader& in) {
  NamedArray array;
  array.name = in.text();
  array.unit = in.text();
  array.on = in.number<char>() != 0 ? NamedArray::On::points : NamedArray::On::cells;
  in.matrix(array.values);
  array.names.resize(in.count(sizeof(std::size_t)));
  for (std::string& name : array.names) name = in.text();
  return array;
}

Part::Kind kind_of_number(int number, const std::string& where) {
  if (number < 0 || number > static_cast<int>(Part::Kind::grid)) {
    throw Error("has parts of kind " + std::to_string(number), where, "0, 1, 2, 3");
  }
  return static_cast<Part::Kind>(number);
}

void require_point(int index, const Part& part, const std::string& where) {
  if (index >= 0 && index < part.points.rows()) return;
  throw Error("refers to point " + std::to_string(index), where,
              "0 to " + std::to_string(part.points.rows() - 1));
}

void require_points(const Part& part, const std::string& where) {
  for (Eigen::Index t = 0; t < part.triangles.rows(); ++t) {
    for (const int index : part.triangles.row(t)) require_point(index, part, where);
  }
  for (const std::vector<int>& line : part.lines) {
    for (const int index : line) require_point(index, part, where);
  }
}

void require_grid(const Part& part, const std::string& where) {
  double points = 1;
  for (const int n : part.grid_size) {
    if (n < 1) throw Error("has a grid of " + std::to_string(n) + " points along an axis", where);
    points *= n;
  }
  if (points > std::numeric_limits<int>::max()) {
    throw Error("has a grid of " + std::to_string(points) + " points", where,
                "at most " + std::to_string(std::numeric_limits<int>::max()));
  }
}

void require_arrays(const Part& part, const std::string& where) {
  for (const NamedArray& array : part.arrays) {
    require_codes(array, where);
    if (array.values.rows() == part.count(array.on)) continue;
    throw Error("array '" + array.name + "' has " + std::to_string(array.values.rows()) + " rows",
                where,
                std::to_string(part.count(array.on)) + ", one a " +
                    (array.on == NamedArray::On::points ? "point" : "cell"));
  }
}

}  // namespace

State part_to_bytes(const Part& part, std::optional<double> parameter) {
  StateWriter out;
  out.number(parameter.has_value() ? char{1} : char{0});
  out.number(parameter.value_or(0));
  out.number(static_cast<int>(part.kind));
  out.matrix(part.points);
  out.matrix(part.triangles);
  out.number(part.lines.size());
  for (const std::vector<int>& line : part.lines) out.items(line);
  out.number(part.grid_size);
  out.matrix(part.grid_origin);
  out.matrix(part.grid_spacing);
  out.number(part.arrays.size());
  for (const NamedArray& array : part.arrays) write_array(array, out);
  return out.take();
}

Part part_from_bytes(const State& bytes, std::optional<double>& parameter,
                     const std::string& where) {
  StateReader in(bytes);
  const bool has_parameter = in.number<char>() != 0;
  const auto value = in.number<double>();
  parameter = has_parameter ? std::optional(value) : std::nullopt;
  Part part;
  part.kind = kind_of_number(in.number<int>(), where);
  in.matrix(part.points);
  in.matrix(part.triangles);
  part.lines.resize(in.count(sizeof(std::size_t)));
  for (std::vector<int>& line : part.lines) in.items(line);
  part.grid_size = in.number<std::array<int, 3>>();
  in.matrix(part.grid_origin);
  in.matrix(part.grid_spacing);
  part.arrays.resize(in.count(kArrayBytes));
  for (NamedArray& array : part.arrays) array = read_array(in);
  in.require_end();
  require_points(part, where);
  require_grid(part, where);
  require_arrays(part, where);
  return part;
}

}  // namespace geoprior
