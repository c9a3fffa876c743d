#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace geoprior::test {

/// What lasts longer is taken for something that will never come: far more than any machine needs,
/// so that no test that passes depends on how fast one is.
constexpr std::chrono::minutes kNever{5};

/// Waits until the condition holds.
///
/// @return  false where it still does not after `kNever`
inline bool await(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + kNever;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace geoprior::test
