#include "solvers/sketch/layers/layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/angles.h"
#include "core/frame_loop.h"
#include "core/geometry/topology.h"
#include "solvers/sketch/layers/joint_range.h"
#include "solvers/sketch/layers/pattern.h"

namespace geoprior::sketch {
namespace {

using LayerOn = NamedArray::On;

NamedArray layer_array(const char* name, LayerOn on, const std::vector<double>& values) {
  return {name, "1", on, Eigen::Map<const Eigen::VectorXd>(values.data(), values.size())};
}

/// Meshes one after the other, moved.
Part joined_layers(const std::vector<TriMesh>& meshes,
                   const std::vector<Eigen::Isometry3d>& poses) {
  Eigen::Index n = 0, m = 0;
  for (const TriMesh& mesh : meshes) {
    n += mesh.V.rows();
    m += mesh.F.rows();
  }
  Part part;
  part.points.resize(n, 3);
  part.triangles.resize(m, 3);
  std::vector<double> layer;
  n = m = 0;
  for (std::size_t j = 0; j < meshes.size(); ++j) {
    const TriMesh& mesh = meshes[j];
    part.points.middleRows(n, mesh.V.rows()) =
        (mesh.V * poses[j].linear().transpose()).rowwise() + poses[j].translation().transpose();
    part.triangles.middleRows(m, mesh.F.rows()) = mesh.F.array() + static_cast<int>(n);
    layer.insert(layer.end(), mesh.F.rows(), static_cast<double>(j + 1));
    n += mesh.V.rows();
    m += mesh.F.rows();
  }
  part.arrays.push_back(layer_array("layer", LayerOn::cells, layer));
  return part;
}

/// Lines through points, each moved with its layer.
class LinesPart {
 public:
  void begin() { part_.lines.emplace_back(); }
  void add(const Eigen::Vector3d& p) {
    part_.lines.back().push_back(static_cast<int>(points_.size()));
    points_.push_back(p);
  }
  [[nodiscard]] Part take() {
    part_.kind = Part::Kind::lines;
    part_.points.resize(points_.size(), 3);
    for (std::size_t i = 0; i < points_.size(); ++i) part_.points.row(i) = points_[i].transpose();
    return std::move(part_);
  }

 private:
  Part part_;
  std::vector<Eigen::Vector3d> points_;
};

Part rims_part(const ArticulatedLayers& layers, const std::vector<Eigen::Isometry3d>& poses,
               int around) {
  LinesPart lines;
  std::vector<double> layer;
  for (std::size_t j = 0; j < layers.bands.size(); ++j) {
    const FrustumBand& band = layers.bands[j];
    for (const double x : {-band.length, 0.0}) {
      lines.begin();
      layer.push_back(static_cast<double>(j + 1));
      for (int k = -around; k <= around; k += 2)
        lines.add(poses[j] * band.point(x, band.half_angle * k / around));
    }
  }
  Part part = lines.take();
  part.arrays.push_back(layer_array("layer", LayerOn::cells, layer));
  return part;
}

/// The feet of the drawn points. The first arc is the front rim of the first band, every other one
/// the rear rim of a band.
Part drawn_arcs_part(const ArticulatedLayers& layers) {
  LinesPart lines;
  std::vector<double> stroke, drawn_at;
  for (const ArcCircle& circle : layers.circles) {
    lines.begin();
    for (std::size_t i = 0; i < circle.at.size(); ++i) {
      lines.add(circle.point(circle.at[i]));
      stroke.push_back(circle.stroke);
      drawn_at.push_back(static_cast<double>(i));
    }
  }
  Part part = lines.take();
  part.arrays.push_back(layer_array("stroke", LayerOn::points, stroke));
  part.arrays.push_back(layer_array("drawn_at", LayerOn::points, drawn_at));
  return part;
}

Part rivets_part(const ArticulatedLayers& layers, const std::vector<Eigen::Isometry3d>& poses) {
  Part part;
  part.kind = Part::Kind::points;
  part.points.resize(4 * layers.hinges.size(), 3);
  std::vector<double> layer, number;
  Eigen::Index row = 0;
  for (std::size_t j = 0; j < layers.hinges.size(); ++j) {
    const LayerHinge& hinge = layers.hinges[j];
    for (const std::size_t l : {j, j + 1}) {
      const double x = l == j ? hinge.front_hole_at : hinge.rear_hole_at;
      const double s = l == j ? hinge.front_hole : hinge.rear_hole;
      for (const double side : {-s, s}) {
        part.points.row(row++) = (poses[l] * layers.bands[l].point(x, side)).transpose();
        layer.push_back(static_cast<double>(l + 1));
        number.push_back(static_cast<double>(j));
      }
    }
  }
  part.arrays.push_back(layer_array("layer", LayerOn::points, layer));
  part.arrays.push_back(layer_array("hinge", LayerOn::points, number));
  return part;
}

class LayersModel final : public FrameModel {
 public:
  LayersModel(const View& view, const LayerOptions& options, const PatternOptions& pattern,
              const LayerFiles& files, RunContext& context)
      : options_(options), pattern_(pattern), files_(files) {
    {
      const Phase phase(context, "reconstruct");
      layers_ = build_layers(view, options);
    }
    const Phase phase(context, "joints");
    set_joint_limits(layers_, options);
    for (const FrustumBand& band : layers_.bands) {
      sheets_.push_back(band_sheet(band, options.grid));
      solids_.push_back(band_solid(band, options.thickness * layers_.unit, options.grid));
    }
    moving_ = layers_;
    for (std::size_t j = 0; j < moving_.hinges.size(); ++j)
      moving_.hinges[j].point = hinge_point(layers_, j, options.axis);
  }

  [[nodiscard]] int frame_count() const override { return options_.poses + 1; }

  void record(int number, FrameSink& sink, RunContext& context) override {
    Frame frame = posed_frame(number);
    if (number == 0) frame.parts["strokes"] = drawn_arcs_part(layers_);
    if (number == options_.poses) {
      MadePattern made;
      {
        const Phase phase(context, "flatten");
        made.pattern = layer_pattern(layers_, options_, pattern_.gap);
      }
      const Phase phase(context, "record");
      add_pattern(frame, made);
      add_files(made.pattern, frame.parts.at("surface").points, sink);
    }
    const Phase phase(context, "record");
    sink.frame(std::move(frame));
  }

 private:
  /// Share of the joints' limits: positive curls up.
  [[nodiscard]] double share(int number) const {
    if (2 * number % options_.poses == 0) return 0;
    return std::sin(kFullTurn * number / options_.poses);
  }

  [[nodiscard]] std::vector<double> angles(int number) const {
    const double s = share(number);
    std::vector<double> result;
    for (const LayerHinge& hinge : moving_.hinges)
      result.push_back(s * (s > 0 ? hinge.curl : hinge.stretch));
    return result;
  }

  [[nodiscard]] Frame posed_frame(int number) const {
    const std::vector<Eigen::Isometry3d> poses = layer_poses(moving_, angles(number));
    Frame frame;
    frame.parameter = number;
    Part surface = joined_layers(sheets_, poses);
    std::vector<double> none(surface.points.rows()), border = none;
    for (const Edge& e : boundary_edges(surface.triangles)) border[e[0]] = border[e[1]] = 1;
    surface.arrays.push_back(layer_array("border", LayerOn::points, border));
    surface.arrays.push_back(layer_array("seam", LayerOn::points, none));
    surface.arrays.push_back(layer_array("fold", LayerOn::points, none));
    frame.parts["surface"] = std::move(surface);
    frame.parts["solid"] = joined_layers(solids_, poses);
    frame.parts["rims"] = rims_part(layers_, poses, options_.grid.around);
    if (!layers_.hinges.empty()) frame.parts["rivets"] = rivets_part(layers_, poses);
    frame.diagnostics["joint_share"] = share(number);
    diagnose(frame.diagnostics);
    return frame;
  }

  void diagnose(std::map<std::string, double>& into) const {
    double curl = 0, stretch = 0, least = layers_.hinges.empty() ? 0 : kFullTurn;
    for (const LayerHinge& hinge : layers_.hinges) {
      curl += hinge.curl;
      stretch += hinge.stretch;
      least = std::min(least, hinge.curl + hinge.stretch);
    }
    double condition = 0, kept = 0, other = 1;
    for (const ArcCircle& circle : layers_.circles) {
      condition = std::max(condition, circle.condition);
      kept = std::max(kept, circle.kept_sine);
      other = std::min(other, circle.other_sine);
    }
    into["curl"] = curl / kDegree;
    into["bend_back"] = stretch / kDegree;
    into["least_range"] = least / kDegree;
    diagnose_overlaps(into);
    into["arc_condition"] = condition;
    into["axis_residual"] = std::asin(kept) / kDegree;
    into["axis_residual_other"] = std::asin(other) / kDegree;
  }

  void diagnose_overlaps(std::map<std::string, double>& into) const {
    if (layers_.choices.empty()) return;
    const auto by_share = [](const OverlapRecord& a, const OverlapRecord& b) {
      return a.share < b.share;
    };
    const auto by_room = [](const OverlapRecord& a, const OverlapRecord& b) {
      return a.free < b.free;
    };
    const auto& all = layers_.choices;
    into["overlap_least"] = std::min_element(all.begin(), all.end(), by_share)->share;
    into["overlap_most"] = std::max_element(all.begin(), all.end(), by_share)->share;
    into["room_least"] = std::min_element(all.begin(), all.end(), by_room)->free / kDegree;
  }

  void add_files(const Pattern& pattern, const Eigen::MatrixX3d& surface, FrameSink& sink) const {
    if (files_.pattern) {
      for (Artifact& file : files_.pattern(pattern, surface)) sink.artifact(std::move(file));
    }
    if (files_.joints) {
      for (Artifact& file : files_.joints(layers_)) sink.artifact(std::move(file));
    }
    if (!files_.motion) return;
    LayerMotion motion;
    for (std::size_t j = 0; j < solids_.size(); ++j) {
      LayerMotion::Link link{pattern.pieces[j].name, solids_[j], layers_.circles[0].centre, {}, {}};
      link.axis = layers_.bands[j].up.cross(layers_.bands[j].axis);
      if (j > 0) link.pivot = moving_.hinges[j - 1].point;
      for (int i = 0; i <= options_.poses; ++i) link.angles.push_back(j > 0 ? angles(i)[j - 1] : 0);
      motion.links.push_back(std::move(link));
    }
    for (Artifact& file : files_.motion(motion)) sink.artifact(std::move(file));
  }

  LayerOptions options_;
  PatternOptions pattern_;
  const LayerFiles& files_;  ///< of the process, which outlives its model
  ArticulatedLayers layers_, moving_;
  std::vector<TriMesh> sheets_, solids_;
};

}  // namespace

std::unique_ptr<Process> make_layers_process(const View& view, const LayerOptions& options,
                                             const PatternOptions& pattern,
                                             const LayerFiles& files) {
  return frame_process([view, options, pattern, files](RunContext& context) {
    return std::make_unique<LayersModel>(view, options, pattern, files, context);
  });
}

}  // namespace geoprior::sketch
