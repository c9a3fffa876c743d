#include <algorithm>

#include "core/error.h"
#include "experiments/formats/hdf5_file.h"
#include "experiments/runner/run_file.h"

namespace geoprior {

namespace {

template <class T>
std::vector<T>& column(std::vector<H5Column>& columns, std::size_t i) {
  return std::get<std::vector<T>>(columns[i].values);
}

using Texts = std::vector<std::string>;
using Numbers = std::vector<double>;
using Integers = std::vector<std::int64_t>;
using Positions = std::vector<std::array<double, 3>>;

/// Names of the groups inside, ordered by their attribute `index`.
std::vector<std::string> in_order(const H5Group& group) {
  std::vector<std::pair<std::int64_t, std::string>> names;
  for (const std::string& name : group.children()) {
    names.emplace_back(group.open_group(name).read_int("index"), name);
  }
  std::sort(names.begin(), names.end());
  std::vector<std::string> out;
  for (auto& [index, name] : names) out.push_back(std::move(name));
  return out;
}

std::vector<StoredFile> read_stored_files(const H5Group& group, const std::string& name) {
  std::vector<H5Column> table{{"name", Texts{}}, {"sha256", Texts{}}};
  group.read_table(name, table);
  std::vector<StoredFile> files;
  for (std::size_t i = 0; i < column<std::string>(table, 0).size(); ++i) {
    files.push_back({column<std::string>(table, 0)[i], column<std::string>(table, 1)[i]});
  }
  return files;
}

std::vector<FrameRecord> read_frames(const H5Group& group) {
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
    frames[static_cast<std::size_t>(index[row])].files.push_back(
        {column<std::string>(table, 1)[row], column<std::string>(table, 2)[row]});
  }
  return frames;
}

std::vector<Event> read_events(const H5Group& group) {
  std::vector<H5Column> table{{"time_s", Numbers{}},
                              {"kind", Texts{}},
                              {"position", Positions{}},
                              {"energy_J", Numbers{}},
                              {"duration_s", Numbers{}}};
  group.read_table("events", table);
  std::vector<Event> events(column<double>(table, 0).size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    events[i].time_s = column<double>(table, 0)[i];
    events[i].kind = column<std::string>(table, 1)[i];
    const std::array<double, 3>& x = column<std::array<double, 3>>(table, 2)[i];
    events[i].position = {x[0], x[1], x[2]};
    events[i].energy_J = column<double>(table, 3)[i];
    events[i].duration_s = column<double>(table, 4)[i];
  }
  return events;
}

std::vector<std::vector<double>> timing_rows(const H5Array& array) {
  if (array.extents.size() != 2) throw Error("a timing has not two extents");
  std::vector<std::vector<double>> rows(array.extents[0]);
  auto from = array.values.begin();
  for (auto& row : rows) {
    const auto to = from + static_cast<std::ptrdiff_t>(array.extents[1]);
    row.assign(from, to);
    from = to;
  }
  return rows;
}

void read_numbers(const H5Group& group, VariantRecord& variant) {
  const H5Group metrics = group.open_group("metrics");
  for (const std::string& name : metrics.children()) {
    H5Array array = metrics.read_array(name);
    variant.metrics[name] = {array.attributes.at("unit"), array.attributes.at("definition"),
                             array.attributes.at("direction"), std::move(array.values)};
  }
  const H5Group summary = group.open_group("summary");
  for (const std::string& name : summary.children()) {
    const H5Array array = summary.read_array(name);
    variant.summary[name] = {array.values.at(0), array.attributes.at("unit"),
                             array.attributes.at("definition"), array.attributes.at("direction")};
  }
  const H5Group diagnostics = group.open_group("diagnostics");
  for (const std::string& name : diagnostics.children()) {
    H5Array array = diagnostics.read_array(name);
    // Empty in runs that were written before the topics had tables of diagnostics.
    variant.diagnostics[name] = {array.attributes["unit"], array.attributes["definition"],
                                 std::move(array.values)};
  }
  const H5Group timing = group.open_group("timing");
  for (const std::string& phase : timing.children()) {
    variant.timing[phase] = timing_rows(timing.read_array(phase));
  }
}

/// What schema version 1 did not have.
std::string read_text_or_none(const H5Group& group, const std::string& name) {
  const std::vector<std::string> names = group.attributes();
  const bool there = std::find(names.begin(), names.end(), name) != names.end();
  return there ? group.read_text(name) : std::string();
}

VariantRecord read_variant(const H5Group& group, const std::string& name) {
  VariantRecord variant;
  variant.name = name;
  variant.method = group.read_text("method");
  variant.role = group.read_text("role");
  variant.reference = group.read_text("reference");
  variant.options_json = group.read_text("options");
  variant.status = group.read_text("status");
  variant.error = read_text_or_none(group, "error");
  variant.frames = read_frames(group);
  read_numbers(group, variant);
  variant.events = read_events(group);
  variant.artifacts = read_stored_files(group, "artifacts");
  return variant;
}

std::vector<TimingRatio> read_ratios(const H5Group& group, std::int64_t version) {
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

CaseRecord read_case(const H5Group& group, const std::string& name, std::int64_t version) {
  CaseRecord record;
  record.name = name;
  record.parameter_name = group.read_text("parameter_name");
  record.parameter_unit = group.read_text("parameter_unit");
  record.seed = group.read_unsigned("seed");
  record.threads = static_cast<int>(group.read_int("threads"));
  record.scene_json = group.read_text("scene");
  record.warnings = group.read_texts("warnings");
  const H5Group swept = group.open_group("swept");
  for (const std::string& key : swept.attributes()) record.swept[key] = swept.read_text(key);
  const H5Group facts = group.open_group("facts");
  for (const std::string& key : facts.attributes()) record.facts[key] = facts.read_double(key);
  record.ratios = read_ratios(group, version);
  const H5Group variants = group.open_group("variants");
  for (const std::string& variant : in_order(variants)) {
    record.variants.push_back(read_variant(variants.open_group(variant), variant));
  }
  return record;
}

std::vector<StudyRecord> read_studies(const H5Group& parent) {
  std::vector<StudyRecord> studies;
  for (const std::string& name : in_order(parent)) {
    const H5Group group = parent.open_group(name);
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

std::vector<ClaimRecord> read_claims(const H5Group& root) {
  std::vector<H5Column> table{{"text", Texts{}},   {"case", Texts{}},    {"detail", Texts{}},
                              {"left", Numbers{}}, {"right", Numbers{}}, {"holds", Integers{}}};
  root.read_table("claims", table);
  std::vector<ClaimRecord> claims;
  for (std::size_t i = 0; i < column<std::string>(table, 0).size(); ++i) {
    claims.push_back({column<std::string>(table, 0)[i], column<std::string>(table, 1)[i],
                      column<std::string>(table, 2)[i], column<double>(table, 3)[i],
                      column<double>(table, 4)[i], column<std::int64_t>(table, 5)[i] != 0});
  }
  return claims;
}

void check_version(const H5Group& root) {
  const std::int64_t version = root.read_int("schema_version");
  const int known = RunRecord{}.schema_version;
  if (version < 1 || version > known) {
    throw Error("has schema version " + std::to_string(version), "",
                "up to " + std::to_string(known));
  }
}

RunRecord read_root(const H5Group& root) {
  check_version(root);
  RunRecord record;
  record.schema_version = static_cast<int>(root.read_int("schema_version"));
  record.quick = root.read_int("quick") != 0;
  for (const auto& [name, member] : kRootTexts) record.*member = root.read_text(name);
  for (const std::string& key : root.attributes()) {
    const auto is_key = [&](const auto& entry) { return entry.first == key; };
    if (key == "schema_version" || key == "quick" ||
        std::any_of(kRootTexts.begin(), kRootTexts.end(), is_key)) {
      continue;
    }
    record.provenance[key] = root.read_text(key);
  }
  record.inputs = read_stored_files(root, "inputs");
  const H5Group cases = root.open_group("cases");
  for (const std::string& name : in_order(cases)) {
    record.cases.push_back(read_case(cases.open_group(name), name, record.schema_version));
  }
  record.studies = read_studies(root.open_group("study"));
  record.claims = read_claims(root);
  return record;
}

/// Every failure becomes one Error that begins with the file's name.
template <class Read>
auto reading(const std::filesystem::path& file, Read read) {
  const auto fail = [&](const std::string& reason) -> Error {
    const std::string name = file.string();
    return reason.starts_with(name) ? Error(reason) : Error(reason, name);
  };
  try {
    const H5File in = H5File::open_for_reading(file);
    return read(in.root());
  } catch (const Error& error) {
    throw fail(error.what());
  } catch (const std::out_of_range&) {
    throw fail("is damaged: a unit, definition or direction is missing");
  }
}

}  // namespace

RunRecord read_run_file(const std::filesystem::path& file) {
  return reading(file, [](const H5Group& root) { return read_root(root); });
}

std::string read_spec_hash(const std::filesystem::path& run_file) {
  return reading(run_file, [](const H5Group& root) { return root.read_text("spec_hash"); });
}

}  // namespace geoprior
