#pragma once

#include <string>

#include "core/frame.h"

namespace geoprior {

/// Text of a frame's table: a line of quoted column names, then rows with 17 digits.
std::string table_to_csv(const FrameTable& table);
FrameTable table_from_csv(const std::string& text, const std::string& where);

}  // namespace geoprior
