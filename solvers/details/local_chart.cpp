#include "solvers/details/local_chart.h"

#include <algorithm>
#include <cmath>

#include "core/angles.h"
#include "core/geometry/planar.h"

namespace geoprior::details {
namespace {

double angle_at_start(const IntrinsicTriangulation& mesh, int h) {
  const double b = mesh.length(h), c = mesh.length(IntrinsicTriangulation::previous(h));
  const double a = mesh.length(IntrinsicTriangulation::next(h));
  return std::atan2(4 * mesh.area(h / 3), b * b + c * c - a * a);
}

/// Apex on the left of p -> q at given distances from both.
Eigen::Vector2d unfold(const Eigen::Vector2d& p, const Eigen::Vector2d& q, double from_p,
                       double from_q) {
  const Eigen::Vector2d along = q - p;
  const double base = along.norm();
  if (!(base > 0)) return p;
  const double x = (base * base + (from_p - from_q) * (from_p + from_q)) / (2 * base);
  const double y = std::sqrt(std::max(0.0, (from_p - x) * (from_p + x)));
  const Eigen::Vector2d e = along / base;
  return p + x * e + y * Eigen::Vector2d(-e.y(), e.x());
}

/// Whether the origin lies on the right of p -> q, where the triangle to be unfolded does not.
bool source_on_right(const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  return cross(p, q) < 1e-12 * (p.squaredNorm() + q.squaredNorm());
}

}  // namespace

void LocalChart::reach(int vertex, const Eigen::Vector2d& at, double radius) {
  if (stamp_[vertex] == round_) return;
  const double distance = at.norm();
  if (distance > radius) return;
  stamp_[vertex] = round_;
  placed_[vertex] = at;
  queue_.push_back({distance, vertex, at});
  std::push_heap(queue_.begin(), queue_.end(), later);
}

bool LocalChart::later(const Reached& a, const Reached& b) {
  return a.distance > b.distance || (a.distance == b.distance && a.vertex > b.vertex);
}

void LocalChart::lay_out_ring(const IntrinsicTriangulation& mesh, int source, double radius) {
  double total = 0;
  const int start = mesh.outgoing(source);
  const auto each_spoke = [&](const auto& visit) {
    for (int h = start; h >= 0;) {
      visit(h);
      const int back = IntrinsicTriangulation::previous(h);
      h = mesh.twin(back);
      if (h < 0) visit(-1 - back);  // the last neighbour of a border vertex
      if (h == start) return;
    }
  };
  each_spoke([&](int h) { total += h >= 0 ? angle_at_start(mesh, h) : 0; });
  const double scale = mesh.border_vertex(source) ? 1 : kFullTurn / total;
  double angle = 0;
  each_spoke([&](int h) {
    const int edge = h >= 0 ? h : -1 - h;
    const double length = mesh.length(edge);
    reach(h >= 0 ? mesh.tip(edge) : mesh.origin(edge),
          length * Eigen::Vector2d(std::cos(angle), std::sin(angle)), radius);
    if (h >= 0) angle += scale * angle_at_start(mesh, h);
  });
}

void LocalChart::unfold_from(const IntrinsicTriangulation& mesh, int vertex, double radius) {
  const int start = mesh.outgoing(vertex);
  const Eigen::Vector2d at = placed_[vertex];
  for (int h = start; h >= 0;) {
    const int back = IntrinsicTriangulation::previous(h);
    const int p = mesh.tip(h), q = mesh.origin(back);
    const double up = mesh.length(h), uq = mesh.length(back);
    const double pq = mesh.length(IntrinsicTriangulation::next(h));
    const bool has_p = stamp_[p] == round_, has_q = stamp_[q] == round_;
    // Only away from the source: the front would fold back where placed points disagree a little.
    if (has_p && !has_q && source_on_right(at, placed_[p]))
      reach(q, unfold(at, placed_[p], uq, pq), radius);
    if (has_q && !has_p && source_on_right(placed_[q], at))
      reach(p, unfold(placed_[q], at, pq, up), radius);
    h = mesh.twin(back);
    if (h == start) break;
  }
}

const std::vector<ChartPoint>& LocalChart::around(const IntrinsicTriangulation& mesh, int source,
                                                  double radius) {
  stamp_.resize(mesh.vertex_slots(), 0);
  placed_.resize(mesh.vertex_slots());
  ++round_;
  points_.clear();
  queue_.clear();
  stamp_[source] = round_;
  placed_[source] = Eigen::Vector2d::Zero();
  points_.push_back({source, Eigen::Vector2d::Zero()});
  lay_out_ring(mesh, source, radius);
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), later);
    const Reached next = queue_.back();
    queue_.pop_back();
    points_.push_back({next.vertex, next.at});
    unfold_from(mesh, next.vertex, radius);
  }
  return points_;
}

}  // namespace geoprior::details
