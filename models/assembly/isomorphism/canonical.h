#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "models/assembly/graph/part_set.h"
#include "models/assembly/graph/ported_graph.h"
#include "models/assembly/isomorphism/key_hash.h"

namespace geoprior::assembly {

/// Canonical form of the ported graph: two assemblies have equal forms exactly when a bijection of
/// their parts keeps labels, and connections port by port up to symmetries of the parts.
///
/// A vertex a part, coloured by its label, and one a port, coloured by its number; joined ports are
/// adjacent. The ports of a part with symmetries have one colour, and each of the symmetries (the
/// identity too) is a vertex, adjacent to a vertex for each port coloured by where the port goes:
/// an automorphism of these is one of the group, and none else. The canonical labelling is nauty's.
///
/// Calls are serialised: nauty keeps state of its own.
/// @param symmetries  false: every port is one of a kind
/// Source: McKay and Piperno 2014.
std::vector<int> canonical_form(const Assembly& assembly, const std::vector<PartType>& types,
                                bool symmetries);
CanonicalKey canonical_key(const Assembly& assembly, const std::vector<PartType>& types,
                           bool symmetries);

/// Key of some parts alone, their boundary ports marked: equal for substructures that put in each
/// other's place give the same assembly, with some match of their boundaries.
CanonicalKey canonical_key(const Assembly& assembly, const std::vector<PartType>& types,
                           const PartSet& parts, bool symmetries);

/// The same, where the boundary's connections have colours: told apart by their places, keys are
/// equal for substructures that give the same assembly with the match of equal places.
/// @param colours  of the connections of `boundary`
CanonicalKey canonical_key(const Assembly& assembly, const std::vector<PartType>& types,
                           const PartSet& parts, std::span<const int> boundary,
                           std::span<const int> colours, bool symmetries);

}  // namespace geoprior::assembly
