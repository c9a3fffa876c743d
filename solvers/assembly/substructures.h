#pragma once

#include <functional>
#include <vector>

#include "models/assembly/exchange/replacement.h"

namespace geoprior::assembly {

/// Which substructures are listed.
struct SubstructureLimits {
  int boundary = 3;    ///< K, 1 to 4: most connections of a boundary
  int parts = 1000;    ///< most parts of a substructure
  bool unions = true;  ///< false: only those that leave one piece when they are taken out
};

/// Every connected set of parts with a boundary of 1 to K connections, once each: all that can be
/// taken out, for a part of the boundary's size, and none else. Costs what the answer has, and for
/// K = 4 the square of the number of classes of connections (`CycleSpace`).
///
/// Taken out, a substructure leaves pieces, and the connections that lead to each of them are a
/// bond: with one piece it is a side of a bond; with more, what several disjoint sides of bonds
/// with no connection in common leave of their component (*unions of bonds*). That it hangs
/// together needs no look: only two bonds of two connections each can leave it in two, exactly
/// where all four are of one class.
///
/// @throws Error  for a K that is not 1 to 4, and where the bonds need more memory than there is
void for_each_substructure(const Assembly& assembly, const SubstructureLimits& limits,
                           const std::function<void(Substructure)>& visit);

/// All of them.
std::vector<Substructure> substructures(const Assembly& assembly, const SubstructureLimits& limits);

}  // namespace geoprior::assembly
