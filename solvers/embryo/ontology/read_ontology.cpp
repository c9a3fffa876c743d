#include "solvers/embryo/ontology/read_ontology.h"

#include <algorithm>
#include <limits>
#include <map>

#include "core/error.h"
#include "solvers/embryo/ontology/geometry.h"
#include "solvers/embryo/ontology/typed_graph.h"

namespace geoprior::embryo {

namespace {

/// Reads a graph whose violations leave a model.
class OntologyReader {
 public:
  OntologyReader(const Graph& graph, const OntologySelection& selection, const std::string& where)
      : graph_(graph), selection_(selection), where_(where) {}

  Ontology read() {
    number_all();
    choose_set();
    read_stages();
    read_structures();
    read_keys();
    read_processes();
    read_diseases();
    read_measurements();
    read_crown_rump_length();
    return std::move(out_);
  }

 private:
  using Numbers = std::map<Term, int>;

  /// Of what refers to each other: places before anything is read.
  void number_all() {
    const auto number = [&](std::string_view class_name) {
      Numbers numbers;
      for (const Term node : graph_.instances(class_name))
        numbers.emplace(node, static_cast<int>(numbers.size()));
      return numbers;
    };
    structures_ = number("EmbryologicalEntity");
    processes_ = number("Process");
  }

  void choose_set() {
    std::string known;
    for (const Term node : graph_.instances("ParameterSet")) {
      const std::string name = local(node);
      out_.parameter_sets.push_back(name);
      known += (known.empty() ? "" : ", ") + name;
      if (name == selection_.parameter_set) set_ = node;
    }
    if (!set_ && !selection_.parameter_set.empty())
      throw Error("no parameter set '" + selection_.parameter_set + "'", where_, known);
  }

  void read_stages() {
    std::vector<std::pair<int, Term>> by_order;
    for (const Term node : graph_.instances("TemporalEntity"))
      by_order.emplace_back(static_cast<int>(*graph_.number(node, "order")), node);
    if (by_order.empty()) throw Error("no stage of the development", where_);
    std::ranges::sort(by_order);
    for (const auto& [order, node] : by_order) {
      stages_[node] = static_cast<int>(out_.stages.size());
      out_.stages.push_back({local(node), graph_.text(node, "rdfs:label"), order,
                             *graph_.number(node, "startDay"), *graph_.number(node, "endDay")});
    }
    const int shift = selection_.stage_shift;
    if (shift < 0 || shift >= static_cast<int>(out_.stages.size()))
      throw Error("a shift by " + std::to_string(shift) + " stages", where_,
                  "0 to " + std::to_string(out_.stages.size() - 1));
  }

  void read_structures() {
    for (const Term node : graph_.instances("EmbryologicalEntity")) {
      Structure structure;
      structure.name = local(node);
      structure.label = graph_.text(node, "rdfs:label");
      structure.side = graph_.text(node, "side");
      structure.kind = graph_.text(node, "kind");
      structure.from_stage = optional_place(stages_, node, "existsFrom");
      structure.until_stage = optional_place(stages_, node, "existsUntil");
      structure.part_of = places(structures_, node, "partOf");
      structure.develops_from = places(structures_, node, "developsFrom");
      structure.touches = places(structures_, node, "touches");
      structure.fused_with = places(structures_, node, "fusedWith");
      structure.blend = graph_.number(node, "blend").value_or(0);
      structure.mirror_of = optional_place(structures_, node, "mirrorOf");
      structure.crown_rump = graph_.flag(node, "crownRump");
      structure.regresses = graph_.flag(node, "regresses");
      out_.structures.push_back(std::move(structure));
    }
  }

  /// Those of all sets and of the chosen one. Where a shift moves a key onto a common one, the
  /// common one goes; a key that a shift moves beyond the last stage goes.
  void read_keys() {
    const int stages = static_cast<int>(out_.stages.size());
    for (const Term node : graph_.instances("SpatioTemporalEntity")) {
      const std::optional<Term> set = graph_.reference(node, "inSet");
      if (set && set != set_) continue;
      Key key;
      key.of_set = set.has_value();
      key.stage = *optional_place(stages_, node, "during") + shift_of(key.of_set);
      if (key.stage >= stages) continue;
      key.day = out_.stages[key.stage].middle();
      key.geometry = geometry_of(graph_, *graph_.reference(node, "geometry"), structures_);
      key.name = local(node);
      out_.structures[*optional_place(structures_, node, "of")].keys.push_back(std::move(key));
    }
    for (Structure& structure : out_.structures) {
      std::vector<Key>& keys = structure.keys;
      std::ranges::stable_sort(keys, [](const Key& a, const Key& b) {
        return a.stage != b.stage ? a.stage < b.stage : a.of_set > b.of_set;
      });
      const auto last = std::unique(keys.begin(), keys.end(),
                                    [](const Key& a, const Key& b) { return a.stage == b.stage; });
      keys.erase(last, keys.end());
    }
  }

  void read_processes() {
    for (const Term node : graph_.instances("Process")) {
      const std::optional<Term> set = graph_.reference(node, "inSet");
      ProcessEntry process;
      process.name = local(node);
      process.label = graph_.text(node, "rdfs:label");
      process.kind = kind_of(node);
      process.acts_on = places(structures_, node, "actsOn");
      process.produces = places(structures_, node, "produces");
      process.fuses = places(structures_, node, "fuses");
      process.requires_ = places(processes_, node, "requires");
      process.dormant = graph_.flag(node, "dormant");
      process.of_set = set.has_value();
      read_span(node, process);
      read_parameters(node, process);
      out_.processes.push_back(std::move(process));
      is_chosen_.push_back(!set || set == set_);
    }
    leave_out_other_sets();
  }

  /// A shift keeps the span's stages among those that there are, and a span of time a span.
  void read_span(Term node, ProcessEntry& process) const {
    const int last = static_cast<int>(out_.stages.size()) - 1;
    const int from = *optional_place(stages_, node, "from");
    const int to = *optional_place(stages_, node, "to");
    const int shift = shift_of(process.of_set);
    process.to_stage = std::min(to + shift, last);
    process.from_stage = std::min(from + shift, process.to_stage - (to > from ? 1 : 0));
  }

  void read_parameters(Term node, ProcessEntry& process) const {
    const auto direction = [&](std::string_view name, const Eigen::Vector3d& usual) {
      return graph_.vector(node, name).value_or(usual).normalized().eval();
    };
    process.about = direction("about", process.about);
    process.normal = direction("normal", process.normal);
    process.descent = direction("descent", process.descent);
    process.angle = graph_.number(node, "angle").value_or(0);
    process.within = graph_.number(node, "within").value_or(0);
    process.thickness = graph_.number(node, "thickness").value_or(0);
    process.blend = graph_.number(node, "blend").value_or(0);
    process.inducer = optional_place(structures_, node, "inducer");
    process.target = optional_place(structures_, node, "target");
    process.positive = optional_place(structures_, node, "positive");
    process.septum = optional_place(structures_, node, "septum");
    process.stops_at = optional_place(structures_, node, "stopsAt");
  }

  /// Processes of the sets that were not chosen go, and with them what refers to them.
  void leave_out_other_sets() {
    std::vector<ProcessEntry> kept;
    new_place_.assign(out_.processes.size(), -1);
    for (int i = 0; i < static_cast<int>(out_.processes.size()); ++i) {
      if (!is_chosen_[i]) continue;
      new_place_[i] = static_cast<int>(kept.size());
      kept.push_back(std::move(out_.processes[i]));
    }
    out_.processes = std::move(kept);
    for (ProcessEntry& process : out_.processes) process.requires_ = kept_of(process.requires_);
  }

  [[nodiscard]] std::vector<int> kept_of(const std::vector<int>& processes) const {
    std::vector<int> kept;
    for (const int process : processes) {
      if (new_place_[process] >= 0) kept.push_back(new_place_[process]);
    }
    return kept;
  }

  void read_diseases() {
    for (const Term node : graph_.instances("Disease")) {
      out_.diseases.push_back({local(node), graph_.text(node, "rdfs:label"),
                               graph_.text(node, "side"),
                               kept_of(places(processes_, node, "disables")),
                               kept_of(places(processes_, node, "enables"))});
    }
  }

  void read_measurements() {
    for (const Term node : graph_.instances("Measurement")) {
      Measurement measurement;
      measurement.name = local(node);
      measurement.quantity = graph_.text(node, "quantity");
      measurement.structure = optional_place(structures_, node, "of");
      measurement.stage = *optional_place(stages_, node, "during");
      read_range(node, measurement);
      const auto quantities = vocabulary_quantities();
      const Dimension dimension =
          std::ranges::find(quantities, measurement.quantity, &Quantity::name)->dimension;
      measurement.unit = dimension == Dimension::length  ? "m"
                         : dimension == Dimension::angle ? "rad"
                                                         : "1";
      for (const Term source : graph_.references(node, "source"))
        measurement.source += (measurement.source.empty() ? "" : ", ") + local(source);
      for (const Term set : graph_.references(node, "inputOf"))
        measurement.input_of.push_back(local(set));
      std::ranges::sort(measurement.input_of);
      out_.measurements.push_back(std::move(measurement));
    }
  }

  /// A range of which one end is not given is open there.
  void read_range(Term node, Measurement& measurement) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const std::optional<double> low = graph_.number(node, "low");
    const std::optional<double> high = graph_.number(node, "high");
    const std::optional<double> mean = graph_.number(node, "mean");
    measurement.deviation = graph_.number(node, "deviation").value_or(0);
    if (mean) {
      measurement.mean = *mean;
      measurement.low = low.value_or(*mean - measurement.deviation);
      measurement.high = high.value_or(*mean + measurement.deviation);
      return;
    }
    measurement.low = low.value_or(-kInfinity);
    measurement.high = high.value_or(kInfinity);
    if (!low || !high) {
      measurement.mean = low ? *low : *high;
      return;
    }
    measurement.mean = (*low + *high) / 2;
    measurement.deviation = (*high - *low) / 2;
  }

  void read_crown_rump_length() {
    for (const Structure& structure : out_.structures) {
      if (!structure.crown_rump) continue;
      for (const Key& key : structure.keys)
        out_.crown_rump_length.emplace_back(key.day, 2 * key.geometry.radii.z());
    }
    if (out_.crown_rump_length.empty())
      throw Error("no structure has the crown-rump length", where_,
                  "a line with the property crownRump");
  }

  [[nodiscard]] ProcessKind kind_of(Term node) const {
    if (graph_.is_a(node, "Migration")) return ProcessKind::migration;
    if (graph_.is_a(node, "Rotation")) return ProcessKind::rotation;
    if (graph_.is_a(node, "Interaction")) return ProcessKind::interaction;
    if (graph_.is_a(node, "Division")) return ProcessKind::division;
    if (graph_.is_a(node, "Fixation")) return ProcessKind::fixation;
    return ProcessKind::growth;
  }

  [[nodiscard]] int shift_of(bool of_set) const { return of_set ? selection_.stage_shift : 0; }

  [[nodiscard]] std::string local(Term node) const {
    return graph_.graph().dictionary().local_name(node);
  }

  [[nodiscard]] std::vector<int> places(const Numbers& numbers, Term node,
                                        std::string_view property) const {
    std::vector<int> out;
    for (const Term found : graph_.references(node, property)) out.push_back(numbers.at(found));
    std::ranges::sort(out);
    return out;
  }

  [[nodiscard]] std::optional<int> optional_place(const Numbers& numbers, Term node,
                                                  std::string_view property) const {
    const std::optional<Term> found = graph_.reference(node, property);
    if (!found) return std::nullopt;
    return numbers.at(*found);
  }

  TypedGraph graph_;
  const OntologySelection& selection_;
  const std::string& where_;
  Numbers stages_, structures_, processes_;
  std::optional<Term> set_;
  std::vector<char> is_chosen_;  ///< of each process of the graph
  std::vector<int> new_place_;   ///< of each process of the graph, or -1
  Ontology out_;
};

}  // namespace

Ontology make_ontology(const Graph& graph, const OntologySelection& selection,
                       const std::string& where) {
  return OntologyReader(graph, selection, where).read();
}

}  // namespace geoprior::embryo
