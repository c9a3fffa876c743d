#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace geoprior::grammar {

/// All points within `radius` of the segment from `a` to `b` (m).
struct Capsule {
  Eigen::Vector3d a, b;
  double radius = 0;
};

/// The closest points of the segments of two capsules.
struct AxisPoints {
  Eigen::Vector3d first, second;
};
/// Source: Ericson, Real-Time Collision Detection (2005), section 5.1.9.
AxisPoints closest_axis_points(const Capsule& first, const Capsule& second);

/// Distance of the surfaces of two capsules (m); negative where they cross.
double gap(const Capsule& first, const Capsule& second);

/// How a capsule crosses another one.
struct Crossing {
  int owner = -1;        ///< of the other
  double depth = 0;      ///< by how much they are too near (m)
  Eigen::Vector3d at;    ///< the point of the capsule's axis that is nearest to the other's
  Eigen::Vector3d away;  ///< unit vector from the other's axis to that point
};

/// Capsules in a hashed grid of cubes: where they are few in a cube, placing one and asking what
/// it crosses take a time that does not depend on how many there are.
///
/// Answers do not depend on the order in which capsules were placed, but for equal depths.
class CapsuleGrid {
 public:
  /// @param cell      edge of a cube (m), about the length of a capsule
  /// @param expected  number of capsules
  CapsuleGrid(double cell, int expected) { restart(cell, expected); }
  /// Begins anew, without any capsule, and keeps the memory.
  void restart(double cell, int expected);

  /// Places the capsule of an owner (a number from 0 on), instead of the one it had.
  void place(int owner, const Capsule& capsule);
  void remove(int owner);
  /// Null when it has none.
  [[nodiscard]] const Capsule* of(int owner) const {
    return owner < static_cast<int>(current_.size()) && current_[owner] >= 0
               ? &capsules_[current_[owner]].shape
               : nullptr;
  }

  /// The capsule that is crossed the deepest, those nearer than `clearance` (m) included.
  /// @param ignore  whether the capsule of an owner does not count
  template <class Ignore>
  [[nodiscard]] std::optional<Crossing> deepest(const Capsule& capsule, double clearance,
                                                const Ignore& ignore) const {
    std::optional<Crossing> out;
    Capsule reach = capsule;
    reach.radius += clearance;
    for_each_cell(reach, [&](const Cell& cell) {
      for (int i = heads_[bucket(cell)]; i >= 0; i = entries_[i].next) {
        if (entries_[i].cell != cell) continue;
        const Placed& other = capsules_[entries_[i].capsule];
        if (current_[other.owner] != entries_[i].capsule || ignore(other.owner)) continue;
        take_deeper(reach, other.shape, other.owner, out);
      }
    });
    return out;
  }

  /// Keeps in `out` the crossing of a capsule with another if it is deeper.
  static void take_deeper(const Capsule& capsule, const Capsule& other, int owner,
                          std::optional<Crossing>& out);

 private:
  using Cell = std::array<int, 3>;
  struct Placed {
    Capsule shape;
    int owner;
  };
  struct Entry {
    Cell cell;
    int capsule;
    int next;  ///< in the same bucket; -1: none
  };

  [[nodiscard]] std::size_t bucket(const Cell& cell) const {
    const auto mix = static_cast<std::uint32_t>(cell[0]) * 73856093u ^
                     static_cast<std::uint32_t>(cell[1]) * 19349663u ^
                     static_cast<std::uint32_t>(cell[2]) * 83492791u;
    return mix & (heads_.size() - 1);
  }

  /// The cubes of the capsule's box that the capsule may reach.
  template <class Visit>
  void for_each_cell(const Capsule& capsule, const Visit& visit) const {
    const auto number = [&](double x) { return static_cast<int>(std::floor(x / cell_)); };
    Cell low, high;
    for (int k = 0; k < 3; ++k) {
      low[k] = number(std::min(capsule.a[k], capsule.b[k]) - capsule.radius);
      high[k] = number(std::max(capsule.a[k], capsule.b[k]) + capsule.radius);
    }
    const double reach = capsule.radius + 0.5 * std::sqrt(3.0) * cell_, near = reach * reach;
    const Eigen::Vector3d axis = capsule.b - capsule.a;
    const double squared = axis.squaredNorm();
    const Eigen::Vector3d per_length = squared > 0 ? Eigen::Vector3d(axis / squared) : axis;
    Cell c;
    for (c[0] = low[0]; c[0] <= high[0]; ++c[0])
      for (c[1] = low[1]; c[1] <= high[1]; ++c[1])
        for (c[2] = low[2]; c[2] <= high[2]; ++c[2]) {
          const Eigen::Vector3d from_start =
              cell_ * Eigen::Vector3d(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5) - capsule.a;
          const double t = std::clamp(from_start.dot(per_length), 0.0, 1.0);
          if ((from_start - t * axis).squaredNorm() <= near) visit(c);
        }
  }

  double cell_ = 1;
  std::vector<int> heads_;  ///< first entry of a bucket; their number is a power of two
  std::vector<Entry> entries_;
  std::vector<Placed> capsules_;
  std::vector<int> current_;  ///< of an owner in `capsules_`; -1: none
};

}  // namespace geoprior::grammar
