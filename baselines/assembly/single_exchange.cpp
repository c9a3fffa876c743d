#include "baselines/assembly/single_exchange.h"

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
    for (const int donor : donors.donors)
      of_donors_.push_back(substructures(donors.set->models[donor]));
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
    const Compatibility& types = *donors_.compatibility;
    int removed_number = 0;
    for (const Substructure& removed : substructures(host)) {
      ++removed_number;
      int number = 0;
      for (std::size_t d = 0; d < of_donors_.size(); ++d)
        for (const Substructure& inserted : of_donors_[d]) {
          ++number;
          const int donor = donors_.donors[d];
          if (!for_each_match(
                  boundary_types(host, removed, types),
                  boundary_types(donors_.set->models[donor], inserted, types), types,
                  options_.matching, [&](const std::vector<int>& match) {
                    return visit({removed, removed_number, donor, inserted, number, match});
                  }))
            return;
        }
    }
  }

 private:
  DonorSet donors_;
  SingleExchangeOptions options_;
  std::vector<std::vector<Substructure>> of_donors_;
};

}  // namespace

std::unique_ptr<ReplacementFinder> make_single_exchange(const DonorSet& donors,
                                                        const SingleExchangeOptions& options) {
  return std::make_unique<SingleExchange>(donors, options);
}

}  // namespace geoprior::assembly
