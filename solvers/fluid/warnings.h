#pragma once

#include <set>
#include <string>

#include "core/method.h"
#include "core/state_bytes.h"

namespace geoprior::fluid {

/// Tells of each thing once, also in a run that goes on after a stop.
class Warnings {
 public:
  /// Pushes an event of kind "warning: text", unless there was one with the same `about`: the text
  /// without what changes from frame to frame.
  void warn(const std::string& text, const std::string& about, double time, FrameSink& sink);
  void save(StateWriter& out) const;
  void load(StateReader& in);

 private:
  std::set<std::string> told_;
};

}  // namespace geoprior::fluid
