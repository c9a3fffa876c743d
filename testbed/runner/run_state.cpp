#include "testbed/runner/run_state.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "testbed/runner/benchmark.h"
#include "testbed/runner/journal/event_table.h"
#include "testbed/runner/journal/record_names.h"

namespace geoprior {

namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

/// Puts a value at a frame of a column that may have begun later than the frames.
void put(std::vector<double>& column, std::size_t index, double value) {
  column.resize(index, kAbsent);
  column.push_back(value);
}

/// Puts the seconds of one phase at a frame, as its only repetition.
void put(std::vector<std::vector<double>>& rows, std::size_t index, double seconds) {
  rows.resize(index, {kAbsent});
  rows.push_back({seconds});
}

void put_rest(const journal::Numbers& seconds, VariantRecord& record) {
  for (const auto& [phase, value] : seconds) record.timing[name_of_rest(phase)] = {{value}};
}

template <class Map, class Values>
void cut(Map& columns, std::size_t frames, Values values) {
  for (auto it = columns.begin(); it != columns.end();) {
    std::vector<double>& column = values(it->second);
    if (column.size() > frames) column.resize(frames);
    const bool empty = std::all_of(column.begin(), column.end(), [](double x) { return x != x; });
    it = empty ? columns.erase(it) : std::next(it);
  }
}

VariantState fresh(const VariantSpec& spec) {
  VariantState state;
  state.record.name = spec.name;
  state.record.method = spec.method;
  state.record.role = spec.role;
  state.record.reference = spec.reference.value_or("");
  state.record.options_json = spec.options_json;
  state.record.status = "stopped";
  return state;
}

CaseState fresh(const CaseSpec& spec) {
  CaseState state;
  state.record.name = spec.name;
  state.record.seed = spec.seed;
  state.record.threads = spec.threads;
  state.record.scene_json = spec.scene_json;
  state.record.swept = spec.swept;
  state.record.claims_only = spec.claims_only;
  for (const VariantSpec& variant : spec.variants) state.variants.push_back(fresh(variant));
  return state;
}

}  // namespace

RunState::RunState(const Experiment& experiment) {
  for (const CaseSpec& spec : experiment.cases) cases_.push_back(fresh(spec));
}

CaseState& RunState::case_of(const std::string& name) {
  for (CaseState& state : cases_) {
    if (state.record.name == name) return state;
  }
  throw Error("the journal names the case '" + name + "', which the experiment does not have");
}

VariantState& RunState::variant_of(const journal::Place& place) {
  for (VariantState& state : case_of(place.case_name).variants) {
    if (state.record.name == place.variant) return state;
  }
  throw Error("the journal names the variant '" + place.variant +
              "', which the experiment does not have");
}

void RunState::apply(const journal::Line& line) {
  std::visit([this](const auto& of_kind) { apply(of_kind); }, line);
}

void RunState::apply(const journal::RunLine& line) { run_ = line; }

void RunState::apply(const journal::CaseLine& line) {
  CaseState& state = case_of(line.case_name);
  state.record.parameter_name = line.parameter_name;
  state.record.parameter_unit = line.parameter_unit;
  state.record.facts = line.facts;
  state.record.warnings = line.warnings;
  state.record.camera = line.camera;
  state.inputs = line.inputs;
  state.load_seconds = line.seconds;
}

void RunState::apply(const journal::BeginLine& line) {
  VariantState& state = variant_of(line.place);
  state.begun = true;
  state.prepare = line.timing;
  state.inputs = line.inputs;
}

void RunState::apply(const journal::RetryLine& line) {
  VariantState& state = variant_of(line.place);
  VariantRecord again;
  again.name = state.record.name;
  again.method = state.record.method;
  again.role = state.record.role;
  again.reference = state.record.reference;
  again.options_json = state.record.options_json;
  again.status = "stopped";
  // Their files go when it is run.
  again.frames = state.record.frames;
  again.events = state.record.events;
  again.artifacts = state.record.artifacts;
  state = {};
  state.record = std::move(again);
  case_of(line.place.case_name).timed = false;
}

void RunState::apply(const journal::FrameLine& line) {
  VariantRecord& record = variant_of(line.place).record;
  if (line.index != record.frames.size()) {
    throw Error("frame " + std::to_string(line.index) + " of variant '" + line.place.variant +
                "' follows " + std::to_string(record.frames.size()) + " frames");
  }
  for (const StoredFile& file : line.files)
    require_stored_file(file, "frames", line.place, "files");
  record.frames.push_back({line.parameter, line.files});
  for (const auto& [name, value] : line.metrics)
    put(record.metrics[name].values, line.index, value);
  for (const auto& [name, value] : line.diagnostics) {
    put(record.diagnostics[name].values, line.index, value);
  }
  for (const auto& [phase, seconds] : line.timing) put(record.timing[phase], line.index, seconds);
}

void RunState::apply(const journal::EventLine& line) {
  require_event_numbers(line.event, "variant '" + line.place.variant + "': numbers");
  variant_of(line.place).record.events.push_back(line.event);
}

void RunState::apply(const journal::ArtifactLine& line) {
  VariantRecord& record = variant_of(line.place).record;
  require_stored_file(line.file, "artifacts", line.place, "name");
  record.artifacts.push_back(line.file);
}

void RunState::apply(const journal::CheckpointLine& line) {
  VariantState& state = variant_of(line.place);
  require_stored_file(line.file, "checkpoints", line.place, "name");
  state.checkpoint = line;
}

void RunState::apply(const journal::ResumeLine& line) {
  VariantRecord& record = variant_of(line.place).record;
  if (record.frames.size() < line.frames || record.events.size() < line.events ||
      record.artifacts.size() < line.artifacts) {
    throw Error("variant '" + line.place.variant + "' is resumed after more than it has");
  }
  record.frames.resize(line.frames);
  record.events.resize(line.events);
  record.artifacts.resize(line.artifacts);
  cut(
      record.metrics, line.frames, [](MetricColumn & c) -> auto& { return c.values; });
  cut(
      record.diagnostics, line.frames, [](DiagnosticColumn & c) -> auto& { return c.values; });
  for (auto it = record.timing.begin(); it != record.timing.end();) {
    if (it->second.size() > line.frames) it->second.resize(line.frames);
    it = it->second.empty() ? record.timing.erase(it) : std::next(it);
  }
}

void RunState::apply(const journal::EndLine& line) {
  VariantState& state = variant_of(line.place);
  state.ended = true;
  state.record.status = line.error.empty() ? "done" : "failed";
  state.record.error = line.error;
  state.record.memory = line.memory;
  // Columns that had no value at the last frames end with the frames.
  for (auto& [name, column] : state.record.metrics) {
    column.values.resize(state.record.frames.size(), kAbsent);
  }
  for (auto& [name, column] : state.record.diagnostics) {
    column.values.resize(state.record.frames.size(), kAbsent);
  }
  for (auto& [phase, rows] : state.record.timing) {
    rows.resize(state.record.frames.size(), {kAbsent});
  }
  for (const auto& [name, value] : line.summary) state.record.summary[name].value = value;
  put_rest(line.timing, state.record);
}

void RunState::apply(const journal::TimingLine& line) {
  CaseState& state = case_of(line.case_name);
  state.timed = true;
  state.record.ratios = line.ratios;
  for (const auto& [variant, phases] : line.timing) {
    VariantRecord& record = variant_of({line.case_name, variant}).record;
    for (const auto& [phase, seconds] : phases) record.timing[phase] = seconds;
  }
}

}  // namespace geoprior
