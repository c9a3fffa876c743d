#include "models/paper/meshing/transfer.h"

#include <algorithm>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/planar.h"
#include "models/paper/contact/overlap.h"
#include "models/paper/sheet/pattern_locator.h"
#include "models/paper/tear/lips.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Farthest that a vertex may lie outside the old mesh, over the pattern's width.
constexpr double kOutside = 1e-6;
/// A weight this near to 1 means the old vertex itself.
constexpr double kOnVertex = 1e-12;

PlaneTriangle corners(const ShellMesh& mesh, int f) {
  return {Vector2d(mesh.pattern.row(mesh.triangles(f, 0))),
          Vector2d(mesh.pattern.row(mesh.triangles(f, 1))),
          Vector2d(mesh.pattern.row(mesh.triangles(f, 2)))};
}

double area(const PlaneTriangle& t) { return cross(t[1] - t[0], t[2] - t[0]) / 2; }

double width(const ShellMesh& mesh) {
  return (mesh.pattern.colwise().maxCoeff() - mesh.pattern.colwise().minCoeff()).maxCoeff();
}

/// A point on the side of every border vertex where the sheet is; of others none (NaN).
std::vector<Vector2d> border_sides(const ShellMesh& mesh) {
  const Vector2d none = Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::vector<Vector2d> sides(mesh.vertex_count(), none);
  const EdgeConnectivity edges(mesh.triangles);
  for (int h = 0; h < edges.half_edge_count(); ++h) {
    if (edges.twin(h) >= 0) continue;
    const auto [a, b, c] = corners(mesh, h / 3);
    for (const int v : {edges.origin(h), edges.tip(h)}) sides[v] = (a + b + c) / 3;
  }
  return sides;
}

void carry_vertices(const ShellState& from, const PatternLocator& locator, ShellState& to) {
  const int n = to.mesh.vertex_count();
  const double allowed = kOutside * width(from.mesh);
  to.x.resize(n, 3);
  to.v.resize(n, 3);
  const std::vector<Vector2d> sides =
      has_lips(from.mesh) ? border_sides(to.mesh) : std::vector<Vector2d>();
  for (int i = 0; i < n; ++i) {
    const Vector2d p = to.mesh.pattern.row(i);
    const PatternLocator::Place place =
        sides.empty() || !sides[i].allFinite() ? locator.locate(p) : locator.locate(p, sides[i]);
    const Eigen::RowVector3i t = from.mesh.triangles.row(place.triangle);
    Eigen::Index nearest = 0;
    if (place.weights.maxCoeff(&nearest) > 1 - kOnVertex) {
      to.x.row(i) = from.x.row(t[nearest]);
      to.v.row(i) = from.v.row(t[nearest]);
    } else {
      to.x.row(i).setZero();
      to.v.row(i).setZero();
      for (int k = 0; k < 3; ++k) {
        to.x.row(i) += place.weights[k] * from.x.row(t[k]);
        to.v.row(i) += place.weights[k] * from.v.row(t[k]);
      }
    }
    Eigen::RowVector2d reached = Eigen::RowVector2d::Zero();
    for (int k = 0; k < 3; ++k) reached += place.weights[k] * from.mesh.pattern.row(t[k]);
    if (!((reached.transpose() - p).norm() <= allowed)) {
      throw Error("vertex lies outside the mesh that the state comes from",
                  "vertex " + std::to_string(i));
    }
  }
}

struct TriangleBox {
  Vector2d low, high;
  explicit TriangleBox(const PlaneTriangle& t)
      : low(t[0].cwiseMin(t[1]).cwiseMin(t[2])), high(t[0].cwiseMax(t[1]).cwiseMax(t[2])) {}
  [[nodiscard]] bool meets(const TriangleBox& o) const {
    return low.x() < o.high.x() && o.low.x() < high.x() && low.y() < o.high.y() &&
           o.low.y() < high.y();
  }
};

/// Triangles of a mesh with their boxes, from left to right.
struct BoxedTriangle {
  int index;
  PlaneTriangle corners;
  TriangleBox box;
};
std::vector<BoxedTriangle> from_left_to_right(const ShellMesh& mesh) {
  std::vector<BoxedTriangle> list;
  list.reserve(mesh.triangle_count());
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    const PlaneTriangle t = corners(mesh, f);
    list.push_back({f, t, TriangleBox(t)});
  }
  std::sort(list.begin(), list.end(), [](const BoxedTriangle& p, const BoxedTriangle& q) {
    return std::tie(p.box.low.x(), p.index) < std::tie(q.box.low.x(), q.index);
  });
  return list;
}

/// Only old triangles that remember something are visited: most of a sheet has no crease.
void carry_creases(const ShellState& from, ShellState& to) {
  const int m = to.mesh.triangle_count();
  to.plastic_curvature = Eigen::MatrixX3d::Zero(m, 3);
  to.damage = Eigen::VectorXd::Zero(m);
  std::vector<int> creased;
  for (int f = 0; f < from.mesh.triangle_count(); ++f) {
    if (from.damage[f] != 0 || !from.plastic_curvature.row(f).isZero(0)) creased.push_back(f);
  }
  if (creased.empty()) return;
  const std::vector<BoxedTriangle> triangles = from_left_to_right(to.mesh);
  double widest = 0;
  for (const BoxedTriangle& t : triangles) {
    widest = std::max(widest, t.box.high.x() - t.box.low.x());
  }
  for (const int f : creased) {
    const PlaneTriangle old = corners(from.mesh, f);
    const TriangleBox box(old);
    const auto left_of = [](const BoxedTriangle& t, double u) { return t.box.low.x() < u; };
    auto t = std::lower_bound(triangles.begin(), triangles.end(), box.low.x() - widest, left_of);
    for (; t != triangles.end() && t->box.low.x() < box.high.x(); ++t) {
      if (!t->box.meets(box)) continue;
      const double shared = overlap_area(t->corners, old);
      to.plastic_curvature.row(t->index) += shared * from.plastic_curvature.row(f);
      to.damage[t->index] += shared * from.damage[f];
    }
  }
  for (const BoxedTriangle& t : triangles) {
    to.plastic_curvature.row(t.index) /= area(t.corners);
    to.damage[t.index] /= area(t.corners);
  }
}

}  // namespace

ShellState transfer_state(const ShellState& from, const ShellMesh& to) {
  ShellState state;
  state.mesh = to;
  state.time = from.time;
  carry_vertices(from, PatternLocator(from.mesh), state);
  carry_creases(from, state);
  return state;
}

}  // namespace geoprior::paper
