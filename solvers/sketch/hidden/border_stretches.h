#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "solvers/sketch/hidden/border_models.h"

namespace geoprior::sketch {

/// Where a point of a completed border was drawn.
struct DrawnPlace {
  int stroke = -1;  ///< of the drawing; -1: nowhere, it is guessed
  double at = 0;    ///< number of its point
};

/// A point of a border as it is put together.
struct BorderPoint {
  Eigen::Vector2d p{0, 0};
  DrawnPlace place;
};
/// Part of a border; not empty.
using Stretch = std::vector<BorderPoint>;

double stretch_length(const Stretch& stretch);
PictureCurve picture_of(const Stretch& stretch, bool closed);

/// Direction in which a stretch leaves its end, from a line through its last part.
/// @param part  length of that (m)
Eigen::Vector2d direction_out(const Stretch& stretch, bool at_back, double part);

/// A stretch with its places on a model of the whole border, in the model's sense.
struct PlacedStretch {
  double begin = 0, end = 0;
  bool turned = false;
  Stretch stretch;
};
/// In the order in which they begin.
std::vector<PlacedStretch> placed_along(const PictureCurve& model,
                                        const std::vector<Stretch>& stretches);

/// Between two places of a curve (m).
double length_between(const PictureCurve& curve, double a, double b);

/// A border as it is put together along a model.
struct FollowedModel {
  const PictureCurve& model;
  Stretch points;
  double added = 0;  ///< length (m)

  /// Points of the model between two places, moved so that they go on from the given points;
  /// without a point, with the end of the model.
  void fill(double a, double b, const std::optional<Eigen::Vector2d>& at_a,
            const std::optional<Eigen::Vector2d>& at_b);
};

}  // namespace geoprior::sketch
