#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"

namespace geoprior {

/// What a VTK XML file holds.
struct VtkFile {
  Part part;
  std::optional<double> parameter;  ///< its TimeValue
  std::vector<std::string> notes;   ///< cells that are left out
};

}  // namespace geoprior
