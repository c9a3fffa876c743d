#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/assembly/graph/part_type.h"

namespace geoprior::assembly {

/// Unit of lengths of XTrackCAD (m).
inline constexpr double kInch = 0.0254;

/// A centre line of a track in a layout's plane: inches, x to the east, y to the north.
using TrackLine = std::vector<Eigen::Vector2d>;

/// An end of a track.
struct TrackEnd {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< inches
  double direction = 0;  ///< out of the track, counter-clockwise from the east (rad)
};

/// A centre line between ends, given by their numbers, or from an end to Way::kInside.
struct TrackRoute {
  int from = Way::kInside;
  int to = Way::kInside;
  TrackLine line;
};

/// An arc about `centre`, counter-clockwise for a positive sweep, in steps of 5 degrees at most.
/// Where the ends are not equally far from the centre the radius changes evenly from one to the
/// other, so that the line meets both.
TrackLine arc_line(const Eigen::Vector2d& centre, const Eigen::Vector2d& from,
                   const Eigen::Vector2d& to, double sweep);

/// A cubic (Hermite) line that meets both ends in their directions: a stand-in for the spiral of
/// an easement, whose law the file only hints at.
TrackLine transition_line(const TrackEnd& from, const TrackEnd& to);

/// The routes of a turnout, one for each pair of ends.
///
/// A path lists pieces by their number from 1 on, negative where it runs through them backwards,
/// and 0 between two routes that are set together. A route counts when its pieces and the ends of
/// the track follow each other within .1 inch, as XTrackCAD asks for. An end that no path reaches
/// gets a straight line to the end that looks the most the other way.
std::vector<TrackRoute> turnout_routes(const std::vector<TrackEnd>& ends,
                                       const std::vector<TrackLine>& pieces,
                                       const std::vector<std::vector<int>>& paths);

/// Ways, mesh and boxes of a type from the routes of its first part, which is at `pose`.
///
/// The mesh is a closed prism a way, as wide as the gauge and .3 of it high, half of it below the
/// plane; prisms of ways that share a piece overlap. The boxes are twice as wide: the ties and the
/// body of a car reach over the rails. Pieces are joined to at most eight boxes a way.
///
/// @param gauge  distance of the rails (m)
void set_track_body(PartType& type, const std::vector<TrackRoute>& routes, const Pose& pose,
                    double gauge);

/// Whether the type's body is one that `set_track_body` made for this gauge.
bool is_of_gauge(const PartType& type, double gauge);

}  // namespace geoprior::assembly
