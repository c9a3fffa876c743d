#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/method.h"
#include "core/options.h"
#include "solvers/fluid/extraction.h"
#include "solvers/fluid/sculpt_scene.h"

namespace geoprior::fluid {

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

}  // namespace geoprior::fluid
