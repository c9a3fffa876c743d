#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/hidden/border_stretches.h"

namespace geoprior::sketch {

/// Of the drawing's diagonal: along which the direction of an end is taken.
inline constexpr double kEndPart = 0.04;

/// A border in one or more stretches, in order and sense.
struct PartialBorder {
  int stroke = -1;  ///< the first that was drawn of it
  std::vector<std::string> panels;
  bool closed = false;
  std::vector<Stretch> stretches;
  std::array<bool, 2> covered{false, false};  ///< first and last end of an open one

  [[nodiscard]] bool whole() const {
    return stretches.size() == 1 && (closed || (!covered[0] && !covered[1]));
  }
};

double distance_to(const PartialBorder& border, const Eigen::Vector2d& p);

/// A drawn ruling between two borders.
struct BorderRuling {
  std::array<int, 2> border{-1, -1};
  std::array<Eigen::Vector2d, 2> end;
};

/// What a view shows of its borders.
struct SeenBorders {
  double diagonal = 0;    ///< of the box about all borders (m)
  double snap = 0;        ///< within which ends meet (m)
  double mark_reach = 0;  ///< within which ends of rulings and pairs lie on borders (m)
  std::vector<PartialBorder> borders;
  std::vector<BorderRuling> rulings;
};

/// Every stroke a border of its own.
/// @param snap   share of the drawing's diagonal within which ends meet
/// @param noise  standard deviation of a drawn coordinate (m)
SeenBorders borders_as_drawn(const View& view, double snap, double noise);

/// Stretches of one border put together: of the same panels, and either named alike ("rim",
/// "rim-2") or meeting smoothly, where something covers both their ends. Something covers an end
/// that lies on another border or on a silhouette, and meets no end of a border of a panel of its
/// own there; sides of one panel, which a ruling joins, meet
/// only where their ends touch. Beside others, a stretch that
/// reaches less far than four deviations of the noise is left out, unless the border ends with it.
SeenBorders seen_borders(const View& view, double snap, double noise);

}  // namespace geoprior::sketch
