#pragma once

namespace geoprior {

/// From now on the first Ctrl-C (SIGINT, or SIGTERM) asks the run to stop at its next consistent
/// state, the second ends the program at once.
void install_stop_handler();

/// True after the first Ctrl-C, or after `request_stop`. The runner's context hands it to the
/// methods.
[[nodiscard]] bool stop_requested() noexcept;

/// What the handler does, for tests; `clear_stop` takes it back.
void request_stop() noexcept;
void clear_stop() noexcept;

}  // namespace geoprior
