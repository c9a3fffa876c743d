#include "models/sketch/surface/positive_winding.h"

#include <CGAL/Exact_rational.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/geometry/planar.h"

namespace geoprior::sketch {
namespace {

using ExactNumber = CGAL::Exact_rational;

struct ExactPoint {
  ExactNumber x, y;

  friend bool operator<(const ExactPoint& a, const ExactPoint& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  }
  friend bool operator==(const ExactPoint& a, const ExactPoint& b) {
    return a.x == b.x && a.y == b.y;
  }
  friend ExactPoint operator-(const ExactPoint& a, const ExactPoint& b) {
    return {a.x - b.x, a.y - b.y};
  }
};

ExactNumber exact_cross(const ExactPoint& a, const ExactPoint& b) { return a.x * b.y - a.y * b.x; }

ExactPoint exact_point(const Eigen::Vector2d& p) {
  return {ExactNumber(p.x()), ExactNumber(p.y())};
}

/// A segment of a curve, and where others meet it.
struct CurveSegment {
  Eigen::Vector2d a, b;
  std::vector<ExactPoint> cuts;

  [[nodiscard]] double left() const { return std::min(a.x(), b.x()); }
  [[nodiscard]] double right() const { return std::max(a.x(), b.x()); }
  [[nodiscard]] bool has_end(const Eigen::Vector2d& p) const { return p == a || p == b; }
};

void require_finite_curves(const std::vector<PlaneLoop>& curves) {
  for (std::size_t k = 0; k < curves.size(); ++k) {
    for (std::size_t i = 0; i < curves[k].size(); ++i) {
      if (!curves[k][i].allFinite()) {
        throw Error("point " + std::to_string(i) + " of curve " + std::to_string(k) +
                    " is not finite");
      }
    }
  }
}

std::vector<CurveSegment> curve_segments(const std::vector<PlaneLoop>& curves) {
  std::vector<CurveSegment> segments;
  for (const PlaneLoop& curve : curves) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const Eigen::Vector2d& a = curve[i];
      const Eigen::Vector2d& b = curve[(i + 1) % curve.size()];
      if (a != b) segments.push_back({a, b, {exact_point(a), exact_point(b)}});
    }
  }
  std::stable_sort(
      segments.begin(), segments.end(),
      [](const CurveSegment& s, const CurveSegment& t) { return s.left() < t.left(); });
  return segments;
}

/// Adds the common point of two segments to both, or the ends of one that lie on the other.
void cut_each_other(CurveSegment& s, CurveSegment& t) {
  const bool on_line = orientation(s.a, s.b, t.a) == 0 && orientation(s.a, s.b, t.b) == 0;
  if (on_line) {
    for (const Eigen::Vector2d& p : {t.a, t.b}) {
      if (segments_meet(s.a, s.b, p, p)) s.cuts.push_back(exact_point(p));
    }
    for (const Eigen::Vector2d& p : {s.a, s.b}) {
      if (segments_meet(t.a, t.b, p, p)) t.cuts.push_back(exact_point(p));
    }
    return;
  }
  if (s.has_end(t.a) || s.has_end(t.b)) return;  // that end is all they share
  const ExactPoint a = exact_point(s.a), c = exact_point(t.a);
  const ExactPoint d = exact_point(s.b) - a, e = exact_point(t.b) - c;
  const ExactNumber along = exact_cross(c - a, e) / exact_cross(d, e);
  const ExactPoint p{a.x + along * d.x, a.y + along * d.y};
  s.cuts.push_back(p);
  t.cuts.push_back(p);
}

/// Sweeps the segments by their left ends, so that only those that overlap in x are compared.
void cut_segments(std::vector<CurveSegment>& segments) {
  for (std::size_t i = 0; i < segments.size(); ++i) {
    CurveSegment& s = segments[i];
    for (std::size_t j = i + 1; j < segments.size() && segments[j].left() <= s.right(); ++j) {
      CurveSegment& t = segments[j];
      if (segments_meet(s.a, s.b, t.a, t.b)) cut_each_other(s, t);
    }
  }
}

/// The planar graph of the curves, cut where they meet. Half-edge 2 e runs along edge e, from its
/// lower to its higher vertex, 2 e + 1 back.
class WindingGraph {
 public:
  explicit WindingGraph(const std::vector<PlaneLoop>& curves) {
    std::vector<CurveSegment> segments = curve_segments(curves);
    cut_segments(segments);
    add_edges(segments);
    sort_around_vertices();
    spread_windings();
  }

  [[nodiscard]] std::size_t half_edge_count() const { return 2 * edges_.size(); }
  static std::size_t twin(std::size_t h) { return h ^ 1U; }
  [[nodiscard]] const ExactPoint& from(std::size_t h) const { return points_[vertex(h)]; }
  [[nodiscard]] const ExactPoint& to(std::size_t h) const { return from(twin(h)); }
  /// The next half-edge around the face on the left.
  [[nodiscard]] std::size_t next(std::size_t h) const { return next_[h]; }
  /// The region lies on its left and not on its right.
  [[nodiscard]] bool is_border(std::size_t h) const { return left_[h] > 0 && left_[twin(h)] <= 0; }

 private:
  struct Edge {
    std::size_t low, high;
    int along;  ///< how many curves run from low to high, less those that run back
  };

  [[nodiscard]] std::size_t vertex(std::size_t h) const {
    return h % 2 == 0 ? edges_[h / 2].low : edges_[h / 2].high;
  }
  /// Winding number on the left less that on the right.
  [[nodiscard]] int step(std::size_t h) const {
    return h % 2 == 0 ? edges_[h / 2].along : -edges_[h / 2].along;
  }

  /// Vertices in the order of their points. Where curves run to and fro as often, there is no edge:
  /// the winding number is the same on both sides.
  void add_edges(const std::vector<CurveSegment>& segments) {
    std::map<ExactPoint, std::size_t> vertex_of;
    for (const CurveSegment& s : segments) {
      for (const ExactPoint& p : s.cuts) vertex_of.emplace(p, 0);
    }
    for (auto& [point, number] : vertex_of) {
      number = points_.size();
      points_.push_back(point);
    }
    std::map<std::pair<std::size_t, std::size_t>, int> along;
    for (const CurveSegment& s : segments) {
      std::vector<std::size_t> chain;
      for (const ExactPoint& p : s.cuts) chain.push_back(vertex_of.at(p));
      const int sign = chain[0] < chain[1] ? 1 : -1;  // the first two are the ends
      std::sort(chain.begin(), chain.end());
      chain.erase(std::unique(chain.begin(), chain.end()), chain.end());
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) along[{chain[i], chain[i + 1]}] += sign;
    }
    for (const auto& [ends, count] : along) {
      if (count != 0) edges_.push_back({ends.first, ends.second, count});
    }
  }

  /// Counter-clockwise, from straight down on.
  void sort_around_vertices() {
    around_.resize(points_.size());
    for (std::size_t h = 0; h < half_edge_count(); ++h) around_[vertex(h)].push_back(h);
    const auto direction = [&](std::size_t h) { return to(h) - from(h); };
    const auto to_the_right = [](const ExactPoint& d) { return d.x > 0 || (d.x == 0 && d.y > 0); };
    next_.resize(half_edge_count());
    for (std::vector<std::size_t>& ring : around_) {
      std::sort(ring.begin(), ring.end(), [&](std::size_t g, std::size_t h) {
        const ExactPoint a = direction(g), b = direction(h);
        if (to_the_right(a) != to_the_right(b)) return to_the_right(a);
        return exact_cross(a, b) > 0;
      });
      for (std::size_t i = 0; i < ring.size(); ++i) {
        next_[twin(ring[i])] = ring[(i + ring.size() - 1) % ring.size()];
      }
    }
  }

  /// Vertices that edges join, numbered by component.
  [[nodiscard]] std::vector<std::size_t> components() const {
    std::vector<std::size_t> component(points_.size(), points_.size());
    for (std::size_t v = 0; v < points_.size(); ++v) {
      if (component[v] != points_.size()) continue;
      component[v] = v;
      std::vector<std::size_t> open{v};
      while (!open.empty()) {
        const std::size_t u = open.back();
        open.pop_back();
        for (const std::size_t h : around_[u]) {
          const std::size_t w = vertex(twin(h));
          if (component[w] != points_.size()) continue;
          component[w] = v;
          open.push_back(w);
        }
      }
    }
    return component;
  }

  /// How often the other components wind around a vertex: a ray straight up crosses edges that
  /// run to the right from their left side to their right side.
  [[nodiscard]] int winding_of_others(std::size_t v,
                                      const std::vector<std::size_t>& component) const {
    const ExactPoint& p = points_[v];
    int winding = 0;
    for (const Edge& edge : edges_) {
      if (component[edge.low] == component[v]) continue;
      const ExactPoint &a = points_[edge.low], &b = points_[edge.high];
      if (a.x <= p.x && p.x < b.x && exact_cross(b - a, p - a) < 0) winding -= edge.along;
    }
    return winding;
  }

  /// From the leftmost vertex of each component, to whose left there is nothing of it.
  void spread_windings() {
    left_.assign(half_edge_count(), 0);
    const std::vector<std::size_t> component = components();
    std::vector<bool> known(half_edge_count(), false);
    for (std::size_t v = 0; v < points_.size(); ++v) {
      if (component[v] != v || around_[v].empty()) continue;
      const std::size_t lowest = around_[v].front();
      left_[lowest] = winding_of_others(v, component) + step(lowest);
      known[lowest] = true;
      std::vector<std::size_t> open{lowest};
      while (!open.empty()) {
        const std::size_t h = open.back();
        open.pop_back();
        const auto reach = [&](std::size_t g, int winding) {
          if (known[g]) return;
          known[g] = true;
          left_[g] = winding;
          open.push_back(g);
        };
        reach(next(h), left_[h]);
        reach(twin(h), left_[h] - step(h));
      }
    }
  }

  std::vector<ExactPoint> points_;  ///< ascending
  std::vector<Edge> edges_;
  std::vector<std::vector<std::size_t>> around_;  ///< half-edges that begin at each vertex
  std::vector<std::size_t> next_;
  std::vector<int> left_;  ///< winding number on the left of each half-edge
};

PlaneLoop loop_from_leftmost(PlaneLoop loop) {
  const auto left = std::min_element(loop.begin(), loop.end(),
                                     [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
                                       return std::tuple(a.x(), a.y()) < std::tuple(b.x(), b.y());
                                     });
  std::rotate(loop.begin(), left, loop.end());
  return loop;
}

/// The loop of border half-edges that `start` begins; points in the middle of a straight stretch
/// are left out, exactly.
PlaneLoop walk_winding_border(const WindingGraph& graph, std::size_t start,
                              std::vector<bool>& done) {
  PlaneLoop loop;
  std::size_t edge = start;
  do {
    done[edge] = true;
    std::size_t next = graph.next(edge);
    while (!graph.is_border(next)) next = graph.next(WindingGraph::twin(next));
    const ExactPoint& p = graph.to(edge);
    if (exact_cross(p - graph.from(edge), graph.to(next) - p) != 0) {
      const Eigen::Vector2d corner(CGAL::to_double(p.x), CGAL::to_double(p.y));
      if (loop.empty() || loop.back() != corner) loop.push_back(corner);
    }
    edge = next;
  } while (edge != start);
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  return loop;
}

double loop_extent(const PlaneLoop& loop) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : loop) box.extend(p);
  return box.diagonal().norm();
}

}  // namespace

double loop_area(const PlaneLoop& loop) {
  double twice = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    twice += cross(loop[i] - loop[0], loop[(i + 1) % loop.size()] - loop[0]);
  }
  return twice / 2;
}

std::vector<PlaneLoop> positive_winding_border(const std::vector<PlaneLoop>& curves) {
  require_finite_curves(curves);
  const WindingGraph graph(curves);
  std::vector<PlaneLoop> loops;
  std::vector<bool> done(graph.half_edge_count(), false);
  for (std::size_t h = 0; h < graph.half_edge_count(); ++h) {
    if (!graph.is_border(h) || done[h]) continue;
    PlaneLoop loop = walk_winding_border(graph, h, done);
    // Rounding may flatten a sliver that exact coordinates still enclose.
    if (loop.size() >= 3) loops.push_back(loop_from_leftmost(std::move(loop)));
  }
  std::sort(loops.begin(), loops.end(), [](const PlaneLoop& a, const PlaneLoop& b) {
    return std::tuple(-loop_extent(a), a[0].x(), a[0].y()) <
           std::tuple(-loop_extent(b), b[0].x(), b[0].y());
  });
  return loops;
}

}  // namespace geoprior::sketch
