#include "models/sketch/surface/sketch_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "models/sketch/drawing/polyline.h"
#include "models/sketch/drawing/traced_stroke.h"
#include "models/sketch/surface/cut_surface.h"
#include "models/sketch/surface/split.h"

namespace geoprior::sketch {
namespace {

std::vector<Eigen::Vector2d> polyline_of(const Stroke& stroke) {
  std::vector<Eigen::Vector2d> points = stroke.points;
  if (stroke.closed) points.push_back(points.front());
  return points;
}

std::string stroke_place(const Drawing& drawing, ViewKind view, const std::string& stroke) {
  return drawing.name + ", view " + view_name(view) + ", stroke '" + stroke + "'";
}

/// Whether the vertex lies where the border stroke was drawn: on the silhouette, or for one inside
/// of it as near as a path of edges follows its stroke.
bool lies_on_border(const SketchSurface& s, int vertex, const BorderPlace& border) {
  if (!border.inside && !s.hull.places[border.view][vertex]) return false;
  const Eigen::Vector2d q =
      s.hull.views[border.view].project(s.hull.mesh.V.row(vertex).transpose());
  const BesideStroke at = beside(border.points, q);
  const double near = (border.inside ? 0.5 : 0.1) * s.hull.spacing;
  return std::abs(at.distance) < near && at.along > -near &&
         at.along < length(border.points) + near;
}

/// Whether most of a stroke runs along the view's silhouette.
bool runs_along(const std::vector<Eigen::Vector2d>& stroke, const Outline& outline, double near) {
  constexpr int kSamples = 64;
  const double whole = length(stroke);
  int off = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector2d at = point_along(stroke, whole * (i + 0.5) / kSamples);
    if (std::abs(outline.nearest(at).distance) > near) ++off;
  }
  return off < kSamples / 5;
}

/// Takes out triangles, and vertices that none is left of.
void remove_triangles(SketchSurface& s, const std::vector<char>& removed) {
  TriMesh& mesh = s.hull.mesh;
  std::vector<int> renamed(mesh.V.rows(), -1);
  Eigen::Index kept = 0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    if (removed[t]) continue;
    mesh.F.row(kept++) = mesh.F.row(t);
    for (int k = 0; k < 3; ++k) renamed[mesh.F(t, k)] = 0;
  }
  mesh.F.conservativeResize(kept, 3);
  int next = 0;
  for (std::size_t v = 0; v < renamed.size(); ++v) {
    if (renamed[v] < 0) continue;
    mesh.V.row(next) = mesh.V.row(v);
    for (auto& places : s.hull.places) places[next] = places[v];
    renamed[v] = next++;
  }
  mesh.V.conservativeResize(next, 3);
  for (auto& places : s.hull.places) places.resize(next);
  mesh.F = mesh.F.unaryExpr([&](int v) { return renamed[v]; });
}

/// Opens the hull where borders were drawn: triangles all of whose corners lie on borders close an
/// opening that the drawing leaves.
void open_borders(SketchSurface& s, const Drawing& drawing) {
  for (int view = 0; view < std::ssize(s.hull.views); ++view) {
    const View& drawn = *drawing.find(s.hull.views[view].kind);
    int number = 0;
    for (const Stroke* stroke : strokes_of(drawn, StrokeKind::border)) {
      if (!stroke->inside) s.borders.push_back({stroke->id, view, polyline_of(*stroke), number});
      ++number;
    }
  }
  TriMesh& mesh = s.hull.mesh;
  std::vector<char> on(mesh.V.rows(), 0);
  for (const BorderPlace& border : s.borders) {
    bool met = false;
    for (int v = 0; v < mesh.V.rows(); ++v) {
      if (!lies_on_border(s, v, border)) continue;
      on[v] = 1;
      met = true;
    }
    if (!met || !runs_along(border.points, s.hull.views[border.view].outline, s.hull.spacing)) {
      const ViewKind kind = s.hull.views[border.view].kind;
      throw Error("is not drawn along the silhouette", stroke_place(drawing, kind, border.id),
                  "a border on the silhouette, where the surface is open");
    }
  }
  std::vector<char> removed(mesh.F.rows(), 0);
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t)
    removed[t] = static_cast<char>(on[mesh.F(t, 0)] && on[mesh.F(t, 1)] && on[mesh.F(t, 2)]);
  remove_triangles(s, removed);
}

/// Of each vertex, whether it is on the border of the surface.
std::vector<char> border_vertices(const TriMesh& mesh) {
  std::vector<char> on(mesh.V.rows(), 0);
  for (const Edge& e : boundary_edges(mesh.F)) on[e[0]] = on[e[1]] = 1;
  return on;
}

/// Loose ends of a path: cut back to the border or the other path that they have just passed, or to
/// the end of the stroke where they have met none. A path that closes on itself has no loose ends.
void trim_ends(StrokePath& path, const OutlinedView& view, const TriMesh& mesh,
               const std::vector<char>& meets, double reach) {
  std::map<int, std::vector<int>> next;
  for (const Edge& e : path.edges) {
    next[e[0]].push_back(e[1]);
    next[e[1]].push_back(e[0]);
  }
  const double whole = length(path.points);
  const auto is_beyond = [&](int v) {
    const double along = beside(path.points, view.project(mesh.V.row(v).transpose())).along;
    return along < 0 || along > whole;
  };
  std::set<Edge> dropped;
  for (const auto& [end, neighbours] : next) {
    if (neighbours.size() != 1 || meets[end]) continue;
    std::vector<Edge> walked;
    int before = end, at = neighbours[0];
    double way = (mesh.V.row(end) - mesh.V.row(at)).norm();
    walked.push_back({std::min(end, at), std::max(end, at)});
    while (!meets[at] && next[at].size() == 2 && way < 2 * reach) {
      const int after = next[at][0] == before ? next[at][1] : next[at][0];
      way += (mesh.V.row(at) - mesh.V.row(after)).norm();
      walked.push_back({std::min(at, after), std::max(at, after)});
      before = std::exchange(at, after);
    }
    for (const Edge& e : walked) {
      if (meets[at] || (is_beyond(e[0]) && is_beyond(e[1]))) dropped.insert(e);
    }
  }
  std::erase_if(path.edges, [&](const Edge& e) { return dropped.contains(e); });
}

/// A stroke on the surface, which is split along it.
StrokePath traced_path(SketchSurface& s, const Drawing& drawing, int view, StrokeKind kind,
                       int number, double reach, const std::vector<std::vector<Edge>*>& kept) {
  const OutlinedView& seen = s.hull.views[view];
  const Stroke& stroke = *strokes_of(*drawing.find(seen.kind), kind)[number];
  StrokePath path;
  path.id = stroke.id;
  path.view = view;
  path.number = number;
  path.points = polyline_of(stroke);
  path.closed = stroke.closed;
  path.side = stroke.side;
  path.fold_angle_deg = stroke.fold_angle_deg;
  path.fold_width = stroke.fold_width;
  path.fold_side = stroke.fold_side;
  TracedStroke traced = trace_stroke(path.points, stroke.side, seen, reach, s.hull.mesh, kept);
  path.edges = std::move(traced.edges);
  path.missed = traced.missed;
  if (path.edges.empty() || path.missed > 0.2) {
    throw Error(
        "leaves the surface: " + std::to_string(static_cast<int>(std::lround(100 * path.missed))) +
            " % of it lie beside no triangle that faces the view",
        stroke_place(drawing, seen.kind, stroke.id), "inside the silhouette");
  }
  return path;
}

/// The place of a vertex that was put on an edge of the hull: on a silhouette where both ends are.
void place_vertex(SketchSurface& s, int v) {
  for (std::size_t view = 0; view < s.hull.views.size(); ++view) {
    const OutlinedView& seen = s.hull.views[view];
    const Outline::Nearest nearest =
        seen.outline.nearest(seen.project(s.hull.mesh.V.row(v).transpose()));
    std::optional<SilhouettePlace>& place = s.hull.places[view][v];
    place.reset();
    if (std::abs(nearest.distance) < 0.05 * s.hull.spacing)
      place = SilhouettePlace{nearest.arc_length, nearest.normal};
  }
}

void place_new_vertices(SketchSurface& s) {
  if (s.hull.places.empty()) return;
  const int count = s.hull.mesh.vertex_count();
  const int first_new = static_cast<int>(s.hull.places.front().size());
  for (auto& places : s.hull.places) places.resize(count);
  for (int v = first_new; v < count; ++v) place_vertex(s, v);
}

/// Gives the two sides of a path vertices of their own.
void slit_along(SketchSurface& s, const StrokePath& path) {
  std::vector<SeamEdge> cut;
  for (const Edge& e : path.edges) cut.push_back({e, 0});
  const std::vector<CutPiece> pieces = cut_surface(s.hull.mesh, cut);
  TriMesh open;
  auto places = s.hull.places;
  for (auto& of_view : places) of_view.clear();
  for (const CutPiece& piece : pieces) {
    const Eigen::Index v = open.V.rows(), t = open.F.rows();
    open.V.conservativeResize(v + piece.mesh.V.rows(), 3);
    open.V.bottomRows(piece.mesh.V.rows()) = piece.mesh.V;
    open.F.conservativeResize(t + piece.mesh.F.rows(), 3);
    open.F.bottomRows(piece.mesh.F.rows()) = piece.mesh.F.array() + static_cast<int>(v);
    for (std::size_t view = 0; view < places.size(); ++view) {
      for (const int old : piece.surface_vertex) places[view].push_back(s.hull.places[view][old]);
    }
  }
  s.hull.mesh = std::move(open);
  s.hull.places = std::move(places);
}

/// Takes out the triangles within a closed stroke that face its side.
void remove_within(SketchSurface& s, const StrokePath& path) {
  const OutlinedView& view = s.hull.views[path.view];
  const Outline hole({path.points.begin(), path.points.end() - 1});
  const Eigen::MatrixX3d normals = triangle_normals(s.hull.mesh);
  const double sign = path.side == DepthSide::back ? -1 : 1;
  std::vector<char> removed(s.hull.mesh.F.rows(), 0);
  for (Eigen::Index t = 0; t < s.hull.mesh.F.rows(); ++t) {
    Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
    for (int k = 0; k < 3; ++k) middle += s.hull.mesh.V.row(s.hull.mesh.F(t, k)) / 3;
    const bool faces =
        path.side == DepthSide::both || sign * normals.row(t).dot(view.frame.row(2)) > 0;
    removed[t] = faces && hole.nearest(view.project(middle.transpose())).distance < 0 ? 1 : 0;
  }
  remove_triangles(s, removed);
}

int stroke_count(const SketchSurface& s, const Drawing& drawing, int view, StrokeKind kind) {
  return static_cast<int>(strokes_of(*drawing.find(s.hull.views[view].kind), kind).size());
}

/// Slits and holes: borders drawn inside of the silhouette.
void open_inside(SketchSurface& s, const Drawing& drawing, double reach) {
  for (int view = 0; view < std::ssize(s.hull.views); ++view) {
    const OutlinedView& seen = s.hull.views[view];
    for (int i = 0; i < stroke_count(s, drawing, view, StrokeKind::border); ++i) {
      if (!strokes_of(*drawing.find(seen.kind), StrokeKind::border)[i]->inside) continue;
      StrokePath path = traced_path(s, drawing, view, StrokeKind::border, i, reach, {});
      place_new_vertices(s);
      if (path.closed) {
        remove_within(s, path);
      } else {
        trim_ends(path, seen, s.hull.mesh, border_vertices(s.hull.mesh), reach);
        slit_along(s, path);
      }
      s.borders.push_back({path.id, view, path.points, i, true});
    }
  }
}

/// Puts the strokes of one kind onto the surface; paths that are there are split along with it.
void trace_strokes(SketchSurface& s, const Drawing& drawing, StrokeKind kind, double reach) {
  std::vector<StrokePath>& paths = kind == StrokeKind::seam ? s.seams : s.folds;
  for (int view = 0; view < std::ssize(s.hull.views); ++view) {
    for (int i = 0; i < stroke_count(s, drawing, view, kind); ++i) {
      std::vector<std::vector<Edge>*> kept;
      for (StrokePath& path : s.seams) kept.push_back(&path.edges);
      for (StrokePath& path : s.folds) kept.push_back(&path.edges);
      paths.push_back(traced_path(s, drawing, view, kind, i, reach, kept));
    }
  }
}

/// Cuts the ends of paths where they meet borders and other seams, once all are there.
void trim_strokes(SketchSurface& s, double reach) {
  const auto trim = [&](StrokePath& path) {
    if (path.closed) return;
    std::vector<char> meets = border_vertices(s.hull.mesh);
    for (const StrokePath& other : s.seams) {
      if (&other == &path) continue;
      for (const Edge& e : other.edges) meets[e[0]] = meets[e[1]] = 1;
    }
    trim_ends(path, s.hull.views[path.view], s.hull.mesh, meets, reach);
  };
  for (StrokePath& path : s.seams) trim(path);
  for (StrokePath& path : s.folds) trim(path);
}

/// Which drawn border each vertex of the surface's border lies on.
void assign_borders(SketchSurface& s) {
  const Eigen::MatrixX3d& V = s.hull.mesh.V;
  s.border_of.assign(V.rows(), -1);
  for (const Edge& e : boundary_edges(s.hull.mesh.F)) {
    for (const int v : e) {
      for (std::size_t b = 0; b < s.borders.size() && s.border_of[v] < 0; ++b) {
        if (lies_on_border(s, v, s.borders[b])) s.border_of[v] = static_cast<int>(b);
      }
    }
  }
}

}  // namespace

void add_seam(SketchSurface& surface, Eigen::MatrixX3d& X,
              const std::vector<std::vector<SurfacePath>>& cuts, const std::string& id) {
  StrokePath seam;
  seam.id = id;
  seam.view = seam.number = -1;
  for (const std::vector<SurfacePath>& paths : cuts) {
    std::vector<Edge> kept = seam.edges;
    for (const auto* paths_so_far : {&surface.seams, &surface.folds}) {
      for (const StrokePath& path : *paths_so_far)
        kept.insert(kept.end(), path.edges.begin(), path.edges.end());
    }
    const std::optional<SurfaceSplit> split = split_along(surface.hull.mesh, paths, kept);
    if (!split) throw Error("cannot be cut into the triangles of the surface", "seam '" + id + "'");
    const int first_new = surface.hull.mesh.vertex_count();
    for (StrokePath& path : surface.seams) path.edges = split->split_edges(path.edges, first_new);
    for (StrokePath& path : surface.folds) path.edges = split->split_edges(path.edges, first_new);
    seam.edges = split->split_edges(seam.edges, first_new);
    surface.hull.mesh.V = split->interpolated(surface.hull.mesh.V);
    X = split->interpolated(X);
    surface.hull.mesh.F = split->triangles;
    place_new_vertices(surface);
    for (const auto& [v, crossing] : split->moved) place_vertex(surface, v);
    seam.edges.insert(seam.edges.end(), split->path.begin(), split->path.end());
  }
  std::sort(seam.edges.begin(), seam.edges.end());
  surface.seams.push_back(std::move(seam));
  assign_borders(surface);
}

SketchSurface sketch_surface(const Drawing& aligned, VisualHull hull) {
  SketchSurface surface;
  surface.hull = std::move(hull);
  open_borders(surface, aligned);
  const double reach = 1.5 * surface.hull.spacing;
  open_inside(surface, aligned, reach);
  trace_strokes(surface, aligned, StrokeKind::seam, reach);
  trace_strokes(surface, aligned, StrokeKind::fold, reach);
  trim_strokes(surface, reach);
  place_new_vertices(surface);
  assign_borders(surface);
  return surface;
}

}  // namespace geoprior::sketch
