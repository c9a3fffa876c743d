#include "solvers/embryo/queries/queries.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <utility>

#include "solvers/embryo/ontology/vocabulary.h"

namespace geoprior::embryo {
namespace {

Term standard_term(const Graph& graph, std::string_view prefix, std::string_view local) {
  return graph.dictionary().find_iri(std::string(prefix) + std::string(local)).value_or(-1);
}

/// Value of a number's text; 0 where it is none, which consistency checks refuse.
template <class Number>
Number number_in(const Graph& graph, std::optional<Term> term) {
  if (!term) return 0;
  std::string_view text = graph.dictionary().text(*term);
  if (text.starts_with('+')) text.remove_prefix(1);
  Number value{};
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// The numeric types of SPARQL 1.1, 17.1.
bool is_numeric_type(std::string_view datatype) {
  constexpr std::array<std::string_view, 16> kNumeric = {"integer",
                                                         "decimal",
                                                         "float",
                                                         "double",
                                                         "nonPositiveInteger",
                                                         "negativeInteger",
                                                         "long",
                                                         "int",
                                                         "short",
                                                         "byte",
                                                         "nonNegativeInteger",
                                                         "unsignedLong",
                                                         "unsignedInt",
                                                         "unsignedShort",
                                                         "unsignedByte",
                                                         "positiveInteger"};
  if (!datatype.starts_with(kXsd)) return false;
  datatype.remove_prefix(kXsd.size());
  return std::find(kNumeric.begin(), kNumeric.end(), datatype) != kNumeric.end();
}

constexpr std::size_t kDimensions = 5;
constexpr int kNotInVocabulary = -1;

void sort_and_unite(std::vector<Term>& terms) {
  std::sort(terms.begin(), terms.end());
  terms.erase(std::unique(terms.begin(), terms.end()), terms.end());
}

std::vector<Term> terms_of(const TermRange& range) { return {range.begin(), range.end()}; }

}  // namespace

ViewerQueries::ViewerQueries(const Graph& saturated) : graph_(&saturated) {
  const Dictionary& terms = saturated.dictionary();
  const auto ours = [&](std::string_view local) { return terms.find_local(local).value_or(-1); };
  v_ = {.type = standard_term(saturated, kRdf, "type"),
        .subclass = standard_term(saturated, kRdfs, "subClassOf"),
        .first = standard_term(saturated, kRdf, "first"),
        .rest = standard_term(saturated, kRdf, "rest"),
        .nil = standard_term(saturated, kRdf, "nil"),
        .exists = ours("exists"),
        .key = ours("key"),
        .during = ours("during"),
        .geometry = ours("geometry"),
        .part_of = ours("partOf"),
        .ancestor = ours("ancestor"),
        .from = ours("from"),
        .to = ours("to"),
        .unit = ours("unit"),
        .source = ours("source"),
        .instance = ours("instance"),
        .exists_from = ours("existsFrom"),
        .exists_until = ours("existsUntil"),
        .half_of = ours("halfOf"),
        .start_day = ours("startDay"),
        .end_day = ours("endDay"),
        .order = ours("order"),
        .stage = ours("TemporalEntity"),
        .entity = ours("EmbryologicalEntity"),
        .component = ours("GeometricalComponent"),
        .process = ours("Process"),
        .active = ours("Active")};
  for (const Term stage : saturated.subjects(v_.type, v_.stage)) {
    stages_.push_back({stage, number_in<int>(saturated, saturated.object(stage, v_.order)),
                       number_in<double>(saturated, saturated.object(stage, v_.start_day)),
                       number_in<double>(saturated, saturated.object(stage, v_.end_day))});
  }
  std::sort(stages_.begin(), stages_.end(), [](const StageDays& a, const StageDays& b) {
    return std::pair(a.order, a.stage) < std::pair(b.order, b.stage);
  });
  units_for_.resize(kDimensions);
  dimension_of_.assign(terms.size(), kNotInVocabulary);
  for (const PropertyEntry& property : vocabulary_properties())
    if (const auto term = terms.find_local(property.name))
      dimension_of_[*term] = static_cast<int>(property.dimension);
  is_number_.resize(terms.size());
  for (Term term = 0; term < terms.size(); ++term)
    is_number_[term] =
        terms.kind(term) == Dictionary::Kind::literal && is_numeric_type(terms.datatype(term));
  for (const Triple& triple : saturated.with_predicate(v_.unit)) {
    for (const Unit& unit : vocabulary_units()) {
      if (terms.text(triple.object) != unit.name) continue;
      units_for_[static_cast<int>(unit.dimension)].push_back(triple.object);
      units_for_[static_cast<int>(Dimension::of_quantity)].push_back(triple.object);
    }
  }
  for (std::vector<Term>& units : units_for_) sort_and_unite(units);
}

const ViewerQueries::StageDays* ViewerQueries::days_of(Term stage) const {
  for (const StageDays& days : stages_)
    if (days.stage == stage) return &days;
  return nullptr;
}

std::optional<Term> ViewerQueries::stage_of(double day) const {
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    if (day < stages_[i].start) continue;
    const bool is_last = i + 1 == stages_.size();
    if (is_last ? day <= stages_[i].end : day < stages_[i + 1].start) return stages_[i].stage;
  }
  return std::nullopt;
}

std::vector<StructureOfDay> ViewerQueries::existing(double day) const {
  std::vector<StructureOfDay> rows;
  const auto stage = stage_of(day);
  if (!stage) return rows;
  const TermRange structures = graph_->subjects(v_.exists, *stage);
  rows.reserve(structures.size());
  for (const Term structure : structures) rows.push_back({structure, *stage});
  return rows;
}

Term ViewerQueries::class_below(Term node, Term ancestor) const {
  for (const Term type : graph_->objects(node, v_.type))
    if (graph_->contains(type, v_.subclass, ancestor)) return type;
  return -1;
}

std::optional<KeyFrame> ViewerQueries::frame_of(Term structure, Term key) const {
  const auto stage = graph_->object(key, v_.during);
  const auto geometry = graph_->object(key, v_.geometry);
  const StageDays* days = stage ? days_of(*stage) : nullptr;
  if (days == nullptr || !geometry) return std::nullopt;
  const Term primitive = class_below(*geometry, v_.component);
  if (primitive < 0) return std::nullopt;
  return KeyFrame{structure, key,      *stage, days->order, (days->start + days->end) / 2,
                  *geometry, primitive};
}

std::vector<KeyFrame> ViewerQueries::key_frames(Term structure) const {
  std::vector<KeyFrame> rows;
  for (const Term key : graph_->objects(structure, v_.key))
    if (const auto frame = frame_of(structure, key)) rows.push_back(*frame);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const KeyFrame& a, const KeyFrame& b) { return a.order < b.order; });
  return rows;
}

std::vector<Term> ViewerQueries::parts(Term system) const {
  return terms_of(graph_->subjects(v_.part_of, system));
}

std::vector<Term> ViewerQueries::progenitors(Term structure) const {
  return terms_of(graph_->objects(structure, v_.ancestor));
}

std::vector<RunningProcess> ViewerQueries::running(double day) const {
  std::vector<RunningProcess> rows;
  for (const Term process : graph_->subjects(v_.type, v_.active)) {
    const auto from = graph_->object(process, v_.from), to = graph_->object(process, v_.to);
    const StageDays* first = from ? days_of(*from) : nullptr;
    const StageDays* last = to ? days_of(*to) : nullptr;
    if (first == nullptr || last == nullptr) continue;
    if (first->start + first->end > 2 * day || 2 * day > last->start + last->end) continue;
    for (const Term type : graph_->objects(process, v_.type))
      if (graph_->contains(type, v_.subclass, v_.process)) rows.push_back({process, type});
  }
  return rows;
}

template <class Visit>
void ViewerQueries::each_value(Term given, const Visit& visit) const {
  if (graph_->dictionary().kind(given) != Dictionary::Kind::blank) return visit(given);
  // A list ends after as many cells as there are triples, or it has no end.
  std::optional<Term> cell = given;
  for (int steps = 0; cell && *cell != v_.nil && steps < graph_->size(); ++steps) {
    if (const auto item = graph_->object(*cell, v_.first)) visit(*item);
    cell = graph_->object(*cell, v_.rest);
  }
}

Term ViewerQueries::unit_of(Term node, Term property) const {
  const int dimension = dimension_of_[property];
  if (dimension < 0 || dimension == static_cast<int>(Dimension::ratio)) return -1;
  const std::vector<Term>& units = units_for_[dimension];
  for (const Term unit : graph_->objects(node, v_.unit))
    if (std::binary_search(units.begin(), units.end(), unit)) return unit;
  return -1;
}

void ViewerQueries::append_sources(SourcedNumber row, std::vector<SourcedNumber>& rows) const {
  const TermRange sources = graph_->objects(row.node, v_.source);
  if (sources.empty()) rows.push_back(row);
  for (const Term source : sources) {
    row.source = source;
    rows.push_back(row);
  }
}

void ViewerQueries::append_numbers(const Triple& triple, std::vector<SourcedNumber>& rows) const {
  std::optional<Term> unit;
  each_value(triple.object, [&](Term value) {
    if (!is_number_[value]) return;
    if (!unit) unit = unit_of(triple.subject, triple.predicate);
    append_sources({triple.subject, triple.predicate, value, *unit, -1}, rows);
  });
}

std::vector<SourcedNumber> ViewerQueries::numbers() const {
  const Dictionary& terms = graph_->dictionary();
  std::vector<bool> is_ours(terms.size());
  for (Term term = 0; term < terms.size(); ++term) is_ours[term] = terms.is_ours(term);
  std::vector<SourcedNumber> rows;
  for (const Triple& triple : graph_->triples())
    if (is_ours[triple.predicate]) append_numbers(triple, rows);
  return rows;
}

std::vector<IncompleteStructure> ViewerQueries::incomplete() const {
  std::vector<IncompleteStructure> rows;
  for (const Term structure : graph_->subjects(v_.type, v_.entity)) {
    if (!graph_->subjects(v_.part_of, structure).empty()) continue;
    if (!graph_->object(structure, v_.exists_from))
      rows.push_back({structure, Missing::first_stage});
    if (!graph_->object(structure, v_.exists_until))
      rows.push_back({structure, Missing::last_stage});
    if (graph_->object(structure, v_.half_of)) continue;
    const TermRange keys = graph_->objects(structure, v_.key);
    const bool has_geometry = std::any_of(keys.begin(), keys.end(), [&](Term key) {
      return graph_->object(key, v_.geometry).has_value();
    });
    if (!has_geometry) rows.push_back({structure, Missing::geometry});
  }
  return rows;
}

void ViewerQueries::append_values(Term geometry, std::vector<GeometryValue>& values) const {
  for (const Triple& triple : graph_->of_subject(geometry)) {
    const Term property = triple.predicate;
    if (property == v_.type || property == v_.instance || property == v_.unit ||
        property == v_.source)
      continue;
    each_value(triple.object, [&](Term value) { values.push_back({property, value}); });
  }
}

FrameBundle ViewerQueries::bundle(double day) const {
  FrameBundle bundle;
  for (const StructureOfDay& row : existing(day)) {
    for (const KeyFrame& frame : key_frames(row.structure)) {
      const int first = static_cast<int>(bundle.values.size());
      append_values(frame.geometry, bundle.values);
      bundle.entries.push_back({frame, first, static_cast<int>(bundle.values.size())});
    }
  }
  return bundle;
}

std::vector<Term> followed(const Graph& graph, Term start, Term property, bool downward,
                           int levels) {
  std::vector<Term> found, border{start};
  for (int level = 0; level < levels && !border.empty(); ++level) {
    std::vector<Term> next;
    for (const Term term : border) {
      const TermRange reached =
          downward ? graph.subjects(property, term) : graph.objects(term, property);
      for (const Term one : reached)
        if (std::find(found.begin(), found.end(), one) == found.end()) {
          found.push_back(one);
          next.push_back(one);
        }
    }
    border = std::move(next);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace geoprior::embryo
