#include "models/sound/resonators/shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <string>

#include "core/disjoint_sets.h"
#include "core/error.h"

namespace geoprior::sound {
namespace {

using Eigen::Vector3d;
using Side = ResonatorShape::Side;

/// First and second differences of the places along one direction of the grid.
struct Differences {
  Vector3d first, second;
  bool known = false;
};

Differences differences(const SoundGrid& grid, const SheetField& field, int cell, int ahead,
                        int behind) {
  const std::array<int, 4> beside = grid.neighbours(cell);
  const Vector3d here = field.place.row(cell);
  const auto there = [&](int side) -> Vector3d { return field.place.row(beside[side]); };
  const bool has_ahead = field.holds(grid, cell, ahead),
             has_behind = field.holds(grid, cell, behind);
  if (has_ahead && has_behind) {
    return {(there(ahead) - there(behind)) / 2, there(ahead) - 2 * here + there(behind), true};
  }
  if (has_ahead) return {there(ahead) - here, Vector3d::Zero(), true};
  if (has_behind) return {here - there(behind), Vector3d::Zero(), true};
  return {Vector3d::Zero(), Vector3d::Zero(), false};
}

/// Second difference of mixed direction, where all four cells of it hold together.
Vector3d mixed(const SoundGrid& grid, const SheetField& field, int cell) {
  const std::array<int, 4> beside = grid.neighbours(cell);
  Vector3d sum = Vector3d::Zero();
  for (const int side : {0, 2}) {
    if (!field.holds(grid, cell, side)) return Vector3d::Zero();
    const int next = beside[side];
    for (const int up : {1, 3}) {
      if (!field.holds(grid, next, up)) return Vector3d::Zero();
      const int corner = grid.neighbours(next)[up];
      const double sign = (side == 0) == (up == 1) ? 1 : -1;
      sum += sign * field.place.row(corner).transpose();
    }
  }
  return sum / 4;
}

Eigen::Matrix<double, 3, 6> local_surface(const SoundGrid& grid, const SheetField& field,
                                          int cell) {
  Differences u = differences(grid, field, cell, 0, 2), v = differences(grid, field, cell, 1, 3);
  const Vector3d normal = field.normal.row(cell);
  // A row of single cells: the other direction lies across the normal.
  if (!u.known && !v.known) u.first = grid.spacing * normal.unitOrthogonal();
  if (!v.known) v.first = normal.cross(u.first).normalized() * grid.spacing;
  if (!u.known && v.known) u.first = v.first.cross(normal).normalized() * grid.spacing;
  Eigen::Matrix<double, 3, 6> place;
  place << field.place.row(cell).transpose(), u.first, v.first, u.second, v.second,
      mixed(grid, field, cell);
  return place;
}

/// The largest set of cells that hold together, ascending.
std::vector<int> largest_piece(const SoundGrid& grid, const SheetField& field,
                               const std::vector<int>& cells) {
  std::map<int, int> number;
  for (int i = 0; i < std::ssize(cells); ++i) number[cells[i]] = i;
  DisjointSets pieces(static_cast<int>(cells.size()));
  for (const int c : cells) {
    for (const int side : {0, 1}) {
      if (!field.holds(grid, c, side)) continue;
      const auto other = number.find(grid.neighbours(c)[side]);
      if (other != number.end()) pieces.join(number[c], other->second);
    }
  }
  std::map<int, std::vector<int>> by_piece;
  for (const int c : cells) by_piece[pieces.find(number[c])].push_back(c);
  const auto largest = std::max_element(
      by_piece.begin(), by_piece.end(),
      [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  return largest == by_piece.end() ? std::vector<int>{} : largest->second;
}

/// By cell and side, whether most of the border of the sheet there is held.
std::map<std::pair<int, int>, double> held_border(const SoundGrid& grid, const SheetField& field,
                                                  const IsHeld& is_held) {
  std::map<std::pair<int, int>, double> held;
  for (const BorderStretch& stretch : field.border) {
    const Eigen::Vector2d way = stretch.place - grid.centre(stretch.cell);
    const int side =
        std::abs(way.x()) >= std::abs(way.y()) ? (way.x() > 0 ? 0 : 2) : (way.y() > 0 ? 1 : 3);
    held[{stretch.cell, side}] += is_held(stretch.place) ? stretch.length : -stretch.length;
  }
  return held;
}

/// Signed change of the shape operator when the curvature across a ruling changes.
Eigen::RowVector3d change_across(const Eigen::Vector2d& ruling, double change) {
  const Eigen::Vector2d across(-ruling.y(), ruling.x());
  return change * Eigen::RowVector3d(across.x() * across.x(), across.x() * across.y(),
                                     across.y() * across.y());
}

/// Vertices of the squares of all cells: those of neighbouring sides inside are one.
class Lattice {
 public:
  Lattice(const ResonatorShape& shape, int s)
      : shape_(shape), s_(s), joined_(static_cast<int>(shape.cells.size()) * (s + 1) * (s + 1)) {
    std::map<std::pair<int, int>, int> at;
    for (int c = 0; c < count(); ++c) at[{cell(c).column, cell(c).row}] = c;
    for (int c = 0; c < count(); ++c) {
      for (const int side : {0, 1}) {
        if (cell(c).sides[side] != Side::inside) continue;
        const int other = at.at({cell(c).column + (side == 0), cell(c).row + (side == 1)});
        for (int k = 0; k <= s_; ++k) {
          if (side == 0) joined_.join(local(c, s_, k), local(other, 0, k));
          if (side == 1) joined_.join(local(c, k, s_), local(other, k, 0));
        }
      }
    }
    for (int i = 0; i < joined_.size(); ++i) number_.try_emplace(joined_.find(i), number_.size());
  }
  [[nodiscard]] int count() const { return static_cast<int>(shape_.cells.size()); }
  [[nodiscard]] const ResonatorShape::Cell& cell(int c) const { return shape_.cells[c]; }
  [[nodiscard]] int vertices() const { return static_cast<int>(number_.size()); }
  [[nodiscard]] int vertex(int c, int a, int b) {
    return static_cast<int>(number_.at(joined_.find(local(c, a, b))));
  }

 private:
  [[nodiscard]] int local(int c, int a, int b) const { return (c * (s_ + 1) + b) * (s_ + 1) + a; }

  const ResonatorShape& shape_;
  int s_;
  DisjointSets joined_;
  std::map<int, std::size_t> number_;
};

}  // namespace

Vector3d ResonatorShape::at(const Cell& cell, double xi, double eta) {
  Eigen::Matrix<double, 6, 1> monomials;
  monomials << 1, xi, eta, xi * xi / 2, eta * eta / 2, xi * eta;
  return cell.place * monomials;
}

ResonatorShape resonator_shape(const SoundGrid& grid, const SheetField& field,
                               const SoundEvent& event, const IsHeld& is_held) {
  ResonatorShape shape;
  shape.spacing = grid.spacing;
  const std::vector<int> cells = largest_piece(grid, field, event.cells);
  const auto held = held_border(grid, field, is_held);
  for (const int c : cells) {
    ResonatorShape::Cell& cell = shape.cells.emplace_back();
    cell.column = c % grid.columns;
    cell.row = c / grid.columns;
    cell.place = local_surface(grid, field, c);
    const std::array<int, 4> beside = grid.neighbours(c);
    for (int side = 0; side < 4; ++side) {
      const auto border = held.find({c, side});
      if (!field.holds(grid, c, side)) {
        const bool is_free = border == held.end() || border->second <= 0;
        cell.sides[side] = is_free ? Side::free : Side::clamped;
      } else if (std::binary_search(cells.begin(), cells.end(), beside[side])) {
        cell.sides[side] = Side::inside;
      } else {
        cell.sides[side] = Side::clamped;
      }
    }
  }
  for (const FlippedCell& flip : event.flips) {
    const auto at = std::lower_bound(cells.begin(), cells.end(), flip.cell);
    if (at == cells.end() || *at != flip.cell) continue;
    shape.cells[at - cells.begin()].change +=
        change_across(field.ruling.row(flip.cell), flip.change);
  }
  return shape;
}

ResonatorMesh mesh_of(const ResonatorShape& shape, int subdivision) {
  if (shape.cells.empty()) throw Error("has no cells", "resonator");
  if (subdivision < 1)
    throw Error("is " + std::to_string(subdivision), "subdivision of a resonator", "1 or more");
  const int s = subdivision;
  Lattice lattice(shape, s);
  ResonatorMesh out;
  ShellState& state = out.state;
  const int n = lattice.vertices(), m = 2 * s * s * lattice.count();
  state.mesh.pattern = Eigen::MatrixX2d::Zero(n, 2);
  state.x = Eigen::MatrixX3d::Zero(n, 3);
  state.mesh.triangles.resize(m, 3);
  out.change.resize(m, 3);
  Eigen::VectorXd members = Eigen::VectorXd::Zero(n);
  int t = 0;
  for (int c = 0; c < lattice.count(); ++c) {
    const ResonatorShape::Cell& cell = lattice.cell(c);
    for (int b = 0; b <= s; ++b) {
      for (int a = 0; a <= s; ++a) {
        const double xi = static_cast<double>(a) / s - 0.5, eta = static_cast<double>(b) / s - 0.5;
        const int v = lattice.vertex(c, a, b);
        state.mesh.pattern.row(v) =
            shape.spacing * Eigen::RowVector2d(cell.column + 0.5 + xi, cell.row + 0.5 + eta);
        state.x.row(v) += ResonatorShape::at(cell, xi, eta).transpose();
        members[v] += 1;
      }
    }
    for (int b = 0; b < s; ++b) {
      for (int a = 0; a < s; ++a) {
        const int p = lattice.vertex(c, a, b), q = lattice.vertex(c, a + 1, b);
        const int r = lattice.vertex(c, a + 1, b + 1), u = lattice.vertex(c, a, b + 1);
        const bool rising = (cell.column * s + a + cell.row * s + b) % 2 == 0;
        state.mesh.triangles.row(t) << p, q, (rising ? r : u);
        state.mesh.triangles.row(t + 1) << (rising ? p : q), r, u;
        out.change.row(t) = out.change.row(t + 1) = cell.change;
        t += 2;
      }
    }
    for (int side = 0; side < 4; ++side) {
      if (cell.sides[side] != Side::clamped) continue;
      for (int k = 0; k < s; ++k) {
        const int a = side == 0 ? s : side == 2 ? 0 : k, b = side == 1 ? s : side == 3 ? 0 : k;
        const bool upright = side == 0 || side == 2;
        out.clamped.push_back(
            undirected(lattice.vertex(c, a, b), lattice.vertex(c, a + !upright, b + upright)));
      }
    }
  }
  for (int v = 0; v < n; ++v) state.x.row(v) /= members[v];
  state.v = Eigen::MatrixX3d::Zero(n, 3);
  state.plastic_curvature = Eigen::MatrixX3d::Zero(m, 3);
  state.damage = Eigen::VectorXd::Zero(m);
  return out;
}

void save(const ResonatorShape& shape, StateWriter& out) {
  out.number(shape.spacing);
  out.number(shape.cells.size());
  for (const ResonatorShape::Cell& cell : shape.cells) {
    out.number(cell.column);
    out.number(cell.row);
    for (const double x : cell.place.reshaped()) out.number(x);
    out.number(cell.sides);
    for (const double x : cell.change) out.number(x);
  }
}

ResonatorShape load_resonator_shape(StateReader& in) {
  ResonatorShape shape;
  shape.spacing = in.number<double>();
  shape.cells.resize(in.count(2 * sizeof(int) + 21 * sizeof(double) + 4));
  for (ResonatorShape::Cell& cell : shape.cells) {
    cell.column = in.number<int>();
    cell.row = in.number<int>();
    for (double& x : cell.place.reshaped()) x = in.number<double>();
    cell.sides = in.number<std::array<Side, 4>>();
    for (double& x : cell.change) x = in.number<double>();
  }
  return shape;
}

}  // namespace geoprior::sound
