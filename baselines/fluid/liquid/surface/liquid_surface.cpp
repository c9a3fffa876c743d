#include "baselines/fluid/liquid/surface/liquid_surface.h"

#include <algorithm>
#include <cmath>

#include "baselines/fluid/liquid/grid/mac_grid_sampler.h"
#include "baselines/fluid/liquid/surface/kernels.h"
#include "core/error.h"
#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr std::size_t kSurfaceLayers = 2;  ///< layers of nodes of a parallel block
/// Cells off a solid where the liquid beside it is looked up: particles stay half a cell off, and a
/// cell further the field is deep.
constexpr float kReadOff = 1.5F;
constexpr float kOnWall = 1e-3F;  ///< cells: as near as this, a node of the border is on a wall

template <class Body>
void for_layers(int layers, const Body& body) {
  parallel_blocks(layers, kSurfaceLayers, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) body(static_cast<int>(k));
  });
}

GridShape refined(const GridShape& shape, double cells_per_cell) {
  GridShape result = shape;
  result.cell = shape.cell / cells_per_cell;
  result.cells =
      (shape.cells.cast<double>() * cells_per_cell).array().round().cast<int>().max(2).matrix();
  return result;
}

/// One pass of phi <- phi / 2 + (mean of six neighbours) / 2 inside the grid.
void smooth(ScalarGrid& field) {
  const ScalarGrid old = field;
  const std::size_t dx = 1, dy = static_cast<std::size_t>(field.size.x()), dz = dy * field.size.y();
  for_layers(field.size.z(), [&](int k) {
    if (k == 0 || k + 1 == field.size.z()) return;
    for (int j = 1; j + 1 < field.size.y(); ++j)
      for (int i = 1; i + 1 < field.size.x(); ++i) {
        const std::size_t n = field.index(i, j, k);
        const float* v = old.values.data() + n;
        const float around = (v[dx] + *(v - dx)) + (v[dy] + *(v - dy)) + (v[dz] + *(v - dz));
        field.values[n] = 0.5F * *v + around / 12;
      }
  });
}

/// Repeats the values beside the border on it.
void repeat_on_border(ScalarGrid& field) {
  const Eigen::Vector3i n = field.size;
  const auto inner = [&](int i, int a) { return std::clamp(i, 1, n[a] - 2); };
  for_layers(n.z(), [&](int k) {
    const bool whole = k == 0 || k + 1 == n.z();
    // Layers on the border copy from their neighbour, whose own border is written elsewhere: read
    // only inner nodes.
    for (int j = 0; j < n.y(); ++j) {
      const bool row = whole || j == 0 || j + 1 == n.y();
      for (int i = 0; i < n.x(); i += row || i + 1 == n.x() ? 1 : n.x() - 1)
        field(i, j, k) = field(inner(i, 0), inner(j, 1), inner(k, 2));
    }
  });
}

/// Trilinear value at a place in units of the grid, clamped to it.
float trilinear(const ScalarGrid& grid, const Eigen::Vector3f& x) {
  const Eigen::Array3f last = (grid.size.array() - 1).cast<float>();
  const Eigen::Array3f inside = x.array().max(0.0F).min(last);
  const Eigen::Array3i base = inside.floor().cast<int>().min(grid.size.array() - 2);
  const Eigen::Array3f t = inside - base.cast<float>();
  const std::size_t dy = static_cast<std::size_t>(grid.size.x()), dz = dy * grid.size.y();
  const float* v = grid.values.data() + grid.index(base.x(), base.y(), base.z());
  const auto along = [&](std::size_t o) { return v[o] + t.x() * (v[o + 1] - v[o]); };
  const float low = along(0) + t.y() * (along(dy) - along(0));
  const float high = along(dz) + t.y() * (along(dz + dy) - along(dz));
  return low + t.z() * (high - low);
}

bool on_border(const ScalarGrid& grid, const Eigen::Vector3i& node) {
  return node.minCoeff() == 0 || (node.array() + 1 == grid.size.array()).any();
}

/// Gradient of the distance at a node of the simulation's grid, in metres per node.
Eigen::Vector3f gradient(const ScalarGrid& d, const Eigen::Vector3f& x) {
  Eigen::Vector3f g;
  for (int a = 0; a < 3; ++a) {
    Eigen::Vector3f low = x, high = x;
    low[a] -= 0.5F;
    high[a] += 0.5F;
    g[a] = trilinear(d, high) - trilinear(d, low);
  }
  return g;
}

}  // namespace

ScalarGrid liquid_field(const GridShape& shape, const LiquidParticles& particles,
                        const LiquidSurfaceOptions& options, GridShape& field_shape) {
  if (particles.cell_begin.size() != shape.cell_count() + 1)
    throw Error("particles are not sorted by cell", "liquid_field");
  if (!(options.cells_per_cell > 0) || !(options.particle_radius > 0))
    throw Error("resolution and radius must be positive", "liquid_field");
  field_shape = refined(shape, options.cells_per_cell);
  ScalarGrid field = options.kernel == SurfaceKernel::anisotropic
                         ? anisotropic_field(shape, particles, options, field_shape)
                         : zhu_bridson_field(shape, particles, options, field_shape);
  repeat_on_border(field);
  for (int pass = 0; pass < options.smoothing; ++pass) {
    smooth(field);
    repeat_on_border(field);
  }
  return field;
}

void meet_solids(const GridShape& shape, const SolidFractions& solids, const GridShape& field_shape,
                 ScalarGrid& field) {
  const ScalarGrid old = field;
  const auto h = static_cast<float>(shape.cell);
  const auto nodes_per_cell = static_cast<float>(shape.cell / field_shape.cell);
  for_layers(field.size.z(), [&](int k) {
    for (int j = 0; j < field.size.y(); ++j)
      for (int i = 0; i < field.size.x(); ++i) {
        const Eigen::Vector3f x =
            Eigen::Vector3f(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)) /
            nodes_per_cell;
        const float d = trilinear(solids.distance, x);
        if (d >= h) continue;
        float& value = field(i, j, k);
        if (d > -2 * h) {
          const Eigen::Vector3f g = gradient(solids.distance, x);
          const float length = g.norm();
          // On the medial axis of two solids the normal is undefined: the field stays.
          if (length > 0.1F * h) {
            const Eigen::Vector3f moved = x + (kReadOff - d / h) / length * g;
            value = std::min(value, trilinear(old, moved * nodes_per_cell));
          }
        }
        // On a wall of the domain the contour closes by itself, with sharper ribs.
        const bool on_wall = on_border(field, {i, j, k}) && d > -kOnWall * h;
        if (!on_wall) value = std::max(value, -d);
      }
  });
}

Eigen::MatrixX3d surface_velocity(const MacGrid& velocity, const Eigen::MatrixX3d& points) {
  Eigen::MatrixX3d result(points.rows(), 3);
  parallel_blocks(points.rows(), 2048, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index p = begin; p < static_cast<Eigen::Index>(end); ++p)
      result.row(p) = velocity_at(velocity, points.row(p)).transpose();
  });
  return result;
}

}  // namespace geoprior::fluid
