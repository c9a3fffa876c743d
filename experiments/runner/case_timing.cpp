#include "experiments/runner/benchmark.h"
#include "experiments/runner/case_runner.h"
#include "experiments/runner/stop.h"

namespace geoprior {

namespace {

/// Rounds that are not counted, when the experiment does not say: a solve is short and its first
/// call meets cold memory; a whole run of a process has warmed up by its first frames, and costs.
constexpr int kPoseWarmUp = 1;
constexpr int kProcessWarmUp = 0;

}  // namespace

bool CaseRunner::time_poses(std::map<std::string, Timing>& timing) {
  std::vector<BenchmarkEntry> entries;
  for (const VariantSpec& variant : spec_.variants) {
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
    // A process that failed would fail again; its record keeps the times of its frames.
    if (record.status == "failed") continue;
    if (auto* process = std::get_if<std::unique_ptr<Process>>(&prepare(variant, false))) {
      entries.push_back({variant.name, process->get(), record.timing, record.frames.size()});
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
  if (!time_poses(line.timing) || !time_processes(line.timing)) return false;
  std::vector<VariantRecord> variants;
  for (const VariantState& state : state_.case_of(spec_.name).variants) {
    variants.push_back({});
    variants.back().name = state.record.name;
    variants.back().role = state.record.role;
    variants.back().status = state.record.status;
    variants.back().frames = state.record.frames;
  }
  line.ratios = timing_ratios(variants, line.timing, spec_.seed);
  recorder_.add(line);
  return true;
}

}  // namespace geoprior
