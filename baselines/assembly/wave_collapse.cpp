#include "baselines/assembly/wave_collapse.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "models/assembly/graph/labels.h"
#include "models/assembly/search/search.h"

namespace geoprior::assembly {

void describe(OptionVisitor& v, WaveCollapseOptions& options) {
  v.value("count", options.count,
          {.doc = "variations after which the search ends", .min = 1, .max = 100000});
  v.value("attempts", options.attempts,
          {.doc = "times that it begins again before it gives up", .min = 1, .max = 1e8});
  v.value(
      "parts", options.parts,
      {.doc = "most parts of an assembly before an attempt is given up", .min = 1, .max = 100000});
  v.value("symmetries", options.symmetries,
          {.doc = "whether ports that a symmetry of their part exchanges are alike"});
}

namespace {

/// A port of a kind of part; `kOpenEnd` for none.
struct PortKind {
  int type = 0, port = 0;
  auto operator<=>(const PortKind&) const = default;
};
constexpr PortKind kOpenEnd{-1, -1};

/// How often each class of ports was seen joined with a port, or open.
using Choices = std::map<PortKind, double>;

std::vector<Choices> seen_choices(const AssemblySet& set, const Compatibility& compatibility) {
  std::vector<Choices> out(compatibility.class_count());
  for (const Assembly& model : set.models) {
    const auto kind = [&](PortRef ref) { return PortKind{model.parts[ref.part].type, ref.port}; };
    for (const auto& [a, b] : model.connections) {
      ++out[compatibility.port_class(model, a)][kind(b)];
      ++out[compatibility.port_class(model, b)][kind(a)];
    }
    const Links links(model, set.types);
    for (int part = 0; part < static_cast<int>(model.parts.size()); ++part)
      for (int port = 0; port < links.port_count(part); ++port)
        if (links.connection({part, port}) < 0)
          ++out[compatibility.port_class(model, {part, port})][kOpenEnd];
  }
  return out;
}

/// One attempt: an assembly that grows until no port is undecided.
class Collapse {
 public:
  Collapse(const AssemblyInput& input, const Compatibility& compatibility,
           const std::vector<Choices>& choices, int parts, RandomStream& random)
      : input_(input),
        types_(input.set.types),
        compatibility_(compatibility),
        choices_(choices),
        most_parts_(parts),
        random_(random) {}

  std::optional<Assembly> run(const PlacedPart& seed) {
    add_part(seed);
    while (!undecided_.empty()) {
      const std::optional<std::size_t> next = least_choices();
      if (!next || !decide(*next)) return std::nullopt;
    }
    return std::move(assembly_);
  }

 private:
  struct Undecided {
    PortRef ref;
    /// Those that are still possible, with weights.
    std::vector<std::pair<PortKind, double>> choices;
  };

  void add_part(const PlacedPart& part) {
    const int number = static_cast<int>(assembly_.parts.size());
    assembly_.parts.push_back(part);
    for (int port = 0; port < static_cast<int>(types_[part.type].ports.size()); ++port) {
      const PortRef ref{number, port};
      if (join_if_met(ref)) continue;
      Undecided& u = undecided_.emplace_back(Undecided{ref, {}});
      for (const auto& [kind, weight] : choices_[compatibility_.port_class(part.type, port)])
        u.choices.emplace_back(kind, weight);
    }
  }

  bool join_if_met(PortRef ref) {
    const Pose pose = port_pose(assembly_, types_, ref);
    for (std::size_t i = 0; i < undecided_.size(); ++i) {
      const PortRef other = undecided_[i].ref;
      if (!within(misfit(pose, port_pose(assembly_, types_, other)), input_.rules.tolerance) ||
          !compatibility_.observed(compatibility_.port_class(assembly_, ref),
                                   compatibility_.port_class(assembly_, other)))
        continue;
      assembly_.connections.push_back({other, ref});
      undecided_.erase(undecided_.begin() + static_cast<std::ptrdiff_t>(i));
      return true;
    }
    return false;
  }

  [[nodiscard]] PlacedPart placed(PortRef at, PortKind kind) const {
    return {kind.type, mated(port_pose(assembly_, types_, at)) *
                           types_[kind.type].ports[kind.port].frame.inverse()};
  }

  [[nodiscard]] bool has_room(const PlacedPart& part, int joined) const {
    if (!input_.rules.grounded.empty() &&
        lowest_point(types_[part.type], part.pose) < -input_.rules.ground_tolerance)
      return false;
    if (!input_.rules.collisions) return true;
    for (int other = 0; other < static_cast<int>(assembly_.parts.size()); ++other) {
      if (other == joined) continue;
      const PlacedPart& there = assembly_.parts[other];
      for (const Box& a : types_[part.type].boxes)
        for (const Box& b : types_[there.type].boxes)
          if (boxes_meet(a, part.pose, b, there.pose, input_.rules.clearance)) return false;
    }
    return true;
  }

  /// The undecided port with the fewest choices, after those without room are gone; none when a
  /// port has no choice left.
  std::optional<std::size_t> least_choices() {
    std::size_t best = 0;
    for (std::size_t i = 0; i < undecided_.size(); ++i) {
      Undecided& u = undecided_[i];
      std::erase_if(u.choices, [&](const auto& choice) {
        return choice.first != kOpenEnd && !has_room(placed(u.ref, choice.first), u.ref.part);
      });
      if (u.choices.empty()) return std::nullopt;
      if (u.choices.size() < undecided_[best].choices.size()) best = i;
    }
    return best;
  }

  bool decide(std::size_t i) {
    const Undecided u = undecided_[i];
    double sum = 0;
    for (const auto& [kind, weight] : u.choices) sum += weight;
    double at = random_.uniform() * sum;
    PortKind chosen = u.choices.back().first;
    for (const auto& [kind, weight] : u.choices) {
      at -= weight;
      if (at >= 0) continue;
      chosen = kind;
      break;
    }
    if (chosen == kOpenEnd) {
      undecided_.erase(undecided_.begin() + static_cast<std::ptrdiff_t>(i));
      return true;
    }
    if (static_cast<int>(assembly_.parts.size()) >= most_parts_) return false;
    add_part(placed(u.ref, chosen));
    return true;
  }

  const AssemblyInput& input_;
  const std::vector<PartType>& types_;
  const Compatibility& compatibility_;
  const std::vector<Choices>& choices_;
  int most_parts_;
  RandomStream& random_;
  Assembly assembly_;
  std::vector<Undecided> undecided_;
};

class WaveCollapse final : public Process {
 public:
  WaveCollapse(const AssemblyInput& input, const WaveCollapseOptions& options)
      : input_(input), options_(options) {}

  void run(FrameSink& sink, RunContext& context, const std::optional<State>& resumed) override {
    const Compatibility compatibility(input_.set, options_.symmetries);
    const std::vector<Choices> choices = seen_choices(input_.set, compatibility);
    RandomStream random = context.random("wave collapse");
    VariationFrames frames(input_, sink, resumed);
    frames.push_inputs();
    SearchOptions search_options;
    search_options.candidates = 1e12;
    VariationSearch search(input_, options_.symmetries, search_options);
    SearchCounts counts;
    for (int i = 0; i < options_.attempts && frames.count() < options_.count; ++i) {
      if (context.stop_requested()) return;
      const Phase phase(context, "search");
      Collapse collapse(input_, compatibility, choices, options_.parts, random);
      std::optional<Assembly> made = collapse.run(seed(random));
      ++counts.candidates;
      if (!made) continue;
      Variation variation{std::move(*made), {}, 1};
      variation.origin.assign(variation.assembly.parts.size(), 0);
      if (!search.accept(variation)) continue;
      const double candidates = counts.candidates;
      counts = search.counts();
      counts.candidates = candidates;
      frames.push(variation, counts);
      context.progress(static_cast<double>(frames.count()) / options_.count);
    }
  }

 private:
  PlacedPart seed(RandomStream& random) const {
    const auto models = static_cast<std::uint32_t>(input_.set.models.size());
    const Assembly& model = input_.set.models[random.below(models)];
    if (input_.rules.entries)
      for (const PlacedPart& part : model.parts) {
        if (is_among(input_.rules.entries->labels, input_.set.types[part.type].label)) return part;
      }
    return model.parts[random.below(static_cast<std::uint32_t>(model.parts.size()))];
  }

  const AssemblyInput& input_;
  WaveCollapseOptions options_;
};

}  // namespace

std::unique_ptr<Process> make_wave_collapse(const AssemblyInput& input,
                                            const WaveCollapseOptions& options) {
  return std::make_unique<WaveCollapse>(input, options);
}

}  // namespace geoprior::assembly
