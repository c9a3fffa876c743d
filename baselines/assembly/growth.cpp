#include "baselines/assembly/growth.h"

#include <algorithm>
#include <set>
#include <utility>

#include "models/assembly/exchange/boundary_types.h"

namespace geoprior::assembly {

void describe(OptionVisitor& v, GrowthOptions& options) { describe(v, options.match); }

namespace {

/// A connection read from its outer to its inner end.
struct Seed {
  int connection = 0;
  PortRef outer, inner;
};

std::vector<Seed> seeds_of(const Assembly& assembly) {
  std::vector<Seed> out;
  for (std::size_t c = 0; c < assembly.connections.size(); ++c) {
    const auto [a, b] = assembly.connections[c];
    if (a.part == b.part) continue;
    out.push_back({static_cast<int>(c), a, b});
    out.push_back({static_cast<int>(c), b, a});
  }
  return out;
}

/// A set of parts that grows from a seed, and its boundary in the order in which it was met.
class GrowingSide {
 public:
  GrowingSide(const Assembly& assembly, const std::vector<PartType>& types, const Seed& seed)
      : assembly_(assembly),
        links_(assembly, types),
        before_(seed.outer.part),
        parts_(static_cast<int>(assembly.parts.size())) {
    take_in(seed.inner);
  }

  /// Takes in the part at a place of the boundary. @return  whether there was one
  bool grow(std::size_t place) {
    if (place >= boundary_.size()) return false;
    const int c = boundary_[place];
    const PortRef entered = outside_end(assembly_.connections[c], parts_);
    if (entered.part == before_) return false;
    take_in(entered);
    return true;
  }

  [[nodiscard]] const std::vector<int>& boundary() const { return boundary_; }
  [[nodiscard]] const PartSet& parts() const { return parts_; }
  [[nodiscard]] int size() const { return size_; }

 private:
  void take_in(PortRef entered) {
    parts_.add(entered.part);
    ++size_;
    const int ports = links_.port_count(entered.part);
    for (int i = 0; i < ports; ++i) {
      const int c = links_.connection({entered.part, (entered.port + i) % ports});
      if (c < 0) continue;
      const auto& [a, b] = assembly_.connections[c];
      if (parts_.has(a.part) && parts_.has(b.part))
        std::erase(boundary_, c);
      else
        boundary_.push_back(c);
    }
  }

  const Assembly& assembly_;
  Links links_;
  int before_;
  PartSet parts_;
  int size_ = 0;
  std::vector<int> boundary_;
};

class Growth final : public ReplacementFinder {
 public:
  Growth(const DonorSet& donors, const GrowthOptions& options)
      : donors_(donors), match_(options.match) {}

  std::vector<Substructure> substructures(const Assembly& host) override {
    std::set<Substructure> found;
    find(host, [&](const Replacement& r) {
      found.insert(r.removed);
      return true;
    });
    return {found.begin(), found.end()};
  }

  void find(const Assembly& host, const ReplacementVisitor& visit) override {
    const std::vector<Seed> host_seeds = seeds_of(host);
    for (const int donor : donors_.donors) {
      const Assembly& model = donors_.set->models[donor];
      const std::vector<Seed> donor_seeds = seeds_of(model);
      for (const Seed& s : host_seeds)
        for (const Seed& t : donor_seeds) {
          if (!are_alike(host, s, model, t)) continue;
          if (!grow_both(host, s, donor, t, visit)) return;
        }
    }
  }

 private:
  /// Whether the donor's inner end may take the place of the host's.
  [[nodiscard]] bool are_alike(const Assembly& host, const Seed& s, const Assembly& model,
                               const Seed& t) const {
    const Compatibility& types = *donors_.compatibility;
    const int outer = types.port_class(host, s.outer), inner = types.port_class(model, t.inner);
    if (match_.matching == Matching::observed) return types.observed(outer, inner);
    return outer == types.port_class(model, t.outer) && types.port_class(host, s.inner) == inner;
  }

  bool grow_both(const Assembly& host, const Seed& s, int donor, const Seed& t,
                 const ReplacementVisitor& visit) {
    const Assembly& model = donors_.set->models[donor];
    const std::vector<PartType>& types = donors_.set->types;
    GrowingSide removed(host, types, s), inserted(model, types, t);
    const int most = std::min(match_.parts, static_cast<int>(host.parts.size()) - 1);
    while (removed.size() <= most && inserted.size() <= match_.parts) {
      const std::size_t differs = first_difference(host, removed, model, inserted);
      const bool agree =
          differs == removed.boundary().size() && differs == inserted.boundary().size();
      if (agree && static_cast<int>(differs) <= match_.boundary && differs > 0 &&
          !tell(removed, donor, inserted, visit))
        return false;
      // The first place is that of the seed, which leads back.
      const std::size_t place = agree ? 1 : differs;
      const bool host_grew = removed.grow(place), donor_grew = inserted.grow(place);
      if (!host_grew && !donor_grew) break;
    }
    return true;
  }

  /// The first place of the two boundaries where the donor's end cannot take the host's place.
  std::size_t first_difference(const Assembly& host, const GrowingSide& removed,
                               const Assembly& model, const GrowingSide& inserted) const {
    const BoundaryTypes a =
        boundary_types(host, {removed.parts(), removed.boundary()}, *donors_.compatibility);
    const BoundaryTypes b =
        boundary_types(model, {inserted.parts(), inserted.boundary()}, *donors_.compatibility);
    std::size_t i = 0;
    while (i < a.inside.size() && i < b.inside.size() &&
           can_join(a, i, b, i, *donors_.compatibility, match_.matching))
      ++i;
    return i;
  }

  /// Tells of the pair, with boundaries in increasing order.
  bool tell(const GrowingSide& removed, int donor, const GrowingSide& inserted,
            const ReplacementVisitor& visit) {
    Substructure host_side{removed.parts(), removed.boundary()};
    Substructure donor_side{inserted.parts(), inserted.boundary()};
    std::sort(host_side.boundary.begin(), host_side.boundary.end());
    std::sort(donor_side.boundary.begin(), donor_side.boundary.end());
    const auto place = [](const std::vector<int>& list, int c) {
      return static_cast<int>(std::find(list.begin(), list.end(), c) - list.begin());
    };
    std::vector<int> match;
    for (const int c : host_side.boundary)
      match.push_back(
          place(donor_side.boundary, inserted.boundary()[place(removed.boundary(), c)]));
    return visit({host_side, ++told_, donor, donor_side, -1, match});
  }

  int told_ = 0;
  DonorSet donors_;
  MatchingOptions match_;
};

}  // namespace

std::unique_ptr<ReplacementFinder> make_growth(const DonorSet& donors,
                                               const GrowthOptions& options) {
  return std::make_unique<Growth>(donors, options);
}

}  // namespace geoprior::assembly
