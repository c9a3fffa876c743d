#include "models/assembly/search/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <string_view>
#include <utility>

#include "core/state_bytes.h"
#include "models/assembly/isomorphism/traversal.h"

namespace geoprior::assembly {

void describe(OptionVisitor& v, SearchOptions& options) {
  v.value("count", options.count,
          {.doc = "variations after which the search ends", .min = 1, .max = 100000});
  v.value("generations", options.generations,
          {.doc = "replacements one after the other that a variation may be of an input",
           .min = 1,
           .max = 1000});
  v.value("pool", options.pool,
          {.doc = "most variations that are taken of one assembly before they are ranked",
           .min = 1,
           .max = 100000});
  v.value("candidates", options.candidates,
          {.doc = "replacements that are looked at before the search ends", .min = 1, .max = 1e12});
  constexpr std::array<std::string_view, 3> kOrders = {"varied", "found", "best"};
  describe_choice(v, "order", options.order, kOrders,
                  {.doc = "whether the next variation is the least like those before, the next one "
                          "found, or one that is better than all before by `scene.guide`"});
}

namespace {

/// Most variations of one removed substructure.
constexpr int kMostOfOne = 3;
/// Candidates between two looks whether the run is to stop.
constexpr int kBetweenStops = 256;

/// Where misfits are spread over all joints, a seam may be off by as many tolerances before as a
/// loop has joints: no more than two models have.
JointTolerance seam_tolerance(const AssemblyInput& input) {
  double reach = 1;
  if (input.rules.relax)
    for (const Assembly& model : input.set.models)
      reach = std::max(reach, 2. * static_cast<double>(model.connections.size()));
  return {reach * input.rules.tolerance.translation, reach * input.rules.tolerance.angle_deg};
}

}  // namespace

VariationSearch::VariationSearch(const AssemblyInput& input, bool symmetries,
                                 const SearchOptions& options)
    : input_(input),
      symmetries_(symmetries),
      options_(options),
      objective_(input.guide, input.set.types),
      filter_(input, seam_tolerance(input), symmetries) {
  for (const Assembly& model : input.set.models)
    made_.insert(isomorphism_key(model, input.set.types, symmetries));
}

bool VariationSearch::is_new(const Assembly& assembly) {
  if (made_.insert(isomorphism_key(assembly, input_.set.types, symmetries_)).second) return true;
  ++counts_.duplicates;
  return false;
}

bool VariationSearch::keeps_rules(Variation& variation) {
  put_on_floor(variation.assembly, input_.set.types, input_.rules);
  const Filter filter = first_broken(variation.assembly, input_.set.types, input_.rules);
  ++counts_.broken[static_cast<std::size_t>(filter)];
  if (filter != Filter::none) return false;
  ++counts_.valid;
  return true;
}

bool VariationSearch::accept(Variation& variation) {
  return is_new(variation.assembly) && keeps_rules(variation);
}

bool VariationSearch::consider(const Variation& state, const Replacement& replacement,
                               Variation& out) {
  Replaced replaced = replace(state.assembly, input_.set.models[replacement.donor], replacement);
  if (!is_new(replaced.assembly)) return false;
  out = varied(state, input_.set, replacement, std::move(replaced));
  return keeps_rules(out);
}

std::vector<Variation> VariationSearch::expand(const Variation& state, ReplacementFinder& finder,
                                               RunContext& context, int most) {
  std::vector<Variation> out;
  ++counts_.states;
  filter_.begin(state.assembly);
  int removed_number = -1;
  bool keeps = true;
  int of_one = 0, since_look = 0;
  finder.find(state.assembly, [&](const Replacement& replacement) {
    if (is_spent() || (++since_look % kBetweenStops == 0 && context.stop_requested())) return false;
    ++counts_.candidates;
    if (replacement.removed_number != removed_number) {
      removed_number = replacement.removed_number;
      of_one = 0;
      const std::vector<int> parts = replacement.removed.parts.parts();
      keeps = std::none_of(parts.begin(), parts.end(), [&](int part) {
        return objective_.keeps(state.assembly.parts[part].type);
      });
    }
    if (!keeps || of_one >= kMostOfOne || !passes_filter(state.assembly, replacement)) return true;
    Variation next;
    if (!consider(state, replacement, next)) return true;
    ++of_one;
    out.push_back(std::move(next));
    return static_cast<int>(out.size()) < most;
  });
  return out;
}

bool VariationSearch::passes_filter(const Assembly& host, const Replacement& replacement) {
  if (options_.prefilter && filter_.look(host, replacement) != SeamFilter::Verdict::passes)
    return false;
  ++counts_.closing;
  return true;
}

VariationFrames::VariationFrames(const AssemblyInput& input, FrameSink& sink,
                                 const std::optional<State>& resumed)
    : input_(input), sink_(sink) {
  if (!resumed) return;
  StateReader in(*resumed);
  done_ = in.number<int>();
  in.require_end();
}

void VariationFrames::push(Frame frame) {
  if (frames_++ < done_) return;
  sink_.frame(std::move(frame));
  StateWriter out;
  out.number(frames_);
  sink_.checkpoint(out.take());
}

void VariationFrames::push_inputs() {
  const int n = static_cast<int>(input_.set.models.size());
  for (int i = 0; i < n; ++i)
    push(assembly_frame(i + 1 - n, unchanged(input_.set.models[i]), input_.set.types, nullptr));
}

void VariationFrames::push(const Variation& variation, const SearchCounts& counts) {
  push(assembly_frame(++variations_, variation, input_.set.types, &counts));
}

namespace {

/// How often each kind of part, and each pair of joined kinds, occurs.
using Features = std::map<std::pair<int, int>, double>;

Features features_of(const Assembly& assembly) {
  Features out;
  for (const PlacedPart& part : assembly.parts) ++out[{part.type, -1}];
  for (const auto& [a, b] : assembly.connections)
    ++out[std::minmax(assembly.parts[a.part].type, assembly.parts[b.part].type)];
  return out;
}

/// Sum of absolute differences.
double distance(const Features& a, const Features& b) {
  double sum = 0;
  for (const auto& [key, n] : a) {
    const auto found = b.find(key);
    sum += std::abs(n - (found == b.end() ? 0 : found->second));
  }
  for (const auto& [key, n] : b)
    if (a.find(key) == a.end()) sum += n;
  return sum;
}

class VariationProcess final : public Process {
 public:
  VariationProcess(const AssemblyInput& input, FinderFactory factory, bool symmetries,
                   const SearchOptions& options)
      : input_(input), factory_(std::move(factory)), symmetries_(symmetries), options_(options) {}

  void run(FrameSink& sink, RunContext& context, const std::optional<State>& resumed) override {
    const Compatibility compatibility(input_.set, symmetries_);
    DonorSet donors{&input_.set, &compatibility, {}};
    for (std::size_t i = 0; i < input_.set.models.size(); ++i)
      donors.donors.push_back(static_cast<int>(i));
    VariationFrames frames(input_, sink, resumed);
    frames.push_inputs();
    const std::unique_ptr<ReplacementFinder> finder = factory_(donors, false, context);
    VariationSearch search(input_, symmetries_, options_);
    if (options_.order == Order::best)
      best_first(search, *finder, frames, context);
    else
      by_generations(search, *finder, frames, context);
  }

 private:
  [[nodiscard]] std::vector<Variation> inputs() const {
    std::vector<Variation> out;
    for (const Assembly& model : input_.set.models) out.push_back(unchanged(model));
    return out;
  }

  [[nodiscard]] bool is_done(const VariationSearch& search, const VariationFrames& frames,
                             const RunContext& context) const {
    return frames.count() >= options_.count || search.is_spent() || context.stop_requested();
  }

  void by_generations(VariationSearch& search, ReplacementFinder& finder, VariationFrames& frames,
                      RunContext& context) const {
    std::vector<Variation> states = inputs();
    std::vector<Features> shown;
    for (const Variation& v : states) shown.push_back(features_of(v.assembly));
    for (int generation = 0; generation < options_.generations; ++generation) {
      std::vector<Variation> next;
      for (const Variation& state : states) {
        if (is_done(search, frames, context)) return;
        const Phase phase(context, "search");
        for (Variation& v : search.expand(state, finder, context, options_.pool)) {
          if (options_.order == Order::found && frames.count() < options_.count)
            frames.push(v, search.counts());
          next.push_back(std::move(v));
        }
      }
      if (options_.order == Order::varied) show_varied(next, shown, search, frames, context);
      context.progress(static_cast<double>(frames.count()) / options_.count);
      if (next.empty()) return;
      states = std::move(next);
    }
  }

  /// The least like all that were shown, again and again; those that are not needed stay in the
  /// generation.
  void show_varied(const std::vector<Variation>& found, std::vector<Features>& shown,
                   const VariationSearch& search, VariationFrames& frames,
                   const RunContext& context) const {
    std::vector<Features> features;
    for (const Variation& v : found) features.push_back(features_of(v.assembly));
    std::vector<double> nearest(found.size(), std::numeric_limits<double>::infinity());
    const auto see = [&](const Features& f) {
      for (std::size_t i = 0; i < nearest.size(); ++i)
        nearest[i] = std::min(nearest[i], distance(features[i], f));
    };
    for (const Features& f : shown) see(f);
    std::vector<char> taken(found.size(), 0);
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (frames.count() >= options_.count || context.stop_requested()) return;
      std::size_t best = found.size();
      for (std::size_t i = 0; i < found.size(); ++i)
        if (!taken[i] && (best == found.size() || nearest[i] > nearest[best])) best = i;
      taken[best] = 1;
      frames.push(found[best], search.counts());
      shown.push_back(features[best]);
      see(features[best]);
    }
  }

  void best_first(VariationSearch& search, ReplacementFinder& finder, VariationFrames& frames,
                  RunContext& context) const {
    struct Entry {
      double objective;
      std::size_t number;
      bool operator<(const Entry& other) const {
        return std::pair(objective, number) > std::pair(other.objective, other.number);
      }
    };
    std::priority_queue<Entry> queue;
    std::vector<Variation> states;
    double best = std::numeric_limits<double>::infinity();
    const auto add = [&](Variation v) {
      const double value = search.objective()(v.assembly);
      if (value < best) {
        best = value;
        if (v.depth > 0) frames.push(v, search.counts());
      }
      queue.push({value, states.size()});
      states.push_back(std::move(v));
    };
    for (Variation& v : inputs()) add(std::move(v));
    while (!queue.empty() && !is_done(search, frames, context)) {
      const std::size_t number = queue.top().number;
      queue.pop();
      if (states[number].depth >= options_.generations) continue;
      const Phase phase(context, "search");
      for (Variation& v : search.expand(states[number], finder, context, options_.pool)) {
        if (frames.count() >= options_.count) break;
        add(std::move(v));
      }
      context.progress(search.counts().candidates / options_.candidates);
    }
  }

  const AssemblyInput& input_;
  FinderFactory factory_;
  bool symmetries_;
  SearchOptions options_;
};

}  // namespace

std::unique_ptr<Process> variation_process(const AssemblyInput& input, FinderFactory factory,
                                           bool symmetries, const SearchOptions& options) {
  return std::make_unique<VariationProcess>(input, std::move(factory), symmetries, options);
}

}  // namespace geoprior::assembly
