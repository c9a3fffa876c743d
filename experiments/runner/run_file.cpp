#include "experiments/runner/run_file.h"

#include <algorithm>
#include <limits>

#include "experiments/formats/hdf5_file.h"
#include "experiments/runner/run_tables.h"

namespace geoprior {

namespace {

template <class T>
void write_each(H5Group& parent, const std::string& name, const T& map) {
  H5Group group = parent.create_group(name);
  for (const auto& [key, value] : map) group.write_attribute(key, value);
}

void write_stored_files(H5Group& group, const std::string& name,
                        const std::vector<StoredFile>& files) {
  std::vector<std::string> names;
  std::vector<std::string> sums;
  for (const StoredFile& file : files) {
    names.push_back(file.name);
    sums.push_back(file.sha256);
  }
  group.write_table(name, {{"name", names}, {"sha256", sums}});
}

void write_frames(H5Group& group, const std::vector<FrameRecord>& frames) {
  std::vector<std::int64_t> index;
  std::vector<std::string> names;
  std::vector<std::string> sums;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (const StoredFile& file : frames[i].files) {
      index.push_back(static_cast<std::int64_t>(i));
      names.push_back(file.name);
      sums.push_back(file.sha256);
    }
  }
  group.write_table("frames", {{"frame", index}, {"name", names}, {"sha256", sums}});
}

void write_events(H5Group& group, const std::vector<Event>& events) {
  std::vector<double> time, energy, duration;
  std::vector<std::string> kind;
  std::vector<std::array<double, 3>> position;
  for (const Event& event : events) {
    time.push_back(event.time_s);
    kind.push_back(event.kind);
    position.push_back({event.position.x(), event.position.y(), event.position.z()});
    energy.push_back(event.energy_J);
    duration.push_back(event.duration_s);
  }
  group.write_table("events", {{"time_s", time},
                               {"kind", kind},
                               {"position", position},
                               {"energy_J", energy},
                               {"duration_s", duration}});
}

/// Rows are frames, columns repetitions; a phase that some frame did not enter has NaN there.
H5Array timing_array(const std::vector<std::vector<double>>& seconds) {
  std::size_t repetitions = 0;
  for (const auto& row : seconds) repetitions = std::max(repetitions, row.size());
  H5Array array{{seconds.size(), repetitions}, {}, {{"unit", "s"}}};
  for (const auto& row : seconds) {
    array.values.insert(array.values.end(), row.begin(), row.end());
    array.values.resize(array.values.size() + repetitions - row.size(),
                        std::numeric_limits<double>::quiet_NaN());
  }
  return array;
}

void write_numbers(H5Group& group, const VariantRecord& variant) {
  H5Group metrics = group.create_group("metrics");
  for (const auto& [name, column] : variant.metrics) {
    metrics.write_array(name, {{column.values.size()},
                               column.values,
                               {{"unit", column.unit},
                                {"definition", column.definition},
                                {"direction", column.direction}}});
  }
  H5Group summary = group.create_group("summary");
  for (const auto& [name, value] : variant.summary) {
    summary.write_array(
        name,
        {{},
         {value.value},
         {{"unit", value.unit}, {"definition", value.definition}, {"direction", value.direction}}});
  }
  H5Group diagnostics = group.create_group("diagnostics");
  for (const auto& [name, column] : variant.diagnostics) {
    diagnostics.write_array(name, {{column.values.size()},
                                   column.values,
                                   {{"unit", column.unit}, {"definition", column.definition}}});
  }
  H5Group timing = group.create_group("timing");
  for (const auto& [phase, seconds] : variant.timing) {
    timing.write_array(phase, timing_array(seconds));
  }
}

/// The run folder that tables are read from; null: no tables.
using TableSource = const std::filesystem::path*;

void write_tables(H5Group& group, const VariantRecord& variant, TableSource run_folder) {
  if (run_folder == nullptr) return;
  const std::map<std::string, StackedTable> tables = stacked_tables(variant, *run_folder);
  if (tables.empty()) return;
  H5Group parent = group.create_group("tables");
  for (const auto& [name, table] : tables) parent.write_matrix(name, table.columns, table.values);
}

void write_variant(H5Group& parent, const CaseRecord& of, std::size_t index,
                   TableSource run_folder) {
  const VariantRecord& variant = of.variants[index];
  H5Group group = parent.create_group(variant.name);
  group.write_attribute("index", static_cast<std::int64_t>(index));
  group.write_attribute("method", variant.method);
  group.write_attribute("role", variant.role);
  group.write_attribute("reference", variant.reference);
  group.write_attribute("options", variant.options_json);
  group.write_attribute("status", variant.status);
  group.write_attribute("error", variant.error);
  H5Array parameter{
      {variant.frames.size()}, {}, {{"name", of.parameter_name}, {"unit", of.parameter_unit}}};
  for (const FrameRecord& frame : variant.frames) parameter.values.push_back(frame.parameter);
  group.write_array("parameter", parameter);
  write_frames(group, variant.frames);
  write_numbers(group, variant);
  write_events(group, variant.events);
  write_tables(group, variant, run_folder);
  write_stored_files(group, "artifacts", variant.artifacts);
}

void write_ratios(H5Group& group, const std::vector<TimingRatio>& ratios) {
  std::vector<std::string> variant, of, paired;
  std::vector<double> median, low, high;
  for (const TimingRatio& ratio : ratios) {
    paired.push_back(ratio.paired);
    variant.push_back(ratio.variant);
    of.push_back(ratio.of);
    median.push_back(ratio.median_ratio);
    low.push_back(ratio.low);
    high.push_back(ratio.high);
  }
  group.write_table("ratios", {{"variant", variant},
                               {"of", of},
                               {"median_ratio", median},
                               {"low", low},
                               {"high", high},
                               {"paired", paired}});
}

void write_case(H5Group& parent, const CaseRecord& record, std::size_t index,
                TableSource run_folder) {
  H5Group group = parent.create_group(record.name);
  group.write_attribute("index", static_cast<std::int64_t>(index));
  group.write_attribute("parameter_name", record.parameter_name);
  group.write_attribute("parameter_unit", record.parameter_unit);
  group.write_attribute("seed", record.seed);
  group.write_attribute("threads", static_cast<std::int64_t>(record.threads));
  group.write_attribute("scene", record.scene_json);
  group.write_attribute("warnings", record.warnings);
  write_each(group, "swept", record.swept);
  write_each(group, "facts", record.facts);
  write_ratios(group, record.ratios);
  H5Group variants = group.create_group("variants");
  for (std::size_t v = 0; v < record.variants.size(); ++v)
    write_variant(variants, record, v, run_folder);
}

void write_studies(H5Group& root, const std::vector<StudyRecord>& studies) {
  H5Group parent = root.create_group("study");
  for (std::size_t s = 0; s < studies.size(); ++s) {
    const StudyRecord& study = studies[s];
    H5Group group = parent.create_group(study.name);
    group.write_attribute("index", static_cast<std::int64_t>(s));
    group.write_attribute("kind", study.kind);
    group.write_attribute("quantity", study.quantity);
    group.write_attribute("value", study.value);
    group.write_attribute("low", study.low);
    group.write_attribute("high", study.high);
    group.write_array("x", {{study.x.size()}, study.x, {}});
    group.write_array("y", {{study.y.size()}, study.y, {}});
    group.write_array("y_of", {{study.y_of.size()}, study.y_of, {}});
  }
}

void write_claims(H5Group& root, const std::vector<ClaimRecord>& claims) {
  std::vector<std::string> text, cases, detail;
  std::vector<double> left, right;
  std::vector<std::int64_t> holds;
  for (const ClaimRecord& claim : claims) {
    text.push_back(claim.text);
    cases.push_back(claim.case_name);
    detail.push_back(claim.detail);
    left.push_back(claim.left);
    right.push_back(claim.right);
    holds.push_back(claim.holds ? 1 : 0);
  }
  root.write_table("claims", {{"text", text},
                              {"case", cases},
                              {"detail", detail},
                              {"left", left},
                              {"right", right},
                              {"holds", holds}});
}

void write_root(H5Group root, const RunRecord& record, TableSource run_folder) {
  root.write_attribute("schema_version", static_cast<std::int64_t>(record.schema_version));
  root.write_attribute("quick", static_cast<std::int64_t>(record.quick ? 1 : 0));
  for (const auto& [name, member] : kRootTexts) {
    root.write_attribute(std::string(name), record.*member);
  }
  for (const auto& [key, text] : record.provenance) root.write_attribute(key, text);
  write_stored_files(root, "inputs", record.inputs);
  H5Group cases = root.create_group("cases");
  for (std::size_t c = 0; c < record.cases.size(); ++c)
    write_case(cases, record.cases[c], c, run_folder);
  write_studies(root, record.studies);
  write_claims(root, record.claims);
}

void write_file(const RunRecord& record, const std::filesystem::path& file,
                TableSource run_folder) {
  const H5File out = H5File::create();
  write_root(out.root(), record, run_folder);
  out.save(file);
}

}  // namespace

void write_run_file(const RunRecord& record, const std::filesystem::path& file) {
  write_file(record, file, nullptr);
}

void write_run_file(const RunRecord& record, const std::filesystem::path& file,
                    const std::filesystem::path& run_folder) {
  write_file(record, file, &run_folder);
}

}  // namespace geoprior
