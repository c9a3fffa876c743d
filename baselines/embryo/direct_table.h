#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/embryo/body/body.h"

namespace geoprior::embryo {

/// Diseases that somebody has written a function for.
enum class TableDisease { none, renal_agenesis_left, horseshoe_kidney, persistent_cloaca };

/// The urinary system of the ascent set as a program without ontology and rules: key frames in
/// tables (baselines/embryo/table; copies of the numbers of experiments/embryo/urinary.ttl),
/// processes as code, and for each disease a function that
/// lists by hand all that follows from it.
///
/// It has the equations of a day (models/embryo/body) in common with what is made of an ontology:
/// that both agree says that the plans do, and nothing of the equations. It gives the same state,
/// number for number of structures and processes, for the healthy body and for its three diseases.
/// What it cannot do: read a structure or a disease that is not compiled in, say where a number
/// comes from, or find out what a disease leads to: a line that is forgotten in its function is an
/// organ that stays. Structures of other diseases have numbers, so that all are numbered alike, but
/// never exist.
class DirectTable {
 public:
  explicit DirectTable(TableDisease disease = TableDisease::none,
                       Interpolation interpolation = Interpolation::monotone);

  /// @throws Error  for a day outside of the stages (names their range)
  [[nodiscard]] DayState at(double day) const { return body_.at(day); }
  [[nodiscard]] double first_day() const { return body_.first_day(); }
  [[nodiscard]] double last_day() const { return body_.last_day(); }
  /// Names of the structures, by number.
  [[nodiscard]] std::vector<std::string> structures() const;

 private:
  Body body_;
};

/// The disease of a name as ontologies have it, "HorseshoeKidney"; absent where there is no
/// function for it.
std::optional<TableDisease> table_disease(std::string_view name);

}  // namespace geoprior::embryo
