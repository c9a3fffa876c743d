#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace geoprior::torus {

/// Radii of the torus of revolution that everything starts from, over 1 / (2 pi): its lines
/// x = const are circles of radius (r2 + r1 cos 2 pi x) / (2 pi).
struct Radii {
  double tube = 0.2;  ///< r1
  double ring = 0.5;  ///< r2; r1 + r2 < 1, so that every length is shorter than in the square
};

/// One corrugation of the sequence that makes the torus isometric.
struct Corrugation {
  int direction = 0;  ///< of `kDirections`
  int number = 12;    ///< N: periods around the torus, times the direction's covector
  /// Share d of the way to the metric of the square that the corrugations of a stage go: their
  /// target is g = (1 - d) b + d Id, where b is the metric of the surface that the stage begins at.
  double share = 1;
  bool begins_stage = false;
};

/// A square part [x - width/2, x + width/2] x [y - width/2, y + width/2] of the unit square.
struct SquareWindow {
  Eigen::Vector2d centre{0.5, 0.5};
  double width = 1;
};

/// Where frames hold points.
struct Sampling {
  int surface = 400;                 ///< points along each side of the surface that is drawn
  std::optional<SquareWindow> view;  ///< absent: the whole torus
  /// Frames are views of all corrugations, each `nearer` times narrower than the one before;
  /// absent: a frame is a corrugation.
  std::optional<int> zooms;
  double nearer = 10;
  std::optional<SquareWindow> detail;  ///< a further part that frames show, magnified
  std::optional<int> whole;  ///< points along each side of the part "grid" of the last frame
  int windows = 256;         ///< places at which the metric is measured
  std::uint64_t seed = 1;    ///< of these places
};

/// What every method of the topic is given.
struct TorusInput {
  Radii radii;
  std::vector<Corrugation> corrugations;
  Sampling sampling;
};

/// The metric of the stage that corrugation i belongs to is measured after so many corrugations.
int stage_base(const TorusInput& input, int corrugation);

/// Share of the first stage, if it is one corrugation in direction 0, after which the other two
/// coefficients are the largest: 4 (r2^2 - r1^2) / (3 + r2^2 - 3 r1^2) (Borrelli et al. 2012).
double first_share(const Radii& radii);

/// @throws Error  naming the corrugation, its coefficient and the place at which it is not positive
[[noreturn]] void refuse_coefficient(const TorusInput& input, int corrugation, double rho,
                                     const Eigen::Vector2d& at);

/// @throws Error  naming what is wrong: radii whose torus is no shorter than the square, no first
///                stage, a direction or number out of range, a window outside the square
void require_valid(const TorusInput& input);

}  // namespace geoprior::torus
