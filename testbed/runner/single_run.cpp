#include "testbed/runner/single_run.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/joined.h"
#include "testbed/runner/case_runner.h"
#include "testbed/runner/journal/content_hash.h"
#include "testbed/runner/journal/journal.h"
#include "testbed/runner/journal/recorder.h"
#include "testbed/runner/journal/run_file.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/judgement/claims.h"
#include "testbed/runner/judgement/grades.h"
#include "testbed/runner/judgement/measure.h"
#include "testbed/runner/judgement/studies.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/process/processor_time.h"
#include "testbed/runner/process/progress.h"
#include "testbed/runner/process/provenance.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/run_folder.h"
#include "testbed/runner/run_state.h"
#include "testbed/runner/spec/json.h"
#include "testbed/streams.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

void require_same_specification(const std::string& recorded, const Experiment& experiment,
                                const fs::path& folder) {
  if (recorded == experiment.hash) return;
  throw Error("the run has another specification than '" + experiment.id + "' has now (hash " +
                  recorded.substr(0, 8) + ", not " + experiment.hash.substr(0, 8) +
                  "): it cannot be resumed",
              folder.string(),
              "the same experiment file, --set, --variant, --quick, --threads and program version");
}

/// The record of a run that is finished already; absent when there is work left.
/// @throws Error  for another specification, and when a frame or artifact is not what was recorded:
///                what is finished is not made anew
std::optional<RunRecord> finished_record(const Experiment& experiment, const fs::path& folder) {
  if (!recorded_result(folder)) return std::nullopt;
  require_same_specification(recorded_hash(folder).value_or(""), experiment, folder);
  std::optional<OpenedRun> run;
  try {
    run.emplace(folder);
  } catch (const Error& error) {
    // The journal has it all.
    say(std::string(error.what()) + ": assembled again from the journal");
    return std::nullopt;
  }
  require_recorded_files(*run);
  return run->record();
}

RunState restore(const Experiment& experiment, const Journal& journal, const fs::path& folder) {
  RunState state(experiment);
  for (std::size_t i = 0; i < journal.lines().size(); ++i) {
    const auto* head = std::get_if<journal::RunLine>(&journal.lines()[i]);
    if ((i == 0) != (head != nullptr)) {
      throw Error("the journal does not begin with one line of kind 'run'",
                  (folder / "journal.jsonl").string());
    }
    if (head != nullptr) require_same_specification(head->spec_hash, experiment, folder);
    try {
      state.apply(journal.lines()[i]);
    } catch (const Error& error) {
      throw Error(error.what(), (folder / "journal.jsonl").string() + ":" + std::to_string(i + 1));
    }
  }
  return state;
}

void begin_run(const Experiment& experiment, Recorder& recorder) {
  write_file_atomically(recorder.folder() / "spec.toml", experiment.resolved_toml);
  write_file_atomically(recorder.folder() / "spec.json", spec_json(experiment));
  recorder.add(journal::RunLine{RunRecord{}.schema_version, experiment.id, experiment.hash,
                                utc_now(), input_name(experiment.file)});
}

std::vector<StoredFile> all_inputs(const RunState& state) {
  std::vector<StoredFile> inputs;
  for (const CaseState& one : state.cases()) {
    std::vector<StoredFile> of_case = one.inputs.value_or(std::vector<StoredFile>{});
    for (const VariantState& variant : one.variants) {
      of_case.insert(of_case.end(), variant.inputs.begin(), variant.inputs.end());
    }
    for (const StoredFile& file : of_case) {
      const auto same = [&](const StoredFile& other) {
        return other.name == file.name && other.sha256 == file.sha256;
      };
      if (std::none_of(inputs.begin(), inputs.end(), same)) inputs.push_back(file);
    }
  }
  return inputs;
}

CaseRecord case_record(const CaseState& state, const Topic& topic) {
  CaseRecord record = state.record;
  for (const VariantState& variant : state.variants) {
    record.variants.push_back(variant.record);
    auto& timing = record.variants.back().timing;
    for (const auto& [phase, seconds] : variant.prepare) {
      // A phase that is entered while preparing and later on has two entries.
      timing[timing.contains(phase) ? "prepare:" + phase : phase] = {{seconds}};
    }
    timing["load"] = {{state.load_seconds}};
    summarise(topic, record.variants.back());
  }
  return record;
}

RunRecord assemble(const Experiment& experiment, const Topic& topic, const RunState& state) {
  RunRecord record;
  record.experiment_id = experiment.id;
  record.title = experiment.title;
  record.figure = experiment.figure;
  record.topic = experiment.topic;
  record.quick = experiment.quick;
  record.experiment_toml = experiment.resolved_toml;
  record.spec_hash = experiment.hash;
  record.provenance = provenance();
  record.provenance["start"] = state.run()->start;
  record.provenance["finish"] = utc_now();
  record.provenance["experiment_file"] = state.run()->experiment_file;
  record.provenance["processor_s"] = rounded_text(state.processor_seconds(), 6);
  record.inputs = all_inputs(state);
  for (const CaseState& one : state.cases()) record.cases.push_back(case_record(one, topic));
  set_hashes(record);
  return record;
}

/// One case: false after a stop request.
bool run_case(const Experiment& experiment, const CaseSpec& spec, const std::vector<Topic>& topics,
              const ExecuteRequest& request, const InputMaker& make_input, Recorder& recorder,
              RunState& state, Progress& progress) {
  const CaseState& known = state.case_of(spec.name);
  const bool timed = known.timed || !request.timing;
  if (timed && std::all_of(known.variants.begin(), known.variants.end(),
                           [](const VariantState& variant) { return variant.ended; })) {
    for (std::size_t i = 0; i < known.variants.size(); ++i) progress.skip();
    if (request.timing) progress.skip();
    return true;
  }
  if (stop_requested()) return false;
  const ResolvedScene scene = resolve_run_inputs(experiment, spec, topics, request, make_input);
  if (scene.stopped) return false;
  CaseRunner runner(experiment, spec, topic_of(experiment, topics), recorder, state, progress);
  if (request.only_declared) runner.require_declared_diagnostics();
  if (request.farewell) {
    runner.leave_at_once_after([&] { request.farewell(recorder.folder()); });
  }
  bool complete = false;
  const double before = processor_seconds();
  with_threads(spec.threads,
               [&] { complete = runner.run(*scene.options, scene.inputs, request.timing); });
  recorder.add(journal::ProcessorLine{processor_seconds() - before}, false);
  return complete;
}

bool run_cases(const Experiment& experiment, const std::vector<Topic>& topics,
               const ExecuteRequest& request, const InputMaker& make_input, Recorder& recorder,
               RunState& state) {
  const std::size_t timings = request.timing ? experiment.cases.size() : 0;
  const std::size_t steps =
      std::accumulate(experiment.cases.begin(), experiment.cases.end(), timings,
                      [](std::size_t n, const CaseSpec& spec) { return n + spec.variants.size(); });
  Progress progress(request.show_progress, steps);
  for (const CaseSpec& spec : experiment.cases) {
    if (!run_case(experiment, spec, topics, request, make_input, recorder, state, progress)) {
      return false;
    }
  }
  return true;
}

/// Studies, claims, run.h5. What cannot be decided must not cost the run: it is recorded as a claim
/// that falls short, run.h5 is written, and the error is thrown after that.
void finish(const Experiment& experiment, const std::vector<Topic>& topics, bool grade,
            Recorder& recorder, ExecuteResult& result) {
  std::optional<Error> undecided;
  try {
    result.record.studies = make_studies(experiment, result.record);
    result.record.claims = decide_claims(experiment, result.record);
    if (grade) grade_claims(experiment, topics, result.folder, result.record);
  } catch (const Error& error) {
    undecided = error;
    ClaimRecord claim;
    claim.text = "every study and claim of the experiment can be decided";
    claim.detail = error.what();
    result.record.claims.push_back(claim);
  }
  const fs::path file = result.folder / "run.h5";
  write_run_file(result.record, file, result.folder);
  recorder.add(journal::ResultLine{{file.filename().string(), sha256_of_file(file)}});
  if (undecided) throw Error(*undecided);
}

bool failed_outside(const VariantRecord& variant, const Topic& topic) {
  return variant.status == "failed" && method_of(topic, variant.method).make_at;
}

/// Variants that failed outside of the program begin anew.
void retry_failed(const Topic& topic, RunState& state, Recorder& recorder) {
  std::vector<journal::Place> places;
  for (const CaseState& one : state.cases()) {
    for (const VariantState& variant : one.variants) {
      if (variant.ended && failed_outside(variant.record, topic))
        places.push_back({one.record.name, variant.record.name});
    }
  }
  for (const journal::Place& place : places) recorder.add(journal::RetryLine{place});
}

bool has_results(const RunState& state) {
  return std::any_of(state.cases().begin(), state.cases().end(), [](const CaseState& one) {
    return std::any_of(one.variants.begin(), one.variants.end(), [](const VariantState& variant) {
      return (variant.ended && !could_not_run(variant.record)) || variant.checkpoint ||
             !variant.record.frames.empty();
    });
  });
}

/// @throws Error  when no variant of any case could run: the reason of the first
void require_one_that_ran(const RunState& state) {
  if (has_results(state)) return;
  for (const CaseState& one : state.cases()) {
    for (const VariantState& variant : one.variants) {
      if (could_not_run(variant.record)) {
        throw Error(variant.record.error,
                    "case '" + one.record.name + "', variant '" + variant.record.name + "'");
      }
    }
  }
}

/// @throws Error  saying what would be started, unless that is allowed
void require_allowed_commands(const Experiment& experiment, const Topic& topic,
                              const ExecuteRequest& request) {
  if (request.allow_commands) return;
  std::vector<std::string> started;
  for (const CaseSpec& one : experiment.cases) {
    for (const VariantSpec& variant : one.variants) {
      const MethodEntry& method = method_of(topic, variant.method);
      const std::string command = method.starts ? method.starts(*variant.options) : "";
      const std::string line = "variant '" + variant.name + "' would start: " + command;
      const bool is_said = std::find(started.begin(), started.end(), line) != started.end();
      if (!command.empty() && !is_said) started.push_back(line);
    }
  }
  if (started.empty()) return;
  throw Error(joined(started, "; "), experiment.file.string(),
              "--allow-commands, after a look at the file and its programs");
}

/// The request for the cases of a run in `folder`: its farewell speaks of that folder, also while
/// inputs are made in others.
ExecuteRequest told_of(const fs::path& folder, ExecuteRequest request) {
  if (!request.farewell) return request;
  request.farewell = [folder, farewell = std::move(request.farewell)](const fs::path&) {
    farewell(folder);
  };
  return request;
}

/// Takes back what a run wrote that broke off without a result: bad input leaves no folder. Nothing
/// of this was there when the run began (`require_own_beginning`).
void discard(const fs::path& folder, bool chosen_by_us) {
  std::error_code ignored;
  for (const char* name : {"frames", "artifacts", "checkpoints"}) {
    fs::remove_all(folder / name, ignored);
  }
  for (const char* name : {"spec.toml", "spec.json", "journal.jsonl"}) {
    fs::remove(folder / name, ignored);
  }
  if (chosen_by_us) fs::remove(folder, ignored);
}

}  // namespace

bool has_failed_outside(const RunRecord& record, const Topic& topic) {
  return std::any_of(record.cases.begin(), record.cases.end(), [&](const CaseRecord& one) {
    return std::any_of(one.variants.begin(), one.variants.end(), [&](const VariantRecord& variant) {
      return failed_outside(variant, topic);
    });
  });
}

ExecuteResult run_once(const Experiment& experiment, const std::vector<Topic>& topics,
                       const ExecuteRequest& request, const InputMaker& make_input) {
  const Topic& topic = topic_of(experiment, topics);
  require_allowed_commands(experiment, topic, request);
  require_no_circle(experiment, topics);
  ExecuteResult result;
  const RunFolder opened = open_run_folder(experiment, request);
  result.folder = opened.path;
  auto record = finished_record(experiment, result.folder);
  if (record && !has_failed_outside(*record, topic)) {
    say(result.folder.string() + " is finished: nothing to do");
    result.record = std::move(*record);
    result.was_finished = true;
    return result;
  }
  Journal journal(path_below(result.folder, "journal.jsonl"));
  RunState state = restore(experiment, journal, result.folder);
  Recorder recorder(result.folder, journal, state, topic_of(experiment, topics).looked_at);
  const bool is_new = !state.run();
  if (is_new) require_own_beginning(experiment, result.folder);
  try {
    if (is_new) begin_run(experiment, recorder);
    retry_failed(topic, state, recorder);
    result.stopped = !run_cases(experiment, topics, told_of(result.folder, request), make_input,
                                recorder, state);
    if (!result.stopped) require_one_that_ran(state);
  } catch (const std::exception&) {
    if (is_new && !has_results(state)) discard(result.folder, !request.out);
    throw;
  }
  result.record = assemble(experiment, topic, state);
  if (result.stopped) return result;
  if (!is_new) require_recorded_files(OpenedRun(result.folder, result.record));
  recorder.remove_checkpoints();
  try {
    finish(experiment, topics, request.grade, recorder, result);
  } catch (const Stopped&) {  // while claims were graded: every frame is recorded
    result.stopped = true;
  }
  return result;
}

}  // namespace geoprior
