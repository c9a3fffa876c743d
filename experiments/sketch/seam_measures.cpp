#include "experiments/sketch/seam_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/mesh.h"
#include "experiments/sketch/measures.h"
#include "experiments/sketch/pattern/piece_verdict.h"
#include "metrics/developability/line_turning.h"
#include "metrics/isometry/flattening.h"

namespace geoprior::sketch {
namespace {

/// Edges of seams that no view drew, as chains between vertices where they end or meet.
std::vector<std::vector<int>> undrawn_chains(const Part& strokes) {
  const auto& kind = strokes.require_array("kind", NamedArray::On::cells, 1).values;
  const auto& view = strokes.require_array("view", NamedArray::On::cells, 1).values;
  std::map<int, std::vector<int>> beside;
  for (std::size_t l = 0; l < strokes.lines.size(); ++l) {
    const auto row = static_cast<Eigen::Index>(l);
    if (kind(row) != static_cast<double>(StrokeKind::seam) || view(row) >= 0) continue;
    const int a = strokes.lines[l].front(), b = strokes.lines[l].back();
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  std::set<std::pair<int, int>> done;
  std::vector<std::vector<int>> chains;
  for (const bool from_end : {true, false}) {
    for (const auto& [v, next] : beside) {
      if ((next.size() != 2) != from_end) continue;
      for (int to : next) {
        std::vector<int> chain{v};
        for (int from = v; done.insert(std::minmax(from, to)).second;) {
          chain.push_back(to);
          const std::vector<int>& on = beside.at(to);
          if (on.size() != 2) break;
          from = std::exchange(to, on[0] == from ? on[1] : on[0]);
        }
        if (chain.size() > 1) chains.push_back(std::move(chain));
      }
    }
  }
  return chains;
}

/// @param normals  of the part's points; none: in space
LineTurning chain_turning(const Part& part, std::vector<int> chain,
                          const Eigen::MatrixX3d* normals = nullptr) {
  const bool closed = chain.size() > 3 && chain.front() == chain.back();
  if (closed) chain.pop_back();
  const Eigen::MatrixX3d points = part.points(chain, Eigen::all);
  if (!normals) return line_turning(points, closed);
  return line_turning_within(points, (*normals)(chain, Eigen::all), closed);
}

double over_length(const LineTurning& of) { return of.turning / of.length; }

LineTurning silhouette_turning(const SketchScene& scene) {
  LineTurning silhouettes;
  for (const DrawnSilhouette& drawn : scene.silhouettes) {
    Eigen::MatrixX3d line = Eigen::MatrixX3d::Zero(std::ssize(drawn.outline), 3);
    for (Eigen::Index i = 0; i < line.rows(); ++i)
      line.row(i).head<2>() = drawn.outline[static_cast<std::size_t>(i)].transpose();
    silhouettes.add(line_turning(line, true));
  }
  return silhouettes;
}

}  // namespace

PieceMeasures piece_measures(const SketchScene& /*scene*/, const Frame& frame) {
  PieceMeasures worst;
  if (frame.find_part("pattern") == nullptr) return worst;
  double whole = 0, least = std::numeric_limits<double>::infinity();
  worst = {1.0, 1.0, 0.0, 0.0, {}};
  for (const FlatPiece& piece : flat_pieces(frame)) {
    const FlatteningSummary flat = flattening({&piece, 1});
    const double area = triangle_areas(piece.x, piece.triangles).sum();
    const double error = std::abs(flat.area_ratio - 1);
    whole += area;
    least = std::min(least, area);
    worst.stretch_p95 = std::max(*worst.stretch_p95, flat.stretch_p95);
    worst.share = std::min(*worst.share, flat.stretch_share[1]);
    worst.area_error = std::max(*worst.area_error, error);
    *worst.refused += flat.flips > 0 || error > kRefusedArea ? 1 : 0;
  }
  worst.least = least / whole;
  return worst;
}

SuggestedTurning suggested_turning(const SketchScene& scene, const Frame& frame) {
  LineTurning seams, within;
  if (frame.find_part("pattern") == nullptr) return {};
  if (const Part* strokes = frame.find_part("strokes")) {
    if (strokes->find_array("view") != nullptr) {
      const Part& surface = *frame.find_part("surface");
      const Eigen::MatrixX3d normals = vertex_normals({surface.points, surface.triangles});
      for (const std::vector<int>& chain : undrawn_chains(*strokes)) {
        seams.add(chain_turning(*strokes, chain));
        within.add(chain_turning(*strokes, chain, &normals));
      }
    }
  }
  const Part* shown = frame.find_part("suggestions");
  if (!(seams.length > 0) && shown != nullptr) {
    for (const std::vector<int>& line : shown->lines) seams.add(chain_turning(*shown, line));
  }
  const LineTurning silhouettes = silhouette_turning(scene);
  SuggestedTurning result;
  if (!(silhouettes.turning > 0)) return result;
  if (seams.length > 0) result.in_space = over_length(seams) / over_length(silhouettes);
  if (within.length > 0) result.within = over_length(within) / over_length(silhouettes);
  return result;
}

std::vector<MetricGroup> seam_metrics() {
  using M = PieceMeasures;
  constexpr Direction kLess = Direction::lower_is_better;
  std::vector<MetricGroup> groups;
  groups.push_back(
      frame_metrics<SketchScene>(piece_measures)
          .row("piece_stretch_p95", "1",
               "stretch, max(s1, 1 / s2), that 95 percent of a piece's area stay under; of the "
               "pieces the worst",
               kLess, {1e-3, 0.02}, &M::stretch_p95)
          .row("piece_share_2", "1",
               "share of a piece's area that is stretched by less than 2 percent; of the pieces "
               "the least",
               Direction::higher_is_better, {0.01, 0}, &M::share)
          .row("piece_area_error", "1",
               "difference of a piece's flat area from its area on the surface, over the latter; "
               "of the pieces the worst",
               kLess, {1e-3, 0.05}, &M::area_error)
          .row("refused_pieces", "1",
               "pieces with triangles turned over, or a flat area that is off by more than 2 "
               "percent",
               kLess, {0, 0}, &M::refused)
          .row("least_piece", "1", "area of the smallest piece on the surface, over that of all",
               Direction::none, {1e-3, 0.05}, &M::least));
  groups.push_back(
      frame_metrics<SketchScene>(suggested_turning)
          .row("suggested_turning", "1",
               "turning over length of suggested seams, over that of the drawn silhouettes", kLess,
               {0.02, 0.05}, &SuggestedTurning::in_space)
          .row(
              "suggested_turning_within", "1",
              "the same of those that were cut, within the surface as their pattern shows it: what "
              "goes straight around a sleeve does not turn",
              kLess, {0.02, 0.05}, &SuggestedTurning::within));
  return groups;
}

}  // namespace geoprior::sketch
