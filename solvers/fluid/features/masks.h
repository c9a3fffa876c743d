#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "core/options.h"

namespace geoprior::fluid {

struct MaskBox {
  std::array<double, 3> low{0, 0, 0}, high{1, 1, 1};
};
void describe(OptionVisitor& v, MaskBox& options);

/// Parts of a frame that are not considered, because a wall or a solid bends the surface there:
/// given as boxes, or inferred.
struct MaskOptions {
  bool infer_walls = true;
  double band = 2.5;
  std::vector<MaskBox> containers;
  std::vector<MaskBox> solids;
};
void describe(OptionVisitor& v, MaskOptions& options);

/// Walls of one upright tank; z is up and never a wall from above.
struct Wall {
  Eigen::AlignedBox3d box;
  std::array<bool, 5> side{};  ///< low x, high x, low y, high y, floor
};
struct Walls {
  std::vector<Wall> tanks;
  std::vector<Eigen::AlignedBox3d> solids;
};

/// What a wall is inferred from: surface samples of one frame.
struct WallSample {
  Eigen::Vector3f x, normal;  ///< m, unit outward
  float area = 0;             ///< m^2
};

/// Sides of the bounding box of all frames at which some frame has a planar patch facing it
/// (normals within 18 degrees, half a cell from the plane) of at least 20 h^2 and 2 % of the side.
/// The free surface faces up, so it is none; an open height field has none.
/// @param frames  samples of each frame @param cell  h (m)
Wall infer_walls(std::span<const std::vector<WallSample>> frames, double cell);

/// True when a vertex lies in the band (m) of a side, of the floor when it faces down or lies on
/// it, or of a solid. Liquid that is shallower than the band keeps its surface.
bool is_masked(const Walls& walls, const Eigen::Vector3d& x, const Eigen::Vector3d& normal,
               double band, double cell);

}  // namespace geoprior::fluid
