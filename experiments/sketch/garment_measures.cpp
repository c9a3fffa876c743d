#include "experiments/sketch/garment_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

#include "core/angles.h"
#include "core/connectivity.h"
#include "core/geometry/topology.h"
#include "experiments/sketch/sewn_lines.h"
#include "metrics/developability/developability.h"
#include "metrics/developability/fold_angle.h"
#include "metrics/isometry/seam_lengths.h"
#include "metrics/shape/mirror_symmetry.h"
#include "metrics/shape/silhouette_depth.h"
#include "models/sketch/drawing/polyline.h"

namespace geoprior::sketch {
namespace {

constexpr double kThesisFoldAngle = 60 * kDegree;

TriMesh garment_mesh(const Frame& frame) {
  const Part& part = frame.require_part("surface", Part::Kind::triangles);
  return {part.points, part.triangles};
}

/// A drawn stroke as it lies on the surface.
struct TracedEdges {
  ViewKind view = ViewKind::front;
  const Stroke* drawn = nullptr;
  std::vector<Edge> edges;
};

/// Strokes of the frame that a drawing of several views has, by kind, view and number.
std::vector<TracedEdges> traced_strokes(const Drawing& aligned, const Frame& frame,
                                        StrokeKind kind) {
  std::map<std::pair<int, int>, TracedEdges> strokes;
  const Part* part = frame.find_part("strokes");
  if (part == nullptr || part->find_array("number", NamedArray::On::cells) == nullptr) return {};
  const auto& kinds = part->require_array("kind", NamedArray::On::cells, 1).values;
  const auto& views = part->require_array("view", NamedArray::On::cells, 1).values;
  const auto& numbers = part->require_array("number", NamedArray::On::cells, 1).values;
  for (std::size_t i = 0; i < part->lines.size(); ++i) {
    if (static_cast<StrokeKind>(kinds(i)) != kind || views(i) < 0) continue;
    const auto view = static_cast<ViewKind>(views(i));
    const int number = static_cast<int>(numbers(i));
    if (aligned.find(view) == nullptr) continue;
    TracedEdges& stroke = strokes[{static_cast<int>(view), number}];
    stroke.view = view;
    stroke.drawn = strokes_of(*aligned.find(view), kind)[number];
    stroke.edges.push_back({part->lines[i][0], part->lines[i][1]});
  }
  std::vector<TracedEdges> list;
  for (auto& [key, stroke] : strokes) list.push_back(std::move(stroke));
  return list;
}

/// Triangles beside the edges of a fold: those of the side that it is drawn on, and of the other.
void add_sides(const EdgeConnectivity& edges, const Eigen::MatrixX3d& normals,
               const TracedEdges& fold, std::vector<SeenFold>& sides) {
  const double asked =
      fold.drawn->fold_angle_deg ? *fold.drawn->fold_angle_deg * kDegree : kThesisFoldAngle;
  const Eigen::Vector3d eye = view_frame(fold.view).row(2).transpose();
  std::set<int> front, back;
  for (const Edge& e : fold.edges) {
    for (const int h : edges.half_edges(edges.find(e[0], e[1]).value())) {
      const bool behind = fold.drawn->side == DepthSide::back ||
                          (fold.drawn->side == DepthSide::both && normals.row(h / 3).dot(eye) < 0);
      (behind ? back : front).insert(h / 3);
    }
  }
  if (!front.empty()) sides.push_back({{front.begin(), front.end()}, eye, asked});
  if (!back.empty()) sides.push_back({{back.begin(), back.end()}, -eye, asked});
}

/// Triangles of each piece on the surface; none before the last frame.
std::vector<std::vector<int>> panels_of(const Frame& frame) {
  if (frame.find_part("pattern") == nullptr) return {};
  const Part& surface = frame.require_part("surface");
  const auto& piece = surface.require_array("piece", NamedArray::On::cells, 1).values;
  std::map<int, std::vector<int>> of_piece;
  for (Eigen::Index t = 0; t < piece.rows(); ++t) {
    if (piece(t) >= 0) of_piece[static_cast<int>(piece(t))].push_back(static_cast<int>(t));
  }
  std::vector<std::vector<int>> panels;
  for (auto& [number, triangles] : of_piece) panels.push_back(std::move(triangles));
  return panels;
}

}  // namespace

FoldMeasures fold_measures(const SketchScene& scene, const Frame& frame) {
  const std::vector<TracedEdges> folds = traced_strokes(scene.aligned, frame, StrokeKind::fold);
  if (folds.empty()) return {};
  const TriMesh mesh = garment_mesh(frame);
  const EdgeConnectivity edges(mesh.F);
  const Eigen::MatrixX3d normals = triangle_normals(mesh);
  std::vector<SeenFold> sides;
  for (const TracedEdges& fold : folds) add_sides(edges, normals, fold, sides);
  const FoldAngle angle = fold_angles(mesh, sides);
  return {angle.mean / kDegree, angle.max / kDegree};
}

StrokeMeasures stroke_measures(const SketchScene& scene, const Frame& frame) {
  StrokeMeasures measures;
  const TriMesh mesh = garment_mesh(frame);
  for (const StrokeKind kind : {StrokeKind::border, StrokeKind::seam}) {
    for (const TracedEdges& stroke : traced_strokes(scene.aligned, frame, kind)) {
      const auto drawn = std::find_if(
          scene.silhouettes.begin(), scene.silhouettes.end(),
          [&](const DrawnSilhouette& silhouette) { return silhouette.view == stroke.view; });
      if (drawn == scene.silhouettes.end()) continue;  // a view without one has no size
      Eigen::Vector2d low = drawn->outline.front(), high = low;
      for (const Eigen::Vector2d& p : drawn->outline) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
      std::vector<Eigen::Vector2d> line = stroke.drawn->points;
      if (stroke.drawn->closed) line.push_back(line.front());
      for (const Edge& e : stroke.edges) {
        for (const int v : e) {
          const Eigen::Vector2d q = drawn->frame.topRows<2>() * mesh.V.row(v).transpose();
          const double off = 100 * std::abs(beside(line, q).distance) / (high - low).norm();
          measures.off_percent = std::max(measures.off_percent.value_or(0), off);
        }
      }
    }
  }
  return measures;
}

GeneratorMeasures generator_measures(const SketchScene& scene, const Frame& frame) {
  if (scene.silhouettes.empty() || frame.find_part("pattern") == nullptr) return {};
  const TriMesh mesh = garment_mesh(frame);
  if (mesh.vertex_count() == 0) return {};
  const DrawnSilhouette& first = scene.silhouettes.front();
  const SilhouetteDepth depth = silhouette_depth(mesh, first.frame, first.outline);
  return {depth.range, depth.jump, 100 * depth.plane_rms};
}

GaussMeasures gauss_measures(const SketchScene& /*scene*/, const Frame& frame) {
  const std::vector<std::vector<int>> panels = panels_of(frame);
  if (panels.empty()) return {};
  const PanelImages images = panel_images(garment_mesh(frame), panels);
  return {images.great_circle_thinness, images.small_circle_thinness, images.circle_rms / kDegree};
}

SeamPointMeasures seam_point_measures(const SketchScene& /*scene*/, const Frame& frame) {
  SeamPointMeasures measures;
  if (frame.find_part("pattern") == nullptr) return measures;
  for (const auto& [left, right] : sewn_lines(frame)) {
    const geoprior::SeamMismatch seam = seam_mismatch(left, right);
    const double length = (seam.left_length + seam.right_length) / 2;
    measures.shift_percent =
        std::max(measures.shift_percent.value_or(0), 100 * seam.shift_max / length);
    measures.segment = std::max(measures.segment.value_or(0), seam.segment_max);
  }
  return measures;
}

std::optional<double> mirror_percent(const SketchScene& scene, const Frame& frame) {
  if (scene.silhouettes.empty() || frame.find_part("pattern") == nullptr) return {};
  const TriMesh mesh = garment_mesh(frame);
  if (mesh.vertex_count() == 0) return {};
  const double diagonal = (mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff()).norm();
  const MirrorSymmetry mirror =
      mirror_symmetry(mesh, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), diagonal / 200);
  return 100 * mirror.hausdorff / diagonal;
}

std::vector<MetricGroup> garment_metrics() {
  constexpr Direction kLow = Direction::lower_is_better, kNone = Direction::none;
  constexpr Tolerance kLoose{0.02, 0.1};
  std::vector<MetricGroup> groups;
  groups.push_back(
      frame_metrics<SketchScene>(fold_measures)
          .row(
              "fold_angle_mean", "deg",
              "mean by area of |angle(normal, view) - asked| over the triangles beside drawn folds",
              kLow, kLoose, &FoldMeasures::mean_deg)
          .row("fold_angle_max", "deg", "largest such difference", kLow, {0.5, 0.1},
               &FoldMeasures::max_deg));
  groups.push_back(
      frame_metrics<SketchScene>(stroke_measures)
          .row("pin_residual", "%",
               "largest distance of a border's or seam's vertex from its stroke in the stroke's "
               "view, over the diagonal of that view",
               kLow, {1e-3, 0.1}, &StrokeMeasures::off_percent));
  groups.push_back(
      frame_metrics<SketchScene>(generator_measures)
          .row("silhouette_depth_range", "1",
               "how far in depth the surface's points on the first view's silhouette spread, "
               "without 5 % at either end, over the depth of the surface",
               kNone, kLoose, &GeneratorMeasures::range)
          .row(
              "silhouette_depth_jump", "1",
              "largest step in depth between neighbouring points of that silhouette, over the same",
              kNone, kLoose, &GeneratorMeasures::jump)
          .row("silhouette_plane_rms", "%",
               "root mean square distance of those points from their best plane, over the diagonal",
               kNone, kLoose, &GeneratorMeasures::plane_percent));
  groups.push_back(
      frame_metrics<SketchScene>(gauss_measures)
          .row("gauss_great_thinness", "1",
               "mean by area over the panels: smallest over middle eigenvalue of the normals about "
               "a great circle; 0 for a cylinder",
               kLow, kLoose, &GaussMeasures::great)
          .row("gauss_small_thinness", "1", "the same about a small circle; 0 for a cone", kLow,
               kLoose, &GaussMeasures::small)
          .row(
              "gauss_circle_rms", "deg",
              "mean by area over the panels: root mean square angle of the normals from the nearer "
              "of the two circles",
              kLow, {0.1, 0.1}, &GaussMeasures::rms_deg));
  groups.push_back(
      frame_metrics<SketchScene>(seam_point_measures)
          .row("seam_shift", "%",
               "largest shift of a point from its partner along a seam, over the seam's length",
               kLow, {0.05, 0.1}, &SeamPointMeasures::shift_percent)
          .row("seam_segment_mismatch", "1",
               "largest difference of the lengths of two segments sewn together, over their mean",
               kLow, kLoose, &SeamPointMeasures::segment));
  groups.push_back(frame_metrics<SketchScene>(mirror_percent)
                       .row("mirror_hausdorff", "%",
                            "Hausdorff distance of the surface from its image in the plane x = 0, "
                            "over its diagonal",
                            kNone, {0.05, 0.1}, [](const std::optional<double>& m) { return m; }));
  return groups;
}

}  // namespace geoprior::sketch
