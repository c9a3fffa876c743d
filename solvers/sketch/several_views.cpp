#include "solvers/sketch/several_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "core/connectivity.h"
#include "models/sketch/drawing/polyline.h"
#include "models/sketch/ridges/drawn_ridges.h"
#include "solvers/sketch/pattern/slide_seams.h"
#include "solvers/sketch/surface/pinned_transfer.h"
#include "solvers/sketch/surface/silhouette_stops.h"

namespace geoprior::sketch {
namespace {

constexpr std::array<std::string_view, 2> kOrders{"merged", "alternating"};
constexpr std::array<std::string_view, 2> kSilhouetteChoices{"protruding", "planar"};

/// Puts a vertex onto a stroke of its view along the coordinate that crosses the stroke more
/// squarely; along the stroke it is free.
void pin_across(const std::vector<Eigen::Vector2d>& stroke, const OutlinedView& view, int vertex,
                const Eigen::MatrixX3d& X, CoordinatePins& pins) {
  const Eigen::Vector2d q = view.project(X.row(vertex).transpose());
  const BesideStroke at = beside(stroke, q);
  const Eigen::Vector2d normal(-at.direction.y(), at.direction.x());
  const int k = std::abs(normal.x()) >= std::abs(normal.y()) ? 0 : 1;
  const Eigen::Vector2d nearest = point_along(stroke, at.along);
  const double value = nearest[k] - normal[1 - k] / normal[k] * (q[1 - k] - nearest[1 - k]);
  const ViewAxis along = view_axis(view.frame, k);
  pins.set(vertex, along.axis, along.sign * value);
}

/// A surface's mesh with vertices of their own on the two sides of every cut.
struct SeveredMesh {
  Eigen::MatrixX3i F;               ///< in the order of the surface's triangles
  std::vector<int> surface_vertex;  ///< of each vertex
};

SeveredMesh severed(const SketchSurface& surface, const std::vector<SeamEdge>& cuts) {
  const TriMesh& mesh = surface.hull.mesh;
  SeveredMesh cut{Eigen::MatrixX3i(mesh.F.rows(), 3), {}};
  int first = 0;
  for (const CutPiece& piece : cut_surface(mesh, cuts)) {
    first = static_cast<int>(cut.surface_vertex.size());
    for (int t = 0; t < piece.mesh.triangle_count(); ++t)
      cut.F.row(piece.surface_triangle[t]) = piece.mesh.F.row(t).array() + first;
    cut.surface_vertex.resize(first + piece.mesh.vertex_count());
    for (int t = 0; t < piece.mesh.triangle_count(); ++t) {
      for (int k = 0; k < 3; ++k)
        cut.surface_vertex[first + piece.mesh.F(t, k)] = mesh.F(piece.surface_triangle[t], k);
    }
  }
  return cut;
}

/// Ridges that were drawn as corners, and seams where they are asked for.
std::vector<SeamEdge> creases_of(const SketchSurface& surface, bool seams) {
  std::vector<SeamEdge> creases;
  if (seams) creases = seam_edges(surface);
  for (const DrawnRidge& ridge : drawn_ridges(surface.hull)) creases.push_back({ridge.edge, 0});
  return creases;
}

DevelopableRotation rotation_of(const SketchSurface& surface, const SeveralViewsOptions& options) {
  const SeveredMesh cut = severed(surface, creases_of(surface, !options.across_seams));
  return {cut.F, static_cast<int>(cut.surface_vertex.size()), options.developability};
}

SketchInput without_seams(SketchInput input) {
  for (View& view : input.drawing.views) {
    std::erase_if(view.strokes, [](const Stroke& s) { return s.kind == StrokeKind::seam; });
  }
  return input;
}

class SeveralViews final : public SketchMethod {
 public:
  SeveralViews(const PreparedSketch& prepared, const SeveralViewsOptions& options)
      : surface_(prepared.surface),
        options_(options),
        ridges_(drawn_ridges(surface_.hull)),
        X_(prepared.start),
        severed_(severed(surface_, creases_of(surface_, true))),
        rotation_(rotation_of(surface_, options)),
        average_(on_both_sides(prepared.start), severed_.F, options.fairing),
        faired_(static_cast<int>(options.fairing.share * iterations_of(prepared, options))),
        fold_(surface_, options.fold),
        transfer_(surface_.hull.mesh.F, surface_.hull.mesh.vertex_count()) {
    const EdgeConnectivity edges(surface_.hull.mesh.F);
    for (std::size_t v = 0; v < surface_.hull.views.size(); ++v) {
      zippering_.emplace_back(surface_.hull.views[v], surface_.hull.places[v], edges.edges(),
                              options.silhouette);
      stops_.emplace_back(surface_.hull, v);
    }
  }

  void step(RunContext& context) override {
    CoordinatePins pins(static_cast<int>(X_.rows()));
    {
      const Phase phase(context, "silhouettes");
      pin_strokes(pins);
    }
    if (options_.order == StepOrder::alternating) {
      const Phase phase(context, "transfer");
      const std::vector<Eigen::Matrix3d> unturned(surface_.hull.mesh.F.rows(),
                                                  Eigen::Matrix3d::Identity());
      X_ = transfer_.solve(X_, unturned, pins);
    }
    std::vector<Eigen::Matrix3d> rotations;
    {
      const Phase phase(context, "rotations");
      const Eigen::MatrixX3d normals = triangle_normals({X_, surface_.hull.mesh.F});
      rotations =
          steps_ < faired_ ? average_.rotations(on_both_sides(X_)) : rotation_.rotations(normals);
      if (options_.folds) fold_.blend(X_, normals, rotations);
    }
    const Phase phase(context, "transfer");
    X_ = transfer_.solve(X_, rotations, pins);
    ++steps_;
  }

  [[nodiscard]] const Eigen::MatrixX3d& positions() const override { return X_; }
  void save(StateWriter& out) const override {
    out.matrix(X_);
    out.number(steps_);
    for (const SilhouetteStops& stops : stops_) stops.save(out);
  }
  void load(StateReader& in) override {
    in.matrix(X_);
    steps_ = in.number<int>();
    for (SilhouetteStops& stops : stops_) stops.load(in);
  }

  void diagnose(std::map<std::string, double>& into) const override {
    into["silhouette_edges"] = edges_;
    into["gaps"] = static_cast<double>(gaps_.size());
    double length = 0;
    for (const auto& [view, gap] : gaps_) length += gap.to - gap.from;
    into["gap_length"] = length;
  }

  /// Part "gaps" (lines): stretches of silhouettes that no edge covers, as drawn, at the side of
  /// the surface that is nearest to the eye of their view.
  void draw(Frame& frame) const override {
    if (gaps_.empty()) return;
    constexpr int kChords = 8;
    Part part;
    part.kind = Part::Kind::lines;
    part.points.resize(std::ssize(gaps_) * (kChords + 1), 3);
    int next = 0;
    for (const auto& [number, gap] : gaps_) {
      const OutlinedView& view = surface_.hull.views[number];
      const double nearest = (X_ * view.frame.row(2).transpose()).maxCoeff();
      std::vector<int>& line = part.lines.emplace_back();
      for (int i = 0; i <= kChords; ++i) {
        const double along = gap.from + (gap.to - gap.from) * i / kChords;
        const Eigen::Vector2d at = view.outline.at(std::fmod(along, view.outline.length()));
        part.points.row(next) = Eigen::RowVector3d(at.x(), at.y(), nearest) * view.frame;
        line.push_back(next++);
      }
    }
    frame.parts["gaps"] = std::move(part);
  }

 private:
  /// Iterations that the method is to make on a surface: other ones once suggestions were cut.
  static int iterations_of(const PreparedSketch& prepared, const SeveralViewsOptions& options) {
    const bool cut = std::any_of(prepared.surface.seams.begin(), prepared.surface.seams.end(),
                                 [](const StrokePath& seam) { return seam.points.empty(); });
    return cut && options.suggest ? options.suggest->iterations : options.iterations;
  }

  /// Positions of the vertices of the severed mesh.
  [[nodiscard]] Eigen::MatrixX3d on_both_sides(const Eigen::MatrixX3d& X) const {
    Eigen::MatrixX3d both(severed_.surface_vertex.size(), 3);
    for (Eigen::Index v = 0; v < both.rows(); ++v) both.row(v) = X.row(severed_.surface_vertex[v]);
    return both;
  }

  void pin_strokes(CoordinatePins& pins) {
    edges_ = 0;
    gaps_.clear();
    if (options_.pin_seams) {
      for (const StrokePath& seam : surface_.seams) {
        if (seam.points.empty()) continue;  // suggested, not drawn
        for (const Edge& edge : seam.edges) {
          for (const int v : edge)
            pin_across(seam.points, surface_.hull.views[seam.view], v, X_, pins);
        }
      }
    }
    for (int v = 0; v < std::ssize(surface_.border_of); ++v) {
      if (surface_.border_of[v] < 0) continue;
      const BorderPlace& border = surface_.borders[surface_.border_of[v]];
      pin_across(border.points, surface_.hull.views[border.view], v, X_, pins);
    }
    if (options_.silhouettes) pin_silhouettes(pins);
  }

  /// Vertices of a flat side that lies on a silhouette stay inside by zippering, which chooses
  /// those that protrude; where a round one only touches it, folds beside may go out through it.
  void pin_silhouettes(CoordinatePins& pins) {
    pin_ridges(pins);
    // What smoothing and the first iterations bring outside comes in by itself.
    for (SilhouetteStops& stops : stops_)
      if (steps_ > 1 && options_.silhouette == SilhouetteChoice::protruding) stops.hold(X_, pins);
    for (std::size_t view = 0; view < zippering_.size(); ++view) {
      const ZippedSilhouette zipped = zippering_[view].close(surface_.hull.mesh.V, X_);
      edges_ += static_cast<int>(zipped.edges.size());
      for (const CoverageGap& gap : zipped.gaps) gaps_.emplace_back(view, gap);
      for (const Edge& edge : zipped.edges) {
        for (const int v : edge) {
          for (int k = 0; k < 2; ++k) {
            const int axis = view_axis(surface_.hull.views[view].frame, k).axis;
            pins.set(v, axis, surface_.hull.mesh.V(v, axis));
          }
        }
      }
    }
  }

  /// Ridges that were drawn stay on the corners of their view and slide along their depth.
  void pin_ridges(CoordinatePins& pins) const {
    for (const DrawnRidge& ridge : ridges_) {
      const Eigen::Matrix3d& frame = surface_.hull.views[ridge.view].frame;
      for (const int v : ridge.edge) {
        for (int k = 0; k < 2; ++k) {
          const int axis = view_axis(frame, k).axis;
          pins.set(v, axis, surface_.hull.mesh.V(v, axis));
        }
      }
    }
  }

  const SketchSurface& surface_;
  SeveralViewsOptions options_;
  std::vector<DrawnRidge> ridges_;
  Eigen::MatrixX3d X_;
  std::vector<Zippering> zippering_;
  std::vector<SilhouetteStops> stops_;  ///< of the views, too
  SeveredMesh severed_;
  DevelopableRotation rotation_;
  RulingAverage average_;
  int faired_;     ///< steps that average, the first ones
  int steps_ = 0;  ///< that were made
  FoldRotation fold_;
  PinnedTransfer transfer_;
  int edges_ = 0;
  std::vector<std::pair<std::size_t, CoverageGap>> gaps_;  ///< and the view of each
};

}  // namespace

void describe(OptionVisitor& v, SuggestedSeamsOptions& o) {
  describe(v, o.find);
  v.value(
      "apply", o.apply,
      {.doc = "number of suggestions that are cut before iterations go on", .min = 0, .max = 100});
  v.value("iterations", o.iterations,
          {.doc = "iterations after suggestions were cut", .min = 1, .max = 1000});
}

void describe(OptionVisitor& v, SeveralViewsOptions& o) {
  v.value("iterations", o.iterations,
          {.doc = "number of steps; a frame each", .min = 1, .max = 1000});
  describe_choice(v, "order", o.order, kOrders,
                  {.doc = "how silhouettes and developability follow each other"});
  describe_group(v, "fairing", o.fairing,
                 {.doc = "averages of normals along rulings, in the first iterations"});
  describe_group(v, "developability", o.developability, {.doc = "what triangles are turned to"});
  describe_group(v, "fold", o.fold, {.doc = "what drawn folds ask of the surface"});
  v.value("silhouettes", o.silhouettes, {.doc = "whether silhouettes are pulled onto the drawing"});
  describe_choice(v, "silhouette", o.silhouette, kSilhouetteChoices,
                  {.doc = "which edges carry a silhouette: those that protrude most, or those "
                          "nearest to one plane"});
  v.value("folds", o.folds, {.doc = "whether drawn folds are asked for"});
  v.value("pin_seams", o.pin_seams,
          {.doc = "whether seams stay where they were drawn, in their view"});
  v.value("across_seams", o.across_seams,
          {.doc = "whether cones are fitted to triangles on both sides of a seam"});
  v.value("drawn_seams", o.drawn_seams, {.doc = "whether seams of the drawing are there"});
  describe_group(v, "suggest", o.suggest,
                 {.doc = "seams and darts that are suggested for the surface of the end"});
}

std::unique_ptr<SketchMethod> make_several_views(const PreparedSketch& prepared,
                                                 const SeveralViewsOptions& options) {
  return std::make_unique<SeveralViews>(prepared, options);
}

std::unique_ptr<Process> make_several_views_process(
    const SketchInput& input, const SeveralViewsOptions& options,
    std::function<std::vector<Artifact>(const std::vector<SuggestedSeam>&)> suggestion_files) {
  SeamSuggester suggester;
  if (options.suggest) {
    suggester.suggest = [find = options.suggest->find](const TriMesh& surface,
                                                       std::span<const SeamEdge> seams,
                                                       const PatternOptions& pattern) {
      return suggest_seams(surface, seams, find, pattern);
    };
    suggester.apply = options.suggest->apply;
    suggester.iterations = options.suggest->iterations;
    if (options.suggest->find.fair) {
      suggester.fair =
          [limits = SlideLimits{options.suggest->find.tolerance, options.suggest->find.share}](
              const TriMesh& surface, std::span<const SeamEdge> slide,
              std::span<const SeamEdge> stay, const PatternOptions& pattern) {
            return slide_seams(surface, slide, stay, limits, pattern);
          };
    }
    suggester.files = std::move(suggestion_files);
  }
  return make_sketch_process(
      options.drawn_seams ? input : without_seams(input), options.iterations,
      [options](const PreparedSketch& prepared, RunContext&) {
        return make_several_views(prepared, options);
      },
      std::move(suggester));
}

}  // namespace geoprior::sketch
