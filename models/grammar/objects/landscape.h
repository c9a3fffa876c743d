#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/options.h"
#include "models/grammar/hierarchy/hierarchy.h"
#include "models/grammar/objects/surface_set.h"

namespace geoprior::grammar {

/// Hills with a wood, houses and a path of stepping stones.
struct LandscapeOptions {
  double width = 60, depth = 60;  ///< of the ground, along x and y (m)
  double relief = 5;              ///< height of the highest place over the lowest (m)
  int houses = 8;
  double woods = 0.45;
  double spacing = 2.6;  ///< least distance of pines of full size (m)
  double pitch = 0.9;    ///< distance of consecutive stones (m)
};
void describe(OptionVisitor& v, LandscapeOptions& options);

/// Numbers of the parameters of a "pine".
struct PineParameter {
  static constexpr int kSize = 0;    ///< 0 … 1
  static constexpr int kRadius = 1;  ///< half the distance that it keeps (m)
  static constexpr int kHeight = 2;  ///< at full size (m)
  static constexpr int kTriangle = 3;
  static constexpr int kB0 = 4, kB1 = 5;
  static constexpr int kCandidate = 6;
};

/// Numbers of the parameters of a "house".
struct HouseParameter {
  static constexpr int kWidth = 0, kDepth = 1;  ///< of its floor (m)
  static constexpr int kHeight = 2;             ///< of its walls (m)
  static constexpr int kPlinth = 3;             ///< depth below the floor (m)
  static constexpr int kTriangle = 4;
  static constexpr int kB0 = 5, kB1 = 6;
};

/// Numbers of the parameters of a "stone".
struct StoneParameter {
  static constexpr int kSize = 0;    ///< 0 … 1
  static constexpr int kRadius = 1;  ///< half the pitch (m)
  static constexpr int kAlong = 2;   ///< place in the path, 0 … 1
  static constexpr int kTriangle = 3;
  static constexpr int kB0 = 4, kB1 = 5;
  static constexpr int kCandidate = 6;
};
/// The parameter of a "path": the distance of consecutive stones at rest (m).
inline constexpr int kPathPitch = 0;

/// Distance that a house keeps (m): half the diagonal of its floor.
double house_radius(double width, double depth);
/// Corners of a floor in the frame of the house, counter-clockwise.
std::array<Eigen::Vector3d, 4> floor_corners(double width, double depth);

/// A terrain seen from above: what is below or above a point. Where there are several, as under an
/// overhang, the nearest counts. Triangles that are upright to round-off are left out.
class Ground {
 public:
  Ground(std::span<const Eigen::Vector3d> points, const Eigen::MatrixX3i& triangles);

  /// Absent beyond the rim.
  [[nodiscard]] std::optional<TrianglePlace> below(const Eigen::Vector3d& x) const;
  [[nodiscard]] Eigen::Vector3d at(const TrianglePlace& place) const {
    return on_triangle(points_, triangles_, place);
  }
  /// How far a point is above the ground, negative below it (m); beyond the rim its distance from
  /// the nearest vertex.
  [[nodiscard]] double gap(const Eigen::Vector3d& x) const;

 private:
  [[nodiscard]] std::array<int, 2> cell_of(const Eigen::Vector3d& x) const;

  std::vector<Eigen::Vector3d> points_;
  Eigen::MatrixX3i triangles_;
  Eigen::AlignedBox3d box_;
  std::array<int, 2> cells_{1, 1};
  std::vector<int> begin_, entry_;  ///< triangles of the cells of a grid in plan
};

/// The least depth of a plinth that reaches into the ground at all corners of a floor (m).
double plinth_depth(const Ground& ground, const Pose& pose, double width, double depth);

/// The same of a house of a hierarchy, as it would be in a pose.
double house_radius(const Hierarchy& h, int house);
double plinth_depth(const Ground& ground, const Hierarchy& h, int house, const Pose& pose);

/// @throws Error  when the landscape has no terrain, or it is not present
int terrain_of(const Hierarchy& h, int landscape);
Ground ground_of(const Hierarchy& h, int landscape);

/// A landscape about the origin at rest, which keeps all its constraints.
///
/// Types: "landscape", the root, whose key point is its position; "terrain", whose points are the
/// vertices of a height field; "grove", "village" and "path", which hold "pine", "house" and
/// "stone" with the parameters above and have no key points. These three stand upright on the
/// terrain, at a place of one of its triangles. Key points: of a pine foot and top, of a house the
/// middle of its floor, the floor's corners and the ridge, of a stone its centre. Children of the
/// root are terrain, grove, village and path in this order; of the grove in order of priority; of
/// the path in order along it, with three candidates after each stone but the last.
/// @throws Error  naming the option: out of its range
Hierarchy make_landscape(const LandscapeOptions& options, std::uint64_t seed);

}  // namespace geoprior::grammar
