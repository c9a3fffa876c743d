#include "metrics/spacing/projected_holes.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/error.h"
#include "metrics/shape/projected_outline.h"

namespace geoprior {
namespace {

/// An interval of a horizontal line.
struct LinePart {
  double begin = 0, end = 0;
};

/// Horizontal lines through the middles of equal rows.
struct ScanLines {
  double bottom = 0, height = 0;  ///< of a row
  double left = 0, right = 0;     ///< beyond the projection
  std::vector<std::vector<LinePart>> covered;
};

void add_triangle(const std::array<Eigen::Vector2d, 3>& c, ScanLines& lines) {
  const auto [low, high] = std::minmax({c[0].y(), c[1].y(), c[2].y()});
  const auto count = static_cast<int>(lines.covered.size());
  const int first = std::max(0, static_cast<int>((low - lines.bottom) / lines.height - 0.5));
  for (int r = first; r < count; ++r) {
    const double y = lines.bottom + (r + 0.5) * lines.height;
    if (y < low) continue;
    if (y >= high) break;
    LinePart part{lines.right, lines.left};
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d &a = c[k], &b = c[(k + 1) % 3];
      if ((a.y() <= y) == (b.y() <= y)) continue;
      const double x = a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      part = {std::min(part.begin, x), std::max(part.end, x)};
    }
    lines.covered[r].push_back(part);
  }
}

ScanLines scan(const Eigen::MatrixX2d& points, const Eigen::MatrixX3i& F, int rows) {
  ScanLines lines;
  const Eigen::RowVector2d low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  lines.bottom = low.y();
  lines.height = (high.y() - low.y()) / rows;
  lines.left = low.x() - lines.height;
  lines.right = high.x() + lines.height;
  lines.covered.resize(rows);
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    std::array<Eigen::Vector2d, 3> corner;
    for (int k = 0; k < 3; ++k) corner[k] = points.row(F(t, k)).transpose();
    add_triangle(corner, lines);
  }
  return lines;
}

/// What a line leaves open, from `left` to `right`.
std::vector<LinePart> open_parts(std::vector<LinePart> covered, double left, double right) {
  std::sort(covered.begin(), covered.end(),
            [](const LinePart& a, const LinePart& b) { return a.begin < b.begin; });
  std::vector<LinePart> open;
  double reached = left;
  for (const LinePart& part : covered) {
    if (part.begin > reached) open.push_back({reached, part.begin});
    reached = std::max(reached, part.end);
  }
  open.push_back({reached, right});
  return open;
}

/// An open part of a line that nothing joins with the outside.
struct HolePart {
  int row = 0;
  LinePart part;
};

std::vector<HolePart> hole_parts(const ScanLines& lines) {
  std::vector<HolePart> all;
  std::vector<std::size_t> first{0};
  for (int r = 0; r < std::ssize(lines.covered); ++r) {
    for (const LinePart& part : open_parts(lines.covered[r], lines.left, lines.right))
      all.push_back({r, part});
    first.push_back(all.size());
  }
  const auto outside = static_cast<int>(all.size());
  DisjointSets joined(outside + 1);
  for (std::size_t r = 0; r + 1 < first.size(); ++r) {
    const bool is_end = r == 0 || r + 2 == first.size();
    for (std::size_t i = first[r]; i < first[r + 1]; ++i) {
      const LinePart& a = all[i].part;
      if (is_end || a.begin <= lines.left || a.end >= lines.right)
        joined.join(static_cast<int>(i), outside);
      if (r + 2 == first.size()) continue;
      for (std::size_t j = first[r + 1]; j < first[r + 2]; ++j) {
        const LinePart& b = all[j].part;
        if (a.begin < b.end && b.begin < a.end)
          joined.join(static_cast<int>(i), static_cast<int>(j));
      }
    }
  }
  std::vector<HolePart> holes;
  for (int i = 0; i < outside; ++i) {
    if (joined.find(i) != joined.find(outside)) holes.push_back(all[i]);
  }
  return holes;
}

}  // namespace

TriMesh with_filled_holes(const TriMesh& mesh, const Eigen::Matrix3d& view, int rows) {
  if (rows < 2) throw Error(std::to_string(rows) + " rows", "holes of a projection", "2 or more");
  const ScanLines lines = scan(projected_points(mesh, view), mesh.F, rows);
  const std::vector<HolePart> holes = hole_parts(lines);
  TriMesh filled = mesh;
  const Eigen::Index count = holes.size();
  filled.V.conservativeResize(mesh.V.rows() + 4 * count, 3);
  filled.F.conservativeResize(mesh.F.rows() + 2 * count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const HolePart& hole = holes[i];
    const double x0 = hole.part.begin - lines.height, x1 = hole.part.end + lines.height;
    const double y0 = lines.bottom + (hole.row - 1) * lines.height, y1 = y0 + 3 * lines.height;
    const Eigen::Index v = mesh.V.rows() + 4 * i;
    const std::array<Eigen::Vector2d, 4> corner{{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
    for (int k = 0; k < 4; ++k)
      filled.V.row(v + k) = (view.topRows<2>().transpose() * corner[k]).transpose();
    const int a = static_cast<int>(v);
    filled.F.row(mesh.F.rows() + 2 * i) << a, a + 1, a + 2;
    filled.F.row(mesh.F.rows() + 2 * i + 1) << a, a + 2, a + 3;
  }
  return filled;
}

}  // namespace geoprior
