#include "testbed/formats/vtk/value_names.h"

#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace geoprior {
namespace {

std::string field_of_names(const NamedArray& array) { return array.name + "_names"; }

std::string place_of_names(const NamedArray& array, const std::string& where) {
  return (where.empty() ? "" : where + ": ") + "array '" + array.name + "'";
}

void require_count_of_names(vtkIdType count, const std::string& place) {
  if (count <= kMostValueNames) return;
  throw Error("has " + std::to_string(count) + " names", place,
              "at most " + std::to_string(kMostValueNames));
}

void require_names(const NamedArray& array, const std::string& where) {
  const std::string place = place_of_names(array, where);
  require_count_of_names(std::ssize(array.names), place);
  for (std::size_t code = 0; code < array.names.size(); ++code) {
    const std::string& name = array.names[code];
    if (!name.empty() && name.find('\0') == std::string::npos) continue;
    throw Error(
        "its name of " + std::to_string(code) + (name.empty() ? " is empty" : " is no text"),
        place);
  }
  require_codes(array, where);
}

/// The array of that name over the other elements must mean the same.
void require_one_meaning(const Part& part, const NamedArray& array) {
  for (const NamedArray& other : part.arrays) {
    if (other.name != array.name || other.names == array.names) continue;
    throw Error("has other names over points than over cells", place_of_names(array, {}));
  }
}

}  // namespace

void require_codes(const NamedArray& array, const std::string& where) {
  if (array.names.empty()) return;
  const auto names = static_cast<double>(array.names.size());
  for (Eigen::Index row = 0; row < array.values.rows(); ++row) {
    for (const double value : array.values.row(row)) {
      if (value >= 0 && value < names && value == std::floor(value)) continue;
      throw Error(
          "its value " + std::to_string(value) + " in row " + std::to_string(row) + " has no name",
          place_of_names(array, where),
          "whole numbers, 0 to " + std::to_string(array.names.size() - 1));
    }
  }
}

void add_value_names(const Part& part, vtkFieldData& fields) {
  for (const NamedArray& array : part.arrays) {
    if (array.names.empty()) continue;
    require_names(array, {});
    require_one_meaning(part, array);
    const std::string field = field_of_names(array);
    if (fields.GetAbstractArray(field.c_str()) != nullptr) continue;  // over the other elements
    vtkNew<vtkStringArray> names;
    names->SetName(field.c_str());
    for (const std::string& name : array.names) names->InsertNextValue(name);
    fields.AddArray(names);
  }
}

void read_value_names(vtkFieldData& fields, Part& part, const std::string& where) {
  for (NamedArray& array : part.arrays) {
    const auto* names =
        vtkStringArray::SafeDownCast(fields.GetAbstractArray(field_of_names(array).c_str()));
    if (names == nullptr) continue;
    require_count_of_names(names->GetNumberOfValues(), place_of_names(array, where));
    for (vtkIdType code = 0; code < names->GetNumberOfValues(); ++code) {
      array.names.push_back(names->GetValue(code));
    }
    require_names(array, where);
  }
}

}  // namespace geoprior
