#include "testbed/runner/journal/run_file.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "testbed/formats/hdf5/content.h"
#include "testbed/formats/hdf5/file.h"
#include "testbed/runner/journal/content_hash.h"
#include "testbed/runner/journal/event_table.h"
#include "testbed/runner/journal/record_names.h"
#include "testbed/runner/journal/run_tables.h"

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
  if (variant.memory) {
    group.write_attribute("memory_start", variant.memory->start);
    group.write_attribute("memory_peak", variant.memory->peak);
  }
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
  group.write_attribute("claims_only", static_cast<std::int64_t>(record.claims_only ? 1 : 0));
  group.write_attribute("scene", record.scene_json);
  group.write_attribute("warnings", record.warnings);
  if (!record.camera.empty()) group.write_attribute("camera", record.camera);
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
  std::vector<std::string> text, cases, detail, null, null_verdict, null_detail, passed_too;
  std::vector<std::string> variant, outcome, nearest, excepted, input, graded;
  std::vector<double> left, right, null_left, null_right, least;
  std::vector<std::int64_t> holds;
  for (const ClaimRecord& claim : claims) {
    text.push_back(claim.text);
    cases.push_back(claim.case_name);
    detail.push_back(claim.detail);
    left.push_back(claim.left);
    right.push_back(claim.right);
    holds.push_back(claim.holds ? 1 : 0);
    null.push_back(claim.null.variant);
    null_verdict.push_back(text_of(claim.null.verdict));
    null_left.push_back(claim.null.left);
    null_right.push_back(claim.null.right);
    null_detail.push_back(claim.null.detail);
    passed_too.push_back(claim.passed_too);
    variant.push_back(claim.variant);
    outcome.push_back(text_of(outcome_of(claim)));
    nearest.push_back(claim.nearest);
    excepted.push_back(claim.excepted);
    input.push_back(claim.grade.input);
    graded.push_back(text_of(claim.grade.of));
    least.push_back(claim.grade.least);
  }
  root.write_table("claims", {{"text", text},
                              {"case", cases},
                              {"detail", detail},
                              {"left", left},
                              {"right", right},
                              {"holds", holds},
                              {"null", null},
                              {"null_verdict", null_verdict},
                              {"null_left", null_left},
                              {"null_right", null_right},
                              {"null_detail", null_detail},
                              {"passed_too", passed_too},
                              {"variant", variant},
                              {"outcome", outcome},
                              {"nearest", nearest},
                              {"excepted", excepted},
                              {"input", input},
                              {"graded", graded},
                              {"least_grade", least}});
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

namespace {

template <class T>
std::vector<T>& column(std::vector<H5Column>& columns, std::size_t i) {
  return std::get<std::vector<T>>(columns[i].values);
}

using Texts = std::vector<std::string>;
using Numbers = std::vector<double>;
using Integers = std::vector<std::int64_t>;

/// Names of the groups inside, ordered by their attribute `index`.
std::vector<std::string> in_order(const H5Node& group) {
  std::vector<std::pair<std::int64_t, std::string>> names;
  for (const std::string& name : group.children()) {
    names.emplace_back(group.open_group(name).read_int("index"), name);
  }
  std::sort(names.begin(), names.end());
  std::vector<std::string> out;
  for (auto& [index, name] : names) out.push_back(std::move(name));
  return out;
}

std::vector<StoredFile> read_stored_files(const H5Node& group, const std::string& name) {
  std::vector<H5Column> table{{"name", Texts{}}, {"sha256", Texts{}}};
  group.read_table(name, table);
  std::vector<StoredFile> files;
  for (std::size_t i = 0; i < column<std::string>(table, 0).size(); ++i) {
    files.push_back({column<std::string>(table, 0)[i], column<std::string>(table, 1)[i]});
  }
  return files;
}

std::vector<FrameRecord> read_frames(const H5Node& group) {
  const H5Array parameter = group.read_array("parameter");
  std::vector<FrameRecord> frames(parameter.values.size());
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].parameter = parameter.values[i];
  std::vector<H5Column> table{{"frame", Integers{}}, {"name", Texts{}}, {"sha256", Texts{}}};
  group.read_table("frames", table);
  const Integers& index = column<std::int64_t>(table, 0);
  for (std::size_t row = 0; row < index.size(); ++row) {
    if (index[row] < 0 || index[row] >= static_cast<std::int64_t>(frames.size())) {
      throw Error("the table of frames names frame " + std::to_string(index[row]) + " of " +
                  std::to_string(frames.size()));
    }
    frames[index[row]].files.push_back(
        {column<std::string>(table, 1)[row], column<std::string>(table, 2)[row]});
  }
  return frames;
}

std::vector<std::vector<double>> timing_rows(const H5Array& array) {
  if (array.extents.size() != 2) throw Error("a timing has not two extents");
  std::vector<std::vector<double>> rows(array.extents[0]);
  auto from = array.values.begin();
  for (auto& row : rows) {
    const auto to = from + array.extents[1];
    row.assign(from, to);
    from = to;
  }
  return rows;
}

void read_numbers(const H5Node& group, VariantRecord& variant) {
  const H5Node metrics = group.open_group("metrics");
  for (const std::string& name : metrics.children()) {
    H5Array array = metrics.read_array(name);
    variant.metrics[name] = {array.attributes.at("unit"), array.attributes.at("definition"),
                             array.attributes.at("direction"), std::move(array.values)};
  }
  const H5Node summary = group.open_group("summary");
  for (const std::string& name : summary.children()) {
    const H5Array array = summary.read_array(name);
    variant.summary[name] = {array.values.at(0), array.attributes.at("unit"),
                             array.attributes.at("definition"), array.attributes.at("direction")};
  }
  const H5Node diagnostics = group.open_group("diagnostics");
  for (const std::string& name : diagnostics.children()) {
    H5Array array = diagnostics.read_array(name);
    // Empty in runs that were written before the topics had tables of diagnostics.
    variant.diagnostics[name] = {array.attributes["unit"], array.attributes["definition"],
                                 std::move(array.values)};
  }
  const H5Node timing = group.open_group("timing");
  for (const std::string& phase : timing.children()) {
    variant.timing[phase] = timing_rows(timing.read_array(phase));
  }
}

bool has_attribute(const H5Node& group, const std::string& name) {
  const std::vector<std::string> names = group.attributes();
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// What schema version 1 did not have.
std::string read_text_or_none(const H5Node& group, const std::string& name) {
  return has_attribute(group, name) ? group.read_text(name) : std::string();
}

std::optional<MemoryUse> read_memory(const H5Node& group) {
  if (!has_attribute(group, "memory_peak")) return std::nullopt;
  return MemoryUse{group.read_unsigned("memory_start"), group.read_unsigned("memory_peak")};
}

VariantRecord read_variant(const H5Node& group, const std::string& name) {
  VariantRecord variant;
  variant.name = name;
  variant.method = group.read_text("method");
  variant.role = group.read_text("role");
  variant.reference = group.read_text("reference");
  variant.options_json = group.read_text("options");
  variant.status = group.read_text("status");
  variant.error = read_text_or_none(group, "error");
  variant.memory = read_memory(group);
  variant.frames = read_frames(group);
  read_numbers(group, variant);
  variant.events = read_events(group);
  variant.artifacts = read_stored_files(group, "artifacts");
  return variant;
}

std::vector<TimingRatio> read_ratios(const H5Node& group, std::int64_t version) {
  std::vector<H5Column> table{{"variant", Texts{}},
                              {"of", Texts{}},
                              {"median_ratio", Numbers{}},
                              {"low", Numbers{}},
                              {"high", Numbers{}}};
  if (version > 1) table.push_back({"paired", Texts{}});
  group.read_table("ratios", table);
  std::vector<TimingRatio> ratios;
  for (std::size_t i = 0; i < column<std::string>(table, 0).size(); ++i) {
    ratios.push_back({column<std::string>(table, 0)[i], column<std::string>(table, 1)[i],
                      column<double>(table, 2)[i], column<double>(table, 3)[i],
                      column<double>(table, 4)[i], "frame"});
    if (version > 1) ratios.back().paired = column<std::string>(table, 5)[i];
  }
  return ratios;
}

CaseRecord read_case(const H5Node& group, const std::string& name, std::int64_t version) {
  CaseRecord record;
  record.name = name;
  record.parameter_name = group.read_text("parameter_name");
  record.parameter_unit = group.read_text("parameter_unit");
  record.seed = group.read_unsigned("seed");
  record.threads = static_cast<int>(group.read_int("threads"));
  record.claims_only = has_attribute(group, "claims_only") && group.read_int("claims_only") != 0;
  record.scene_json = group.read_text("scene");
  record.warnings = group.read_texts("warnings");
  if (has_attribute(group, "camera")) record.camera = group.read_text("camera");
  const H5Node swept = group.open_group("swept");
  for (const std::string& key : swept.attributes()) record.swept[key] = swept.read_text(key);
  const H5Node facts = group.open_group("facts");
  for (const std::string& key : facts.attributes()) record.facts[key] = facts.read_double(key);
  record.ratios = read_ratios(group, version);
  const H5Node variants = group.open_group("variants");
  for (const std::string& variant : in_order(variants)) {
    record.variants.push_back(read_variant(variants.open_group(variant), variant));
  }
  return record;
}

std::vector<StudyRecord> read_studies(const H5Node& parent) {
  std::vector<StudyRecord> studies;
  for (const std::string& name : in_order(parent)) {
    const H5Node group = parent.open_group(name);
    StudyRecord& study = studies.emplace_back();
    study.name = name;
    study.kind = group.read_text("kind");
    study.quantity = group.read_text("quantity");
    study.value = group.read_double("value");
    study.low = group.read_double("low");
    study.high = group.read_double("high");
    study.x = group.read_array("x").values;
    study.y = group.read_array("y").values;
    if (group.has("y_of")) study.y_of = group.read_array("y_of").values;
  }
  return studies;
}

/// The enumerator that a column of the claims has the word of.
template <class Enum, std::size_t n>
Enum enumerator_of(const std::string& text, const std::array<std::string_view, n>& words,
                   const std::string& column_name) {
  const auto found = std::find(words.begin(), words.end(), text);
  if (found == words.end()) {
    throw Error("'" + text + "' is no value of the column", "claims: " + column_name);
  }
  return static_cast<Enum>(found - words.begin());
}

/// What schema version 2 did not have.
void read_nulls(const H5Node& root, std::vector<ClaimRecord>& claims) {
  std::vector<H5Column> table{{"null", Texts{}},        {"null_verdict", Texts{}},
                              {"null_detail", Texts{}}, {"passed_too", Texts{}},
                              {"null_left", Numbers{}}, {"null_right", Numbers{}}};
  root.read_table("claims", table);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    NullRecord& null = claims[i].null;
    null.variant = column<std::string>(table, 0)[i];
    null.verdict = enumerator_of<Discrimination>(column<std::string>(table, 1)[i], kDiscriminations,
                                                 "null_verdict");
    null.detail = column<std::string>(table, 2)[i];
    claims[i].passed_too = column<std::string>(table, 3)[i];
    null.left = column<double>(table, 4)[i];
    null.right = column<double>(table, 5)[i];
  }
}

/// What schema version 3 did not have. The outcome follows from the rest.
void read_grades(const H5Node& root, std::vector<ClaimRecord>& claims) {
  std::vector<H5Column> table{{"variant", Texts{}},  {"nearest", Texts{}},
                              {"excepted", Texts{}}, {"input", Texts{}},
                              {"graded", Texts{}},   {"least_grade", Numbers{}}};
  root.read_table("claims", table);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    claims[i].variant = column<std::string>(table, 0)[i];
    claims[i].nearest = column<std::string>(table, 1)[i];
    claims[i].excepted = column<std::string>(table, 2)[i];
    claims[i].grade.input = column<std::string>(table, 3)[i];
    claims[i].grade.of =
        enumerator_of<Graded>(column<std::string>(table, 4)[i], kGradeds, "graded");
    claims[i].grade.least = column<double>(table, 5)[i];
  }
}

std::vector<ClaimRecord> read_claims(const H5Node& root, int schema_version) {
  std::vector<H5Column> table{{"text", Texts{}},   {"case", Texts{}},    {"detail", Texts{}},
                              {"left", Numbers{}}, {"right", Numbers{}}, {"holds", Integers{}}};
  root.read_table("claims", table);
  std::vector<ClaimRecord> claims;
  for (std::size_t i = 0; i < column<std::string>(table, 0).size(); ++i) {
    claims.push_back({column<std::string>(table, 0)[i], column<std::string>(table, 1)[i],
                      column<std::string>(table, 2)[i], column<double>(table, 3)[i],
                      column<double>(table, 4)[i], column<std::int64_t>(table, 5)[i] != 0});
  }
  if (schema_version >= 3) read_nulls(root, claims);
  if (schema_version >= 4) read_grades(root, claims);
  return claims;
}

void check_version(const H5Node& root) {
  const std::int64_t version = root.read_int("schema_version");
  const int known = RunRecord{}.schema_version;
  if (version < 1 || version > known) {
    throw Error("has schema version " + std::to_string(version), "",
                "up to " + std::to_string(known));
  }
}

/// Runs that were written before the content hash was split have its halves nowhere.
bool is_half(std::string RunRecord::*member) {
  return member == &RunRecord::frames_sha256 || member == &RunRecord::metrics_sha256;
}

bool is_in(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

RunRecord read_root(const H5Node& root) {
  check_version(root);
  RunRecord record;
  record.schema_version = static_cast<int>(root.read_int("schema_version"));
  record.quick = root.read_int("quick") != 0;
  const std::vector<std::string> attributes = root.attributes();
  for (const auto& [name, member] : kRootTexts) {
    if (is_in(attributes, name) || !is_half(member)) record.*member = root.read_text(name);
  }
  for (const std::string& key : attributes) {
    const auto is_key = [&](const auto& entry) { return entry.first == key; };
    if (key == "schema_version" || key == "quick" ||
        std::any_of(kRootTexts.begin(), kRootTexts.end(), is_key)) {
      continue;
    }
    record.provenance[key] = root.read_text(key);
  }
  record.inputs = read_stored_files(root, "inputs");
  const H5Node cases = root.open_group("cases");
  for (const std::string& name : in_order(cases)) {
    record.cases.push_back(read_case(cases.open_group(name), name, record.schema_version));
  }
  record.studies = read_studies(root.open_group("study"));
  record.claims = read_claims(root, record.schema_version);
  if (!is_in(attributes, "frames_sha256")) record.frames_sha256 = frames_sha256(record);
  if (!is_in(attributes, "metrics_sha256")) record.metrics_sha256 = metrics_sha256(record);
  return record;
}

}  // namespace

RunRecord read_run_file(const std::filesystem::path& file) {
  // Every failure becomes one Error that begins with the file's name.
  const auto fail = [&](const std::string& reason) -> Error {
    const std::string name = file.string();
    return reason.starts_with(name) ? Error(reason) : Error(reason, name);
  };
  try {
    RunRecord record = read_root(read_hdf5(file));
    require_names(record, file.string());
    return record;
  } catch (const Error& error) {
    throw fail(error.what());
  } catch (const std::out_of_range&) {
    throw fail("is damaged: a unit, definition or direction is missing");
  }
}

}  // namespace geoprior
