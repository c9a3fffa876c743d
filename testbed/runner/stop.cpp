#include "testbed/runner/stop.h"

#include <csignal>

namespace geoprior {
namespace {

volatile std::sig_atomic_t stop_flag = 0;

extern "C" void on_stop_signal(int signal) {
  if (stop_flag != 0) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  stop_flag = 1;
}

}  // namespace

void install_stop_handler() {
  // SA_RESTART: writing a frame is never interrupted half-way by the first signal.
  struct sigaction action {};
  action.sa_handler = on_stop_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stop_requested() noexcept { return stop_flag != 0; }
void request_stop() noexcept { stop_flag = 1; }
void clear_stop() noexcept { stop_flag = 0; }

}  // namespace geoprior
