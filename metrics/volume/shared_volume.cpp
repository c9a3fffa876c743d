#include "metrics/volume/shared_volume.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "metrics/volume/liquid_columns.h"

namespace geoprior {
namespace {

constexpr int kRowsAtOnce = 16;
constexpr double kMostColumns = 268435456;  // 2^28

/// A column enters (+1) or leaves (-1) a ball or the surface on its way up.
struct Passage {
  Eigen::Index column;
  double height;
  int ball, surface;
};

/// Rows of a grid from `first` to `last`, with what reaches them.
struct Strip {
  int first, last;
  std::vector<int> balls, triangles;
};

void require_valid(const Balls& balls, const TriMesh& surface, double spacing) {
  if (!(spacing > 0)) {
    throw Error("column spacing " + std::to_string(spacing), "shared volume", "a positive length");
  }
  if (balls.radii.size() != balls.centres.rows()) {
    throw Error(std::to_string(balls.radii.size()) + " radii", "shared volume",
                std::to_string(balls.centres.rows()) + ", one a ball");
  }
  if (!balls.centres.allFinite() || !surface.V.allFinite()) {
    throw Error("coordinate is not finite", "shared volume", "finite numbers");
  }
  for (Eigen::Index b = 0; b < balls.radii.size(); ++b) {
    if (!(balls.radii[b] > 0) || !std::isfinite(balls.radii[b]))
      throw Error("radius is not positive", "ball " + std::to_string(b), "a positive length");
  }
}

ColumnGrid grid_over(const Balls& balls, const TriMesh& surface, double spacing) {
  const Eigen::Index n = balls.centres.rows();
  Eigen::MatrixX3d extremes(2 * n + surface.V.rows(), 3);
  extremes << balls.centres.colwise() - balls.radii, balls.centres.colwise() + balls.radii,
      surface.V;
  const Eigen::RowVector3d size =
      extremes.rows() == 0 ? Eigen::RowVector3d::Zero().eval()
                           : (extremes.colwise().maxCoeff() - extremes.colwise().minCoeff()).eval();
  if ((size.x() / spacing + 1) * (size.y() / spacing + 1) > kMostColumns) {
    throw Error("too many columns", "shared volume, spacing " + std::to_string(spacing) + " m",
                "at most 2^28 columns");
  }
  return covering_grid(extremes, spacing);
}

std::vector<Strip> strips_of(const Balls& balls, const TriMesh& surface, const ColumnGrid& grid) {
  std::vector<Strip> strips;
  for (int first = 0; first < grid.ny; first += kRowsAtOnce)
    strips.push_back({first, std::min(first + kRowsAtOnce, grid.ny) - 1, {}, {}});
  const auto strip_at = [&](double y) {
    const double row = (y - grid.origin.y()) / grid.spacing - 0.5;
    return static_cast<int>(std::clamp(row, 0.0, grid.ny - 1.0)) / kRowsAtOnce;
  };
  for (int b = 0; b < std::ssize(balls.radii); ++b) {
    const double y = balls.centres(b, 1), r = balls.radii[b];
    for (int s = strip_at(y - r); s <= strip_at(y + r); ++s) strips[s].balls.push_back(b);
  }
  for (int t = 0; t < surface.triangle_count(); ++t) {
    const auto [low, high] =
        std::minmax({surface.V(surface.F(t, 0), 1), surface.V(surface.F(t, 1), 1),
                     surface.V(surface.F(t, 2), 1)});
    // A row more, where rounding puts a column on the border of a strip.
    for (int s = strip_at(low - grid.spacing); s <= strip_at(high + grid.spacing); ++s)
      strips[s].triangles.push_back(t);
  }
  return strips;
}

void append_ball(const Balls& balls, int b, const ColumnGrid& grid, const Strip& strip,
                 const Eigen::AlignedBox3d& room, std::vector<Passage>* passages) {
  const Eigen::Vector3d centre = balls.centres.row(b);
  const double r = balls.radii[b];
  const Eigen::AlignedBox2d plan(room.min().head<2>(), room.max().head<2>());
  const auto first = [&](int axis, int least) {
    return std::max(
        least,
        static_cast<int>(std::ceil((centre[axis] - r - grid.origin[axis]) / grid.spacing - 0.5)));
  };
  const auto last = [&](int axis, int most) {
    return std::min(
        most,
        static_cast<int>(std::floor((centre[axis] + r - grid.origin[axis]) / grid.spacing - 0.5)));
  };
  for (int j = first(1, strip.first); j <= last(1, strip.last); ++j) {
    for (int i = first(0, 0); i <= last(0, grid.nx - 1); ++i) {
      const Eigen::Vector2d at = grid.probe(i, j);
      const double left = r * r - (at - centre.head<2>()).squaredNorm();
      if (left <= 0 || !plan.contains(at)) continue;
      const double low = std::max(centre.z() - std::sqrt(left), room.min().z());
      const double high = std::min(centre.z() + std::sqrt(left), room.max().z());
      if (low >= high) continue;
      passages->push_back({grid.index(i, j), low, 1, 0});
      passages->push_back({grid.index(i, j), high, -1, 0});
    }
  }
}

void append_surface(const TriMesh& surface, const ColumnGrid& grid, const Strip& strip,
                    std::vector<Passage>* passages) {
  std::vector<ColumnCrossing> crossings;
  for (const int t : strip.triangles) {
    append_crossings(surface.V({surface.F(t, 0), surface.F(t, 1), surface.F(t, 2)}, Eigen::all),
                     grid, strip.first, strip.last, &crossings);
  }
  for (const ColumnCrossing& c : crossings)
    passages->push_back({grid.index(c.i, c.j), c.height, 0, -c.sign});
}

/// Lengths along the columns, in metres of column.
SharedVolume lengths_along(std::vector<Passage>* passages) {
  std::sort(passages->begin(), passages->end(), [](const Passage& a, const Passage& b) {
    return std::tie(a.column, a.height) < std::tie(b.column, b.height);
  });
  SharedVolume sum;
  int in_balls = 0, in_surface = 0;
  for (std::size_t k = 0; k < passages->size(); ++k) {
    const Passage& here = (*passages)[k];
    in_balls += here.ball;
    in_surface += here.surface;
    const bool last = k + 1 == passages->size() || (*passages)[k + 1].column != here.column;
    if (last) {
      in_balls = in_surface = 0;
      continue;
    }
    const double length = (*passages)[k + 1].height - here.height;
    if (in_balls > 0) sum.first += length;
    if (in_surface > 0) sum.second += length;
    if (in_balls > 0 && in_surface > 0) sum.both += length;
  }
  return sum;
}

}  // namespace

std::optional<double> SharedVolume::intersection_over_union() const {
  const double either = first + second - both;
  if (either <= 0) return std::nullopt;
  return both / either;
}

SharedVolume shared_volume(const Balls& balls, const TriMesh& surface, double spacing,
                           const Eigen::AlignedBox3d& room) {
  require_valid(balls, surface, spacing);
  if (balls.radii.size() == 0 && surface.V.rows() == 0) return {};
  const ColumnGrid grid = grid_over(balls, surface, spacing);
  const std::vector<Strip> strips = strips_of(balls, surface, grid);
  std::vector<SharedVolume> partial(strips.size());
  parallel_blocks(strips.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<Passage> passages;
    for (std::size_t s = begin; s < end; ++s) {
      passages.clear();
      for (const int b : strips[s].balls) append_ball(balls, b, grid, strips[s], room, &passages);
      append_surface(surface, grid, strips[s], &passages);
      partial[s] = lengths_along(&passages);
    }
  });
  SharedVolume total;
  const double area = spacing * spacing;
  for (const SharedVolume& p : partial) {
    total.first += p.first * area;
    total.second += p.second * area;
    total.both += p.both * area;
  }
  return total;
}

}  // namespace geoprior
