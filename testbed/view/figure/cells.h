#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/frame.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// Overlays that are of the sheet's own stuff, whose colours do not tell overlays apart.
inline constexpr std::string_view kLipDetail = "lip_detail", kFibres = "fibres";

/// Panels side by side, and where names are written beside what they show.
inline constexpr std::size_t kMostColumns = 6, kMostLabelledColumns = 3;

struct NamedPart {
  std::string name;
  Part part;
};

/// One panel of a figure before it is drawn: a variant in one state.
struct FigureCell {
  std::string label;  ///< of the variant, or of the state or case when those stand side by side
  std::optional<double> parameter;  ///< of the frame that is drawn
  std::optional<Part> part;  ///< absent: the variant has no such frame (it failed, or was left out)
  std::optional<Part> plain;      ///< shown in plain panels; absent: `part` is
  std::string note = "no frame";  ///< stands in place of the part
  std::vector<NamedPart> overlays;
  std::optional<Part> obstacles;  ///< part "obstacles" of the frame: drawn faintly, never fitted
};

/// Panels side by side.
struct FigureRow {
  std::string label;         ///< the state ("angle 90°") and, in a sweep, the case
  bool has_headings = true;  ///< cells are named over it: not when the row above has the same
  std::vector<FigureCell> cells;
};

/// Which states are drawn, loaded from the run's files: variants as columns (wrapped past
/// `most_columns`), parameters and cases as rows (at most eight), or with `across` parameters or
/// cases as columns and variants as rows. The frame nearest to a wanted parameter is taken, and the
/// label gives the parameter it really has; parameters with the same nearest frame make one row.
/// @throws Error  naming the variant, case or part that the run does not have, or a damaged file
std::vector<FigureRow> collect_cells(const OpenedRun& run, const FigureView& view,
                                     std::size_t most_columns = kMostColumns);

/// Whether two rows name their cells alike.
bool same_labels(const FigureRow& a, const FigureRow& b);

/// "dual-quaternion" as "Dual quaternion", "flip" as "FLIP".
std::string display_name(const std::string& name);

/// "90°", "0.25 s", "12": a parameter with its unit.
std::string with_unit(double value, const std::string& unit);

}  // namespace geoprior
