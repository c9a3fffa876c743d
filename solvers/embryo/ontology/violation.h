#pragma once

#include <string>

namespace geoprior::embryo {

/// One statement of an ontology that cannot be.
struct Violation {
  std::string kind;     ///< one of `violation_kinds`
  std::string subject;  ///< local name
  std::string message;  ///< a sentence with the names and numbers
  int line = 0;         ///< of all files of the graph (`Graph::place`)
};

}  // namespace geoprior::embryo
