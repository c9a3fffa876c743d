#include "testbed/runner/benchmark.h"

#include <limits>
#include <numeric>

#include "core/error.h"
#include "testbed/runner/judgement/timing_statistics.h"
#include "testbed/runner/options/quantity.h"

namespace geoprior {

namespace {

/// One table of NaN for a phase that appears for the first time.
std::vector<std::vector<double>>& column(Timing& timing, const std::string& phase,
                                         std::size_t frames, int repetitions) {
  auto& rows = timing[phase];
  if (rows.empty()) {
    rows.assign(frames, std::vector<double>(repetitions, std::numeric_limits<double>::quiet_NaN()));
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
  DiscardingSink(TimedContext& context, ProcessTimes& times) : context_(context), times_(times) {}
  void frame(Frame frame) override {
    times_.frames.push_back(context_.lap());
    const TimedContext::Pause pause(context_);
    Frame discarded = std::move(frame);
  }
  void event(const Event&) override {}
  void artifact(Artifact) override {}
  void checkpoint(const State&) override {}

 private:
  TimedContext& context_;
  ProcessTimes& times_;
};

/// Writes the times of one run into its column of the tables.
void put(const ProcessTimes& times, int repetition, int repetitions, Timing& timing) {
  const auto put_one = [&](const std::string& phase, std::size_t rows, std::size_t row, double s) {
    column(timing, phase, rows, repetitions)[row][repetition] = s;
  };
  for (std::size_t frame = 0; frame < times.frames.size(); ++frame) {
    for (const auto& [phase, seconds] : times.frames[frame]) {
      put_one(phase, times.frames.size(), frame, seconds);
    }
  }
  for (const auto& [phase, seconds] : times.rest) put_one(name_of_rest(phase), 1, 0, seconds);
}

/// One time in place of those of the frames.
ProcessTimes as_a_whole(const ProcessTimes& times) {
  const auto run = [](const std::map<std::string, double>& phases) {
    const auto found = phases.find("run");
    return found == phases.end() ? 0 : found->second;
  };
  double sum = run(times.rest);
  for (const auto& phases : times.frames) sum += run(phases);
  return {{}, {{kWholeProcess, sum}}};
}

/// The recorded run as the first repetition.
Timing first_repetition(const Timing& recorded, int repetitions) {
  Timing timing;
  for (const auto& [phase, rows] : recorded) {
    for (std::size_t row = 0; row < rows.size(); ++row) {
      column(timing, phase, rows.size(), repetitions)[row][0] = rows[row].at(0);
    }
  }
  return timing;
}

std::vector<double> flat(const std::vector<std::vector<double>>& rows) {
  std::vector<double> values;
  for (const auto& row : rows) values.insert(values.end(), row.begin(), row.end());
  return values;
}

/// The phase that is the whole time of a frame.
const std::vector<std::vector<double>>* whole_time(const Timing& timing) {
  for (const char* phase : {"run", "solve"}) {
    if (const auto found = timing.find(phase); found != timing.end()) return &found->second;
  }
  return nullptr;
}

/// Times of two variants in pairs.
struct Pairs {
  std::string kind;
  std::vector<double> a;
  std::vector<double> b;
};

Pairs pairs_of(const VariantRecord& a, const Timing& of_a, const VariantRecord& b,
               const Timing& of_b, bool by_frames) {
  const auto* rows_a = whole_time(of_a);
  const auto* rows_b = whole_time(of_b);
  if (by_frames && rows_a != nullptr && rows_b != nullptr && same_frames(a.frames, b.frames)) {
    return {"frame", flat(*rows_a), flat(*rows_b)};
  }
  return {"run", whole_runs(of_a), whole_runs(of_b)};
}

}  // namespace

std::string name_of_rest(const std::string& phase) {
  if (phase == kWholeProcess) return phase;
  return phase == "run" ? "finish" : "finish:" + phase;
}

bool same_frames(const std::vector<FrameRecord>& a, const std::vector<FrameRecord>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const FrameRecord& x, const FrameRecord& y) {
                      return same_parameter(x.parameter, y.parameter);
                    });
}

std::vector<double> whole_runs(const Timing& timing) {
  std::vector<double> sums;
  for (const char* phase : {"run", "solve", "finish", kWholeProcess}) {
    const auto found = timing.find(phase);
    if (found == timing.end()) continue;
    for (const std::vector<double>& row : found->second) {
      sums.resize(std::max(sums.size(), row.size()), 0);
      for (std::size_t r = 0; r < row.size(); ++r) sums[r] += row[r];
    }
  }
  return sums;
}

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
        const BenchmarkEntry& entry = entries[(turn + round) % count];
        if (frame == 0) entry.method->restart();
        const auto seconds = time_solve(*entry.method, parameters[frame], context);
        if (context.stop_requested()) return {};
        if (repetition < 0) continue;
        for (const auto& [phase, value] : seconds) {
          column(timing[entry.name], phase, parameters.size(),
                 options.repetitions)[frame][repetition] = value;
        }
      }
      fraction((round + static_cast<double>(frame + 1) / static_cast<double>(parameters.size())) /
               rounds);
    }
  }
  return timing;
}

ProcessTimes time_process(Process& process, TimedContext& context) {
  ProcessTimes times;
  DiscardingSink sink(context, times);
  context.take_phases();
  {
    const Phase phase(context, "run");
    process.run(sink, context, std::nullopt);
  }
  times.rest = context.take_phases();
  return times;
}

std::map<std::string, Timing> benchmark_processes(const std::vector<ProcessEntry>& entries,
                                                  const BenchmarkOptions& options,
                                                  std::uint64_t seed,
                                                  const std::function<void(double)>& fraction) {
  std::map<std::string, Timing> timing;
  if (options.warm_up == 0) {
    for (const ProcessEntry& entry : entries) {
      timing[entry.name] = first_repetition(entry.recorded, options.repetitions);
    }
  }
  const int rounds = options.warm_up + options.repetitions;
  const std::size_t count = entries.size();
  const double all = static_cast<double>(count) * (rounds - 1);
  for (int round = 1; round < rounds; ++round) {
    for (std::size_t turn = 0; turn < count; ++turn) {
      const ProcessEntry& entry = entries[(turn + round) % count];
      const double done = static_cast<double>(count) * (round - 1) + static_cast<double>(turn);
      TimedContext context(seed, [&](double of_this) { fraction((done + of_this) / all); });
      const ProcessTimes times = time_process(*entry.process, context);
      if (context.stop_was_told()) return {};
      if (times.frames.size() != entry.frames) {
        throw Error("a repetition made " + std::to_string(times.frames.size()) +
                        " frames, the recorded run " + std::to_string(entry.frames),
                    "variant '" + entry.name + "'", "the same frames for the same seed");
      }
      if (round < options.warm_up) continue;
      put(entry.as_a_whole ? as_a_whole(times) : times, round - options.warm_up,
          options.repetitions, timing[entry.name]);
    }
  }
  return timing;
}

std::vector<TimingRatio> timing_ratios(const std::vector<VariantRecord>& variants,
                                       const std::map<std::string, Timing>& timing, bool by_frames,
                                       std::uint64_t seed) {
  std::vector<TimingRatio> ratios;
  const auto compared = [&](const VariantRecord& variant) {
    return variant.status != "failed" && timing.contains(variant.name);
  };
  for (const VariantRecord& variant : variants) {
    if (variant.role == "baseline" || !compared(variant)) continue;
    for (const VariantRecord& baseline : variants) {
      if (baseline.role != "baseline" || !compared(baseline)) continue;
      const Pairs pairs =
          pairs_of(variant, timing.at(variant.name), baseline, timing.at(baseline.name), by_frames);
      if (pairs.a.empty() || pairs.a.size() != pairs.b.size()) continue;
      const Interval ratio = median_of_paired_ratios(pairs.a, pairs.b, seed);
      ratios.push_back(
          {variant.name, baseline.name, ratio.value, ratio.low, ratio.high, pairs.kind});
    }
  }
  return ratios;
}

}  // namespace geoprior
