#include "solvers/assembly/substructures.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/limits.h"
#include "solvers/assembly/cycle_space.h"

namespace geoprior::assembly {
namespace {

/// A bond and the parts on one side of it.
struct Side {
  PartSet parts;
  std::vector<int> bond;
};

class SubstructureLister {
 public:
  SubstructureLister(const Assembly& assembly, const SubstructureLimits& limits,
                     const std::function<void(Substructure)>& visit)
      : space_(assembly), limits_(limits), visit_(visit) {
    double bytes = 0;
    double bonds = 0;
    for (int size = 1; size <= limits.boundary; ++size) {
      bytes += space_.bytes_needed(size);
      require_memory(bytes, static_cast<double>(space_.classes().size()),
                     "classes of connections, whose pairs are compared", "options.boundary");
      bonds += space_.bond_count(size);
    }
    require_memory(bytes + bonds * (64. + space_.part_count() / 8.), bonds, "bonds",
                   "options.boundary");
  }

  void list() {
    for (int size = 1; size <= limits_.boundary; ++size)
      space_.for_each_bond(size, [&](std::span<const int> bond) {
        for (Side& side : sides(bond)) emit(std::move(side.parts), {bond.begin(), bond.end()});
      });
    if (limits_.unions && limits_.boundary >= 2) list_unions();
  }

 private:
  std::vector<Side> sides(std::span<const int> bond) const {
    const PartSet far = space_.far_side(bond);
    const std::vector<int> edges(bond.begin(), bond.end());
    return {{far, edges}, {space_.rest_of_component(far), edges}};
  }

  void emit(PartSet parts, std::vector<int> boundary) const {
    if (parts.size() <= limits_.parts) visit_({std::move(parts), std::move(boundary)});
  }

  /// What the chosen sides leave.
  void emit_rest(const std::vector<const Side*>& chosen) const {
    PartSet taken = chosen.front()->parts;
    std::vector<int> boundary = chosen.front()->bond;
    for (std::size_t i = 1; i < chosen.size(); ++i) {
      taken |= chosen[i]->parts;
      boundary.insert(boundary.end(), chosen[i]->bond.begin(), chosen[i]->bond.end());
    }
    std::sort(boundary.begin(), boundary.end());
    emit(space_.rest_of_component(taken), std::move(boundary));
  }

  /// Disjoint sides of one component, without a common connection.
  static bool go_together(const Side& a, const Side& b, const CycleSpace& space) {
    if (a.parts.meets(b.parts)) return false;
    for (const int c : a.bond)
      if (std::find(b.bond.begin(), b.bond.end(), c) != b.bond.end()) return false;
    return space.rest_of_component(a.parts).meets(b.parts);
  }

  void list_unions() {
    for (const int bridge : space_.bridges())
      for (Side& side : sides({&bridge, 1})) bridge_sides_.push_back(std::move(side));
    const int count = static_cast<int>(bridge_sides_.size());
    together_.assign(count, PartSet(count));
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j)
        if (go_together(bridge_sides_[i], bridge_sides_[j], space_)) together_[i].add(j);
    for (int i = 0; i < count; ++i)
      add_bridges({&bridge_sides_[i]}, together_[i], i, limits_.boundary - 1);
    for (int size = 2; size < limits_.boundary; ++size)
      space_.for_each_bond(size, [&](std::span<const int> bond) {
        for (const Side& side : sides(bond))
          add_bridges({&side}, bridges_beside(side), -1, limits_.boundary - size);
      });
    if (limits_.boundary >= 4) list_pairs_of_pairs();
  }

  PartSet bridges_beside(const Side& side) const {
    PartSet out(static_cast<int>(bridge_sides_.size()));
    for (std::size_t i = 0; i < bridge_sides_.size(); ++i)
      if (go_together(side, bridge_sides_[i], space_)) out.add(static_cast<int>(i));
    return out;
  }

  /// Adds one more bridge after `last`, and after it others.
  void add_bridges(const std::vector<const Side*>& chosen, const PartSet& candidates, int last,
                   int room) const {
    if (room == 0) return;
    for (const int i : candidates.parts()) {
      if (i <= last) continue;
      std::vector<const Side*> more = chosen;
      more.push_back(&bridge_sides_[i]);
      emit_rest(more);
      PartSet left = candidates;
      left &= together_[i];
      add_bridges(more, left, i, room - 1);
    }
  }

  /// Two bonds of two connections, of different classes.
  void list_pairs_of_pairs() const {
    std::map<int, std::vector<Side>> by_class;
    space_.for_each_bond(2, [&](std::span<const int> bond) {
      for (Side& side : sides(bond)) by_class[space_.class_of(bond[0])].push_back(std::move(side));
    });
    for (auto a = by_class.begin(); a != by_class.end(); ++a)
      for (auto b = std::next(a); b != by_class.end(); ++b)
        for (const Side& s : a->second)
          for (const Side& t : b->second)
            if (go_together(s, t, space_)) emit_rest({&s, &t});
  }

  CycleSpace space_;
  SubstructureLimits limits_;
  const std::function<void(Substructure)>& visit_;
  std::vector<Side> bridge_sides_;
  std::vector<PartSet> together_;
};

}  // namespace

void for_each_substructure(const Assembly& assembly, const SubstructureLimits& limits,
                           const std::function<void(Substructure)>& visit) {
  if (limits.boundary < 1 || limits.boundary > 4)
    throw Error("boundaries of " + std::to_string(limits.boundary) + " connections are not listed",
                "options.boundary", "1 to 4");
  SubstructureLister(assembly, limits, visit).list();
}

std::vector<Substructure> substructures(const Assembly& assembly,
                                        const SubstructureLimits& limits) {
  std::vector<Substructure> out;
  constexpr std::size_t kBetweenLooks = 1 << 16;
  const double bytes_each = 120. + static_cast<double>(assembly.parts.size()) / 8;
  for_each_substructure(assembly, limits, [&](Substructure s) {
    out.push_back(std::move(s));
    if (out.size() % kBetweenLooks == 0)
      require_memory(bytes_each * 2 * static_cast<double>(out.size()),
                     static_cast<double>(out.size()), "substructures", "options.boundary");
  });
  return out;
}

}  // namespace geoprior::assembly
