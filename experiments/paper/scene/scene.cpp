#include "experiments/paper/scene/scene.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "experiments/paper/scene/drawn_surface.h"
#include "experiments/paper/scene/fast_handles.h"
#include "experiments/paper/scene/make_sheet.h"
#include "experiments/paper/scene/pulled_apart.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/paper/sheet/valid.h"
#include "testbed/given_tables.h"
#include "testbed/keyframes.h"

namespace geoprior::paper {
namespace {

/// The waves of the start may dip into an obstacle that the flat sheet only touches.
void warn_of_waves(PaperScene& scene) {
  const Sheet& sheet = scene.sheet;
  if (sheet.imperfection <= 0) return;
  for (std::size_t i = 0; i < sheet.obstacles.size(); ++i) {
    const Obstacle& obstacle = sheet.obstacles[i];
    const auto near = start_nearer_than(sheet, obstacle, sheet.imperfection);
    if (!near) continue;
    std::ostringstream text;
    text << "scene.obstacles." << i << (obstacle.name.empty() ? "" : " '" + obstacle.name + "'")
         << " is nearer to the flat start of the sheet than its waves are high"
         << " (scene.imperfection = " << sheet.imperfection << " m), at the pattern point ("
         << near->x() << ", " << near->y() << ") m: they begin inside of it and are pushed out; "
         << "move one of them " << sheet.imperfection << " m away, or set imperfection = 0";
    scene.load_warnings.push_back(text.str());
  }
}

/// The sheet before it moves, on a mesh that has vertices where handles hold it.
Part flat_sheet(const Sheet& sheet) {
  constexpr int kTriangles = 2000;
  const double edge = equilateral_edge(signed_area(sheet.pattern), kTriangles);
  require_lattice(sheet.pattern, edge);
  const ShellMesh mesh = uniform_mesh(sheet.pattern, kTriangles, UniformLayout::automatic,
                                      handle_points(sheet, edge), 1);
  Part part;
  part.triangles = mesh.triangles;
  part.points.resize(mesh.vertex_count(), 3);
  NamedArray handle{"handle", "1", NamedArray::On::points,
                    Eigen::MatrixXd::Constant(mesh.vertex_count(), 1, -1)};
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Eigen::Vector2d p = mesh.pattern.row(v);
    part.points.row(v) = sheet.placement * Eigen::Vector3d(p.x(), p.y(), 0);
    const auto holds = [&](const Handle& h) { return h.covers(p); };
    const auto first = std::find_if(sheet.handles.begin(), sheet.handles.end(), holds);
    if (first == sheet.handles.end()) continue;
    handle.values(v, 0) = static_cast<double>(first - sheet.handles.begin());
  }
  part.arrays = {{"pattern", "m", NamedArray::On::points, mesh.pattern}, std::move(handle)};
  return part;
}

Part pattern_outline(const Pattern& pattern) {
  Part part;
  part.kind = Part::Kind::lines;
  std::vector<double> kinds;
  const auto add = [&](const std::vector<Eigen::Vector2d>& points, bool closed, double kind) {
    const auto first = static_cast<int>(part.points.rows());
    part.points.conservativeResize(first + std::ssize(points), 3);
    std::vector<int>& line = part.lines.emplace_back();
    for (const Eigen::Vector2d& p : points) {
      line.push_back(first + static_cast<int>(line.size()));
      part.points.row(line.back()) << p.x(), p.y(), 0;
    }
    if (closed) line.push_back(first);
    kinds.push_back(kind);
  };
  add(pattern.border, true, 0);
  for (const auto& hole : pattern.holes) add(hole, true, 1);
  for (const auto& cut : pattern.cuts) add(cut, false, 2);
  part.arrays.push_back({"kind", "1", NamedArray::On::cells,
                         Eigen::Map<const Eigen::VectorXd>(kinds.data(), std::ssize(kinds))});
  return part;
}

/// Moves what a handle holds from where the flat sheet starts, as `Handle::target`.
Eigen::Isometry3d handle_transform(const Handle& handle, const Eigen::Isometry3d& placement,
                                   double time) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  const std::vector<Eigen::Vector2d> anchors = handle.anchors();
  for (const Eigen::Vector2d& p : anchors) centre += placement * Eigen::Vector3d(p.x(), p.y(), 0);
  centre /= static_cast<double>(anchors.size());
  const Keyframe key = handle.motion->at(time);
  return Eigen::Translation3d(centre + key.shift) * key.turn * Eigen::Translation3d(-centre);
}

}  // namespace

std::map<std::string, double> PaperScene::facts() const {
  return {{"pattern_area", signed_area(sheet.pattern)},
          {"pattern_width", width(sheet.pattern)},
          {"pattern_corners", static_cast<double>(corners(sheet.pattern).size())},
          {"handles", static_cast<double>(sheet.handles.size())},
          {"obstacles", static_cast<double>(sheet.obstacles.size())},
          {"frames", static_cast<double>(sheet.frame_count())},
          {"membrane_stiffness", sheet.material.membrane_stiffness()},
          {"bending_stiffness", sheet.material.bending_stiffness()}};
}

Frame PaperScene::given() const {
  Frame frame;
  frame.parts["sheet"] = flat_sheet(sheet);
  frame.parts["outline"] = pattern_outline(sheet.pattern);
  std::vector<double> times;
  for (int i = 0; i < sheet.frame_count(); ++i) times.push_back(sheet.frame_time(i));
  frame.tables["frames"] = frame_times(times);
  TableBuilder moved(with_transform_columns({"frame", "handle", "holds"}));
  TableBuilder forces({"handle", "x [N]", "y [N]", "z [N]"});
  for (std::size_t h = 0; h < sheet.handles.size(); ++h) {
    const Handle& handle = sheet.handles[h];
    const auto number = static_cast<double>(h);
    if (const auto& force = handle.force) forces.add({number, force->x(), force->y(), force->z()});
    if (!handle.motion) continue;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double holds = handle.is_active(times[i]) ? 1 : 0;
      moved.add(with_transform({static_cast<double>(i), number, holds},
                               handle_transform(handle, sheet.placement, times[i])));
    }
  }
  frame.tables["handle_transforms"] = moved.finished();
  frame.tables["handle_forces"] = forces.finished();
  return frame;
}

std::vector<PartShape> PaperScene::frame_shape() const {
  return {{"surface", Part::Kind::triangles}};
}

std::vector<Artifact> PaperScene::files_of(Frame& frame) const {
  add_drawn_surface(frame);
  return {};
}

Sheet make_sheet(const PaperSceneOptions& options, const Pattern& pattern, std::uint64_t seed) {
  Sheet sheet;
  sheet.pattern = pattern;
  sheet.material = options.material;
  sheet.toughness = make_toughness(options.toughness, seed);
  for (std::size_t i = 0; i < options.handles.size(); ++i) {
    sheet.handles.push_back(make_handle(options.handles[i], "scene.handles." + std::to_string(i)));
  }
  sheet.obstacles = make_obstacles(options.obstacles);
  sheet.gravity = to_vector(options.gravity);
  sheet.placement = Eigen::Isometry3d::Identity();
  sheet.placement.translate(to_vector(options.placement.move))
      .rotate(to_rotation(options.placement.turn_deg));
  sheet.imperfection = options.imperfection;
  sheet.duration = options.duration;
  sheet.frame_interval = options.frame_interval;
  sheet.substeps = options.substeps;
  sheet.handle_step = options.handle_step;
  return sheet;
}

std::shared_ptr<PaperScene> load_paper_scene(const PaperSceneOptions& options,
                                             const std::filesystem::path& folder,
                                             std::uint64_t seed) {
  auto scene = std::make_shared<PaperScene>();
  const Pattern pattern =
      make_pattern(options.pattern, folder, scene->input_files, scene->load_warnings);
  scene->sheet = make_sheet(options, pattern, seed);
  scene->fold_radius = options.fold_radius;
  require_valid(scene->sheet, "scene");
  // Ten times what the imperfection may add.
  constexpr double kStretch = 1e-3;
  // What tears gives way.
  const bool holds = !scene->sheet.toughness.tears();
  if (const auto worst = holds ? worst_pulled_apart(scene->sheet, kStretch) : std::nullopt) {
    scene->load_warnings.push_back(warning_text(scene->sheet, *worst, "scene"));
  }
  if (auto text = fast_handle_warning(scene->sheet, "scene")) {
    scene->load_warnings.push_back(*std::move(text));
  }
  warn_of_waves(*scene);
  return scene;
}

}  // namespace geoprior::paper
