#include "solvers/sketch/cut_trial.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/angles.h"
#include "models/sketch/flat_stretch.h"
#include "models/sketch/flatten.h"
#include "models/sketch/shortest_cut.h"

namespace geoprior::sketch {
namespace {

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

CutLines lines_of(const std::vector<SurfacePath>& paths, const TriMesh& mesh) {
  const Eigen::MatrixX3d N = vertex_normals(mesh);
  CutLines lines;
  for (const SurfacePath& path : paths) {
    Eigen::MatrixX3d line(static_cast<Eigen::Index>(path.size()), 3), normal = line;
    for (std::size_t i = 0; i < path.size(); ++i) {
      line.row(static_cast<Eigen::Index>(i)) = path[i].position(mesh.V);
      normal.row(static_cast<Eigen::Index>(i)) = path[i].position(N).normalized();
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

std::optional<CutTrial> try_cut(const CutPiece& piece, const std::vector<SurfacePath>& paths,
                                const TrialOptions& options) {
  CutTrial trial;
  trial.cut = paths;
  trial.lines = lines_of(paths, piece.mesh);
  SeamedSurface surface{piece.mesh, {}};
  if (!paths.empty() && !surface.cut(paths, 0)) return {};
  for (const CutPiece& part : cut_surface(surface.mesh, surface.seams)) {
    const double area = triangle_areas(part.mesh.V, part.mesh.F).sum();
    trial.least_part = trial.parts == 0 ? area : std::min(trial.least_part, area);
    ++trial.parts;
  }
  const std::optional<Openings> openings = open_rings(surface, 1, options);
  if (!openings) return {};
  trial.opening_length = openings->lines.length;
  for (const CutPiece& part : cut_surface(surface.mesh, surface.seams))
    trial.flat.add(measured(part.mesh, options));
  return trial;
}

}  // namespace geoprior::sketch
