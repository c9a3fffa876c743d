#include "models/paper/meshing/uniform_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/limits.h"
#include "core/random.h"
#include "models/paper/meshing/grid_anchors.h"
#include "models/paper/tear/lips.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Anchors nearer to the border than this share of the pattern's width lie on it.
constexpr double kOnBorder = 1e-9;
/// Free points keep this distance from border and anchors, in edge lengths: nearer ones would make
/// triangles much smaller than asked for.
constexpr double kClearance = 0.55;
/// Most points of a lattice: a sheet of so many vertices takes hours a frame.
constexpr double kMostPoints = 5e6;
/// Radius of the jitter of the Delaunay layout, in edge lengths.
constexpr double kJitter = 0.3;
/// Radius within which points are nearer to each other about a tip, in edge lengths.
constexpr double kRefined = 2.5;

double perimeter(const Pattern& pattern) {
  double sum = 0;
  each_edge(pattern, [&](const Vector2d& a, const Vector2d& b) { sum += (b - a).norm(); });
  return sum;
}

/// Points of a triangulation to be made: the closed chains of border and holes first.
struct Sites {
  std::vector<std::vector<Vector2d>> loops;
  std::vector<std::vector<Vector2d>> cuts;  ///< ends may be points of other chains
  std::vector<Vector2d> anchors;            ///< off the border
  std::vector<Vector2d> free;
};

/// Adds a point at each stop of the edge from a along `along`, and between them pieces of about
/// `spacing` (of level and of upright edges); the end of the edge is left to the next one.
void sample_edge(const Vector2d& a, const Vector2d& along, std::vector<double>& t,
                 const Vector2d& spacing, double tolerance, std::vector<Vector2d>& chain) {
  const double length = along.norm();
  const double piece = along.cwiseAbs().dot(spacing) / length;
  t.push_back(0);
  t.push_back(1);
  std::sort(t.begin(), t.end());
  t.erase(std::unique(t.begin(), t.end(),
                      [&](double s, double u) { return (u - s) * length <= tolerance; }),
          t.end());
  // The last stop may have been taken for the corner's double.
  t.back() = 1;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const double share = t[i + 1] - t[i];
    const auto pieces = std::max(1, static_cast<int>(std::lround(share * length / piece)));
    for (int k = 0; k < pieces; ++k) chain.push_back(a + (t[i] + share * k / pieces) * along);
  }
}

/// Border, holes and cuts in pieces, with a point at every corner, every anchor on them and every
/// end of a cut.
void sample_border(const Pattern& pattern, const std::vector<Vector2d>& anchors,
                   const Vector2d& spacing, Sites& sites) {
  std::vector<std::vector<double>> stops(edge_count(pattern));
  const double tolerance = kOnBorder * width(pattern);
  for (const Vector2d& p : anchors) {
    const BorderPoint b = nearest_on_border(pattern, p);
    if (b.distance > tolerance) {
      sites.anchors.push_back(p);
    } else {
      stops[b.edge].push_back(b.t);
    }
  }
  int first = edge_count({pattern.border, pattern.holes});  // edge of cut k
  Pattern others = pattern;
  for (std::size_t k = 0; k < pattern.cuts.size(); ++k) {
    others.cuts[k].clear();
    const auto own = static_cast<int>(pattern.cuts[k].size()) - 1;
    for (const Vector2d& end : {pattern.cuts[k].front(), pattern.cuts[k].back()}) {
      const BorderPoint b = nearest_on_border(others, end);
      if (b.distance > tolerance) continue;
      stops[b.edge < first ? b.edge : b.edge + own].push_back(b.t);
    }
    others.cuts[k] = pattern.cuts[k];
    first += own;
  }
  std::size_t e = 0;
  for (std::size_t k = 0; k < pattern.loop_count(); ++k) {
    const std::vector<Vector2d>& loop = pattern.loop(k);
    std::vector<Vector2d>& chain = sites.loops.emplace_back();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vector2d along = loop[(i + 1) % loop.size()] - loop[i];
      sample_edge(loop[i], along, stops[e++], spacing, tolerance, chain);
    }
  }
  for (const std::vector<Vector2d>& cut : pattern.cuts) {
    std::vector<Vector2d>& chain = sites.cuts.emplace_back();
    for (std::size_t i = 0; i + 1 < cut.size(); ++i)
      sample_edge(cut[i], cut[i + 1] - cut[i], stops[e++], spacing, tolerance, chain);
    chain.push_back(cut.back());
  }
}

/// Whether a lattice point can be a vertex beside border and anchors.
bool is_clear(const Pattern& pattern, const Sites& sites, const Vector2d& p, double clearance) {
  if (!contains(pattern, p)) return false;
  if (nearest_on_border(pattern, p).distance < clearance) return false;
  return std::none_of(sites.anchors.begin(), sites.anchors.end(),
                      [&](const Vector2d& a) { return (a - p).norm() < clearance; });
}

/// Hexagonal lattice of this spacing over the bounding box; rows are `row` apart.
std::vector<Vector2d> lattice(const Pattern& pattern, const Vector2d& spacing) {
  const Eigen::AlignedBox2d box = bounding_box(pattern);
  const Vector2d low = box.min(), size = box.sizes();
  std::vector<Vector2d> points;
  const int rows = static_cast<int>(size.y() / spacing.y() + 1e-6);
  const int columns = static_cast<int>(size.x() / spacing.x() + 1e-6);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      points.emplace_back(low.x() + (i + 0.5 * (j % 2)) * spacing.x(), low.y() + j * spacing.y());
    }
  }
  return points;
}

/// Horizontal and vertical spacing of a lattice of about this edge length; on a rectangle both
/// divide its sides, so that its rows meet the border.
Vector2d lattice_spacing(const Pattern& pattern, double edge) {
  const Vector2d size = bounding_box(pattern).sizes();
  const double row = edge * std::sqrt(3.0) / 2;
  // An even number of rows: the last one then starts at the corner, as the first does.
  return {size.x() / std::max(1.0, std::round(size.x() / edge)),
          size.y() / (2 * std::max(1.0, std::round(size.y() / (2 * row))))};
}

Sites equilateral_sites(const Pattern& pattern, const std::vector<Vector2d>& anchors, double edge) {
  Sites sites;
  const Vector2d spacing = lattice_spacing(pattern, edge);
  sample_border(pattern, anchors, spacing, sites);
  // Every other row of the lattice begins half an edge from an upright border: keep those points.
  const double clearance = 0.45 * spacing.minCoeff();
  for (const Vector2d& p : lattice(pattern, spacing)) {
    if (is_clear(pattern, sites, p, clearance)) sites.free.push_back(p);
  }
  return sites;
}

Sites delaunay_sites(const Pattern& pattern, const std::vector<Vector2d>& anchors, double edge,
                     std::uint64_t seed) {
  Sites sites;
  sample_border(pattern, anchors, {edge, edge}, sites);
  RandomStream random(seed, "uniform mesh");
  for (const Vector2d& p : lattice(pattern, {edge, edge * std::sqrt(3.0) / 2})) {
    const double radius = kJitter * edge * std::sqrt(random.uniform());
    const double angle = 2 * std::numbers::pi * random.uniform();
    const Vector2d q = p + radius * Vector2d(std::cos(angle), std::sin(angle));
    if (is_clear(pattern, sites, q, kClearance * edge)) sites.free.push_back(q);
  }
  return sites;
}

/// Points by squares of the plane, to find those within a tolerance.
class PointCells {
 public:
  PointCells(const std::vector<Vector2d>& points, double tolerance) : tolerance_(tolerance) {
    for (int i = 0; i < std::ssize(points); ++i) add(points[i], i);
  }
  void add(const Vector2d& p, int number) { cells_[cell_of(p)].push_back(number); }
  /// The lowest number of a point within the tolerance.
  [[nodiscard]] std::optional<int> first_near(const std::vector<Vector2d>& points,
                                              const Vector2d& p) const {
    std::optional<int> first;
    const auto [x, y] = cell_of(p);
    for (const double dx : {-1, 0, 1}) {
      for (const double dy : {-1, 0, 1}) {
        const auto cell = cells_.find({x + dx, y + dy});
        if (cell == cells_.end()) continue;
        for (const int i : cell->second) {
          if ((points[i] - p).norm() <= tolerance_ && (!first || i < *first)) first = i;
        }
      }
    }
    return first;
  }

 private:
  using Cell = std::pair<double, double>;
  [[nodiscard]] Cell cell_of(const Vector2d& p) const {
    // Wider than the tolerance, so that rounding hides nothing behind a neighbour.
    const double side = 4 * tolerance_;
    return {std::floor(p.x() / side), std::floor(p.y() / side)};
  }

  double tolerance_;
  std::map<Cell, std::vector<int>> cells_;
};

ShellMesh triangulate(const Sites& sites, double tolerance) {
  ShellMesh mesh;
  std::vector<Vector2d> points;
  std::vector<std::vector<int>> loops;
  for (const std::vector<Vector2d>& chain : sites.loops) {
    std::vector<int>& loop = loops.emplace_back(chain.size());
    std::iota(loop.begin(), loop.end(), static_cast<int>(points.size()));
    points.insert(points.end(), chain.begin(), chain.end());
  }
  std::vector<Eigen::Vector2i> segments;
  // A cut begins and ends at a point that is there, or at a tip.
  PointCells cells(points, tolerance);
  const auto point_at = [&](const Vector2d& p) {
    if (const auto there = cells.first_near(points, p)) return *there;
    cells.add(p, static_cast<int>(points.size()));
    points.push_back(p);
    return static_cast<int>(points.size()) - 1;
  };
  for (const std::vector<Vector2d>& cut : sites.cuts) {
    int last = point_at(cut.front());
    for (std::size_t i = 1; i < cut.size(); ++i) {
      const int here = point_at(cut[i]);
      segments.emplace_back(last, here);
      last = here;
    }
  }
  points.insert(points.end(), sites.anchors.begin(), sites.anchors.end());
  points.insert(points.end(), sites.free.begin(), sites.free.end());
  mesh.pattern.resize(points.size(), 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    mesh.pattern.row(i) = points[i];
  }
  mesh.triangles = constrained_delaunay(mesh.pattern, loops, segments);
  open_along(mesh, segments);
  return mesh;
}

/// Points twice as near to each other, about a place.
void refine_about(const Pattern& pattern, const Vector2d& place, double edge, Sites& sites) {
  const Vector2d spacing = lattice_spacing(pattern, edge) / 2;
  const double radius = kRefined * edge, clearance = 0.45 * spacing.minCoeff();
  std::vector<Vector2d> near;
  const auto note = [&](const Vector2d& p) {
    if ((p - place).norm() < radius + edge) near.push_back(p);
  };
  for (const Vector2d& p : sites.free) note(p);
  for (const Vector2d& p : sites.anchors) note(p);
  for (const Vector2d& p : lattice(pattern, spacing)) {
    if ((p - place).norm() > radius || !is_clear(pattern, sites, p, clearance)) continue;
    if (std::none_of(near.begin(), near.end(),
                     [&](const Vector2d& q) { return (p - q).norm() < clearance; })) {
      sites.free.push_back(p);
    }
  }
}

bool is_rectangle(const Pattern& pattern) {
  if (pattern.border.size() != 4 || !pattern.holes.empty() || !pattern.cuts.empty()) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d side = pattern.border[(i + 1) % 4] - pattern.border[i];
    if (side.x() != 0 && side.y() != 0) return false;
  }
  return true;
}

ShellMesh structured_mesh(const Pattern& pattern, int triangles) {
  const Vector2d low = pattern.border[0].cwiseMin(pattern.border[2]);
  const Vector2d high = pattern.border[0].cwiseMax(pattern.border[2]);
  const Vector2d size = high - low;
  const double cell = std::sqrt(2 * size.x() * size.y() / triangles);
  const int nx = std::max(1, static_cast<int>(std::lround(size.x() / cell)));
  const int ny =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(triangles) / (2.0 * nx))));
  ShellMesh mesh;
  mesh.pattern.resize((nx + 1) * (ny + 1), 2);
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      mesh.pattern.row(j * (nx + 1) + i) =
          Vector2d(i == nx ? high.x() : low.x() + size.x() * i / nx,
                   j == ny ? high.y() : low.y() + size.y() * j / ny);
    }
  }
  mesh.triangles.resize(2 * nx * ny, 3);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int a = j * (nx + 1) + i, b = a + 1, d = a + nx + 1, c = d + 1;
      const int row = 2 * (j * nx + i);
      if ((i + j) % 2 == 0) {
        mesh.triangles.row(row) = Eigen::Vector3i(a, b, c);
        mesh.triangles.row(row + 1) = Eigen::Vector3i(a, c, d);
      } else {
        mesh.triangles.row(row) = Eigen::Vector3i(a, b, d);
        mesh.triangles.row(row + 1) = Eigen::Vector3i(b, c, d);
      }
    }
  }
  return mesh;
}

std::vector<Vector2d> distinct(const std::vector<Vector2d>& points, double tolerance) {
  std::vector<Vector2d> kept;
  for (const Vector2d& p : points) {
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const Vector2d& q) { return (p - q).norm() <= tolerance; })) {
      kept.push_back(p);
    }
  }
  return kept;
}

}  // namespace

double equilateral_edge(double area, double triangles) {
  return std::sqrt(4 * area / (std::sqrt(3.0) * triangles));
}

void require_lattice(const Pattern& pattern, double edge) {
  const Vector2d size = bounding_box(pattern).sizes();
  const double row = edge * std::sqrt(3.0) / 2;
  const double points = (size.x() / edge + 1) * (size.y() / row + 1) + perimeter(pattern) / edge;
  std::ostringstream what;
  what << "points of a mesh with edges of " << edge << " m";
  require_count(points, what.str(), kMostPoints, "scene.pattern");
}

ShellMesh lattice_mesh(const Pattern& pattern, double edge, UniformLayout layout,
                       const std::vector<Vector2d>& anchors, std::uint64_t seed,
                       const std::vector<Vector2d>& finer_at) {
  Sites sites = layout == UniformLayout::delaunay ? delaunay_sites(pattern, anchors, edge, seed)
                                                  : equilateral_sites(pattern, anchors, edge);
  for (const Vector2d& p : finer_at) refine_about(pattern, p, edge, sites);
  return triangulate(sites, kOnBorder * width(pattern));
}

double uniform_edge(const Pattern& pattern, int triangles, UniformLayout layout,
                    const std::vector<Vector2d>& anchors, std::uint64_t seed) {
  const Pattern whole{pattern.border, pattern.holes};
  const double edge = equilateral_edge(signed_area(whole), triangles);
  // The border costs more or fewer triangles than its area says: corrected once.
  const ShellMesh mesh = lattice_mesh(whole, edge, layout, anchors, seed);
  return edge * std::sqrt(static_cast<double>(mesh.triangle_count()) / triangles);
}

ShellMesh uniform_mesh(const Pattern& pattern, int triangles, UniformLayout layout,
                       const std::vector<Vector2d>& anchors, std::uint64_t seed) {
  require_simple(pattern, "pattern");
  if (triangles < 2) throw Error("uniform mesh of too few triangles", "triangles", ">= 2");
  require_lattice(pattern, equilateral_edge(signed_area(pattern), triangles));
  const double tolerance = kOnBorder * width(pattern);
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (!contains(pattern, anchors[i], tolerance)) {
      throw Error("anchor lies outside the pattern", "anchor " + std::to_string(i));
    }
  }
  const std::vector<Vector2d> held = distinct(anchors, tolerance);
  if (layout == UniformLayout::automatic) {
    layout = is_rectangle(pattern) ? UniformLayout::structured : UniformLayout::equilateral;
  }
  if (layout != UniformLayout::structured) {
    const double edge = uniform_edge(pattern, triangles, layout, held, seed);
    return lattice_mesh(pattern, edge, layout, held, seed);
  }
  if (!is_rectangle(pattern)) {
    throw Error("structured layout of a pattern that is no upright rectangle", "layout",
                "equilateral, delaunay");
  }
  return with_anchors(structured_mesh(pattern, triangles), pattern, held);
}

std::vector<Eigen::Vector2d> handle_points(const Sheet& sheet, double edge) {
  const double tolerance = 1e-9 * width(sheet.pattern);
  const auto on_border = [&](const Eigen::Vector2d& p) {
    return nearest_on_border(sheet.pattern, p).distance <= tolerance;
  };
  std::vector<Eigen::Vector2d> points;
  for (const Handle& handle : sheet.handles) {
    const std::vector<Eigen::Vector2d> anchors = handle.anchors();
    points.insert(points.end(), anchors.begin(), anchors.end());
    if (!handle.segment) continue;
    const auto& [a, b] = *handle.segment;
    if (on_border(a) && on_border((a + b) / 2) && on_border(b)) continue;
    const auto pieces = static_cast<int>(std::ceil((b - a).norm() / edge));
    for (int i = 1; i < pieces; ++i) points.emplace_back(a + (b - a) * i / pieces);
  }
  return points;
}

ShellState resting_state(const Sheet& sheet, ShellMesh mesh, std::uint64_t seed) {
  ShellState state;
  state.mesh = std::move(mesh);
  const int n = state.mesh.vertex_count(), m = state.mesh.triangle_count();
  state.x.resize(n, 3);
  for (int i = 0; i < n; ++i) {
    state.x.row(i) = sheet.rest_place(state.mesh.pattern.row(i), seed);
  }
  state.v = Eigen::MatrixX3d::Zero(n, 3);
  state.plastic_curvature = Eigen::MatrixX3d::Zero(m, 3);
  state.damage = Eigen::VectorXd::Zero(m);
  return state;
}

}  // namespace geoprior::paper
