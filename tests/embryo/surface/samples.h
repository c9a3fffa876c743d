#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <vector>

#include "core/connectivity.h"
#include "core/disjoint_sets.h"
#include "core/mesh.h"
#include "models/embryo/body/day_state.h"
#include "models/embryo/shape/shape.h"

/// Shapes, days and counts that the tests of surfaces share.
namespace geoprior::embryo::samples {

using Eigen::Vector3d;

inline Shape ovoid(const Vector3d& center, const Vector3d& radii, double egg = 0) {
  Shape shape;
  shape.primitive = Primitive::ovoid;
  shape.center = center;
  shape.radii = radii;
  shape.egg = egg;
  return shape;
}

inline Shape duct(std::vector<Vector3d> points, double radius, double end_radius) {
  Shape shape;
  shape.primitive = Primitive::duct;
  shape.points = std::move(points);
  shape.radius = radius;
  shape.end_radius = end_radius;
  return shape;
}

inline Shape duct(std::vector<Vector3d> points, double radius) {
  return duct(std::move(points), radius, radius);
}

inline Shape cylinder(const Vector3d& center, double radius, double length) {
  Shape shape;
  shape.primitive = Primitive::cylinder;
  shape.center = center;
  shape.radii = {radius, radius, length / 2};
  return shape;
}

inline Shape turned(Shape shape, double angle, const Vector3d& about) {
  shape.axes = Eigen::AngleAxisd(angle, about.normalized()) * shape.axes;
  return shape;
}

/// The mirror image in the plane x = 0; its axes stay a rotation.
inline Shape mirrored(Shape shape) {
  const Vector3d flip(-1, 1, 1);
  shape.center = shape.center.cwiseProduct(flip);
  shape.axes = flip.asDiagonal() * shape.axes;
  shape.axes.col(0) = -shape.axes.col(0);
  for (Vector3d& p : shape.points) p = p.cwiseProduct(flip);
  return shape;
}

/// A bent duct, 40 radii long and wider at its end.
inline Shape bent_duct() {
  return duct({{0.3, 0, 0}, {0.5, 0.6, 1}, {-0.2, 0.8, 1.8}, {0.4, 0.2, 2.6}, {1, 0, 3.2}}, 0.1,
              0.14);
}

/// Two ovoids and a duct from one to the other, blended: a horseshoe.
inline DayState horseshoe() {
  DayState day;
  day.structures = {{0, turned(ovoid({1.2, 0, 0}, {0.5, 0.4, 0.9}, 0.1), 0.3, {0, 1, 0})},
                    {1, turned(ovoid({-1.2, 0, 0}, {0.5, 0.4, 0.9}, 0.1), -0.3, {0, 1, 0})},
                    {2, duct({{1, 0, -0.7}, {0, 0.1, -1}, {-1, 0, -0.7}}, 0.2)}};
  day.fused = {{{0, 1, 2}, 0.2}};
  return day;
}

/// An ovoid with a septum that has come down to a share of its way through it.
inline DayState divided_ovoid(double progress) {
  DayState day;
  day.structures = {{0, ovoid({0.2, 0.1, 0}, {0.6, 0.8, 1})}};
  Cut cut;
  cut.normal = {0, 1, 0};
  cut.descent = {0, 0, -1};
  cut.point = {0.2, 0.1, 0};
  cut.thickness = 0.1;
  cut.progress = progress;
  cut.tip = -1.1 + progress * 2.2;
  day.cuts = {cut};
  return day;
}

/// Two halves of that ovoid, structures 1 and 2.
inline DayState halved_ovoid() {
  DayState day = divided_ovoid(1);
  const Shape whole = day.structures[0].shape;
  day.structures = {{1, whole}, {2, whole}};
  day.halves = {{1, 0, whole, day.cuts[0], 1}, {2, 0, whole, day.cuts[0], -1}};
  day.cuts.clear();
  return day;
}

inline int components(const TriMesh& mesh) {
  DisjointSets sets(mesh.vertex_count());
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 1; k < 3; ++k) sets.join(mesh.F(t, 0), mesh.F(t, k));
  int count = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) count += sets.find(v) == v ? 1 : 0;
  return count;
}

inline int euler_number(const TriMesh& mesh) {
  return mesh.vertex_count() - EdgeConnectivity(mesh.F).edge_count() + mesh.triangle_count();
}

/// Whether every vertex has one ring of triangles, and every edge two.
inline bool closed_manifold(const TriMesh& mesh) {
  const EdgeConnectivity edges(mesh.F);
  if (2 * edges.edge_count() != edges.half_edge_count() || edges.first_repeated()) return false;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (edges.valence(v) < 3 || !edges.has_ring(v)) return false;
  return true;
}

}  // namespace geoprior::embryo::samples
