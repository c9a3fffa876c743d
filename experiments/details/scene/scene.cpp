#include "experiments/details/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/limits.h"
#include "experiments/details/scene/frame_parts.h"
#include "experiments/details/scene/position_file.h"
#include "models/details/process.h"
#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/given_tables.h"
#include "testbed/home.h"

namespace geoprior::details {
namespace {

namespace fs = std::filesystem;

/// What loading adds to.
struct Loading {
  const DetailSceneOptions& options;
  fs::path folder;
  DetailsScene& result;
  std::uint64_t seed;                               ///< of the experiment
  std::shared_ptr<const SurfaceSequence> sequence;  ///< of `motion`, or null

  void load_surface() {
    DetailScene& scene = result.input;
    const DetailSurfaceOptions& o = options.surface;
    if (o.kind == DetailSurfaceKind::sequence) {
      if (!sequence) throw Error("there is none", "scene.motion.sequence", "a mesh sequence");
      scene.surface = sequence->frame(0).mesh;
      scene.name = sequence->name();
    } else if (o.kind == DetailSurfaceKind::file) {
      load_file(o);
    } else {
      scene.surface = make_surface(o);
      scene.name = "scene.surface";
    }
  }

  void load_file(const DetailSurfaceOptions& o) {
    SequenceOptions still;
    still.path = find_file(o.file, folder, "data", "scene.surface.file").string();
    still.scale = o.scale;
    still.frames_per_second = 1;
    still.up = UpAxis::z;
    TriMesh mesh =
        open_sequence(still, folder, result.load_warnings, result.input_files)->frame(0).mesh;
    mesh.V = mesh.V * to_rotation(o.turn_deg).toRotationMatrix().transpose();
    result.input.surface = std::move(mesh);
    result.input.name = still.path;
  }

  [[nodiscard]] Eigen::VectorXd density() const {
    const DensityOptions& o = options.pattern.density;
    const TriMesh& surface = result.input.surface;
    if (o.kind != DensityKind::array) return gradient_density(surface, o);
    const std::string where = "scene.pattern.density.array";
    const fs::path file = options.surface.file;
    if (options.surface.kind != DetailSurfaceKind::file || file.extension() != ".vtp") {
      throw Error("is in no file", where, "with scene.surface.file, a .vtp");
    }
    std::optional<double> time;
    const Part part =
        read_foreign_vtk_part(find_file(file.string(), folder, "data", "scene.surface.file"), time);
    const NamedArray* array = part.find_array(o.array);
    if (array == nullptr || array->on != NamedArray::On::points || array->values.cols() != 1) {
      throw Error("there is no array '" + o.array + "'", where, "one number a point");
    }
    if (array->values.rows() != surface.V.rows()) {
      throw Error("has " + std::to_string(array->values.rows()) + " values", where,
                  "as many as vertices after welding: " + std::to_string(surface.V.rows()));
    }
    if (!array->values.allFinite() || array->values.minCoeff() < 0)
      throw Error("has values that are no density", where, "finite, not negative");
    return array->values.col(0);
  }

  void load_details() {
    DetailScene& scene = result.input;
    const DetailPatternOptions& o = options.pattern;
    result.region = faces_of_region(scene.surface, o.region);
    if (o.kind == PatternKind::file) {
      const fs::path file = find_file(o.file, folder, "data", "scene.pattern.file");
      result.input_files.push_back(file);
      const double far = o.max_distance.value_or(0.01 * bounding_box_diagonal(scene.surface.V));
      scene.details = details_of_file(file, scene.surface, far, result.load_warnings);
      if (o.aligned) align(scene.details);
      return;
    }
    const Eigen::VectorXd relative = density();
    scene.details = scatter(scene.surface, o, relative, seed);
    for (int i = 1; i <= kResamples; ++i) {
      DetailPatternOptions again = o;
      again.seed += i * kSeedStep;
      result.resamples.push_back(scatter(scene.surface, again, relative, seed));
    }
    // A twentieth less is what chance explains; more is a pattern that does not fit.
    const double share = static_cast<double>(scene.details.size()) / o.count;
    if (share < 0.95) {
      result.load_warnings.push_back("scene.pattern: " + std::to_string(scene.details.size()) +
                                     " details of " + std::to_string(o.count) +
                                     " found a place: a smaller radius, a larger region");
    }
  }

  void load_drawing() {
    result.drawing = options.drawing;
    if (!options.drawing) return;
    const DrawingOptions& look = options.drawing->look;
    if (look.kind == DrawnKind::mesh && look.instance.shape == InstanceShape::given) {
      const fs::path file = find_file(options.drawing->file, folder, "data", "scene.drawing.file");
      for (const fs::path& piece : files_of_mesh(file)) result.input_files.push_back(piece);
      result.instance = read_mesh_file(file, result.load_warnings).mesh;
    }
    require_drawable(look, result.input.details.size(), result.instance);
  }

  void align(std::vector<Detail>& details) const {
    const TriMesh& surface = result.input.surface;
    const SurfaceTopology topology(surface);
    std::vector<Eigen::Vector3d> x;
    for (Eigen::Index v = 0; v < surface.V.rows(); ++v) x.emplace_back(surface.V.row(v));
    const Eigen::Vector3d direction = to_vector(options.pattern.direction);
    for (Detail& d : details) d.tangent_angle = tangent_angle(d.at.face, direction, topology, x);
  }

  /// What is dragged or read is kept, one position a vertex and frame.
  void require_positions(int frames, const std::string& where) const {
    const int vertices = result.input.surface.vertex_count();
    require_memory(static_cast<double>(frames) * vertices * 3 * sizeof(double), frames,
                   "frames of " + std::to_string(vertices) + " vertices", where);
  }

  void load_motion() {
    const DetailMotionOptions& o = options.motion;
    DetailScene& scene = result.input;
    if (sequence) {
      require_positions(sequence->frame_count(), "scene.motion.sequence");
      if (!o.deform.empty() || o.drag)
        throw Error("stands beside a sequence", "scene.motion", "sequence, or deform and drag");
      scene.motion = motion_of_sequence(*sequence);
      return;
    }
    std::vector<double> times;
    for (int i = 0; i <= o.frames; ++i) times.push_back(o.duration * i / o.frames);
    std::shared_ptr<const SurfaceMotion> base =
        std::make_shared<StoredMotion>(std::vector{scene.surface.V}, std::vector{0.0});
    if (o.drag) require_positions(o.frames + 1, "scene.motion.frames");
    if (o.drag) base = drag_handles(scene.surface, *o.drag, times);
    scene.motion = std::make_shared<ScriptedMotion>(scene.surface, base, o.deform, times);
  }

  static constexpr int kResamples = 3;
  static constexpr int kSeedStep = 1000003;  ///< between the seeds of the pattern and of these
};

}  // namespace

const Frame& DetailsScene::rest() const {
  std::call_once(rest_made_, [&] {
    rest_ =
        detail_frame(build_detail_mesh(input.surface, input.details), input.motion->parameter(0));
  });
  return rest_;
}

double DetailsScene::rest_edge() const {
  return spacing_of(rest().require_part("detail_mesh"), 0).mean;
}

bool DetailsScene::is_one_of(int count, double parameter) const {
  const int last = input.motion->frame_count() - 1;
  for (int i = 1; i <= count; ++i) {
    const auto frame = static_cast<int>(std::lround(static_cast<double>(last) * i / count));
    // Recorded parameters went through text.
    if (std::abs(input.motion->parameter(frame) - parameter) <= 1e-9 * std::abs(parameter))
      return true;
  }
  return false;
}

bool DetailsScene::measures_pairs(double parameter) const {
  return is_one_of(pair_frames, parameter);
}

bool DetailsScene::is_drawn(double parameter) const {
  if (!drawing) return false;
  return parameter == input.motion->parameter(0) || is_one_of(drawing->frames, parameter);
}

bool DetailsScene::measures_drawn_pop(double parameter) const {
  return drawing && is_one_of(drawing->pop_frames, parameter);
}

std::map<std::string, double> DetailsScene::facts() const {
  const Eigen::VectorXd areas = triangle_areas(input.surface.V, input.surface.F);
  return {{"vertices", static_cast<double>(input.surface.vertex_count())},
          {"triangles", static_cast<double>(input.surface.triangle_count())},
          {"area", areas.sum()},
          {"details", static_cast<double>(input.details.size())},
          {"frames", static_cast<double>(input.motion->frame_count())}};
}

Frame DetailsScene::given() const {
  Frame frame;
  Part& surface = frame.parts["surface"] = rest().require_part("surface");
  const Eigen::Map<const Eigen::Matrix<char, Eigen::Dynamic, 1>> inside(region.data(),
                                                                        std::ssize(region));
  surface.arrays.push_back({"region", "1", NamedArray::On::cells, inside.cast<double>()});
  for (const char* part : {"details", "detail_mesh"}) frame.parts[part] = rest().require_part(part);
  std::vector<double> times;
  for (int i = 0; i < input.motion->frame_count(); ++i) {
    times.push_back(input.motion->parameter(i));
    Part& moved = frame.parts[numbered("motion", i)];
    moved.kind = Part::Kind::points;
    moved.points = input.motion->positions(i);
  }
  frame.tables["frames"] = frame_times(times);
  return frame;
}

std::vector<PartShape> DetailsScene::frame_shape() const {
  return {{"surface", Part::Kind::triangles, input.surface.vertex_count(), input.surface.F},
          {"details", Part::Kind::points},
          {"detail_mesh", Part::Kind::triangles},
          {"visible_mesh", Part::Kind::triangles}};
}

std::shared_ptr<DetailsScene> load_details_scene(const DetailSceneOptions& options,
                                                 const fs::path& folder, std::uint64_t seed) {
  auto scene = std::make_shared<DetailsScene>();
  Loading loading{options, folder, *scene, seed, nullptr};
  if (options.motion.sequence) {
    if (options.surface.kind != DetailSurfaceKind::sequence) {
      throw Error("is not the one that moves", "scene.surface.kind",
                  "sequence, with scene.motion.sequence");
    }
    loading.sequence =
        open_sequence(*options.motion.sequence, folder, scene->load_warnings, scene->input_files);
  }
  loading.load_surface();
  loading.load_details();
  loading.load_motion();
  scene->chosen_height = options.detail_height;
  scene->pair_frames = options.pair_frames;
  scene->pair_sources = options.pair_sources;
  loading.load_drawing();
  require_valid(scene->input);
  return scene;
}

}  // namespace geoprior::details
