#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "core/method.h"
#include "core/state_bytes.h"

namespace geoprior {

/// What a process makes frame by frame, and remembers between two frames. `run_frames` drives it.
///
/// Calls of one run: `start` or `load`, `begin`, then for every frame `advance` (not for frame 0),
/// `record`, `save`. A model is made for one run.
class FrameModel {
 public:
  virtual ~FrameModel() = default;
  [[nodiscard]] virtual int frame_count() const = 0;
  /// The state of frame 0.
  virtual void start(RunContext& /*context*/) {}
  /// In place of `start`: the state that `save` wrote, after which `next_frame` comes.
  /// @throws Error  for bytes that are none
  virtual void load(StateReader& /*in*/, int /*next_frame*/) {}
  /// What is to be done before the first frame of this run, new or resumed. It may end early when a
  /// stop is requested: no frame is asked for then.
  virtual void begin(FrameSink& /*sink*/, RunContext& /*context*/) {}
  /// From the state of frame - 1 to that of `frame`.
  virtual void advance(int /*frame*/, FrameSink& /*sink*/, RunContext& /*context*/) {}
  /// Pushes one frame, and the events and artifacts that come with it.
  virtual void record(int frame, FrameSink& sink, RunContext& context) = 0;
  /// All that the frames to come depend on, beside the number of the next one.
  virtual void save(StateWriter& /*out*/) const {}
  /// False: there are no checkpoints, a run that was stopped begins again.
  [[nodiscard]] virtual bool can_resume() const { return true; }
};

/// The loop of a process: asks before every frame whether to stop, advances, records, tells the
/// progress, leaves a checkpoint; a run that is resumed from one makes the frames that are missing.
/// @throws Error  for a state that no run of this model left
void run_frames(FrameModel& model, FrameSink& sink, RunContext& context,
                const std::optional<State>& resume_from);

/// A process whose frames are those of a model. `make` is called once a run, before anything else.
std::unique_ptr<Process> frame_process(
    std::function<std::unique_ptr<FrameModel>(RunContext& context)> make);

}  // namespace geoprior
