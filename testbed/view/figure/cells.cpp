#include "testbed/view/figure/cells.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <set>

#include "core/error.h"
#include "testbed/formats/folders.h"
#include "testbed/joined.h"
#include "testbed/runner/options/quantity.h"
#include "testbed/runner/process/stop.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRows = 8;
constexpr const char* kObstacles = "obstacles";

/// `wanted` in its own order, checked; all of `available` when none is wanted.
std::vector<std::string> choose(const std::vector<std::string>& wanted,
                                const std::vector<std::string>& available, const std::string& key) {
  if (wanted.empty()) return available;
  for (const std::string& name : wanted) {
    if (std::find(available.begin(), available.end(), name) == available.end()) {
      throw Error("no '" + name + "' in this run", key, joined(available));
    }
  }
  return wanted;
}

std::vector<std::string> case_names(const RunRecord& record) {
  std::vector<std::string> names;
  for (const CaseRecord& c : record.cases) {
    if (!c.claims_only) names.push_back(c.name);
  }
  return names;
}

std::vector<std::string> variant_names(const RunRecord& record) {
  std::vector<std::string> names;
  for (const CaseRecord& c : record.cases) {
    for (const VariantRecord& v : c.variants) {
      if (is_null_control(v.role)) continue;
      if (std::find(names.begin(), names.end(), v.name) == names.end()) names.push_back(v.name);
    }
  }
  return names;
}

const FrameRecord* nearest_frame(const VariantRecord& variant, std::optional<double> wanted) {
  if (variant.frames.empty()) return nullptr;
  if (!wanted) return &variant.frames.back();
  return &*std::min_element(
      variant.frames.begin(), variant.frames.end(), [&](const auto& a, const auto& b) {
        return std::abs(a.parameter - *wanted) < std::abs(b.parameter - *wanted);
      });
}

/// "surface" of "frames/default/implicit/surface_0012.vtp".
std::string part_name(const StoredFile& file) {
  const std::string stem = fs::path(file.name).stem().string();
  return stem.substr(0, stem.find_last_of('_'));
}

std::optional<Part> load_part(const FrameRecord& frame, const std::string& name,
                              const OpenedRun& run) {
  throw_if_stopped();
  for (const StoredFile& file : frame.files) {
    if (fs::path(file.name).extension() != ".csv" && part_name(file) == name) {
      return run.part(file);
    }
  }
  return std::nullopt;
}

Part require_part(const FrameRecord& frame, const std::string& name, const OpenedRun& run) {
  if (auto part = load_part(frame, name, run)) return *std::move(part);
  std::vector<std::string> available;
  for (const StoredFile& file : frame.files) available.push_back(part_name(file));
  throw Error("no part '" + name + "' in the frames", "figure_view.part", joined(available));
}

/// The parameter that a row shows: of all variants' frames the one nearest to the wanted one, or
/// the last of all. Absent: there are no frames.
std::optional<double> state_of(const CaseRecord& c, std::optional<double> wanted) {
  std::optional<double> best;
  for (const VariantRecord& variant : c.variants) {
    const FrameRecord* frame = nearest_frame(variant, wanted);
    if (frame == nullptr) continue;
    const double parameter = frame->parameter;
    const bool better = !best || (wanted ? std::abs(parameter - *wanted) < std::abs(*best - *wanted)
                                         : parameter > *best);
    if (better) best = parameter;
  }
  return best;
}

std::string state_label(const CaseRecord& c, std::optional<double> state) {
  if (!state) return {};
  return display_name(c.parameter_name) + " " + with_unit(*state, c.parameter_unit);
}

/// Whether the variant broke off before the state of its row: its last frame is another state.
bool failed_before(const VariantRecord& variant, std::optional<double> state) {
  if (variant.status != "failed" || variant.frames.empty() || !state) return false;
  const double last = variant.frames.back().parameter;
  return last < *state && !same_parameter(last, *state);
}

FigureCell make_cell(const CaseRecord& c, const std::string& variant_name,
                     std::optional<double> parameter, std::optional<double> state,
                     const FigureView& view, const OpenedRun& run) {
  FigureCell cell;
  cell.label = display_name(variant_name);
  const VariantRecord* variant = find_variant(c, variant_name);
  const FrameRecord* frame = variant != nullptr ? nearest_frame(*variant, parameter) : nullptr;
  if (variant != nullptr && could_not_run(*variant)) cell.note = "cannot run";
  if (frame == nullptr) return cell;
  if (failed_before(*variant, state)) {
    cell.note = "failed after " + with_unit(variant->frames.back().parameter, c.parameter_unit);
    return cell;
  }
  cell.parameter = frame->parameter;
  cell.part = require_part(*frame, view.part, run);
  if (view.plain && !view.plain_part.empty()) cell.plain = load_part(*frame, view.plain_part, run);
  for (const std::string& overlay : view.overlays) {
    if (auto part = load_part(*frame, overlay, run)) {
      cell.overlays.push_back({overlay, *std::move(part)});
    }
  }
  if (view.part != kObstacles) cell.obstacles = load_part(*frame, kObstacles, run);
  return cell;
}

/// Splits columns evenly into as few rows as the limit allows.
template <class T>
std::vector<std::vector<T>> wrap(const std::vector<T>& columns, std::size_t most) {
  const std::size_t rows = (columns.size() + most - 1) / most;
  const std::size_t width = rows == 0 ? 0 : (columns.size() + rows - 1) / rows;
  std::vector<std::vector<T>> out;
  for (std::size_t i = 0; i < columns.size(); i += width) {
    const auto begin = columns.begin() + i;
    out.emplace_back(begin, begin + std::min(width, columns.size() - i));
  }
  return out;
}

std::vector<std::optional<double>> wanted_parameters(const FigureView& view) {
  std::vector<std::optional<double>> wanted;
  if (view.at_parameter) wanted.emplace_back(*view.at_parameter);
  for (const double p : view.parameters) wanted.emplace_back(p);
  if (wanted.empty()) wanted.emplace_back(std::nullopt);
  return wanted;
}

/// One state that is drawn of a case.
struct DrawnState {
  std::optional<double> wanted;
  std::optional<double> parameter;  ///< what the label gives
  std::string label;
};

/// Whether variants that went through end at different parameters: an iteration is not a time.
bool ends_apart(const CaseRecord& c) {
  std::optional<double> end;
  for (const VariantRecord& variant : c.variants) {
    if (variant.status == "failed" || variant.frames.empty()) continue;
    const double last = variant.frames.back().parameter;
    if (end && !same_parameter(*end, last)) return true;
    end = last;
  }
  return false;
}

/// A quick run is shorter: what lies beyond it is its last frame, once.
std::vector<DrawnState> drawn_states(const CaseRecord& c, const FigureView& view) {
  std::vector<DrawnState> states;
  std::set<std::string> known;
  for (const std::optional<double>& wanted : wanted_parameters(view)) {
    const std::optional<double> parameter = state_of(c, wanted);
    const std::string label =
        !wanted && ends_apart(c) ? "Last " + c.parameter_name : state_label(c, parameter);
    if (known.insert(label).second) states.push_back({wanted, parameter, label});
  }
  return states;
}

using Variants = std::vector<std::string>;

/// Variants side by side, a row a state.
std::vector<FigureRow> rows_of_states(const CaseRecord& c, const Variants& variants,
                                      const FigureView& view, const OpenedRun& run,
                                      std::size_t most_columns) {
  std::vector<FigureRow> rows;
  const auto blocks = wrap(variants, most_columns);
  for (const DrawnState& state : drawn_states(c, view)) {
    for (const Variants& block : blocks) {
      FigureRow row;
      row.label = state.label;
      for (const std::string& variant : block) {
        row.cells.push_back(make_cell(c, variant, state.wanted, state.parameter, view, run));
      }
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

/// States side by side, a row a variant.
std::vector<FigureRow> rows_of_variants(const CaseRecord& c, const Variants& variants,
                                        const FigureView& view, const OpenedRun& run,
                                        std::size_t most_columns) {
  std::vector<FigureRow> rows;
  for (const std::string& variant : variants) {
    for (const std::vector<DrawnState>& block : wrap(drawn_states(c, view), most_columns)) {
      FigureRow row;
      if (variants.size() > 1) row.label = display_name(variant);
      for (const DrawnState& state : block) {
        row.cells.push_back(make_cell(c, variant, state.wanted, state.parameter, view, run));
        row.cells.back().label = state.label;
      }
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

using Cases = std::vector<const CaseRecord*>;

/// Cases side by side, a row a variant and state: those of the first case.
std::vector<FigureRow> rows_of_cases(const Cases& cases, const Variants& variants,
                                     const FigureView& view, const OpenedRun& run,
                                     std::size_t most_columns) {
  std::vector<FigureRow> rows;
  const auto blocks = wrap(cases, most_columns);
  for (const std::string& variant : variants) {
    for (const DrawnState& state : drawn_states(*cases.front(), view)) {
      for (const Cases& block : blocks) {
        FigureRow row;
        if (variants.size() > 1) row.label = display_name(variant) + ", ";
        row.label += state.label;
        for (const CaseRecord* c : block) {
          row.cells.push_back(
              make_cell(*c, variant, state.wanted, state_of(*c, state.wanted), view, run));
          row.cells.back().label = display_name(c->name);
        }
        rows.push_back(std::move(row));
      }
    }
  }
  return rows;
}

/// Rows of one case after the other.
std::vector<FigureRow> rows_case_by_case(const Cases& cases, const Variants& variants,
                                         const FigureView& view, const OpenedRun& run,
                                         std::size_t most_columns) {
  const bool states_across = view.across == FigureView::Across::states;
  std::vector<FigureRow> rows;
  for (const CaseRecord* c : cases) {
    if (rows.size() >= kMostRows) break;
    for (FigureRow& row : states_across ? rows_of_variants(*c, variants, view, run, most_columns)
                                        : rows_of_states(*c, variants, view, run, most_columns)) {
      if (cases.size() > 1) row.label += (row.label.empty() ? "" : ", ") + c->name;
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

/// Written in capitals wherever they stand alone.
const std::set<std::string> kAcronyms{"apic", "flip", "jonswap", "pic", "tma"};

std::string capitals(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

bool same_labels(const FigureRow& a, const FigureRow& b) {
  return std::equal(
      a.cells.begin(), a.cells.end(), b.cells.begin(), b.cells.end(),
      [](const FigureCell& one, const FigureCell& other) { return one.label == other.label; });
}

std::string display_name(const std::string& name) {
  const std::size_t first = std::min(name.find_first_of("-_"), name.size());
  const std::string word = name.substr(0, first);
  std::string text = name;
  std::replace(text.begin(), text.end(), '-', ' ');
  std::replace(text.begin(), text.end(), '_', ' ');
  if (!text.empty()) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    if (kAcronyms.contains(word)) text.replace(0, first, capitals(word));
  }
  return text;
}

std::string with_unit(double value, const std::string& unit) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  if (unit == "deg") return std::string(text.data()) + "\u00b0";
  return std::string(text.data()) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

std::vector<FigureRow> collect_cells(const OpenedRun& run, const FigureView& view,
                                     std::size_t most_columns) {
  const RunRecord& record = run.record();
  const auto wanted = choose(view.cases, case_names(record), "figure_view.cases");
  const Variants variants = choose(view.variants, variant_names(record), "figure_view.variants");
  Cases cases;
  for (const CaseRecord& c : record.cases) {
    if (std::find(wanted.begin(), wanted.end(), c.name) != wanted.end()) cases.push_back(&c);
  }
  if (cases.empty()) return {};
  std::vector<FigureRow> rows = view.across == FigureView::Across::cases
                                    ? rows_of_cases(cases, variants, view, run, most_columns)
                                    : rows_case_by_case(cases, variants, view, run, most_columns);
  if (rows.size() > kMostRows) rows.resize(kMostRows);
  for (std::size_t i = 1; i < rows.size(); ++i)
    rows[i].has_headings = !same_labels(rows[i - 1], rows[i]);
  return rows;
}

}  // namespace geoprior
