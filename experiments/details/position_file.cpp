#include "experiments/details/position_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/triangle_tree.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/mesh_file.h"
#include "testbed/formats/text_lines.h"

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

constexpr std::array<std::string_view, 5> kColumns{"x", "y", "z", "weight", "type"};

/// Words between commas, without blanks around them.
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  line = line.substr(0, line.find('#'));
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    std::string cell(line.substr(begin, end - begin));
    const std::size_t first = cell.find_first_not_of(" \t\r");
    const std::size_t last = cell.find_last_not_of(" \t\r");
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
    begin = end + 1;
  }
  if (cells.size() == 1 && cells[0].empty()) cells.clear();
  return cells;
}

/// Where each known column is in a row.
using Columns = std::array<std::optional<std::size_t>, kColumns.size()>;

Columns columns_of(const std::vector<std::string>& header, const std::string& place) {
  Columns columns;
  for (std::size_t i = 0; i < header.size(); ++i) {
    for (std::size_t k = 0; k < kColumns.size(); ++k) {
      if (header[i] != kColumns[k]) continue;
      if (columns[k]) throw Error("names the column '" + header[i] + "' twice", place, "each once");
      columns[k] = i;
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (!columns[k]) {
      throw Error("names no column '" + std::string(kColumns[k]) + "'", place,
                  "x, y, z and, if need be, weight, type");
    }
  }
  return columns;
}

Position position_of_row(const std::vector<std::string>& cells, const Columns& columns,
                         std::string place) {
  const auto number = [&](std::size_t k, double otherwise) {
    if (!columns[k]) return otherwise;
    if (*columns[k] >= cells.size())
      throw Error("has no " + std::string(kColumns[k]), place, "a row as long as the first");
    const std::string& cell = cells[*columns[k]];
    const std::optional<double> x = finite_number(cell);
    if (!x) throw Error("'" + cell + "' is no finite number", place, std::string(kColumns[k]));
    return *x;
  };
  Position p;
  p.x = {number(0, 0), number(1, 0), number(2, 0)};
  p.weight = number(3, 1);
  if (!(p.weight >= 0 && p.weight <= 1))
    throw Error("weight " + cells[*columns[3]], place, "0 … 1");
  const double type = number(4, 0);
  if (!(type >= 0 && type == std::floor(type) && type <= std::numeric_limits<int>::max()))
    throw Error("type " + cells[*columns[4]], place, "a whole number, 0 or more");
  p.type = static_cast<int>(type);
  p.place = std::move(place);
  return p;
}

std::vector<Position> read_csv(const fs::path& file) {
  const std::string text = read_whole_file(file);
  TextLines lines(text, file.string());
  std::optional<Columns> columns;
  std::vector<Position> positions;
  while (lines.next()) {
    const std::vector<std::string> cells = cells_of(lines.line());
    if (cells.empty()) continue;
    if (!columns) {
      columns = columns_of(cells, lines.place());
    } else {
      positions.push_back(position_of_row(cells, *columns, lines.place()));
    }
  }
  if (!columns) throw Error("is empty", file.string(), "a line of columns, then rows");
  return positions;
}

std::vector<Position> read_vertices(const fs::path& file) {
  const MeshFile read = read_mesh_file(file);
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
                                    double max_distance) {
  const std::vector<Position> positions =
      file.extension() == ".csv" ? read_csv(file) : read_vertices(file);
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
