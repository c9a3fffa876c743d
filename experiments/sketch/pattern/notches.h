#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/sketch/pattern/pattern.h"

namespace geoprior::sketch {

struct NotchOptions {
  double spacing = 0.1;         ///< of the even notches along a sewn edge, about (m)
  double shortest_edge = 0.02;  ///< edges that are shorter carry none (m)
};

/// A mark on a sewn edge. It comes twice, once on each side of the seam.
struct Notch {
  int label = 0;           ///< from 1 on; both of a pair carry it, no others
  bool direction = false;  ///< lies off the middle, so that the edge cannot be sewn reversed
  int piece = 0;
  int edge = 0;                   ///< of that piece
  double arc = 0;                 ///< length along the edge from its first point (m)
  Eigen::Vector2d point{0, 0};    ///< on the sewing line (m)
  Eigen::Vector2d outward{0, 0};  ///< unit normal of the sewing line, away from the material
};

/// Pairs of notches along all seams: notch 2 k and notch 2 k + 1 meet when the seam is sewn.
///
/// An edge of length L is divided into m = max(1, round(L / spacing)) even parts with a notch
/// between any two; one direction notch lies at 2/5 of the first part, where no even notch lies
/// when the edge is turned round. The partner runs through the opposite way: the arc a of one is L
/// - a of the other. Where the flat lengths of the two differ, positions are shares of each length,
/// so that the difference is eased in evenly. An edge that is its own partner (a dart's two legs in
/// one) is folded at its middle, and both notches of a pair lie on it.
///
/// @param pattern  drawable (piece_border.h)
/// @throws Error   for a pattern that is not, or a spacing that is not positive
std::vector<Notch> paired_notches(const Pattern& pattern, const NotchOptions& options);

}  // namespace geoprior::sketch
