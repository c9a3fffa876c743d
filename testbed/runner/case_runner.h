#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "testbed/runner/benchmark.h"
#include "testbed/runner/journal/recorded_frames.h"
#include "testbed/runner/journal/recorder.h"
#include "testbed/runner/process/progress.h"
#include "testbed/runner/process/run_context.h"
#include "testbed/runner/run_state.h"
#include "testbed/runner/spec/experiment.h"
#include "testbed/topic.h"

namespace geoprior {

/// Runs the variants of one case that are not done yet, then times them.
///
/// An Error that a process throws after its first frame ends that variant: its frames stay, its
/// record has the status "failed" with the message, the other variants run. So does a method that
/// is not for the scene (`NotApplicable`) before its first frame, and one whose frames come from
/// outside and cannot be measured. Any other Error (bad input, a
/// full disk, a metric that cannot be measured) ends the run.
class CaseRunner {
 public:
  CaseRunner(const Experiment& experiment, const CaseSpec& spec, const Topic& topic,
             Recorder& recorder, RunState& state, Progress& progress);

  /// False after a stop request: the folder can be resumed.
  /// @param options  the scene's, run references replaced
  /// @param inputs   runs that stand among them
  bool run(const OptionSet& options, std::vector<StoredFile> inputs, bool timing);
  /// Makes a diagnostic that the topic's table lacks an error.
  void require_declared_diagnostics() { only_declared_ = true; }
  /// Lets a stop request end the program while the scene is loaded, a method prepared, a pose
  /// solved or measured.
  void leave_at_once_after(std::function<void()> farewell) { farewell_ = std::move(farewell); }

 private:
  [[nodiscard]] journal::Place place(const VariantSpec& variant) const {
    return {spec_.name, variant.name};
  }
  [[nodiscard]] std::string name_of(const VariantSpec& variant) const {
    return "case '" + spec_.name + "', variant '" + variant.name + "'";
  }
  [[nodiscard]] MethodSite site_of(const VariantSpec& variant);
  /// Whether its frames are made outside of the program: what is wrong with them is no error of the
  /// run.
  [[nodiscard]] bool comes_from_outside(const VariantSpec& variant) const;
  /// Whether that program is started by the run: else its frames are files.
  [[nodiscard]] bool starts_program(const VariantSpec& variant) const;
  VariantState& state_of(const VariantSpec& variant) { return state_.variant_of(place(variant)); }
  void load(const OptionSet& options, std::vector<StoredFile> inputs);
  MethodEntry::Instance& prepare(const VariantSpec& variant, bool log);
  /// The files that make the variant's result. @throws NotApplicable  when one is not readable
  void add_inputs(const VariantSpec& variant, journal::BeginLine& line);
  bool run_variant(const VariantSpec& variant);
  bool run_or_refuse(const VariantSpec& variant);
  void refuse(const VariantSpec& variant, const NotApplicable& reason);
  void tell_failure(const VariantSpec& variant, const std::string& error);
  bool run_poses(const VariantSpec& variant, PoseMethod& method, TimedContext& context);
  bool run_process(const VariantSpec& variant, Process& process, TimedContext& context,
                   journal::EndLine& end);
  void finish(const VariantSpec& variant, journal::EndLine end);
  /// A pose that is not recorded yet costs its own time only; a process would have to go on at its
  /// last checkpoint.
  std::function<void()> farewell_within_frame(const VariantSpec& variant);
  void record_frame(const VariantSpec& variant, Frame frame, const journal::Numbers& seconds = {});
  /// What is recorded of the variant's reference; null when it has none, or it was left out.
  [[nodiscard]] const VariantRecord* reference_record(const VariantSpec& variant);
  std::optional<Frame> reference_frame(const VariantSpec& variant, double parameter);
  void log_error(const journal::Place& at, const std::string& message);
  bool time_variants();
  bool time_poses(std::map<std::string, Timing>& timing);
  bool time_processes(std::map<std::string, Timing>& timing);

  class Sink;

  const Experiment& experiment_;
  const CaseSpec& spec_;
  const Topic& topic_;
  Recorder& recorder_;
  RunState& state_;
  Progress& progress_;
  std::shared_ptr<Scene> scene_;
  std::map<std::string, MethodEntry::Instance> prepared_;  ///< by variant, kept for the benchmark
  bool only_declared_ = false;
  std::function<void()> farewell_;
  KeptFrames kept_;  ///< of the current variant, for sequence metrics
};

/// Variants ordered so that a reference precedes those that compare with it; otherwise as given.
/// @throws Error  when they refer to each other in a circle
std::vector<const VariantSpec*> references_first(const std::vector<VariantSpec>& variants);

}  // namespace geoprior
