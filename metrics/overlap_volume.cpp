#include "metrics/overlap_volume.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

namespace geoprior {
namespace {

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
void rasterise(const std::array<Corner, 3>& c, RowRange rows, const OverlapGrid& grid,
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
      crossings.push_back({z, j * grid.width + i, l0 ? -1 : 1});
    }
  }
}

/// Integral of max(0, w - 1) between z_low and z_high along one column, its crossings sorted by z.
double integrate(const Crossing* begin, const Crossing* end, const OverlapGrid& grid) {
  double sum = 0;
  int winding = 0;
  for (const Crossing* c = begin; c + 1 < end; ++c) {
    winding += c->sign;
    if (winding < 2) continue;
    const double low = std::max(c->z, grid.z_low);
    const double high = std::min((c + 1)->z, grid.z_high);
    if (high > low) sum += (winding - 1) * (high - low);
  }
  return sum;
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

OverlapVolume integrate_strip(StripBuffers& b, int first_column, int columns,
                              const OverlapGrid& grid) {
  sort_by_column(b, first_column, columns);
  OverlapVolume strip;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(columns); ++i) {
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
    strip.volume += integrate(first, last, grid);
  }
  return strip;
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
  const int strips = (grid.height + kRowsOfStrip - 1) / kRowsOfStrip;
  std::vector<std::vector<int>> of_strip(strips);
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

}  // namespace

OverlapVolume overlap_volume(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                             const Eigen::AlignedBox3d& box, double spacing, int axis) {
  if (!(spacing > 0)) {
    throw Error("column spacing " + std::to_string(spacing), "overlap volume", "a positive length");
  }
  if (box.isEmpty() || F.rows() == 0) return {};
  const OverlapGrid grid = make_grid(box, spacing, axis);
  const std::vector<Corner> corners = project(V, grid);
  const std::vector<std::vector<int>> of_strip = triangles_of_strips(corners, F, grid);
  std::vector<OverlapVolume> partial(of_strip.size());
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
        rasterise(c, rows, grid, buffers.crossings);
      }
      const int rows_here = std::min(kRowsOfStrip, grid.height - strip_first);
      partial[s] = integrate_strip(buffers, strip_first * grid.width, rows_here * grid.width, grid);
    }
  });
  OverlapVolume total;
  for (const OverlapVolume& p : partial) {
    total.volume += p.volume;
    total.columns += p.columns;
    total.unbalanced_columns += p.unbalanced_columns;
  }
  total.volume *= spacing * spacing;
  return total;
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
  study.noise_floor =
      std::max({std::abs(coarse.volume - fine.volume), std::abs(coarse.volume - across.volume),
                spacing * spacing / 4 * depth_scale});
  study.unbalanced_columns =
      coarse.unbalanced_columns + fine.unbalanced_columns + across.unbalanced_columns;
  return study;
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
