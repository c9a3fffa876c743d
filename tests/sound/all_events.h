#pragma once

#include <utility>
#include <vector>

#include "core/context.h"
#include "models/sound/events/detector.h"

namespace geoprior::sound {

/// What the detector hears of the frames of a sheet, from the first to the last.
inline std::vector<SoundEvent> all_events(const Sheet& sheet, const DetectionOptions& options,
                                          const std::vector<SheetSnapshot>& frames) {
  RunContext context;
  SoundDetector detector(sheet, options);
  std::vector<SoundEvent> all;
  const auto add = [&](std::vector<SoundEvent> more) {
    for (SoundEvent& e : more) all.push_back(std::move(e));
  };
  for (const SheetSnapshot& frame : frames) add(detector.push(frame, context));
  add(detector.finish(context));
  return all;
}

}  // namespace geoprior::sound
