#include "metrics/isometry/border_lengths.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/angles.h"
#include "core/geometry/planar.h"
#include "core/geometry/topology.h"
#include "metrics/isometry/circular_arc.h"

namespace geoprior {
namespace {

/// Border of a set of triangles as closed chains of vertices.
std::vector<std::vector<int>> border_chains(const Eigen::MatrixX3i& F) {
  std::map<int, int> next;
  for (const Edge& e : boundary_edges(F)) next[e[0]] = e[1];
  std::vector<std::vector<int>> chains;
  while (!next.empty()) {
    std::vector<int> chain;
    int v = next.begin()->first;
    for (auto found = next.find(v); found != next.end(); found = next.find(v)) {
      chain.push_back(v);
      v = found->second;
      next.erase(found);
    }
    chains.push_back(std::move(chain));
  }
  return chains;
}

/// A closed chain cut where it turns by more than 45 degrees.
void add_stretches(const std::vector<int>& chain, const Eigen::MatrixX2d& flat,
                   std::vector<std::vector<int>>& stretches) {
  const std::size_t n = chain.size();
  const auto at = [&](std::size_t i) -> Eigen::Vector2d {
    return flat.row(chain[i % n]).transpose();
  };
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = signed_angle(at(i) - at(i + n - 1), at(i + 1) - at(i));
    if (std::abs(turn) > kFullTurn / 8) corners.push_back(i);
  }
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const std::size_t end = c + 1 < corners.size() ? corners[c + 1] : corners[0] + n;
    std::vector<int> stretch;
    for (std::size_t i = corners[c]; i <= end; ++i) stretch.push_back(chain[i % n]);
    stretches.push_back(std::move(stretch));
  }
}

/// Length of a smooth chain: every chord as the mean of the arcs that it cuts off the circles
/// through its ends and the point before, and the point behind. Of fourth order in the chords.
double smooth_length(const Eigen::MatrixX3d& points) {
  const Eigen::Index n = points.rows();
  double length = 0;
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const double chord = (points.row(i + 1) - points.row(i)).norm();
    double sum = 0;
    int count = 0;
    for (Eigen::Index first = std::max<Eigen::Index>(i - 1, 0);
         first <= std::min<Eigen::Index>(i, n - 3); ++first, ++count) {
      const double radius = circular_arc(points.middleRows(first, 3)).radius;
      sum += std::isinf(radius) ? chord : 2 * radius * std::asin(chord / (2 * radius));
    }
    length += sum / count;
  }
  return length;
}

double stretch_length(const Eigen::MatrixX3d& points) {
  if (points.rows() < 3) return (points.row(0) - points.row(points.rows() - 1)).norm();
  const CircularArc arc = circular_arc(points);
  constexpr double kRound = 1e-6;  // of its length
  return arc.off <= kRound * arc.length ? arc.length : smooth_length(points);
}

}  // namespace

std::vector<std::vector<int>> border_stretches(const Eigen::MatrixX2d& points,
                                               const Eigen::MatrixX3i& F) {
  std::vector<std::vector<int>> stretches;
  for (const std::vector<int>& chain : border_chains(F)) add_stretches(chain, points, stretches);
  return stretches;
}

double border_length_error(const Eigen::MatrixX2d& flat, const Eigen::MatrixX3i& F,
                           const Eigen::MatrixX3d& space) {
  double worst = 0;
  for (const std::vector<int>& stretch : border_stretches(flat, F)) {
    const Eigen::Index n = stretch.size();
    Eigen::MatrixX3d laid(n, 3), real(n, 3);
    for (Eigen::Index i = 0; i < n; ++i) {
      const int v = stretch[i];
      laid.row(i) << flat(v, 0), flat(v, 1), 0;
      real.row(i) = space.row(v);
    }
    worst = std::max(worst, std::abs(stretch_length(laid) / stretch_length(real) - 1));
  }
  return worst;
}

}  // namespace geoprior
