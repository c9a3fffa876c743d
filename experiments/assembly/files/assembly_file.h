#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/options.h"
#include "experiments/assembly/files/read_result.h"
#include "testbed/topic.h"

namespace geoprior::assembly {

/// A port as the file has it; x axis of its frame out of the part, z axis up.
struct PortEntry {
  std::string name;
  std::array<double, 3> at{};
  std::array<double, 3> out{};
  std::array<double, 3> up{0, 0, 1};
};
void describe(OptionVisitor& v, PortEntry& port);

struct WayEntry {
  std::string from, to;
  std::vector<double> points;  ///< three numbers a point
};
void describe(OptionVisitor& v, WayEntry& way);

enum class SolidKind { box, cylinder, sphere, lathe, prism, channel, rail };

/// A primitive of a body (primitives.h). Its kind says which members count.
struct SolidEntry {
  SolidKind kind = SolidKind::box;
  std::array<double, 3> at{};
  std::array<double, 3> turn_deg{};
  std::array<double, 3> size{};
  double radius = 0;
  std::optional<double> top_radius;
  double length = 0, width = 0, height = 0, depth = 0, wall = 0, offset = 0, round = 0;
  std::vector<double> outline;  ///< two numbers a point
  std::vector<double> points;   ///< three numbers a point
};
void describe(OptionVisitor& v, SolidEntry& solid);

struct PartEntry {
  std::string label;
  std::vector<PortEntry> ports;
  std::vector<WayEntry> ways;
  std::vector<std::string> symmetries;
  std::string mesh;
  std::vector<SolidEntry> solids;
};
void describe(OptionVisitor& v, PartEntry& part);

struct ModelPartEntry {
  std::string id, part;
};
void describe(OptionVisitor& v, ModelPartEntry& part);

struct PlaceEntry {
  std::string part;
  std::array<double, 3> at{};
  double turn_deg = 0;
};
void describe(OptionVisitor& v, PlaceEntry& place);

struct ModelEntry {
  std::string name;
  std::vector<ModelPartEntry> parts;
  std::vector<std::string> joints;
  std::vector<PlaceEntry> place;
};
void describe(OptionVisitor& v, ModelEntry& model);

/// Kinds of parts and models made of them, as TOML or, with the same keys, JSON:
///
///     include = ["rails.assembly.toml"]           # read first; each file counts once
///
///     [[part]]
///     label = "ramp"
///     ports = [
///       { name = "in", at = [0, 0, 0], out = [-1, 0, 0] },
///       { name = "out", at = [0.2, 0, -0.05], out = [1, 0, 0] },
///       { name = "under", at = [0.02, 0, -0.01], out = [0, 0, -1], up = [1, 0, 0] },
///     ]
///     ways = [{ from = "in", to = "out", points = [[0, 0, 0], [0.2, 0, -0.05]] }]
///     solids = [{ kind = "channel", width = 0.03, depth = 0.02, wall = 0.005 }]
///
///     [[model]]
///     name = "two-ramps"
///     parts = [{ id = "a", part = "ramp" }, { id = "b", part = "ramp" }]
///     joints = ["a.out b.in"]
///     place = [{ part = "a", at = [0, 0, 0.3], turn_deg = 90 }]
///
/// Joined ports face each other: frames differ by half a turn about z. A part is placed where its
/// first joint, counted from a placed part, puts it: whether other joints close is asked of
/// `joint_misfits`. Ports that no joint names are open. A model may fall into pieces, each of which
/// needs a place; one in one piece without a place stands at the origin, by its first part.
///
/// Symmetries of a part are found by others (`find_symmetries`) where the file gives none.
struct AssemblyFile {
  std::vector<std::string> include;
  std::vector<PartEntry> parts;
  std::vector<ModelEntry> models;
};
void describe(OptionVisitor& v, AssemblyFile& file);

/// @throws Error  naming file and line (JSON: the pointer to the value), and what is allowed
ReadAssemblies read_assembly_file(const std::filesystem::path& file);
/// @param name    of the file, for messages
/// @param folder  that the files named by `include` and `mesh` are looked for in
ReadAssemblies parse_assembly_file(std::string_view text, const std::string& name,
                                   const std::filesystem::path& folder, bool json);

/// The keys of such a file, for `geoprior describe`.
TopicFile assembly_keys();

}  // namespace geoprior::assembly
