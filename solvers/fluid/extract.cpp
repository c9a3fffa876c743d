#include "solvers/fluid/extract.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/frame_loop.h"
#include "solvers/fluid/lift/lift.h"
#include "solvers/fluid/lift/lifted_frames.h"
#include "solvers/fluid/warnings.h"

namespace geoprior::fluid {

namespace {

/// What is kept of a frame until the tracks are known.
struct Kept {
  Eigen::VectorXf curvature;
  std::vector<int> label;
  double masked_share = 0;
  double bytes = 0;  ///< of the mesh
};

/// What `lift` adds to the frames.
struct Lifted {
  std::vector<Feature> features;
  std::vector<Artifact> files;
  const Feature* shown = nullptr;  ///< its map is recorded; may be null
  std::map<std::string, double> diagnostics;
};

int kind_number(RegionKind kind) { return kind == RegionKind::isolated ? 1 : 2; }

class ExtractFrames final : public FrameModel {
 public:
  ExtractFrames(const SurfaceSequence& source, const ExtractOptions& options,
                const FeatureFiles& files)
      : source_(source), options_(options), files_(files) {}

  [[nodiscard]] int frame_count() const override { return source_.frame_count(); }

  void begin(FrameSink& sink, RunContext& context) override {
    segment(context);
    if (context.stop_requested()) return;
    for (const std::string& w : extraction_.warnings) warnings_.warn(w, w, 0, sink);
    if (options_.lift) lift(context);
    if (context.stop_requested()) return;
    track_of_ = tracks_of(extraction_);
  }

  void record(int i, FrameSink& sink, RunContext& /*context*/) override {
    const bool is_last = i + 1 == frame_count();
    Frame frame = labelled(i);
    frame.diagnostics.merge(std::map(lifted_.diagnostics));
    if (lifted_.shown != nullptr) {
      frame.parts["map"] = map_part(*lifted_.shown, extraction_.times[i]);
    }
    if (is_last) add_tracks(extraction_, frame);
    if (is_last && options_.lift) add_features(frame);
    sink.frame(std::move(frame));
    // Before the last checkpoint: a run that goes on after it has them, one before makes them.
    if (is_last) {
      for (Artifact& file : lifted_.files) sink.artifact(std::move(file));
    }
  }

  void save(StateWriter& out) const override { warnings_.save(out); }
  void load(StateReader& in, int /*next_frame*/) override { warnings_.load(in); }

 private:
  void segment(RunContext& context) {
    kept_.resize(source_.frame_count());
    const auto keep = [&](int i, const SurfaceFrame& source, const SegmentedFrame& segmented) {
      Kept& k = kept_[i];
      k.bytes = mesh_bytes(source.mesh);
      k.curvature = segmented.curvature.cast<float>();
      k.label = segmented.label;
      const auto masked = std::count(segmented.masked.begin(), segmented.masked.end(), char{1});
      k.masked_share = segmented.masked.empty() ? 0
                                                : static_cast<double>(masked) /
                                                      static_cast<double>(segmented.masked.size());
    };
    extraction_ = extract_regions(source_, options_.extraction, context, keep);
  }

  /// Track id of every region, 0 for none.
  static std::vector<int> tracks_of(const Extraction& extraction) {
    std::vector<int> result(extraction.regions.size(), 0);
    for (const Track& track : extraction.tracking.tracks) {
      for (const int r : track.regions) result[r] = track.id;
    }
    return result;
  }

  void lift(RunContext& context) {
    lifted_.features = lift_features(source_, extraction_, options_.extraction, {}, context);
    if (context.stop_requested()) return;
    lifted_.shown = shown_map(lifted_.features, options_.map_feature);
    if (files_) {
      const Phase phase(context, "store");
      lifted_.files = files_(lifted_.features);
    }
    double features = 0, files = 0, sequence = 0;
    for (const Feature& f : lifted_.features) features += static_cast<double>(f.bytes());
    for (const Artifact& file : lifted_.files) files += static_cast<double>(file.bytes.size());
    for (const Kept& k : kept_) sequence += k.bytes;
    lifted_.diagnostics = {{"lifted_features", static_cast<double>(lifted_.features.size())},
                           {"feature_bytes", features},
                           {"feature_file_bytes", files},
                           {"sequence_bytes", sequence}};
  }

  void add_features(Frame& frame) const {
    std::vector<double> bytes;
    for (const Kept& k : kept_) bytes.push_back(k.bytes);
    frame.tables["features"] = feature_table(lifted_.features, extraction_.times, bytes);
  }

  [[nodiscard]] Frame labelled(int i) const {
    const Kept& kept = kept_[i];
    SurfaceFrame source = source_.frame(i);
    Frame frame;
    frame.parameter = source.time;
    const Eigen::Index n = source.mesh.V.rows();
    Eigen::VectorXd label(n), track = Eigen::VectorXd::Zero(n), kind = Eigen::VectorXd::Zero(n);
    std::vector<std::vector<double>> rows;
    std::map<int, std::pair<int, int>> of_label;  // track and kind
    for (std::size_t r = 0; r < extraction_.regions.size(); ++r) {
      const Region& region = extraction_.regions[r];
      if (region.frame != i) continue;
      of_label[region.label] = {track_of_[r], kind_number(region.kind)};
      rows.push_back({static_cast<double>(region.label), static_cast<double>(track_of_[r]),
                      static_cast<double>(kind_number(region.kind)), region.centre.x(),
                      region.centre.y(), region.centre.z(), region.area, region.volume});
    }
    for (Eigen::Index v = 0; v < n; ++v) {
      label[v] = kept.label[v];
      const auto found = of_label.find(kept.label[v]);
      if (found == of_label.end()) continue;
      track[v] = found->second.first;
      kind[v] = found->second.second;
    }
    Part& surface = frame.parts["surface"];
    surface.points = std::move(source.mesh.V);
    surface.triangles = std::move(source.mesh.F);
    const auto on = NamedArray::On::points;
    surface.arrays.push_back({"curvature", "1/m", on, kept.curvature.cast<double>()});
    surface.arrays.push_back({"label", "1", on, label});
    surface.arrays.push_back({"track", "1", on, track});
    surface.arrays.push_back({"kind", "1", on, kind});
    if (source.velocity.rows() == n && n > 0) {
      surface.arrays.push_back({"velocity", "m/s", on, source.velocity});
    }
    frame.tables["regions"] = table({"label [1]", "track [1]", "kind [1]", "x [m]", "y [m]",
                                     "z [m]", "area [m^2]", "volume [m^3]"},
                                    rows);
    frame.diagnostics["regions"] = static_cast<double>(rows.size());
    frame.diagnostics["tracks"] = static_cast<double>(extraction_.tracking.tracks.size());
    frame.diagnostics["masked_share"] = kept.masked_share;
    return frame;
  }

  static FrameTable table(const std::vector<std::string>& columns,
                          const std::vector<std::vector<double>>& rows) {
    FrameTable result;
    result.columns = columns;
    result.rows.resize(rows.size(), columns.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c) {
        result.rows(r, c) = rows[r][c];
      }
    }
    return result;
  }

  static void add_tracks(const Extraction& extraction, Frame& frame) {
    std::vector<std::vector<double>> tracks, events;
    for (const Track& track : extraction.tracking.tracks) {
      const auto region = [&](int r) { return extraction.regions[r]; };
      double largest = 0;
      for (const int r : track.regions) largest = std::max(largest, region(r).area);
      const auto time = [&](int r) { return extraction.times[region(r).frame]; };
      tracks.push_back({static_cast<double>(track.id), static_cast<double>(kind_number(track.kind)),
                        time(track.regions.front()), time(track.regions.back()),
                        static_cast<double>(track.regions.size()), largest});
    }
    for (const TrackEvent& e : extraction.tracking.events) {
      events.push_back({static_cast<double>(e.kind), extraction.times[e.frame],
                        static_cast<double>(e.from), static_cast<double>(e.to)});
    }
    frame.tables["tracks"] = table(
        {"track [1]", "kind [1]", "begin [s]", "end [s]", "regions [1]", "largest_area [m^2]"},
        tracks);
    frame.tables["events"] = table({"kind [1]", "time [s]", "from [1]", "to [1]"}, events);
  }

  const SurfaceSequence& source_;
  const ExtractOptions& options_;
  const FeatureFiles& files_;
  Warnings warnings_;
  Extraction extraction_;
  std::vector<Kept> kept_;     ///< by frame
  std::vector<int> track_of_;  ///< by region: its track's id, 0 for none
  Lifted lifted_;
};

}  // namespace

void describe(OptionVisitor& v, ExtractOptions& o) {
  describe_group(v, "extraction", o.extraction, {.doc = "how features are found and lifted out"});
  v.value("lift", o.lift, {.doc = "lifts the features out: their maps are recorded and stored"});
  v.value("map_feature", o.map_feature,
          {.doc = "differential feature whose map is recorded, by its id; absent: the largest",
           .min = 1});
}

std::unique_ptr<Process> make_extract(const SculptScene& scene, const ExtractOptions& options,
                                      FeatureFiles files) {
  if (scene.sources.empty() || scene.sources.begin()->second == nullptr) {
    throw Error("there is nothing to extract features from", "scene", "a source");
  }
  return frame_process([source = scene.sources.begin()->second, options,
                        files = std::move(files)](RunContext& /*context*/) {
    return std::make_unique<ExtractFrames>(*source, options, files);
  });
}

}  // namespace geoprior::fluid
