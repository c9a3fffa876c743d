#pragma once

#include <string>

#include "core/frame.h"

namespace geoprior {

/// A cell of a .csv in quotes, quotes in it doubled (RFC 4180). @throws Error  for a line break
std::string quoted_cell(const std::string& text);

/// Text of a frame's table: a line of quoted column names, then rows with 17 digits.
std::string table_to_csv(const FrameTable& table);
FrameTable table_from_csv(const std::string& text, const std::string& where);

}  // namespace geoprior
