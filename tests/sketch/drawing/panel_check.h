#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/geometry/planar.h"
#include "models/sketch/pattern/pattern.h"
#include "models/sketch/surface/positive_winding.h"

namespace geoprior::test {

/// A line as an independent reader found it. Millimetres, up is up.
struct ReadLine {
  std::string layer;
  bool closed = false;
  sketch::PlaneLoop points;
};

/// The outer border of a piece, re-read: the same points up to a motion of the plane, in 0.01 mm.
///
/// All distances from three points of it are compared, and the sense of rotation.
inline void expect_panel(const sketch::PatternPiece& piece, const sketch::PlaneLoop& read) {
  const std::vector<int>& border = piece.borders[0];
  ASSERT_EQ(read.size(), border.size());
  sketch::PlaneLoop asked;
  for (const int v : border) asked.emplace_back(1000 * piece.points.row(v).transpose());
  const std::size_t n = asked.size();
  for (const std::size_t from : {std::size_t{0}, n / 3, 2 * n / 3}) {
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR((read[i] - read[from]).norm(), (asked[i] - asked[from]).norm(), 0.01)
          << piece.name << ", point " << i;
    }
  }
  EXPECT_GT(sketch::loop_area(read) * sketch::loop_area(asked), 0) << "mirrored";
}

inline double distance_to_line(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                               const Eigen::Vector2d& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

inline double distance_to_closed(const Eigen::Vector2d& p, const sketch::PlaneLoop& loop) {
  double least = 1e300;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    least = std::min(least, distance_to_line(p, loop[i], loop[(i + 1) % loop.size()]));
  }
  return least;
}

/// Least distance of two polygons that do not cross.
inline double distance_of_closed(const sketch::PlaneLoop& a, const sketch::PlaneLoop& b) {
  double least = 1e300;
  for (const Eigen::Vector2d& p : a) least = std::min(least, distance_to_closed(p, b));
  for (const Eigen::Vector2d& p : b) least = std::min(least, distance_to_closed(p, a));
  return least;
}

}  // namespace geoprior::test
