#include "solvers/embryo/ontology/typed_graph.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <set>
#include <utility>

namespace geoprior::embryo {

namespace {

constexpr int kLongestList = 10'000;

std::string full_name(std::string_view name) {
  for (const auto& [prefix, iri] :
       {std::pair<std::string_view, std::string_view>{"rdfs:", kRdfs}, {"skos:", kSkos}}) {
    if (name.starts_with(prefix)) return std::string(iri).append(name.substr(prefix.size()));
  }
  return std::string(kNamespace).append(name);
}

bool is_numeric(std::string_view datatype) {
  if (!datatype.starts_with(kXsd)) return false;
  return is_among(datatype.substr(kXsd.size()),
                  "integer decimal double float int long short nonNegativeInteger positiveInteger");
}

}  // namespace

std::optional<double> number_of(const Dictionary& dictionary, Term term) {
  if (dictionary.kind(term) != Dictionary::Kind::literal) return std::nullopt;
  if (!is_numeric(dictionary.datatype(term))) return std::nullopt;
  std::string_view text = dictionary.text(term);
  if (text.starts_with('+')) text.remove_prefix(1);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (text == "INF") return kInfinity;
  if (text == "-INF") return -kInfinity;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || text.empty()) return std::nullopt;
  if (error == std::errc::result_out_of_range) return kInfinity;
  if (error != std::errc()) return std::nullopt;
  return value;
}

bool is_integer(const Dictionary& dictionary, Term term) {
  const std::optional<double> value = number_of(dictionary, term);
  return value && std::abs(*value) < 1e6 && *value == static_cast<int>(*value);
}

std::optional<bool> boolean_of(const Dictionary& dictionary, Term term) {
  if (dictionary.datatype(term) != std::string(kXsd).append("boolean")) return std::nullopt;
  const std::string& text = dictionary.text(term);
  if (text == "true" || text == "1") return true;
  if (text == "false" || text == "0") return false;
  return std::nullopt;
}

TypedGraph::TypedGraph(const Graph& graph)
    : graph_(&graph),
      type_(graph.dictionary().find_iri(std::string(kRdf) + "type")),
      subclass_(graph.dictionary().find_iri(std::string(kRdfs) + "subClassOf")),
      first_(graph.dictionary().find_iri(std::string(kRdf) + "first")),
      rest_(graph.dictionary().find_iri(std::string(kRdf) + "rest")),
      nil_(graph.dictionary().find_iri(std::string(kRdf) + "nil")),
      class_of_(graph.dictionary().size(), kNone),
      property_of_(graph.dictionary().size(), kNone) {
  resolve_classes();
  resolve_properties();
}

void TypedGraph::resolve_classes() {
  if (!type_) return;
  std::map<Term, int> known;
  for (const Triple& triple : graph_->with_predicate(*type_)) {
    const auto [entry, added] = known.try_emplace(triple.object, kNone);
    if (added) entry->second = class_named(triple.object);
    int& at = class_of_[triple.subject];
    const int found = entry->second;
    const bool is_better =
        at < 0 ? found >= 0 || at == kNone : found >= 0 && found != at && is_subclass(found, at);
    if (is_better) at = found;
  }
}

void TypedGraph::resolve_properties() {
  const Dictionary& dictionary = graph_->dictionary();
  const int classes = static_cast<int>(vocabulary_classes().size());
  rows_of_class_.resize(classes);
  for (const PropertyEntry& entry : vocabulary_properties()) {
    const auto [name, added] = names_.try_emplace(entry.name, static_cast<int>(names_.size()));
    if (added) {
      row_.emplace_back(classes, nullptr);
      const std::optional<Term> term = dictionary.find_iri(full_name(entry.name));
      term_of_name_.push_back(term.value_or(-1));
      if (term) property_of_[*term] = name->second;
    }
    for (int c = 0; c < classes; ++c) {
      for (std::optional<int> at = c; at; at = find_class(vocabulary_classes()[*at].parent)) {
        if (is_among(vocabulary_classes()[*at].name, entry.domain)) row_[name->second][c] = &entry;
      }
      if (row_[name->second][c] == &entry) rows_of_class_[c].push_back(&entry);
    }
  }
}

int TypedGraph::class_named(Term type) const {
  const Dictionary& dictionary = graph_->dictionary();
  std::vector<Term> open = {type};
  std::set<Term> seen = {type};
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (dictionary.is_ours(open[i])) {
      const std::string name = dictionary.local_name(open[i]);
      if (const std::optional<int> found = find_class(name)) return *found;
    }
    if (!subclass_) continue;
    for (const Term parent : graph_->objects(open[i], *subclass_)) {
      if (seen.insert(parent).second) open.push_back(parent);
    }
  }
  return dictionary.is_ours(type) ? kUnknown : kNone;
}

bool TypedGraph::is_a(Term node, std::string_view class_name) const {
  const int found = class_of(node);
  return found >= 0 && is_subclass(found, find_class(class_name).value());
}

std::vector<Term> TypedGraph::instances(std::string_view class_name) const {
  const int asked = find_class(class_name).value();
  std::vector<char> is_asked(vocabulary_classes().size());
  for (int c = 0; c < static_cast<int>(is_asked.size()); ++c) is_asked[c] = is_subclass(c, asked);
  std::vector<std::pair<std::string, Term>> named;
  for (Term node = 0; node < static_cast<int>(class_of_.size()); ++node) {
    if (class_of_[node] >= 0 && is_asked[class_of_[node]])
      named.emplace_back(graph_->dictionary().local_name(node), node);
  }
  std::ranges::sort(named);
  std::vector<Term> nodes;
  for (const auto& entry : named) nodes.push_back(entry.second);
  return nodes;
}

const PropertyEntry* TypedGraph::row(int class_number, Term predicate) const {
  const int name = property_of_[predicate];
  return name < 0 || class_number < 0 ? nullptr : row_[name][class_number];
}

std::optional<Term> TypedGraph::property(std::string_view name) const {
  const int term = term_of_name_[names_.at(name)];
  if (term < 0) return std::nullopt;
  return term;
}

TermRange TypedGraph::values(Term node, std::string_view name) const {
  const std::optional<Term> predicate = property(name);
  return predicate ? graph_->objects(node, *predicate) : TermRange();
}

bool TypedGraph::has(Term node, std::string_view name) const { return !values(node, name).empty(); }

std::optional<Term> TypedGraph::value(Term node, std::string_view name) const {
  const TermRange found = values(node, name);
  if (found.empty()) return std::nullopt;
  return found[0];
}

std::string TypedGraph::text(Term node, std::string_view name) const {
  const std::optional<Term> found = value(node, name);
  return found ? graph_->dictionary().text(*found) : std::string();
}

bool TypedGraph::flag(Term node, std::string_view name) const {
  const std::optional<Term> found = value(node, name);
  return found && boolean_of(graph_->dictionary(), *found).value_or(false);
}

std::optional<double> TypedGraph::number(Term node, std::string_view name) const {
  const std::optional<Term> found = value(node, name);
  const std::optional<double> number =
      found ? number_of(graph_->dictionary(), *found) : std::nullopt;
  if (!number) return std::nullopt;
  const PropertyEntry* entry = row(class_of(node), *property(name));
  const Unit* given = entry ? unit(node, dimension_of(node, *entry)) : nullptr;
  return *number * (given ? given->factor : 1);
}

std::optional<std::vector<double>> TypedGraph::numbers(Term node, std::string_view name) const {
  const std::optional<Term> head = value(node, name);
  const std::optional<std::vector<Term>> items = head ? list(*head) : std::nullopt;
  if (!items) return std::nullopt;
  const PropertyEntry* entry = row(class_of(node), *property(name));
  const Unit* given = entry ? unit(node, dimension_of(node, *entry)) : nullptr;
  std::vector<double> out;
  for (const Term item : *items) {
    const std::optional<double> number = number_of(graph_->dictionary(), item);
    if (!number) return std::nullopt;
    out.push_back(*number * (given ? given->factor : 1));
  }
  return out;
}

std::optional<Eigen::Vector3d> TypedGraph::vector(Term node, std::string_view name) const {
  const std::optional<std::vector<double>> found = numbers(node, name);
  if (!found || found->size() != 3) return std::nullopt;
  return Eigen::Vector3d((*found)[0], (*found)[1], (*found)[2]);
}

std::vector<Term> TypedGraph::references(Term node, std::string_view name) const {
  std::vector<Term> out;
  for (const Term found : values(node, name)) {
    const PropertyEntry* entry = row(class_of(node), *property(name));
    if (entry && is_a(found, entry->range)) out.push_back(found);
  }
  return out;
}

std::optional<Term> TypedGraph::reference(Term node, std::string_view name) const {
  const std::vector<Term> found = references(node, name);
  if (found.empty()) return std::nullopt;
  return found.front();
}

const Unit* TypedGraph::unit(Term node, Dimension dimension) const {
  const Unit* found = nullptr;
  for (const Term text : values(node, "unit")) {
    const auto units = vocabulary_units();
    const auto entry = std::ranges::find(units, graph_->dictionary().text(text), &Unit::name);
    if (entry == units.end() || entry->dimension != dimension) continue;
    if (found != nullptr) return nullptr;
    found = &*entry;
  }
  return found;
}

Dimension TypedGraph::dimension_of(Term node, const PropertyEntry& entry) const {
  if (entry.dimension != Dimension::of_quantity) return entry.dimension;
  const auto quantities = vocabulary_quantities();
  const auto found = std::ranges::find(quantities, text(node, "quantity"), &Quantity::name);
  return found == quantities.end() ? Dimension::ratio : found->dimension;
}

std::optional<std::vector<Term>> TypedGraph::list(Term head) const {
  std::vector<Term> items;
  for (Term cell = head; cell != nil_;) {
    const TermRange item = first_ ? graph_->objects(cell, *first_) : TermRange();
    const TermRange rest = rest_ ? graph_->objects(cell, *rest_) : TermRange();
    if (item.size() != 1 || rest.size() != 1 || items.size() == kLongestList) return std::nullopt;
    items.push_back(item[0]);
    cell = rest[0];
  }
  return items;
}

std::string TypedGraph::name_of(Term node) const {
  const Dictionary& dictionary = graph_->dictionary();
  const std::optional<Term> geometry = property("geometry");
  if (dictionary.kind(node) == Dictionary::Kind::blank && geometry) {
    const TermRange keys = graph_->subjects(*geometry, node);
    if (!keys.empty()) return "geometry of " + dictionary.local_name(keys[0]);
  }
  return dictionary.local_name(node);
}

int TypedGraph::line(Term node, std::string_view name) const {
  const std::optional<Term> predicate = name.empty() ? std::nullopt : property(name);
  const int of_property = predicate ? graph_->line_of(node, *predicate) : 0;
  return of_property > 0 ? of_property : graph_->line_of(node);
}

}  // namespace geoprior::embryo
