#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "models/torus/map.h"

namespace geoprior::torus {

/// Points of a window along each of its sides: differences of fourth order reach two to each side.
constexpr int kWindowSide = 12;
/// Those of the windows that show what a grid hides, by differences of second order.
constexpr int kCoarseSide = 6;
/// Points a period of the finest corrugation in windows, and in coarse ones.
constexpr int kSamplesPerPeriod = 40;
constexpr std::array<int, 3> kCoarseSamples{8, 16, 32};
/// Points a period along the curves whose lengths are measured; a frame has no curve of more points
/// than `kMostCurvePoints`.
constexpr int kCurveSamples = 16;
constexpr int kMostCurvePoints = 60000;

/// Squares of side x side parameters, one after the other, rows along y.
struct WindowSet {
  std::string name;  ///< of the part that holds them, and of the table of their corners
  int side = 0;
  double step = 0;          ///< between two neighbours
  Eigen::MatrixX2d corner;  ///< a row each
  [[nodiscard]] Eigen::MatrixX2d parameters() const;
};

/// A surface of side x side points, rows along y.
struct Lattice {
  int side = 0;
  bool closed = false;  ///< the whole torus: its last row and column join the first ones
  /// It is moved to the origin, turned upright and magnified so.
  std::optional<double> magnification;
};

/// One part of a frame: its points, as they are asked of a map.
struct FramePart {
  std::string name;
  TorusSamples samples;
  std::optional<Lattice> lattice;
};

/// Everything that a frame asks of a map.
struct FramePlan {
  double parameter = 0;  ///< corrugations so far, or the number of the view
  int corrugations = 0;
  std::vector<FramePart> parts;
  std::vector<WindowSet> windows;  ///< those that have corners of their own
};

/// Periods of the finest corrugation among the first `corrugations`, along a side of the square;
/// at least 1.
double finest_periods(const TorusInput& input, int corrugations);

/// The node of a periodic grid of n nodes at a parameter, which is a whole multiple of 1 / n.
int grid_node(double parameter, int n);

/// @param grid  all parameters are multiples of 1 / grid; absent: any
std::vector<FramePlan> plan_frames(const TorusInput& input, std::optional<int> grid);

}  // namespace geoprior::torus
