#include "metrics/developability/surface_front.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "core/error.h"
#include "core/geometry/planar.h"

namespace geoprior {
namespace {

/// Corners a, b of an edge with the triangle to the left, and the distances there: the centre of
/// the circle through which the front comes, to the right of the edge.
/// @return  whether there is one; distances of two different ways round may have none
bool centre_behind(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double length, double at_a,
                   double at_b, Eigen::Vector2d& centre) {
  if (!(at_a + at_b < std::numeric_limits<double>::infinity()) || !(length > 0)) return false;
  const double squared = length * length, inverse = 1 / length;
  const double along = (at_a * at_a - at_b * at_b + squared) * (0.5 * inverse);
  const double depth_squared = at_a * at_a - along * along;
  // A source on the line of the edge has depth 0 up to round-off.
  if (!(depth_squared >= -1e-12 * (squared + at_a * at_a))) return false;
  const double depth = std::sqrt(std::max(0., depth_squared));
  const Eigen::Vector2d e = inverse * (b - a);
  centre = a + along * e + depth * Eigen::Vector2d(e.y(), -e.x());
  return true;
}

/// Whether the straight way from the centre to the point passes between a and b.
bool passes_between(const Eigen::Vector2d& centre, const Eigen::Vector2d& point,
                    const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d way = point - centre;
  const double slack = 1e-12 * way.squaredNorm();
  return cross(way, a - centre) >= -slack && cross(way, b - centre) <= slack;
}

UnfoldedSurface::Triangle lay_out(const TriMesh& mesh, int f) {
  const Eigen::RowVector3d u = mesh.V.row(mesh.F(f, 1)) - mesh.V.row(mesh.F(f, 0));
  const Eigen::RowVector3d v = mesh.V.row(mesh.F(f, 2)) - mesh.V.row(mesh.F(f, 0));
  const double length = u.norm(), along = length > 0 ? v.dot(u) / length : 0;
  const double height = std::sqrt(std::max(0., v.squaredNorm() - along * along));
  UnfoldedSurface::Triangle t;
  t.corner = {Eigen::Vector2d(0, 0), Eigen::Vector2d(length, 0), Eigen::Vector2d(along, height)};
  for (std::size_t c = 0; c < 3; ++c) t.length[c] = (t.corner[(c + 1) % 3] - t.corner[c]).norm();
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::Vector2d next = t.corner[(c + 1) % 3] - t.corner[c];
    const Eigen::Vector2d last = t.corner[(c + 2) % 3] - t.corner[c];
    const double product = t.length[c] * t.length[(c + 2) % 3];
    t.cosine[c] = product > 0 ? next.dot(last) / product : 0;
  }
  return t;
}

}  // namespace

UnfoldedSurface::UnfoldedSurface(TriMesh surface) : mesh_(std::move(surface)) {
  if (!mesh_.V.allFinite()) throw Error("a vertex is not finite", "unfolded surface");
  const std::size_t vertices = mesh_.vertex_count();
  longest_edge_.assign(vertices, 0);
  for (int f = 0; f < mesh_.triangle_count(); ++f) {
    const Eigen::RowVector3i corner = mesh_.F.row(f);
    if (corner.minCoeff() < 0 || corner.maxCoeff() >= mesh_.vertex_count()) {
      throw Error("a corner is no vertex", "triangle " + std::to_string(f));
    }
    triangles_.push_back(lay_out(mesh_, f));
    const auto& length = triangles_.back().length;
    const double longest = std::max({length[0], length[1], length[2]});
    for (const int c : corner) {
      double& known = longest_edge_[c];
      known = std::max(known, longest);
    }
  }
  corners_ = VertexCorners(mesh_.F, mesh_.vertex_count());
}

Eigen::Vector2d UnfoldedSurface::layout(const SurfacePoint& place) const {
  const auto& corner = triangle(place.face).corner;
  return place.barycentric(1) * corner[1] + place.barycentric(2) * corner[2];
}

Eigen::Vector3d UnfoldedSurface::position(const SurfacePoint& place) const {
  return position_of(place, mesh_.V, mesh_.F);
}

void UnfoldedSurface::require(const SurfacePoint& place) const {
  if (place.face < 0 || place.face >= mesh_.triangle_count()) {
    throw Error("no triangle " + std::to_string(place.face), "place on a surface",
                "0 to " + std::to_string(mesh_.triangle_count()) + " excluded");
  }
  if (!(place.barycentric.minCoeff() >= -1e-6) || !(std::abs(place.barycentric.sum() - 1) < 1e-6)) {
    throw Error("barycentric coordinates are not of a point in the triangle",
                "place on triangle " + std::to_string(place.face), "0 to 1, their sum 1");
  }
}

SurfaceFront::SurfaceFront(const UnfoldedSurface& surface)
    : surface_(surface),
      distance_(surface.mesh().vertex_count(), kFar),
      is_reached_(surface.mesh().triangle_count(), 0) {}

void SurfaceFront::clear() {
  for (const int v : touched_) distance_[v] = kFar;
  for (const int f : reached_) is_reached_[f] = 0;
  touched_.clear();
  reached_.clear();
  heap_.clear();
}

void SurfaceFront::offer(int vertex, double distance) {
  double& known = distance_[vertex];
  // Less than round-off is no news: triangles around a vertex could exchange it for ever.
  if (!(distance < known - 1e-12 * reach_)) return;
  const double chord = (surface_.mesh().V.row(vertex).transpose() - source_).norm();
  distance = std::max(distance, chord);
  if (!(distance < known - 1e-12 * reach_)) return;
  if (known == kFar) touched_.push_back(vertex);
  known = distance;
  heap_.emplace_back(distance, vertex);
  std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
}

void SurfaceFront::cross(int face, std::size_t from, double distance) {
  const UnfoldedSurface::Triangle& t = surface_.triangle(face);
  for (std::size_t k = 1; k < 3; ++k) {  // into corner c, across the edge (a, b) that faces it
    const std::size_t c = (from + k) % 3, other = (from + 3 - k) % 3;
    const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
    const int vertex = surface_.mesh().F(face, static_cast<int>(c));
    const double edge = t.length[k == 1 ? from : c];
    const double known = distance_[vertex];
    offer(vertex, distance + edge);
    // A straight way across the edge to c meets the edge (from, c) at an angle of at most that at
    // c. By the law of cosines it is then no shorter than the one to `from`, unless c is very near.
    if (known <= distance && edge <= 2 * (distance - edge) * t.cosine[c]) continue;
    const double there = distance_[surface_.mesh().F(face, static_cast<int>(other))];
    Eigen::Vector2d centre;
    if (centre_behind(t.corner[a], t.corner[b], t.length[a], a == from ? distance : there,
                      a == from ? there : distance, centre) &&
        passes_between(centre, t.corner[c], t.corner[a], t.corner[b])) {
      offer(vertex, (t.corner[c] - centre).norm());
    }
  }
}

void SurfaceFront::visit(int vertex, double distance) {
  for (const int c : surface_.corners_of(vertex)) {
    const int f = c / 3;
    if (is_reached_[f] == 0) {
      is_reached_[f] = 1;
      reached_.push_back(f);
    }
    cross(f, c % 3, distance);
  }
}

void SurfaceFront::spread(const SurfacePoint& source, double reach) {
  surface_.require(source);
  if (!(reach > 0)) throw Error("reach " + std::to_string(reach), "front", "positive");
  clear();
  source_face_ = source.face;
  source_layout_ = surface_.layout(source);
  source_ = surface_.position(source);
  reach_ = reach;
  is_reached_[source_face_] = 1;
  reached_.push_back(source_face_);
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector2d& corner = surface_.triangle(source_face_).corner[c];
    offer(surface_.mesh().F(source_face_, c), (corner - source_layout_).norm());
  }
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    const auto [distance, vertex] = heap_.back();
    heap_.pop_back();
    if (distance != distance_[vertex]) continue;
    // A triangle with a point within the reach has its corners at most an edge beyond, and those
    // get their distances across edges that end at most another one beyond.
    if (distance <= reach_ + 2 * surface_.longest_edge(vertex)) visit(vertex, distance);
  }
}

bool SurfaceFront::is_beyond(int face, double distance) const {
  if (face == source_face_) return false;
  const auto& length = surface_.triangle(face).length;
  const auto at = [&](int c) { return distance_[surface_.mesh().F(face, c)]; };
  const double farthest = std::max({at(0), at(1), at(2)});
  return farthest - std::max({length[0], length[1], length[2]}) >= distance;
}

SurfaceFront::Within SurfaceFront::within(int face) const {
  const UnfoldedSurface::Triangle& t = surface_.triangle(face);
  Within w;
  w.corner_ = t.corner;
  w.has_source_ = face == source_face_;
  w.source_ = source_layout_;
  for (int c = 0; c < 3; ++c) {
    const int vertex = surface_.mesh().F(face, c);
    w.at_corner_[c] = distance_[vertex];
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t d = (c + 1) % 3;
    w.crosses_[c] = centre_behind(t.corner[c], t.corner[d], t.length[c], w.at_corner_[c],
                                  w.at_corner_[d], w.centre_[c]);
  }
  return w;
}

double SurfaceFront::Within::distance(const Eigen::Vector2d& point) const {
  if (has_source_) return (point - source_).norm();
  double least = kFar;
  for (std::size_t c = 0; c < 3; ++c) {
    if (crosses_[c] && passes_between(centre_[c], point, corner_[c], corner_[(c + 1) % 3])) {
      least = std::min(least, (point - centre_[c]).norm());
    } else if (at_corner_[c] < least) {
      least = std::min(least, at_corner_[c] + (point - corner_[c]).norm());
    }
  }
  return least;
}

}  // namespace geoprior
