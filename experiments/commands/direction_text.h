#pragma once

#include <string>

#include "experiments/topic.h"

namespace geoprior {

/// "lower_is_better", …: the words of run.h5.
inline std::string direction_text(Direction direction) {
  switch (direction) {
    case Direction::lower_is_better:
      return "lower_is_better";
    case Direction::higher_is_better:
      return "higher_is_better";
    case Direction::closer_to_target:
      return "closer_to_target";
    case Direction::none:
      return "none";
  }
  return "none";
}

}  // namespace geoprior
