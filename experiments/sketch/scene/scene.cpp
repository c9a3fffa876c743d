#include "experiments/sketch/scene/scene.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <mutex>
#include <utility>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/random.h"
#include "experiments/sketch/drawing/drawing_checks.h"
#include "experiments/sketch/drawing/picture_file.h"
#include "experiments/sketch/drawing/view_picture.h"
#include "experiments/sketch/fabrication/cloth_files.h"
#include "experiments/sketch/pattern/joint_table.h"
#include "models/sketch/sections/hull_sections.h"
#include "testbed/formats/artifact.h"
#include "testbed/formats/gltf/writer.h"
#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/svg/color.h"
#include "testbed/given_tables.h"
#include "testbed/home.h"

namespace geoprior::sketch {
namespace {

void load_surface(const SketchSceneOptions& o, const std::filesystem::path& folder,
                  SketchScene& scene) {
  const std::filesystem::path file = find_file(o.surface, folder, "data", "scene.surface");
  scene.input_files = files_of_mesh(file);
  MeshFile read = read_mesh_file(file);
  TriMesh mesh = weld_by_position(read.mesh).mesh;
  note_collapsed(read.mesh, mesh, read.notes);
  name_notes(read, file);
  scene.load_warnings = std::move(read.notes);
  if (mesh.triangle_count() == 0)
    throw Error("has no triangles", file.string(), "a surface of one triangle or more");
  mesh.V *= o.surface_scale;
  scene.input.surface = std::move(mesh);
}

/// A word on what the sections between the views are taken for.
void tell_sections(const SketchSceneOptions& o, SketchScene& scene) {
  const std::vector<OutlinedView> views = outlined_views(scene.aligned);
  if (o.hull.sections != HullSections::automatic || views.size() < 2) return;
  const SectionBounds sections(scene.aligned, views, o.hull.sections);
  scene.load_warnings.push_back(sections.report().text());
}

std::vector<DrawnSilhouette> drawn_silhouettes(const Drawing& aligned) {
  std::vector<DrawnSilhouette> silhouettes;
  for (const OutlinedView& view : outlined_views(aligned))
    silhouettes.push_back({view.kind, view.frame, view.outline.points()});
  return silhouettes;
}

/// Silhouettes of several views as they are drawn, and what is doubtful in them.
void align_drawing(const SketchSceneOptions& o, SketchScene& scene) {
  scene.aligned = align_views(scene.input.drawing, o.align, &scene.load_warnings);
  for (std::string& doubt : doubtful_views(scene.aligned))
    scene.load_warnings.push_back(std::move(doubt));
  tell_sections(o, scene);
  scene.silhouettes = drawn_silhouettes(scene.aligned);
}

void load_drawing(const SketchSceneOptions& o, const std::filesystem::path& folder,
                  std::uint64_t seed, SketchScene& scene) {
  const std::filesystem::path file = find_file(o.drawing, folder, "data", "scene.drawing");
  DrawingFileOptions how = o.read;
  if (how.tremor) how.tremor->seed = static_cast<int>(scene_seed(seed, how.tremor->seed));
  DrawingFile read = read_drawing(file, how);
  scene.input.drawing = std::move(read.drawing);
  scene.load_warnings = std::move(read.warnings);
  scene.input_files = std::move(read.inputs);
  if (!o.photo.empty()) {
    const std::filesystem::path photo = find_file(o.photo, folder, "data", "scene.photo");
    replace_picture(scene.input.drawing, photo, read.page);
    scene.input_files.push_back(photo);
  }
  if (scene.input.drawing.find(ViewKind::photo) != nullptr) return;
  align_drawing(o, scene);
  if (!how.tremor) return;
  // What a trembling hand meant is what the surface is measured against.
  how.tremor.reset();
  scene.silhouettes = drawn_silhouettes(align_views(read_drawing(file, how).drawing, o.align));
}

/// What a known drawing shows is its truth; without a file it is drawn here.
void load_known(const SketchSceneOptions& o, std::uint64_t seed, SketchScene& scene) {
  if (o.drawing.empty()) scene.input.drawing = known_drawing(*o.known);
  scene.truth = known_truth(scene.photo(), *o.known, scene_seed(seed, o.known->seed));
  scene.input.drawing.views = {scene.truth->view};
}

/// The files of a pattern; of one that is none a text that says why.
std::vector<Artifact> pattern_artifacts(const Pattern& pattern, const Eigen::MatrixX3d& surface,
                                        const FabricationOptions& options) {
  std::vector<Artifact> artifacts;
  try {
    for (const FabricationFile& file : judged_fabrication_files(pattern, surface, options))
      artifacts.push_back(artifact_of(file.name, file.bytes));
    if (options.cloth) {
      for (const FabricationFile& file : cloth_files(pattern, surface))
        artifacts.push_back(artifact_of(file.name, file.bytes));
    }
  } catch (const Error& error) {
    artifacts = {artifact_of("pattern-refused.txt", std::string(error.what()) + "\n")};
  }
  return artifacts;
}

/// The picture of the scene's view, decoded when it is first asked for, whatever variants follow.
class DecodedPicture {
 public:
  const PixelImage& of(const View& view) {
    const std::lock_guard lock(mutex_);
    if (!image_) image_ = read_picture(view.picture);
    return *image_;
  }

 private:
  std::mutex mutex_;
  std::optional<PixelImage> image_;
};

/// Refuses a picture that is too large before anything is computed.
void require_picture(const SketchScene& scene) {
  const Picture& picture = scene.photo().picture;
  const std::string head = picture.file.empty() ? picture.content : head_of_picture(picture.file);
  if (const auto size = picture_size(head)) {
    require_picture_size(*size, 3, picture.file.empty() ? "the drawing's picture" : picture.file);
  }
}

/// @throws Error  unless it is absent or a colour
std::optional<std::string> known_background(const TexturedFileOptions& textures) {
  if (textures.background && !parse_svg_colour(*textures.background)) {
    throw Error("'" + *textures.background + "' is no colour", "scene.textures.background",
                "#rrggbb");
  }
  if (!textures.background) return {};
  const SvgColour c = *parse_svg_colour(*textures.background);
  constexpr int kLeast = 40;
  std::array<int, 3> channels{c.red, c.green, c.blue};
  std::sort(channels.begin(), channels.end());
  if (channels[2] - channels[1] < kLeast) {
    throw Error("'" + *textures.background + "' has no hue that tells it from an object",
                "scene.textures.background", "one channel 40 of 255 above the others");
  }
  return textures.background;
}

/// Files of one view: the pattern's, the textured ones, and the drawing that was made here.
OneViewFiles one_view_files(const SketchSceneOptions& o, DecodedPicture& picture, const View& view,
                            const OneViewResult& result, const Pattern& pattern) {
  OneViewFiles files;
  if (o.fabrication)
    files.artifacts = pattern_artifacts(pattern, result.surface.mesh.V, *o.fabrication);
  std::vector<FabricationFile> made;
  if (o.textures) {
    TexturedFiles textured = textured_files(view, picture.of(view), result, pattern, *o.textures);
    made = std::move(textured.files);
    files.diagnostics = std::move(textured.diagnostics);
    if (o.textures->background) files.parts["texels"] = std::move(textured.texels);
  }
  if (o.known && o.drawing.empty()) {
    for (FabricationFile& file : known_drawing_files(*o.known)) made.push_back(std::move(file));
  }
  for (const FabricationFile& file : made)
    files.artifacts.push_back(artifact_of(file.name, file.bytes));
  return files;
}

/// Adds a line of a view to a part, in the plane of the view through the origin.
void add_view_line(const std::vector<Eigen::Vector2d>& points, bool closed,
                   const Eigen::Matrix3d& frame, Part& part) {
  part.kind = Part::Kind::lines;
  const auto first = static_cast<int>(part.points.rows());
  part.points.conservativeResize(first + std::ssize(points), 3);
  std::vector<int>& line = part.lines.emplace_back();
  for (const Eigen::Vector2d& p : points) {
    line.push_back(first + static_cast<int>(line.size()));
    part.points.row(line.back()) = p.transpose() * frame.topRows<2>();
  }
  if (closed) line.push_back(first);
}

/// The strokes of all views that are lines.
Part strokes_in_space(const Drawing& drawing) {
  Part part;
  part.kind = Part::Kind::lines;
  std::vector<double> kinds, views, closed;
  for (const View& view : drawing.views) {
    for (const Stroke& stroke : view.strokes) {
      if (stroke.points.size() < 2) continue;  // a mark at a point
      add_view_line(stroke.points, stroke.closed, view_frame(view.kind), part);
      kinds.push_back(static_cast<double>(stroke.kind));
      views.push_back(static_cast<double>(view.kind));
      closed.push_back(stroke.closed ? 1 : 0);
    }
  }
  const auto add = [&](const char* name, const std::vector<double>& values) {
    part.arrays.push_back({name, "1", NamedArray::On::cells,
                           Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values))});
  };
  add("kind", kinds);
  add("view", views);
  add("closed", closed);
  return part;
}

void require_one_source(const SketchSceneOptions& options) {
  const bool drawn = !options.drawing.empty() || options.known;
  const int given = drawn + !options.surface.empty() + options.synthetic.has_value() +
                    options.closed_form.has_value() + options.layers.has_value() +
                    options.solid.has_value();
  if (given == 1) return;
  throw Error(std::to_string(given) + " of them are given",
              "scene.drawing (or scene.known), scene.surface, scene.synthetic, "
              "scene.closed_form, scene.layers and scene.solid",
              "one");
}

}  // namespace

void describe(OptionVisitor& v, SketchSceneOptions& o) {
  v.value("drawing", o.drawing, {.doc = "SVG file with the annotated views", .named = Named::file});
  v.value("photo", o.photo,
          {.doc = "picture (PNG, JPEG) that the one view was traced over: in the place of the "
                  "drawing's own, or over its whole page",
           .named = Named::file});
  v.value(
      "surface", o.surface,
      {.doc = "mesh file in place of a drawing, for methods that need none", .named = Named::file});
  describe_group(v, "synthetic", o.synthetic,
                 {.doc = "one view of a shape that is known, in place of a drawing"});
  describe_group(v, "closed_form", o.closed_form,
                 {.doc = "a surface of closed form, in place of a drawing"});
  describe_group(v, "layers", o.layers,
                 {.doc = "one view of a known body of rigid layers, in place of a drawing"});
  describe_group(v, "solid", o.solid,
                 {.doc = "several views of a thing whose area is known, in place of a drawing"});
  describe_group(v, "known", o.known,
                 {.doc = "the known object that the drawing shows; drawn here without a file"});
  v.value("surface_scale", o.surface_scale,
          {.doc = "metres for one unit of the surface's mesh file",
           .unit = "m",
           .min = 1e-9,
           .max = 1e9});
  describe_group(v, "read", o.read, {.doc = "how the drawing becomes strokes"});
  describe_group(v, "align", o.align, {.doc = "how views are put together"});
  describe_group(v, "hull", o.hull, {.doc = "the visual hull that all methods begin with"});
  describe_group(v, "smoothing", o.smoothing,
                 {.doc = "how the hull is smoothed before the first step"});
  describe_group(v, "pattern", o.pattern, {.doc = "how pieces are laid flat"});
  describe_group(v, "fabrication", o.fabrication, {.doc = "files to cut and sew by"});
  describe_group(v, "textures", o.textures,
                 {.doc = "files of one view that carry its photograph's colours"});
}

std::map<std::string, double> SketchScene::facts() const {
  std::map<std::string, double> facts;
  facts["views"] = static_cast<double>(silhouettes.size());
  facts["triangles_asked"] = input.hull.triangles;
  if (input.surface) facts["triangles"] = input.surface->triangle_count();
  return facts;
}

Frame SketchScene::given() const {
  Frame frame;
  if (input.surface) {
    Part& surface = frame.parts["surface"];
    surface.points = input.surface->V;
    surface.triangles = input.surface->F;
    return frame;
  }
  const Drawing& drawing = aligned.views.empty() ? input.drawing : aligned;
  frame.parts["strokes"] = strokes_in_space(drawing);
  // Those that methods see: what `silhouettes` holds is the truth.
  for (const OutlinedView& view : outlined_views(aligned)) {
    add_view_line(view.outline.points(), true, view.frame,
                  frame.parts[std::string("silhouette_") + view_name(view.kind)]);
  }
  TableBuilder views(
      {"view", "right_x", "right_y", "right_z", "up_x", "up_y", "up_z", "eye_x", "eye_y", "eye_z"});
  for (const View& view : drawing.views) {
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> directions = view_frame(view.kind);
    std::vector<double> row{static_cast<double>(view.kind)};
    row.insert(row.end(), directions.data(), directions.data() + directions.size());
    views.add(row);
  }
  frame.tables["views"] = views.finished();
  return frame;
}

std::vector<PartShape> SketchScene::frame_shape() const {
  return {{"surface", Part::Kind::triangles}};
}

const View& SketchScene::photo() const {
  const View* view = input.drawing.find(ViewKind::photo);
  if (view == nullptr) throw Error("has no view of kind photo", "scene", "a drawing with one view");
  return *view;
}

LayerFiles SketchScene::layer_files() const {
  LayerFiles files;
  if (!input.files) return files;
  files.pattern = input.files;
  files.joints = [](const ArticulatedLayers& layers) -> std::vector<Artifact> {
    return {artifact_of("layers.txt", joint_table(layers))};
  };
  files.motion = [](const LayerMotion& motion) -> std::vector<Artifact> {
    std::vector<GltfLink> links;
    for (const LayerMotion::Link& link : motion.links)
      links.push_back({link.name, link.solid, link.pivot, link.axis, link.angles});
    constexpr double kFrame = 0.125;  // s
    std::vector<double> times;
    for (std::size_t i = 0; i < motion.links.front().angles.size(); ++i)
      times.push_back(kFrame * static_cast<double>(i));
    return {artifact_of("layers.glb", rigid_chain_glb(links, times, "layers"))};
  };
  return files;
}

OneViewInput SketchScene::photo_input() const {
  return {photo(), input.pattern, input.patterns, photo_files};
}

std::shared_ptr<SketchScene> load_sketch_scene(const SketchSceneOptions& options,
                                               const std::filesystem::path& folder,
                                               std::uint64_t seed) {
  require_one_source(options);
  auto scene = std::make_shared<SketchScene>();
  scene->input.align = options.align;
  scene->input.hull = options.hull;
  scene->input.smoothing = options.smoothing;
  scene->input.pattern = options.pattern;
  if (options.fabrication) {
    scene->input.files = [fabrication = *options.fabrication](const Pattern& pattern,
                                                              const Eigen::MatrixX3d& surface) {
      return pattern_artifacts(pattern, surface, fabrication);
    };
  }
  if (options.fabrication || options.textures || options.known) {
    scene->photo_files = [options, picture = std::make_shared<DecodedPicture>()](
                             const View& view, const OneViewResult& result,
                             const Pattern& pattern) {
      return one_view_files(options, *picture, view, result, pattern);
    };
  }
  if (options.synthetic) {
    SyntheticViewOptions shape = *options.synthetic;
    shape.seed = static_cast<int>(scene_seed(seed, shape.seed));
    scene->truth = synthetic_view(shape);
    scene->input.drawing = {"scene.synthetic", {scene->truth->view}};
  } else if (options.closed_form) {
    scene->input.surface = closed_form_surface(*options.closed_form);
    scene->input.patterns = false;
  } else if (options.layers) {
    SyntheticLayerOptions body = *options.layers;
    body.seed = static_cast<int>(scene_seed(seed, body.seed));
    scene->truth = synthetic_layers(body);
    scene->input.drawing = {"scene.layers", {scene->truth->view}};
  } else if (options.solid) {
    KnownSolid solid = known_solid(*options.solid);
    scene->input.drawing = std::move(solid.drawing);
    scene->known_area = solid.area;
    align_drawing(options, *scene);
  } else if (!options.surface.empty()) {
    load_surface(options, folder, *scene);
    scene->input.patterns = false;
  } else if (!options.drawing.empty()) {
    load_drawing(options, folder, seed, *scene);
    if (options.textures && scene->input.drawing.find(ViewKind::photo) != nullptr)
      require_picture(*scene);
  }
  if (options.known) load_known(options, seed, *scene);
  if (options.textures) scene->background = known_background(*options.textures);
  return scene;
}

}  // namespace geoprior::sketch
