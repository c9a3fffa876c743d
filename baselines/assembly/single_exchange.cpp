#include "baselines/assembly/single_exchange.h"

#include <utility>

#include "models/assembly/exchange/boundary_types.h"

namespace geoprior::assembly {

void describe(OptionVisitor& v, SingleExchangeOptions& options) {
  v.value("boundary", options.boundary,
          {.doc = "most connections of a part that is exchanged", .min = 1, .max = 8});
  v.value("symmetries", options.symmetries,
          {.doc = "whether ports that a symmetry of their part exchanges are alike"});
  describe_matching(v, options.matching);
}

namespace {

class SingleExchange final : public ReplacementFinder {
 public:
  SingleExchange(const DonorSet& donors, const SingleExchangeOptions& options)
      : donors_(donors), options_(options) {
    int number = 0;
    for (const int donor : donors.donors)
      for (Substructure& s : substructures(donors.set->models[donor])) {
        BoundaryTypes types = boundary_types(donors.set->models[donor], s, *donors.compatibility);
        entries_.push_back({donor, ++number, std::move(s), std::move(types)});
      }
  }

  std::vector<Substructure> substructures(const Assembly& host) override {
    std::vector<Substructure> out;
    const int parts = static_cast<int>(host.parts.size());
    for (int part = 0; part < parts; ++part) {
      PartSet one(parts);
      one.add(part);
      Substructure s = substructure_of(host, std::move(one));
      const int size = static_cast<int>(s.boundary.size());
      if (size >= 1 && size <= options_.boundary) out.push_back(std::move(s));
    }
    return out;
  }

  void find(const Assembly& host, const ReplacementVisitor& visit) override {
    const Compatibility& compatibility = *donors_.compatibility;
    int removed_number = 0;
    for (const Substructure& removed : substructures(host)) {
      ++removed_number;
      const BoundaryTypes types = boundary_types(host, removed, compatibility);
      for (const Entry& entry : entries_)
        if (!for_each_match(types, entry.types, compatibility, options_.matching,
                            [&](const std::vector<int>& match) {
                              return visit({removed, removed_number, entry.donor,
                                            entry.substructure, entry.number, match});
                            }))
          return;
    }
  }

 private:
  /// A part of a donor.
  struct Entry {
    int donor = 0;
    int number = 0;
    Substructure substructure;
    BoundaryTypes types;
  };

  DonorSet donors_;
  SingleExchangeOptions options_;
  std::vector<Entry> entries_;
};

}  // namespace

std::unique_ptr<ReplacementFinder> make_single_exchange(const DonorSet& donors,
                                                        const SingleExchangeOptions& options) {
  return std::make_unique<SingleExchange>(donors, options);
}

}  // namespace geoprior::assembly
