#include "metrics/shape/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "metrics/volume/box_grid.h"

namespace geoprior {
namespace {

constexpr std::size_t kRowsOfBlock = 64;

/// Part of a row that a shape covers.
struct Span {
  double begin, end;
};

void require_drawn(std::span<const PlanarLoop> drawn) {
  if (drawn.empty()) throw Error("nothing is drawn", "silhouette", "a closed polygon");
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (drawn[i].size() < 3) {
      throw Error(std::to_string(drawn[i].size()) + " points", "drawn polygon " + std::to_string(i),
                  "three or more");
    }
    for (const Eigen::Vector2d& p : drawn[i]) {
      if (!p.allFinite())
        throw Error("coordinate is not finite", "drawn polygon " + std::to_string(i),
                    "finite numbers");
    }
  }
}

/// Rows between given heights, ascending; empty ones are left out.
struct Rows {
  std::vector<double> middle, height;  ///< m
};

Rows make_rows(const Eigen::MatrixX2d& points, const Eigen::MatrixX3i& F,
               std::span<const PlanarLoop> drawn, int count) {
  std::vector<double> bounds;
  for (const PlanarLoop& loop : drawn) {
    for (const Eigen::Vector2d& p : loop) bounds.push_back(p.y());
  }
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const int v : F.reshaped()) {
    low = std::min(low, points(v, 1));
    high = std::max(high, points(v, 1));
  }
  bounds.insert(bounds.end(), {low, high});
  const auto [least, most] = std::minmax_element(bounds.begin(), bounds.end());
  const double bottom = *least, size = *most - *least;
  for (int i = 1; i < count; ++i) bounds.push_back(bottom + size * i / count);
  std::sort(bounds.begin(), bounds.end());
  Rows rows;
  for (std::size_t i = 1; i < bounds.size(); ++i) {
    if (!(bounds[i] > bounds[i - 1])) continue;
    rows.middle.push_back((bounds[i] + bounds[i - 1]) / 2);
    rows.height.push_back(bounds[i] - bounds[i - 1]);
  }
  return rows;
}

/// Place at which the line from `a` to `b` passes height y, which lies between theirs.
double crossing_at(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double y) {
  return a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
}

/// Part of the horizontal line at height y within a triangle that it passes.
Span span_of_triangle(const std::array<Eigen::Vector2d, 3>& corner, double y) {
  Span span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d &a = corner[k], &b = corner[(k + 1) % 3];
    if ((a.y() <= y) == (b.y() <= y)) continue;
    const double x = crossing_at(a, b, y);
    span = {std::min(span.begin, x), std::max(span.end, x)};
  }
  return span;
}

/// Things found in rows, row after row.
template <class Thing>
struct RowLists {
  std::vector<std::size_t> begin;  ///< of each row in `things`; rows + 1
  std::vector<Thing> things;

  [[nodiscard]] std::span<Thing> of(std::size_t row) {
    return {things.data() + begin[row], begin[row + 1] - begin[row]};
  }
};

/// Counts, then fills. `each(visit)` calls `visit(row, make)` for all things, twice in the same
/// order.
template <class Thing, class Each>
RowLists<Thing> make_row_lists(std::size_t rows, const Each& each) {
  RowLists<Thing> lists;
  lists.begin.assign(rows + 1, 0);
  each([&](std::size_t r, const auto&) { ++lists.begin[r + 1]; });
  for (std::size_t r = 0; r < rows; ++r) lists.begin[r + 1] += lists.begin[r];
  lists.things.resize(lists.begin.back());
  std::vector<std::size_t> next(lists.begin.begin(), lists.begin.end() - 1);
  each([&](std::size_t r, const auto& make) { lists.things[next[r]++] = make(); });
  return lists;
}

/// Calls `visit(row)` for the rows whose middles are at `low` or above it, and below `high`.
template <class Visit>
void each_row_between(const std::vector<double>& middle, double low, double high,
                      const Visit& visit) {
  const auto first = std::lower_bound(middle.begin(), middle.end(), low) - middle.begin();
  for (std::size_t r = first; r < middle.size() && middle[r] < high; ++r) visit(r);
}

RowLists<Span> spans_of_mesh(const Eigen::MatrixX2d& points, const Eigen::MatrixX3i& F,
                             const std::vector<double>& middle) {
  return make_row_lists<Span>(middle.size(), [&](const auto& visit) {
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
      std::array<Eigen::Vector2d, 3> c;
      for (int k = 0; k < 3; ++k) c[k] = points.row(F(t, k)).transpose();
      const auto [low, high] = std::minmax({c[0].y(), c[1].y(), c[2].y()});
      each_row_between(middle, low, high, [&](std::size_t r) {
        visit(r, [&] { return span_of_triangle(c, middle[r]); });
      });
    }
  });
}

/// Places at which polygons pass the middles of the rows.
RowLists<double> crossings_of_loops(std::span<const PlanarLoop> drawn,
                                    const std::vector<double>& middle) {
  return make_row_lists<double>(middle.size(), [&](const auto& visit) {
    for (const PlanarLoop& loop : drawn) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Eigen::Vector2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
        const auto [low, high] = std::minmax(a.y(), b.y());
        each_row_between(middle, low, high, [&](std::size_t r) {
          visit(r, [&] { return crossing_at(a, b, middle[r]); });
        });
      }
    }
  });
}

/// Union of spans, in place: sorted and disjoint.
std::vector<Span> united(std::span<Span> spans) {
  std::sort(spans.begin(), spans.end(),
            [](const Span& a, const Span& b) { return a.begin < b.begin; });
  std::vector<Span> all;
  for (const Span& s : spans) {
    if (!all.empty() && s.begin <= all.back().end) {
      all.back().end = std::max(all.back().end, s.end);
    } else {
      all.push_back(s);
    }
  }
  return all;
}

/// Parts of a row inside polygons that pass it at these places, by the even-odd rule; sorts them.
std::vector<Span> even_odd_spans(std::span<double> x) {
  std::sort(x.begin(), x.end());
  std::vector<Span> spans;
  for (std::size_t i = 0; i + 1 < x.size(); i += 2) spans.push_back({x[i], x[i + 1]});
  return spans;
}

double span_length(const std::vector<Span>& spans) {
  double length = 0;
  for (const Span& s : spans) length += s.end - s.begin;
  return length;
}

double common_length(const std::vector<Span>& a, const std::vector<Span>& b) {
  double length = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    length += std::max(std::min(a[i].end, b[j].end) - std::max(a[i].begin, b[j].begin), 0.0);
    ++(a[i].end < b[j].end ? i : j);
  }
  return length;
}

/// A curve of straight pieces that distances are taken from.
class CurveDistance {
 public:
  explicit CurveDistance(std::vector<PlanarSegment> segments)
      : segments_(std::move(segments)), grid_(boxes_of(segments_)) {}

  /// Distance of the nearest point. `guess` is where the search starts: fast when it is little more
  /// than the distance, right whatever it is.
  [[nodiscard]] double operator()(const Eigen::Vector2d& p, double guess) const {
    double reach = std::max(guess, grid_.cell_size() / 4);
    while (true) {
      double nearest2 = std::numeric_limits<double>::infinity();
      const Eigen::Vector2d r(reach, reach);
      grid_.visit({p - r, p + r},
                  [&](int i) { nearest2 = std::min(nearest2, distance2(segments_[i], p)); });
      const double nearest = std::sqrt(nearest2);
      if (nearest <= reach) return nearest;
      reach = std::isfinite(nearest) ? nearest : 2 * reach;
    }
  }

 private:
  static std::vector<PlanarBox> boxes_of(const std::vector<PlanarSegment>& segments) {
    std::vector<PlanarBox> boxes;
    for (const PlanarSegment& s : segments) boxes.push_back({s.a.cwiseMin(s.b), s.a.cwiseMax(s.b)});
    return boxes;
  }
  static double distance2(const PlanarSegment& s, const Eigen::Vector2d& p) {
    const Eigen::Vector2d along = s.b - s.a;
    const double length2 = along.squaredNorm();
    const double at = length2 > 0 ? std::clamp((p - s.a).dot(along) / length2, 0.0, 1.0) : 0.0;
    return (s.a + at * along - p).squaredNorm();
  }

  std::vector<PlanarSegment> segments_;
  BoxGrid grid_;
};

/// A segment cut into equal pieces no longer than the spacing, and the distances of their ends.
struct SampledSegment {
  double piece = 0;              ///< length (m)
  std::vector<double> distance;  ///< one more than pieces
};

std::vector<SampledSegment> sampled_distances(const std::vector<PlanarSegment>& segments,
                                              const CurveDistance& distance_from, double spacing) {
  std::vector<SampledSegment> samples(segments.size());
  parallel_blocks(segments.size(), 16, [&](std::size_t begin, std::size_t end) {
    double guess = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const PlanarSegment& s = segments[i];
      const double length = (s.b - s.a).norm();
      const int pieces = std::max(1, static_cast<int>(std::ceil(length / spacing)));
      samples[i].piece = length / pieces;
      for (int k = 0; k <= pieces; ++k) {
        const double d = distance_from(s.a + (s.b - s.a) * k / pieces, guess);
        samples[i].distance.push_back(d);
        guess = d + samples[i].piece;  // no farther than that at the next sample
      }
    }
  });
  return samples;
}

double largest_sample(const std::vector<SampledSegment>& samples) {
  double largest = 0;
  for (const SampledSegment& s : samples) {
    for (const double d : s.distance) largest = std::max(largest, d);
  }
  return largest;
}

/// Lengths of the stretches of closed loops that are farther than a tolerance; between samples the
/// distance is taken as linear.
class GapLengths {
 public:
  explicit GapLengths(double tolerance) : tolerance_(tolerance) {}

  /// One loop, in order.
  void add_loop(std::span<const SampledSegment> loop) {
    first_run_ = 0;
    covered_before_ = false;
    run_ = 0;
    for (const SampledSegment& s : loop) {
      for (std::size_t k = 1; k < s.distance.size(); ++k)
        add_piece(s.piece, s.distance[k - 1] - tolerance_, s.distance[k] - tolerance_);
    }
    // The loop is closed: what runs at its end goes on at its start.
    longest_ = std::max(longest_, run_ + first_run_);
  }
  [[nodiscard]] double share() const { return length_ > 0 ? far_ / length_ : 0; }
  [[nodiscard]] double longest() const { return longest_; }

 private:
  /// @param a,b  by how much the ends are farther than the tolerance
  void add_piece(double length, double a, double b) {
    length_ += length;
    const bool covered = a <= 0 || b <= 0;
    const double leading = a <= 0 ? 0 : covered ? length * a / (a - b) : length;
    run_ += leading;
    far_ += leading;
    if (!covered) return;
    if (!covered_before_) first_run_ = run_;
    covered_before_ = true;
    longest_ = std::max(longest_, run_);
    run_ = b > 0 ? length * b / (b - a) : 0;
    far_ += run_;
  }

  double tolerance_, far_ = 0, length_ = 0, longest_ = 0;
  double run_ = 0;               ///< length of the stretch so far
  double first_run_ = 0;         ///< of the one that this loop starts with
  bool covered_before_ = false;  ///< this loop had a covered point
};

std::vector<PlanarSegment> segments_of(std::span<const PlanarLoop> drawn) {
  std::vector<PlanarSegment> segments;
  for (const PlanarLoop& loop : drawn) {
    for (std::size_t i = 0; i < loop.size(); ++i)
      segments.push_back({loop[i], loop[(i + 1) % loop.size()]});
  }
  return segments;
}

double diagonal_of(std::span<const PlanarLoop> drawn) {
  PlanarBox box = box_of(drawn.front());
  for (const PlanarLoop& loop : drawn) {
    const PlanarBox b = box_of(loop);
    box = {box.low.cwiseMin(b.low), box.high.cwiseMax(b.high)};
  }
  return (box.high - box.low).norm();
}

void require_options(const SilhouetteOptions& options) {
  if (!(options.sampling > 0) || !(options.gap_tolerance > 0))
    throw Error("sampling or tolerance is not positive", "silhouette", "above 0");
}

}  // namespace

SilhouetteArea silhouette_area(const Eigen::MatrixX2d& points, const Eigen::MatrixX3i& triangles,
                               std::span<const PlanarLoop> drawn, int rows) {
  require_drawn(drawn);
  if (rows < 1) throw Error(std::to_string(rows) + " rows", "silhouette", "1 or more");
  if (!points.allFinite()) throw Error("coordinate is not finite", "silhouette", "finite numbers");
  if (triangles.rows() == 0) throw Error("no triangles", "silhouette", "at least one");
  const Rows grid = make_rows(points, triangles, drawn, rows);
  RowLists<Span> spans = spans_of_mesh(points, triangles, grid.middle);
  RowLists<double> crossings = crossings_of_loops(drawn, grid.middle);
  std::vector<SilhouetteArea> of_row(grid.middle.size());
  parallel_blocks(of_row.size(), kRowsOfBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      const std::vector<Span> mesh = united(spans.of(r));
      const std::vector<Span> shape = even_odd_spans(crossings.of(r));
      of_row[r] = {grid.height[r] * span_length(mesh), grid.height[r] * span_length(shape),
                   grid.height[r] * common_length(mesh, shape)};
    }
  });
  SilhouetteArea area;
  for (const SilhouetteArea& r : of_row) {
    area.mesh += r.mesh;
    area.drawn += r.drawn;
    area.common += r.common;
  }
  if (!(area.mesh > 0)) throw Error("projection has no area", "silhouette", "a positive area");
  if (!(area.drawn > 0)) throw Error("drawing has no area", "silhouette", "a positive area");
  return area;
}

SilhouetteMatch silhouette_match(const TriMesh& mesh, const Eigen::Matrix3d& view,
                                 std::span<const PlanarLoop> drawn,
                                 const SilhouetteOptions& options) {
  require_options(options);
  const Eigen::MatrixX2d points = projected_points(mesh, view);
  SilhouetteMatch match;
  match.iou = silhouette_area(points, mesh.F, drawn, options.rows).iou();
  const double diagonal = diagonal_of(drawn), spacing = options.sampling * diagonal;
  const std::vector<PlanarSegment> drawn_segments = segments_of(drawn);
  const std::vector<PlanarSegment> outline = projected_outline(points, mesh.F);
  const std::vector<SampledSegment> from_drawn =
      sampled_distances(drawn_segments, CurveDistance(outline), spacing);
  match.drawn_to_mesh = largest_sample(from_drawn);
  match.mesh_to_drawn =
      largest_sample(sampled_distances(outline, CurveDistance(drawn_segments), spacing));
  match.hausdorff = std::max(match.drawn_to_mesh, match.mesh_to_drawn);
  match.hausdorff_percent = 100 * match.hausdorff / diagonal;
  GapLengths gaps(options.gap_tolerance * diagonal);
  std::size_t first = 0;
  for (const PlanarLoop& loop : drawn) {
    gaps.add_loop({from_drawn.data() + first, loop.size()});
    first += loop.size();
  }
  match.gap_share = gaps.share();
  match.gap_longest = gaps.longest();
  return match;
}

}  // namespace geoprior
