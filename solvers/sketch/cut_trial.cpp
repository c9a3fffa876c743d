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

class TrialPiece {
 public:
  TrialPiece(const CutPiece& piece, const TrialOptions& options)
      : options_(options), surface_{piece.mesh, {}} {}

  bool cut(const std::vector<SurfacePath>& paths) {
    const Eigen::MatrixX3d V = surface_.mesh.V, N = vertex_normals(surface_.mesh);
    if (!surface_.cut(paths, 0)) return false;
    for (const SurfacePath& path : paths) {
      Eigen::MatrixX3d line(static_cast<Eigen::Index>(path.size()), 3), normal = line;
      for (std::size_t i = 0; i < path.size(); ++i) {
        line.row(static_cast<Eigen::Index>(i)) = path[i].position(V);
        normal.row(static_cast<Eigen::Index>(i)) = path[i].position(N).normalized();
      }
      trial_.length += length(path, V);
      trial_.lines.push_back(std::move(line));
      trial_.normals.push_back(std::move(normal));
    }
    trial_.cuts.push_back(paths);
    return true;
  }

  std::optional<CutTrial> finish() {
    constexpr int kMostOpenings = 8;
    for (int i = 0; i <= kMostOpenings; ++i) {
      const std::vector<CutPiece> parts = cut_surface(surface_.mesh, surface_.seams);
      const auto closed = std::find_if(parts.begin(), parts.end(), [&](const CutPiece& part) {
        return !can_be_laid_flat(part, options_.pattern.hole_tolerance_deg * kDegree);
      });
      if (closed == parts.end()) {
        trial_.parts = static_cast<int>(parts.size());
        for (const CutPiece& part : parts) trial_.flat.add(measured(part.mesh, options_));
        return std::move(trial_);
      }
      if (!cut(opening_of(*closed))) return {};
    }
    return {};
  }

 private:
  [[nodiscard]] std::vector<SurfacePath> opening_of(const CutPiece& part) const {
    std::vector<SurfacePath> paths;
    if (part.genus() == 0 && part.border_count() > 1) {
      const SurfacePath across = bridge(part, options_.mirror);
      if (!across.empty()) paths.push_back(renumbered(across, part.surface_vertex));
    }
    if (!paths.empty()) return paths;
    for (const Edge& e : shortest_cut(part.mesh)) {
      paths.push_back({at_vertex(part.surface_vertex[e[0]]), at_vertex(part.surface_vertex[e[1]])});
    }
    return paths;
  }

  const TrialOptions& options_;
  SeamedSurface surface_;
  CutTrial trial_;
};

}  // namespace

std::optional<CutTrial> try_cut(const CutPiece& piece, const std::vector<SurfacePath>& paths,
                                const TrialOptions& options) {
  TrialPiece trial(piece, options);
  if (!paths.empty() && !trial.cut(paths)) return {};
  return trial.finish();
}

}  // namespace geoprior::sketch
