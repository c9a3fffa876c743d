#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "experiments/sketch/drawing/drawing_file.h"
#include "experiments/sketch/fabrication/fabrication.h"
#include "experiments/sketch/fabrication/textured_files.h"
#include "experiments/sketch/truth/closed_form_surface.h"
#include "experiments/sketch/truth/known_drawing.h"
#include "experiments/sketch/truth/known_solid.h"
#include "experiments/sketch/truth/synthetic_layers.h"
#include "experiments/sketch/truth/synthetic_views.h"
#include "metrics/contact/planar_overlap.h"
#include "models/sketch/sketch_process.h"
#include "solvers/sketch/layers/layers.h"
#include "solvers/sketch/one_view_process.h"
#include "testbed/topic.h"

namespace geoprior::sketch {

/// `[scene]` of a sketch experiment: a drawing, a drawing of a shape that is known, or a surface in
/// its place.
struct SketchSceneOptions {
  std::string drawing;
  std::string photo;
  std::string surface;
  double surface_scale = 1;
  std::optional<SyntheticViewOptions> synthetic;
  std::optional<ClosedFormOptions> closed_form;
  std::optional<SyntheticLayerOptions> layers;
  std::optional<KnownDrawingOptions> known;
  std::optional<KnownSolidOptions> solid;
  DrawingFileOptions read;
  AlignOptions align;
  HullOptions hull;
  TaubinOptions smoothing;
  PatternOptions pattern;
  std::optional<FabricationOptions> fabrication;
  std::optional<TexturedFileOptions> textures;
};
void describe(OptionVisitor& v, SketchSceneOptions& options);

/// A silhouette that the surface is to have.
struct DrawnSilhouette {
  ViewKind view = ViewKind::front;
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  PlanarLoop outline;
};

class SketchScene final : public ProcessScene {
 public:
  SketchInput input;  ///< what a method is given
  std::vector<DrawnSilhouette> silhouettes;
  Drawing aligned;                        ///< of several views, as methods see them
  std::optional<SyntheticView> truth;     ///< of a synthetic or known view
  std::optional<std::string> background;  ///< colour behind the object in the photograph
  std::optional<double> known_area;       ///< of the surface that several views show (m^2)
  /// Files that are made of one view; none when empty.
  std::function<OneViewFiles(const View&, const OneViewResult&, const Pattern&)> photo_files;

  /// The one view of a drawing that has no others.
  /// @throws Error  when the scene has none
  [[nodiscard]] const View& photo() const;
  /// What articulated layers leave beside their frames: a pattern's files and layers.glb.
  [[nodiscard]] LayerFiles layer_files() const;
  /// The same with how it is laid flat and what files are made of it.
  [[nodiscard]] OneViewInput photo_input() const;

  [[nodiscard]] std::string parameter_name() const override { return "iteration"; }
  [[nodiscard]] std::string parameter_unit() const override { return "1"; }
  [[nodiscard]] std::map<std::string, double> facts() const override;
  /// Parts "silhouette_front", "_side", "_top" (a closed line each) and "strokes" of all views
  /// (lines with the arrays "kind", "view", "closed": StrokeKind, ViewKind), aligned, each in the
  /// plane of its view through the origin, or "surface" in place of a drawing; table "views" with
  /// the directions of right, up and towards the eye.
  [[nodiscard]] Frame given() const override;
  [[nodiscard]] std::vector<PartShape> frame_shape() const override;
};

/// @param folder  of the experiment file, against which relative files are tried first
/// @throws Error  naming key or file, and place
/// @param seed    of the experiment: of the noise of a synthetic view, beside its own
std::shared_ptr<SketchScene> load_sketch_scene(const SketchSceneOptions& options,
                                               const std::filesystem::path& folder,
                                               std::uint64_t seed);

}  // namespace geoprior::sketch
