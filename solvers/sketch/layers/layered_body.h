#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "solvers/sketch/drawing/mirror_plane.h"
#include "solvers/sketch/layers/arc_circle.h"
#include "solvers/sketch/layers/frustum_band.h"

namespace geoprior::sketch {

/// About what neighbouring layers turn when they are shown in motion.
enum class HingeAxis {
  rivets,  ///< the line through the rivets at the ends of the arcs
  centre,  ///< a line through the circle's centre
  crown,   ///< a line along the back, where a rigger would put a chain of joints
};

/// Parameters of articulated layers. Lengths are shares of the mean radius of the circles, so that
/// a drawing at another scale gives the same shape.
struct LayerOptions {
  double vector_ratio = 1;
  bool constrained = true;
  bool oblique = true;
  /// How far a layer reaches below the one before it, over the visible length of that one; absent:
  /// at every joint the largest that fits.
  std::optional<double> overlap = {};
  double gape = 0.1;  ///< largest distance of a rim from the layer below it, of a chosen overlap
  double thickness = 0.008;
  double clearance = 0.012;  ///< between a layer and the part of the next that lies below it
  /// Angle of a joint either way for which the strip below has room: on a body that grows thinner
  /// it must be narrower than the clearance alone asks for, or it is stuck.
  double free_deg = 8;
  double rivet_margin = 0.08;
  double rivet_radius = 0.02;
  double max_angle_deg = 30;
  /// A joint stops before a gap opens between its layers, or one vanishes below the other.
  bool keep_covered = true;
  HingeAxis axis = HingeAxis::rivets;
  BandGrid grid = {};
  int poses = 16;
};

/// Joint of two neighbouring layers: a line along the mirror plane's normal.
struct LayerHinge {
  Eigen::Vector3d point{0, 0, 0};          ///< in the mirror plane, at rest (m)
  Eigen::Vector3d axis{1, 0, 0};           ///< unit; a positive angle curls the body up
  double front_hole = 0;                   ///< s of the hole in the layer before, +- (rad)
  double front_hole_at = 0;                ///< x of that hole
  double rear_hole = 0, rear_hole_at = 0;  ///< in the layer behind
  double curl = 0, stretch = 0;            ///< largest angles both ways, >= 0 (rad)
};

/// How an overlap came about.
struct OverlapRecord {
  double share = 0;     ///< of the visible length of the layer before
  double free = 0;      ///< angle either way for which the strip has room (rad)
  bool chosen = false;  ///< not given by the user
};

/// Rigid layers, from the first arc to the last, and what joins them.
struct ArticulatedLayers {
  MirrorPlanes planes;  ///< the one used, and the other reading of the same picture
  std::vector<ArcCircle> circles;
  std::vector<FrustumBand> bands;      ///< one less; band j ends at circle j + 1
  std::vector<double> overlaps;        ///< of each band below the one before; 0 for the first (m)
  std::vector<OverlapRecord> choices;  ///< one a hinge
  std::vector<LayerHinge> hinges;      ///< one less again; hinge j joins bands j and j + 1
  double unit = 0;                     ///< mean radius (m)
};

/// Where each band is when every hinge is turned by its angle: band 0 stays.
std::vector<Eigen::Isometry3d> layer_poses(const ArticulatedLayers& layers,
                                           const std::vector<double>& angles);

/// Line that a hinge turns about with another choice of axis.
Eigen::Vector3d hinge_point(const ArticulatedLayers& layers, std::size_t hinge, HingeAxis axis);

/// Turns by an angle about the hinge.
Eigen::Isometry3d hinge_turn(const LayerHinge& hinge, double angle);

}  // namespace geoprior::sketch
