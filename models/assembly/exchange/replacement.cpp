#include "models/assembly/exchange/replacement.h"

#include "core/disjoint_sets.h"

namespace geoprior::assembly {

PortRef inside_end(const Connection& connection, const PartSet& parts) {
  return parts.has(connection.a.part) ? connection.a : connection.b;
}

PortRef outside_end(const Connection& connection, const PartSet& parts) {
  return parts.has(connection.a.part) ? connection.b : connection.a;
}

namespace {

/// The connections between parts that all have a new number.
void copy_connections(const Assembly& from, const std::vector<int>& number, Assembly& into) {
  for (const Connection& c : from.connections)
    if (number[c.a.part] >= 0 && number[c.b.part] >= 0)
      into.connections.push_back({{number[c.a.part], c.a.port}, {number[c.b.part], c.b.port}});
}

}  // namespace

Replaced replace(const Assembly& host, const Assembly& donor, const Replacement& replacement) {
  const Substructure &removed = replacement.removed, &inserted = replacement.inserted;
  const std::span<const int> match = replacement.match;
  Replaced out;
  out.assembly.name = host.name;
  std::vector<int> kept(host.parts.size(), -1), copied(donor.parts.size(), -1);
  std::vector<PlacedPart>& parts = out.assembly.parts;
  for (std::size_t i = 0; i < host.parts.size(); ++i) {
    if (removed.parts.has(static_cast<int>(i))) continue;
    kept[i] = static_cast<int>(parts.size());
    parts.push_back(host.parts[i]);
  }
  out.kept = static_cast<int>(parts.size());
  for (const int i : inserted.parts.parts()) {
    copied[i] = static_cast<int>(parts.size());
    parts.push_back(donor.parts[i]);
  }
  copy_connections(host, kept, out.assembly);
  copy_connections(donor, copied, out.assembly);
  for (std::size_t k = 0; k < removed.boundary.size(); ++k) {
    const PortRef outer = outside_end(host.connections[removed.boundary[k]], removed.parts);
    const PortRef inner =
        inside_end(donor.connections[inserted.boundary[match[k]]], inserted.parts);
    out.seams.push_back(static_cast<int>(out.assembly.connections.size()));
    out.assembly.connections.push_back(
        {{kept[outer.part], outer.port}, {copied[inner.part], inner.port}});
  }
  return out;
}

std::vector<int> pieces_outside(const Assembly& host, const PartSet& parts) {
  DisjointSets sets(static_cast<int>(host.parts.size()));
  for (const auto& [a, b] : host.connections)
    if (!parts.has(a.part) && !parts.has(b.part)) sets.join(a.part, b.part);
  std::vector<int> out(host.parts.size(), -1);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (!parts.has(static_cast<int>(i))) out[i] = sets.find(static_cast<int>(i));
  return out;
}

}  // namespace geoprior::assembly
