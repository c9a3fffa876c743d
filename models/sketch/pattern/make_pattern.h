#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "core/options.h"
#include "models/sketch/flatten/flatten.h"
#include "models/sketch/pattern/pattern.h"
#include "models/sketch/surface/cut_surface.h"

namespace geoprior::sketch {

/// What of a piece points to +y in the pattern.
enum class GrainRule {
  up,  ///< the direction that is +y on the surface; that of `longest` where the piece lies flat
  longest,  ///< its axis of largest second moment of area, with the surface's +y upwards
};

struct PatternOptions {
  FlattenOptions flatten = {};
  /// Another way to lay a disc flat at true scale than `flatten`, to compare with; its report is
  /// empty.
  std::function<Eigen::MatrixX2d(const TriMesh&)> lay_disc = {};
  GrainRule grain = GrainRule::up;
  double gap = 0.02;
  std::optional<double> width = {};
  bool equal_seams = true;
  double seam_mismatch = 0.004;
  /// A border that turns by -2 pi within this is a hole in something flat and stays (deg).
  double hole_tolerance_deg = 10;
  int most_pieces = 0;  ///< that suggested seams may make; 0: any number
};
void describe(OptionVisitor& v, PatternOptions& options);

/// Whether a piece is a disc, or one with holes in something flat.
/// @param hole_tolerance  rad; see PatternOptions
bool can_be_laid_flat(const CutPiece& piece, double hole_tolerance);

/// A pattern and how it came about.
struct MadePattern {
  Pattern pattern;
  std::vector<FlattenReport> reports;  ///< of each piece
  /// Cuts beside the seams that were asked for, one seam a piece, numbered above those.
  std::vector<SeamEdge> added_seams;
};

/// Cuts a surface along its seams, lays every piece flat at true scale and the pieces side by side.
///
/// Pieces keep the order of `cut_surface`; their names are "piece 1", … . A piece that is closed,
/// has a handle or a border that is no hole in something flat is cut open along its shortest cut
/// (`shortest_cut`), whose two sides are then sewn together like those of any seam. Every piece is
/// turned so that its grain is +y, then placed on shelves from y = 0 up, the highest pieces first,
/// all at x >= 0 with `gap` between their boxes. Borders: the outer one first. Both sides of a seam
/// are then held at one length, between those that they have freely. Pieces are laid flat
/// in parallel; the result is the same at any number of threads.
///
/// @param surface  of length m
/// @throws Error   as `cut_surface` and `flatten`
MadePattern make_pattern(const TriMesh& surface, std::span<const SeamEdge> seams,
                         const PatternOptions& options = {});

/// Difference of the lengths of the two stretches of a seam over their mean, without sign.
struct SeamMismatch {
  int piece = -1, edge = -1;  ///< the first of the two
  int seam = -1;
  double relative = 0;
};

/// Of every sewn pair of stretches, in the order of the pieces and their edges.
std::vector<SeamMismatch> seam_mismatches(const Pattern& pattern);

}  // namespace geoprior::sketch
