#pragma once

#include <cstdint>

#include "core/options.h"
#include "models/grammar/hierarchy/hierarchy.h"

namespace geoprior::grammar {

/// A town house, a block or a tower: storeys on one another, windows in rows, a door, a roof.
struct BuildingOptions {
  double width = 11;  ///< of the ground storey, along x (m)
  double depth = 9;   ///< along y (m)
  int storeys = 3;
  double storey_height = 3.1;  ///< m
  double pitch = 1.8;          ///< distance of windows that is aimed at (m)
  double window_width = 1;     ///< m
  double window_height = 1.5;  ///< m
  double variety = 1;          ///< 0: all storeys and windows alike
};
void describe(OptionVisitor& v, BuildingOptions& options);

/// A building that keeps all its constraints, the middle of its ground at the origin, its front
/// (side 0, with the door) towards -y.
///
/// Types, in this order, with parameters (building_layout.h has their numbers) and key points:
///
/// - "building", the root: none; the middle of its ground;
/// - "storey": width, depth, height, base (of its base course; 0: none); the corners of the bottom
///   from (-width/2, -depth/2) counter-clockwise, then those of the top. Origin: middle of the
///   floor; it stands upright;
/// - "wall": length, height, side (0 .. 3), offset (from the storey's middle); bottom start, bottom
///   end, top end, top start. Frame: origin at the bottom start, x along, y inwards, z up;
/// - "window", "door": width, height, along (of its centre, from the wall's start), sill; centre,
///   then corners as a wall's. Frame: the wall's, origin at the centre;
/// - "roof": width, depth (of the storey below), rise, eaves (how far it juts out), ridge (its
///   length over what a gable roof's would be); four eave corners as a storey's, then the apex, the
///   ridge's middle. Origin: middle of the top storey's ceiling.
///
/// Children: of the building the storeys from the ground up, then the roof; of a storey its walls;
/// of a wall its openings from its start.
/// @throws Error  naming the option: out of its range
Hierarchy make_building(const BuildingOptions& options, std::uint64_t seed);

}  // namespace geoprior::grammar
