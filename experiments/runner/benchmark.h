#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/method.h"
#include "experiments/runner/run_context.h"
#include "experiments/runner/run_record.h"

namespace geoprior {

/// Phase: [frame][repetition] seconds. A phase that a call did not enter has NaN there.
using Timing = std::map<std::string, std::vector<std::vector<double>>>;

struct BenchmarkEntry {
  std::string name;
  PoseMethod* method = nullptr;  ///< prepared
};

struct BenchmarkOptions {
  int repetitions = 1;
  int warm_up = 1;  ///< rounds whose times are thrown away
};

/// Times `solve` of several methods interleaved: for every round, for every parameter, each method
/// in turn, so that a disturbance of the machine meets all of them. The order rotates by one every
/// round, so that none is always first. Result: variant: timing, with phase "solve" and those that
/// the method marks. Empty after a stop request.
///
/// @param context   hands the seed and the stop request to the methods
/// @param fraction  told how much is done, 0 … 1
std::map<std::string, Timing> benchmark_poses(const std::vector<BenchmarkEntry>& entries,
                                              const std::vector<double>& parameters,
                                              const BenchmarkOptions& options,
                                              TimedContext& context,
                                              const std::function<void(double)>& fraction);

/// One call of a process timed as a whole: results are thrown away. Phases as seconds, "run" is
/// all.
std::map<std::string, double> time_process(Process& process, TimedContext& context);

/// Ratios of the times of every variant that is no baseline over every baseline (role "baseline"),
/// by the whole time: "run" of a process, "solve" of a pose method.
std::vector<TimingRatio> timing_ratios(const std::vector<VariantRecord>& variants,
                                       const std::map<std::string, Timing>& timing,
                                       std::uint64_t seed);

}  // namespace geoprior
