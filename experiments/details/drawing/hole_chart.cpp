#include "experiments/details/drawing/hole_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/geometry/planar.h"

namespace geoprior::details {
namespace {

/// Polar coordinates of the third corner of a triangle right of the edge a -> b.
Eigen::Vector2d polar_corner(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                             const Eigen::Vector3d& xa, const Eigen::Vector3d& xb,
                             const Eigen::Vector3d& xc) {
  const double length = (xb - xa).norm(), to_a = a.norm(), to_b = b.norm();
  const double along = (length * length + to_a * to_a - to_b * to_b) / (2 * length);
  const Eigen::Vector2d anchor(along, std::sqrt(std::max(0.0, to_a * to_a - along * along)));
  const Eigen::Vector2d edge(length, 0);
  const Eigen::Vector2d corner = unfold_corner(Eigen::Vector2d::Zero(), edge, xa, xb, xc) - anchor;
  const double between = signed_angle(a, b);
  const double whole = signed_angle(-anchor, edge - anchor);
  const double part = signed_angle(-anchor, corner);
  if (between > 0 && whole > 0 && part >= 0 && part <= whole) {
    const double turn = between * part / whole, c = std::cos(turn), s = std::sin(turn);
    const Eigen::Vector2d toward = a * (corner.norm() / to_a);
    return {c * toward.x() - s * toward.y(), s * toward.x() + c * toward.y()};
  }
  const double by_a = to_a + (xc - xa).norm(), by_b = to_b + (xc - xb).norm();
  return by_a < by_b ? a * (by_a / to_a) : b * (by_b / to_b);
}

}  // namespace

double distance_to_segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d e = b - a;
  const double length2 = e.squaredNorm();
  const double t = length2 > 0 ? std::clamp(-a.dot(e) / length2, 0.0, 1.0) : 0;
  return (a + t * e).norm();
}

HoleCharter::HoleCharter(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x)
    : surface_(surface),
      x_(x),
      rays_(surface, x),
      vertex_round_(x.size(), 0),
      face_round_(surface.face.size(), 0),
      at_(x.size()) {}

bool HoleCharter::later(const Front& a, const Front& b) {
  return std::tie(a.distance, a.vertex) > std::tie(b.distance, b.vertex);
}

bool HoleCharter::placed(int vertex) const { return vertex_round_[vertex] == round_; }

void HoleCharter::place(int vertex, const Eigen::Vector2d& at) {
  if (!placed(vertex)) chart_.vertices.push_back({vertex, at});
  vertex_round_[vertex] = round_;
  at_[vertex] = at;
  queue_.push_back({at.norm(), vertex});
  std::push_heap(queue_.begin(), queue_.end(), later);
}

void HoleCharter::place_if_nearer(int vertex, const Eigen::Vector2d& at) {
  if (!placed(vertex) || at.norm() < at_[vertex].norm() * (1 - 1e-6)) place(vertex, at);
}

void HoleCharter::spread_from(int v, double radius) {
  for (const int at_v : surface_.corners_of(v)) {
    const auto& c = surface_.face[at_v / 3];
    for (std::size_t k = 0; k < 3; ++k) {
      // The corner at k + 2 lies left of the edge from k to k + 1, right of that from k + 1 to k.
      const int a = c[(k + 1) % 3], b = c[k], corner = c[(k + 2) % 3];
      if ((a != v && b != v) || !placed(a) || !placed(b)) continue;
      if (distance_to_segment(at_[a], at_[b]) >= radius) continue;
      place_if_nearer(corner, polar_corner(at_[a], at_[b], x_[a], x_[b], x_[corner]));
    }
  }
}

void HoleCharter::limit_by_edge(int face, std::size_t edge) {
  const auto& c = surface_.face[face];
  const std::size_t a = c[edge], b = c[(edge + 1) % 3];
  if (surface_.across[face][edge] < 0)
    chart_.radius = std::min(chart_.radius, 0.9 * distance_to_segment(at_[a], at_[b]));
  if ((at_[a] - at_[b]).norm() > 1.6 * (x_[a] - x_[b]).norm())
    chart_.radius = std::min(chart_.radius, 0.9 * std::min(at_[a].norm(), at_[b].norm()));
}

void HoleCharter::collect_faces(double radius) {
  for (const ChartVertex& v : chart_.vertices) {
    for (const int at_v : surface_.corners_of(v.vertex)) {
      const int f = at_v / 3;
      const auto& c = surface_.face[f];
      if (face_round_[f] == round_) continue;
      if (!placed(c[0]) || !placed(c[1]) || !placed(c[2])) continue;
      face_round_[f] = round_;
      chart_.faces.push_back(f);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = c[k], b = c[(k + 1) % 3];
        if (distance_to_segment(at_[a], at_[b]) < radius) limit_by_edge(f, k);
      }
    }
  }
}

HoleChart HoleCharter::around(const DrawnAnchor& anchor, double radius) {
  ++round_;
  queue_.clear();
  chart_ = {};
  chart_.radius = radius;
  rays_.start(anchor.at, anchor.tangent);
  for (std::size_t k = 0; k < 3; ++k) place(surface_.face[anchor.at.face][k], rays_.corners()[k]);
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), later);
    const Front front = queue_.back();
    queue_.pop_back();
    if (front.distance <= at_[front.vertex].norm()) spread_from(front.vertex, radius);
  }
  collect_faces(radius);
  for (ChartVertex& v : chart_.vertices) v.at = at_[v.vertex];
  return std::move(chart_);
}

}  // namespace geoprior::details
