#include "baselines/fluid/liquid/grid/extrapolation.h"

#include <algorithm>

#include "baselines/fluid/liquid/grid/mac_grid_sampler.h"
#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

/// Grid of one component, with its six neighbours.
struct FaceGrid {
  Eigen::Vector3i size;
  std::array<std::size_t, 3> stride;

  explicit FaceGrid(const Eigen::Vector3i& n)
      : size(n),
        stride{1, static_cast<std::size_t>(n.x()), static_cast<std::size_t>(n.x()) * n.y()} {}
  [[nodiscard]] Eigen::Vector3i place(std::size_t i) const {
    return {static_cast<int>(i % stride[1]), static_cast<int>(i % stride[2] / stride[1]),
            static_cast<int>(i / stride[2])};
  }
  template <class Visit>
  void neighbours(std::size_t i, const Visit& visit) const {
    const Eigen::Vector3i at = place(i);
    for (int a = 0; a < 3; ++a) {
      const std::size_t step = stride[a];
      if (at[a] > 0) visit(i - step);
      if (at[a] + 1 < size[a]) visit(i + step);
    }
  }
};

/// Whether a row has a known face.
std::vector<char> rows_with_known(const FaceGrid& grid, const std::vector<char>& known) {
  std::vector<char> any(known.size() / grid.stride[1]);
  for (std::size_t r = 0; r < any.size(); ++r) {
    char all = 0;
    for (std::size_t i = 0; i < grid.stride[1]; ++i)
      all = static_cast<char>(all | known[r * grid.stride[1] + i]);
    any[r] = all;
  }
  return any;
}

/// Marks the faces of a row that are unknown and have a known one beside them with 1, others with
/// 0.
void mark_front(std::size_t n, const char* at, const std::array<const char*, 4>& rows,
                std::vector<char>& beside) {
  for (std::size_t i = 0; i < n; ++i)
    beside[i] = static_cast<char>(rows[0][i] | rows[1][i] | rows[2][i] | rows[3][i]);
  for (std::size_t i = 1; i < n; ++i) beside[i] = static_cast<char>(beside[i] | at[i - 1]);
  for (std::size_t i = 0; i + 1 < n; ++i) beside[i] = static_cast<char>(beside[i] | at[i + 1]);
  for (std::size_t i = 0; i < n; ++i) beside[i] = static_cast<char>(beside[i] & ~at[i] & 1);
}

/// Unknown faces beside a known one, in order.
void first_front(const FaceGrid& grid, const std::vector<char>& known,
                 std::vector<std::uint32_t>& front) {
  front.clear();
  const std::size_t nx = grid.stride[1];
  const std::size_t ny = grid.size.y(), nz = grid.size.z();
  const std::vector<char> any = rows_with_known(grid, known);
  std::vector<char> beside(nx);
  for (std::size_t k = 0; k < nz; ++k) {
    for (std::size_t j = 0; j < ny; ++j) {
      const std::size_t row = j + ny * k;
      // At the border the row stands in for its neighbour that does not exist.
      const std::array<std::size_t, 4> around{j > 0 ? row - 1 : row, j + 1 < ny ? row + 1 : row,
                                              k > 0 ? row - ny : row, k + 1 < nz ? row + ny : row};
      char reached = any[row];
      std::array<const char*, 4> rows{};
      for (std::size_t r = 0; r < 4; ++r) {
        reached = static_cast<char>(reached | any[around[r]]);
        rows[r] = known.data() + around[r] * nx;
      }
      if (reached == 0) continue;
      mark_front(nx, known.data() + row * nx, rows, beside);
      for (std::size_t i = 0; i < nx; ++i)
        if (beside[i] != 0) front.push_back(static_cast<std::uint32_t>(row * nx + i));
    }
  }
}

float mean_of_known(const FaceGrid& grid, const std::vector<char>& known,
                    const std::vector<float>& velocity, std::size_t i) {
  float sum = 0;
  int count = 0;
  grid.neighbours(i, [&](std::size_t n) {
    if (known[n] != 1) return;
    sum += velocity[n];
    ++count;
  });
  return sum / static_cast<float>(count);
}

}  // namespace

void Extrapolator::extrapolate(int layers, MacGrid& velocity,
                               std::array<std::vector<char>, 3>& known) {
  constexpr char kQueued = 2;
  parallel_blocks(3, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      Component& c = component_[a];
      const FaceGrid grid(velocity.face[a].size);
      std::vector<float>& u = velocity.face[a].values;
      first_front(grid, known[a], c.front);
      for (int layer = 0; layer < layers && !c.front.empty(); ++layer) {
        c.values.resize(c.front.size());
        for (std::size_t f = 0; f < c.front.size(); ++f) {
          c.values[f] = mean_of_known(grid, known[a], u, c.front[f]);
        }
        for (std::size_t f = 0; f < c.front.size(); ++f) {
          u[c.front[f]] = c.values[f];
          known[a][c.front[f]] = 1;
        }
        c.next.clear();
        if (layer + 1 == layers) break;
        for (const std::uint32_t face : c.front) {
          grid.neighbours(face, [&](std::size_t n) {
            if (known[a][n] != 0) return;
            known[a][n] = kQueued;
            c.next.push_back(static_cast<std::uint32_t>(n));
          });
        }
        c.front.swap(c.next);
      }
    }
  });
}

namespace {

/// Position of a face in node distances.
Eigen::Vector3f face_place(const Eigen::Vector3i& at, int axis) {
  Eigen::Vector3f x = at.cast<float>() + Eigen::Vector3f::Constant(0.5F);
  x[axis] -= 0.5F;
  return x;
}

/// A face whose velocity is given by the solid behind it.
struct Constrained {
  std::size_t face;
  float velocity;
};

/// Solid's velocity at a point (in cells).
Eigen::Vector3f solid_velocity(const SolidFractions& solids, const Eigen::Vector3f& x) {
  Eigen::Vector3f u;
  for (int a = 0; a < 3; ++a) {
    Eigen::Vector3f shifted = x - Eigen::Vector3f::Constant(0.5F);
    shifted[a] += 0.5F;
    u[a] = GridSampler(solids.velocity[a])(shifted);
  }
  return u;
}

void constrain_component(const SolidFractions& solids, const std::vector<char>& known,
                         const MacGrid& velocity, int axis, std::vector<Constrained>& out) {
  const FaceGrid grid(velocity.face[axis].size);
  const FaceSampler sampler(velocity);
  const GridSampler distance(solids.distance);
  const std::vector<float>& open = solids.open[axis].values;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (open[i] > 0 || known[i] == 0) continue;
    const Eigen::Vector3i at = grid.place(i);
    if (at[axis] == 0 || at[axis] + 1 == grid.size[axis]) {  // a wall of the domain
      out.push_back({i, solids.velocity[axis].values[i]});
      continue;
    }
    const Eigen::Vector3f x = face_place(at, axis);
    Eigen::Vector3f normal;
    distance.with_gradient(x, normal);
    const float length = normal.norm();
    if (!(length > 1e-6F * static_cast<float>(velocity.shape.cell))) continue;
    normal /= length;
    const Eigen::Vector3f u = sampler(x);
    const float into = (u - solid_velocity(solids, x)).dot(normal);
    out.push_back({i, u[axis] - into * normal[axis]});
  }
}

}  // namespace

void constrain_to_solids(const SolidFractions& solids,
                         const std::array<std::vector<char>, 3>& known, MacGrid& velocity) {
  std::array<std::vector<Constrained>, 3> changed;
  parallel_blocks(3, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      constrain_component(solids, known[a], velocity, static_cast<int>(a), changed[a]);
    }
  });
  // After all were read: what a face becomes must not depend on the order.
  for (std::size_t a = 0; a < 3; ++a) {
    for (const Constrained& c : changed[a]) velocity.face[a].values[c.face] = c.velocity;
  }
}

}  // namespace geoprior::fluid
