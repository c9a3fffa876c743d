#include "core/frame_loop.h"

#include <string>
#include <utility>

#include "core/error.h"

namespace geoprior {
namespace {

/// Loads the model and returns the number of its next frame.
int resume(FrameModel& model, const State& state) {
  StateReader in(state);
  const int next_frame = in.number<int>();
  const int count = model.frame_count();
  if (next_frame < 1 || next_frame > count) {
    throw Error("goes on with frame " + std::to_string(next_frame) + " of " + std::to_string(count),
                "checkpoint", "one of the same process");
  }
  model.load(in, next_frame);
  in.require_end();
  return next_frame;
}

State checkpoint(const FrameModel& model, int next_frame) {
  StateWriter out;
  out.number(next_frame);
  model.save(out);
  return out.take();
}

class FrameProcess final : public Process {
 public:
  explicit FrameProcess(std::function<std::unique_ptr<FrameModel>(RunContext&)> make)
      : make_(std::move(make)) {}
  void run(FrameSink& sink, RunContext& context, const std::optional<State>& resume_from) override {
    run_frames(*make_(context), sink, context, resume_from);
  }

 private:
  std::function<std::unique_ptr<FrameModel>(RunContext&)> make_;
};

}  // namespace

void run_frames(FrameModel& model, FrameSink& sink, RunContext& context,
                const std::optional<State>& resume_from) {
  int frame = 0;
  if (resume_from) {
    frame = resume(model, *resume_from);
  } else {
    model.start(context);
  }
  model.begin(sink, context);
  for (const int count = model.frame_count(); frame < count; ++frame) {
    if (context.stop_requested()) return;
    if (frame > 0) model.advance(frame, sink, context);
    model.record(frame, sink, context);
    context.progress(static_cast<double>(frame + 1) / count);
    if (model.can_resume()) sink.checkpoint(checkpoint(model, frame + 1));
  }
}

std::unique_ptr<Process> frame_process(
    std::function<std::unique_ptr<FrameModel>(RunContext& context)> make) {
  return std::make_unique<FrameProcess>(std::move(make));
}

}  // namespace geoprior
