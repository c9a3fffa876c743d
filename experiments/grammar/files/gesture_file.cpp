#include "experiments/grammar/files/gesture_file.h"

#include <array>
#include <utility>

#include "core/error.h"
#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/runner/options/listing.h"
#include "testbed/runner/options/toml.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior::grammar {
namespace {

struct StrokeTable {
  Stroke::Kind kind = Stroke::Kind::grab;
  std::vector<double> x, y, z;
  double radius = 1, amount = 0;
  std::array<double, 3> axis{0, 0, 1}, along{0, 0, 1};
};

struct LatticeTable {
  std::array<double, 3> low{0, 0, 0}, high{1, 1, 1};
  std::array<int, 3> points{2, 2, 2};
  std::vector<double> shifts;
};

struct CageTable {
  std::string rest, moved;
};

struct GestureTable {
  std::vector<StrokeTable> strokes;
  std::optional<LatticeTable> lattice;
  std::optional<CageTable> cage;
};

void describe(OptionVisitor& v, StrokeTable& stroke) {
  constexpr std::array<std::string_view, 4> kKinds{"grab", "inflate", "twist", "bend"};
  describe_choice(v, "kind", stroke.kind, kKinds,
                  {.doc = "what the tool does to what is near it", .required = true});
  v.value("path_x", stroke.x,
          {.doc = "where the tool is, along x: two points or more for grab",
           .unit = "m",
           .required = true});
  v.value("path_y", stroke.y, {.doc = "where the tool is, along y", .unit = "m", .required = true});
  v.value("path_z", stroke.z, {.doc = "where the tool is, along z", .unit = "m", .required = true});
  v.value(
      "radius", stroke.radius,
      {.doc = "how far the tool reaches", .unit = "m", .min = 1e-6, .max = 1e6, .required = true});
  v.value("axis", stroke.axis, {.doc = "axis of twist and bend"});
  v.value("along", stroke.along,
          {.doc = "direction along which bend turns more and more, across its axis"});
  v.value("amount", stroke.amount,
          {.doc = "strain at the tool of inflate; largest angle (rad) of twist, and of "
                  "bend",
           .min = -100,
           .max = 100});
}

void describe(OptionVisitor& v, LatticeTable& lattice) {
  v.value("low", lattice.low, {.doc = "lowest corner of the box", .unit = "m", .required = true});
  v.value("high", lattice.high,
          {.doc = "highest corner of the box", .unit = "m", .required = true});
  v.value("points", lattice.points,
          {.doc = "control points along x, y and z", .min = 2, .max = 16, .required = true});
  v.value("shifts", lattice.shifts,
          {.doc = "shift of each control point, three numbers each, along x fastest",
           .unit = "m",
           .required = true});
}

void describe(OptionVisitor& v, CageTable& cage) {
  v.value("rest", cage.rest,
          {.doc = "closed mesh around the object", .required = true, .named = Named::file});
  v.value("moved", cage.moved,
          {.doc = "the mesh around the object, where the gesture takes it",
           .required = true,
           .named = Named::file});
}

void describe(OptionVisitor& v, GestureTable& table) {
  describe_list(v, "stroke", table.strokes, {.doc = "strokes of a tool, one after the other"});
  describe_group(v, "lattice", table.lattice, {.doc = "box of control points; absent: none"});
  describe_group(v, "cage", table.cage, {.doc = "mesh around the object; absent: none"});
}

Eigen::Vector3d vector_of(const std::array<double, 3>& x) { return Eigen::Vector3d::Map(x.data()); }

Stroke stroke_of(const StrokeTable& table, const std::string& where) {
  if (table.x.size() != table.y.size() || table.x.size() != table.z.size())
    throw Error("has " + std::to_string(table.x.size()) + ", " + std::to_string(table.y.size()) +
                    " and " + std::to_string(table.z.size()) + " coordinates",
                where, "as many of path_x, path_y and path_z");
  Stroke stroke;
  stroke.kind = table.kind;
  for (std::size_t i = 0; i < table.x.size(); ++i)
    stroke.path.emplace_back(table.x[i], table.y[i], table.z[i]);
  stroke.radius = table.radius;
  stroke.amount = table.amount;
  stroke.axis = vector_of(table.axis);
  stroke.along = vector_of(table.along);
  return stroke;
}

Lattice lattice_of(const LatticeTable& table, const std::string& where) {
  if (table.shifts.size() % 3 != 0)
    throw Error("has " + std::to_string(table.shifts.size()) + " numbers", where + ": shifts",
                "three a control point");
  Lattice lattice{vector_of(table.low), vector_of(table.high), table.points, {}};
  for (std::size_t i = 0; i < table.shifts.size(); i += 3)
    lattice.shifts.emplace_back(table.shifts[i], table.shifts[i + 1], table.shifts[i + 2]);
  return lattice;
}

GestureTable gesture_table(const TomlNode& root) {
  GestureTable table;
  read_options(root, "", table);
  return table;
}

/// All but the cage. What the strokes do not allow is said at their place in the file.
Gesture gesture_of(const GestureTable& table, const TomlNode& root, const std::string& name) {
  Gesture gesture;
  for (std::size_t i = 0; i < table.strokes.size(); ++i) {
    const std::string& place = root.find("stroke")->items[i].place;
    gesture.strokes.push_back(stroke_of(table.strokes[i], place));
    try {
      map_of({{gesture.strokes.back()}, {}, {}}, 1);
    } catch (const Error& e) {
      throw Error(e.what(), place);
    }
  }
  if (table.lattice) {
    const std::string& place = root.find("lattice")->place;
    gesture.lattice = lattice_of(*table.lattice, place);
    try {
      map_of({{}, gesture.lattice, {}}, 1);
    } catch (const Error& e) {
      throw Error(e.what(), place);
    }
  }
  if (table.strokes.empty() && !table.lattice && !table.cage)
    throw Error("is a gesture without anything", name, "[[stroke]], [lattice] or [cage]");
  return gesture;
}

}  // namespace

Gesture parse_gesture(std::string_view text, const std::string& name) {
  const TomlNode root = parse_toml_text(text, name);
  const GestureTable table = gesture_table(root);
  if (table.cage) throw Error("names other files", root.find("cage")->place, "strokes, a lattice");
  return gesture_of(table, root, name);
}

ReadGesture read_gesture_file(const std::filesystem::path& file) {
  const TomlNode root = parse_toml_text(read_text_file(file), file.string());
  const GestureTable table = gesture_table(root);
  ReadGesture out{gesture_of(table, root, file.string()), {file}};
  if (!table.cage) return out;
  const auto rest = file.parent_path() / table.cage->rest;
  const auto moved = file.parent_path() / table.cage->moved;
  Cage cage{read_mesh_file(rest).mesh, read_mesh_file(moved).mesh.V};
  try {
    map_of({{}, {}, cage}, 1);
  } catch (const Error& e) {
    throw Error(e.what(), root.find("cage")->place);
  }
  out.gesture.cage = std::move(cage);
  out.files.insert(out.files.end(), {rest, moved});
  return out;
}

TopicFile gesture_keys() {
  GestureTable table;
  return {"gesture", "what a sculpting tool did, a lattice or a cage",
          "[[stroke]], [lattice], [cage]",
          list_options([&](OptionVisitor& v) { describe(v, table); })};
}

}  // namespace geoprior::grammar
