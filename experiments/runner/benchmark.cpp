#include "experiments/runner/benchmark.h"

#include <limits>

#include "core/error.h"
#include "experiments/runner/timing_statistics.h"

namespace geoprior {

namespace {

/// One table of NaN for a phase that appears for the first time.
std::vector<std::vector<double>>& column(Timing& timing, const std::string& phase,
                                         std::size_t frames, int repetitions) {
  auto& rows = timing[phase];
  if (rows.empty()) {
    rows.assign(frames, std::vector<double>(static_cast<std::size_t>(repetitions),
                                            std::numeric_limits<double>::quiet_NaN()));
  }
  return rows;
}

std::map<std::string, double> time_solve(PoseMethod& method, double parameter,
                                         TimedContext& context) {
  context.take_phases();
  std::map<std::string, double> inner;
  double seconds = 0;
  {
    const auto begin = std::chrono::steady_clock::now();
    method.solve(parameter, context);
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    inner = context.take_phases();
  }
  inner["solve"] = seconds;
  return inner;
}

class DiscardingSink final : public FrameSink {
 public:
  explicit DiscardingSink(TimedContext& context) : context_(context) {}
  void frame(Frame frame) override {
    const TimedContext::Pause pause(context_);
    Frame discarded = std::move(frame);
  }
  void event(const Event&) override {}
  void artifact(Artifact) override {}
  void checkpoint(const State&) override {}

 private:
  TimedContext& context_;
};

std::vector<double> flat(const std::vector<std::vector<double>>& rows) {
  std::vector<double> values;
  for (const auto& row : rows) values.insert(values.end(), row.begin(), row.end());
  return values;
}

const std::vector<std::vector<double>>* whole_time(const Timing& timing) {
  for (const char* phase : {"run", "solve"}) {
    if (const auto found = timing.find(phase); found != timing.end()) return &found->second;
  }
  return nullptr;
}

}  // namespace

std::map<std::string, Timing> benchmark_poses(const std::vector<BenchmarkEntry>& entries,
                                              const std::vector<double>& parameters,
                                              const BenchmarkOptions& options,
                                              TimedContext& context,
                                              const std::function<void(double)>& fraction) {
  std::map<std::string, Timing> timing;
  const std::size_t count = entries.size();
  const int rounds = options.warm_up + options.repetitions;
  for (int round = 0; round < rounds; ++round) {
    const int repetition = round - options.warm_up;
    for (std::size_t frame = 0; frame < parameters.size(); ++frame) {
      for (std::size_t turn = 0; turn < count; ++turn) {
        const BenchmarkEntry& entry = entries[(turn + static_cast<std::size_t>(round)) % count];
        const auto seconds = time_solve(*entry.method, parameters[frame], context);
        if (context.stop_requested()) return {};
        if (repetition < 0) continue;
        for (const auto& [phase, value] : seconds) {
          column(timing[entry.name], phase, parameters.size(),
                 options.repetitions)[frame][static_cast<std::size_t>(repetition)] = value;
        }
      }
      fraction((round + static_cast<double>(frame + 1) / static_cast<double>(parameters.size())) /
               rounds);
    }
  }
  return timing;
}

std::map<std::string, double> time_process(Process& process, TimedContext& context) {
  DiscardingSink sink(context);
  context.take_phases();
  {
    const Phase phase(context, "run");
    process.run(sink, context, std::nullopt);
  }
  return context.take_phases();
}

std::vector<TimingRatio> timing_ratios(const std::vector<VariantRecord>& variants,
                                       const std::map<std::string, Timing>& timing,
                                       std::uint64_t seed) {
  std::vector<TimingRatio> ratios;
  const auto times_of = [&](const VariantRecord& variant) -> std::vector<double> {
    const auto found = timing.find(variant.name);
    if (found == timing.end()) return {};
    const auto* rows = whole_time(found->second);
    return rows == nullptr ? std::vector<double>{} : flat(*rows);
  };
  for (const VariantRecord& variant : variants) {
    if (variant.role == "baseline") continue;
    const std::vector<double> own = times_of(variant);
    for (const VariantRecord& baseline : variants) {
      if (baseline.role != "baseline") continue;
      const std::vector<double> other = times_of(baseline);
      if (own.empty() || own.size() != other.size()) continue;
      const Interval ratio = median_of_paired_ratios(own, other, seed);
      ratios.push_back({variant.name, baseline.name, ratio.value, ratio.low, ratio.high});
    }
  }
  return ratios;
}

}  // namespace geoprior
