#include "models/assembly/exchange/matching_options.h"

#include <array>
#include <string_view>

namespace geoprior::assembly {

void describe(OptionVisitor& v, MatchingOptions& options) {
  v.value("boundary", options.boundary,
          {.doc = "K: most connections that lead out of a substructure", .min = 1, .max = 4});
  v.value(
      "parts", options.parts,
      {.doc = "most parts of a substructure that is removed or inserted", .min = 1, .max = 1e6});
  v.value("symmetries", options.symmetries,
          {.doc = "whether ports that a symmetry of their part exchanges are alike"});
  describe_matching(v, options.matching);
}

void describe_matching(OptionVisitor& v, Matching& matching) {
  constexpr std::array<std::string_view, 2> kMatchings = {"observed", "strict"};
  describe_choice(
      v, "matching", matching, kMatchings,
      {.doc = "what of a new connection must have been seen: its two ports joined in "
              "some model, or the removed connection's very ports at both of its ends"});
}

}  // namespace geoprior::assembly
