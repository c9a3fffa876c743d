#include "metrics/surface_front.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "core/error.h"

namespace geoprior {
namespace {

/// Corners a, b of an edge with the triangle to the left, and the distances there: the centre of
/// the circle through which the front comes, to the right of the edge.
/// @return  whether there is one; distances of two different ways round may have none
bool centre_behind(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double at_a, double at_b,
                   Eigen::Vector2d& centre) {
  const Eigen::Vector2d edge = b - a;
  const double squared = edge.squaredNorm();
  if (!(squared > 0)) return false;
  const double length = std::sqrt(squared);
  const double along = (at_a * at_a - at_b * at_b + squared) / (2 * length);
  const double depth_squared = at_a * at_a - along * along;
  // A source on the line of the edge has depth 0 up to round-off.
  if (!(depth_squared >= -1e-12 * (squared + at_a * at_a))) return false;
  const double depth = std::sqrt(std::max(0., depth_squared));
  const Eigen::Vector2d e = edge / length;
  centre = a + along * e + depth * Eigen::Vector2d(e.y(), -e.x());
  return true;
}

double cross_product(const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
  return u.x() * v.y() - u.y() * v.x();
}

/// Whether the straight way from the centre to the point passes between a and b.
bool passes_between(const Eigen::Vector2d& centre, const Eigen::Vector2d& point,
                    const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d way = point - centre;
  const double slack = 1e-12 * way.squaredNorm();
  return cross_product(way, a - centre) >= -slack && cross_product(way, b - centre) <= slack;
}

}  // namespace

UnfoldedSurface::UnfoldedSurface(TriMesh surface) : mesh_(std::move(surface)) {
  if (!mesh_.V.allFinite()) throw Error("a vertex is not finite", "unfolded surface");
  const auto vertices = static_cast<std::size_t>(mesh_.vertex_count());
  face_offset_.assign(vertices + 1, 0);
  longest_edge_.assign(vertices, 0);
  for (int f = 0; f < mesh_.triangle_count(); ++f) {
    const Eigen::RowVector3i corner = mesh_.F.row(f);
    if (corner.minCoeff() < 0 || corner.maxCoeff() >= mesh_.vertex_count()) {
      throw Error("a corner is no vertex", "triangle " + std::to_string(f));
    }
    const Eigen::RowVector3d u = mesh_.V.row(corner(1)) - mesh_.V.row(corner(0));
    const Eigen::RowVector3d v = mesh_.V.row(corner(2)) - mesh_.V.row(corner(0));
    const double length = u.norm(), along = length > 0 ? v.dot(u) / length : 0;
    const double height = std::sqrt(std::max(0., v.squaredNorm() - along * along));
    corners_.push_back(
        {Eigen::Vector2d(0, 0), Eigen::Vector2d(length, 0), Eigen::Vector2d(along, height)});
    const double longest = std::max({length, v.norm(), (v - u).norm()});
    for (const int c : corner) {
      ++face_offset_[static_cast<std::size_t>(c) + 1];
      double& known = longest_edge_[static_cast<std::size_t>(c)];
      known = std::max(known, longest);
    }
  }
  for (std::size_t v = 0; v < vertices; ++v) face_offset_[v + 1] += face_offset_[v];
  face_.resize(static_cast<std::size_t>(face_offset_.back()));
  std::vector<int> next(face_offset_.begin(), face_offset_.end() - 1);
  for (int f = 0; f < mesh_.triangle_count(); ++f) {
    for (const int c : mesh_.F.row(f)) {
      int& at = next[static_cast<std::size_t>(c)];
      face_[static_cast<std::size_t>(at++)] = f;
    }
  }
}

Eigen::Vector2d UnfoldedSurface::layout(const SurfacePlace& place) const {
  const auto& corner = corners(place.face);
  return place.barycentric(1) * corner[1] + place.barycentric(2) * corner[2];
}

Eigen::Vector3d UnfoldedSurface::position(const SurfacePlace& place) const {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c) {
    x += place.barycentric(c) * mesh_.V.row(mesh_.F(place.face, c)).transpose();
  }
  return x;
}

std::span<const int> UnfoldedSurface::faces_of(int vertex) const {
  const int begin = face_offset_[static_cast<std::size_t>(vertex)];
  const int end = face_offset_[static_cast<std::size_t>(vertex) + 1];
  return {face_.data() + begin, static_cast<std::size_t>(end - begin)};
}

void UnfoldedSurface::require(const SurfacePlace& place) const {
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
      distance_(static_cast<std::size_t>(surface.mesh().vertex_count()), kFar),
      is_reached_(static_cast<std::size_t>(surface.mesh().triangle_count()), 0) {}

void SurfaceFront::clear() {
  for (const int v : touched_) distance_[static_cast<std::size_t>(v)] = kFar;
  for (const int f : reached_) is_reached_[static_cast<std::size_t>(f)] = 0;
  touched_.clear();
  reached_.clear();
  heap_.clear();
}

void SurfaceFront::offer(int vertex, double distance) {
  double& known = distance_[static_cast<std::size_t>(vertex)];
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

void SurfaceFront::cross(int face) {
  const auto& corner = surface_.corners(face);
  const auto at = [&](std::size_t c) {
    return distance_[static_cast<std::size_t>(surface_.mesh().F(face, static_cast<int>(c)))];
  };
  for (std::size_t c = 0; c < 3; ++c) {  // into corner c, across the edge (a, b) that faces it
    const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
    double way =
        std::min(at(a) + (corner[a] - corner[c]).norm(), at(b) + (corner[b] - corner[c]).norm());
    Eigen::Vector2d centre;
    if (at(a) < kFar && at(b) < kFar && centre_behind(corner[a], corner[b], at(a), at(b), centre) &&
        passes_between(centre, corner[c], corner[a], corner[b])) {
      way = std::min(way, (corner[c] - centre).norm());
    }
    if (way < kFar) offer(surface_.mesh().F(face, static_cast<int>(c)), way);
  }
}

void SurfaceFront::visit(int vertex) {
  for (const int f : surface_.faces_of(vertex)) {
    if (is_reached_[static_cast<std::size_t>(f)] == 0) {
      is_reached_[static_cast<std::size_t>(f)] = 1;
      reached_.push_back(f);
    }
    cross(f);
  }
}

void SurfaceFront::spread(const SurfacePlace& source, double reach) {
  surface_.require(source);
  if (!(reach > 0)) throw Error("reach " + std::to_string(reach), "front", "positive");
  clear();
  source_face_ = source.face;
  source_layout_ = surface_.layout(source);
  source_ = surface_.position(source);
  reach_ = reach;
  is_reached_[static_cast<std::size_t>(source_face_)] = 1;
  reached_.push_back(source_face_);
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::Vector2d& corner = surface_.corners(source_face_)[c];
    offer(surface_.mesh().F(source_face_, static_cast<int>(c)), (corner - source_layout_).norm());
  }
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    const auto [distance, vertex] = heap_.back();
    heap_.pop_back();
    if (distance != distance_[static_cast<std::size_t>(vertex)]) continue;
    // A triangle with a point within the reach has its corners at most an edge beyond, and those
    // get their distances across edges that end at most another one beyond.
    if (distance <= reach_ + 2 * surface_.longest_edge(vertex)) visit(vertex);
  }
}

SurfaceFront::Within SurfaceFront::within(int face) const {
  Within w;
  w.corner_ = surface_.corners(face);
  w.has_source_ = face == source_face_;
  w.source_ = source_layout_;
  for (std::size_t c = 0; c < 3; ++c) {
    const int vertex = surface_.mesh().F(face, static_cast<int>(c));
    w.at_corner_[c] = distance_[static_cast<std::size_t>(vertex)];
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t d = (c + 1) % 3;
    w.crosses_[c] =
        w.at_corner_[c] < kFar && w.at_corner_[d] < kFar &&
        centre_behind(w.corner_[c], w.corner_[d], w.at_corner_[c], w.at_corner_[d], w.centre_[c]);
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
