#include "models/assembly/isomorphism/traversal.h"

#include <algorithm>
#include <map>
#include <vector>

#include "models/assembly/isomorphism/key_hash.h"

namespace geoprior::assembly {
namespace {

/// Parts of the label that the fewest have; of several the first.
std::vector<int> rarest_parts(const Assembly& assembly) {
  std::map<int, std::vector<int>> by_type;
  for (int part = 0; part < static_cast<int>(assembly.parts.size()); ++part)
    by_type[assembly.parts[part].type].push_back(part);
  const auto rarest = std::min_element(
      by_type.begin(), by_type.end(),
      [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  return rarest == by_type.end() ? std::vector<int>{} : rarest->second;
}

class Walk {
 public:
  Walk(const Assembly& assembly, const std::vector<PartType>& types, bool symmetries)
      : assembly_(assembly),
        types_(types),
        links_(assembly, types),
        with_symmetries_(symmetries),
        number_(assembly.parts.size()),
        symmetry_(assembly.parts.size()) {
    order_.reserve(assembly.parts.size());
  }

  [[nodiscard]] int symmetry_count(int part) const {
    return with_symmetries_ ? static_cast<int>(symmetries_of(part).size()) : 0;
  }

  /// @param symmetry  of the root: -1 for the identity
  std::optional<CanonicalKey> key_from(int root, int symmetry) {
    std::fill(number_.begin(), number_.end(), -1);
    order_.assign(1, root);
    number_[root] = 0;
    symmetry_[root] = symmetry;
    KeyHash hash;
    for (std::size_t next = 0; next < order_.size(); ++next) visit(order_[next], hash);
    if (order_.size() != number_.size()) return std::nullopt;
    return hash.key();
  }

 private:
  [[nodiscard]] const std::vector<Symmetry>& symmetries_of(int part) const {
    return types_[assembly_.parts[part].type].symmetries;
  }

  /// Where a symmetry takes a port.
  [[nodiscard]] int role(int part, int symmetry, int port) const {
    return symmetry < 0 ? port : symmetries_of(part)[symmetry].ports[port];
  }
  [[nodiscard]] int role(PortRef ref) const {
    return role(ref.part, symmetry_[ref.part], ref.port);
  }

  void visit(int part, KeyHash& hash) {
    hash.add(assembly_.parts[part].type);
    const int ports = links_.port_count(part);
    roles_.assign(ports, 0);
    for (int port = 0; port < ports; ++port) roles_[role({part, port})] = port;
    for (const int port : roles_) {
      const int c = links_.connection({part, port});
      if (c < 0) {
        hash.add(-1);
        continue;
      }
      const PortRef there = other_end(assembly_.connections[c], {part, port});
      if (number_[there.part] < 0) enter(there);
      hash.add(number_[there.part]);
      hash.add(role(there));
    }
  }

  /// Takes the symmetry that gives the port by which the part is entered the least role.
  void enter(PortRef ref) {
    number_[ref.part] = static_cast<int>(order_.size());
    order_.push_back(ref.part);
    int best = -1;
    for (int s = 0; s < symmetry_count(ref.part); ++s)
      if (role(ref.part, s, ref.port) < role(ref.part, best, ref.port)) best = s;
    symmetry_[ref.part] = best;
  }

  const Assembly& assembly_;
  const std::vector<PartType>& types_;
  Links links_;
  bool with_symmetries_;
  std::vector<int> number_, symmetry_, order_, roles_;
};

}  // namespace

std::optional<CanonicalKey> traversal_key(const Assembly& assembly,
                                          const std::vector<PartType>& types, bool symmetries) {
  std::optional<CanonicalKey> least;
  Walk walk(assembly, types, symmetries);
  for (const int root : rarest_parts(assembly))
    for (int s = -1; s < walk.symmetry_count(root); ++s) {
      const std::optional<CanonicalKey> key = walk.key_from(root, s);
      if (!key) return std::nullopt;
      if (!least || *key < *least) least = key;
    }
  return least;
}

CanonicalKey isomorphism_key(const Assembly& assembly, const std::vector<PartType>& types,
                             bool symmetries) {
  if (const auto key = traversal_key(assembly, types, symmetries)) return *key;
  return canonical_key(assembly, types, symmetries);
}

}  // namespace geoprior::assembly
