#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "models/grammar/objects/building_layout.h"

namespace geoprior::grammar {

// The storeys of a building, one on the other, that fit best what is asked of each: places in plan
// and sizes under the limit of the overhang, levels under the limits of the heights. Both are least
// squares, of moments that grow sample by sample. Lengths in m, angles in rad.

/// The largest of the four distances of side middles (see `kMostOverhang`).
double overhang(const StoreyBox& below, const StoreyBox& above);

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
