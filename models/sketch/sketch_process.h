#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/context.h"
#include "core/frame.h"
#include "core/method.h"
#include "core/options.h"
#include "core/state_bytes.h"
#include "models/sketch/drawing/align_views.h"
#include "models/sketch/drawing/drawing.h"
#include "models/sketch/pattern/make_pattern.h"
#include "models/sketch/pattern/pattern.h"
#include "models/sketch/pattern/suggested_seam.h"
#include "models/sketch/surface/sketch_surface.h"
#include "models/sketch/surface/taubin.h"

namespace geoprior::sketch {

/// What methods of several views are given: a drawing, or a surface in its place, and how both are
/// prepared, alike for all of them.
struct SketchInput {
  Drawing drawing;
  std::optional<TriMesh> surface;  ///< instead of a drawing
  AlignOptions align;
  HullOptions hull;
  TaubinOptions smoothing;
  PatternOptions pattern;
  bool patterns = true;  ///< the last frame has the flat pieces
  /// Another hull of the aligned drawing than `visual_hull` with `hull`, to compare with.
  std::function<VisualHull(const Drawing&)> make_hull = {};
  /// Files that are made of the pattern and the surface's points; none when empty.
  std::function<std::vector<Artifact>(const Pattern&, const Eigen::MatrixX3d&)> files = {};
};

/// The surface that methods begin with.
struct PreparedSketch {
  SketchSurface surface;   ///< its mesh: the hull
  Eigen::MatrixX3d start;  ///< n x 3, smoothed
};

/// Views aligned, hull meshed, opened at borders, seams traced, smoothed.
/// @throws Error  naming view and stroke
PreparedSketch prepare_sketch(const SketchInput& input);

/// A method of the topic that improves a surface step by step.
class SketchMethod {
 public:
  virtual ~SketchMethod() = default;
  /// This is what is timed.
  virtual void step(RunContext& context) = 0;
  [[nodiscard]] virtual const Eigen::MatrixX3d& positions() const = 0;
  /// All that `step` depends on, so that a run can go on after a stop. A method that remembers more
  /// than it writes says so, and is begun anew.
  virtual void save(StateWriter& out) const { out.matrix(positions()); }
  virtual void load(StateReader& in) = 0;
  [[nodiscard]] virtual bool can_resume() const { return true; }
  /// What only the method knows of its last step (gaps, residual of pins …).
  virtual void diagnose(std::map<std::string, double>& /*into*/) const {}
  /// Parts of a frame beside those that all methods have.
  virtual void draw(Frame& /*frame*/) const {}
};

using SketchMethodFactory =
    std::function<std::unique_ptr<SketchMethod>(const PreparedSketch&, RunContext&)>;

/// Suggestions of seams and darts for what a method ends with.
struct SeamSuggester {
  /// None: nothing is suggested.
  std::function<std::vector<SuggestedSeam>(const TriMesh&, std::span<const SeamEdge>,
                                           const PatternOptions&)>
      suggest = {};
  int apply = 0;       ///< the first so many are cut, and the method is begun anew from there
  int iterations = 0;  ///< of the method after that
  /// Makes suggested seams fair on the surface that a method ends with, given edges that may slide
  /// and edges that stay; edges between seams may be flipped. The last frame and the pattern have
  /// them.
  std::function<TriMesh(const TriMesh&, std::span<const SeamEdge>, std::span<const SeamEdge>,
                        const PatternOptions&)>
      fair = {};
  /// Files that are made of the suggestions; none when empty.
  std::function<std::vector<Artifact>(const std::vector<SuggestedSeam>&)> files = {};
};

/// One recorded state. Metrics of the topic read these parts and nothing else:
///
/// - "surface" (triangles): point arrays "border", "seam", "fold", "ridge" (0 or 1; the last of
///   corners that were drawn, see `drawn_ridges`);
/// - "strokes" (lines): borders, seams and folds on the surface, cell arrays "kind" (StrokeKind),
///   "view" (ViewKind) and "number" (among the strokes of that kind in that view; both -1 for a
///   border that no stroke asks for);
/// - "pattern" (triangles, z = 0, m), in the last frame: point array "surface_vertex", cell arrays
///   "surface_triangle", "piece" and "stretch";
/// - "gaps" (lines), of several views: stretches of drawn silhouettes that no edge covers;
/// - "drawing" (lines, z = 0), in the last frame: the strokes as they were drawn, cell array
/// "kind";
/// - table "sewn", in the last frame: a row for each vertex of a sewn stretch of the pattern's
///   borders, in their order: stretch, partner stretch, seam, point of "pattern";
/// - "suggestions" (lines), in the last frame where any were asked for and found: cell arrays
/// "rank"
///   (1: the first), "kind" (0: dart, 1: seam), "length" (m, of all lines of that rank) and
///   "share_after" (of the area within the tolerance).
Frame sketch_frame(const PreparedSketch& prepared, const Eigen::MatrixX3d& X, double parameter);

/// Adds the parts of the flat pieces to a frame, and to its surface the cell arrays "piece" and
/// "stretch" (logarithm of the larger singular value, or of the smaller one where that is farther
/// from 0: positive where the surface is longer than the pattern).
void add_pattern(Frame& frame, const MadePattern& made);

/// The lines of suggestions, as a part of a frame.
Part suggestions_part(const std::vector<SuggestedSeam>& suggestions);

/// The drawn seams as edges to be cut, numbered in their order.
std::vector<SeamEdge> seam_edges(const SketchSurface& surface);

/// The loop around a method: frame 0 is the start, every other one a step; the last one has the
/// pattern. With suggestions that are applied, further steps follow on the surface that they have
/// cut; such a run cannot be resumed. Phases: "prepare", "step", "suggest", "flatten", "record".
std::unique_ptr<Process> make_sketch_process(const SketchInput& input, int steps,
                                             SketchMethodFactory factory,
                                             SeamSuggester suggester = {});

}  // namespace geoprior::sketch
