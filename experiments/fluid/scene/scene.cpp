#include "experiments/fluid/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include "core/error.h"
#include "core/limits.h"
#include "core/random.h"
#include "experiments/fluid/scene/edit_list.h"
#include "experiments/fluid/scene/feature_files.h"
#include "experiments/fluid/scene/ocean_sequence.h"
#include "testbed/given_tables.h"
#include "testbed/home.h"

namespace geoprior::fluid {
namespace {

namespace fs = std::filesystem;

/// What loading adds to.
struct Loading {
  fs::path folder;
  FluidScene& scene;
  std::uint64_t seed;  ///< of the experiment

  TriMesh read_mesh(const std::string& file, double scale, const std::string& where) {
    SequenceOptions still;
    still.path = find_file(file, folder, "data", where).string();
    still.scale = scale;
    still.frames_per_second = 1;
    return open_sequence(still, folder, scene.load_warnings, scene.input_files)->frame(0).mesh;
  }
};

Eigen::Vector3d direction(const std::array<double, 3>& axis, const std::string& where) {
  const Eigen::Vector3d a = to_vector(axis);
  if (!(a.norm() > 0)) throw Error("has no direction", where, "a vector of any length");
  return a.normalized();
}

LiquidShape make_shape(const LiquidShapeOptions& options, Loading& loading,
                       const std::string& where) {
  LiquidShape shape;
  shape.kind = options.kind;
  shape.centre = to_vector(options.centre);
  shape.half_size = to_vector(options.size) / 2;
  shape.radius = options.radius;
  shape.axis = direction(options.axis, where + ".axis");
  shape.half_length = options.length / 2;
  if (options.kind == LiquidShape::Kind::mesh) {
    shape.mesh = loading.read_mesh(options.file, options.scale, where + ".file");
    const Eigen::Matrix3d turn = to_rotation({0, 0, options.turn_z_deg}).toRotationMatrix();
    shape.mesh.V = (shape.mesh.V * turn.transpose()).rowwise() + shape.centre.transpose();
  }
  return shape;
}

constexpr double kMostCellsAlong = 1e6;

/// Whole cells along an edge. @throws Error  when the size is not a multiple of the cell
int cells_along(double size, double cell, const std::string& where) {
  const double cells = size / cell;
  const double whole = std::round(cells);
  require_count(whole, "cells", kMostCellsAlong, where);
  if (whole >= 1 && std::abs(cells - whole) < 1e-6 * whole) return static_cast<int>(whole);
  throw Error("is " + std::to_string(cells) + " cells long", where,
              "a whole number of cells of " + std::to_string(cell) + " m");
}

Tank make_tank(const TankOptions& options, const FluidSceneOptions& all, Loading& loading) {
  const std::string where = "scene.tank";
  Tank tank;
  tank.origin = to_vector(options.origin);
  tank.cell = options.cell;
  for (int axis = 0; axis < 3; ++axis) {
    tank.cells[axis] =
        cells_along(options.size[axis], options.cell, where + ".size." + std::to_string(axis));
  }
  tank.gravity = to_vector(all.gravity);
  tank.density = options.density;
  tank.open_top = options.open_top;
  tank.duration = all.duration;
  tank.frame_interval = all.frame_interval;
  const auto at = [&](const char* list, std::size_t i) {
    return where + "." + list + "." + std::to_string(i);
  };
  for (std::size_t i = 0; i < options.volumes.size(); ++i) {
    const LiquidVolumeOptions& o = options.volumes[i];
    tank.volumes.push_back(
        {o.name, make_shape(o.shape, loading, at("volumes", i) + ".shape"), to_vector(o.velocity)});
  }
  for (std::size_t i = 0; i < options.sources.size(); ++i) {
    const LiquidSourceOptions& o = options.sources[i];
    tank.sources.push_back({o.name, make_shape(o.shape, loading, at("sources", i) + ".shape"),
                            to_vector(o.velocity), o.from, o.until});
  }
  for (std::size_t i = 0; i < options.solids.size(); ++i) {
    const TankSolidOptions& o = options.solids[i];
    TankSolid solid{o.name, make_shape(o.shape, loading, at("solids", i) + ".shape"), {}};
    if (!o.keys.empty()) solid.motion = to_trajectory(o.keys, at("solids", i) + ".keys");
    tank.solids.push_back(std::move(solid));
  }
  return tank;
}

std::shared_ptr<const SurfaceSequence> still(TriMesh mesh, const std::string& name) {
  std::vector<SurfaceFrame> frames(1);
  frames.front().mesh = std::move(mesh);
  return std::make_shared<StoredSequence>(std::move(frames), name);
}

std::shared_ptr<const SurfaceSequence> make_target(const TargetOptions& options, Loading& loading) {
  FluidScene& scene = loading.scene;
  switch (options.kind) {
    case TargetKind::sequence:
      return open_sequence(options.sequence, loading.folder, scene.load_warnings,
                           scene.input_files);
    case TargetKind::ocean:
      require_vertices(vertices_of(options.ocean), "scene.target.ocean.samples");
      return std::make_shared<OceanSequence>(
          options.ocean, scene_seed(loading.seed, options.ocean_seed), scene.sculpt.times);
    case TargetKind::mesh: {
      TriMesh mesh = loading.read_mesh(options.file, options.scale, "scene.target.file");
      const Eigen::Matrix3d turn = to_rotation(options.turn_deg).toRotationMatrix();
      mesh.V = (mesh.V * turn.transpose()).rowwise() + to_vector(options.move).transpose();
      return still(std::move(mesh), options.file);
    }
    case TargetKind::injected:
      if (scene.injected) return scene.injected;
      throw Error("the scene has no injected animation", "scene.target.kind",
                  "a table scene.injected beside it");
  }
  throw Error("unknown kind of target", "scene.target", "sequence, mesh, ocean, injected");
}

void load_sources(const FluidSceneOptions& options, Loading& loading) {
  SculptScene& sculpt = loading.scene.sculpt;
  const auto require_new = [&](const std::string& name, const std::string& where) {
    if (sculpt.sources.count(name) + sculpt.libraries.count(name) > 0) {
      throw Error("the name '" + name + "' is taken", where, "a name of its own");
    }
  };
  if (options.injected) {
    InjectedOptions injected = *options.injected;
    injected.seed = scene_seed(loading.seed);
    loading.scene.injected = std::make_shared<InjectedSequence>(injected);
    require_vertices(loading.scene.injected->layer_nodes(), "scene.injected.resolution");
    loading.scene.injected_resolution = options.injected->resolution;
    sculpt.sources["injected"] = loading.scene.injected;
  }
  for (std::size_t i = 0; i < options.sequences.size(); ++i) {
    const NamedSequenceOptions& o = options.sequences[i];
    require_new(o.name, "scene.sequences." + std::to_string(i) + ".name");
    const auto sequence = open_sequence(o.sequence, loading.folder, loading.scene.load_warnings,
                                        loading.scene.input_files);
    if (sequence->frame_count() == 1) {
      loading.scene.load_warnings.push_back(o.sequence.path +
                                            ": has one frame: nothing is tracked through time");
    }
    sculpt.sources[o.name] = sequence;
  }
  for (std::size_t i = 0; i < options.libraries.size(); ++i) {
    const LibraryOptions& o = options.libraries[i];
    const std::string where = "scene.libraries." + std::to_string(i);
    require_new(o.name, where + ".name");
    const fs::path file = find_file(o.path, loading.folder, "data", where + ".path");
    loading.scene.input_files.push_back(file);
    sculpt.libraries[o.name] = read_feature_library(file);
  }
}

/// @param place  of the edit: key of the scene, or file
void require_edit(const std::vector<Edit>& edits, std::size_t i, const SculptScene& sculpt,
                  const std::string& place) {
  const Edit& edit = edits[i];
  try {
    require_valid(edit);
  } catch (const Error& e) {
    throw Error(e.what(), place);
  }
  const auto same_name = [&](const Edit& other) { return other.name == edit.name; };
  const auto end = edits.begin() + i;
  if (!edit.name.empty() && std::any_of(edits.begin(), end, same_name)) {
    throw Error("the name '" + edit.name + "' is taken", place + ".name", "a name of its own");
  }
  if (sculpt.sources.count(edit.source) + sculpt.libraries.count(edit.source) > 0) return;
  // The only source need not be named.
  if (edit.source.empty() && sculpt.sources.size() + sculpt.libraries.size() == 1) return;
  std::string known;
  for (const auto& [name, sequence] : sculpt.sources) known += (known.empty() ? "" : ", ") + name;
  for (const auto& [name, features] : sculpt.libraries) known += (known.empty() ? "" : ", ") + name;
  throw Error("edit '" + edit.name + "' takes features from '" + edit.source + "'",
              place + ".source", known.empty() ? "a sequence or library of the scene" : known);
}

void load_edits(const FluidSceneOptions& options, Loading& loading) {
  SculptScene& sculpt = loading.scene.sculpt;
  sculpt.edits = options.edits;
  std::string list;
  if (options.edit_list) {
    const fs::path file = find_file(*options.edit_list, loading.folder, "data", "scene.edit_list");
    loading.scene.input_files.push_back(file);
    const std::vector<Edit> more = read_edit_list(file);
    sculpt.edits.insert(sculpt.edits.end(), more.begin(), more.end());
    list = file.string();
  }
  for (std::size_t i = 0; i < sculpt.edits.size(); ++i) {
    const std::size_t in_scene = options.edits.size();
    require_edit(sculpt.edits, i, sculpt,
                 i < in_scene ? "scene.edits." + std::to_string(i)
                              : list + ": edit." + std::to_string(i - in_scene));
  }
}

/// Gauges and cell of a scene, from its tank or from the first frame of an animation.
void place_gauges(FluidScene& scene) {
  if (scene.tank) {
    const Tank& tank = *scene.tank;
    scene.cell = tank.cell;
    scene.gauges = ColumnGrid{tank.origin.head<2>(), tank.cell, tank.cells.x(), tank.cells.y()};
    return;
  }
  std::shared_ptr<const SurfaceSequence> animation = scene.sculpt.target;
  if (!animation && !scene.sculpt.sources.empty()) {
    animation = scene.sculpt.sources.begin()->second;
  }
  if (!animation) return;
  const TriMesh mesh = animation->frame(0).mesh;
  if (mesh.triangle_count() == 0) return;
  double length = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    length += (mesh.V.row(mesh.F(t, 0)) - mesh.V.row(mesh.F(t, 1))).norm();
  }
  scene.cell = length / mesh.triangle_count();
  constexpr double kMostGauges = 256;
  const Eigen::RowVector3d size = mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff();
  scene.gauges =
      covering_grid(mesh.V, std::max(scene.cell, std::max(size.x(), size.y()) / kMostGauges));
}

/// Bodies of a tank as a table "volumes", "sources" or "solids", those that are meshes as parts.
class GivenBodies {
 public:
  explicit GivenBodies(std::string name)
      : name_(std::move(name)),
        rows_({"kind", "centre_x [m]", "centre_y [m]", "centre_z [m]", "half_x [m]", "half_y [m]",
               "half_z [m]", "radius [m]", "axis_x", "axis_y", "axis_z", "half_length [m]",
               "velocity_x [m/s]", "velocity_y [m/s]", "velocity_z [m/s]", "from [s]",
               "until [s]"}) {}

  /// @param velocity  of the liquid that is put there, from one time to the other
  void add(const LiquidShape& s, Frame& frame,
           const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero(), double from = 0,
           double until = 0) {
    std::vector<double> row{static_cast<double>(s.kind)};
    const auto append = [&row](const Eigen::Vector3d& v) {
      row.insert(row.end(), v.begin(), v.end());
    };
    append(s.centre);
    append(s.half_size);
    row.push_back(s.radius);
    append(s.axis);
    row.push_back(s.half_length);
    append(velocity);
    row.insert(row.end(), {from, until});
    rows_.add(row);
    if (s.kind == LiquidShape::Kind::mesh) {
      Part& part = frame.parts[numbered(name_, count_)];
      part.points = s.mesh.V;
      part.triangles = s.mesh.F;
    }
    ++count_;
    frame.tables[name_ + "s"] = rows_.finished();
  }

 private:
  std::string name_;
  TableBuilder rows_;
  int count_ = 0;
};

void give_tank(const Tank& tank, const std::vector<double>& times, Frame& frame) {
  TableBuilder room({"x [m]", "y [m]", "z [m]", "cells_x", "cells_y", "cells_z", "cell [m]",
                     "gravity_x [m/s^2]", "gravity_y [m/s^2]", "gravity_z [m/s^2]",
                     "density [kg/m^3]", "open_top"});
  const Eigen::Vector3d &o = tank.origin, &g = tank.gravity, n = tank.cells.cast<double>();
  room.add({o.x(), o.y(), o.z(), n.x(), n.y(), n.z(), tank.cell, g.x(), g.y(), g.z(), tank.density,
            tank.open_top ? 1.0 : 0.0});
  frame.tables["tank"] = room.finished();
  GivenBodies volumes("volume"), sources("source"), solids("solid");
  for (const LiquidVolume& v : tank.volumes) volumes.add(v.shape, frame, v.velocity);
  for (const LiquidSource& s : tank.sources)
    sources.add(s.shape, frame, s.velocity, s.from, s.until);
  TableBuilder moved(with_transform_columns({"frame", "solid"}));
  for (std::size_t s = 0; s < tank.solids.size(); ++s) {
    const TankSolid& solid = tank.solids[s];
    solids.add(solid.shape, frame);
    if (!solid.motion) continue;
    const ShapeDistance distance(solid.shape, tank.cell);
    for (std::size_t i = 0; i < times.size(); ++i) {
      moved.add(with_transform({static_cast<double>(i), static_cast<double>(s)},
                               place_solid(solid, distance, times[i], 0).placement));
    }
  }
  frame.tables["solid_transforms"] = moved.finished();
}

}  // namespace

const Tank& FluidScene::require_tank(const std::string& who) const {
  if (!tank) {
    throw Error(who + " has nothing to simulate", "scene.tank", "a table that gives the tank");
  }
  if (tank->volumes.empty() && tank->sources.empty()) {
    throw Error(who + " has no liquid to simulate", "scene.tank", "volumes or sources");
  }
  return *tank;
}

std::map<std::string, double> FluidScene::facts() const {
  std::map<std::string, double> facts{
      {"sources", static_cast<double>(sculpt.sources.size() + sculpt.libraries.size())},
      {"edits", static_cast<double>(sculpt.edits.size())}};
  if (tank) {
    facts["cells"] = tank->cells.cast<double>().prod();
    facts["frames"] = tank->frame_count();
  }
  if (sculpt.target) facts["target_frames"] = sculpt.target->frame_count();
  return facts;
}

Frame FluidScene::given() const {
  Frame frame;
  std::vector<double> times = sculpt.times;
  if (tank) {
    times.clear();
    for (int i = 0; i < tank->frame_count(); ++i) times.push_back(tank->frame_time(i));
    give_tank(*tank, times, frame);
  }
  frame.tables["frames"] = frame_times(times);
  return frame;
}

std::vector<PartShape> FluidScene::frame_shape() const {
  return {{"surface", Part::Kind::triangles}};
}

std::optional<double> FluidScene::dam_width() const {
  if (!tank || tank->volumes.size() != 1 || !tank->solids.empty() || !tank->sources.empty()) {
    return {};
  }
  const LiquidShape& shape = tank->volumes.front().shape;
  const double wall = tank->origin.x();
  const double low = shape.centre.x() - shape.half_size.x();
  const double high = shape.centre.x() + shape.half_size.x();
  const double far_wall = wall + tank->cells.x() * tank->cell;
  if (shape.kind != LiquidShape::Kind::box || low > wall + 1e-9 || high > far_wall - tank->cell) {
    return {};
  }
  return high - wall;
}

std::shared_ptr<FluidScene> load_fluid_scene(const FluidSceneOptions& options,
                                             const fs::path& folder, std::uint64_t seed) {
  auto scene = std::make_shared<FluidScene>();
  Loading loading{folder, *scene, seed};
  scene->duration = options.duration;
  scene->frame_interval = options.frame_interval;
  scene->gravity = to_vector(options.gravity);
  if (scene->gravity.norm() > 0) scene->sculpt.up = -scene->gravity.normalized();
  require_frames(options.duration, options.frame_interval, "scene.duration");
  const int frames =
      1 + static_cast<int>(std::floor(options.duration / options.frame_interval + 1e-9));
  for (int i = 0; i < frames; ++i) {
    scene->sculpt.times.push_back(options.start + i * options.frame_interval);
  }
  if (options.tank) {
    scene->tank = make_tank(*options.tank, options, loading);
    require_valid(*scene->tank, 1, memory_limit(), "scene.tank");
  }
  load_sources(options, loading);
  if (options.target) scene->sculpt.target = make_target(*options.target, loading);
  load_edits(options, loading);
  place_gauges(*scene);
  return scene;
}

}  // namespace geoprior::fluid
