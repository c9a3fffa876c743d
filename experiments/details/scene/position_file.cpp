#include "experiments/details/scene/position_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "core/error.h"
#include "core/geometry/triangle_tree.h"
#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/text/csv_table.h"
#include "testbed/formats/text/letters.h"

namespace geoprior::details {
namespace {

namespace fs = std::filesystem;

/// A row of the file, and where it is.
struct Position {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  double weight = 1;
  int type = 0;
  std::string place;
};

std::vector<Position> read_csv(const fs::path& file) {
  const CsvTable table(file, {"x", "y", "z"}, {"weight", "type"});
  std::vector<Position> positions;
  for (const CsvTable::Row& row : table.rows()) {
    Position& p = positions.emplace_back();
    p.x = {*table.number(row, "x"), *table.number(row, "y"), *table.number(row, "z")};
    p.weight = table.number(row, "weight").value_or(1);
    if (!(p.weight >= 0 && p.weight <= 1)) {
      throw Error("weight " + *table.text(row, "weight"), row.place, "0 … 1");
    }
    const double type = table.number(row, "type").value_or(0);
    if (!(type >= 0 && type == std::floor(type) && type <= std::numeric_limits<int>::max())) {
      throw Error("type " + *table.text(row, "type"), row.place, "a whole number, 0 or more");
    }
    p.type = static_cast<int>(type);
    p.place = row.place;
  }
  return positions;
}

std::vector<Position> read_vertices(const fs::path& file, std::vector<std::string>& warnings) {
  const MeshFile read = read_mesh_file(file, warnings);
  std::vector<Position> positions;
  for (Eigen::Index v = 0; v < read.mesh.V.rows(); ++v) {
    Position p;
    p.x = read.mesh.V.row(v);
    p.place = file.string() + ", vertex " + std::to_string(v);
    positions.push_back(p);
  }
  return positions;
}

using PlaceKey = std::array<double, 3>;

}  // namespace

std::vector<Detail> details_of_file(const fs::path& file, const TriMesh& surface,
                                    double max_distance, std::vector<std::string>& warnings) {
  const bool table = lower(file.extension().string()) == ".csv";
  const std::vector<Position> positions = table ? read_csv(file) : read_vertices(file, warnings);
  const TriangleTree tree(surface);
  std::vector<Detail> details;
  std::map<PlaceKey, std::string> taken;
  for (const Position& p : positions) {
    const TriangleTree::Nearest nearest = tree.nearest(p.x);
    if (nearest.distance > max_distance) {
      throw Error("is off the surface by " + std::to_string(nearest.distance) + " m", p.place,
                  "at most " + std::to_string(max_distance) + " m");
    }
    const auto [other, is_new] = taken.try_emplace({p.x.x(), p.x.y(), p.x.z()}, p.place);
    if (!is_new) throw Error("is in the place of " + other->second, p.place, "another place");
    Detail& d = details.emplace_back();
    d.at = nearest.point;
    d.weight = p.weight;
    d.type = p.type;
  }
  return details;
}

}  // namespace geoprior::details
