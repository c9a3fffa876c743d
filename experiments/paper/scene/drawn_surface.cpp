#include "experiments/paper/scene/drawn_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/angles.h"
#include "core/connectivity.h"
#include "core/disjoint_sets.h"
#include "core/geometry/planar.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kFlat = 0;  ///< of the array "kind"

bool is_along(const Vector3d& normal, const Vector3d& mean) {
  return normal.dot(mean) > std::cos(DrawnSurface::kUneven * kDegree);
}

/// The sheet of a frame with what is asked of its edges.
class SheetEdges {
 public:
  explicit SheetEdges(const Part& surface)
      : mesh_{surface.points, surface.triangles},
        pattern_(surface.require_array("pattern", NamedArray::On::points, 2).values),
        plastic_(surface.require_array("plastic_curvature", NamedArray::On::cells, 3).values),
        edges_(mesh_.F),
        normals_(triangle_normals(mesh_)),
        plane_(plane_triangles(surface)) {
    for (int e = 0; e < edges_.edge_count(); ++e) sharp_.push_back(is_sharp(e));
  }

  [[nodiscard]] const TriMesh& mesh() const { return mesh_; }
  [[nodiscard]] const EdgeConnectivity& edges() const { return edges_; }
  [[nodiscard]] bool sharp(int e) const { return sharp_[e]; }
  [[nodiscard]] Vector3d place(int v) const { return mesh_.V.row(v); }
  [[nodiscard]] Vector3d normal(int triangle) const { return normals_.row(triangle); }
  [[nodiscard]] bool is_plane(int triangle) const { return plane_[triangle]; }

  /// Height of the triangle of a half-edge over it (m).
  [[nodiscard]] double width(int h) const {
    const Vector3d a = place(edges_.origin(h));
    const Vector3d d = place(edges_.tip(h)) - a;
    const Vector3d c = place(edges_.origin(EdgeConnectivity::previous(h))) - a;
    return d.cross(c).norm() / std::max(d.norm(), 1e-12);
  }

  /// The corner at the tip of a half-edge, in its triangle; at its origin it is h itself.
  static int tip_corner(int h) { return EdgeConnectivity::next(h); }

  /// Joins the corners on both sides of an edge, at each of its ends.
  void join_across(int e, DisjointSets& corners) const {
    const auto both = edges_.half_edges(e);
    if (both.size() != 2) return;
    corners.join(both[0], tip_corner(both[1]));
    corners.join(both[1], tip_corner(both[0]));
  }

 private:
  /// Triangles of flat pieces that are: all of a piece have its normal, up to kUneven.
  [[nodiscard]] std::vector<bool> plane_triangles(const Part& surface) const {
    std::vector<bool> plane(mesh_.triangle_count(), false);
    const NamedArray* kind = surface.find_array("kind", NamedArray::On::cells);
    const NamedArray* piece = surface.find_array("piece", NamedArray::On::cells);
    if (kind == nullptr || piece == nullptr) return plane;
    std::map<double, std::vector<int>> flat;
    for (int t = 0; t < mesh_.triangle_count(); ++t) {
      if (kind->values(t, 0) == kFlat) flat[piece->values(t, 0)].push_back(t);
    }
    const Eigen::VectorXd areas = triangle_areas(mesh_.V, mesh_.F);
    for (const auto& [number, triangles] : flat) {
      Vector3d mean = Vector3d::Zero();
      for (const int t : triangles) mean += areas[t] * normal(t);
      const bool is_plane = std::all_of(triangles.begin(), triangles.end(), [&](int t) {
        return is_along(normal(t), mean.normalized());
      });
      for (const int t : triangles) plane[t] = is_plane;
    }
    return plane;
  }

  /// Fold that stays when the sheet is let go, of the strip that the edge stands for (rad).
  [[nodiscard]] double yielded_fold(int e) const {
    const auto [u, v] = edges_.edge(e);
    const Vector2d a = pattern_.row(u), b = pattern_.row(v);
    const double length = (b - a).norm();
    if (!(length > 0)) return 0;
    const Vector2d n = Vector2d((a - b).y(), (b - a).x()) / length;
    double fold = 0;
    for (const int h : edges_.half_edges(e)) {
      const Vector2d c = pattern_.row(edges_.origin(EdgeConnectivity::previous(h)));
      const Eigen::RowVector3d s = plastic_.row(h / 3);
      const double curvature =
          s[0] * n.x() * n.x() + 2 * s[1] * n.x() * n.y() + s[2] * n.y() * n.y();
      fold += curvature * std::abs(cross(b - a, c - a)) / length / 3;
    }
    return std::abs(fold);
  }

  [[nodiscard]] bool is_sharp(int e) const {
    const auto both = edges_.half_edges(e);
    if (both.size() != 2) return true;
    const double cosine = normal(both[0] / 3).dot(normal(both[1] / 3));
    if (cosine < std::cos(DrawnSurface::kSharpFold * kDegree)) return true;
    return cosine < std::cos(DrawnSurface::kYieldedFold * kDegree) &&
           yielded_fold(e) > DrawnSurface::kYieldedFold * kDegree;
  }

  TriMesh mesh_;
  Eigen::MatrixX2d pattern_;
  Eigen::MatrixX3d plastic_;
  EdgeConnectivity edges_;
  Eigen::MatrixX3d normals_;
  std::vector<bool> plane_;
  std::vector<bool> sharp_;
};

/// Of each corner, 3 t + k: the normal of the triangles that no sharp edge parts from it there.
Eigen::MatrixX3d smooth_normals(const SheetEdges& sheet) {
  const Eigen::MatrixX3i& F = sheet.mesh().F;
  DisjointSets groups(3 * static_cast<int>(F.rows()));
  for (int e = 0; e < sheet.edges().edge_count(); ++e) {
    if (!sheet.sharp(e)) sheet.join_across(e, groups);
  }
  Eigen::MatrixX3d sum = Eigen::MatrixX3d::Zero(3 * F.rows(), 3);
  for (int c = 0; c < groups.size(); ++c) {
    const Vector3d v = sheet.place(F(c / 3, c % 3));
    const Vector3d e = sheet.place(F(c / 3, (c + 1) % 3)) - v;
    const Vector3d f = sheet.place(F(c / 3, (c + 2) % 3)) - v;
    const double squares = e.squaredNorm() * f.squaredNorm();
    if (squares > 0) sum.row(groups.find(c)) += e.cross(f) / squares;
  }
  Eigen::MatrixX3d normals(sum.rows(), 3);
  for (int c = 0; c < groups.size(); ++c) {
    const Eigen::RowVector3d n = sum.row(groups.find(c));
    normals.row(c) = n.squaredNorm() > 0 ? n.normalized() : sheet.normal(c / 3).transpose();
  }
  return normals;
}

/// Half-edges along a line, by side: those that run as it does, and those that run back.
using Sides = std::array<std::vector<int>, 2>;

/// Finds the rulings among the edges of the sheet: their points are vertices of it, bit for bit.
class RulingFinder {
 public:
  explicit RulingFinder(const SheetEdges& sheet) : sheet_(sheet) {
    for (int v = 0; v < sheet.mesh().vertex_count(); ++v) at_[key(sheet.place(v))].push_back(v);
  }

  [[nodiscard]] Sides sides(const Part& rulings, const std::vector<int>& line) const {
    Sides sides;
    const EdgeConnectivity& edges = sheet_.edges();
    for (std::size_t i = 1; i < line.size(); ++i) {
      for (const int u : vertices(rulings.points.row(line[i - 1]))) {
        for (const int v : vertices(rulings.points.row(line[i]))) {
          const auto e = edges.find(u, v);
          if (!e) continue;
          for (const int h : edges.half_edges(*e)) sides[edges.origin(h) == u ? 0 : 1].push_back(h);
        }
      }
    }
    return sides;
  }

 private:
  using Key = std::array<double, 3>;
  static Key key(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }
  [[nodiscard]] std::vector<int> vertices(const Vector3d& p) const {
    const auto found = at_.find(key(p));
    return found == at_.end() ? std::vector<int>{} : found->second;
  }

  const SheetEdges& sheet_;
  std::map<Key, std::vector<int>> at_;
};

/// What lies at one side of a ruling.
struct Side {
  Vector3d normal = Vector3d::Zero();
  double width = 0;  ///< m
  bool plane = true;
};

Side side_of(const SheetEdges& sheet, const std::vector<int>& half_edges) {
  Side side;
  double length = 0;
  for (const int h : half_edges) {
    const double l =
        (sheet.place(sheet.edges().tip(h)) - sheet.place(sheet.edges().origin(h))).norm();
    side.normal += l * sheet.normal(h / 3);
    side.width += l * sheet.width(h);
    length += l;
    side.plane = side.plane && sheet.is_plane(h / 3);
  }
  side.normal.normalize();
  side.width = std::max(side.width / length, 1e-9);
  return side;
}

/// Whether the sheet is as even along a ruling as it says: a mesh may have bent across it since.
bool is_held(const SheetEdges& sheet, const std::vector<int>& half_edges, const Side& side) {
  return std::all_of(half_edges.begin(), half_edges.end(),
                     [&](int h) { return is_along(sheet.normal(h / 3), side.normal); });
}

/// Normal of a ruling for each of its sides; two where it is a crease, none where it is not held.
std::optional<std::array<Vector3d, 2>> ruling_normals(const SheetEdges& sheet, const Sides& sides) {
  const Side left = side_of(sheet, sides[0]), right = side_of(sheet, sides[1]);
  if (!is_held(sheet, sides[0], left) || !is_held(sheet, sides[1], right)) return std::nullopt;
  const bool sharp = std::any_of(sides[0].begin(), sides[0].end(),
                                 [&](int h) { return sheet.sharp(sheet.edges().edge_of(h)); });
  if (sharp) return std::array{left.normal, right.normal};
  const Vector3d mean = (left.normal / left.width + right.normal / right.width).normalized();
  const Vector3d n = left.plane == right.plane ? mean : left.plane ? left.normal : right.normal;
  return std::array{n, n};
}

/// The normals that rulings have, by half-edge, and those that corners beside them have.
class RulingNormals {
 public:
  RulingNormals(const SheetEdges& sheet, const Part& rulings)
      : along_(sheet.edges().half_edge_count()), sectors_(sheet.edges().half_edge_count()) {
    const RulingFinder finder(sheet);
    for (const std::vector<int>& line : rulings.lines) {
      const Sides sides = finder.sides(rulings, line);
      if (sides[0].empty() || sides[1].empty()) continue;
      const auto normals = ruling_normals(sheet, sides);
      if (!normals) continue;
      for (const int s : {0, 1}) {
        for (const int h : sides[s]) along_[h] = (*normals)[s];
      }
    }
    for (int e = 0; e < sheet.edges().edge_count(); ++e) {
      if (!along_[sheet.edges().half_edges(e)[0]] && !sheet.sharp(e)) {
        sheet.join_across(e, sectors_);
      }
    }
    gather();
  }

  [[nodiscard]] const std::optional<Vector3d>& along(int half_edge) const {
    return along_[half_edge];
  }
  /// Of the rulings that bound a corner's sector: none, their one normal, or those of an apex.
  [[nodiscard]] const std::vector<Vector3d>& at(int corner) {
    return of_sector_[sectors_.find(corner)];
  }

 private:
  void gather() {
    constexpr double kSame = 1e-6;  // rad
    of_sector_.resize(along_.size());
    for (int h = 0; h < std::ssize(along_); ++h) {
      if (!along_[h]) continue;
      for (const int corner : {h, SheetEdges::tip_corner(h)}) {
        std::vector<Vector3d>& known = of_sector_[sectors_.find(corner)];
        const bool is_known = std::any_of(known.begin(), known.end(), [&](const Vector3d& n) {
          return n.dot(*along_[h]) > std::cos(kSame);
        });
        if (!is_known) known.push_back(*along_[h]);
      }
    }
  }

  std::vector<std::optional<Vector3d>> along_;
  DisjointSets sectors_;
  std::vector<std::vector<Vector3d>> of_sector_;
};

/// The nearest whole number of units: what is left to store are few digits.
Eigen::MatrixX3d rounded(const Eigen::MatrixX3d& values, double unit) {
  return unit * (values / unit).array().round();
}

void add_cells(const Part& surface, const std::string& name, const std::vector<int>& parent,
               Part& drawn) {
  const NamedArray* array = surface.find_array(name, NamedArray::On::cells);
  if (array == nullptr) return;
  NamedArray& values = drawn.arrays.emplace_back(*array);
  values.values.resize(parent.size(), array->values.cols());
  for (Eigen::Index t = 0; t < std::ssize(parent); ++t) {
    values.values.row(t) = array->values.row(parent[t]);
  }
}

}  // namespace

EdgeNormals paper_normals(const Part& surface, const Part* rulings) {
  const SheetEdges sheet(surface);
  Eigen::MatrixX3d normals = smooth_normals(sheet);
  std::vector<bool> apex(normals.rows(), false);
  std::optional<RulingNormals> ruled;
  if (rulings != nullptr) ruled.emplace(sheet, *rulings);
  for (int c = 0; ruled && c < normals.rows(); ++c) {
    const std::vector<Vector3d>& known = ruled->at(c);
    apex[c] = known.size() > 1;
    if (known.size() == 1) normals.row(c) = known[0];
  }
  EdgeNormals out = EdgeNormals::zero(surface.triangles.rows());
  for (int h = 0; h < normals.rows(); ++h) {
    const int tip = SheetEdges::tip_corner(h);
    const auto at = [&](int corner, int other) -> Vector3d {
      if (!apex[corner]) return normals.row(corner);
      if (ruled->along(h)) return *ruled->along(h);
      if (!apex[other]) return normals.row(other);
      return sheet.normal(h / 3);
    };
    out.origin.row(h) = at(h, tip);
    out.tip.row(h) = at(tip, h);
  }
  return out;
}

CurvedSampling paper_sampling(const Part& surface) {
  const Eigen::MatrixX2d pattern =
      surface.require_array("pattern", NamedArray::On::points, 2).values;
  double area = 0;
  for (const auto& t : surface.triangles.rowwise()) {
    const Vector2d a = pattern.row(t[0]), b = pattern.row(t[1]), c = pattern.row(t[2]);
    area += cross(b - a, c - a) / 2;
  }
  return {.tolerance = DrawnSurface::kTolerance,
          .angle = DrawnSurface::kTurn * kDegree,
          .shortest = DrawnSurface::kShortest * std::sqrt(std::abs(area)),
          .farthest = DrawnSurface::kFarthest};
}

void add_drawn_surface(Frame& frame) {
  const Part& surface = frame.require_part("surface");
  const EdgeNormals normals = paper_normals(surface, frame.find_part("rulings"));
  const CurvedSurface curved =
      curved_surface({surface.points, surface.triangles}, normals, paper_sampling(surface));
  Part drawn;
  drawn.points = rounded(curved.mesh.V, DrawnSurface::kPlaceUnit);
  drawn.triangles = curved.mesh.F;
  drawn.arrays.push_back(
      {"normal", "1", NamedArray::On::points, rounded(curved.normals, DrawnSurface::kNormalUnit)});
  add_cells(surface, "piece", curved.parent, drawn);
  add_cells(surface, "kind", curved.parent, drawn);
  frame.diagnostics["drawn_distance"] = curved.distance;
  frame.parts[DrawnSurface::kPart] = std::move(drawn);
}

}  // namespace geoprior::paper
