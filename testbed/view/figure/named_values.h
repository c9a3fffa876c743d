#pragma once

#include <string>
#include <vector>

#include "core/frame.h"
#include "testbed/view/figure/cells.h"

namespace geoprior {

/// The array of that name whose values have names; null when there is none.
const NamedArray* named_array(const Part& part, const std::string& name);

/// The names that the values of an array have in the parts of a figure; empty: no part has such an
/// array with names. Where parts have not the same names, all arrays get the whole list, and their
/// values become codes of it: a name is one colour in all panels.
/// @param first  names that the list begins with
/// @throws Error  naming `figure_view.color_by` and the array: a value that is no code of its names
std::vector<std::string> unite_names(std::vector<FigureRow>& rows, const std::string& array,
                                     const std::vector<std::string>& first = {});

/// Which of the codes of a named array of the parts occur in some panel; empty where no part has
/// such an array.
std::vector<bool> codes_that_occur(const std::vector<FigureRow>& rows, const std::string& array);

/// The names of the things that parts and overlays have, each once, as they occur.
/// @throws Error  naming `figure_view.labels`: no part or overlay has such an array with names
std::vector<std::string> label_names(const std::vector<FigureRow>& rows, const std::string& array);

}  // namespace geoprior
