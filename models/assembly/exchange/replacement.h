#pragma once

#include <functional>
#include <span>
#include <vector>

#include "models/assembly/graph/compatibility.h"
#include "models/assembly/graph/part_set.h"
#include "models/assembly/graph/ported_graph.h"

namespace geoprior::assembly {

/// Connected parts of an assembly, not all of them, and the connections that lead out of them.
struct Substructure {
  PartSet parts;
  std::vector<int> boundary;  ///< connections with one end inside, in increasing order
  auto operator<=>(const Substructure&) const = default;
};

/// The end of a boundary connection inside, or outside, of the parts.
PortRef inside_end(const Connection& connection, const PartSet& parts);
PortRef outside_end(const Connection& connection, const PartSet& parts);

/// A substructure of a host gives way to one of a donor. The host's boundary connection i becomes
/// one from its end outside to the donor's inside end of boundary connection `match[i]` (places in
/// the two lists). Refers to what its finder holds while it tells of it.
struct Replacement {
  const Substructure& removed;   ///< of the host
  int removed_number = 0;        ///< another one for another substructure of this search
  int donor = 0;                 ///< model of the set
  const Substructure& inserted;  ///< of the donor
  int inserted_number = -1;      ///< the same one for this substructure for ever; -1: it has none
  std::span<const int> match;
};

/// The host with the replacement made: first the parts that stay, in their order, with their poses,
/// then the copied ones with the donor's poses. Not embedded yet.
struct Replaced {
  Assembly assembly;
  int kept = 0;  ///< parts from this number on are copied
  /// The new connections, in the order of the host's boundary.
  std::vector<int> seams;
};
Replaced replace(const Assembly& host, const Assembly& donor, const Replacement& replacement);

/// For each part that is not among `parts` the lowest of those that hang together with it without
/// them; -1 for those that are.
std::vector<int> pieces_outside(const Assembly& host, const PartSet& parts);

/// Told a replacement; false ends the search for more.
using ReplacementVisitor = std::function<bool(const Replacement&)>;

/// Finds substructures of a host that can be replaced by substructures of the donors, some models
/// of a set: one shape for the method and its baselines.
class ReplacementFinder {
 public:
  virtual ~ReplacementFinder() = default;
  /// Substructures of the host that it knows, whether or not something can replace them.
  virtual std::vector<Substructure> substructures(const Assembly& host) = 0;
  /// Replacements of a host, in an order that depends on the assemblies alone and, where a finder
  /// draws, on the random stream that it was made with.
  virtual void find(const Assembly& host, const ReplacementVisitor& visit) = 0;
};

/// A set of models, its compatibility, and which of the models give substructures.
struct DonorSet {
  const AssemblySet* set = nullptr;
  const Compatibility* compatibility = nullptr;
  std::vector<int> donors;
};

}  // namespace geoprior::assembly
