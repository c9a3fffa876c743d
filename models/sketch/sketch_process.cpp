#include "models/sketch/sketch_process.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>

#include "core/frame_loop.h"
#include "core/geometry/topology.h"
#include "models/sketch/drawing/drawing_part.h"
#include "models/sketch/flatten/flat_stretch.h"
#include "models/sketch/pattern/piece_names.h"
#include "models/sketch/ridges/drawn_ridges.h"

namespace geoprior::sketch {
namespace {

NamedArray vertex_flags(const char* name, Eigen::Index count) {
  return {name, "1", NamedArray::On::points, Eigen::MatrixXd::Zero(count, 1)};
}

Part surface_of(const PreparedSketch& prepared, const Eigen::MatrixX3d& X) {
  const SketchSurface& s = prepared.surface;
  Part part;
  part.points = X;
  part.triangles = s.hull.mesh.F;
  NamedArray border = vertex_flags("border", X.rows()), seam = vertex_flags("seam", X.rows()),
             fold = vertex_flags("fold", X.rows()), ridge = vertex_flags("ridge", X.rows());
  for (const Edge& e : boundary_edges(s.hull.mesh.F)) border.values(e[0]) = border.values(e[1]) = 1;
  const auto mark = [](const std::vector<StrokePath>& paths, NamedArray& flags) {
    for (const StrokePath& path : paths) {
      for (const Edge& e : path.edges) flags.values(e[0]) = flags.values(e[1]) = 1;
    }
  };
  mark(s.seams, seam);
  mark(s.folds, fold);
  for (const DrawnRidge& of : drawn_ridges(s.hull))
    ridge.values(of.edge[0]) = ridge.values(of.edge[1]) = 1;
  part.arrays = {std::move(border), std::move(seam), std::move(fold), std::move(ridge)};
  return part;
}

/// Edges of strokes, and what each was drawn as.
class StrokePartBuilder {
 public:
  explicit StrokePartBuilder(const std::vector<OutlinedView>& views) : views_(views) {}

  /// @param view,number  -1, -1: no stroke asked for it
  void add(const Edge& e, StrokeKind kind, int view, int number) {
    part_.lines.push_back({e[0], e[1]});
    kind_.push_back(static_cast<double>(kind));
    view_.push_back(view < 0 ? -1 : static_cast<double>(views_[view].kind));
    number_.push_back(number);
  }

  [[nodiscard]] Part finished(const Eigen::MatrixX3d& X) {
    part_.kind = Part::Kind::lines;
    part_.points = X;
    const auto array = [&](const char* name, const std::vector<double>& values) {
      part_.arrays.push_back({name, "1", NamedArray::On::cells,
                              Eigen::Map<const Eigen::VectorXd>(values.data(), values.size())});
    };
    array("kind", kind_);
    array("view", view_);
    array("number", number_);
    return std::move(part_);
  }

 private:
  const std::vector<OutlinedView>& views_;
  Part part_;
  std::vector<double> kind_, view_, number_;
};

Part strokes_of_surface(const PreparedSketch& prepared, const Eigen::MatrixX3d& X) {
  const SketchSurface& s = prepared.surface;
  StrokePartBuilder strokes(s.hull.views);
  for (const Edge& e : boundary_edges(s.hull.mesh.F)) {
    const int border = s.border_of[e[0]] == s.border_of[e[1]] ? s.border_of[e[0]] : -1;
    const BorderPlace* place = border < 0 ? nullptr : &s.borders[border];
    strokes.add(e, StrokeKind::border, place ? place->view : -1, place ? place->number : -1);
  }
  for (const StrokePath& path : s.seams) {
    for (const Edge& e : path.edges) strokes.add(e, StrokeKind::seam, path.view, path.number);
  }
  for (const StrokePath& path : s.folds) {
    for (const Edge& e : path.edges) strokes.add(e, StrokeKind::fold, path.view, path.number);
  }
  return strokes.finished(X);
}

/// First point of each piece in the part that holds all of them.
std::vector<int> first_points(const Pattern& pattern) {
  std::vector<int> first{0};
  for (const PatternPiece& piece : pattern.pieces)
    first.push_back(first.back() + static_cast<int>(piece.points.rows()));
  return first;
}

Part pattern_part(const Pattern& pattern) {
  const std::vector<int> first = first_points(pattern);
  Eigen::Index triangles = 0;
  for (const PatternPiece& piece : pattern.pieces) triangles += piece.triangles.rows();
  Part part;
  part.points = Eigen::MatrixX3d::Zero(first.back(), 3);
  part.triangles.resize(triangles, 3);
  NamedArray vertex = vertex_flags("surface_vertex", first.back());
  NamedArray of_triangle{"surface_triangle", "1", NamedArray::On::cells,
                         Eigen::MatrixXd(triangles, 1)};
  NamedArray of_piece{"piece", "1", NamedArray::On::cells, Eigen::MatrixXd(triangles, 1)};
  Eigen::Index t = 0;
  for (std::size_t p = 0; p < pattern.pieces.size(); ++p) {
    const PatternPiece& piece = pattern.pieces[p];
    part.points.block(first[p], 0, piece.points.rows(), 2) = piece.points;
    for (Eigen::Index v = 0; v < piece.points.rows(); ++v)
      vertex.values(first[p] + v) = piece.surface_vertex[v];
    for (Eigen::Index i = 0; i < piece.triangles.rows(); ++i, ++t) {
      part.triangles.row(t) = piece.triangles.row(i).array() + first[p];
      of_triangle.values(t) = piece.surface_triangle[i];
      of_piece.values(t) = static_cast<double>(p);
    }
  }
  part.arrays = {std::move(vertex), std::move(of_triangle), std::move(of_piece)};
  return part;
}

FrameTable sewn_table(const Pattern& pattern) {
  const std::vector<int> first = first_points(pattern);
  std::vector<int> first_stretch{0};
  for (const PatternPiece& piece : pattern.pieces)
    first_stretch.push_back(first_stretch.back() + static_cast<int>(piece.edges.size()));
  std::vector<std::array<double, 4>> rows;
  for (std::size_t p = 0; p < pattern.pieces.size(); ++p) {
    const PatternPiece& piece = pattern.pieces[p];
    for (std::size_t e = 0; e < piece.edges.size(); ++e) {
      const PieceEdge& edge = piece.edges[e];
      if (edge.partner_piece < 0) continue;
      for (const int v : edge.vertices) {
        rows.push_back({static_cast<double>(first_stretch[p]) + static_cast<double>(e),
                        static_cast<double>(first_stretch[edge.partner_piece] + edge.partner_edge),
                        static_cast<double>(edge.seam), static_cast<double>(first[p] + v)});
      }
    }
  }
  FrameTable table{{"stretch", "partner", "seam", "point"}, Eigen::MatrixXd(rows.size(), 4)};
  for (std::size_t i = 0; i < rows.size(); ++i)
    table.rows.row(i) = Eigen::Map<Eigen::RowVector4d>(rows[i].data());
  return table;
}

/// What the hull's sections were taken for, and how much of it.
void note_sections(const SectionReport& sections, Frame& frame) {
  int tubes = 0;
  for (const SectionReport::Tubes& of_axis : sections.tubes) tubes += of_axis.count;
  frame.diagnostics["openings"] = sections.openings;
  frame.diagnostics["round_tubes"] = tubes;
  frame.diagnostics["top_sections"] = sections.top_share;
  frame.diagnostics["round_sections"] = sections.round_share;
  frame.diagnostics["box_sections"] = sections.box_share;
}

class SketchFrames final : public FrameModel {
 public:
  SketchFrames(const SketchInput& input, int steps, const SketchMethodFactory& factory,
               const SeamSuggester& suggester, RunContext& context)
      : input_(input), steps_(steps), factory_(factory), suggester_(suggester) {
    const Phase phase(context, "prepare");
    prepared_ = prepare_sketch(input);
    method_ = factory(prepared_, context);
  }

  [[nodiscard]] int frame_count() const override {
    return steps_ + 1 + (suggester_.apply > 0 ? suggester_.iterations : 0);
  }
  void load(StateReader& in, int /*next_frame*/) override { method_->load(in); }
  void save(StateWriter& out) const override { method_->save(out); }
  [[nodiscard]] bool can_resume() const override {
    return suggester_.apply == 0 && method_->can_resume();
  }

  void advance(int frame, FrameSink& /*sink*/, RunContext& context) override {
    if (frame == steps_ + 1) apply_suggestions(context);
    const Phase phase(context, "step");
    method_->step(context);
  }

  void record(int number, FrameSink& sink, RunContext& context) override {
    const bool last = number + 1 == frame_count();
    const Eigen::MatrixX3d X = last ? fair_suggested() : method_->positions();
    Frame frame = sketch_frame(prepared_, X, number);
    if (last && suggester_.suggest) {
      if (suggester_.apply == 0) suggest(context);
      if (!suggestions_.empty()) frame.parts["suggestions"] = suggestions_part(suggestions_);
      if (suggester_.files) {
        for (Artifact& file : suggester_.files(suggestions_)) sink.artifact(std::move(file));
      }
    }
    if (last && input_.patterns) {
      MadePattern made;
      {
        const Phase phase(context, "flatten");
        made = make_pattern({X, prepared_.surface.hull.mesh.F}, seam_edges(prepared_.surface),
                            input_.pattern);
        name_pieces(made.pattern, input_.drawing, prepared_.surface, X);
      }
      add_pattern(frame, made);
      if (input_.files) {
        const Phase phase(context, "record");
        for (Artifact& file : input_.files(made.pattern, X)) sink.artifact(std::move(file));
      }
    }
    const Phase phase(context, "record");
    if (last && !input_.drawing.views.empty())
      frame.parts["drawing"] = drawing_part(input_.drawing);
    if (number == 0 && !input_.surface) note_sections(prepared_.surface.hull.sections, frame);
    method_->diagnose(frame.diagnostics);
    method_->draw(frame);
    sink.frame(std::move(frame));
  }

 private:
  void suggest(RunContext& context) {
    const Phase phase(context, "suggest");
    suggestions_ = suggester_.suggest({method_->positions(), prepared_.surface.hull.mesh.F},
                                      seam_edges(prepared_.surface), input_.pattern);
  }

  /// Makes suggested seams, which were drawn in no view, fair: triangles are those after flips.
  Eigen::MatrixX3d fair_suggested() {
    const std::vector<StrokePath>& seams = prepared_.surface.seams;
    std::vector<SeamEdge> slide, stay;
    for (const SeamEdge& e : seam_edges(prepared_.surface))
      (seams[e.seam].view < 0 ? slide : stay).push_back(e);
    if (!suggester_.fair || slide.empty()) return method_->positions();
    TriMesh fair = suggester_.fair({method_->positions(), prepared_.surface.hull.mesh.F}, slide,
                                   stay, input_.pattern);
    prepared_.surface.hull.mesh.F = std::move(fair.F);
    return std::move(fair.V);
  }

  /// Cuts the first suggestions; the method begins anew on what they leave.
  void apply_suggestions(RunContext& context) {
    suggest(context);
    prepared_.start = method_->positions();
    method_.reset();
    const std::size_t count = suggester_.apply;
    const std::size_t applied = std::min(count, suggestions_.size());
    for (std::size_t i = 0; i < applied; ++i) {
      add_seam(prepared_.surface, prepared_.start, {suggestions_[i].cut},
               "suggestion-" + std::to_string(i + 1));
    }
    if (applied > 0 && !suggestions_[applied - 1].openings.empty()) {
      add_seam(prepared_.surface, prepared_.start, suggestions_[applied - 1].openings, "opening");
    }
    method_ = factory_(prepared_, context);
  }

  // Of the process, which outlives its model.
  const SketchInput& input_;
  int steps_;
  const SketchMethodFactory& factory_;
  const SeamSuggester& suggester_;
  PreparedSketch prepared_;
  std::vector<SuggestedSeam> suggestions_;
  std::unique_ptr<SketchMethod> method_;
};

}  // namespace

PreparedSketch prepare_sketch(const SketchInput& input) {
  PreparedSketch prepared;
  if (input.surface) {
    prepared.surface.hull.mesh = *input.surface;
    prepared.surface.border_of.assign(input.surface->V.rows(), -1);
    prepared.start = input.surface->V;
    return prepared;
  }
  const Drawing aligned = align_views(input.drawing, input.align);
  prepared.surface = sketch_surface(
      aligned, input.make_hull ? input.make_hull(aligned) : visual_hull(aligned, input.hull));
  prepared.start = taubin_smoothed(prepared.surface.hull.mesh, input.smoothing,
                                   edges_of(drawn_ridges(prepared.surface.hull)));
  return prepared;
}

Part suggestions_part(const std::vector<SuggestedSeam>& suggestions) {
  Part part;
  part.kind = Part::Kind::lines;
  Eigen::Index points = 0, lines = 0;
  for (const SuggestedSeam& seam : suggestions) {
    lines += seam.lines.points.size();
    for (const Eigen::MatrixX3d& line : seam.lines.points) points += line.rows();
  }
  part.points.resize(points, 3);
  const auto cells = [&](const char* name, const char* unit) {
    return NamedArray{name, unit, NamedArray::On::cells, Eigen::MatrixXd(lines, 1)};
  };
  NamedArray rank = cells("rank", "1"), kind = cells("kind", "1"), length = cells("length", "m"),
             share = cells("share_after", "1");
  Eigen::Index next = 0, row = 0;
  for (std::size_t i = 0; i < suggestions.size(); ++i) {
    for (const Eigen::MatrixX3d& line : suggestions[i].lines.points) {
      part.points.middleRows(next, line.rows()) = line;
      std::vector<int>& numbers = part.lines.emplace_back(static_cast<std::size_t>(line.rows()));
      std::iota(numbers.begin(), numbers.end(), static_cast<int>(next));
      next += line.rows();
      rank.values(row) = static_cast<double>(i + 1);
      kind.values(row) = suggestions[i].is_dart ? 0 : 1;
      length.values(row) = suggestions[i].lines.length;
      share.values(row++) = suggestions[i].share_after;
    }
  }
  part.arrays = {std::move(rank), std::move(kind), std::move(length), std::move(share)};
  return part;
}

std::vector<SeamEdge> seam_edges(const SketchSurface& surface) {
  std::vector<SeamEdge> edges;
  for (int s = 0; s < std::ssize(surface.seams); ++s) {
    for (const Edge& e : surface.seams[s].edges) edges.push_back({e, s});
  }
  return edges;
}

Frame sketch_frame(const PreparedSketch& prepared, const Eigen::MatrixX3d& X, double parameter) {
  Frame frame;
  frame.parameter = parameter;
  frame.parts["surface"] = surface_of(prepared, X);
  Part strokes = strokes_of_surface(prepared, X);
  if (!strokes.lines.empty()) frame.parts["strokes"] = std::move(strokes);
  return frame;
}

void add_pattern(Frame& frame, const MadePattern& made) {
  Part pattern = pattern_part(made.pattern);
  Part& surface = frame.parts.at("surface");
  NamedArray piece{"piece", "1", NamedArray::On::cells,
                   Eigen::MatrixXd::Constant(surface.triangles.rows(), 1, -1)};
  NamedArray stretch{"stretch", "1", NamedArray::On::cells,
                     Eigen::MatrixXd::Zero(surface.triangles.rows(), 1)};
  NamedArray flat_stretch{"stretch", "1", NamedArray::On::cells,
                          Eigen::MatrixXd::Zero(pattern.triangles.rows(), 1)};
  const NamedArray& of = *pattern.find_array("surface_triangle");
  const NamedArray& pieces = *pattern.find_array("piece");
  for (Eigen::Index t = 0; t < pattern.triangles.rows(); ++t) {
    const auto s = static_cast<Eigen::Index>(of.values(t));
    const auto edges = [](const Part& part, Eigen::Index triangle) {
      const Eigen::RowVector3d a = part.points.row(part.triangles(triangle, 0));
      Eigen::Matrix<double, 3, 2> e;
      e.col(0) = (part.points.row(part.triangles(triangle, 1)) - a).transpose();
      e.col(1) = (part.points.row(part.triangles(triangle, 2)) - a).transpose();
      return e;
    };
    piece.values(s) = pieces.values(t);
    stretch.values(s) = flat_stretch.values(t) = log_stretch(edges(pattern, t), edges(surface, s));
  }
  surface.arrays.push_back(std::move(piece));
  surface.arrays.push_back(std::move(stretch));
  pattern.arrays.push_back(std::move(flat_stretch));
  frame.tables["sewn"] = sewn_table(made.pattern);
  frame.parts["pattern"] = std::move(pattern);
}

std::unique_ptr<Process> make_sketch_process(const SketchInput& input, int steps,
                                             SketchMethodFactory factory, SeamSuggester suggester) {
  return frame_process([input, steps, factory = std::move(factory),
                        suggester = std::move(suggester)](RunContext& context) {
    return std::make_unique<SketchFrames>(input, steps, factory, suggester, context);
  });
}

}  // namespace geoprior::sketch
