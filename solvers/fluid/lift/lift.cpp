#include "solvers/fluid/lift/lift.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "solvers/fluid/features/base_surface.h"
#include "solvers/fluid/lift/maps.h"

namespace geoprior::fluid {
namespace {

/// Frames read at a time; each is then worked on by itself.
constexpr int kFramesAtOnce = 8;

const Track* find_track(const Extraction& extraction, int id) {
  for (const Track& t : extraction.tracking.tracks) {
    if (t.id == id) return &t;
  }
  return nullptr;
}

std::vector<const Track*> wanted_tracks(const Extraction& extraction, const std::vector<int>& ids) {
  std::vector<const Track*> result;
  if (ids.empty()) {
    for (const Track& t : extraction.tracking.tracks) result.push_back(&t);
    return result;
  }
  for (const int id : ids) {
    const Track* track = find_track(extraction, id);
    if (track == nullptr) {
      std::string known;
      for (const Track& t : extraction.tracking.tracks) {
        known += (known.empty() ? "" : ", ") + std::to_string(t.id);
      }
      throw Error("there is no feature " + std::to_string(id), "lift",
                  known.empty() ? "none: nothing was found" : known);
    }
    result.push_back(track);
  }
  return result;
}

/// What a region gives to its feature.
struct LiftedRegion {
  std::optional<LiftPatch> patch;  ///< differential
  TriMesh mesh;                    ///< isolated
  std::string refused;             ///< why there is no bed
};

struct Piece {
  std::size_t track;
  const Region* region;
  LiftedRegion lifted;
};

void lift_region(const SurfaceFrame& frame, const FrameLabels& labels, double border,
                 Piece& piece) {
  if (piece.region->kind == RegionKind::isolated) {
    piece.lifted.mesh = isolated_mesh(frame.mesh, labels, piece.region->label);
    return;
  }
  try {
    piece.lifted.patch = lift_patch(frame, labels, *piece.region, border);
  } catch (const Error& error) {  // a frame without a bed is a gap; only all of them are too many
    piece.lifted.refused = error.what();
  }
}

/// Lifts the regions of the wanted tracks frame by frame, a few frames at a time.
std::vector<std::vector<Piece>> lift_pieces(const SurfaceSequence& sequence,
                                            const Extraction& extraction, const Labeller& labeller,
                                            const std::vector<const Track*>& tracks, double border,
                                            RunContext& context) {
  std::map<int, std::vector<Piece>> by_frame;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    for (const int r : tracks[t]->regions) {
      const Region& region = extraction.regions[r];
      by_frame[region.frame].push_back({t, &region, {}});
    }
  }
  std::vector<std::vector<Piece>> result(tracks.size());
  std::size_t done = 0;
  for (auto first = by_frame.begin(); first != by_frame.end() && !context.stop_requested();) {
    std::vector<std::pair<int, std::vector<Piece>*>> chunk;
    std::vector<SurfaceFrame> frames;
    for (; first != by_frame.end() && std::ssize(chunk) < kFramesAtOnce; ++first) {
      chunk.emplace_back(first->first, &first->second);
      frames.push_back(sequence.frame(first->first));
    }
    parallel_blocks(chunk.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const FrameLabels labels = labeller(frames[i], chunk[i].first);
        for (Piece& piece : *chunk[i].second) lift_region(frames[i], labels, border, piece);
      }
    });
    for (const auto& entry : chunk) {
      for (Piece& piece : *entry.second) result[piece.track].push_back(std::move(piece));
    }
    done += chunk.size();
    context.progress(static_cast<double>(done) / static_cast<double>(by_frame.size()));
  }
  return result;
}

Feature differential_feature(std::vector<Piece>& pieces, const Extraction& extraction,
                             const MapOptions& options, int id) {
  std::vector<LiftPatch> patches;
  for (Piece& piece : pieces) {
    if (piece.lifted.patch) patches.push_back(std::move(*piece.lifted.patch));
  }
  if (patches.empty()) {
    throw Error(pieces.empty() ? "no frames" : pieces.front().lifted.refused,
                "feature " + std::to_string(id), "a feature with a bed in some frame");
  }
  return feature_of_patches(std::move(patches), extraction.times, extraction.cell, options);
}

Feature isolated_feature(std::vector<Piece>& pieces, const Extraction& extraction,
                         const MapOptions& options) {
  Feature feature;
  feature.cell = extraction.cell;
  std::vector<FrameSample> samples;
  for (const Piece& piece : pieces) {
    FrameSample sample;
    sample.frame = piece.region->frame;
    sample.time = extraction.times[sample.frame];
    sample.centre = piece.region->centre;
    samples.push_back(sample);
  }
  std::vector<FrameTime> times;
  for (int f = samples.front().frame; f <= samples.back().frame; ++f) {
    times.push_back({f, extraction.times[f]});
  }
  feature.placement = moving_centres(samples, times, options.smoothing_window);
  for (std::size_t i = 0, next = 0; i < times.size(); ++i) {
    feature.times.push_back(times[i].time);
    if (next + 1 < samples.size() && samples[next + 1].frame <= times[i].frame) ++next;
    // In a gap: the mesh of the frame before, carried along the path.
    const Piece& piece = pieces[next];
    const bool own = piece.region->frame == times[i].frame;
    const Eigen::Vector3d origin = own ? feature.placement[i].translation() : piece.region->centre;
    TriMesh mesh = piece.lifted.mesh;
    mesh.V.rowwise() -= origin.transpose();
    feature.meshes.push_back(std::move(mesh));
    feature.area.push_back(piece.region->area);
    feature.volume.push_back(piece.region->volume);
  }
  return feature;
}

const Region* region_in_frame(const Extraction& extraction, const Track& track, int frame) {
  for (const int r : track.regions) {
    const Region& region = extraction.regions[r];
    if (region.frame == frame) return &region;
  }
  return nullptr;
}

/// Regions of a track before and after a frame that it misses; none when it is not alive.
std::vector<const Region*> regions_around(const Extraction& extraction, const Track& track,
                                          int frame) {
  const Region* before = nullptr;
  const Region* after = nullptr;
  for (const int r : track.regions) {
    const Region& region = extraction.regions[r];
    if (region.frame < frame) before = &region;
    if (region.frame > frame && after == nullptr) after = &region;
  }
  if (before == nullptr || after == nullptr) return {};
  return {before, after};
}

/// A wave that a frame's segmentation has missed: bed where it was before or will be after, carried
/// along its path, gets label `label`. False when no vertex is there.
bool label_missed(const SurfaceFrame& frame, int index, const Extraction& extraction,
                  const std::vector<const Region*>& around, int label, FrameLabels& labels) {
  const Region& before = *around[0];
  const Region& after = *around[1];
  const double share =
      static_cast<double>(index - before.frame) / static_cast<double>(after.frame - before.frame);
  const Eigen::Vector3d centre = before.centre + share * (after.centre - before.centre);
  bool any = false;
  for (Eigen::Index v = 0; v < frame.mesh.V.rows(); ++v) {
    if (labels.label[v] != 0 || (!labels.masked.empty() && labels.masked[v] != 0)) continue;
    const Eigen::Vector3d x = frame.mesh.V.row(v).transpose() - centre;
    const bool there = std::any_of(around.begin(), around.end(), [&](const Region* region) {
      return touches_support(region->support, support_cube(x + region->centre, extraction.cell));
    });
    if (!there) continue;
    labels.label[v] = label;
    any = true;
  }
  return any;
}

Labeller labeller_of(const Extraction& extraction) {
  return [&extraction](const SurfaceFrame& frame, int index) {
    SegmentedFrame segmented = extraction.segmenter->segment(frame, index);
    return FrameLabels{std::move(segmented.label), std::move(segmented.masked)};
  };
}

/// A frame without some of its vertices and the triangles at them.
SurfaceFrame without_vertices(const SurfaceFrame& frame, const std::vector<char>& gone) {
  SurfaceFrame result;
  result.time = frame.time;
  std::vector<int> local(gone.size(), -1);
  int count = 0;
  for (std::size_t v = 0; v < gone.size(); ++v) {
    if (gone[v] == 0) local[v] = count++;
  }
  result.mesh.V.resize(count, 3);
  if (frame.velocity.rows() > 0) result.velocity.resize(count, 3);
  for (std::size_t v = 0; v < gone.size(); ++v) {
    if (local[v] < 0) continue;
    result.mesh.V.row(local[v]) = frame.mesh.V.row(v);
    if (frame.velocity.rows() > 0) result.velocity.row(local[v]) = frame.velocity.row(v);
  }
  Eigen::Index kept = 0;
  result.mesh.F.resize(frame.mesh.F.rows(), 3);
  for (Eigen::Index t = 0; t < frame.mesh.F.rows(); ++t) {
    Eigen::RowVector3i f;
    for (int k = 0; k < 3; ++k) f[k] = local[frame.mesh.F(t, k)];
    if (f.minCoeff() >= 0) result.mesh.F.row(kept++) = f;
  }
  result.mesh.F.conservativeResize(kept, 3);
  return result;
}

}  // namespace

std::vector<Feature> lift_tracks(const SurfaceSequence& sequence, const Extraction& extraction,
                                 const Labeller& labeller, const MapOptions& options,
                                 const std::vector<int>& ids, RunContext& context) {
  const std::vector<const Track*> tracks = wanted_tracks(extraction, ids);
  std::vector<std::vector<Piece>> pieces = lift_pieces(sequence, extraction, labeller, tracks,
                                                       options.border * extraction.cell, context);
  std::vector<Feature> result;
  if (context.stop_requested()) return result;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    Feature feature = tracks[t]->kind == RegionKind::isolated
                          ? isolated_feature(pieces[t], extraction, options)
                          : differential_feature(pieces[t], extraction, options, tracks[t]->id);
    pieces[t] = {};
    feature.id = tracks[t]->id;
    feature.kind = tracks[t]->kind;
    // Without folders: the same sequence gives the same features wherever it lies.
    const std::string source = std::filesystem::path(sequence.name()).filename().string();
    feature.name = source + "/" + std::to_string(feature.id);
    result.push_back(std::move(feature));
  }
  return result;
}

std::vector<Feature> lift_features(const SurfaceSequence& sequence, const Extraction& extraction,
                                   const ExtractionOptions& options, const std::vector<int>& ids,
                                   RunContext& context) {
  const Phase phase(context, "lift");
  std::vector<int> wanted = ids;
  if (wanted.empty()) {
    for (const FeatureSummary& s : track_summaries(extraction, options.shortest_track)) {
      wanted.push_back(s.id);
    }
    if (wanted.empty()) return {};
  }
  return lift_tracks(sequence, extraction, labeller_of(extraction), options.map, wanted, context);
}

SurfaceFrame without_regions(const SurfaceFrame& frame, const FrameLabels& labels,
                             const std::vector<Region>& regions, double border) {
  SurfaceFrame result = frame;
  std::vector<int> waves, drops;
  for (const Region& r : regions) {
    (r.kind == RegionKind::isolated ? drops : waves).push_back(r.label);
  }
  if (!waves.empty()) {
    const std::vector<double> distance = distance_from_region(frame.mesh, labels, waves, border);
    std::vector<char> inside(distance.size());
    for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = std::isfinite(distance[v]) ? 1 : 0;
    result.mesh.V = unfolded_base(frame.mesh, inside);
  }
  if (drops.empty()) return result;
  std::vector<char> gone(labels.label.size(), 0);
  for (std::size_t v = 0; v < gone.size(); ++v) {
    gone[v] = std::find(drops.begin(), drops.end(), labels.label[v]) != drops.end() ? 1 : 0;
  }
  return without_vertices(result, gone);
}

SurfaceFrame without_feature(const SurfaceFrame& frame, int frame_index,
                             const Extraction& extraction, const ExtractionOptions& options,
                             const std::vector<int>& ids) {
  std::vector<Region> regions;
  std::vector<std::vector<const Region*>> missed;
  for (const Track* track : wanted_tracks(extraction, ids)) {
    const Region* region = region_in_frame(extraction, *track, frame_index);
    if (region != nullptr) {
      regions.push_back(*region);
    } else if (track->kind == RegionKind::differential) {
      auto around = regions_around(extraction, *track, frame_index);
      if (!around.empty()) missed.push_back(std::move(around));
    }
  }
  if (regions.empty() && missed.empty()) return frame;
  FrameLabels labels = labeller_of(extraction)(frame, frame_index);
  int label =
      labels.label.empty() ? 0 : *std::max_element(labels.label.begin(), labels.label.end());
  for (const auto& around : missed) {
    Region region;
    region.frame = frame_index;
    region.label = ++label;
    if (label_missed(frame, frame_index, extraction, around, label, labels)) {
      regions.push_back(region);
    }
  }
  return without_regions(frame, labels, regions, options.map.border * extraction.cell);
}

std::vector<FeatureSummary> track_summaries(const Extraction& extraction, int shortest) {
  std::vector<FeatureSummary> result;
  for (const Track& track : extraction.tracking.tracks) {
    if (std::ssize(track.regions) < shortest) continue;
    FeatureSummary summary;
    summary.id = track.id;
    for (const int r : track.regions) {
      const Region& region = extraction.regions[r];
      summary.times.push_back(extraction.times[region.frame]);
      summary.centres.push_back(region.centre);
      summary.largest_area = std::max(summary.largest_area, region.area);
    }
    result.push_back(std::move(summary));
  }
  return result;
}

}  // namespace geoprior::fluid
