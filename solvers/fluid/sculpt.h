#pragma once

#include <memory>

#include "core/method.h"
#include "core/options.h"
#include "solvers/fluid/extraction.h"
#include "solvers/fluid/paste/paste.h"
#include "solvers/fluid/sculpt_scene.h"

namespace geoprior::fluid {

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

}  // namespace geoprior::fluid
