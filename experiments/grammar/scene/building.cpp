#include "experiments/grammar/scene/building.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/random.h"
#include "models/grammar/objects/building_layout.h"

namespace geoprior::grammar {
namespace {

constexpr double kWallThickness = 0.25;  ///< m
constexpr double kOpeningFrame = 0.07;   ///< width of a window's frame (m)

using BuildingKeyList = std::vector<Eigen::Vector3d>;
using BuildingValues = std::span<const double>;

/// Triangles that grow box by box.
class BuildingMesh {
 public:
  void box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    std::array<int, 8> v{};
    for (int i = 0; i < 8; ++i)
      v[i] = vertex({(i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                     (i & 4) != 0 ? high.z() : low.z()});
    quad(v[0], v[2], v[3], v[1]);
    quad(v[4], v[5], v[7], v[6]);
    quad(v[0], v[1], v[5], v[4]);
    quad(v[2], v[6], v[7], v[3]);
    quad(v[0], v[4], v[6], v[2]);
    quad(v[1], v[3], v[7], v[5]);
  }
  int vertex(const Eigen::Vector3d& x) {
    vertices_.push_back(x);
    return static_cast<int>(vertices_.size()) - 1;
  }
  void triangle(int a, int b, int c) { triangles_.emplace_back(a, b, c); }
  void quad(int a, int b, int c, int d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }
  [[nodiscard]] TriMesh mesh() const {
    TriMesh out;
    out.V.resize(static_cast<int>(vertices_.size()), 3);
    out.F.resize(static_cast<int>(triangles_.size()), 3);
    for (int i = 0; i < out.vertex_count(); ++i) out.V.row(i) = vertices_[i];
    for (int i = 0; i < out.triangle_count(); ++i) out.F.row(i) = triangles_[i];
    return out;
  }

 private:
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

/// A cornice under the ceiling, which is a slab, and a base course.
TriMesh storey_mesh(BuildingValues p) {
  const double w = p[StoreyParameter::width] / 2, d = p[StoreyParameter::depth] / 2;
  const double h = p[StoreyParameter::height], base = p[StoreyParameter::base];
  BuildingMesh out;
  out.box({-w - 0.05, -d - 0.05, h - 0.22}, {w + 0.05, d + 0.05, h - 0.1});
  out.box({-w - 0.12, -d - 0.12, h - 0.1}, {w + 0.12, d + 0.12, h});
  if (base > 0) out.box({-w - 0.04, -d - 0.04, 0}, {w + 0.04, d + 0.04, base});
  return out.mesh();
}

TriMesh wall_mesh(BuildingValues p) {
  BuildingMesh out;
  out.box({0, 0, 0}, {p[WallParameter::length], kWallThickness, p[WallParameter::height]});
  return out.mesh();
}

/// Four bars about an opening of half sizes w and h, from `front` of the wall to its face.
void add_opening_frame(BuildingMesh& out, double w, double h, double bar, double front) {
  out.box({-w, -front, -h}, {-w + bar, 0.05, h});
  out.box({w - bar, -front, -h}, {w, 0.05, h});
  out.box({-w + bar, -front, h - bar}, {w - bar, 0.05, h});
  out.box({-w + bar, -front, -h}, {w - bar, 0.05, -h + bar});
}

TriMesh window_mesh(BuildingValues p) {
  const double w = p[OpeningParameter::width] / 2, h = p[OpeningParameter::height] / 2;
  const double bar = std::min(kOpeningFrame, std::min(w, h) / 3);
  BuildingMesh out;
  add_opening_frame(out, w, h, bar, 0.06);
  out.box({-w + bar, -0.02, -h + bar}, {w - bar, 0.02, h - bar});
  // A mullion, a transom and a sill.
  out.box({-bar / 3, -0.04, -h + bar}, {bar / 3, -0.02, h - bar});
  out.box({-w + bar, -0.04, 0.35 * h}, {w - bar, -0.02, 0.35 * h + 2 * bar / 3});
  out.box({-w - 0.05, -0.14, -h - 0.06}, {w + 0.05, 0, -h});
  return out.mesh();
}

TriMesh door_mesh(BuildingValues p) {
  const double w = p[OpeningParameter::width] / 2, h = p[OpeningParameter::height] / 2;
  const double bar = std::min(1.4 * kOpeningFrame, std::min(w, h) / 3);
  BuildingMesh out;
  add_opening_frame(out, w, h, bar, 0.1);
  out.box({-w + bar, -0.05, -h}, {w - bar, 0.02, h - bar});
  out.box({-w + 2 * bar, -0.07, -0.8 * h}, {w - 2 * bar, -0.05, -0.1 * h});
  out.box({-w + 2 * bar, -0.07, 0.05 * h}, {w - 2 * bar, -0.05, 0.75 * h});
  // A step and a canopy.
  out.box({-w - 0.2, -0.6, -h}, {w + 0.2, 0, -h + 0.12});
  out.box({-w - 0.2, -0.5, h + 0.02}, {w + 0.2, 0, h + 0.1});
  return out.mesh();
}

void roof_keys(BuildingValues p, BuildingKeyList& out) {
  const double w = p[RoofParameter::width] / 2 + p[RoofParameter::eaves];
  const double d = p[RoofParameter::depth] / 2 + p[RoofParameter::eaves];
  out.insert(out.end(),
             {{-w, -d, 0}, {w, -d, 0}, {w, d, 0}, {-w, d, 0}, {0, 0, p[RoofParameter::rise]}});
}

/// A hipped roof on a board; the ridge lies along the longer side.
TriMesh roof_mesh(BuildingValues p) {
  constexpr double kBoard = 0.14;
  const double w = p[RoofParameter::width] / 2 + p[RoofParameter::eaves];
  const double d = p[RoofParameter::depth] / 2 + p[RoofParameter::eaves];
  const bool along_x = w >= d;
  const double ridge = p[RoofParameter::ridge] * (along_x ? w : d), rise = p[RoofParameter::rise];
  BuildingMesh out;
  out.box({-w, -d, 0}, {w, d, kBoard});
  const int a = out.vertex({-w, -d, kBoard}), b = out.vertex({w, -d, kBoard});
  const int c = out.vertex({w, d, kBoard}), e = out.vertex({-w, d, kBoard});
  const int low =
      out.vertex(along_x ? Eigen::Vector3d(-ridge, 0, rise) : Eigen::Vector3d(0, -ridge, rise));
  const int high =
      out.vertex(along_x ? Eigen::Vector3d(ridge, 0, rise) : Eigen::Vector3d(0, ridge, rise));
  if (along_x) {
    out.quad(a, b, high, low);
    out.triangle(b, c, high);
    out.quad(c, e, low, high);
    out.triangle(e, a, low);
  } else {
    out.triangle(a, b, low);
    out.quad(b, c, high, low);
    out.triangle(c, e, high);
    out.quad(e, a, low, high);
  }
  return out.mesh();
}

void opening_keys(BuildingValues p, BuildingKeyList& out) {
  const double w = p[OpeningParameter::width] / 2, h = p[OpeningParameter::height] / 2;
  out.insert(out.end(), {{0, 0, 0}, {-w, 0, -h}, {w, 0, -h}, {w, 0, h}, {-w, 0, h}});
}

struct BuildingTypes {
  int building, storey, wall, window, door, roof;
};

BuildingTypes add_building_types(Hierarchy& h) {
  const auto storey_keys = [](BuildingValues p, BuildingKeyList& out) {
    const double w = p[StoreyParameter::width] / 2, d = p[StoreyParameter::depth] / 2;
    for (const double z : {0., p[StoreyParameter::height]})
      out.insert(out.end(), {{-w, -d, z}, {w, -d, z}, {w, d, z}, {-w, d, z}});
  };
  const auto wall_keys = [](BuildingValues p, BuildingKeyList& out) {
    const double l = p[WallParameter::length], z = p[WallParameter::height];
    out.insert(out.end(), {{0, 0, 0}, {l, 0, 0}, {l, 0, z}, {0, 0, z}});
  };
  const std::vector<ParameterType> opening{{"width", "m", 0.3, 2},
                                           {"height", "m", 0.3, kMostStoreyHeight},
                                           {"along", "m", 0, 1e4},
                                           {"sill", "m", 0, kMostStoreyHeight}};
  BuildingTypes t{};
  t.building = h.add_type({.name = "building", .keys = [](BuildingValues, BuildingKeyList& out) {
                             out.emplace_back(0, 0, 0);
                           }});
  t.storey = h.add_type({.name = "storey",
                         .parameters = {{"width", "m", kLeastStoreySide, 1e4},
                                        {"depth", "m", kLeastStoreySide, 1e4},
                                        {"height", "m", kLeastStoreyHeight, kMostStoreyHeight},
                                        {"base", "m", 0, 2}},
                         .keys = storey_keys,
                         .mesh = storey_mesh});
  t.wall = h.add_type({.name = "wall",
                       .parameters = {{"length", "m", kLeastStoreySide, 1e4},
                                      {"height", "m", kLeastStoreyHeight, kMostStoreyHeight},
                                      {"side", "1", 0, 3},
                                      {"offset", "m", kLeastStoreySide / 2, 1e4}},
                       .keys = wall_keys,
                       .mesh = wall_mesh});
  t.window = h.add_type(
      {.name = "window", .parameters = opening, .keys = opening_keys, .mesh = window_mesh});
  t.door =
      h.add_type({.name = "door", .parameters = opening, .keys = opening_keys, .mesh = door_mesh});
  t.roof = h.add_type({.name = "roof",
                       .parameters = {{"width", "m", kLeastStoreySide, 1e4},
                                      {"depth", "m", kLeastStoreySide, 1e4},
                                      {"rise", "m", kLeastRoofRise, kMostRoofRise},
                                      {"eaves", "m", 0, 2},
                                      {"ridge", "1", 0, 1}},
                       .keys = roof_keys,
                       .mesh = roof_mesh});
  return t;
}

/// Sizes of a storey's openings.
struct OpeningStyle {
  double pitch, width, height, sill;
};

/// A row in even distances, as many as come nearest to the style's pitch.
std::vector<Opening> even_row(double length, const OpeningStyle& style, bool with_door) {
  const Opening window{0, style.width, style.sill, style.height, false, false};
  const double least = least_pitch(window, window);
  int count = std::max(1, static_cast<int>(std::lround(length / style.pitch)));
  if (with_door && count % 2 == 0) count += length / (count + 1) >= least ? 1 : -1;
  while (count > 1 && length / count < least) count -= with_door ? 2 : 1;
  const double pitch = std::min(length / count, kMostPitch);
  std::vector<Opening> row(count, window);
  for (int i = 0; i < count; ++i) row[i].along = length / 2 + (i - (count - 1) / 2.) * pitch;
  if (with_door) {
    Opening& door = row[count / 2];
    door.door = true;
    door.sill = 0;
    door.width = std::clamp(1.1, 0.6, 2 * (pitch - kOpeningGap) - style.width);
    door.height = std::min(2.2, 0.8 * (style.sill + style.height + 0.3));
  }
  return row;
}

void add_new_storey(Hierarchy& h, const BuildingTypes& types, const StoreyBox& box,
                    const OpeningStyle& style, bool ground) {
  const Pose pose{box.bottom, turn_of_yaw(box.yaw)};
  const int storey = h.add(types.storey, 0, pose,
                           std::array{box.width, box.depth, box.height, ground ? 0.45 : 0.});
  std::array<int, 4> walls{};
  for (int side = 0; side < 4; ++side)
    walls[side] = h.add(types.wall, storey, wall_pose(pose, side, box.width, box.depth),
                        wall_parameters(side, box.width, box.depth, box.height));
  for (int side = 0; side < 4; ++side) {
    const double length = h.parameter(walls[side], WallParameter::length);
    for (const Opening& o : even_row(length, style, ground && side == 0))
      h.add(o.door ? types.door : types.window, walls[side], opening_pose(h.pose(walls[side]), o),
            std::array{o.width, o.height, o.along, o.sill});
  }
}

void require_building_range(double value, double low, double high, const char* name) {
  if (!(value >= low && value <= high))
    throw Error("option '" + std::string(name) + "' is " + std::to_string(value), "building",
                std::to_string(low) + " to " + std::to_string(high));
}

void require_building_options(const BuildingOptions& o) {
  require_building_range(o.width, 4, 200, "width");
  require_building_range(o.depth, 4, 200, "depth");
  require_building_range(o.storeys, 1, 200, "storeys");
  require_building_range(o.storey_height, kLeastStoreyHeight, kMostStoreyHeight, "storey_height");
  require_building_range(o.pitch, 1.4, kMostPitch, "pitch");
  require_building_range(o.window_width, 0.5, 1.2, "window_width");
  require_building_range(o.window_height, 0.5, 1.6, "window_height");
  require_building_range(o.variety, 0, 1, "variety");
}

}  // namespace

void describe(OptionVisitor& v, BuildingOptions& o) {
  v.value("width", o.width,
          {.doc = "width of the ground storey, along x", .unit = "m", .min = 4, .max = 200});
  v.value("depth", o.depth,
          {.doc = "depth of the ground storey, along y", .unit = "m", .min = 4, .max = 200});
  v.value("storeys", o.storeys, {.doc = "number of storeys", .min = 1, .max = 200});
  v.value("storey_height", o.storey_height,
          {.doc = "usual height of a storey",
           .unit = "m",
           .min = kLeastStoreyHeight,
           .max = kMostStoreyHeight});
  v.value("pitch", o.pitch,
          {.doc = "distance of neighbouring windows that is aimed at",
           .unit = "m",
           .min = 1.4,
           .max = kMostPitch});
  v.value("window_width", o.window_width,
          {.doc = "usual width of a window", .unit = "m", .min = 0.5, .max = 1.2});
  v.value("window_height", o.window_height,
          {.doc = "usual height of a window", .unit = "m", .min = 0.5, .max = 1.6});
  v.value("variety", o.variety,
          {.doc = "how much storeys and their windows differ, and setbacks; 0: all alike",
           .min = 0,
           .max = 1});
}

Hierarchy make_building(const BuildingOptions& options, std::uint64_t seed) {
  require_building_options(options);
  RandomStream random(seed, "building");
  const auto vary = [&](double by) {
    return 1 + by * options.variety * (2 * random.uniform() - 1);
  };
  Hierarchy h;
  const BuildingTypes types = add_building_types(h);
  h.add(types.building, -1, {});
  StoreyBox box{{0, 0, 0}, 0, options.width, options.depth, options.storey_height};
  // Upper storeys share a style: the first above the ground has taller windows.
  const double width = std::clamp(options.window_width * vary(0.15), 0.5, 1.2);
  const double upper = vary(0.05);
  for (int i = 0; i < options.storeys; ++i) {
    const double rise = i == 0 ? 1 + 0.15 * options.variety : upper * vary(0.015);
    box.height = std::clamp(options.storey_height * rise, kLeastStoreyHeight, kMostStoreyHeight);
    if (i > 0 && random.uniform() < 0.2 * options.variety) {
      const double setback = 0.15 + 0.2 * random.uniform();
      box.width = std::max(4., box.width - 2 * setback);
      box.depth = std::max(4., box.depth - 2 * setback);
    }
    const double tall = i == 1 ? 1 + 0.12 * options.variety : 1;
    const double window = std::min(options.window_height * tall, 0.58 * box.height);
    const double sill = std::min(0.3 * box.height, box.height - window - 0.35);
    add_new_storey(h, types, box, {options.pitch, width, window, sill}, i == 0);
    box.bottom.z() += box.height;
  }
  const double shorter = std::min(box.width, box.depth);
  const double rise = std::clamp(shorter * 0.28 * vary(0.3), 1.2, 4.);
  const double ridge = options.storeys > 7 ? 0 : 0.25 + 0.3 * options.variety * random.uniform();
  h.add(types.roof, 0, {box.bottom}, std::array{box.width, box.depth, rise, 0.4, ridge});
  return h;
}

}  // namespace geoprior::grammar
