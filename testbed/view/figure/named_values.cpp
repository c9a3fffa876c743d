#include "testbed/view/figure/named_values.h"

#include <algorithm>
#include <set>

#include "core/error.h"
#include "testbed/formats/vtk/value_names.h"
#include "testbed/joined.h"

namespace geoprior {
namespace {

/// The code of a name, which is appended where the list does not have it.
double code_in(std::vector<std::string>& all, const std::string& name) {
  const auto found = std::find(all.begin(), all.end(), name);
  const auto code = static_cast<double>(found - all.begin());
  if (found == all.end()) all.push_back(name);
  return code;
}

/// Codes of the whole list, which gets the array's names, in place of its own.
void recode(NamedArray& array, std::vector<std::string>& all) {
  std::vector<double> code;
  for (const std::string& name : array.names) code.push_back(code_in(all, name));
  array.values = array.values.unaryExpr([&](double own) { return code[static_cast<int>(own)]; });
}

template <class Visit>
void for_each_part(const std::vector<FigureRow>& rows, const Visit& visit) {
  for (const FigureRow& row : rows) {
    for (const FigureCell& cell : row.cells) {
      if (cell.part) visit(*cell.part);
      for (const NamedPart& overlay : cell.overlays) visit(overlay.part);
    }
  }
}

std::string named_arrays(const std::vector<FigureRow>& rows) {
  std::set<std::string> names;
  for_each_part(rows, [&](const Part& part) {
    for (const NamedArray& array : part.arrays) {
      if (!array.names.empty()) names.insert(array.name);
    }
  });
  return names.empty() ? "no array has names; leave labels out" : joined(names);
}

}  // namespace

const NamedArray* named_array(const Part& part, const std::string& name) {
  const auto found = std::find_if(
      part.arrays.begin(), part.arrays.end(),
      [&](const NamedArray& array) { return array.name == name && !array.names.empty(); });
  return found == part.arrays.end() ? nullptr : &*found;
}

std::vector<std::string> unite_names(std::vector<FigureRow>& rows, const std::string& array,
                                     const std::vector<std::string>& first) {
  std::vector<std::string> all = first;
  std::vector<NamedArray*> arrays;
  for (FigureRow& row : rows) {
    for (FigureCell& cell : row.cells) {
      if (!cell.part) continue;
      for (NamedArray& own : cell.part->arrays) {
        if (own.name != array || own.names.empty()) continue;
        require_codes(own, "figure_view.color_by");
        recode(own, all);
        arrays.push_back(&own);
      }
    }
  }
  for (NamedArray* own : arrays) own->names = all;
  return arrays.empty() ? std::vector<std::string>{} : all;
}

std::vector<bool> codes_that_occur(const std::vector<FigureRow>& rows, const std::string& array) {
  std::vector<bool> occurs;
  for (const FigureRow& row : rows) {
    for (const FigureCell& cell : row.cells) {
      const NamedArray* own = cell.part ? named_array(*cell.part, array) : nullptr;
      if (own == nullptr) continue;
      for (const double code : own->values.reshaped()) {
        const auto index = static_cast<std::size_t>(code);
        if (index >= occurs.size()) occurs.resize(index + 1);
        occurs[index] = true;
      }
    }
  }
  return occurs;
}

std::vector<std::string> label_names(const std::vector<FigureRow>& rows, const std::string& array) {
  std::vector<std::string> names;
  bool is_there = false;
  for_each_part(rows, [&](const Part& part) {
    const NamedArray* own = named_array(part, array);
    if (own == nullptr) return;
    is_there = true;
    require_codes(*own, "figure_view.labels");
    const std::set<double> codes(own->values.reshaped().begin(), own->values.reshaped().end());
    for (const double code : codes) (void)code_in(names, own->names[static_cast<int>(code)]);
  });
  if (is_there) return names;
  throw Error("no array '" + array + "' with names", "figure_view.labels", named_arrays(rows));
}

}  // namespace geoprior
