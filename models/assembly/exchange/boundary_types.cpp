#include "models/assembly/exchange/boundary_types.h"

#include <utility>

namespace geoprior::assembly {

BoundaryTypes boundary_types(const Assembly& assembly, const Substructure& s,
                             const Compatibility& compatibility) {
  BoundaryTypes out;
  for (const int c : s.boundary) {
    const Connection& connection = assembly.connections[c];
    out.inside.push_back(compatibility.port_class(assembly, inside_end(connection, s.parts)));
    out.outside.push_back(compatibility.port_class(assembly, outside_end(connection, s.parts)));
  }
  return out;
}

bool can_join(const BoundaryTypes& host, std::size_t i, const BoundaryTypes& donor, std::size_t j,
              const Compatibility& compatibility, Matching matching) {
  if (matching == Matching::strict)
    return host.outside[i] == donor.outside[j] && host.inside[i] == donor.inside[j];
  return compatibility.observed(host.outside[i], donor.inside[j]);
}

Substructure substructure_of(const Assembly& assembly, PartSet parts) {
  Substructure out{std::move(parts), {}};
  for (std::size_t c = 0; c < assembly.connections.size(); ++c) {
    const auto [a, b] = assembly.connections[c];
    if (out.parts.has(a.part) != out.parts.has(b.part)) out.boundary.push_back(static_cast<int>(c));
  }
  return out;
}

}  // namespace geoprior::assembly
