#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/method.h"
#include "core/options.h"
#include "core/surface_sequence.h"
#include "solvers/fluid/edits.h"
#include "solvers/fluid/extraction.h"
#include "solvers/fluid/paste.h"

namespace geoprior {

/// Inputs of both processes below. Sequences are read frame by frame.
struct SculptScene {
  std::map<std::string, std::shared_ptr<const SurfaceSequence>> sources;
  std::map<std::string, std::vector<Feature>> libraries;  ///< features read from files
  std::shared_ptr<const SurfaceSequence> target;          ///< one frame: a still mesh
  std::vector<Edit> edits;
  std::vector<double> times;  ///< of the result (s)
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};

/// Frames of the first source as it is, labelled: part "surface" with point arrays "curvature"
/// [1/m], "label" (1 … region of the frame), "track" (feature id, 0: bed), "kind" (0 bed, 1
/// isolated, 2 differential), "velocity" when known; table "regions" (label, track, kind, centre,
/// area, volume); in the last frame: tables "tracks", "events". Diagnostics: "regions", "tracks",
/// "masked_share". Tracks are known after the last frame: frames are pushed then. Events of kind
/// "warning: …" say what was noticed. Resumes by frame: segmentation is repeated, frames are not.
///
/// With `lift`, the tracks of at least `shortest_track` frames are lifted out as well (phase
/// "lift"). Every frame has the part "map" then (lifted_frames.h), unless no feature is
/// differential, and the diagnostics "lifted_features", "feature_bytes", "feature_file_bytes",
/// "sequence_bytes"; the last has the table "features", and the files come with it.
struct ExtractOptions {
  ExtractionOptions extraction;
  bool lift = false;
  std::optional<int> map_feature;  ///< id; absent: the largest differential feature
};
void describe(OptionVisitor& v, ExtractOptions& options);

/// Makes files of features: solvers know no file format. The same features, the same bytes.
using FeatureFiles = std::function<std::vector<Artifact>(const std::vector<Feature>&)>;

/// @param files  called once with all lifted features, in phase "store"; may be empty
/// @throws Error  for a scene without a source; `run` for a `map_feature` that is not there
std::unique_ptr<Process> make_extract(const SculptScene& scene, const ExtractOptions& options,
                                      FeatureFiles files = {});

/// Lifts the edited features out of their sources and pastes them into the target (its frame
/// nearest in time), frame by frame: part "surface" with "velocity" when known (0 for a still
/// mesh), "feature" (id of the feature that moved the vertex most, 0); table "insertions" (what is
/// there at this time). Diagnostics: those of PasteReport, and of the work: "lifted_features",
/// "feature_bytes", "target_vertices". Phases "segment", "track", "lift", "cut", "paste". Events of
/// kind "warning: …" once for each thing noticed. Resumes by frame: features are lifted again.
struct SculptOptions {
  ExtractionOptions extraction;
  PasteOptions paste;
};
void describe(OptionVisitor& v, SculptOptions& options);
/// @throws Error  when the scene has no target, no times or no edits, an edit is not valid or names
/// a source that is not there, or cuts out of one that is not the target; `run` throws for ids that
/// do not exist, and for edits that lie off the target at all of the times
std::unique_ptr<Process> make_sculpt(const SculptScene& scene, const SculptOptions& options);

}  // namespace geoprior
