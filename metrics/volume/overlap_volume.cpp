#include "metrics/volume/overlap_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

namespace geoprior {
namespace {

constexpr double kBodySpacings = 768;  // columns along the diagonal of a whole body
constexpr double kBodyDepth = 48;      // detection depth of a whole body, in column spacings

constexpr int kRowsOfStrip = 16;
constexpr double kMaxColumns = 268435456;  // 2^28
constexpr double kSpacingsOfRadius = 24;

/// A square grid of columns seen along their axis; (x, y, z) is a cyclic permutation, so that
/// orientation is kept.
struct OverlapGrid {
  int x_axis, y_axis, z_axis;
  double x0, y0, spacing;  // of column (0, 0)
  int width, height;
  double z_low, z_high;

  [[nodiscard]] std::size_t strips() const { return (height + kRowsOfStrip - 1) / kRowsOfStrip; }
  /// Whether the column stands beside a side face of the box.
  [[nodiscard]] bool is_border(int column) const {
    const int i = column % width, j = column / width;
    return i == 0 || j == 0 || i == width - 1 || j == height - 1;
  }
};

OverlapGrid make_grid(const Eigen::AlignedBox3d& box, double spacing, int axis) {
  OverlapGrid g{};
  g.x_axis = (axis + 1) % 3;
  g.y_axis = (axis + 2) % 3;
  g.z_axis = axis;
  g.spacing = spacing;
  // Irrational, different offsets in (0, 1): a column hits no vertex of a symmetric or gridded
  // mesh.
  g.x0 = box.min()(g.x_axis) + (std::numbers::sqrt2 - 1) * spacing;
  g.y0 = box.min()(g.y_axis) + (std::numbers::phi - 1) * spacing;
  const Eigen::Vector3d size = box.sizes();
  const double width = std::ceil(size(g.x_axis) / spacing);
  const double height = std::ceil(size(g.y_axis) / spacing);
  if (width * height > kMaxColumns) {
    throw Error("too many columns", "overlap volume, spacing " + std::to_string(spacing) + " m",
                "at most 2^28 columns");
  }
  g.width = static_cast<int>(width);
  g.height = static_cast<int>(height);
  g.z_low = box.min()(axis);
  g.z_high = box.max()(axis);
  return g;
}

/// A mesh corner in the coordinates of the grid: column (i, j) stands at x = i, y = j.
struct Corner {
  double x, y, z;
  int index;
};

struct Crossing {
  double z;
  int column;
  int triangle;
  int sign;  ///< +1 where w rises with z
};

/// Which side of the line from `a` to `b` (in order of vertex index) the point lies on, and the
/// doubled area. Both triangles of an edge see the same number with opposite sign.
struct EdgeSide {
  explicit EdgeSide(const Corner& a, const Corner& b)
      : from(a.index < b.index ? a : b),
        to(a.index < b.index ? b : a),
        flip(a.index < b.index ? 1.0 : -1.0) {}
  [[nodiscard]] double operator()(double x, double y, bool& left) const {
    const double area = (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
    left = (area >= 0) == (flip > 0);
    return flip * area;
  }
  Corner from, to;
  double flip;
};

struct RowRange {
  int first, last;
};

RowRange rows_of(const std::array<Corner, 3>& c, int height) {
  const auto [low, high] = std::minmax({c[0].y, c[1].y, c[2].y});
  return {static_cast<int>(std::ceil(std::max(low, 0.0))),
          static_cast<int>(std::floor(std::min(high, height - 1.0)))};
}

/// The crossings of one triangle with the columns of rows [first, last].
void rasterise(const std::array<Corner, 3>& c, int triangle, RowRange rows, const OverlapGrid& grid,
               std::vector<Crossing>& crossings) {
  const auto [low, high] = std::minmax({c[0].x, c[1].x, c[2].x});
  const int first = static_cast<int>(std::ceil(std::max(low, 0.0)));
  const int last = static_cast<int>(std::floor(std::min(high, grid.width - 1.0)));
  if (first > last) return;
  const EdgeSide e0(c[1], c[2]), e1(c[2], c[0]), e2(c[0], c[1]);
  for (int j = rows.first; j <= rows.last; ++j) {
    for (int i = first; i <= last; ++i) {
      bool l0 = false, l1 = false, l2 = false;
      const double a0 = e0(i, j, l0), a1 = e1(i, j, l1), a2 = e2(i, j, l2);
      if (l0 != l1 || l1 != l2) continue;
      // Counter-clockwise seen from +z is a surface that faces +z: w falls there.
      const double z = (a0 * c[0].z + a1 * c[1].z + a2 * c[2].z) / (a0 + a1 + a2);
      crossings.push_back({z, j * grid.width + i, triangle, l0 ? -1 : 1});
    }
  }
}

/// Lengths along one column between z_low and z_high (m).
struct ColumnSums {
  double overlap = 0;     ///< integral of max(0, w - 1)
  double inside_out = 0;  ///< integral of max(0, -w)
  int cut_ends = 0;       ///< times that an overlap goes on beyond z_low or z_high
};

/// Over the crossings of a column, sorted by z.
ColumnSums integrate(const Crossing* begin, const Crossing* end, const OverlapGrid& grid) {
  ColumnSums sums;
  int winding = 0;
  for (const Crossing* c = begin; c + 1 < end; ++c) {
    winding += c->sign;
    if (winding == 0 || winding == 1) continue;
    const double low = std::max(c->z, grid.z_low);
    const double high = std::min((c + 1)->z, grid.z_high);
    if (!(high > low)) continue;
    if (winding < 0) {
      sums.inside_out -= winding * (high - low);
      continue;
    }
    sums.overlap += (winding - 1) * (high - low);
    sums.cut_ends += (c->z < grid.z_low ? 1 : 0) + ((c + 1)->z > grid.z_high ? 1 : 0);
  }
  return sums;
}

/// Marks the triangles in which a column enters or leaves an overlap within the box.
void mark_overlap(const Crossing* begin, const Crossing* end, const OverlapGrid& grid,
                  std::vector<int>& triangles) {
  int below = 0;
  for (const Crossing* c = begin; c != end; ++c) {
    const int above = below + c->sign;
    const bool bounds_overlap = (below >= 2) != (above >= 2);
    if (bounds_overlap && c->z >= grid.z_low && c->z <= grid.z_high) {
      triangles.push_back(c->triangle);
    }
    below = above;
  }
}

/// What a thread needs for one strip after another.
struct StripBuffers {
  std::vector<Crossing> crossings;  // in order of triangles
  std::vector<Crossing> sorted;     // in order of columns
  std::vector<std::size_t> end_of_column;
};

/// Groups the crossings by column (counting sort, keeps the order of triangles).
void sort_by_column(StripBuffers& b, int first_column, int columns) {
  const auto slot = [&](const Crossing& c) {
    return static_cast<std::size_t>(c.column - first_column);
  };
  b.end_of_column.assign(columns + 1, 0);
  for (const Crossing& c : b.crossings) ++b.end_of_column[slot(c) + 1];
  for (std::size_t i = 1; i < b.end_of_column.size(); ++i)
    b.end_of_column[i] += b.end_of_column[i - 1];
  b.sorted.resize(b.crossings.size());
  for (const Crossing& c : b.crossings) b.sorted[b.end_of_column[slot(c)]++] = c;
}

/// Calls `visit(column, first, last)` with the crossings of each column, sorted by z; returns how
/// many columns crossed anything, and how many of those did not balance and were left out.
template <class Visit>
OverlapVolume visit_columns(StripBuffers& b, int first_column, int columns, const Visit& visit) {
  sort_by_column(b, first_column, columns);
  OverlapVolume strip;
  std::size_t begin = 0;
  for (int i = 0; i < columns; ++i) {
    const std::size_t end = b.end_of_column[i];
    if (begin == end) continue;
    Crossing* first = b.sorted.data() + begin;
    Crossing* last = b.sorted.data() + end;
    begin = end;
    int balance = 0;
    for (const Crossing* c = first; c != last; ++c) balance += c->sign;
    ++strip.columns;
    if (balance != 0) {
      ++strip.unbalanced_columns;
      continue;
    }
    std::sort(first, last, [](const Crossing& l, const Crossing& r) { return l.z < r.z; });
    visit(first_column + i, first, last);
  }
  return strip;
}

/// Sums over the columns of a strip; lengths are not yet multiplied by the spacing.
OverlapVolume integrate_strip(StripBuffers& b, int first_column, int columns,
                              const OverlapGrid& grid) {
  OverlapVolume sums;
  const auto add = [&](int column, const Crossing* first, const Crossing* last) {
    const ColumnSums c = integrate(first, last, grid);
    sums.volume += c.overlap * grid.spacing * grid.spacing;
    sums.inside_out += c.inside_out * grid.spacing * grid.spacing;
    sums.cut_area += c.cut_ends * grid.spacing * grid.spacing;
    if (grid.is_border(column)) sums.cut_area += c.overlap * grid.spacing;
  };
  const OverlapVolume counted = visit_columns(b, first_column, columns, add);
  sums.columns = counted.columns;
  sums.unbalanced_columns = counted.unbalanced_columns;
  return sums;
}

std::vector<Corner> project(const Eigen::MatrixX3d& V, const OverlapGrid& grid) {
  std::vector<Corner> corners(V.rows());
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    corners[v] = {(V(v, grid.x_axis) - grid.x0) / grid.spacing,
                  (V(v, grid.y_axis) - grid.y0) / grid.spacing, V(v, grid.z_axis),
                  static_cast<int>(v)};
  }
  return corners;
}

std::array<Corner, 3> corners_of(const std::vector<Corner>& corners, const Eigen::MatrixX3i& F,
                                 Eigen::Index t) {
  return {corners[F(t, 0)], corners[F(t, 1)], corners[F(t, 2)]};
}

/// Triangles that reach each strip of rows, in order of index.
std::vector<std::vector<int>> triangles_of_strips(const std::vector<Corner>& corners,
                                                  const Eigen::MatrixX3i& F,
                                                  const OverlapGrid& grid) {
  std::vector<std::vector<int>> of_strip(grid.strips());
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const std::array<Corner, 3> c = corners_of(corners, F, t);
    const auto [low, high] = std::minmax({c[0].x, c[1].x, c[2].x});
    const RowRange rows = rows_of(c, grid.height);
    if (high < 0 || low > grid.width - 1 || rows.first > rows.last) continue;
    for (int s = rows.first / kRowsOfStrip; s <= rows.last / kRowsOfStrip; ++s) {
      of_strip[s].push_back(static_cast<int>(t));
    }
  }
  return of_strip;
}

/// Calls `finish(strip, buffers, first column, columns)` for every strip of the grid, in parallel.
template <class Finish>
void each_strip(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F, const OverlapGrid& grid,
                const Finish& finish) {
  const std::vector<Corner> corners = project(V, grid);
  const std::vector<std::vector<int>> of_strip = triangles_of_strips(corners, F, grid);
  parallel_blocks(of_strip.size(), 1, [&](std::size_t begin, std::size_t end) {
    StripBuffers buffers;
    for (std::size_t s = begin; s < end; ++s) {
      buffers.crossings.clear();
      const int strip_first = static_cast<int>(s) * kRowsOfStrip;
      for (const int t : of_strip[s]) {
        const std::array<Corner, 3> c = corners_of(corners, F, t);
        RowRange rows = rows_of(c, grid.height);
        rows.first = std::max(rows.first, strip_first);
        rows.last = std::min(rows.last, strip_first + kRowsOfStrip - 1);
        rasterise(c, t, rows, grid, buffers.crossings);
      }
      const int rows_here = std::min(kRowsOfStrip, grid.height - strip_first);
      finish(s, buffers, strip_first * grid.width, rows_here * grid.width);
    }
  });
}

void require_spacing(double spacing) {
  if (spacing > 0) return;
  throw Error("column spacing " + std::to_string(spacing), "overlap volume", "a positive length");
}

Eigen::AlignedBox3d bounds_of_triangles(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F) {
  Eigen::AlignedBox3d box;
  for (const int v : F.reshaped()) box.extend(V.row(v).transpose());
  return box;
}

int longest_axis(const Eigen::AlignedBox3d& box) {
  Eigen::Index axis = 0;
  if (!box.isEmpty()) box.sizes().maxCoeff(&axis);
  return static_cast<int>(axis);
}

}  // namespace

OverlapVolume overlap_volume(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                             const Eigen::AlignedBox3d& box, double spacing, int axis) {
  require_spacing(spacing);
  if (box.isEmpty() || F.rows() == 0) return {};
  const OverlapGrid grid = make_grid(box, spacing, axis);
  std::vector<OverlapVolume> partial(grid.strips());
  each_strip(V, F, grid, [&](std::size_t s, StripBuffers& buffers, int first, int columns) {
    partial[s] = integrate_strip(buffers, first, columns, grid);
  });
  OverlapVolume total;
  for (const OverlapVolume& p : partial) {
    total.volume += p.volume;
    total.inside_out += p.inside_out;
    total.cut_area += p.cut_area;
    total.columns += p.columns;
    total.unbalanced_columns += p.unbalanced_columns;
  }
  return total;
}

std::vector<int> triangles_about_overlap(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                                         double spacing) {
  require_spacing(spacing);
  const Eigen::AlignedBox3d box = bounds_of_triangles(V, F);
  if (box.isEmpty()) return {};
  const OverlapGrid grid = make_grid(box, spacing, longest_axis(box));
  std::vector<std::vector<int>> partial(grid.strips());
  each_strip(V, F, grid, [&](std::size_t s, StripBuffers& buffers, int first, int columns) {
    visit_columns(buffers, first, columns, [&](int, const Crossing* begin, const Crossing* end) {
      mark_overlap(begin, end, grid, partial[s]);
    });
  });
  std::vector<int> triangles;
  for (const std::vector<int>& p : partial) triangles.insert(triangles.end(), p.begin(), p.end());
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

double union_volume(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F, double spacing) {
  const Eigen::AlignedBox3d box = bounds_of_triangles(V, F);
  const OverlapVolume overlap = overlap_volume(V, F, box, spacing, longest_axis(box));
  return signed_volume(V, F) - overlap.volume + overlap.inside_out;
}

OverlapStudy overlap_study(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                           const Eigen::AlignedBox3d& box, double spacing, double depth_scale) {
  // The longest side first: looking along it the projection is smallest.
  std::array<int, 3> axes{0, 1, 2};
  const Eigen::Vector3d size =
      box.isEmpty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : Eigen::Vector3d(box.sizes());
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return size(a) > size(b); });
  const OverlapVolume coarse = overlap_volume(V, F, box, spacing, axes[0]);
  const OverlapVolume fine = overlap_volume(V, F, box, spacing / 2, axes[0]);
  const OverlapVolume across = overlap_volume(V, F, box, spacing, axes[1]);
  OverlapStudy study;
  study.volume = fine.volume;
  study.inside_out = fine.inside_out;
  study.cut_area = fine.cut_area;
  study.noise_floor =
      std::max({std::abs(coarse.volume - fine.volume), std::abs(coarse.volume - across.volume),
                spacing * spacing / 4 * depth_scale});
  study.unbalanced_columns =
      coarse.unbalanced_columns + fine.unbalanced_columns + across.unbalanced_columns;
  return study;
}

double OverlapStudy::ratio_to(const OverlapStudy& other) const {
  const double floor = std::max(noise_floor, other.noise_floor);
  return volume <= floor ? 0.0 : volume / std::max(other.volume, floor);
}

OverlapStudy overlap_above_rest(const OverlapStudy& posed, const OverlapStudy& rest) {
  OverlapStudy above = posed;
  above.volume -= rest.volume;
  above.noise_floor += rest.noise_floor;
  above.inside_out -= rest.inside_out;
  above.cut_area = std::max(above.cut_area - rest.cut_area, 0.0);
  return above;
}

double union_volume_change(const Eigen::MatrixX3d& rest, const Eigen::MatrixX3d& posed,
                           const Eigen::MatrixX3i& F, const OverlapStudy& above,
                           double rest_union) {
  const double change =
      signed_volume(posed, F) - signed_volume(rest, F) - above.volume + above.inside_out;
  return change / rest_union;
}

double body_column_spacing(const Eigen::MatrixX3d& rest) {
  return bounding_box_diagonal(rest) / kBodySpacings;
}

OverlapStudy body_overlap_study(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                                double spacing) {
  Eigen::AlignedBox3d box;
  for (Eigen::Index v = 0; v < V.rows(); ++v) box.extend(V.row(v).transpose());
  return overlap_study(V, F, box, spacing, kBodyDepth * spacing);
}

OverlapStudy region_overlap_study(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                                  const JointRegion& region, const Pose& pose) {
  return overlap_study(V, F, joint_box(region, pose), region_column_spacing(region),
                       smallest_radius(region));
}

Eigen::AlignedBox3d joint_box(const JointRegion& region, const Pose& pose) {
  Eigen::AlignedBox3d box;
  for (const JointRegion::Hinge& hinge : region.hinges) {
    const Eigen::Vector3d centre = pose[hinge.joint] * hinge.head;
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant((region.extent + 1) * hinge.radius);
    box.extend(centre - reach);
    box.extend(centre + reach);
  }
  return box;
}

double smallest_radius(const JointRegion& region) {
  if (region.hinges.empty()) throw Error("a region without joints has no size", region.name);
  double radius = region.hinges.front().radius;
  for (const JointRegion::Hinge& hinge : region.hinges) radius = std::min(radius, hinge.radius);
  return radius;
}

double region_column_spacing(const JointRegion& region) {
  return smallest_radius(region) / kSpacingsOfRadius;
}

}  // namespace geoprior
