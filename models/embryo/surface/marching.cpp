#include "models/embryo/surface/marching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "core/error.h"
#include "models/embryo/surface/lattice_table.h"

namespace geoprior::embryo {
namespace {

using Eigen::Vector3d;

/// Of the lattice, in halves of boxes: all even (a corner) or all odd (a centre).
using LatticePoint = std::array<int, 3>;

constexpr int kOffset = 1 << 19;         ///< added to coordinates in keys of 20 bits each
constexpr int kFarthest = kOffset - 64;  ///< of a coordinate from the origin
constexpr double kKeepOff = 1e-5;        ///< of vertices from the ends of their edges
constexpr double kTolerance = 5e-4;      ///< from vertex to surface, in smallest radii
/// And in distances from the nearer end of the edge: vertices close to a point of the lattice are
/// close to each other, and small triangles need good places for their normals.
constexpr double kNearTolerance = 3e-3;
constexpr int kMostSteps = 40;  ///< two are common

/// The corners of a tetrahedron whose order it keeps oriented, with the inside ones first: a row
/// for each set of inside corners.
struct TetrahedronCase {
  int inside = 0;
  std::array<int, 4> order{0, 1, 2, 3};
};
constexpr std::array<TetrahedronCase, 16> kCases = [] {
  std::array<TetrahedronCase, 16> out{};
  for (int mask = 1; mask < 15; ++mask) {
    // The twelve even permutations of the corners.
    constexpr std::array<std::array<int, 4>, 12> kEven = {{{0, 1, 2, 3},
                                                           {0, 2, 3, 1},
                                                           {0, 3, 1, 2},
                                                           {1, 0, 3, 2},
                                                           {1, 2, 0, 3},
                                                           {1, 3, 2, 0},
                                                           {2, 3, 0, 1},
                                                           {2, 0, 1, 3},
                                                           {2, 1, 3, 0},
                                                           {3, 2, 1, 0},
                                                           {3, 0, 2, 1},
                                                           {3, 1, 0, 2}}};
    for (const auto& order : kEven) {
      int first = 0;
      while (first < 4 && (mask >> order[first] & 1) != 0) ++first;
      int count = 0;
      for (int corner = 0; corner < 4; ++corner) count += mask >> corner & 1;
      if (first != count) continue;
      out[mask] = {count, order};
      break;
    }
  }
  return out;
}();

std::uint64_t key_of(const LatticePoint& p) {
  return (std::uint64_t(p[0] + kOffset) << 40) | (std::uint64_t(p[1] + kOffset) << 20) |
         std::uint64_t(p[2] + kOffset);
}

/// Of an edge: the corner of a box that it leaves and one of eight directions, or the lower of two
/// points two halves apart and one of three.
std::uint64_t edge_key(const LatticePoint& p, const LatticePoint& q) {
  const std::array<int, 3> d = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
  if (d[0] != 0 && d[1] != 0) {
    const bool p_is_corner = (p[0] & 1) == 0;
    const int sign = p_is_corner ? 1 : -1;
    const int direction = (sign * d[0] > 0) | (sign * d[1] > 0) << 1 | (sign * d[2] > 0) << 2;
    return key_of(p_is_corner ? p : q) << 4 | std::uint64_t(direction);
  }
  const int axis = d[0] != 0 ? 0 : d[1] != 0 ? 1 : 2;
  return key_of(d[axis] > 0 ? p : q) << 4 | std::uint64_t(8 + axis);
}

/// Order of places that a mirror in a plane of the axes keeps, as far as there is one.
bool is_before(const LatticePoint& p, const LatticePoint& q) {
  const auto without_signs = [](const LatticePoint& a) {
    return LatticePoint{std::abs(a[0]), std::abs(a[1]), std::abs(a[2])};
  };
  const LatticePoint a = without_signs(p), b = without_signs(q);
  return a != b ? a < b : p < q;
}

class Marching {
 public:
  Marching(const SolidField& field, const Lattice& lattice, const MarchOptions& options,
           const std::string& where)
      : field_(field),
        lattice_(lattice),
        options_(options),
        where_(where),
        graded_(!lattice.growth.isZero(0)),
        tolerance_(kTolerance * field.smallest_radius()),
        least_slope_(field.least_slope()) {}

  MarchedSurface run() {
    enclose();
    measure_levels();
    visit(low_, levels_, field_.all_pieces());
    return result();
  }

 private:
  /// A vertex in the lattice's own axes (m), for the diagonals, and in the world.
  struct Vertex {
    Vector3d local, world;
  };

  void enclose();
  void measure_levels();
  void visit(const LatticePoint& low, int level, const SolidField::Near& near);
  void visit_box(const LatticePoint& center);
  void cut(const std::array<LatticePoint, 4>& corner, const std::array<double, 4>& f);
  void add(const std::array<int, 3>& triangle);
  int vertex(const LatticePoint& p, double f_p, const LatticePoint& q, double f_q);
  Vector3d crossing(const LatticePoint& p, double f_p, const LatticePoint& q, double f_q);
  struct Extent {
    double change = 0;  ///< of the field between the centre and any point, at most
    double reach = 0;   ///< of the points from the centre (m)
  };
  [[nodiscard]] Extent extent_of(const LatticePoint& center, int level) const;
  double value(const LatticePoint& p);
  double evaluate(const Vector3d& x);
  MarchedSurface result();

  /// In the lattice's axes, from its origin.
  [[nodiscard]] Vector3d local(const LatticePoint& p) const {
    return {lattice_.place(0, p[0]), lattice_.place(1, p[1]), lattice_.place(2, p[2])};
  }
  [[nodiscard]] Vector3d world(const Vector3d& x) const {
    return lattice_.origin + lattice_.axes * x;
  }

  const SolidField& field_;
  const Lattice& lattice_;
  const MarchOptions& options_;
  const std::string& where_;
  const bool graded_;         ///< whether boxes differ in size
  const double tolerance_;    ///< from a vertex to the surface (m)
  const double least_slope_;  ///< of the field on the surface

  LatticePoint low_{};                  ///< lowest corner of the root
  int levels_ = 0;                      ///< the root has 2^levels boxes along each axis
  std::vector<Extent> extents_;         ///< of the nodes of each level, if all boxes are alike
  std::vector<SolidField::Near> near_;  ///< of the node of each level that is being visited
  const SolidField::Near* here_ = nullptr;

  LatticeTable<double> values_{4096};
  LatticeTable<int> vertex_of_edge_{4096};
  std::vector<Vertex> vertices_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> members_;
  double deviation_ = 0;
  int evaluations_ = 0;
};

/// The root: boxes around the solid, one more on each side, 2^levels of them along each axis.
void Marching::enclose() {
  int most = 2;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d direction = lattice_.axes.col(axis);
    const double from = -field_.support(-direction) - direction.dot(lattice_.origin);
    const double to = field_.support(direction) - direction.dot(lattice_.origin);
    const double first = std::floor(lattice_.halves(axis, from) / 2) - 1,
                 last = std::ceil(lattice_.halves(axis, to) / 2) + 1;
    if (!(4 * std::max(std::abs(first), std::abs(last)) < kFarthest))
      throw Error("its smallest radius asks for too many cells along an axis", where_,
                  "up to " + std::to_string(kFarthest / 4) + " from the lattice's origin");
    low_[axis] = 2 * static_cast<int>(first);
    most = std::max(most, static_cast<int>(last - first));
  }
  while ((1 << levels_) < most) ++levels_;
  if (3 * (1 << levels_) > kFarthest)
    throw Error("its smallest radius asks for too many cells along an axis", where_,
                "up to " + std::to_string(kFarthest / 4));
}

void Marching::measure_levels() {
  for (int level = 0; level <= levels_ && !graded_; ++level)
    extents_.push_back(extent_of({0, 0, 0}, level));
  near_.assign(levels_ + 1, field_.all_pieces());
}

/// The tetrahedra of a node are those of its boxes, which reach the centres of the next ones along
/// each axis. All lie in the hull of their outer points.
Marching::Extent Marching::extent_of(const LatticePoint& center, int level) const {
  const int s = 1 << level, inner = s - 1;
  const Vector3d middle = local(center);
  Extent out;
  const auto include = [&](int x, int y, int z) {
    const Vector3d d =
        lattice_.axes * (local({center[0] + x, center[1] + y, center[2] + z}) - middle);
    out.change = std::max(out.change, field_.change(d));
    out.reach = std::max(out.reach, d.norm());
  };
  for (const int a : {-1, 1})
    for (const int b : {-1, 1}) {
      for (const int c : {-1, 1}) include(a * s, b * s, c * s);
      include(s + 1, a * inner, b * inner);
      include(a * inner, s + 1, b * inner);
      include(a * inner, b * inner, s + 1);
    }
  return out;
}

double Marching::evaluate(const Vector3d& x) {
  ++evaluations_;
  return options_.skip ? field_.value(x, *here_) : field_.value(x);
}

double Marching::value(const LatticePoint& p) {
  const auto [f, fresh] = values_[key_of(p)];
  if (fresh) f = evaluate(world(local(p)));
  return f;
}

void Marching::visit(const LatticePoint& low, int level, const SolidField::Near& near) {
  const int half = 1 << level;  // of the node, in halves of boxes
  const LatticePoint center = {low[0] + half, low[1] + half, low[2] + half};
  here_ = &near;
  if (options_.skip) {
    const Extent extent = graded_ ? extent_of(center, level) : extents_[level];
    if (std::abs(value(center)) > extent.change) return;
    field_.narrow(near, world(local(center)), extent.reach, near_[level]);
  }
  here_ = &near_[level];
  if (level == 0) return visit_box(center);
  for (int k = 0; k < 8; ++k)
    visit({low[0] + (k & 1) * half, low[1] + (k >> 1 & 1) * half, low[2] + (k >> 2) * half},
          level - 1, near_[level]);
}

void Marching::visit_box(const LatticePoint& center) {
  // The corners of a face around its axis, counter-clockwise seen against it.
  constexpr std::array<std::array<int, 2>, 4> kAround = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  const double f_center = value(center);
  std::array<double, 8> corner;  // bit 0, 1, 2 of the index: above the centre in x, y, z
  std::array<double, 3> next;    // centres
  for (int k = 0; k < 8; ++k)
    corner[k] = value({center[0] + 2 * (k & 1) - 1, center[1] + 2 * (k >> 1 & 1) - 1,
                       center[2] + 2 * (k >> 2) - 1});
  for (int axis = 0; axis < 3; ++axis) {
    LatticePoint beside = center;
    beside[axis] += 2;
    next[axis] = value(beside);
  }
  const auto as_center = [&](double f) { return (f < 0) == (f_center < 0); };
  if (std::all_of(corner.begin(), corner.end(), as_center) &&
      std::all_of(next.begin(), next.end(), as_center))
    return;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    LatticePoint beside = center;
    beside[axis] += 2;
    std::array<LatticePoint, 4> face;
    std::array<double, 4> f;
    for (int k = 0; k < 4; ++k) {
      face[k] = center;
      face[k][axis] += 1;
      face[k][u] += 2 * kAround[k][0] - 1;
      face[k][v] += 2 * kAround[k][1] - 1;
      f[k] = corner[1 << axis | kAround[k][0] << u | kAround[k][1] << v];
    }
    for (int k = 0; k < 4; ++k) {
      const int l = (k + 1) % 4;
      cut({center, beside, face[k], face[l]}, {f_center, next[axis], f[k], f[l]});
    }
  }
}

/// The surface within one tetrahedron. A value of 0 is outside.
void Marching::cut(const std::array<LatticePoint, 4>& corner, const std::array<double, 4>& f) {
  int mask = 0;
  for (int k = 0; k < 4; ++k) mask |= (f[k] < 0) << k;
  const auto& [inside, order] = kCases[mask];
  if (inside == 0) return;
  const auto on = [&](int i, int j) {
    return vertex(corner[order[i]], f[order[i]], corner[order[j]], f[order[j]]);
  };
  if (inside == 1) return add({on(0, 1), on(0, 2), on(0, 3)});
  if (inside == 3) return add({on(0, 3), on(1, 3), on(2, 3)});
  const std::array<int, 4> quad = {on(0, 2), on(0, 3), on(1, 3), on(1, 2)};
  const auto squared = [&](int i, int j) {
    return (vertices_[quad[i]].local - vertices_[quad[j]].local).squaredNorm();
  };
  const double first = squared(0, 2), second = squared(1, 3);
  bool along_first = first < second;
  if (std::abs(first - second) <= 1e-9 * (first + second))
    along_first = is_before(corner[order[0]], corner[order[1]]) ==
                  is_before(corner[order[2]], corner[order[3]]);
  const int shift = along_first ? 0 : 1;
  add({quad[shift], quad[shift + 1], quad[shift + 2]});
  add({quad[shift], quad[shift + 2], quad[(shift + 3) % 4]});
}

void Marching::add(const std::array<int, 3>& triangle) {
  if (static_cast<int>(triangles_.size()) >= options_.most_triangles)
    throw Error("its surface needs too many triangles", where_,
                "up to " + std::to_string(options_.most_triangles));
  triangles_.push_back(triangle);
  const Vector3d middle =
      (vertices_[triangle[0]].world + vertices_[triangle[1]].world + vertices_[triangle[2]].world) /
      3;
  members_.push_back(field_.solids().size() == 1 ? 0 : field_.nearest_member(middle, *here_));
}

int Marching::vertex(const LatticePoint& p, double f_p, const LatticePoint& q, double f_q) {
  const auto [index, fresh] = vertex_of_edge_[edge_key(p, q)];
  if (!fresh) return index;
  index = static_cast<int>(vertices_.size());
  const Vector3d at = f_p < 0 ? crossing(p, f_p, q, f_q) : crossing(q, f_q, p, f_p);
  vertices_.push_back({at, world(at)});
  return index;
}

/// The zero between an inside point and an outside one, in the lattice's axes: false position, with
/// the end that stays too long given half its weight (Illinois).
Vector3d Marching::crossing(const LatticePoint& p, double f_p, const LatticePoint& q, double f_q) {
  const Vector3d from = local(p), along = local(q) - from;
  const double length = along.norm();
  const double slope = std::max((f_q - f_p) / length, least_slope_);
  double low = 0, high = 1, f_low = f_p, f_high = f_q, t = 0, f = 0;
  int last = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    t = (low * f_high - high * f_low) / (f_high - f_low);
    if (!(t > low && t < high)) t = 0.5 * (low + high);
    t = std::clamp(t, kKeepOff, 1 - kKeepOff);
    f = evaluate(world(from + t * along));
    const double near = kNearTolerance * length * std::min(t, 1 - t);
    if (std::abs(f) <= slope * std::min(tolerance_, near) || high - low < kKeepOff / 10) break;
    const int side = f < 0 ? -1 : 1;
    if ((side < 0 && t >= 1 - kKeepOff) || (side > 0 && t <= kKeepOff)) break;
    (side < 0 ? low : high) = t;
    (side < 0 ? f_low : f_high) = f;
    if (side == last) (side < 0 ? f_high : f_low) /= 2;
    last = side;
  }
  deviation_ = std::max(deviation_, std::abs(f) / slope);
  return from + t * along;
}

MarchedSurface Marching::result() {
  MarchedSurface out;
  out.mesh.V.resize(static_cast<int>(vertices_.size()), 3);
  for (int v = 0; v < static_cast<int>(vertices_.size()); ++v)
    out.mesh.V.row(v) = vertices_[v].world.transpose();
  out.mesh.F.resize(static_cast<int>(triangles_.size()), 3);
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
    for (int k = 0; k < 3; ++k) out.mesh.F(t, k) = triangles_[t][k];
  out.member_of_triangle = std::move(members_);
  out.deviation = deviation_;
  out.evaluations = evaluations_;
  return out;
}

}  // namespace

double Lattice::place(int axis, double halves) const {
  const double half = spacing[axis] / 2, g = growth[axis];
  return g > 0 ? half * std::sinh(g / 2 * halves) * 2 / g : half * halves;
}

double Lattice::halves(int axis, double place) const {
  const double half = spacing[axis] / 2, g = growth[axis];
  return g > 0 ? std::asinh(g / 2 * place / half) * 2 / g : place / half;
}

MarchedSurface march(const SolidField& field, const Lattice& lattice, const MarchOptions& options,
                     const std::string& where) {
  return Marching(field, lattice, options, where).run();
}

}  // namespace geoprior::embryo
