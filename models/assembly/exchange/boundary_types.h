#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "models/assembly/exchange/replacement.h"
#include "models/assembly/graph/compatibility.h"

namespace geoprior::assembly {

/// Port classes at each connection of a boundary, in its order.
struct BoundaryTypes {
  std::vector<int> inside, outside;
};
BoundaryTypes boundary_types(const Assembly& assembly, const Substructure& s,
                             const Compatibility& compatibility);

/// Whether boundary connection i of a host may become one to the inside of the donor's j.
bool can_join(const BoundaryTypes& host, std::size_t i, const BoundaryTypes& donor, std::size_t j,
              const Compatibility& compatibility, Matching matching);

/// Calls `visit(match)` for each bijection of two boundaries that joins what can be joined, until
/// it returns false.
/// @return  whether it never did
template <class Visit>
bool for_each_match(const BoundaryTypes& host, const BoundaryTypes& donor,
                    const Compatibility& compatibility, Matching matching, Visit visit) {
  const std::size_t n = host.inside.size();
  if (donor.inside.size() != n) return true;
  std::vector<int> match(n);
  std::iota(match.begin(), match.end(), 0);
  do {
    bool joins = true;
    for (std::size_t i = 0; i < n && joins; ++i)
      joins = can_join(host, i, donor, match[i], compatibility, matching);
    if (joins && !visit(match)) return false;
  } while (std::next_permutation(match.begin(), match.end()));
  return true;
}

/// The substructure of these parts: its boundary.
Substructure substructure_of(const Assembly& assembly, PartSet parts);

}  // namespace geoprior::assembly
