#include "solvers/sketch/pattern/cut_trial.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "core/angles.h"
#include "core/connectivity.h"
#include "core/error.h"
#include "core/parallel.h"
#include "models/sketch/flatten/flat_stretch.h"
#include "models/sketch/flatten/flatten.h"
#include "models/sketch/surface/shortest_cut.h"

namespace geoprior::sketch {
namespace {

constexpr int kTrialIterations = 60;
constexpr double kTrialTolerance = 1e-6;

FlatMeasure measured(const TriMesh& part, const TrialOptions& options) {
  const Flattening flat = flatten(part, options.pattern.flatten);
  FlatMeasure measure;
  measure.sound = flat.report.flipped.empty() && flat.report.overlaps.empty();
  const double bound = std::log1p(options.tolerance);
  for (int t = 0; t < part.triangle_count(); ++t) {
    Eigen::Matrix<double, 3, 2> on_surface, in_plane = Eigen::Matrix<double, 3, 2>::Zero();
    for (int k = 0; k < 2; ++k) {
      on_surface.col(k) = (part.V.row(part.F(t, k + 1)) - part.V.row(part.F(t, 0))).transpose();
      in_plane.col(k).head<2>() =
          (flat.points.row(part.F(t, k + 1)) - flat.points.row(part.F(t, 0))).transpose();
    }
    const double area = on_surface.col(0).cross(on_surface.col(1)).norm() / 2;
    const double stretch = std::abs(log_stretch(in_plane, on_surface));
    measure.area += area;
    measure.strain += area * std::min(stretch, 1.0);
    if (stretch < bound) measure.within += area;
  }
  return measure;
}

std::vector<SurfacePath> opening_of(const CutPiece& part, const TrialOptions& options) {
  std::vector<SurfacePath> paths;
  if (part.genus() == 0 && part.border_count() > 1) {
    const SurfacePath across = bridge(part, options.mirror);
    if (!across.empty()) paths.push_back(renumbered(across, part.surface_vertex));
  }
  if (!paths.empty()) return paths;
  for (const Edge& e : shortest_cut(part.mesh))
    paths.push_back({at_vertex(part.surface_vertex[e[0]]), at_vertex(part.surface_vertex[e[1]])});
  return paths;
}

}  // namespace

TrialOptions trial_options(const PatternOptions& pattern, double tolerance) {
  TrialOptions options;
  options.pattern = pattern;
  options.tolerance = tolerance;
  options.pattern.flatten.iterations = std::min(pattern.flatten.iterations, kTrialIterations);
  options.pattern.flatten.tolerance = std::max(pattern.flatten.tolerance, kTrialTolerance);
  return options;
}

CutLines lines_of(const std::vector<SurfacePath>& paths, const TriMesh& mesh) {
  const Eigen::MatrixX3d N = vertex_normals(mesh);
  CutLines lines;
  for (const SurfacePath& path : paths) {
    Eigen::MatrixX3d line(path.size(), 3), normal = line;
    for (std::size_t i = 0; i < path.size(); ++i) {
      line.row(i) = path[i].position(mesh.V);
      normal.row(i) = path[i].position(N).normalized();
    }
    lines.length += length(path, mesh.V);
    lines.points.push_back(std::move(line));
    lines.normals.push_back(std::move(normal));
  }
  return lines;
}

std::optional<Openings> open_rings(SeamedSurface& surface, int seam, const TrialOptions& options) {
  constexpr int kMostOpenings = 64;
  Openings openings;
  for (int i = 0; i < kMostOpenings; ++i) {
    const std::vector<CutPiece> parts = cut_surface(surface.mesh, surface.seams);
    const auto closed = std::find_if(parts.begin(), parts.end(), [&](const CutPiece& part) {
      return !can_be_laid_flat(part, options.pattern.hole_tolerance_deg * kDegree);
    });
    if (closed == parts.end()) return openings;
    const std::vector<SurfacePath> paths = opening_of(*closed, options);
    openings.lines.append(lines_of(paths, surface.mesh));
    openings.cuts.push_back(paths);
    if (!surface.cut(paths, seam)) return {};
  }
  return {};
}

std::vector<Panel> panels_of(const SeamedSurface& surface) {
  const EdgeConnectivity edges(surface.mesh.F);
  std::vector<int> piece_of(surface.mesh.triangle_count());
  const std::vector<CutPiece> pieces = cut_surface(surface.mesh, surface.seams);
  for (int p = 0; p < std::ssize(pieces); ++p) {
    for (const int t : pieces[p].surface_triangle) piece_of[t] = p;
  }
  std::vector<SeamEdge> outer, inner;
  for (const SeamEdge& seam : surface.seams) {
    const std::span<const int> both = edges.half_edges(*edges.find(seam.edge[0], seam.edge[1]));
    const bool own = both.size() == 2 && piece_of[both[0] / 3] == piece_of[both[1] / 3];
    (own ? inner : outer).push_back(seam);
  }
  std::vector<Panel> panels;
  for (CutPiece& piece : cut_surface(surface.mesh, outer)) {
    const Eigen::MatrixX3i& local = piece.mesh.F;
    const EdgeConnectivity on_surface(
        local.unaryExpr([&](int v) { return piece.surface_vertex[v]; }).eval());
    Panel& panel = panels.emplace_back();
    for (const SeamEdge& seam : inner) {
      const auto edge = on_surface.find(seam.edge[0], seam.edge[1]);
      if (!edge) continue;
      const int h = on_surface.half_edges(*edge).back();
      panel.inner.push_back({{local(h / 3, h % 3), local(h / 3, (h % 3 + 1) % 3)}, seam.seam});
    }
    panel.piece = std::move(piece);
  }
  return panels;
}

std::optional<CutTrial> try_cut(const Panel& panel, const std::vector<SurfacePath>& paths,
                                const TrialOptions& options) {
  CutTrial trial;
  trial.cut = paths;
  trial.lines = lines_of(paths, panel.piece.mesh);
  SeamedSurface surface{panel.piece.mesh, panel.inner};
  int next_seam = 0;
  for (const SeamEdge& e : panel.inner) next_seam = std::max(next_seam, e.seam + 1);
  if (!paths.empty() && !surface.cut(paths, next_seam)) return {};
  trial.parts = static_cast<int>(cut_surface(surface.mesh, surface.seams).size());
  if (trial.parts > options.most_parts) return {};
  const std::optional<Openings> openings = open_rings(surface, next_seam + 1, options);
  if (!openings) return {};
  trial.opening_length = openings->lines.length;
  trial.least_part = std::numeric_limits<double>::infinity();
  for (const CutPiece& part : cut_surface(surface.mesh, surface.seams)) {
    trial.flat.add(measured(part.mesh, options));
    trial.least_part = std::min(trial.least_part, triangle_areas(part.mesh.V, part.mesh.F).sum());
  }
  return trial;
}

std::vector<CutTrial> measured_panels(const std::vector<Panel>& panels,
                                      const TrialOptions& options) {
  std::vector<CutTrial> measures(panels.size());
  std::vector<std::exception_ptr> errors(panels.size());
  parallel_blocks(panels.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      try {
        std::optional<CutTrial> trial = try_cut(panels[p], {}, options);
        if (!trial) {
          throw Error("cannot be cut open",
                      "a piece of " + std::to_string(panels[p].piece.mesh.F.rows()) + " triangles");
        }
        measures[p] = std::move(*trial);
      } catch (...) {
        errors[p] = std::current_exception();
      }
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  return measures;
}

}  // namespace geoprior::sketch
