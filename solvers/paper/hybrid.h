#pragma once

#include <memory>

#include "models/paper/sheet/process.h"
#include "solvers/paper/hybrid_options.h"

namespace geoprior::paper {

/// The hybrid model as a process (thesis 3.2.1, Figures 3.6 to 3.9): elastic steps on a coarse mesh
/// whose edges are the rulings of planes, cylinders and cones; after every few frames the rulings
/// follow the bending that the steps have left, as an even mesh relaxes it, and its compression.
///
/// Paper that tears (`Sheet::toughness`) does so at the candidates of torn_structure.h after every
/// step (thesis 3.2.2); the lips are borders of the structure, the tips singular points.
///
/// What it cannot do: no contact of the sheet with itself on the geometric layer; a d-cone is a
/// point, not a crescent; a ruling has few vertices (`ruling_parts`), so it hardly bends until a
/// singular point breaks it.
///
/// Frames have the parts "rulings" (lines; cell arrays "piece", "kind": 0 flat, 1 cylinder, 2 cone)
/// and "singular_points" (points; "id", "birth" [s], "weakening"), the cell arrays "piece" and
/// "kind" on "surface", the tables "pieces" and "singular_points", and as diagnostics the numbers
/// of pieces of each kind, the events of the frame and the edge strain around the projection.
/// Phases: "analyse", "propagate", "remesh", "project", "weigh", "settle".
std::unique_ptr<Process> make_hybrid_sheet(const Sheet& sheet, const HybridOptions& options);

}  // namespace geoprior::paper
