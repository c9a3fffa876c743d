#include "experiments/sketch/layer_measures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/angles.h"
#include "metrics/arrangement/lengths.h"
#include "metrics/contact/intersection_depth.h"
#include "metrics/contact/self_contact.h"
#include "metrics/isometry/border_lengths.h"
#include "metrics/isometry/circular_arc.h"
#include "metrics/shape/mirror_symmetry.h"
#include "metrics/shape/surface_distance.h"
#include "metrics/spacing/rim_cover.h"
#include "metrics/tracks/of_values.h"
#include "models/sketch/drawing/ellipse_fit.h"
#include "models/sketch/drawing/polyline.h"
#include "solvers/sketch/drawing/mirror_plane.h"

namespace geoprior::sketch {
namespace {

using LayerOn = NamedArray::On;

constexpr double kPercentOf = 100;

/// Of the photograph, or of what is drawn where there is none (m).
double picture_width(const View& view) {
  if (view.picture.size.x() > 0) return view.picture.size.x();
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (const Stroke& stroke : view.strokes) {
    for (const Eigen::Vector2d& p : stroke.points) {
      left = std::min(left, p.x());
      right = std::max(right, p.x());
    }
  }
  return right - left;
}

bool has_arcs(const SketchScene& scene) {
  const View* view = scene.input.drawing.find(ViewKind::photo);
  return view != nullptr && !strokes_of(*view, StrokeKind::arc).empty();
}

/// Points of a line of a part.
Eigen::MatrixX3d line_points(const Part& part, std::size_t line) {
  const std::vector<int>& indices = part.lines[line];
  Eigen::MatrixX3d points(indices.size(), 3);
  for (std::size_t i = 0; i < indices.size(); ++i) points.row(i) = part.points.row(indices[i]);
  return points;
}

/// Triangles of one layer.
TriMesh layer_mesh(const Part& part, int layer) {
  const auto& of = part.require_array("layer", LayerOn::cells, 1).values;
  TriMesh mesh{part.points, {}};
  mesh.F.resize(part.triangles.rows(), 3);
  Eigen::Index kept = 0;
  for (Eigen::Index t = 0; t < part.triangles.rows(); ++t) {
    if (static_cast<int>(of(t)) == layer) mesh.F.row(kept++) = part.triangles.row(t);
  }
  mesh.F.conservativeResize(kept, 3);
  return mesh;
}

int layer_count(const Part& part) {
  const auto& layer = part.require_array("layer", LayerOn::cells, 1).values;
  return static_cast<int>(largest_of(layer.col(0)).value_or(0));
}

/// Where the stroke that a line belongs to really is, and how the line compares with it.
void add_circle_errors(const SyntheticView& truth, std::size_t stroke,
                       const Eigen::MatrixX3d& points, ArcMeasures& measures) {
  const std::vector<Eigen::Vector3d>& known = truth.truth[stroke];
  Eigen::MatrixX3d real(known.size(), 3);
  for (std::size_t i = 0; i < known.size(); ++i) real.row(i) = known[i].transpose();
  const ArcDifference off = arc_difference(circular_arc(points), circular_arc(real));
  measures.radius_error = std::max(measures.radius_error.value_or(0), off.radius);
  measures.axis_error_deg = std::max(measures.axis_error_deg.value_or(0), off.axis / kDegree);
}

/// Squared distances of a stroke's points from the image of a line: their sum and the largest.
std::pair<double, double> image_distances(const Stroke& stroke, const Eigen::MatrixX3d& line) {
  std::vector<Eigen::Vector2d> image;
  for (Eigen::Index i = 0; i < line.rows(); ++i) {
    const Eigen::Vector2d p = line.row(i).head<2>().transpose();
    if (image.empty() || p != image.back()) image.push_back(p);
  }
  double sum = 0, most = 0;
  for (const Eigen::Vector2d& p : stroke.points) {
    const BesideStroke near = beside(image, p);
    const double past = std::max({0.0, -near.along, near.along - length(image)});
    const double squared = near.distance * near.distance + past * past;
    sum += squared;
    most = std::max(most, squared);
  }
  return {sum, most};
}

double distance_to_line(const Eigen::MatrixX3d& line, const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i + 1 < line.rows(); ++i)
    least = std::min(least, distance_from_segment(p, line.row(i), line.row(i + 1)));
  return least;
}

void measure_contact(const Frame& frame, double width, LayerMeasures& measures) {
  const Part& solid = frame.require_part("solid", Part::Kind::triangles);
  const auto& layer = solid.require_array("layer", LayerOn::cells, 1).values;
  const Eigen::VectorXi number = layer.col(0).cast<int>();
  const auto between = pairs_between_layers(intersecting_triangles(solid.points, solid.triangles),
                                            std::span<const int>(number.data(), layer.size()));
  measures.pairs = static_cast<double>(between.size());
  measures.depth_percent =
      kPercentOf * intersection_depth(solid.points, solid.triangles, between) / width;
}

/// "rims" has the front and the rear rim of each layer in turn.
void measure_cover(const Frame& frame, LayerMeasures& measures) {
  const Part& rims = frame.require_part("rims", Part::Kind::lines);
  const Part& surface = frame.require_part("surface", Part::Kind::triangles);
  constexpr double kEnds = 0.1;  // beside the rivets
  double worst = 0;
  for (int j = 1; j < layer_count(surface); ++j) {
    const Eigen::MatrixX3d rear = line_points(rims, 2 * j - 1);
    worst = std::max(worst, uncovered_share(rear, kEnds, layer_mesh(surface, j + 1)));
  }
  measures.uncovered = worst;
}

/// "rivets" has, of each hinge, two on the layer before and two on the one behind.
void measure_rivets(const Frame& frame, double width, LayerMeasures& measures) {
  const Part& rivets = frame.require_part("rivets", Part::Kind::points);
  const Part& surface = frame.require_part("surface", Part::Kind::triangles);
  const auto& layer = rivets.require_array("layer", LayerOn::points, 1).values;
  double off = 0, apart = 0;
  for (Eigen::Index first = 0; first + 3 < rivets.points.rows(); first += 4) {
    for (const Eigen::Index pair : {first, first + 2}) {
      const TriMesh own = layer_mesh(surface, static_cast<int>(layer(pair)));
      off = std::max(off, largest_distance(rivets.points.middleRows(pair, 2), own));
    }
    const Eigen::RowVector3d a = rivets.points.row(first);
    const Eigen::RowVector3d line = (rivets.points.row(first + 1) - a).normalized();
    for (const Eigen::Index other : {first + 2, first + 3})
      apart = std::max(apart, (rivets.points.row(other) - a).cross(line).norm());
  }
  measures.rivets_off_percent = kPercentOf * off / width;
  measures.rivets_apart_percent = kPercentOf * apart / width;
}

void measure_symmetry(const SketchScene& scene, const Frame& frame, double width,
                      LayerMeasures& measures) {
  const Part& surface = frame.require_part("surface", Part::Kind::triangles);
  MirrorPlane plane = drawn_mirror_planes(scene.photo()).chosen;
  if (scene.truth) plane = {scene.truth->mirror_normal, 0};
  constexpr double kSpacing = 0.01;  // of the width
  const MirrorSymmetry symmetry =
      mirror_symmetry({surface.points, surface.triangles}, plane.offset * plane.normal,
                      plane.normal, kSpacing * width);
  measures.asymmetry_percent = kPercentOf * symmetry.hausdorff / width;
}

}  // namespace

ArcMeasures arc_measures(const SketchScene& scene, const Frame& frame) {
  ArcMeasures measures;
  if (!has_arcs(scene) || frame.find_part("strokes") == nullptr) return measures;
  const View& view = scene.photo();
  const double width = picture_width(view);
  const Part& lines = frame.require_part("strokes", Part::Kind::lines);
  const auto& stroke = lines.require_array("stroke", LayerOn::points, 1).values;
  double sum = 0, most = 0, count = 0;
  for (std::size_t l = 0; l < lines.lines.size(); ++l) {
    if (lines.lines[l].empty()) continue;
    const auto number = static_cast<std::size_t>(stroke(lines.lines[l].front()));
    const Eigen::MatrixX3d points = line_points(lines, l);
    const auto [squares, largest] = image_distances(view.strokes[number], points);
    sum += squares;
    most = std::max(most, largest);
    count += static_cast<double>(view.strokes[number].points.size());
    if (scene.truth) add_circle_errors(*scene.truth, number, points, measures);
  }
  if (count == 0) return measures;
  measures.rms_percent = kPercentOf * std::sqrt(sum / count) / width;
  measures.max_percent = kPercentOf * std::sqrt(most) / width;
  const Part& surface = frame.require_part("surface", Part::Kind::triangles);
  measures.off_surface_percent =
      kPercentOf * largest_distance(lines.points, TriMesh{surface.points, surface.triangles}) /
      width;
  return measures;
}

EdgeMeasures edge_measures(const SketchScene& scene, const Frame& frame) {
  EdgeMeasures measures;
  if (!has_arcs(scene) || frame.find_part("rims") == nullptr ||
      frame.find_part("strokes") == nullptr)
    return measures;
  const View& view = scene.photo();
  const Part& rims = frame.require_part("rims", Part::Kind::lines);
  std::size_t edge = 0;
  for (std::size_t number = 0; number < view.strokes.size(); ++number) {
    const Stroke& stroke = view.strokes[number];
    if (stroke.kind != StrokeKind::arc) continue;
    const std::size_t line = edge == 0 ? 0 : 2 * edge - 1;
    ++edge;
    if (line >= rims.lines.size()) return {};
    const Eigen::MatrixX3d rim = line_points(rims, line);
    const double radius = fit_ellipse(stroke.points, stroke.id).ellipse.major;
    const double off = std::sqrt(image_distances(stroke, rim).second) / radius;
    measures.drawn = std::max(measures.drawn.value_or(0), off);
    if (!scene.truth) continue;
    const std::vector<Eigen::Vector3d>& known = scene.truth->truth[number];
    Eigen::MatrixX3d real(known.size(), 3);
    for (std::size_t i = 0; i < known.size(); ++i) real.row(i) = known[i].transpose();
    double most = 0;
    for (const Eigen::Vector3d& p : known) most = std::max(most, distance_to_line(rim, p));
    measures.known = std::max(measures.known.value_or(0), most / circular_arc(real).radius);
  }
  return measures;
}

LayerMeasures layer_measures(const SketchScene& scene, const Frame& frame) {
  LayerMeasures measures;
  if (frame.find_part("solid") == nullptr) return measures;
  const double width = picture_width(scene.photo());
  measure_contact(frame, width, measures);
  measure_cover(frame, measures);
  if (frame.find_part("rivets") != nullptr) measure_rivets(frame, width, measures);
  if (frame.find_part("strokes") != nullptr) measure_symmetry(scene, frame, width, measures);
  return measures;
}

std::optional<double> sector_length_error(const SketchScene& /*scene*/, const Frame& frame) {
  if (frame.find_part("solid") == nullptr || frame.find_part("pattern") == nullptr) return {};
  const Part& flat = frame.require_part("pattern", Part::Kind::triangles);
  const Part& surface = frame.require_part("surface", Part::Kind::triangles);
  const auto& vertex = flat.require_array("surface_vertex", LayerOn::points, 1).values;
  Eigen::MatrixX3d real(flat.points.rows(), 3);
  for (Eigen::Index i = 0; i < real.rows(); ++i)
    real.row(i) = surface.points.row(static_cast<Eigen::Index>(vertex(i)));
  return border_length_error(flat.points.leftCols<2>(), flat.triangles, real);
}

}  // namespace geoprior::sketch
