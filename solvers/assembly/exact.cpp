#include "solvers/assembly/exact.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_set>
#include <utility>

#include "models/assembly/exchange/boundary_types.h"
#include "models/assembly/isomorphism/canonical.h"

namespace geoprior::assembly {

void describe(OptionVisitor& v, ExactOptions& options) {
  describe(v, options.match);
  v.value("unions", options.unions,
          {.doc = "whether substructures are listed that leave several pieces when they are taken "
                  "out"});
}

namespace {

class ExactFinder final : public ReplacementFinder {
 public:
  ExactFinder(const DonorSet& donors, const ExactOptions& options, bool keep_alike)
      : donors_(donors), options_(options), keep_alike_(keep_alike) {}

  std::vector<Substructure> substructures(const Assembly& host) override {
    return assembly::substructures(
        host, {options_.match.boundary, options_.match.parts, options_.unions});
  }

  void find(const Assembly& host, const ReplacementVisitor& visit) override {
    if (!std::exchange(is_filed_, true))
      for (const int donor : donors_.donors) file_donor(donor);
    int number = 0;
    for (const Substructure& removed : substructures(host)) {
      ++number;
      const BoundaryTypes types = boundary_types(host, removed, *donors_.compatibility);
      for (const Drawer* drawer : matching_drawers(types))
        for (const Entry& entry : drawer->entries)
          if (!visit_matches(types, removed, number, entry, visit)) return;
    }
  }

 private:
  struct Entry {
    int donor = 0;
    int number = 0;  ///< of all entries
    Substructure substructure;
    BoundaryTypes types;
  };
  /// Substructures of the donors whose boundaries have the same types.
  struct Drawer {
    std::vector<Entry> entries;
    std::unordered_set<CanonicalKey, CanonicalHash> keys;
  };
  using Key = std::vector<std::pair<int, int>>;

  /// What two boundaries must share to be filed together: the inside ends, and the outside ends
  /// where these have to agree, too.
  [[nodiscard]] Key key_of(const BoundaryTypes& types) const {
    Key key;
    for (std::size_t i = 0; i < types.inside.size(); ++i)
      key.emplace_back(types.inside[i],
                       options_.match.matching == Matching::strict ? types.outside[i] : -1);
    std::sort(key.begin(), key.end());
    return key;
  }

  /// What of a boundary must agree beside its inside for two substructures to be alike: the ends
  /// outside, where these count.
  [[nodiscard]] std::vector<int> colours_of(const BoundaryTypes& types) const {
    if (options_.match.matching == Matching::strict) return types.outside;
    return std::vector<int>(types.outside.size(), 0);
  }

  void file_donor(int donor) {
    const Assembly& model = donors_.set->models[donor];
    for (Substructure& s : substructures(model)) {
      BoundaryTypes types = boundary_types(model, s, *donors_.compatibility);
      Drawer& drawer = drawers_[key_of(types)];
      if (!keep_alike_ && !drawer.keys
                               .insert(canonical_key(model, donors_.set->types, s.parts, s.boundary,
                                                     colours_of(types), options_.match.symmetries))
                               .second)
        continue;
      drawer.entries.push_back({donor, entries_++, std::move(s), std::move(types)});
    }
  }

  /// The drawers that have a match; found once for all boundaries of the same types.
  const std::vector<const Drawer*>& matching_drawers(const BoundaryTypes& types) {
    Key asked;
    for (std::size_t i = 0; i < types.inside.size(); ++i)
      asked.emplace_back(types.outside[i],
                         options_.match.matching == Matching::strict ? types.inside[i] : -1);
    std::sort(asked.begin(), asked.end());
    const auto [found, is_new] = matches_.try_emplace(asked);
    if (!is_new) return found->second;
    std::set<Key> keys;
    collect_keys(asked, {}, keys);
    for (const Key& key : keys)
      if (const auto drawer = drawers_.find(key); drawer != drawers_.end())
        found->second.push_back(&drawer->second);
    return found->second;
  }

  /// The keys of all boundaries that could be joined with these outer ends: one inner port for
  /// each, of those that were seen with it.
  void collect_keys(const Key& asked, const Key& chosen, std::set<Key>& keys) const {
    if (chosen.size() == asked.size()) {
      Key key = chosen;
      std::sort(key.begin(), key.end());
      keys.insert(std::move(key));
      return;
    }
    const auto [outside, inside] = asked[chosen.size()];
    Key next = chosen;
    if (options_.match.matching == Matching::strict) {
      next.emplace_back(inside, outside);
      return collect_keys(asked, next, keys);
    }
    next.emplace_back();
    for (const int port : donors_.compatibility->seen_with(outside)) {
      next.back() = {port, -1};
      collect_keys(asked, next, keys);
    }
  }

  bool visit_matches(const BoundaryTypes& types, const Substructure& removed, int number,
                     const Entry& entry, const ReplacementVisitor& visit) const {
    return for_each_match(
        types, entry.types, *donors_.compatibility, options_.match.matching,
        [&](const std::vector<int>& match) {
          return visit({removed, number, entry.donor, entry.substructure, entry.number, match});
        });
  }

  DonorSet donors_;
  ExactOptions options_;
  bool keep_alike_;
  bool is_filed_ = false;  ///< donors are filed when they are first asked for
  int entries_ = 0;
  std::map<Key, Drawer> drawers_;
  std::map<Key, std::vector<const Drawer*>> matches_;
};

}  // namespace

std::unique_ptr<ReplacementFinder> make_exact_finder(const DonorSet& donors,
                                                     const ExactOptions& options, bool keep_alike) {
  return std::make_unique<ExactFinder>(donors, options, keep_alike);
}

}  // namespace geoprior::assembly
