#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "models/grammar/hierarchy/hierarchy.h"

namespace geoprior::grammar {

// How the parts of a building follow from few numbers: boxes of storeys, walls of a storey,
// openings (windows and doors) of a wall. The generator, the rules and the optimum use the same
// formulas. Lengths in m, angles in rad.

inline constexpr double kLeastStoreyHeight = 2.6, kMostStoreyHeight = 4.5;
inline constexpr double kLeastStoreySide = 3;  ///< of width and depth
/// Each of the four side middles of a storey lies within this distance, in plan, of the matching
/// side middle of the storey below. The middle of side s is the mean of the corners s and s + 1
/// (modulo 4) of the bottom, and of the top: what a storey's yaw turns, it turns too.
inline constexpr double kMostOverhang = 0.6;
/// Of the distance between the centres of neighbouring openings of a wall, a door being one.
inline constexpr double kLeastPitch = 1.2, kMostPitch = 2.4;
inline constexpr double kLeastRoofRise = 0.8, kMostRoofRise = 8;
inline constexpr double kOpeningGap = 0.15;  ///< least wall between two openings
inline constexpr double kWallEnd = 0.15;     ///< least wall beside the outermost openings
inline constexpr double kWallTop = 0.1;      ///< least wall above an opening

/// Numbers of the parameters of the types.
struct StoreyParameter {
  enum : int { width, depth, height, base };
};
struct WallParameter {
  enum : int { length, height, side, offset };
};
struct OpeningParameter {
  enum : int { width, height, along, sill };
};
struct RoofParameter {
  enum : int { width, depth, rise, eaves, ridge };
};

/// A storey: where the middle of its floor is, how it is turned about z, how large it is.
struct StoreyBox {
  Eigen::Vector3d bottom = Eigen::Vector3d::Zero();
  double yaw = 0;
  double width = 0, depth = 0, height = 0;

  bool operator==(const StoreyBox&) const = default;
};

/// Turn about z of a turn, without its tilt.
double yaw_of(const Eigen::Quaterniond& turn);
Eigen::Quaterniond turn_of_yaw(double yaw);
StoreyBox storey_box(const Pose& pose, double width, double depth, double height);
/// The present children of a type, those of a building's storeys from the ground up.
std::vector<int> present_children(const Hierarchy& hierarchy, int parent, const char* type);
std::vector<int> storeys_of(const Hierarchy& hierarchy, int building);

/// Wall `side` of a storey: its frame, at the storey's corner of that number, x towards the next
/// corner, y inwards; and its parameters.
Pose wall_pose(const Pose& storey, int side, double width, double depth);
std::vector<double> wall_parameters(int side, double width, double depth, double height);

/// A window or a door of a wall.
struct Opening {
  double along = 0;  ///< of its centre, from the wall's start
  double width = 1, sill = 0, height = 1;
  bool door = false;
  bool held = false;  ///< it keeps all these numbers
};
Pose opening_pose(const Pose& wall, const Opening& opening);

/// An opening with its place in the row before; negative: it is new.
struct LaidOpening {
  Opening opening;
  int origin = -1;
};

/// The least distance of the centres of two neighbours.
double least_pitch(const Opening& a, const Opening& b);

/// The openings of a wall whose length and height changed.
///
/// Sill and height follow the wall's height in proportion, distances from the wall's middle follow
/// its length, width stays. From the middle outwards (or from what is held, which does not move)
/// distances are then brought into the range of the pitch. What finds no place at the ends is
/// dropped, at both ends at once; where the pitch is at its limit and a whole opening fits beside
/// the outermost ones, one is added there. So nothing else jumps when the number changes.
/// A door is never dropped, nor is the last opening.
/// @param row  from the wall's start; not empty unless there is nothing to lay out
std::vector<LaidOpening> lay_out_row(std::span<const Opening> row, double length_before,
                                     double height_before, double length, double height);

}  // namespace geoprior::grammar
