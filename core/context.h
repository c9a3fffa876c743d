#pragma once

#include <cstdint>
#include <string_view>

#include "core/random.h"

namespace geoprior {

/// What a method is given and must not own: the clock, the wish to stop, progress, the seed.
///
/// Methods mark phases; the runner reads the clock. A plain `RunContext` ignores everything, so
/// that a method can be lifted out of the testbed and called with `RunContext context;`.
class RunContext {
 public:
  explicit RunContext(std::uint64_t seed = 1) : seed_(seed) {}
  virtual ~RunContext() = default;

  virtual void begin_phase(std::string_view /*name*/) {}
  virtual void end_phase() {}
  /// True after Ctrl-C: a process leaves its loop at the next consistent state.
  [[nodiscard]] virtual bool stop_requested() const { return false; }
  /// Fraction done, 0 … 1, of the current method.
  virtual void progress(double /*fraction*/) {}

  [[nodiscard]] std::uint64_t seed() const { return seed_; }
  [[nodiscard]] RandomStream random(std::string_view purpose) const { return {seed_, purpose}; }

 private:
  std::uint64_t seed_;
};

/// Marks a phase for as long as it lives. Phases nest; a phase's time includes those inside it.
class Phase {
 public:
  Phase(RunContext& context, std::string_view name) : context_(context) {
    context_.begin_phase(name);
  }
  ~Phase() { context_.end_phase(); }
  Phase(const Phase&) = delete;
  Phase& operator=(const Phase&) = delete;

 private:
  RunContext& context_;
};

}  // namespace geoprior
