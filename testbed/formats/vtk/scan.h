#pragma once

#include <string>
#include <string_view>

namespace geoprior {

/// What is looked at in a VTK XML file before VTK's parser and readers see it: they recurse as deep
/// as elements are nested, and allocate what the file declares. One pass over its elements, up to
/// its appended data; of compressed arrays the headers (vtk_blocks.h) are read.
///
/// @throws Error  naming file and byte: no XML, a document type (entities), elements nested deeper
///                than 32, arrays of an unknown type, counts that are no whole number or more than
///                the file can hold, over 2^20 texts, extents that are no six numbers in order
void check_vtk_xml(std::string_view text, const std::string& where);

}  // namespace geoprior
