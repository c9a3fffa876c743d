#pragma once

#include <optional>
#include <string>
#include <vector>

#include "testbed/figure_view.h"
#include "testbed/runner/journal/run_record.h"

namespace geoprior {

/// The sound of a variant: its first artifact that is a WAV file; null when it has none. Its first
/// sample is at the time 0 of the frames.
const StoredFile* sound_of(const VariantRecord& variant);

/// Whether the frames of a case are at times (s), so that a sound can go with them.
bool has_times(const CaseRecord& of);

/// Variants with a sound among those that are drawn of the view's first case.
std::vector<const VariantRecord*> sounding_variants(const RunRecord& record,
                                                    const FigureView& view);

/// What a video of the frames plays, and at what rate its pictures then keep step with it.
struct SoundTrack {
  std::string variant;
  StoredFile file;
  double start_s = 0;            ///< of the sound, at the first picture
  double frames_per_second = 0;  ///< of frames in real time
};

/// The sound of the first of those variants; absent, with the reason in `problem` where it has a
/// sound, when the frames are not evenly spaced in time (to a tenth of their distance), begin
/// before the sound or are fewer than two.
///
/// @param times  of the frames (s), rising
std::optional<SoundTrack> sound_track(const RunRecord& record, const FigureView& view,
                                      const std::vector<double>& times, std::string& problem);

}  // namespace geoprior
