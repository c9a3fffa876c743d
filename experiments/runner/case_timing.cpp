#include "experiments/runner/benchmark.h"
#include "experiments/runner/case_runner.h"
#include "experiments/runner/stop.h"

namespace geoprior {

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
  timing = benchmark_poses(entries, parameters,
                           {experiment_.timing_repetitions, experiment_.timing_warm_up}, context,
                           [this](double done) { progress_.fraction(done); });
  return !timing.empty();
}

bool CaseRunner::time_processes(std::map<std::string, Timing>& timing) {
  for (const VariantSpec& variant : spec_.variants) {
    auto* process = std::get_if<std::unique_ptr<Process>>(&prepare(variant, false));
    if (process == nullptr) continue;
    Timing& own = timing[variant.name];
    // The recording run is the first repetition: its phases are in the record, 1 x 1.
    own = state_of(variant).record.timing;
    for (int repetition = 1; repetition < experiment_.timing_repetitions; ++repetition) {
      TimedContext context(spec_.seed);
      const auto seconds = time_process(**process, context);
      if (context.stop_was_told()) return false;
      for (auto& [phase, rows] : own) {
        const auto found = seconds.find(phase);
        if (found != seconds.end()) rows.front().push_back(found->second);
      }
    }
  }
  return true;
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
  }
  line.ratios = timing_ratios(variants, line.timing, spec_.seed);
  recorder_.add(line);
  return true;
}

}  // namespace geoprior
