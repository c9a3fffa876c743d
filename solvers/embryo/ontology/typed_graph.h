#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/embryo/ontology/vocabulary.h"
#include "solvers/embryo/triples/graph.h"

namespace geoprior::embryo {

/// A graph seen through the vocabulary: the class of each node, the row of each statement, and
/// values in SI units (days for days).
///
/// It judges nothing: a value that is missing, repeated beyond the first or malformed is absent,
/// and `violations` says so. The graph must outlive it.
class TypedGraph {
 public:
  static constexpr int kNone = -1;     ///< of a node without a class, or of another vocabulary
  static constexpr int kUnknown = -2;  ///< a name of our namespace that is not in the vocabulary

  explicit TypedGraph(const Graph& graph);

  [[nodiscard]] const Graph& graph() const { return *graph_; }
  /// Place in `vocabulary_classes`, `kNone` or `kUnknown`; of several the most special one.
  [[nodiscard]] int class_of(Term node) const { return class_of_[node]; }
  [[nodiscard]] bool is_a(Term node, std::string_view class_name) const;
  /// The class that a type names, itself or through rdfs:subClassOf; else `kNone` or `kUnknown`.
  [[nodiscard]] int class_named(Term type) const;
  /// Nodes of the class and its subclasses, by local name.
  [[nodiscard]] std::vector<Term> instances(std::string_view class_name) const;

  /// The row that a property has for the nodes of a class; null where there is none.
  [[nodiscard]] const PropertyEntry* row(int class_number, Term predicate) const;
  /// All rows of a class, by name.
  [[nodiscard]] const std::vector<const PropertyEntry*>& rows(int class_number) const {
    return rows_of_class_[class_number];
  }
  /// Whether some class of the vocabulary has the property.
  [[nodiscard]] bool is_property(Term predicate) const { return property_of_[predicate] >= 0; }
  /// The term of a property's name; absent where the graph never names it.
  [[nodiscard]] std::optional<Term> property(std::string_view name) const;

  [[nodiscard]] TermRange values(Term node, std::string_view name) const;
  [[nodiscard]] bool has(Term node, std::string_view name) const;
  [[nodiscard]] std::optional<Term> value(Term node, std::string_view name) const;
  [[nodiscard]] std::string text(Term node, std::string_view name) const;
  [[nodiscard]] bool flag(Term node, std::string_view name) const;
  [[nodiscard]] std::optional<double> number(Term node, std::string_view name) const;
  /// The numbers of a list.
  [[nodiscard]] std::optional<std::vector<double>> numbers(Term node, std::string_view name) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> vector(Term node, std::string_view name) const;
  /// Nodes of the class that the row of the property asks for.
  [[nodiscard]] std::vector<Term> references(Term node, std::string_view name) const;
  [[nodiscard]] std::optional<Term> reference(Term node, std::string_view name) const;

  /// The unit that a node gives for a dimension; absent where it gives none or several.
  [[nodiscard]] const Unit* unit(Term node, Dimension dimension) const;
  /// What a number of the node measures, that of a measurement by its quantity.
  [[nodiscard]] Dimension dimension_of(Term node, const PropertyEntry& row) const;
  /// The items of an RDF list; absent where it is none, has no end or more than 10,000 items.
  [[nodiscard]] std::optional<std::vector<Term>> list(Term head) const;

  /// Local name; of a nameless geometry that of its key.
  [[nodiscard]] std::string name_of(Term node) const;
  /// Line of the property's first value; of the node itself where it has none.
  [[nodiscard]] int line(Term node, std::string_view name = {}) const;

 private:
  void resolve_classes();
  void resolve_properties();

  const Graph* graph_;
  std::optional<Term> type_, subclass_, first_, rest_, nil_;
  std::vector<int> class_of_;                           ///< of each term
  std::vector<int> property_of_;                        ///< of each term: number of its name
  std::map<std::string_view, int, std::less<>> names_;  ///< of properties
  std::vector<Term> term_of_name_;                      ///< or -1
  std::vector<std::vector<const PropertyEntry*>> row_;  ///< of a name and a class
  std::vector<std::vector<const PropertyEntry*>> rows_of_class_;
};

/// The number of a numeric literal; absent for other terms and for texts that are no number. It may
/// be infinite or not a number.
std::optional<double> number_of(const Dictionary& dictionary, Term term);
bool is_integer(const Dictionary& dictionary, Term term);
/// Absent where it is none.
std::optional<bool> boolean_of(const Dictionary& dictionary, Term term);

}  // namespace geoprior::embryo
