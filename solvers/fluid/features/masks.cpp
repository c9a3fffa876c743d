#include "solvers/fluid/features/masks.h"

#include <algorithm>

namespace geoprior::fluid {
namespace {

constexpr float kFacing = 0.95F;       // cosine of about 18 degrees
constexpr double kSmallestPatch = 20;  // h^2
constexpr double kSmallestShare = 0.02;
constexpr double kPlanar = 0.5;  // h

/// Side `s` of `box`: its axis, and its position along it measured inwards.
int axis_of(std::size_t side) { return static_cast<int>(side / 2); }
bool is_high(std::size_t side) { return side % 2 == 1; }

double inwards(const Eigen::AlignedBox3d& box, std::size_t side, const Eigen::Vector3d& x) {
  const int a = axis_of(side);
  return is_high(side) ? box.max()[a] - x[a] : x[a] - box.min()[a];
}

double patch_area(const std::vector<WallSample>& samples, const Eigen::AlignedBox3d& box,
                  std::size_t side, double cell) {
  const float outward = is_high(side) ? 1.0F : -1.0F;
  double area = 0;
  for (const WallSample& s : samples) {
    if (outward * s.normal[axis_of(side)] < kFacing) continue;
    if (inwards(box, side, s.x.cast<double>()) < kPlanar * cell) area += s.area;
  }
  return area;
}

double side_area(const Eigen::AlignedBox3d& box, std::size_t side) {
  const Eigen::Vector3d size = box.sizes();
  const int a = axis_of(side);
  return size[(a + 1) % 3] * size[(a + 2) % 3];
}

bool in_tank_band(const Wall& tank, const Eigen::Vector3d& x, const Eigen::Vector3d& normal,
                  double band, double cell) {
  for (std::size_t side = 0; side < 4; ++side) {
    if (tank.side[side] && inwards(tank.box, side, x) < band) return true;
  }
  if (!tank.side[4]) return false;
  const double height = inwards(tank.box, 4, x);
  return height < kPlanar * cell || (height < band && normal.z() < 0);
}

}  // namespace

void describe(OptionVisitor& v, MaskBox& o) {
  v.value("low", o.low, {.doc = "lower corner of the box", .unit = "m", .required = true});
  v.value("high", o.high, {.doc = "upper corner of the box", .unit = "m", .required = true});
}

void describe(OptionVisitor& v, MaskOptions& o) {
  v.value("infer_walls", o.infer_walls,
          {.doc = "finds the walls of a closed tank: planar sides and floor of the bounding box"});
  v.value("band", o.band,
          {.doc = "distance from a wall or solid within which vertices are masked",
           .unit = "h",
           .min = 0,
           .max = 100});
  describe_list(v, "containers", o.containers,
                {.doc = "tanks as boxes, whose sides and floors are walls"});
  describe_list(v, "solids", o.solids, {.doc = "bodies in the liquid as boxes"});
}

Wall infer_walls(std::span<const std::vector<WallSample>> frames, double cell) {
  Wall wall;
  for (const std::vector<WallSample>& samples : frames) {
    for (const WallSample& s : samples) wall.box.extend(s.x.cast<double>());
  }
  if (wall.box.isEmpty()) return wall;
  for (std::size_t side = 0; side < wall.side.size(); ++side) {
    const double needed =
        std::max(kSmallestPatch * cell * cell, kSmallestShare * side_area(wall.box, side));
    wall.side[side] = std::any_of(frames.begin(), frames.end(), [&](const auto& samples) {
      return patch_area(samples, wall.box, side, cell) >= needed;
    });
  }
  return wall;
}

bool is_masked(const Walls& walls, const Eigen::Vector3d& x, const Eigen::Vector3d& normal,
               double band, double cell) {
  return std::any_of(walls.tanks.begin(), walls.tanks.end(),
                     [&](const Wall& tank) { return in_tank_band(tank, x, normal, band, cell); }) ||
         std::any_of(walls.solids.begin(), walls.solids.end(), [&](const auto& solid) {
           return solid.squaredExteriorDistance(x) < band * band;
         });
}

}  // namespace geoprior::fluid
