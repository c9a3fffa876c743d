#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/frame.h"
#include "models/assembly/exchange/replacement.h"
#include "models/assembly/search/input.h"

namespace geoprior::assembly {

/// An assembly and where its parts come from.
struct Variation {
  static constexpr int kKept = -1;
  Assembly assembly;
  /// For each part: `kKept` where it was in the input from the beginning, else the model that it
  /// was copied from.
  std::vector<int> origin;
  int depth = 0;  ///< replacements since the input
};

/// An input as a variation of itself.
Variation unchanged(const Assembly& model);

/// A host with a replacement made, and embedded.
/// @param replaced  what `replace` makes of them
Variation varied(const Variation& host, const AssemblySet& set, const Replacement& replacement,
                 Replaced replaced);

/// What became of the candidates of a search so far.
struct SearchCounts {
  double candidates = 0;           ///< replacements that a finder named
  double closing = 0;              ///< of these, with seams that meet
  std::array<double, 9> broken{};  ///< by filter (rules.h), the last: by none
  double duplicates = 0;           ///< of the valid ones, those that were there
  double valid = 0;                ///< distinct
  double states = 0;               ///< assemblies whose replacements were looked at
};

/// The frame of an assembly. Parts: `surface` with the cell arrays `part`, `label` (its type) and
/// `exchanged` (0: kept, 1: copied); `graph`, a line a connection between the parts' centres;
/// `joints`, a point a connection with its misfit; `ways`, a ball's ways where parts begin some,
/// else the ways of all parts. Tables: `parts` and `connections`, from which metrics are measured.
/// @param counts  null: no diagnostics
Frame assembly_frame(double parameter, const Variation& variation,
                     const std::vector<PartType>& types, const SearchCounts* counts);

/// The assembly and origins that the tables of a frame hold.
Variation variation_of(const Frame& frame);

}  // namespace geoprior::assembly
