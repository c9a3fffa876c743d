#include "models/details/surface_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/connectivity.h"

namespace geoprior::details {
namespace {

using Points = std::span<const Eigen::Vector3d>;

std::array<Eigen::Vector3d, 3> corners_of(int face, const SurfaceTopology& surface, Points x) {
  const auto& f = surface.face[face];
  return {x[f[0]], x[f[1]], x[f[2]]};
}

/// Barycentric coordinates of the point of the edge a-b that is nearest to p.
Eigen::Vector3d nearest_on_edge(const std::array<Eigen::Vector3d, 3>& c, int k,
                                const Eigen::Vector3d& p) {
  const int l = (k + 1) % 3;
  const Eigen::Vector3d along = c[l] - c[k];
  const double s = along.squaredNorm();
  const double t = s > 0 ? std::clamp(along.dot(p - c[k]) / s, 0.0, 1.0) : 0;
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  b[k] = 1 - t;
  b[l] = t;
  return b;
}

Eigen::Vector3d nearest_on_triangle(const std::array<Eigen::Vector3d, 3>& c,
                                    const Eigen::Vector3d& p) {
  const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
  const double s = normal.squaredNorm();
  Eigen::Vector3d b;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d &u = c[(k + 1) % 3], &v = c[(k + 2) % 3];
    b[k] = normal.dot((v - u).cross(p - u)) / s;
  }
  if (b.minCoeff() >= 0) return b / b.sum();
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d e = nearest_on_edge(c, k, p);
    const double d = (e[0] * c[0] + e[1] * c[1] + e[2] * c[2] - p).squaredNorm();
    if (d < best) {
      best = d;
      b = e;
    }
  }
  return b;
}

struct Candidate {
  SurfacePoint point;
  double distance2 = std::numeric_limits<double>::infinity();
};

void try_face(int face, const Eigen::Vector3d& target, const SurfaceTopology& surface, Points x,
              Candidate& best) {
  const auto c = corners_of(face, surface, x);
  const Eigen::Vector3d b = nearest_on_triangle(c, target);
  const double d = (b[0] * c[0] + b[1] * c[1] + b[2] * c[2] - target).squaredNorm();
  if (d < best.distance2 * (1 - 1e-12)) best = {{face, b}, d};
}

/// A straight path within a face.
struct Heading {
  Eigen::Vector3d velocity;   ///< of the barycentric coordinates (1/m): constant within the face
  Eigen::Vector3d direction;  ///< unit, in the face's plane
};

Heading heading_in(int face, const Eigen::Vector3d& d, const SurfaceTopology& surface, Points x) {
  const auto c = corners_of(face, surface, x);
  const Eigen::Vector3d n = (c[1] - c[0]).cross(c[2] - c[0]);
  Heading heading;
  heading.direction = (d - n * (n.dot(d) / n.squaredNorm())).normalized();
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d edge = c[(k + 2) % 3] - c[(k + 1) % 3];
    heading.velocity[k] = n.cross(edge).dot(heading.direction) / n.squaredNorm();
  }
  return heading;
}

/// Where a path leaves its face.
struct Exit {
  double after = 0;   ///< this length (m), at most what is left of the path
  int opposite = -1;  ///< corner opposite to the edge; -1: the path ends before
};

/// @param entered  corner opposite to the edge that the path came by (-1: it starts here): leaving
///                 through it at once is round-off
Exit exit_of(const SurfacePoint& p, const Eigen::Vector3d& velocity, int entered, double length) {
  Exit exit{length, -1};
  for (int k = 0; k < 3; ++k) {
    if (k == entered || !(velocity[k] < 0)) continue;
    const double t = std::max(p.barycentric[k], 0.0) / -velocity[k];
    if (t < exit.after) exit = {t, k};
  }
  return exit;
}

/// Unfolds the path over an edge into the face beyond: the point stays, the angle to the edge too.
/// @return  corner of the face beyond that is opposite to the edge
int cross_edge(std::size_t edge, const SurfaceTopology& surface, Points x, SurfacePoint& p,
               Heading& heading) {
  const auto& face = surface.face[p.face];
  const auto c = corners_of(p.face, surface, x);
  const Eigen::Vector3d along = (c[(edge + 1) % 3] - c[edge]).normalized();
  const double cosine = heading.direction.dot(along);
  const int a = face[edge], b = face[(edge + 1) % 3];
  SurfacePoint q{surface.across[p.face][edge], Eigen::Vector3d::Zero()};
  int opposite = 0;
  for (int k = 0; k < 3; ++k) {
    const int w = surface.face[q.face][k];
    if (w == a)
      q.barycentric[k] = p.barycentric[edge];
    else if (w == b)
      q.barycentric[k] = p.barycentric[(edge + 1) % 3];
    else
      opposite = k;
  }
  const Eigen::Vector3d in = corners_of(q.face, surface, x)[opposite] - x[a];
  const Eigen::Vector3d across = (in - along * in.dot(along)).normalized();
  heading = heading_in(
      q.face, cosine * along + std::sqrt(std::max(0.0, 1 - cosine * cosine)) * across, surface, x);
  p = q;
  return opposite;
}

}  // namespace

SurfaceTopology::SurfaceTopology(const TriMesh& rest)
    : face(rest.F.rows()), corners(rest.F, rest.vertex_count()), border_vertex(rest.V.rows(), 0) {
  const EdgeConnectivity edges(rest.F);
  across = edges.across();
  for (int e = 0; e < edges.edge_count(); ++e) {
    if (edges.half_edges(e).size() == 2) continue;
    for (const int v : edges.edge(e)) border_vertex[v] = 1;
  }
  for (int t = 0; t < rest.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) face[t][k] = rest.F(t, k);
  }
  const Eigen::VectorXd areas = triangle_areas(rest.V, rest.F);
  rest_area.assign(areas.data(), areas.data() + areas.size());
  euler = rest.vertex_count() - edges.edge_count() + rest.triangle_count();
}

int SurfaceTopology::fan_of(int vertex) const {
  const auto around = corners_of(vertex);
  if (around.empty()) return 0;
  const int start = around[0] / 3;
  int count = 0;
  for (const bool forward : {true, false}) {
    int f = start;
    for (;;) {
      const auto& v = face[f];
      const std::size_t k = v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
      const int g = across[f][forward ? (k + 2) % 3 : k];
      if (forward || f != start) ++count;
      if (g == start) return count;
      if (g < 0 || count > std::ssize(around)) break;
      f = g;
    }
  }
  return count;
}

double area_of_face(int face, const SurfaceTopology& surface, Points x) {
  const auto c = corners_of(face, surface, x);
  return 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
}

Eigen::Vector3d normal_of_face(int face, const SurfaceTopology& surface, Points x) {
  const auto c = corners_of(face, surface, x);
  return (c[1] - c[0]).cross(c[2] - c[0]).normalized();
}

SurfacePoint walk_to_nearest(const SurfacePoint& start, const Eigen::Vector3d& target,
                             const SurfaceTopology& surface, Points x) {
  Candidate best;
  try_face(start.face, target, surface, x, best);
  for (;;) {
    const Candidate before = best;
    const auto& f = surface.face[before.point.face];
    const auto& b = before.point.barycentric;
    for (std::size_t k = 0; k < 3; ++k) {
      // The nearest point may lie beyond an edge it touches, or anywhere around a corner.
      if (b[k] >= 1 - 1e-12) {
        for (const int c : surface.corners_of(f[k])) try_face(c / 3, target, surface, x, best);
      }
      if (b[(k + 2) % 3] > 1e-12) continue;
      const int g = surface.across[before.point.face][k];
      if (g >= 0) try_face(g, target, surface, x, best);
    }
    if (best.point.face == before.point.face) return best.point;
  }
}

SurfacePoint trace_straight(const SurfacePoint& start, const Eigen::Vector3d& direction,
                            double length, const SurfaceTopology& surface, Points x) {
  constexpr int kMostFaces = 100000;  // a path that circles a vertex for ever ends too
  SurfacePoint p = start;
  Heading heading = heading_in(p.face, direction, surface, x);
  int entered = -1;
  for (int steps = 0; steps < kMostFaces && length > 0; ++steps) {
    const Exit exit = exit_of(p, heading.velocity, entered, length);
    p.barycentric = (p.barycentric + exit.after * heading.velocity).cwiseMax(0.0);
    p.barycentric /= p.barycentric.sum();
    length -= exit.after;
    if (exit.opposite < 0) break;
    const std::size_t edge = (exit.opposite + 1) % 3;
    if (surface.across[p.face][edge] < 0) break;
    entered = cross_edge(edge, surface, x, p, heading);
  }
  return p;
}

Eigen::Vector3d tangent_direction(int face, double angle, const SurfaceTopology& surface,
                                  Points x) {
  const auto c = corners_of(face, surface, x);
  const Eigen::Vector3d e = (c[1] - c[0]).normalized();
  const Eigen::Vector3d n = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
  return std::cos(angle) * e + std::sin(angle) * n.cross(e);
}

double tangent_angle(int face, const Eigen::Vector3d& direction, const SurfaceTopology& surface,
                     Points x) {
  const auto c = corners_of(face, surface, x);
  const Eigen::Vector3d e = (c[1] - c[0]).normalized();
  const Eigen::Vector3d n = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
  return std::atan2(direction.dot(n.cross(e)), direction.dot(e));
}

}  // namespace geoprior::details
