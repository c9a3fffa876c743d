#include "metrics/developability/creases.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/disjoint_sets.h"
#include "core/error.h"

namespace geoprior {
namespace {

using std::numbers::pi;

constexpr double kPlateau = 0.8;  // of a peak's energy: belongs to its plateau

/// A family of parallel links between grid points, and the range of directions of lines that it
/// stands for (rad).
struct LinkFamily {
  int i, j;
  double range;
};

/// Eight directions; each stands for the lines up to half way to its neighbours.
std::array<LinkFamily, 8> link_families() {
  const double steep = std::atan(0.5);  // between (2, 0) and (2, 1); pi/4 - steep to (1, 1)
  const double axis = steep;
  const double oblique = pi / 8;
  const double diagonal = pi / 4 - steep;
  return {{{2, 0, axis},
           {2, 1, oblique},
           {1, 1, diagonal},
           {1, 2, oblique},
           {0, 2, axis},
           {-1, 2, oblique},
           {-1, 1, diagonal},
           {-2, 1, oblique}}};
}

/// Creases that the lines of a family cross. A line is a chain of links; links that turn the same
/// way, with at most one between them, cross one crease that is wider than a link.
long crossings(const GriddedSheet& sheet, const LinkFamily& link, double cosine) {
  const Eigen::MatrixX3d& n = sheet.normals;
  // Axis of the turn from one grid point of the chain to the next; zero when it is not sharp.
  const auto turn = [&](int i, int j) -> Eigen::RowVector3d {
    const int a = sheet.grid.at(i, j);
    const int b = sheet.grid.at(i + link.i, j + link.j);
    if (a < 0 || b < 0 || a == b || n.row(a).dot(n.row(b)) >= cosine) {
      return Eigen::RowVector3d::Zero();
    }
    return n.row(a).cross(n.row(b));
  };
  long count = 0;
  for (int j = 0; j < sheet.grid.rows; ++j) {
    for (int i = 0; i < sheet.grid.columns; ++i) {
      const Eigen::RowVector3d axis = turn(i, j);
      if (axis.isZero(0)) continue;
      const bool goes_on = turn(i - link.i, j - link.j).dot(axis) > 0 ||
                           turn(i - 2 * link.i, j - 2 * link.j).dot(axis) > 0;
      if (!goes_on) ++count;
    }
  }
  return count;
}

int index(const PatternGrid& grid, int i, int j) { return j * grid.columns + i; }

/// Ring of grid offsets about a point.
constexpr int kRing = 16;
using CellRing = std::array<std::array<int, 2>, kRing>;

CellRing ring_of(double radius_in_spacings) {
  CellRing ring{};
  for (int k = 0; k < kRing; ++k) {
    const double angle = 2 * pi * k / kRing;
    ring[k] = {static_cast<int>(std::lround(radius_in_spacings * std::cos(angle))),
               static_cast<int>(std::lround(radius_in_spacings * std::sin(angle)))};
  }
  return ring;
}

/// Energy at a grid point; negative where the ring leaves the pattern.
double ring_energy(const GriddedSheet& sheet, const CellRing& ring, int i, int j) {
  std::array<int, kRing> triangle{};
  bool same = true;
  for (std::size_t k = 0; k < kRing; ++k) {
    triangle[k] = sheet.grid.at(i + ring[k][0], j + ring[k][1]);
    if (triangle[k] < 0) return -1;
    same = same && triangle[k] == triangle[0];
  }
  if (same) return 0;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const int t : triangle) sum += sheet.normals.row(t).transpose() * sheet.normals.row(t);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(2 * pi / kRing * sum, Eigen::EigenvaluesOnly);
  return std::max(solver.eigenvalues()(0), 0.0);
}

/// Energies at every second grid point of both directions.
struct EnergyField {
  int columns = 0, rows = 0;
  std::vector<double> value;
  /// Negative beyond the field.
  [[nodiscard]] double at(int i, int j) const {
    if (i < 0 || j < 0 || i >= columns || j >= rows) return -1;
    return value[static_cast<std::size_t>(j) * columns + i];
  }
};

EnergyField energy_field(const GriddedSheet& sheet, const CellRing& ring) {
  EnergyField field{(sheet.grid.columns + 1) / 2, (sheet.grid.rows + 1) / 2, {}};
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      field.value.push_back(ring_energy(sheet, ring, 2 * i, 2 * j));
    }
  }
  return field;
}

/// Whether no value within `reach` is larger (nor equal and earlier), and all neighbours have one.
bool is_peak(const EnergyField& field, int i, int j, int reach) {
  const double own = field.at(i, j);
  for (int dj = -reach; dj <= reach; ++dj) {
    for (int di = -reach; di <= reach; ++di) {
      const double other = field.at(i + di, j + dj);
      if (std::max(std::abs(di), std::abs(dj)) == 1 && other < 0) return false;
      if (di * di + dj * dj > reach * reach || (di == 0 && dj == 0)) continue;
      const bool earlier = dj < 0 || (dj == 0 && di < 0);
      if (other > own || (other == own && earlier)) return false;
    }
  }
  return true;
}

/// Centre of the plateau about a peak: on a coarse mesh every ring that goes round a vertex sees
/// the same triangles.
Eigen::Vector2d plateau_centre(const GriddedSheet& sheet, const EnergyField& field, int i, int j,
                               int reach) {
  Eigen::Vector2d sum(0, 0);
  int count = 0;
  for (int dj = -reach; dj <= reach; ++dj) {
    for (int di = -reach; di <= reach; ++di) {
      const bool near = di * di + dj * dj <= reach * reach;
      if (!near || field.at(i + di, j + dj) < kPlateau * field.at(i, j)) continue;
      sum += sheet.grid.point(2 * (i + di), 2 * (j + dj));
      ++count;
    }
  }
  return sum / count;
}

}  // namespace

GriddedSheet gridded_sheet(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3d& x,
                           const Eigen::MatrixX3i& triangles, double grid_spacing) {
  return {pattern_grid(pattern, triangles, grid_spacing), triangle_normals({x, triangles})};
}

double crease_length(const GriddedSheet& sheet, const CreaseOptions& options) {
  const double cosine = std::cos(options.fold_angle);
  double length = 0;
  for (const LinkFamily& link : link_families()) {
    const double between_lines = sheet.grid.spacing / std::hypot(link.i, link.j);
    length += link.range / 2 * between_lines * static_cast<double>(crossings(sheet, link, cosine));
  }
  return length;
}

std::vector<double> facet_areas(const GriddedSheet& sheet, const CreaseOptions& options) {
  const PatternGrid& grid = sheet.grid;
  const double cosine = std::cos(options.fold_angle);
  DisjointSets facets(static_cast<int>(grid.triangle.size()));  // named by their lowest points
  const auto smooth = [&](int a, int b) {
    return b >= 0 && (a == b || sheet.normals.row(a).dot(sheet.normals.row(b)) >= cosine);
  };
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const int own = grid.at(i, j);
      if (own < 0) continue;
      const int p = index(grid, i, j);
      if (smooth(own, grid.at(i + 1, j))) facets.join(p, index(grid, i + 1, j));
      if (smooth(own, grid.at(i, j + 1))) facets.join(p, index(grid, i, j + 1));
    }
  }
  std::vector<int> points(grid.triangle.size(), 0);
  for (int p = 0; p < facets.size(); ++p) {
    if (grid.triangle[p] >= 0) ++points[facets.find(p)];
  }
  std::vector<double> areas;
  for (const int count : points) {
    const double area = count * grid.spacing * grid.spacing;
    if (count > 0 && area >= options.smallest_facet) areas.push_back(area);
  }
  return areas;
}

std::vector<DetectedCone> detect_cones(const GriddedSheet& sheet, const CreaseOptions& options) {
  const double spacing = sheet.grid.spacing;
  const EnergyField field = energy_field(sheet, ring_of(options.ring_radius / spacing));
  const int reach = static_cast<int>(std::lround(options.cone_distance / (2 * spacing)));
  std::vector<DetectedCone> cones;
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      if (field.at(i, j) <= options.cone_energy || !is_peak(field, i, j, reach)) continue;
      cones.push_back({plateau_centre(sheet, field, i, j, reach), field.at(i, j)});
    }
  }
  return cones;
}

}  // namespace geoprior
