#include "experiments/sketch/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <span>

#include "core/angles.h"
#include "core/connectivity.h"
#include "experiments/sketch/sewn_lines.h"
#include "metrics/developability/ruling_angle.h"
#include "metrics/developability/sharp_turning.h"
#include "metrics/isometry/seam_lengths.h"
#include "metrics/shape/depth_error.h"
#include "metrics/shape/silhouette.h"
#include "metrics/spacing/projected_holes.h"

namespace geoprior::sketch {
namespace {

TriMesh surface_mesh(const Frame& frame) {
  const Part& part = frame.require_part("surface", Part::Kind::triangles);
  return {part.points, part.triangles};
}

/// Length of the edges both of whose ends are marked.
double length_between(const TriMesh& mesh, const std::vector<bool>& marked) {
  double length = 0;
  const EdgeConnectivity edges(mesh.F);
  for (const auto& [a, b] : edges.edges()) {
    if (marked[a] && marked[b]) length += (mesh.V.row(a) - mesh.V.row(b)).norm();
  }
  return length;
}

/// Largest relative difference of two stretches that are sewn together.
std::optional<double> largest_mismatch(const Frame& frame) {
  std::optional<double> largest;
  for (const auto& [left, right] : sewn_lines(frame))
    largest = std::max(largest.value_or(0), seam_mismatch(left, right).relative);
  return largest;
}

}  // namespace

std::vector<FlatPiece> flat_pieces(const Frame& frame) {
  const Part& pattern = frame.require_part("pattern", Part::Kind::triangles);
  const Part& surface = frame.require_part("surface", Part::Kind::triangles);
  const auto& piece = pattern.require_array("piece", NamedArray::On::cells, 1).values;
  const auto& vertex = pattern.require_array("surface_vertex", NamedArray::On::points, 1).values;
  Eigen::MatrixX3d x(pattern.points.rows(), 3);
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    x.row(i) = surface.points.row(static_cast<Eigen::Index>(vertex(i)));
  const Eigen::VectorXi number = piece.col(0).cast<int>();
  return pieces_apart(pattern.points.leftCols<2>(), x, pattern.triangles,
                      std::span<const int>(number.data(), piece.size()));
}

SurfaceMeasures surface_measures(const SketchScene& /*scene*/, const Frame& frame) {
  const TriMesh mesh = surface_mesh(frame);
  const Part& part = frame.require_part("surface");
  const auto& seam = part.require_array("seam", NamedArray::On::points, 1).values;
  const auto& fold = part.require_array("fold", NamedArray::On::points, 1).values;
  std::vector<bool> left_out(mesh.V.rows());
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) left_out[v] = seam(v) > 0 || fold(v) > 0;
  std::vector<bool> drawn = left_out;
  if (const NamedArray* ridge = part.find_array("ridge")) {
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) drawn[v] = drawn[v] || ridge->values(v) > 0;
  }
  return {developability_spread(mesh), developability_spread(mesh, left_out),
          sharp_turning_share(mesh, kSharpTurn, left_out),
          crease_measures(mesh, kCreaseTurn, drawn), length_between(mesh, drawn)};
}

SilhouetteMeasures silhouette_measures(const SketchScene& scene, const Frame& frame) {
  const TriMesh mesh = surface_mesh(frame);
  SilhouetteMeasures worst;
  for (const DrawnSilhouette& drawn : scene.silhouettes) {
    const SilhouetteMatch match =
        silhouette_match(with_filled_holes(mesh, drawn.frame), drawn.frame,
                         std::span<const PlanarLoop>(&drawn.outline, 1));
    worst.iou = std::min(worst.iou.value_or(1), match.iou);
    worst.hausdorff_percent =
        std::max(worst.hausdorff_percent.value_or(0), match.hausdorff_percent);
    worst.gap_share = std::max(worst.gap_share.value_or(0), match.gap_share);
  }
  return worst;
}

PatternMeasures pattern_measures(const SketchScene& /*scene*/, const Frame& frame) {
  PatternMeasures measures;
  if (frame.find_part("pattern") == nullptr) return measures;
  const std::vector<FlatPiece> pieces = flat_pieces(frame);
  measures.flat = flattening(pieces);
  measures.pieces = static_cast<double>(pieces.size());
  measures.piece_overlaps = static_cast<double>(piece_overlaps(pieces).size());
  measures.seam_mismatch = largest_mismatch(frame);
  return measures;
}

CutMeasures cut_measures(const SketchScene& /*scene*/, const Frame& frame) {
  CutMeasures measures;
  if (const Part* pattern = frame.find_part("pattern")) {
    const Part& surface = frame.require_part("surface");
    const auto& vertex = pattern->require_array("surface_vertex", NamedArray::On::points, 1).values;
    const Eigen::MatrixXd& sewn = frame.require_table("sewn").rows;
    const auto at = [&](Eigen::Index row) -> Eigen::RowVector3d {
      const auto point = static_cast<Eigen::Index>(sewn(row, 3));
      return surface.points.row(static_cast<Eigen::Index>(vertex(point)));
    };
    double both_sides = 0;
    for (Eigen::Index i = 1; i < sewn.rows(); ++i) {
      if (sewn(i, 0) == sewn(i - 1, 0)) both_sides += (at(i) - at(i - 1)).norm();
    }
    measures.seam_length = both_sides / 2;
  }
  const Part* part = frame.find_part("suggestions");
  if (part == nullptr || part->lines.empty()) return measures;
  const auto& rank = part->require_array("rank", NamedArray::On::cells, 1).values;
  double sum = 0, first = 0;
  for (std::size_t l = 0; l < part->lines.size(); ++l) {
    double line = 0;
    for (std::size_t k = 1; k < part->lines[l].size(); ++k)
      line +=
          (part->points.row(part->lines[l][k]) - part->points.row(part->lines[l][k - 1])).norm();
    sum += line;
    if (rank(l) == 1) first += line;
  }
  measures.suggestions = rank.maxCoeff();
  measures.suggested_length = sum;
  measures.first_suggestion_length = first;
  return measures;
}

namespace {

/// Areas of the flat pieces against those of the known panels.
void add_panel_areas(const SyntheticView& truth, const Frame& frame, TruthMeasures& measures) {
  const Part* pattern = frame.find_part("pattern");
  if (truth.panel_areas.empty() || pattern == nullptr) return;
  const std::vector<std::string> names = panels_of(truth.view);
  const auto& triangle =
      pattern->require_array("surface_triangle", NamedArray::On::cells, 1).values;
  const auto& panel = frame.require_array("surface", "panel", NamedArray::On::cells, 1).values;
  const Eigen::VectorXd areas = triangle_areas(pattern->points, pattern->triangles);
  std::map<std::string, double> flat;
  for (Eigen::Index t = 0; t < areas.size(); ++t) {
    const auto number = static_cast<int>(panel(static_cast<Eigen::Index>(triangle(t))));
    if (number >= 0) flat[names[static_cast<std::size_t>(number)]] += areas(t);
  }
  double whole = 0, worst = 0;
  for (const auto& [name, area] : truth.panel_areas) {
    whole += area;
    worst = std::max(worst, std::abs(flat[name] / area - 1));
  }
  measures.pattern_area = std::abs(areas.sum() / whole - 1);
  measures.panel_area = worst;
}

/// @param offset  depth to be added to the reconstruction, which one view cannot tell (m)
std::optional<double> ruling_angle(const SyntheticView& truth, const Frame& frame, double offset) {
  const Part* rulings = frame.find_part("rulings");
  if (!truth.conical || rulings == nullptr) return {};
  std::vector<std::array<Eigen::Vector3d, 2>> ends;
  for (const std::vector<int>& line : rulings->lines) {
    if (line.empty()) continue;
    ends.push_back({rulings->points.row(line.front()).transpose(),
                    rulings->points.row(line.back()).transpose()});
  }
  const std::optional<double> rms = ruling_angle_rms(ends, truth.apex, {0, 0, offset});
  if (!rms) return {};
  return *rms / kDegree;
}

double distance_to_line(const std::vector<Eigen::Vector3d>& line, const Eigen::Vector3d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Eigen::Vector3d d = line[k + 1] - line[k];
    const double t = std::clamp(d.dot(p - line[k]) / d.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (line[k] + t * d - p).norm());
  }
  return nearest;
}

/// @param offset  as `ruling_angle`
std::optional<double> guessed_off(const SyntheticView& truth, const Part& curves,
                                  const Eigen::VectorXd& stroke, double offset) {
  if (truth.borders.empty()) return {};
  double sum = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < curves.points.rows(); ++i) {
    if (stroke(i) >= 0) continue;
    const Eigen::Vector3d p = curves.points.row(i).transpose() + Eigen::Vector3d(0, 0, offset);
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::vector<Eigen::Vector3d>& border : truth.borders)
      nearest = std::min(nearest, distance_to_line(border, p));
    sum += nearest * nearest;
    ++count;
  }
  if (count == 0) return {};
  return std::sqrt(sum / count) / truth.height;
}

}  // namespace

std::optional<double> surface_area_error(const SketchScene& scene, const Frame& frame) {
  if (!scene.known_area || frame.find_part("surface") == nullptr) return {};
  const Part& surface = frame.require_part("surface", Part::Kind::triangles);
  const double area = triangle_areas(surface.points, surface.triangles).sum();
  return std::abs(area - *scene.known_area) / *scene.known_area;
}

TruthMeasures truth_measures(const SketchScene& scene, const Frame& frame) {
  TruthMeasures measures;
  if (!scene.truth || frame.find_part("strokes") == nullptr) return measures;
  const SyntheticView& truth = *scene.truth;
  const Part& curves = frame.require_part("strokes", Part::Kind::lines);
  if (curves.points.rows() == 0) return measures;
  const auto& stroke = curves.require_array("stroke", NamedArray::On::points, 1).values;
  const auto& drawn_at = curves.require_array("drawn_at", NamedArray::On::points, 1).values;
  Eigen::MatrixX3d real(curves.points.rows(), 3), found(curves.points.rows(), 3);
  Eigen::Index drawn = 0;
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (Eigen::Index i = 0; i < curves.points.rows(); ++i) {
    if (stroke(i) < 0) continue;  // guessed: it stands for no drawn point
    const auto& points = truth.truth[static_cast<std::size_t>(stroke(i))];
    const double at = std::floor(drawn_at(i));
    const Eigen::Vector3d a = points[static_cast<std::size_t>(at) % points.size()];
    const Eigen::Vector3d b = points[(static_cast<std::size_t>(at) + 1) % points.size()];
    found.row(drawn) = curves.points.row(i);
    real.row(drawn) = (a + (drawn_at(i) - at) * (b - a)).transpose();
    left = std::min(left, real(drawn, 0));
    right = std::max(right, real(drawn, 0));
    ++drawn;
  }
  if (drawn == 0) return measures;
  real.conservativeResize(drawn, 3);
  found.conservativeResize(drawn, 3);
  const DepthError error = depth_error(found, real, Eigen::Vector3d::UnitZ(), truth.height);
  measures.depth_rms = error.share;
  measures.depth_max = error.max / truth.height;
  measures.reprojection = error.in_plane_rms / (right - left);
  const double offset = (real.col(2) - found.col(2)).mean();
  measures.ruling_angle = ruling_angle(truth, frame, offset);
  measures.guessed_off = guessed_off(truth, curves, stroke.col(0), offset);
  add_panel_areas(truth, frame, measures);
  return measures;
}

}  // namespace geoprior::sketch
