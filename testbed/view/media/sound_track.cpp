#include "testbed/view/media/sound_track.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "testbed/view/figure/frame_times.h"

namespace geoprior {
namespace {

/// Why pictures at these times cannot keep step with a sound; empty when they can.
std::string step_problem(const CaseRecord& of, const std::vector<double>& times) {
  if (!has_times(of)) return "the frames are at no times but at " + of.parameter_name;
  if (times.size() < 2) return "there is one frame only";
  if (times.front() < 0) return "the frames begin before the sound";
  const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double even = times.front() + step * static_cast<double>(i);
    if (std::abs(times[i] - even) > 0.1 * step) return "the frames are not evenly spaced in time";
  }
  return {};
}

}  // namespace

const StoredFile* sound_of(const VariantRecord& variant) {
  const auto found = std::find_if(
      variant.artifacts.begin(), variant.artifacts.end(),
      [](const auto& file) { return std::filesystem::path(file.name).extension() == ".wav"; });
  return found == variant.artifacts.end() ? nullptr : &*found;
}

bool has_times(const CaseRecord& of) { return of.parameter_unit == "s"; }

std::vector<const VariantRecord*> sounding_variants(const RunRecord& record,
                                                    const FigureView& view) {
  const CaseRecord* of = first_drawn_case(record, view);
  if (of == nullptr) return {};
  std::vector<const VariantRecord*> variants = drawn_variants(*of, view);
  std::erase_if(variants, [](const VariantRecord* v) { return sound_of(*v) == nullptr; });
  return variants;
}

std::optional<SoundTrack> sound_track(const RunRecord& record, const FigureView& view,
                                      const std::vector<double>& times, std::string& problem) {
  const std::vector<const VariantRecord*> variants = sounding_variants(record, view);
  if (variants.empty()) return std::nullopt;
  problem = step_problem(*first_drawn_case(record, view), times);
  if (!problem.empty()) return std::nullopt;
  const double rate = static_cast<double>(times.size() - 1) / (times.back() - times.front());
  return SoundTrack{variants.front()->name, *sound_of(*variants.front()), times.front(), rate};
}

}  // namespace geoprior
