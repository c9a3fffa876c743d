#pragma once

#include <optional>

#include "core/frame.h"
#include "experiments/torus/scene/scene.h"
#include "testbed/frame_sequence.h"

namespace geoprior::torus {

/// What the groups of the table of metrics (metrics.cpp) measure, from points of a frame alone.
using Value = std::optional<double>;

/// |Id - f* < , >| at the points inside the windows of a frame. Absent in a frame without windows.
struct DefaultMeasures {
  double mean = 0, largest = 0;
  double deviation = 0;  ///< of the mean over the windows: standard error
  /// Mean of |Id - h|, h what the corrugations of the stage would have made of its base if each had
  /// added exactly its part of g - base; once all three directions had theirs, h = g.
  /// Absent where a later frame does not say how many corrugations it has come to.
  Value wanted;
  Value miss;  ///< mean of |h - f* < , >|, at least |mean - wanted|; absent likewise
};
std::optional<DefaultMeasures> default_measures(const TorusScene& scene, const Frame& frame);

/// The mean default by differences of second order, at 8, 16 and 32 points a period.
struct CoarseMeasures {
  std::array<double, 3> mean{};
};
std::optional<CoarseMeasures> coarse_measures(const TorusScene& scene, const Frame& frame);

/// What the last corrugation did to the metric and to the points, at the windows. Absent in the
/// first frame.
struct CorrugationMeasures {
  double error = 0, largest_error = 0;  ///< |f_before* + rho pi^2 / |pi|^2 - f*|
  double way = 0;                       ///< largest distance of a point to where it was (m)
  double way_ratio = 0;                 ///< largest of it over r / N, its bound
  double least_rho = 0;                 ///< smallest coefficient
};
std::optional<CorrugationMeasures> corrugation_measures(const TorusScene& scene,
                                                        const Frame& frame);

/// default_miss after the last corrugation over the sum of the errors of its stage's.
Value miss_ratio(const TorusScene& scene, const FrameSequence& frames);

/// Lengths of closed curves over those in the square; absent where the frame has no such curve.
struct LengthMeasures {
  Value horizontal, vertical, diagonal;
};
LengthMeasures length_measures(const TorusScene& scene, const Frame& frame);

/// Power of the normals along a horizontal, in bands about the numbers of the corrugations so far.
struct NormalMeasures {
  Value finest;  ///< mean square of the normal's waves in the band of the finest corrugation
  Value slope;   ///< of log power over log number; absent for fewer than three corrugations
};
NormalMeasures normal_measures(const TorusScene& scene, const Frame& frame);

/// Pairs of triangles that intersect; absent where a part has fewer than `kLeastSamples` points a
/// period of the finest corrugation: its triangles are not the torus then.
constexpr double kLeastSamples = 8;
struct Intersections {
  Value surface, detail;
};
Intersections intersections(const TorusScene& scene, const Frame& frame);

/// Root mean square angle of the triangles of a part to their mean normal (deg); absent where they
/// cancel, as on a whole torus.
struct NormalSpread {
  Value surface, detail;
};
NormalSpread normal_spread(const TorusScene& scene, const Frame& frame);

/// The body that is printed, where the last frame has one.
struct PrintMeasures {
  double defects = 0;  ///< borders, crowded and turned edges, pinched vertices: 0 where closed
  double intersecting = 0;
  double volume = 0;  ///< m^3
};
std::optional<PrintMeasures> print_measures(const TorusScene& scene, const Frame& frame);

/// Root mean square of the way from the torus of revolution (m); absent in magnified views.
Value relief(const TorusScene& scene, const Frame& frame);

}  // namespace geoprior::torus
