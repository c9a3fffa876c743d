#include "testbed/runner/case_runner.h"

#include <algorithm>

#include "core/error.h"
#include "core/limits.h"
#include "testbed/runner/benchmark.h"
#include "testbed/runner/journal/frames_text.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/judgement/measure.h"
#include "testbed/runner/process/peak_memory.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/run_folder.h"
#include "testbed/runner/scene_camera.h"
#include "testbed/runner/spec/scene_place.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

/// A frame from outside that the metrics cannot be measured on: its variant has failed, not the
/// run.
class UnmeasurableFrame final : public Error {
 public:
  using Error::Error;
};

const VariantSpec* find_variant(const std::vector<VariantSpec>& variants, const std::string& name) {
  for (const VariantSpec& variant : variants) {
    if (variant.name == name) return &variant;
  }
  return nullptr;
}

/// Resident memory of a program from outside, as it is recorded of its first frame.
std::optional<MemoryUse> memory_of_program(const VariantRecord& record) {
  const auto found = record.diagnostics.find(kPeakMemory);
  if (found == record.diagnostics.end() || found->second.values.empty()) return std::nullopt;
  constexpr double kBytesPerMB = 1e6;
  return MemoryUse{0, static_cast<std::uint64_t>(found->second.values.front() * kBytesPerMB)};
}

}  // namespace

std::vector<const VariantSpec*> references_first(const std::vector<VariantSpec>& variants) {
  std::vector<const VariantSpec*> order;
  const auto placed = [&](const VariantSpec* variant) {
    return std::find(order.begin(), order.end(), variant) != order.end();
  };
  while (order.size() < variants.size()) {
    const std::size_t before = order.size();
    for (const VariantSpec& variant : variants) {
      if (placed(&variant)) continue;
      const VariantSpec* reference =
          variant.reference ? find_variant(variants, *variant.reference) : nullptr;
      // A reference left out by --variant is no obstacle: its metrics are then absent.
      if (reference == nullptr || placed(reference) || reference == &variant) {
        order.push_back(&variant);
        break;  // start over: keeps the given order wherever references allow it
      }
    }
    if (order.size() == before) throw Error("variants refer to each other in a circle");
  }
  return order;
}

/// Receives what a process pushes; the process' clock stands still meanwhile.
class CaseRunner::Sink final : public FrameSink {
 public:
  /// @param earlier  seconds between the last frame and the checkpoint that the process goes on
  /// from
  Sink(CaseRunner& runner, const VariantSpec& variant, TimedContext& context,
       journal::Numbers earlier)
      : runner_(runner), variant_(variant), context_(context), earlier_(std::move(earlier)) {}

  void frame(Frame frame) override {
    const bool from_outside = runner_.comes_from_outside(variant_);
    journal::Numbers seconds;
    if (!from_outside) {
      seconds = with_earlier(context_.lap());
      earlier_.clear();
    }
    const TimedContext::Pause pause(context_);
    require_finite(frame, runner_.state_of(variant_).record.frames.size(), variant_.method);
    // Frames from outside come with their files.
    const std::vector<Artifact> files =
        from_outside ? std::vector<Artifact>{} : runner_.scene_->files_of(frame);
    for (const Artifact& file : files)
      guarded([&] { runner_.recorder_.write_artifact(runner_.place(variant_), file); });
    guarded([&] { runner_.record_frame(variant_, std::move(frame), seconds); });
  }
  void event(const Event& event) override {
    const TimedContext::Pause pause(context_);
    // Not flushed: an event is safe with the next frame or checkpoint, and void without it.
    guarded([&] { runner_.recorder_.write_event(runner_.place(variant_), event); });
  }
  void artifact(Artifact artifact) override {
    const TimedContext::Pause pause(context_);
    guarded([&] { runner_.recorder_.write_artifact(runner_.place(variant_), artifact); });
  }
  void checkpoint(const State& state) override {
    const journal::Numbers seconds = with_earlier(context_.phases());
    const TimedContext::Pause pause(context_);
    guarded([&] { runner_.recorder_.write_checkpoint(runner_.place(variant_), state, seconds); });
  }

  /// Throws what broke the recording, as against the process, if anything did.
  void rethrow_failure() const {
    if (failure_) std::rethrow_exception(failure_);
  }
  [[nodiscard]] journal::Numbers with_earlier(const journal::Numbers& seconds) const {
    journal::Numbers sum = earlier_;
    for (const auto& [phase, value] : seconds) sum[phase] += value;
    return sum;
  }

 private:
  template <class Record>
  void guarded(Record record) {
    try {
      record();
    } catch (const UnmeasurableFrame&) {
      throw;
    } catch (...) {
      failure_ = std::current_exception();
      throw;
    }
  }

  CaseRunner& runner_;
  const VariantSpec& variant_;
  TimedContext& context_;
  journal::Numbers earlier_;
  std::exception_ptr failure_;
};

CaseRunner::CaseRunner(const Experiment& experiment, const CaseSpec& spec, const Topic& topic,
                       Recorder& recorder, RunState& state, Progress& progress)
    : experiment_(experiment),
      spec_(spec),
      topic_(topic),
      recorder_(recorder),
      state_(state),
      progress_(progress),
      kept_(kMostKept) {}

void CaseRunner::load(const OptionSet& options, std::vector<StoredFile> inputs) {
  const auto begin = std::chrono::steady_clock::now();
  try {
    const LeaveAtOnce section(farewell_);
    scene_ = topic_.load(options, experiment_.file.parent_path(), spec_.seed);
  } catch (const Error& error) {
    const std::string place = place_of_scene_key(spec_.scene_places, error.what());
    throw Error(error.what(), (place.empty() ? experiment_.file.string() : place) +
                                  ": scene of case '" + spec_.name + "'");
  } catch (const std::bad_alloc&) {
    throw out_of_memory(experiment_.file.string() + ": scene of case '" + spec_.name + "'");
  }
  journal::CaseLine line;
  line.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  line.case_name = spec_.name;
  line.parameter_name = scene_->parameter_name();
  line.parameter_unit = scene_->parameter_unit();
  line.facts = scene_->facts();
  line.warnings = scene_->warnings();
  for (const VariantSpec& variant : spec_.variants) {
    const MethodEntry& entry = method_of(topic_, variant.method);
    if (!entry.warnings) continue;
    for (const std::string& warning : entry.warnings(*scene_, *variant.options))
      line.warnings.push_back("variant '" + variant.name + "': " + warning);
  }
  if (const auto camera = scene_->camera()) line.camera = camera_text(*camera);
  for (const auto& file : scene_->inputs()) {
    inputs.push_back({input_name(file), sha256_of_file(file)});
  }
  line.inputs = std::move(inputs);
  const CaseState& known = state_.case_of(spec_.name);
  if (!known.inputs) {
    for (const std::string& warning : line.warnings) {
      const std::string place = place_of_scene_key(spec_.scene_places, warning);
      progress_.say("warning: " + (place.empty() ? "" : place + ": ") + warning);
    }
    recorder_.add(line);
    return;
  }
  const auto same = [](const StoredFile& a, const StoredFile& b) {
    return a.name == b.name && a.sha256 == b.sha256;
  };
  if (!std::equal(line.inputs.begin(), line.inputs.end(), known.inputs->begin(),
                  known.inputs->end(), same)) {
    throw Error("the input files are not those that the run began with: it cannot be resumed",
                "case '" + spec_.name + "'", "a new run");
  }
}

MethodSite CaseRunner::site_of(const VariantSpec& variant) {
  return {experiment_.topic,
          experiment_.id,
          fs::absolute(experiment_.file).parent_path(),
          path_below(recorder_.folder(), fs::path("external") / spec_.name / variant.name),
          spec_.name,
          variant.name,
          spec_.seed,
          spec_.scene_json,
          reference_record(variant),
          &recorder_.files()};
}

bool CaseRunner::comes_from_outside(const VariantSpec& variant) const {
  return static_cast<bool>(method_of(topic_, variant.method).make_at);
}

bool CaseRunner::starts_program(const VariantSpec& variant) const {
  const MethodEntry& entry = method_of(topic_, variant.method);
  return entry.starts && !entry.starts(*variant.options).empty();
}

MethodEntry::Instance& CaseRunner::prepare(const VariantSpec& variant, bool log) {
  if (const auto found = prepared_.find(variant.name); found != prepared_.end()) {
    return found->second;
  }
  TimedContext context(spec_.seed);
  const MethodEntry& entry = method_of(topic_, variant.method);
  std::optional<MethodEntry::Instance> instance;
  {
    const LeaveAtOnce section(farewell_);
    const Phase phase(context, "prepare");
    instance = entry.make_at ? entry.make_at(site_of(variant), *scene_, *variant.options, context)
                             : entry.make(*scene_, *variant.options, context);
  }
  if (log) {
    journal::BeginLine line{place(variant), context.take_phases()};
    if (entry.inputs) {
      add_inputs(variant, line);
    }
    recorder_.add(line);
  }
  return prepared_.emplace(variant.name, std::move(*instance)).first->second;
}

void CaseRunner::add_inputs(const VariantSpec& variant, journal::BeginLine& line) {
  try {
    for (const auto& file :
         method_of(topic_, variant.method).inputs(site_of(variant), *variant.options)) {
      line.inputs.push_back({input_name(file), sha256_of_file(file)});
    }
  } catch (const Error& error) {
    if (!comes_from_outside(variant)) throw;
    throw NotApplicable(error.what());
  }
}

std::function<void()> CaseRunner::farewell_within_frame(const VariantSpec& variant) {
  const bool is_pose = std::holds_alternative<std::unique_ptr<PoseMethod>>(prepare(variant, false));
  return is_pose ? farewell_ : nullptr;
}

const VariantRecord* CaseRunner::reference_record(const VariantSpec& variant) {
  if (!variant.reference) return nullptr;
  const VariantSpec* reference = find_variant(spec_.variants, *variant.reference);
  if (reference == nullptr || reference == &variant) return nullptr;
  return &state_of(*reference).record;
}

std::optional<Frame> CaseRunner::reference_frame(const VariantSpec& variant, double parameter) {
  if (!has_reference_metrics(topic_)) return std::nullopt;
  const VariantRecord* record = reference_record(variant);
  if (record == nullptr) return std::nullopt;
  const int index = frame_of_parameter(record->frames, parameter);
  if (index < 0) return std::nullopt;
  return recorder_.files().frame(*record, static_cast<std::size_t>(index), reference_parts(topic_));
}

void CaseRunner::record_frame(const VariantSpec& variant, Frame frame,
                              const journal::Numbers& seconds) {
  const std::size_t index = state_of(variant).record.frames.size();
  const bool from_outside = comes_from_outside(variant);
  if (only_declared_ && !from_outside) require_declared(topic_, frame, variant.method);
  journal::FrameLine line;
  line.place = place(variant);
  line.index = index;
  line.parameter = frame.parameter;
  line.files = recorder_.write_frame(line.place, index, frame);
  for (const std::string& name : topic_.looked_at) frame.parts.erase(name);
  const std::optional<Frame> reference = reference_frame(variant, frame.parameter);
  try {
    const LeaveAtOnce section(farewell_within_frame(variant));
    line.metrics = measure_frame(topic_, *scene_, frame, reference ? &*reference : nullptr);
  } catch (const Error& error) {
    if (!from_outside) throw;
    recorder_.discard(line.files);
    throw UnmeasurableFrame(error.what());
  }
  line.diagnostics = frame.diagnostics;
  line.timing = seconds;
  recorder_.add(line);
  if (has_sequence_metrics(topic_)) kept_.keep(index, std::move(frame));
}

bool CaseRunner::run_poses(const VariantSpec& variant, PoseMethod& method, TimedContext& context) {
  const std::vector<double> parameters = scene_->parameters();
  const std::size_t recorded = state_of(variant).record.frames.size();
  method.restart();
  for (std::size_t i = method.path_dependent() ? 0 : recorded; i < parameters.size(); ++i) {
    if (stop_requested()) return false;
    {
      const LeaveAtOnce section(farewell_within_frame(variant));
      method.solve(parameters[i], context);
    }
    // A method that broke off its solve has no state worth recording.
    if (context.stop_was_told()) return false;
    if (i < recorded) continue;
    Frame frame = method.frame();
    frame.parameter = parameters[i];
    require_finite(frame, i, variant.method);
    record_frame(variant, std::move(frame));
    progress_.fraction(static_cast<double>(i + 1) / static_cast<double>(parameters.size()));
  }
  return true;
}

bool CaseRunner::run_process(const VariantSpec& variant, Process& process, TimedContext& context,
                             journal::EndLine& end) {
  const std::optional<State> from = recorder_.prepare_resume(place(variant), true);
  const auto& checkpoint = state_of(variant).checkpoint;
  Sink sink(*this, variant, context, from ? checkpoint->timing : journal::Numbers{});
  try {
    const Phase phase(context, "run");
    process.run(sink, context, from);
  } catch (const Error& error) {
    sink.rethrow_failure();
    if (state_of(variant).record.frames.empty()) throw;
    end.error = error.what();
  }
  sink.rethrow_failure();
  const journal::Numbers seconds = sink.with_earlier(context.take_phases());
  if (!comes_from_outside(variant)) {
    end.timing = seconds;
  } else if (starts_program(variant)) {
    end.timing = {{kWholeProcess, seconds.at("run")}};
  }
  return !end.error.empty() || !context.stop_was_told();
}

void CaseRunner::finish(const VariantSpec& variant, journal::EndLine line) {
  const VariantRecord& record = state_of(variant).record;
  // The metrics of a sequence have no meaning on a part of it.
  if (has_sequence_metrics(topic_) && line.error.empty()) {
    const KeptFrames none(0);
    const VariantRecord* of = reference_record(variant);
    const auto reference =
        of ? std::optional<RecordedFrames>(std::in_place, recorder_.files(), *of, none)
           : std::nullopt;
    try {
      line.summary = measure_sequence(
          topic_, *scene_,
          RecordedFrames(recorder_.files(), record, kept_, reference ? &*reference : nullptr));
    } catch (const Error& error) {
      if (!comes_from_outside(variant)) throw;
      line.error = error.what();
      tell_failure(variant, line.error);
    }
    kept_ = KeptFrames(kMostKept);
  }
  recorder_.write_collection(line.place);
  recorder_.add(line);
}

void CaseRunner::tell_failure(const VariantSpec& variant, const std::string& error) {
  progress_.say("variant '" + variant.name + "' of case '" + spec_.name + "' " +
                failure_text(state_of(variant).record.frames.size(), error));
  if (could_not_run(state_of(variant).record)) return;
  for (const std::string& warning : state_.case_of(spec_.name).record.warnings)
    progress_.say("  the scene's warning may be why: " + warning);
}

void CaseRunner::refuse(const VariantSpec& variant, const NotApplicable& reason) {
  if (!state_of(variant).begun) recorder_.add(journal::BeginLine{place(variant), {}});
  journal::EndLine end;
  end.place = place(variant);
  end.error = reason.what();
  recorder_.add(end);
  tell_failure(variant, end.error);
  progress_.end();
}

bool CaseRunner::run_variant(const VariantSpec& variant) {
  progress_.begin(experiment_.id + " " + spec_.name + "/" + variant.name);
  kept_ = KeptFrames(kMostKept);
  const PeakMemory memory;
  MethodEntry::Instance& instance = prepare(variant, true);
  TimedContext context(spec_.seed, [this](double done) { progress_.fraction(done); });
  journal::EndLine end;
  end.place = place(variant);
  bool complete = false;
  if (auto* method = std::get_if<std::unique_ptr<PoseMethod>>(&instance)) {
    recorder_.prepare_resume(place(variant), false);
    complete = run_poses(variant, **method, context);
  } else {
    auto& process = std::get<std::unique_ptr<Process>>(instance);
    complete = run_process(variant, *process, context, end);
  }
  if (!complete) return false;
  if (starts_program(variant)) {
    end.memory = memory_of_program(state_of(variant).record);
  } else if (!comes_from_outside(variant)) {
    end.memory = memory.use();
  }
  if (!end.error.empty()) {
    tell_failure(variant, end.error);
  }
  finish(variant, std::move(end));
  progress_.end();
  return true;
}

bool CaseRunner::run_or_refuse(const VariantSpec& variant) {
  try {
    return run_variant(variant);
  } catch (const NotApplicable& reason) {
    if (!state_of(variant).record.frames.empty()) throw;
    refuse(variant, reason);
    return true;
  }
}

void CaseRunner::log_error(const journal::Place& at, const std::string& message) {
  try {
    recorder_.add(journal::ErrorLine{at, message});
  } catch (const Error&) {
    // Disk full, most likely: the message is on its way to the person anyway.
  }
}

bool CaseRunner::run(const OptionSet& options, std::vector<StoredFile> inputs, bool timing) {
  load(options, std::move(inputs));
  for (const VariantSpec* variant : references_first(spec_.variants)) {
    if (state_of(*variant).ended) {
      progress_.skip();
      continue;
    }
    if (stop_requested()) return false;
    try {
      if (!run_or_refuse(*variant)) return false;
    } catch (const Error& error) {
      log_error(place(*variant), error.what());
      std::string key = place_of_scene_key(spec_.scene_places, error.what());
      if (key.empty()) key = place_of_key(variant->option_places, "options", error.what());
      throw Error(error.what(), (key.empty() ? key : key + ": ") + name_of(*variant));
    } catch (const std::bad_alloc&) {
      throw out_of_memory(name_of(*variant));
    }
  }
  if (!timing || state_.case_of(spec_.name).timed) return true;
  progress_.begin(experiment_.id + " " + spec_.name + ": timing");
  if (!time_variants()) return false;
  progress_.end();
  return true;
}

namespace {

/// Rounds that are not counted, when the experiment does not say: a solve is short and its first
/// call meets cold memory; a whole run of a process has warmed up by its first frames, and costs.
constexpr int kPoseWarmUp = 1;
constexpr int kProcessWarmUp = 0;

}  // namespace

bool CaseRunner::time_poses(std::map<std::string, Timing>& timing) {
  std::vector<BenchmarkEntry> entries;
  for (const VariantSpec& variant : spec_.variants) {
    if (is_null_control(variant.role) || state_of(variant).record.status == "failed") continue;
    MethodEntry::Instance& instance = prepare(variant, false);
    if (auto* method = std::get_if<std::unique_ptr<PoseMethod>>(&instance)) {
      entries.push_back({variant.name, method->get()});
    }
  }
  const std::vector<double> parameters = scene_->parameters();
  if (entries.empty() || parameters.empty()) return true;
  TimedContext context(spec_.seed);
  timing = benchmark_poses(
      entries, parameters,
      {experiment_.timing_repetitions, experiment_.timing_warm_up.value_or(kPoseWarmUp)}, context,
      [this](double done) { progress_.fraction(done); });
  return !timing.empty();
}

bool CaseRunner::time_processes(std::map<std::string, Timing>& timing) {
  std::vector<ProcessEntry> entries;
  for (const VariantSpec& variant : spec_.variants) {
    const VariantRecord& record = state_of(variant).record;
    if (is_null_control(variant.role)) continue;
    // A process that failed would fail again; its record keeps the times of its frames.
    if (record.status == "failed") continue;
    const bool from_outside = comes_from_outside(variant);
    if (from_outside && !starts_program(variant)) continue;  // files are read in no time of theirs
    if (auto* process = std::get_if<std::unique_ptr<Process>>(&prepare(variant, false))) {
      entries.push_back(
          {variant.name, process->get(), record.timing, record.frames.size(), from_outside});
    }
  }
  if (entries.empty()) return true;
  auto times = benchmark_processes(
      entries,
      {experiment_.timing_repetitions, experiment_.timing_warm_up.value_or(kProcessWarmUp)},
      spec_.seed, [this](double done) { progress_.fraction(done); });
  const bool complete = !times.empty();
  timing.merge(times);
  return complete;
}

bool CaseRunner::time_variants() {
  journal::TimingLine line;
  line.case_name = spec_.name;
  const bool timed = spec_.claims_only || (time_poses(line.timing) && time_processes(line.timing));
  if (!timed) return false;
  std::vector<VariantRecord> variants;
  for (const VariantState& state : state_.case_of(spec_.name).variants) {
    variants.push_back({});
    variants.back().name = state.record.name;
    variants.back().role = state.record.role;
    variants.back().status = state.record.status;
    variants.back().frames = state.record.frames;
  }
  line.ratios = timing_ratios(variants, line.timing, scene_->frames_share_work(), spec_.seed);
  recorder_.add(line);
  return true;
}

}  // namespace geoprior
