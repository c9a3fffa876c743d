#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// How `check` holds a value against its reference value.
struct Gate {
  Tolerance tolerance;
  Direction direction = Direction::none;
  double target = 0;       ///< for Direction::closer_to_target
  bool headline = false;   ///< a claim names the metric
  bool only_more = false;  ///< counted work: less of it is no failure
  bool compared = true;    ///< false: the metric table says `ungated`
};

/// The gates of an experiment: those of its topic's tables, its [tolerance] and its claims.
class Gates {
 public:
  Gates(const Experiment& experiment, const Topic& topic);

  /// @param name  of a gated value, see `GatedValues`
  [[nodiscard]] Gate of(const std::string& variant, const std::string& name) const;

 private:
  [[nodiscard]] Gate of_study(const StudySpec& study) const;
  [[nodiscard]] Tolerance of_quantity(const std::string& name) const;
  void add_claim(const ClaimSpec& claim, const Experiment& experiment);

  std::map<std::string, Gate> gates_;                       ///< by name before ".max"
  std::set<std::pair<std::string, std::string>> headline_;  ///< variant, metric
};

/// A value of a run that has, or gets, a reference value.
struct GatedValue {
  double value = 0;
  std::string unit;
  /// What a relative tolerance is a share of where that is not the value: the sides of the claim
  /// that falls short.
  std::optional<double> size = {};
};

/// Case, variant, name. Names are those of headlines ("overlap_volume.max", headlines.h);
/// "diagnostic:<name>" is the mean over the frames of counted work; "study:<name>" has neither case
/// nor variant (""), "shortfall:<text of the claim>" no variant: by how much a claim with
/// `known_shortfall` falls short, in its metric's unit.
using GatedValues = std::map<std::string, std::map<std::string, std::map<std::string, GatedValue>>>;

/// visit(case, variant, name, value) for each of a set's values, in their order.
template <class Values, class Visit>
void visit_values(const Values& set, Visit visit) {
  for (const auto& [case_name, variants] : set) {
    for (const auto& [variant, values] : variants) {
      for (const auto& [name, value] : values) visit(case_name, variant, name, value);
    }
  }
}

/// What `check` compares of a run: its headlines, counted work, studies and shortfalls. Of an
/// experiment that bifurcates it is the median over the seeds: its cases differ in nothing else and
/// are called "seed=*".
/// @param claims  decided for this record
GatedValues gated_values(const Experiment& experiment, const Topic& topic, const RunRecord& record,
                         const std::vector<ClaimRecord>& claims);

/// Whether results of a variant repeat; methods that the topic does not know do.
bool has_gated_method(const Topic& topic, const VariantRecord& variant);

/// The values of cases that differ in their seed only, replaced by their median; such a case is
/// called "seed=*".
/// @param values  of the record's cases
GatedValues medians_over_seeds(const RunRecord& record, const GatedValues& values);

/// How much worse a headline metric may be than its reference, however wide its tolerance: the
/// larger of 3 % and twice the absolute tolerance.
double headline_limit(const Gate& gate, double reference);

/// By how much a value is worse than the reference; negative when better. Without a direction any
/// change is for the worse.
double worsening(const Gate& gate, double value, double reference);

/// The value of a set of this shape; null when there is none.
template <class Values>
const auto* find_value(const Values& set, const std::string& case_name, const std::string& variant,
                       const std::string& name) {
  using Found = typename Values::mapped_type::mapped_type::mapped_type;
  const Found* none = nullptr;
  const auto in_case = set.find(case_name);
  if (in_case == set.end()) return none;
  const auto of_variant = in_case->second.find(variant);
  if (of_variant == in_case->second.end()) return none;
  const auto value = of_variant->second.find(name);
  return value == of_variant->second.end() ? none : &value->second;
}

}  // namespace geoprior
