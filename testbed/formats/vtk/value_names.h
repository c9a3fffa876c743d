#pragma once

#include <string>

#include "core/frame.h"

class vtkFieldData;

namespace geoprior {

/// Most names of an array that a file may have.
inline constexpr int kMostValueNames = 65536;

/// Names of the codes that the values of an array are stand in the field data of its file: strings
/// `<array>_names`, in the order of the codes. One list serves the arrays over points and over
/// cells that share a name.
///
/// @throws Error  naming the array: a value that is no code of the names, a name that is empty or
///                has a zero byte in it, over 65,536 names, other names over points than over cells
void add_value_names(const Part& part, vtkFieldData& fields);

/// Gives the arrays of a part the names that the field data have of them. What is no list of
/// strings, or of no array, is left alone.
/// @throws Error  naming file and array, as above
void read_value_names(vtkFieldData& fields, Part& part, const std::string& where);

/// @throws Error  naming `where` and the array: it has names, and a value that is no code of them
void require_codes(const NamedArray& array, const std::string& where);

}  // namespace geoprior
