#include "models/sketch/surface/nets.h"

#include <cstddef>
#include <utility>

#include "core/disjoint_sets.h"
#include "core/error.h"

namespace geoprior::sketch {
namespace {

/// Corner c of a cell is at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge e runs along axis e / 4 from
/// corner kEdgeStart[e].
constexpr std::array<int, 12> kEdgeStart{0, 2, 4, 6, 0, 1, 4, 5, 0, 1, 2, 3};
/// Corners of each face, around it.
constexpr std::array<std::array<int, 4>, 6> kFaces{
    {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};

int edge_between(int a, int b) {
  for (int e = 0; e < 12; ++e) {
    const int start = kEdgeStart[e], end = start | 1 << e / 4;
    if ((start == a && end == b) || (start == b && end == a)) return e;
  }
  return -1;
}

/// For each set of inside corners: which of the cell's sheets crosses each edge; -1 for none.
using SheetTable = std::array<std::array<signed char, 12>, 256>;

std::array<signed char, 12> sheets_of(int inside) {
  const auto is_inside = [&](int corner) { return (inside >> corner & 1) != 0; };
  DisjointSets sets(12);
  std::array<bool, 12> crossed{};
  for (const std::array<int, 4>& face : kFaces) {
    // The two crossed edges at an inside corner whose neighbours are outside belong together; else
    // the face has two crossed edges, which do.
    std::array<int, 4> edges{};
    std::vector<int> open;
    for (int k = 0; k < 4; ++k) {
      edges[k] = edge_between(face[k], face[(k + 1) % 4]);
      if (is_inside(face[k]) != is_inside(face[(k + 1) % 4])) {
        open.push_back(edges[k]);
        crossed[edges[k]] = true;
      }
    }
    if (open.size() == 2) sets.join(open[0], open[1]);
    if (open.size() == 4) {
      for (int k = 0; k < 4; ++k) {
        if (is_inside(face[k])) sets.join(edges[k], edges[(k + 3) % 4]);
      }
    }
  }
  std::array<signed char, 12> sheet{};
  std::array<signed char, 12> of_set{};
  of_set.fill(-1);
  signed char count = 0;
  for (int e = 0; e < 12; ++e) {
    signed char& known = of_set[sets.find(e)];
    if (crossed[e] && known < 0) known = count++;
    sheet[e] = crossed[e] ? known : static_cast<signed char>(-1);
  }
  return sheet;
}

const SheetTable& sheet_table() {
  static const SheetTable table = [] {
    SheetTable all{};
    for (int inside = 0; inside < 256; ++inside) all[inside] = sheets_of(inside);
    return all;
  }();
  return table;
}

/// One pass over the cells for the vertices, one over the edges for the quadrilaterals.
class Netting {
 public:
  explicit Netting(const GridFunction& f)
      : f_(f), inside_(f.values.size()), first_(f.values.size(), -1) {}

  QuadMesh make() {
    for (int k = 0; k + 1 < f_.size[2]; ++k) {
      for (int j = 0; j + 1 < f_.size[1]; ++j) {
        for (int i = 0; i + 1 < f_.size[0]; ++i) add_vertices(i, j, k);
      }
    }
    for (int k = 0; k < f_.size[2]; ++k) {
      for (int j = 0; j < f_.size[1]; ++j) {
        for (int i = 0; i < f_.size[0]; ++i) {
          for (int axis = 0; axis < 3; ++axis) add_quad({i, j, k}, axis);
        }
      }
    }
    mesh_.V.resize(points_.size(), 3);
    for (std::size_t v = 0; v < points_.size(); ++v) mesh_.V.row(v) = points_[v];
    return std::move(mesh_);
  }

 private:
  void add_vertices(int i, int j, int k) {
    const int cell = f_.index(i, j, k);
    std::array<double, 8> value;
    int inside = 0;
    for (int c = 0; c < 8; ++c) {
      value[c] = f_.values[f_.index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1))];
      if (value[c] < 0) inside |= 1 << c;
    }
    inside_[cell] = static_cast<unsigned char>(inside);
    if (inside == 0 || inside == 255) return;
    first_[cell] = static_cast<int>(points_.size());
    std::array<std::vector<Eigen::Vector3d>, 4> of_sheet;
    const std::array<signed char, 12>& sheet = sheet_table()[inside];
    for (int e = 0; e < 12; ++e) {
      if (sheet[e] < 0) continue;
      const int a = kEdgeStart[e], b = a | 1 << e / 4;
      Eigen::Vector3d at(a & 1, a >> 1 & 1, a >> 2 & 1);
      at[e / 4] += value[a] / (value[a] - value[b]);
      of_sheet[sheet[e]].emplace_back(f_.origin + f_.spacing * (Eigen::Vector3d(i, j, k) + at));
    }
    for (std::vector<Eigen::Vector3d>& crossings : of_sheet) {
      if (crossings.empty()) break;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Eigen::Vector3d& x : crossings) sum += x;
      points_.emplace_back(sum / static_cast<double>(crossings.size()));
      mesh_.crossings.push_back(std::move(crossings));
    }
  }

  /// The quadrilateral about the edge of the grid from a point along an axis, if it is crossed.
  void add_quad(std::array<int, 3> point, int axis) {
    std::array<int, 3> next = point;
    ++next[axis];
    if (next[axis] >= f_.size[axis]) return;
    const bool in = f_.values[f_.index(point[0], point[1], point[2])] < 0;
    if (in == (f_.values[f_.index(next[0], next[1], next[2])] < 0)) return;
    const int u = (axis + 1) % 3, w = (axis + 2) % 3;
    if (point[u] == 0 || point[w] == 0 || point[u] + 1 >= f_.size[u] || point[w] + 1 >= f_.size[w])
      throw Error("is not positive on the grid's border", "surface nets");
    // Cells around the edge, counter-clockwise seen against the axis.
    std::array<int, 4> quad{};
    constexpr std::array<std::array<int, 2>, 4> kAround{{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
    for (int n = 0; n < 4; ++n) {
      std::array<int, 3> cell = point;
      cell[u] += kAround[n][0];
      cell[w] += kAround[n][1];
      const int corner = (-kAround[n][0]) << u | (-kAround[n][1]) << w;
      const int index = f_.index(cell[0], cell[1], cell[2]);
      const int edge = edge_between(corner, corner | 1 << axis);
      quad[in ? n : 3 - n] = first_[index] + sheet_table()[inside_[index]][edge];
    }
    mesh_.quads.push_back(quad);
  }

  const GridFunction& f_;
  std::vector<unsigned char> inside_;  ///< of each cell, a bit a corner
  std::vector<int> first_;             ///< vertex of each cell
  std::vector<Eigen::Vector3d> points_;
  QuadMesh mesh_;
};

}  // namespace

QuadMesh surface_nets(const GridFunction& f) { return Netting(f).make(); }

}  // namespace geoprior::sketch
