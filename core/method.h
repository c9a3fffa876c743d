#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/context.h"
#include "core/frame.h"

namespace geoprior {

/// First shape of a method: a closed formula or a local solve, random access, no memory between
/// calls unless it says so (`path_dependent`).
///
/// `solve` leaves its result inside the object; `frame` copies it out. They are apart because the
/// benchmark times `solve` alone: recording is no part of a method's cost. Constructing one is
/// `prepare`.
class PoseMethod {
 public:
  virtual ~PoseMethod() = default;
  /// Computes the state at a parameter of the scene. No allocation once warm.
  virtual void solve(double parameter, RunContext& context) = 0;
  /// Whether a solve begins where the one before ended. Such a method is asked for the parameters
  /// in their order, each once, after `restart`.
  [[nodiscard]] virtual bool path_dependent() const { return false; }
  /// Forgets what was solved: the next `solve` begins a path.
  virtual void restart() {}
  /// The state that the last `solve` left.
  [[nodiscard]] virtual Frame frame() const = 0;
};

/// Opaque saved state of a process.
using State = std::vector<std::byte>;

/// Receives what a process makes, as it comes.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  virtual void frame(Frame frame) = 0;
  virtual void event(const Event& event) = 0;
  virtual void artifact(Artifact artifact) = 0;
  /// State from which `Process::run` can go on after the frames, events and artifacts pushed so
  /// far.
  virtual void checkpoint(const State& state) = 0;
};

/// Second shape of a method: owns its loop (an optimiser, a simulation, an enumeration) and ends
/// when it is done.
class Process {
 public:
  virtual ~Process() = default;
  /// Runs to the end, or until `context.stop_requested()`. `resume_from` is a state it saved
  /// itself, absent for a fresh start or when it never saved one. Must produce the same frames
  /// either way.
  virtual void run(FrameSink& sink, RunContext& context,
                   const std::optional<State>& resume_from) = 0;
};

}  // namespace geoprior
