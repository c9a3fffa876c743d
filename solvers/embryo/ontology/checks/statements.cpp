#include <algorithm>
#include <cmath>

#include "solvers/embryo/ontology/checks/findings.h"

namespace geoprior::embryo {

namespace {

constexpr double kShortest = 1e-9;  ///< length of a direction
constexpr double kLargestEgg = 0.5;

bool is_numeric(const PropertyEntry& row) {
  return row.type == ValueType::integer || row.type == ValueType::number ||
         row.type == ValueType::vector;
}

/// Checks the statements of one node after the other.
class StatementCheck {
 public:
  explicit StatementCheck(Findings& findings)
      : findings_(findings),
        graph_(findings.graph()),
        terms_(graph_.graph().dictionary()),
        type_(terms_.find_iri(std::string(kRdf) + "type")) {}

  void run() {
    for (Term node = 0; node < terms_.size(); ++node) {
      const auto statements = graph_.graph().of_subject(node);
      if (statements.empty()) continue;
      const bool has_class = check_class(node, statements);
      check_names(node, statements, has_class);
      if (has_class) check_values(node);
    }
  }

 private:
  void add(std::string_view kind, const Triple& triple, const std::string& message) {
    findings_.add_at(kind, triple.subject, message, triple.line);
  }

  [[nodiscard]] std::string about(const Triple& triple) const {
    return findings_.quoted(triple.predicate) + " of " + findings_.quoted(triple.subject);
  }

  [[nodiscard]] bool is_geometry_of_key(Term node) const {
    const std::optional<Term> geometry = graph_.property("geometry");
    return geometry && !graph_.graph().subjects(*geometry, node).empty();
  }

  /// @return  whether its statements can be judged by a class
  bool check_class(Term node, std::span<const Triple> statements) {
    const int found = graph_.class_of(node);
    for (const Triple& triple : statements) {
      if (triple.predicate != type_) continue;
      const int named = graph_.class_named(triple.object);
      if (named == TypedGraph::kUnknown) {
        add(is_geometry_of_key(node) ? "unknown_primitive" : "unknown_class", triple,
            findings_.quoted(node) + " is of the unknown class " + findings_.quoted(triple.object));
      } else if (named >= 0 && !is_subclass(found, named)) {
        add("two_classes", triple,
            findings_.quoted(node) + " is " + with_article(vocabulary_classes()[found].name) +
                " and " + with_article(vocabulary_classes()[named].name));
      }
    }
    if (found < 0 || !vocabulary_classes()[found].abstract) return found >= 0;
    const bool is_geometry = vocabulary_classes()[found].name == "GeometricalComponent";
    findings_.add(is_geometry ? "unknown_primitive" : "unknown_class", node,
                  findings_.quoted(node) + " is " + with_article(vocabulary_classes()[found].name) +
                      " of none of its kinds");
    return false;
  }

  void check_names(Term node, std::span<const Triple> statements, bool has_class) {
    const Triple* ours = nullptr;
    for (const Triple& triple : statements) {
      if (!terms_.is_ours(triple.predicate)) continue;
      if (ours == nullptr) ours = &triple;
      if (!graph_.is_property(triple.predicate)) {
        add("unknown_property", triple,
            "the vocabulary has no " + findings_.quoted(triple.predicate));
      } else if (has_class && graph_.row(graph_.class_of(node), triple.predicate) == nullptr) {
        add("misplaced_property", triple,
            about(triple) + ": " + with_article(vocabulary_classes()[graph_.class_of(node)].name) +
                " has none");
      }
    }
    if (ours != nullptr && graph_.class_of(node) == TypedGraph::kNone)
      add("no_class", *ours, findings_.quoted(node) + " is of no class");
  }

  void check_values(Term node) {
    bool has_number = false, wants_source = false;
    std::vector<Dimension> dimensions;
    for (const PropertyEntry* row : graph_.rows(graph_.class_of(node))) {
      const std::optional<Term> predicate = graph_.property(row->name);
      const auto found =
          predicate ? graph_.graph().matching(node, *predicate) : std::span<const Triple>();
      check_count(node, *row, found);
      for (const Triple& triple : found) check_value(triple, *row);
      if (row->name == "source") wants_source = row->presence != Presence::at_least_once;
      if (found.empty() || !is_numeric(*row)) continue;
      has_number = true;
      dimensions.push_back(graph_.dimension_of(node, *row));
    }
    check_units(node, dimensions);
    if (has_number && wants_source && !graph_.has(node, "source"))
      findings_.add("missing_source", node,
                    "the numbers of " + findings_.quoted(node) + " have no source");
  }

  void check_units(Term node, const std::vector<Dimension>& dimensions) {
    std::vector<const Unit*> given;
    for (const Term text : graph_.values(node, "unit")) {
      const auto units = vocabulary_units();
      const auto unit = std::ranges::find(units, terms_.text(text), &Unit::name);
      if (unit == units.end()) return;  // an unknown unit may have been any of them
      given.push_back(&*unit);
    }
    for (const Dimension dimension : {Dimension::length, Dimension::angle, Dimension::day}) {
      const auto count = std::ranges::count(given, dimension, &Unit::dimension);
      if (count > 1)
        findings_.add(
            "two_units", node,
            findings_.quoted(node) + " has two units of a " + std::string(name_of(dimension)),
            "unit");
      if (count == 0 && std::ranges::count(dimensions, dimension) > 0)
        findings_.add(
            "missing_unit", node,
            findings_.quoted(node) + " has no unit of its " + std::string(name_of(dimension)));
    }
  }

  void check_count(Term node, const PropertyEntry& row, std::span<const Triple> found) {
    const bool is_needed =
        row.presence == Presence::required || row.presence == Presence::at_least_once;
    const bool is_single = row.presence == Presence::optional || row.presence == Presence::required;
    const std::string_view subject =
        graph_.is_a(node, "SpatioTemporalEntity") ? subject_of_key(row.name) : std::string_view();
    if (found.empty() && is_needed) {
      std::string kind = row.name == "source" ? "missing_source" : "missing_property";
      if (!subject.empty()) kind = std::string("key_without_").append(subject);
      findings_.add(kind, node, findings_.quoted(node) + " has no " + std::string(row.name));
    } else if (found.size() > 1 && is_single) {
      std::string kind = "repeated_property";
      if (!subject.empty()) kind = std::string("key_with_two_").append(subject).append("s");
      if (kind == "key_with_two_geometrys") kind = "key_with_two_geometries";
      const Triple& last = *std::ranges::max_element(found, {}, &Triple::line);
      add(kind, last, findings_.quoted(node) + " has more than one " + std::string(row.name));
    }
  }

  static std::string_view subject_of_key(std::string_view property) {
    if (property == "of") return "structure";
    if (property == "during") return "stage";
    if (property == "geometry") return "geometry";
    return {};
  }

  void check_value(const Triple& triple, const PropertyEntry& row) {
    const bool is_literal = terms_.kind(triple.object) == Dictionary::Kind::literal;
    switch (row.type) {
      case ValueType::reference:
        return check_reference(triple, row);
      case ValueType::iri:
        if (is_literal) wrong_type(triple, "a name");
        return;
      case ValueType::text:
        if (!is_literal) wrong_type(triple, "a text");
        return;
      case ValueType::choice:
        if (!is_literal) return wrong_type(triple, "a text");
        if (!is_among(terms_.text(triple.object), row.range))
          add(row.name == "unit" ? "unknown_unit" : "unknown_choice", triple,
              about(triple) + " is \"" + terms_.text(triple.object) + "\", none of " +
                  std::string(row.range));
        return;
      case ValueType::boolean:
        if (!boolean_of(terms_, triple.object)) wrong_type(triple, "true or false");
        return;
      case ValueType::integer:
        if (!is_integer(terms_, triple.object)) wrong_type(triple, "an integer");
        return;
      case ValueType::number:
        return check_numbers(triple, row, {triple.object});
      case ValueType::vector:
        return check_vector(triple, row);
    }
  }

  void wrong_type(const Triple& triple, const std::string& wanted) {
    add("wrong_value_type", triple, about(triple) + " is not " + wanted);
  }

  void check_reference(const Triple& triple, const PropertyEntry& row) {
    if (terms_.kind(triple.object) == Dictionary::Kind::literal)
      return wrong_type(triple, with_article(row.range));
    if (graph_.is_a(triple.object, row.range)) return;
    const int found = graph_.class_of(triple.object);
    const bool is_anchor = row.name == "startsOn" || row.name == "endsOn";
    if (found >= 0 && !is_anchor) return wrong_type(triple, with_article(row.range));
    // Of a node that is described under an unknown class, or under none, that has been said.
    if (found == TypedGraph::kUnknown) return;
    if (found == TypedGraph::kNone && has_our_statement(triple.object)) return;
    add(is_anchor ? "anchor_on_no_structure" : unknown_kind(triple.subject, row.range), triple,
        about(triple) + ": " + findings_.quoted(triple.object) + " is no " +
            std::string(row.range));
  }

  [[nodiscard]] bool has_our_statement(Term node) const {
    return std::ranges::any_of(graph_.graph().of_subject(node), [&](const Triple& triple) {
      return terms_.is_ours(triple.predicate);
    });
  }

  [[nodiscard]] std::string_view unknown_kind(Term node, std::string_view range) const {
    if (range == "TemporalEntity") return "unknown_stage";
    if (range == "Source") return "unknown_source";
    if (range == "ParameterSet") return "unknown_parameter_set";
    if (range == "GeometricalComponent") return "unknown_geometry";
    if (range == "Process")
      return graph_.is_a(node, "Disease") ? "disease_unknown_process" : "unknown_process";
    return graph_.is_a(node, "Process") ? "process_unknown_structure" : "unknown_structure";
  }

  void check_vector(const Triple& triple, const PropertyEntry& row) {
    const std::optional<std::vector<Term>> items = graph_.list(triple.object);
    if (!items) return wrong_type(triple, "a list of numbers");
    const int size = static_cast<int>(items->size());
    if (row.count > 0 ? size != row.count : size % 3 != 0) {
      const std::string wanted = row.count > 0 ? std::to_string(row.count) : "a multiple of three";
      add("vector_length", triple,
          about(triple) + " has " + std::to_string(size) + " numbers, not " + wanted);
      return;
    }
    check_numbers(triple, row, *items);
  }

  void check_numbers(const Triple& triple, const PropertyEntry& row,
                     const std::vector<Term>& items) {
    double square = 0, least = INFINITY, largest = 0;
    for (const Term item : items) {
      const std::optional<double> number = number_of(terms_, item);
      if (!number)
        return wrong_type(triple, row.type == ValueType::vector ? "a list of numbers" : "a number");
      if (!std::isfinite(*number))
        return add("not_finite", triple, about(triple) + " is not finite");
      square += *number * *number;
      least = std::min(least, *number);
      largest = std::max(largest, std::abs(*number));
    }
    if (row.bound == Bound::positive && least <= 0)
      add("not_positive", triple, about(triple) + " must be above 0");
    if (row.bound == Bound::not_negative && least < 0)
      add("negative_number", triple, about(triple) + " must not be below 0");
    if (row.bound == Bound::egg && largest > kLargestEgg)
      add("egg_out_of_range", triple, about(triple) + " must be within -0.5 and 0.5");
    if (row.bound == Bound::direction && std::sqrt(square) < kShortest)
      add("axis_zero", triple, about(triple) + " has no direction");
  }

  Findings& findings_;
  const TypedGraph& graph_;
  const Dictionary& terms_;
  std::optional<Term> type_;
};

}  // namespace

void check_statements(Findings& findings) { StatementCheck(findings).run(); }

}  // namespace geoprior::embryo
