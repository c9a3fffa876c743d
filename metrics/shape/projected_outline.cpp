#include "metrics/shape/projected_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/parallel.h"
#include "metrics/volume/box_grid.h"

namespace geoprior {
namespace {

constexpr double kBeside = 1e-9;         ///< of the size: where an edge is tested for cover
constexpr double kShortestPiece = 1e-6;  ///< of the size
constexpr std::size_t kEdgesOfBlock = 64;

struct Interval {
  double begin, end;
};

/// Sorts closed intervals and joins those with gaps of at most `gap`.
void join_intervals(std::vector<Interval>& intervals, double gap) {
  std::sort(intervals.begin(), intervals.end(),
            [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  std::size_t last = 0;
  for (std::size_t i = 1; i < intervals.size(); ++i) {
    if (intervals[i].begin <= intervals[last].end + gap) {
      intervals[last].end = std::max(intervals[last].end, intervals[i].end);
    } else {
      intervals[++last] = intervals[i];
    }
  }
  if (!intervals.empty()) intervals.resize(last + 1);
}

/// Common parts of two sorted lists of disjoint intervals.
std::vector<Interval> common_intervals(const std::vector<Interval>& a,
                                       const std::vector<Interval>& b) {
  std::vector<Interval> common;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const double begin = std::max(a[i].begin, b[j].begin), end = std::min(a[i].end, b[j].end);
    if (begin < end) common.push_back({begin, end});
    ++(a[i].end < b[j].end ? i : j);
  }
  return common;
}

/// Projected triangles with an area, counter-clockwise, and the edges that may bound their union.
class Projection {
 public:
  using Corners = std::array<Eigen::Vector2d, 3>;

  Projection(const Eigen::MatrixX2d& points, const Eigen::MatrixX3i& F)
      : candidates_(collect_candidates(points, F)), grid_(boxes_of(corners_)) {
    PlanarBox all = grid_.box(0);
    for (int i = 1; i < std::ssize(corners_); ++i)
      all = {all.low.cwiseMin(grid_.box(i).low), all.high.cwiseMax(grid_.box(i).high)};
    size_ = (all.high - all.low).norm();
  }

  [[nodiscard]] const std::vector<PlanarSegment>& candidates() const { return candidates_; }

  /// Appends the pieces of a segment that have uncovered points beside them.
  void append_outline(const PlanarSegment& s, std::vector<PlanarSegment>& outline) const {
    const Eigen::Vector2d along = s.b - s.a;
    const double length = along.norm();
    if (!(length > kShortestPiece * size_)) return;
    const Eigen::Vector2d beside =
        kBeside * size_ / length * Eigen::Vector2d(-along.y(), along.x());
    const std::vector<Interval> inside =
        common_intervals(covered({s.a + beside, s.b + beside}, length),
                         covered({s.a - beside, s.b - beside}, length));
    const double shortest = kShortestPiece * size_ / length;
    const auto append = [&](double begin, double end) {
      if (end - begin > shortest) outline.push_back({s.a + begin * along, s.a + end * along});
    };
    double begin = 0;
    for (const Interval& hidden : inside) {
      append(begin, hidden.begin);
      begin = hidden.end;
    }
    append(begin, 1);
  }

 private:
  static std::vector<PlanarBox> boxes_of(const std::vector<Corners>& corners) {
    if (corners.empty()) throw Error("no triangle has an area in the view", "outline", "one");
    std::vector<PlanarBox> boxes;
    for (const Corners& c : corners) boxes.push_back(box_of(c));
    return boxes;
  }

  /// Fills `corners_` too.
  std::vector<PlanarSegment> collect_candidates(const Eigen::MatrixX2d& points,
                                                const Eigen::MatrixX3i& F) {
    std::vector<int> side(F.rows(), 0);
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
      Corners c;
      for (int k = 0; k < 3; ++k) c[k] = points.row(F(t, k)).transpose();
      side[t] = orientation(c[0], c[1], c[2]);
      if (side[t] < 0) std::swap(c[1], c[2]);
      if (side[t] != 0) corners_.push_back(c);
    }
    const EdgeConnectivity connectivity(F);
    std::vector<PlanarSegment> candidates;
    for (int e = 0; e < connectivity.edge_count(); ++e) {
      bool left = false, right = false;
      for (const int h : connectivity.half_edges(e)) {
        const int where = connectivity.ascends(h) ? side[h / 3] : -side[h / 3];
        left = left || where > 0;
        right = right || where < 0;
      }
      if (left == right) continue;  // covered on both sides, or edge-on
      const auto [a, b] = connectivity.edge(e);
      candidates.push_back({points.row(a).transpose(), points.row(b).transpose()});
    }
    return candidates;
  }

  /// Parts of a segment, from 0 to 1, that lie in a closed triangle.
  [[nodiscard]] std::vector<Interval> covered(const PlanarSegment& s, double length) const {
    std::vector<Interval> intervals;
    grid_.visit({s.a.cwiseMin(s.b), s.a.cwiseMax(s.b)}, [&](int t) {
      const Interval i = part_in_triangle(s, corners_[t]);
      if (i.begin <= i.end) intervals.push_back(i);
    });
    join_intervals(intervals, kBeside * size_ / length);
    return intervals;
  }

  /// Clips a segment by the three edges; begin above end: nothing is left.
  static Interval part_in_triangle(const PlanarSegment& s, const Corners& corner) {
    Interval part{0, 1};
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d edge = corner[(k + 1) % 3] - corner[k];
      const double at_a = cross(edge, s.a - corner[k]), at_b = cross(edge, s.b - corner[k]);
      if (at_a < 0 && at_b < 0) return {1, 0};
      if (at_a < 0) part.begin = std::max(part.begin, at_a / (at_a - at_b));
      if (at_b < 0) part.end = std::min(part.end, at_a / (at_a - at_b));
    }
    return part;
  }

  std::vector<Corners> corners_;
  std::vector<PlanarSegment> candidates_;
  double size_ = 0;  ///< diagonal of the box (m)
  BoxGrid grid_;     ///< of `corners_`
};

}  // namespace

Eigen::MatrixX2d projected_points(const TriMesh& mesh, const Eigen::Matrix3d& view) {
  if (!((view * view.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-9))
    throw Error("rows of the view are not orthonormal", "projection", "a rotation");
  if (!mesh.V.allFinite()) throw Error("coordinate is not finite", "projection", "finite numbers");
  return mesh.V * view.topRows<2>().transpose();
}

std::vector<PlanarSegment> projected_outline(const Eigen::MatrixX2d& points,
                                             const Eigen::MatrixX3i& triangles) {
  const Projection projection(points, triangles);
  const std::vector<PlanarSegment>& candidates = projection.candidates();
  std::vector<std::vector<PlanarSegment>> found((candidates.size() + kEdgesOfBlock - 1) /
                                                kEdgesOfBlock);
  parallel_blocks(candidates.size(), kEdgesOfBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      projection.append_outline(candidates[i], found[begin / kEdgesOfBlock]);
  });
  std::vector<PlanarSegment> outline;
  for (const auto& pieces : found) outline.insert(outline.end(), pieces.begin(), pieces.end());
  if (outline.empty()) throw Error("every edge is too short", "outline", "1e-6 of the size");
  return outline;
}

}  // namespace geoprior
