#include "testbed/runner/judgement/measured_run.h"

#include <algorithm>
#include <limits>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/formats/system_reason.h"
#include "testbed/runner/journal/content_hash.h"
#include "testbed/runner/journal/journal.h"
#include "testbed/runner/journal/recorded_frames.h"
#include "testbed/runner/journal/run_file.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/judgement/claims.h"
#include "testbed/runner/judgement/measure.h"
#include "testbed/runner/judgement/recorded_scene.h"
#include "testbed/runner/judgement/studies.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/process/build_info.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/run_folder.h"
#include "testbed/runner/spec/spec.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

/// Measures the variants of one case, a frame at a time.
class CaseMeasurement {
 public:
  CaseMeasurement(const Topic& topic, const Scene& scene, const FrameFiles& files,
                  const CaseRecord& recorded)
      : topic_(topic), scene_(scene), files_(files), recorded_(recorded) {}

  [[nodiscard]] VariantRecord measure(VariantRecord variant) const {
    variant.metrics.clear();
    variant.summary.clear();
    try {
      measure_frames(variant);
    } catch (const Error& error) {
      throw Error(error.what(), "case '" + recorded_.name + "', variant '" + variant.name + "'");
    }
    summarise(topic_, variant);
    return variant;
  }

 private:
  void measure_frames(VariantRecord& variant) const {
    const VariantRecord* reference = reference_of(recorded_, variant);
    // The metrics of a sequence have no meaning on a part of it.
    const bool is_sequence = has_sequence_metrics(topic_) && variant.error.empty();
    KeptFrames kept(is_sequence ? kMostKept : 0);
    for (std::size_t i = 0; i < variant.frames.size(); ++i) {
      throw_if_stopped();
      Frame frame = files_.frame(variant, i);
      for (const auto& [name, value] : values_at(frame, reference)) {
        std::vector<double>& column = variant.metrics[name].values;
        column.resize(variant.frames.size(), kAbsent);
        column[i] = value;
      }
      kept.keep(i, std::move(frame));
    }
    if (!is_sequence) return;
    for (const auto& [name, value] : values_of_sequence(variant, kept, reference)) {
      variant.summary[name].value = value;
    }
  }

  [[nodiscard]] std::map<std::string, double> values_at(const Frame& frame,
                                                        const VariantRecord* reference) const {
    std::optional<Frame> compared;
    if (reference != nullptr && has_reference_metrics(topic_)) {
      const int same = frame_of_parameter(reference->frames, frame.parameter);
      if (same >= 0) {
        compared =
            files_.frame(*reference, static_cast<std::size_t>(same), reference_parts(topic_));
      }
    }
    return measure_frame(topic_, scene_, frame, compared ? &*compared : nullptr);
  }

  [[nodiscard]] std::map<std::string, double> values_of_sequence(
      const VariantRecord& variant, const KeptFrames& kept, const VariantRecord* reference) const {
    const KeptFrames none(0);
    const auto compared = reference != nullptr ? std::optional<RecordedFrames>(
                                                     std::in_place, files_, *reference, none)
                                               : std::nullopt;
    return measure_sequence(topic_, scene_,
                            RecordedFrames(files_, variant, kept, compared ? &*compared : nullptr));
  }

  const Topic& topic_;
  const Scene& scene_;
  const FrameFiles& files_;
  const CaseRecord& recorded_;
};

/// A run that was made without times has no claims and studies about them, though its text has.
void leave_out_undecided_times(Experiment& experiment, const RunRecord& record) {
  std::erase_if(experiment.claims, [&](const ClaimSpec& claim) {
    return claim.exempt == Exemption::timing &&
           std::none_of(record.claims.begin(), record.claims.end(),
                        [&](const ClaimRecord& known) { return known.text == claim.text; });
  });
  std::erase_if(experiment.studies, [&](const StudySpec& study) {
    return study.quantity.starts_with("timing:") &&
           std::none_of(record.studies.begin(), record.studies.end(),
                        [&](const StudyRecord& known) { return known.name == study.name; });
  });
}

std::string program_text(const std::string& version, const std::string& commit,
                         const std::string& difference) {
  return "version " + version + "\ncommit " + commit + "\ndifference " + difference + "\n";
}

std::string our_program() {
  const BuildInfo& build = build_info();
  return program_text(build.version, build.git_commit, build.git_difference);
}

void add_provenance(const std::string& measured_content, RunRecord& record) {
  const BuildInfo& build = build_info();
  record.provenance["measured"] = utc_now();
  record.provenance["measured_version"] = build.version;
  record.provenance["measured_git_commit"] = build.git_commit;
  record.provenance["measured_git_difference"] = build.git_difference;
  record.provenance["measured_from"] = measured_content;
}

/// A file at its place in another folder, as a hard link where the file system allows it.
void link_file(const fs::path& from, const fs::path& to, const std::string& name) {
  const fs::path source = path_below(from, name);
  const fs::path target = path_below(to, name);
  make_folders(target.parent_path());
  std::error_code code;
  fs::create_hard_link(source, target, code);
  if (!code) return;
  fs::copy_file(source, target, code);
  if (code) throw Error("cannot be written: " + system_reason(code.value()), target.string());
}

/// A folder that takes its name when it is whole, and goes when it is not.
class PendingFolder {
 public:
  explicit PendingFolder(const fs::path& target)
      : target_(target), temporary_(target.string() + std::string(kTemporarySuffix)) {
    std::error_code code;
    made_ = fs::create_directory(temporary_, code);
    if (code) {
      throw Error("cannot be made: " + system_reason(code.value()), temporary_.string());
    }
    if (!made_) {
      throw Error("is there already: another program writes it, or was killed at it",
                  temporary_.string(), "another --out, or none of that name");
    }
  }
  ~PendingFolder() {
    std::error_code ignored;
    if (made_) fs::remove_all(temporary_, ignored);
  }
  PendingFolder(const PendingFolder&) = delete;
  PendingFolder& operator=(const PendingFolder&) = delete;

  [[nodiscard]] const fs::path& path() const { return temporary_; }
  void commit() {
    std::error_code code;
    fs::rename(temporary_, target_, code);  // onto an empty folder, or none
    if (code) throw Error("cannot be written: " + system_reason(code.value()), target_.string());
    made_ = false;
    flush_to_disk(target_.parent_path());
  }

 private:
  fs::path target_;
  fs::path temporary_;
  bool made_ = false;
};

void link_files(const RunRecord& record, const fs::path& from, const fs::path& to) {
  for (const char* name : {"spec.toml", "spec.json"}) {
    if (fs::exists(path_below(from, name))) link_file(from, to, name);
  }
  for (const CaseRecord& one : record.cases) {
    for (const VariantRecord& variant : one.variants) {
      throw_if_stopped();
      for (const FrameRecord& frame : variant.frames) {
        for (const StoredFile& file : frame.files) link_file(from, to, file.name);
      }
      for (const StoredFile& file : variant.artifacts) link_file(from, to, file.name);
      const std::string collection = "frames/" + one.name + "/" + variant.name + ".pvd";
      if (fs::exists(path_below(from, collection))) link_file(from, to, collection);
    }
  }
}

fs::path folder_for(const RunRecord& record, const std::optional<fs::path>& out) {
  if (!out) return unused_run_folder(record.experiment_id, record.spec_hash);
  std::error_code code;
  const bool is_free =
      !fs::exists(*out) || (fs::is_directory(*out) && fs::is_empty(*out, code) && !code);
  if (!is_free) {
    throw Error("is there already and not empty: a run is never overwritten", out->string(),
                "a new folder");
  }
  return fs::weakly_canonical(fs::absolute(*out));
}

using Columns = std::map<std::string, std::vector<double>>;

/// Values of a metric over all cases, variants and frames, in order.
Columns columns_of(const RunRecord& record) {
  Columns columns;
  for (const CaseRecord& one : record.cases) {
    for (const VariantRecord& variant : one.variants) {
      for (const auto& [name, column] : variant.metrics) {
        std::vector<double>& all = columns[name];
        all.insert(all.end(), column.values.begin(), column.values.end());
      }
      for (const auto& [name, value] : variant.summary) {
        // Statistics of a frame metric follow from its column.
        if (name.find('.') == std::string::npos) columns[name].push_back(value.value);
      }
    }
  }
  return columns;
}

bool are_equal(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return x == y || (x != x && y != y); });
}

}  // namespace

MeasuredRun measure_again(const OpenedRun& run, const std::vector<Topic>& topics) {
  require_recorded_files(run);
  MeasuredRun measured;
  measured.record = run.record();
  RunRecord& record = measured.record;
  Experiment& experiment = measured.experiment;
  const auto file = record.provenance.find("experiment_file");
  experiment = load_recorded_experiment(
      record.experiment_toml, (run.folder() / "run.h5").string() + ": experiment",
      file == record.provenance.end() ? run.folder() : input_file(file->second), topics);
  leave_out_undecided_times(experiment, record);
  const Topic& topic = topic_of(experiment, topics);
  const FrameFiles files(run.folder(), topic.looked_at);
  for (CaseRecord& one : record.cases) {
    throw_if_stopped();
    const CaseSpec& spec = case_spec(experiment, one.name);
    with_threads(spec.threads, [&] {
      const std::shared_ptr<Scene> scene = load_recorded_scene(experiment, spec, topics, record);
      const CaseMeasurement measurement(topic, *scene, files, one);
      for (VariantRecord& variant : one.variants) variant = measurement.measure(variant);
    });
  }
  record.schema_version = RunRecord{}.schema_version;
  record.spec_hash = sha256(record.spec_hash + "\nmeasured by\n" + our_program());
  add_provenance(run.record().content_sha256, record);
  set_hashes(record);
  if (record.frames_sha256 != run.record().frames_sha256) {
    throw Error("the frames that were measured are not those of the run", run.folder().string());
  }
  record.studies = make_studies(experiment, record);
  record.claims = decide_claims(experiment, record);
  return measured;
}

bool is_measured_by_us(const RunRecord& record) {
  const std::string prefix = record.provenance.contains("measured") ? "measured_" : "";
  const auto text = [&](const std::string& key) {
    const auto found = record.provenance.find(prefix + key);
    return found == record.provenance.end() ? std::string() : found->second;
  };
  return program_text(text("version"), text("git_commit"), text("git_difference")) == our_program();
}

fs::path write_measured_run(const MeasuredRun& measured, const OpenedRun& of,
                            const std::optional<fs::path>& out) {
  const RunRecord& record = measured.record;
  const fs::path target = folder_for(record, out);
  const MadeFolders parent(target.parent_path());
  PendingFolder folder(target);
  link_files(record, of.folder(), folder.path());
  write_run_file(record, folder.path() / "run.h5", folder.path());
  {
    const std::string experiment_file = input_name(measured.experiment.file);
    Journal journal(folder.path() / "journal.jsonl");
    journal.append(journal::RunLine{record.schema_version, record.experiment_id, record.spec_hash,
                                    record.provenance.at("measured"), experiment_file},
                   false);
    journal.append(journal::ResultLine{{"run.h5", sha256_of_file(folder.path() / "run.h5")}}, true);
  }
  throw_if_stopped();
  folder.commit();
  return target;
}

MetricChanges metric_changes(const RunRecord& before, const RunRecord& now) {
  const Columns old = columns_of(before);
  MetricChanges changes;
  const Columns columns = columns_of(now);
  for (const auto& [name, values] : columns) {
    const auto known = old.find(name);
    if (known == old.end()) {
      changes.added.push_back(name);
    } else if (!are_equal(known->second, values)) {
      changes.changed.push_back(name);
    }
  }
  for (const auto& [name, values] : old) {
    if (!columns.contains(name)) changes.gone.push_back(name);
  }
  return changes;
}

}  // namespace geoprior
