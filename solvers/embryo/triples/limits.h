#pragma once

#include <cstddef>

namespace geoprior::embryo {

/// What a file may ask of us at most.
struct ReadLimits {
  std::size_t bytes = 64u << 20;  ///< of the file
  int triples = 2'000'000;        ///< in the file
  int text = 65'536;              ///< bytes of one IRI, literal or label
  int nesting = 64;               ///< of blank nodes, lists and elements in each other
};

}  // namespace geoprior::embryo
