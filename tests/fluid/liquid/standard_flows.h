#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "baselines/fluid/liquid/grid/advection.h"
#include "baselines/fluid/liquid/grid/mac_grid.h"
#include "baselines/fluid/liquid/particles/particles.h"
#include "core/geometry/planar.h"
#include "core/mesh.h"
#include "tests/fluid/liquid/fixture.h"

/// Flows that bring every shape back, in which transport is tested.
namespace geoprior::fluid::flows {

/// Sets the faces of a grid from a velocity field.
template <class Field>
void sample_field(const Field& field, MacGrid& grid) {
  for (int a = 0; a < 3; ++a) {
    ScalarGrid& face = grid.face[a];
    for (int k = 0; k < face.size.z(); ++k) {
      for (int j = 0; j < face.size.y(); ++j) {
        for (int i = 0; i < face.size.x(); ++i) {
          Eigen::Vector3d x = Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5);
          x[a] -= 0.5;
          const Eigen::Vector3d u = field(Eigen::Vector3d(grid.shape.origin + grid.shape.cell * x));
          face(i, j, k) = static_cast<float>(u[a]);
        }
      }
    }
  }
}

inline void advect(const MacGrid& velocity, double dt, LiquidParticles& particles) {
  std::vector<std::uint8_t> left;
  advect_particles(velocity, dt, nullptr, std::nullopt, particles, left);
}

/// Zalesak 1979: a domain of 100 x 100 that turns once about its middle in 628 units of time, and
/// a disc of radius 15 at (50, 75) with a slot 5 wide, open below, that ends 10 above its centre.
struct SlottedDisc {
  static constexpr double kTurn = 628, kRadius = 15, kHalfSlot = 2.5, kSlotEnd = 85;

  static MacGrid flow() {
    MacGrid grid(tanks::grid_of({100, 100, 2}, 1));
    sample_field(
        [](const Eigen::Vector3d& x) {
          return Eigen::Vector3d(2 * std::numbers::pi / kTurn * (50 - x.y()),
                                 2 * std::numbers::pi / kTurn * (x.x() - 50), 0);
        },
        grid);
    return grid;
  }
  static bool contains(double x, double y) {
    const bool slot = std::abs(x - 50) < kHalfSlot && y < kSlotEnd;
    return std::hypot(x - 50, y - 75) < kRadius && !slot;
  }
  /// Counter-clockwise, the arc in chords of a hundredth of a cell off it at most.
  static Eigen::MatrixX2d outline() {
    constexpr int kChords = 200;
    const double mouth = std::asin(kHalfSlot / kRadius);
    Eigen::MatrixX2d points(kChords + 3, 2);
    for (int i = 0; i <= kChords; ++i) {
      const double angle =
          -std::numbers::pi / 2 + mouth + (2 * std::numbers::pi - 2 * mouth) * i / kChords;
      points.row(i) << 50 + kRadius * std::cos(angle), 75 + kRadius * std::sin(angle);
    }
    points.row(kChords + 1) << 50 - kHalfSlot, kSlotEnd;
    points.row(kChords + 2) << 50 + kHalfSlot, kSlotEnd;
    return points;
  }
  /// Area of the disc without the slot: half planes of the circle's chord at the slot's sides.
  static double area() {
    const double mouth = std::asin(kHalfSlot / kRadius);
    const double below = kRadius * kRadius * mouth + kHalfSlot * kRadius * std::cos(mouth);
    return std::numbers::pi * kRadius * kRadius - below - 2 * kHalfSlot * (kSlotEnd - 75);
  }
};

/// Enright et al. 2002: a sphere of radius 0.15 in the unit box, torn into a sheet and back in 3 s.
struct EnrightSphere {
  static constexpr double kRadius = 0.15, kDuration = 3;
  static constexpr int kSteps = 200;
  static Eigen::Vector3d centre() { return Eigen::Vector3d::Constant(0.35); }

  /// Of the flow without its factor in time: no divergence.
  static Eigen::Vector3d velocity(const Eigen::Vector3d& x) {
    const Eigen::Vector3d s = (std::numbers::pi * x).array().sin();
    const Eigen::Vector3d t = (2 * std::numbers::pi * x).array().sin();
    return {2 * s.x() * s.x() * t.y() * t.z(), -t.x() * s.y() * s.y() * t.z(),
            -t.x() * t.y() * s.z() * s.z()};
  }
  /// @param leak  divergence added to the flow (1/s)
  static MacGrid flow(int n, double leak = 0) {
    MacGrid grid(tanks::grid_of({n, n, n}, 1.0 / n));
    sample_field(
        [leak](const Eigen::Vector3d& x) -> Eigen::Vector3d {
          return velocity(x) + leak / 3 * (x - Eigen::Vector3d::Constant(0.5));
        },
        grid);
    return grid;
  }
  /// Step `s` of kSteps: the flow slows down, turns round in the middle and comes back.
  static void step(const MacGrid& flow, int s, LiquidParticles& particles) {
    MacGrid now = flow;
    const auto factor = static_cast<float>(std::cos(std::numbers::pi * (s + 0.5) / kSteps));
    for (ScalarGrid& face : now.face)
      for (float& u : face.values) u *= factor;
    advect(now, kDuration / kSteps, particles);
  }
};

}  // namespace geoprior::fluid::flows
