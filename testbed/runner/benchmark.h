#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/method.h"
#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/process/run_context.h"

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
/// round, so that none is always first. A path-dependent method begins its path anew every round:
/// its times are those of whole sweeps. Result: variant: timing, with phase "solve" and those that
/// the method marks. Empty after a stop request.
///
/// @param context   hands the seed and the stop request to the methods
/// @param fraction  told how much is done, 0 … 1
std::map<std::string, Timing> benchmark_poses(const std::vector<BenchmarkEntry>& entries,
                                              const std::vector<double>& parameters,
                                              const BenchmarkOptions& options,
                                              TimedContext& context,
                                              const std::function<void(double)>& fraction);

/// The times of one run of a process.
struct ProcessTimes {
  /// For each frame the phases since the frame before; "run" is all of it.
  std::vector<std::map<std::string, double>> frames;
  std::map<std::string, double> rest;  ///< after the last frame
};

/// The phase of a program from outside that makes all frames at once: one time, of the whole run.
inline constexpr const char* kWholeProcess = "process";

/// The diagnostic of its first frame that is its resident memory, MB.
inline constexpr const char* kPeakMemory = "process_peak_memory";

/// What follows the last frame of a process is no frame's: "finish", and the phases in it.
std::string name_of_rest(const std::string& phase);

/// Runs a process to its end; what it makes is thrown away, with the clock standing still.
ProcessTimes time_process(Process& process, TimedContext& context);

struct ProcessEntry {
  std::string name;
  Process* process = nullptr;  ///< prepared
  Timing recorded;             ///< of the run that recorded its frames
  std::size_t frames = 0;      ///< that it recorded
  bool as_a_whole = false;     ///< its frames have no times, but its run has (kWholeProcess)
};

/// Times processes by whole runs, one of each in turn, rotating as `benchmark_poses` does. The runs
/// that recorded the frames are the first round: the first repetition, or with a warm-up the first
/// of its rounds. Result: variant: timing, one row a frame; "finish" is the time after the last
/// one; of those that are timed as a whole one row. Empty after a stop request.
/// @throws Error  when a process makes another number of frames than it recorded
std::map<std::string, Timing> benchmark_processes(const std::vector<ProcessEntry>& entries,
                                                  const BenchmarkOptions& options,
                                                  std::uint64_t seed,
                                                  const std::function<void(double)>& fraction);

/// Whether the frames are at equal parameters.
bool same_frames(const std::vector<FrameRecord>& a, const std::vector<FrameRecord>& b);

/// Seconds of each repetition, all frames and what follows them; of a pose method the sum of its
/// frames. NaN where a frame has no time.
std::vector<double> whole_runs(const Timing& timing);

/// Ratios of the times of every variant that is no baseline over every baseline (role "baseline"),
/// by the whole time: "run" of a process, "solve" of a pose method. Paired frame by frame and
/// repetition by repetition; by whole runs where `by_frames` is false, one of them is timed as a
/// whole, or two processes have frames at other parameters. Variants that failed have none.
std::vector<TimingRatio> timing_ratios(const std::vector<VariantRecord>& variants,
                                       const std::map<std::string, Timing>& timing, bool by_frames,
                                       std::uint64_t seed);

}  // namespace geoprior
