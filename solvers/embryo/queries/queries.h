#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solvers/embryo/triples/graph.h"

namespace geoprior::embryo {

struct StructureOfDay {
  Term structure, stage;
};

/// A key frame of a structure.
struct KeyFrame {
  Term structure, key, stage;
  int order = 0;             ///< of the stage
  double day = 0;            ///< the middle of the stage
  Term geometry, primitive;  ///< node and class
};

struct RunningProcess {
  Term process, kind;  ///< class below e:Process
};

/// One number of the ontology: where it stands and where it is from. -1 where nothing is said.
struct SourcedNumber {
  Term node, property, value, unit, source;
};

enum class Missing { first_stage, last_stage, geometry };

struct IncompleteStructure {
  Term structure;
  Missing missing;
};

/// One value of a geometry: a number, alone or of a list, or what an end or a frame refers to.
struct GeometryValue {
  Term property, value;
};

/// All that the shapes of a day are made of.
struct FrameBundle {
  struct Entry {
    KeyFrame frame;
    int first_value = 0, last_value = 0;  ///< into `values`, which lists keep their order in
  };
  std::vector<Entry> entries;
  std::vector<GeometryValue> values;
};

/// The viewer's queries as joins over a graph that rules have saturated (graph_facts.h): what is
/// `exists`, `key`, `hasPart`, `halfOf`, `ancestor` and `Active` there was derived, for one disease
/// and one parameter set.
///
/// Terms of the vocabulary and the stages are looked up once. Asking changes nothing and may be
/// done by several threads; rows come in the order of terms' numbers unless another is named.
class ViewerQueries {
 public:
  /// @param saturated  must outlive the queries
  explicit ViewerQueries(const Graph& saturated);

  [[nodiscard]] const Graph& graph() const { return *graph_; }

  /// The stage that a day lies in: from its first day to that of the next one, the last one to its
  /// end. Absent outside.
  [[nodiscard]] std::optional<Term> stage_of(double day) const;

  /// Q1: the structures that exist at a day. None outside of all stages.
  [[nodiscard]] std::vector<StructureOfDay> existing(double day) const;
  /// Q2: the key frames of a structure, by their stages' order.
  [[nodiscard]] std::vector<KeyFrame> key_frames(Term structure) const;
  /// Q3: the parts of a system and theirs, to any depth.
  [[nodiscard]] std::vector<Term> parts(Term system) const;
  /// Q4: what a structure develops from, and that, to any depth.
  [[nodiscard]] std::vector<Term> progenitors(Term structure) const;
  /// Q5: the processes that are active at a day, first and last included: a process runs from the
  /// middle of one stage to that of another.
  [[nodiscard]] std::vector<RunningProcess> running(double day) const;
  /// Q6: every number of our namespace, once for each source; its unit is the one of those on its
  /// node that measures what the property does.
  [[nodiscard]] std::vector<SourcedNumber> numbers() const;
  /// Q7: structures without a first or a last stage or without any key's geometry. Those that have
  /// parts need none of these, the halves of a division no geometry.
  [[nodiscard]] std::vector<IncompleteStructure> incomplete() const;
  /// Q8: the key frames of all structures of a day with the values of their geometries.
  [[nodiscard]] FrameBundle bundle(double day) const;

 private:
  struct StageDays {
    Term stage;
    int order;
    double start, end;
  };
  /// Terms of the vocabulary; -1 for those that the graph has not.
  struct Vocabulary {
    Term type, subclass, first, rest, nil, exists, key, during, geometry, part_of, ancestor, from,
        to, unit, source, instance, exists_from, exists_until, half_of, start_day, end_day, order,
        stage, entity, component, process, active;
  };

  [[nodiscard]] const StageDays* days_of(Term stage) const;
  [[nodiscard]] std::optional<KeyFrame> frame_of(Term structure, Term key) const;
  [[nodiscard]] Term class_below(Term node, Term ancestor) const;
  void append_values(Term geometry, std::vector<GeometryValue>& values) const;
  void append_numbers(const Triple& triple, std::vector<SourcedNumber>& rows) const;
  void append_sources(SourcedNumber row, std::vector<SourcedNumber>& rows) const;
  [[nodiscard]] Term unit_of(Term node, Term property) const;
  /// Calls `visit` with the term or, of a list, with each of its items.
  template <class Visit>
  void each_value(Term given, const Visit& visit) const;

  const Graph* graph_;
  Vocabulary v_{};
  std::vector<StageDays> stages_;             ///< by order
  std::vector<std::vector<Term>> units_for_;  ///< by dimension: literals that measure it
  std::vector<int> dimension_of_;             ///< of a property; -1: not in the vocabulary
  std::vector<bool> is_number_;               ///< of a term
};

/// What a hierarchy gives that is followed for so many levels, as a join of fixed depth does: on
/// the triples as they were stated the deeper ones are lost without a word. In the order of
/// numbers.
///
/// @param graph     as it was read: a saturated graph has the whole hierarchy at level one
/// @param downward  from an object to the subjects (parts), else from a subject to the objects
std::vector<Term> followed(const Graph& graph, Term start, Term property, bool downward,
                           int levels);

}  // namespace geoprior::embryo
