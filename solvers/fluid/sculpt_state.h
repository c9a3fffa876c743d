#pragma once

#include <set>
#include <string>

#include "core/method.h"

namespace geoprior::fluid {

/// Where a process over independent frames goes on, and what it has warned of.
struct SculptState {
  int next_frame = 0;
  std::set<std::string> warned;

  [[nodiscard]] State bytes() const;
  /// @throws Error  for bytes that are none of these
  static SculptState of(const State& state);
  /// Tells of a thing once; `about` is the text without its time.
  void warn(const std::string& text, const std::string& about, double time, FrameSink& sink);
};

}  // namespace geoprior::fluid
