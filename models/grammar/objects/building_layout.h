#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "models/grammar/hierarchy/hierarchy.h"

namespace geoprior::grammar {

// How the parts of a building follow from few numbers: storeys of a stack, walls of a storey,
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

/// The largest of the four distances of side middles (see `kMostOverhang`).
double overhang(const StoreyBox& below, const StoreyBox& above);

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

/// Sum over samples of weight |c + R(yaw) (a w, b d) - target|^2 in plan, as moments: a and b are
/// -1/2 .. 1/2 over a storey's width and depth.
struct PlanFit {
  double s = 0, sa = 0, sb = 0, saa = 0, sab = 0, sbb = 0, tt = 0;
  Eigen::Vector2d t{0, 0}, ta{0, 0}, tb{0, 0};

  void add(double a, double b, double weight, const Eigen::Vector2d& target);
};

/// The same upwards: sum of weight (level + c height - target)^2, c from 0 to 1 over the height.
struct HeightFit {
  double s = 0, sc = 0, scc = 0, t = 0, tc = 0;

  void add(double c, double weight, double target);
};

/// What is asked of a storey of a stack, and what it has to keep.
struct StoreyWish {
  StoreyBox rest;  ///< what it was; of a new one, what it begins as
  PlanFit plan = {};
  HeightFit rise = {};
  bool moved = false;       ///< false: `rest` is the best fit, bit for bit
  bool keep = false;        ///< it may not be taken away
  bool hold_size = false;   ///< width, depth and height
  bool hold_place = false;  ///< all of `rest`
  bool given = false;       ///< all of it is to be `goal`, and the others make room
  StoreyBox goal = {};
  double least_width = kLeastStoreySide, least_depth = kLeastStoreySide;
  double least_height = kLeastStoreyHeight, most_height = kMostStoreyHeight;
};
/// A wish to be like a box, as by so many samples of weight 1.
void wish_for(StoreyWish& wish, const StoreyBox& box, double weight);

/// Levels of the floors, and of the ceiling of the top storey, that fit best while heights are
/// within the wishes' ranges: a quadratic programme, exact by an active set.
std::vector<double> fit_levels(std::span<const StoreyWish> wishes);

/// Places in plan, yaw, widths and depths that fit best while no overhang is too large.
///
/// Where the best fits of the storeys for themselves keep the limits they are the answer. Else a
/// logarithmic barrier at the limits, followed by Newton's method (Gauss-Newton for the rotation,
/// so the answer is a local optimum), from a stack of all storeys above one another; storeys that
/// end within 1e-5 of their own best fit get it. `bottom.z` and `height` are not looked at.
/// @return  false, where what is held leaves no room: `boxes` is then not to be used
bool fit_plans(std::span<const StoreyWish> wishes, std::vector<StoreyBox>& boxes);

}  // namespace geoprior::grammar
