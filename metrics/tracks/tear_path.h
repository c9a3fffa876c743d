#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace geoprior {

/// The way of a tear's tip through the plane, the start first (m).
using TearPath = std::vector<Eigen::Vector2d>;

/// Length (m).
double path_length(const TearPath& path);

/// The longest of the paths, the first of those as long; null when none has a length.
const TearPath* longest_path(const std::vector<TearPath>& paths);

/// The first `length` (m) of a path, or the whole of a shorter one, without steps of no length.
/// @param path  not empty
TearPath first_part(const TearPath& path, double length);

/// How far |CA| - |CB| of a tip C goes from what it is at the start, over |AB|: 0 on a hyperbola
/// with the foci A and B, which the tear of a taut inextensible sheet follows (O'Keefe 1994).
/// @throws Error  when A and B are one point or the path is empty
double focal_drift(const TearPath& path, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/// Angle between the chord of the path and a direction (degrees); 0 for a path of one point.
double chord_angle_deg(const TearPath& path, const Eigen::Vector2d& direction);

/// Farthest that a point of the path lies from its chord, over the chord's length: 0 when straight.
double path_bow(const TearPath& path);

/// How a path keeps to a reference, both as far as the shorter of them goes.
struct PathComparison {
  double distance = 0;   ///< Hausdorff distance (m)
  double drift = 0;      ///< farthest that a point of the path lies from the reference, over the
                         ///< length compared: sin of the angle for two lines from one point
  double deviation = 0;  ///< angle between the chords (degrees): 0 for parallel lines
};
/// @throws Error  when one is empty or has no length
PathComparison compare_paths(const TearPath& path, const TearPath& reference);

/// Farthest that a point of either path lies from the other (Hausdorff distance, m).
/// @throws Error  when one is empty
double path_distance(const TearPath& p, const TearPath& q);

/// The path of a taut inextensible sheet pulled at A and B: the tip goes away from both along their
/// bisector, -(a + b) / |a + b| with a and b the directions from the tip to A and B (Roman 2013),
/// by midpoint steps.
/// @throws Error  when start, A and B are on one line
TearPath bisector_path(const Eigen::Vector2d& start, const Eigen::Vector2d& a,
                       const Eigen::Vector2d& b, double length, double step);

/// Energy per area that tearing takes at a place, in a direction of unit length (J/m^2).
using TearToughness =
    std::function<double(const Eigen::Vector2d& at, const Eigen::Vector2d& direction)>;

/// Energy that tears along paths took (J): toughness over the torn section, by the middle of every
/// step. @param thickness  of the sheet (m)
double fracture_energy(const std::vector<TearPath>& paths, const TearToughness& toughness,
                       double thickness);

/// Direction of the tear at C: away from A and B along the bisector, unit; zero where C lies
/// between them.
Eigen::Vector2d bisector_direction(const Eigen::Vector2d& c, const Eigen::Vector2d& a,
                                   const Eigen::Vector2d& b);

/// Force under which a taut inextensible sheet begins to tear: K e / (2 cos(theta / 2)), theta the
/// angle A C B (N). @param toughness K (J/m^2) @param thickness e (m)
double onset_force(const Eigen::Vector2d& c, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                   double toughness, double thickness);

}  // namespace geoprior
