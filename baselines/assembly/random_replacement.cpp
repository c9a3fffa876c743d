#include "baselines/assembly/random_replacement.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "models/assembly/exchange/boundary_types.h"

namespace geoprior::assembly {

void describe(OptionVisitor& v, RandomReplacementOptions& options) {
  describe(v, options.match);
  v.value("attempts", options.attempts,
          {.doc = "pairs of substructures that are drawn for each assembly", .min = 1, .max = 1e8});
}

namespace {

class RandomReplacement final : public ReplacementFinder {
 public:
  RandomReplacement(const DonorSet& donors, const RandomReplacementOptions& options,
                    const RandomStream& random)
      : donors_(donors), options_(options), random_(random) {}

  std::vector<Substructure> substructures(const Assembly& host) override {
    std::set<Substructure> found;
    for (int i = 0; i < options_.attempts; ++i)
      if (auto s = draw(host); is_boundary(s)) found.insert(std::move(s));
    return {found.begin(), found.end()};
  }

  void find(const Assembly& host, const ReplacementVisitor& visit) override {
    const Compatibility& types = *donors_.compatibility;
    for (int i = 0; i < options_.attempts; ++i) {
      const int donor =
          donors_.donors[random_.below(static_cast<std::uint32_t>(donors_.donors.size()))];
      const Assembly& model = donors_.set->models[donor];
      const Substructure removed = draw(host), inserted = draw(model);
      if (!is_boundary(removed) || removed.boundary.size() != inserted.boundary.size()) continue;
      std::vector<int> match(removed.boundary.size());
      std::iota(match.begin(), match.end(), 0);
      shuffle(match);
      const BoundaryTypes a = boundary_types(host, removed, types);
      const BoundaryTypes b = boundary_types(model, inserted, types);
      bool joins = true;
      for (std::size_t k = 0; k < match.size() && joins; ++k)
        joins = can_join(a, k, b, match[k], types, options_.match.matching);
      if (joins && !visit({removed, i, donor, inserted, -1, match})) return;
    }
  }

 private:
  [[nodiscard]] bool is_boundary(const Substructure& s) const {
    return !s.boundary.empty() && static_cast<int>(s.boundary.size()) <= options_.match.boundary;
  }

  void shuffle(std::vector<int>& list) {
    for (std::size_t i = list.size(); i > 1; --i)
      std::swap(list[i - 1], list[random_.below(static_cast<std::uint32_t>(i))]);
  }

  Substructure draw(const Assembly& assembly) {
    const auto n = static_cast<std::uint32_t>(assembly.parts.size());
    const std::uint32_t most = std::min(n, static_cast<std::uint32_t>(options_.match.parts));
    const int size = 1 + static_cast<int>(random_.below(most));
    PartSet parts(static_cast<int>(n));
    parts.add(static_cast<int>(random_.below(n)));
    for (int k = 1; k < size; ++k) {
      std::vector<int> neighbours;
      for (const auto& [a, b] : assembly.connections)
        if (parts.has(a.part) != parts.has(b.part))
          neighbours.push_back(parts.has(a.part) ? b.part : a.part);
      if (neighbours.empty()) break;
      parts.add(neighbours[random_.below(static_cast<std::uint32_t>(neighbours.size()))]);
    }
    return substructure_of(assembly, std::move(parts));
  }

  DonorSet donors_;
  RandomReplacementOptions options_;
  RandomStream random_;
};

}  // namespace

std::unique_ptr<ReplacementFinder> make_random_replacement(const DonorSet& donors,
                                                           const RandomReplacementOptions& options,
                                                           const RandomStream& random) {
  return std::make_unique<RandomReplacement>(donors, options, random);
}

}  // namespace geoprior::assembly
