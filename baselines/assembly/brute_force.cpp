#include "baselines/assembly/brute_force.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

#include "core/error.h"

namespace geoprior::assembly {

void describe(OptionVisitor& v, BruteForceOptions& options) { describe(v, options.match); }

namespace {

/// Every connected set of parts whose boundary has at most so many connections.
class ConnectedSets {
 public:
  ConnectedSets(const Assembly& assembly, int boundary)
      : boundary_(boundary),
        state_(assembly.parts.size(), State::open),
        neighbours_(assembly.parts.size()) {
    for (const Connection& c : assembly.connections) {
      if (c.a.part == c.b.part) continue;
      neighbours_[c.a.part].push_back(c.b.part);
      neighbours_[c.b.part].push_back(c.a.part);
    }
  }

  std::vector<std::vector<int>> list() {
    for (std::size_t least = 0; least < state_.size(); ++least) {
      state_[least] = State::in;
      chosen_ = {static_cast<int>(least)};
      decide(cut_of(static_cast<int>(least)));
      state_[least] = State::out;
    }
    return std::move(found_);
  }

 private:
  enum class State { open, in, out };

  /// Connections from a part to those that were left out.
  [[nodiscard]] int cut_of(int part) const {
    int n = 0;
    for (const int other : neighbours_[part])
      if (state_[other] == State::out) ++n;
    return n;
  }

  [[nodiscard]] int next_open() const {
    for (const int part : chosen_)
      for (const int other : neighbours_[part])
        if (state_[other] == State::open) return other;
    return -1;
  }

  /// @param cut  connections between parts taken in and parts left out
  void decide(int cut) {
    if (cut > boundary_) return;
    const int part = next_open();
    if (part < 0) {
      if (cut > 0) found_.push_back(chosen_);
      return;
    }
    state_[part] = State::in;
    chosen_.push_back(part);
    decide(cut + cut_of(part));
    chosen_.pop_back();
    state_[part] = State::out;
    int to_chosen = 0;
    for (const int other : neighbours_[part])
      if (state_[other] == State::in) ++to_chosen;
    decide(cut + to_chosen);
    state_[part] = State::open;
  }

  int boundary_;
  std::vector<State> state_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<int> chosen_;
  std::vector<std::vector<int>> found_;
};

/// A port of a kind of part.
using KindPort = std::pair<int, int>;

class BruteForce final : public ReplacementFinder {
 public:
  BruteForce(const DonorSet& donors, const BruteForceOptions& options)
      : donors_(donors), match_(options.match) {
    for (const int donor : donors.donors)
      of_donors_.push_back(substructures(donors.set->models[donor]));
  }

  std::vector<Substructure> substructures(const Assembly& host) override {
    if (host.parts.size() > kMostBruteForceParts)
      throw Error("has " + std::to_string(host.parts.size()) + " parts, too many for brute force",
                  "model '" + host.name + "'", "at most " + std::to_string(kMostBruteForceParts));
    std::vector<Substructure> out;
    for (const std::vector<int>& parts : ConnectedSets(host, match_.boundary).list()) {
      if (static_cast<int>(parts.size()) > match_.parts) continue;
      Substructure s{PartSet(static_cast<int>(host.parts.size())), {}};
      for (const int part : parts) s.parts.add(part);
      for (std::size_t c = 0; c < host.connections.size(); ++c)
        if (s.parts.has(host.connections[c].a.part) != s.parts.has(host.connections[c].b.part))
          s.boundary.push_back(static_cast<int>(c));
      out.push_back(std::move(s));
    }
    return out;
  }

  void find(const Assembly& host, const ReplacementVisitor& visit) override {
    int removed_number = 0;
    for (const Substructure& removed : substructures(host)) {
      ++removed_number;
      int number = 0;
      for (std::size_t d = 0; d < of_donors_.size(); ++d)
        for (const Substructure& inserted : of_donors_[d]) {
          ++number;
          if (inserted.boundary.size() != removed.boundary.size()) continue;
          std::vector<int> match;
          const Replacement trial{removed, removed_number, donors_.donors[d], inserted, number, {}};
          if (!try_matches(host, trial, match, visit)) return;
        }
    }
  }

 private:
  /// Extends the match by each place that is free.
  bool try_matches(const Assembly& host, const Replacement& trial, std::vector<int>& match,
                   const ReplacementVisitor& visit) {
    const std::size_t i = match.size();
    if (i == trial.removed.boundary.size())
      return visit({trial.removed, trial.removed_number, trial.donor, trial.inserted,
                    trial.inserted_number, match});
    for (int j = 0; j < static_cast<int>(trial.inserted.boundary.size()); ++j) {
      if (std::find(match.begin(), match.end(), j) != match.end()) continue;
      if (!may_join(host, trial, i, j)) continue;
      match.push_back(j);
      if (!try_matches(host, trial, match, visit)) return false;
      match.pop_back();
    }
    return true;
  }

  bool may_join(const Assembly& host, const Replacement& trial, std::size_t i, int j) {
    const Assembly& donor = donors_.set->models[trial.donor];
    const auto kind = [](const Assembly& assembly, PortRef ref) {
      return KindPort{assembly.parts[ref.part].type, ref.port};
    };
    const auto ends = [&](const Assembly& assembly, const Substructure& s, int c) {
      const Connection& connection = assembly.connections[c];
      const bool a_inside = s.parts.has(connection.a.part);
      return std::array{kind(assembly, a_inside ? connection.a : connection.b),
                        kind(assembly, a_inside ? connection.b : connection.a)};
    };
    const auto [inside, outside] = ends(host, trial.removed, trial.removed.boundary[i]);
    const auto [new_inside, new_outside] = ends(donor, trial.inserted, trial.inserted.boundary[j]);
    if (match_.matching == Matching::strict)
      return are_alike(inside, new_inside) && are_alike(outside, new_outside);
    return was_seen(outside, new_inside);
  }

  /// The same port, or one that a symmetry of the part brings there.
  [[nodiscard]] bool are_alike(KindPort a, KindPort b) const {
    if (a.first != b.first) return false;
    if (a.second == b.second) return true;
    if (!match_.symmetries) return false;
    for (const Symmetry& s : donors_.set->types[a.first].symmetries)
      if (s.ports[a.second] == b.second) return true;
    return false;
  }

  bool was_seen(KindPort a, KindPort b) {
    const auto [found, is_new] = seen_.try_emplace({a, b}, false);
    if (!is_new) return found->second;
    for (const Assembly& model : donors_.set->models)
      for (const Connection& c : model.connections) {
        const KindPort p{model.parts[c.a.part].type, c.a.port};
        const KindPort q{model.parts[c.b.part].type, c.b.port};
        if ((are_alike(a, p) && are_alike(b, q)) || (are_alike(a, q) && are_alike(b, p)))
          found->second = true;
      }
    return found->second;
  }

  DonorSet donors_;
  MatchingOptions match_;
  std::vector<std::vector<Substructure>> of_donors_;
  std::map<std::pair<KindPort, KindPort>, bool> seen_;
};

}  // namespace

std::unique_ptr<ReplacementFinder> make_brute_force(const DonorSet& donors,
                                                    const BruteForceOptions& options) {
  return std::make_unique<BruteForce>(donors, options);
}

}  // namespace geoprior::assembly
