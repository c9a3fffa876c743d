#pragma once

#include <optional>

#include "models/assembly/isomorphism/canonical.h"

namespace geoprior::assembly {

/// A key of the walk through a connected assembly, port by port from a part: parts numbered as they
/// are met, what each port is joined with. Equal for isomorphic assemblies and for no others (but
/// for a collision of 128 bits), in the time of the walk: without nauty, which a search of many
/// thousand assemblies would wait for, and which the tests hold it against.
///
/// The walk tells the whole graph. It has no choice but where it begins: of each part the ports are
/// ordered, and a symmetry is known by where it takes one port, so that the port by which a part is
/// entered decides which of its symmetries is taken. It begins at each part of the rarest label, by
/// each of its symmetries, and the least key counts.
///
/// @param symmetries  false: every port is one of a kind
/// @return  absent for an assembly that does not hang together
std::optional<CanonicalKey> traversal_key(const Assembly& assembly,
                                          const std::vector<PartType>& types, bool symmetries);

/// The traversal's key, or, of what does not hang together, the canonical form's: equal for
/// isomorphic assemblies alone.
CanonicalKey isomorphism_key(const Assembly& assembly, const std::vector<PartType>& types,
                             bool symmetries);

}  // namespace geoprior::assembly
