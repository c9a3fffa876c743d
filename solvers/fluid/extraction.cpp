#include "solvers/fluid/extraction.h"

#include <map>
#include <utility>

namespace geoprior::fluid {
namespace {

/// Warnings of frames, each once with the frames it was met in.
class FrameWarnings {
 public:
  void add(int frame, const std::vector<std::string>& warnings) {
    for (const std::string& text : warnings) {
      auto [it, is_new] = seen_.try_emplace(text, std::pair{frame, 0});
      ++it->second.second;
    }
  }
  void append_to(std::vector<std::string>& all) const {
    for (const auto& [text, where] : seen_) {
      std::string message = "frame " + std::to_string(where.first);
      if (where.second > 1) message += " and " + std::to_string(where.second - 1) + " later";
      all.push_back(message + ": " + text);
    }
  }

 private:
  std::map<std::string, std::pair<int, int>> seen_;  // first frame, count
};

}  // namespace

void describe(OptionVisitor& v, ExtractionOptions& o) {
  describe_group(v, "segmentation", o.segmentation,
                 {.doc = "how the regions of a frame are found"});
  describe_group(v, "tracking", o.tracking, {.doc = "how regions are joined over time"});
  describe_group(v, "map", o.map, {.doc = "displacement maps of differential features"});
  v.value("shortest_track", o.shortest_track,
          {.doc = "least number of frames of a feature that is lifted out", .min = 1, .max = 1e6});
}

Extraction extract_regions(
    const SurfaceSequence& sequence, const ExtractionOptions& options, RunContext& context,
    const std::function<void(int, const SurfaceFrame&, const SegmentedFrame&)>& each) {
  Extraction result;
  const int frames = sequence.frame_count();
  for (int f = 0; f < frames; ++f) result.times.push_back(sequence.time(f));
  {
    const Phase phase(context, "segment");
    result.segmenter = std::make_shared<const Segmenter>(sequence, options.segmentation);
    result.cell = result.segmenter->cell();
    result.thresholds = result.segmenter->thresholds();
    result.warnings = result.segmenter->warnings();
    FrameWarnings warnings;
    for (int f = 0; f < frames && !context.stop_requested(); ++f) {
      const SurfaceFrame frame = sequence.frame(f);
      SegmentedFrame segmented = result.segmenter->segment(frame, f);
      if (each) each(f, frame, segmented);
      warnings.add(f, frame.notes);
      warnings.add(f, segmented.warnings);
      result.regions.insert(result.regions.end(),
                            std::make_move_iterator(segmented.regions.begin()),
                            std::make_move_iterator(segmented.regions.end()));
      context.progress(static_cast<double>(f + 1) / frames);
    }
    warnings.append_to(result.warnings);
  }
  const Phase phase(context, "track");
  result.tracking = track_regions(result.regions, result.times, result.cell, options.tracking);
  return result;
}

}  // namespace geoprior::fluid
