#include "testbed/runner/inputs/made_run.h"

#include <array>
#include <chrono>
#include <thread>
#include <utility>

#include "testbed/runner/inputs/making_lock.h"
#include "testbed/runner/journal/journal.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/run_folder.h"
#include "testbed/runner/single_run.h"
#include "testbed/streams.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

/// An experiment with its times, and without.
using Forms = std::array<Experiment, 2>;

/// Finished runs in which another program failed are gone on with (`run_to_go_on_with`).
std::optional<OpenedRun> find_finished(const Forms& forms, const Topic& topic) {
  for (const Experiment& form : forms) {
    const auto folder = find_run(form);
    if (!folder) continue;
    OpenedRun run(*folder);
    if (!has_failed_outside(run.record(), topic)) return run;
  }
  return std::nullopt;
}

/// An interrupted run, or one in which another program failed; absent: a new one is made.
std::optional<fs::path> run_to_go_on_with(const Experiment& experiment) {
  auto folder = find_unfinished_run(experiment);
  return folder ? folder : find_run(experiment);
}

/// The folder of a run that another program is writing. It may be a run of its own, which needs no
/// lock to be made.
std::optional<fs::path> find_written(const Forms& forms) {
  for (const Experiment& form : forms) {
    const auto folder = find_unfinished_run(form);
    if (folder && is_being_written(*folder)) return folder;
  }
  return std::nullopt;
}

/// Whose turn it is to make the run.
struct Turn {
  std::optional<OpenedRun> finished;  ///< nobody's: it is there; absent: ours
};

/// Waits while another program makes the same run; nothing after a stop.
std::optional<Turn> wait_for_turn(const Forms& forms, const Topic& topic, MakingLock& lock) {
  constexpr std::chrono::milliseconds kPause{200};
  for (bool told = false; !stop_requested(); told = true) {
    const bool is_ours = lock.try_lock();
    const std::optional<fs::path> written = find_written(forms);
    std::optional<OpenedRun> finished = find_finished(forms, topic);
    if (finished || (is_ours && !written)) return Turn{std::move(finished)};
    if (!told) {
      say("waiting for " + (written ? written->string() : "a run of " + forms[0].id) +
          ", which another program is making");
    }
    std::this_thread::sleep_for(kPause);
  }
  return std::nullopt;
}

}  // namespace

void leave_out_times(Experiment& experiment) {
  std::erase_if(experiment.studies,
                [](const StudySpec& study) { return study.quantity.starts_with("timing:"); });
  std::erase_if(experiment.claims,
                [](const ClaimSpec& claim) { return claim.exempt == Exemption::timing; });
}

Experiment without_times(Experiment experiment) {
  leave_out_times(experiment);
  experiment.hash = sha256(experiment.hash + " without times");
  return experiment;
}

std::optional<OpenedRun> find_or_make_run(const Experiment& experiment,
                                          const std::vector<Topic>& topics,
                                          const ExecuteRequest& request,
                                          const std::string& announcement) {
  const Forms forms{experiment, without_times(experiment)};
  const Topic& topic = topic_of(experiment, topics);
  if (auto finished = find_finished(forms, topic)) return finished;
  MakingLock lock(experiment.hash);
  std::optional<Turn> turn = wait_for_turn(forms, topic, lock);
  if (!turn) return std::nullopt;
  if (turn->finished) return std::move(turn->finished);
  const Experiment& made = forms[request.timing ? 0 : 1];
  ExecuteRequest own = request;
  own.out = run_to_go_on_with(made);
  own.resume = own.out.has_value();
  say(announcement);
  ExecuteResult result = run_once(made, topics, own, input_maker(topics));
  if (result.stopped) return std::nullopt;
  return OpenedRun(result.folder, std::move(result.record));
}

InputMaker input_maker(const std::vector<Topic>& topics) {
  return [&topics](const Experiment& input, const ExecuteRequest& request) {
    return find_or_make_run(input, topics, request, input.id + " is needed first");
  };
}

}  // namespace geoprior
