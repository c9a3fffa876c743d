#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

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
/// isolated, 2 differential), "velocity" when known; part "maps" none; table "regions" (label,
/// track, kind, centre, area, volume); last: table "tracks", table "events". Diagnostics: regions,
/// tracks, masked share. Labels are known at once, tracks after the last frame: frames are pushed
/// then.
struct ExtractOptions {
  ExtractionOptions extraction;
};
void describe(OptionVisitor& v, ExtractOptions& options);
std::unique_ptr<Process> make_extract(const SculptScene& scene, const ExtractOptions& options);

/// Lifts the edited features out of their sources and pastes them into the target, frame by frame:
/// part "surface" with "velocity" when known, "feature" (id of the feature that moved the vertex,
/// 0); diagnostics of PasteReport. Phases "segment", "track", "lift", "paste".
struct SculptOptions {
  ExtractionOptions extraction;
  PasteOptions paste;
};
void describe(OptionVisitor& v, SculptOptions& options);
std::unique_ptr<Process> make_sculpt(const SculptScene& scene, const SculptOptions& options);

}  // namespace geoprior
