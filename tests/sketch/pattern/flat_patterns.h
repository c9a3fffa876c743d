#pragma once

#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "models/sketch/pattern/pattern.h"

namespace geoprior::test {

/// A bucket: a frustum of `count` planar facets, unrolled, and the disc that closes its wider end.
///
/// Edge 0 of the wall (the outer arc) is sewn to edge 0 of the disc (its whole border), edge 1 to
/// edge 3 (the wall's legs); edge 2, the inner arc, is free. The chords of both arcs are equal, so
/// that the lengths of every seam are equal to round-off.
inline sketch::Pattern bucket(int count = 48, double wide = 0.12, double narrow = 0.08,
                              double height = 0.15) {
  const double slant = std::hypot(height, wide - narrow);
  const double outer = wide * slant / (wide - narrow), inner = outer - slant;
  const double angle = 2 * std::numbers::pi * (wide - narrow) / slant;
  const double chord = 2 * outer * std::sin(angle / (2 * count));
  const double radius = chord / (2 * std::sin(std::numbers::pi / count));
  sketch::PatternPiece wall, disc;
  wall.name = "wall";
  wall.points.resize(2 * count + 2, 2);
  for (int i = 0; i <= count; ++i) {
    const double a = std::numbers::pi / 2 + angle * (static_cast<double>(i) / count - 0.5);
    wall.points.row(i) << outer * std::cos(a), outer * std::sin(a);
    wall.points.row(2 * count + 1 - i) << inner * std::cos(a), inner * std::sin(a);
  }
  std::vector<int> border(2 * count + 2);
  std::iota(border.begin(), border.end(), 0);
  wall.borders = {border};
  const auto range = [](int from, int to) {
    std::vector<int> chain;
    for (int i = from; i <= to; ++i) chain.push_back(i);
    return chain;
  };
  wall.edges = {{range(0, count), 0, 1, 0},
                {{count, count + 1}, 1, 0, 3},
                {range(count + 1, 2 * count + 1), -1, -1, -1},
                {{2 * count + 1, 0}, 1, 0, 1}};
  for (int i = 0; i <= count; ++i) wall.surface_vertex.push_back(i % count);
  for (int i = count; i >= 0; --i) wall.surface_vertex.push_back(count + i % count);
  disc.name = "disc";
  disc.points.resize(count, 2);
  for (int i = 0; i < count; ++i) {
    const double a = 2 * std::numbers::pi * i / count;
    disc.points.row(i) << radius * std::cos(a), radius * std::sin(a);
    disc.surface_vertex.push_back((count - i) % count);
  }
  disc.borders = {range(0, count - 1)};
  std::vector<int> around = range(0, count - 1);
  around.push_back(0);
  disc.edges = {{around, 0, 0, 0}};
  return {{wall, disc}};
}

/// A piece with these corners, counter-clockwise (m); without edges it is free all round.
inline sketch::PatternPiece polygon_piece(const std::string& name,
                                          const std::vector<Eigen::Vector2d>& corners) {
  sketch::PatternPiece piece;
  piece.name = name;
  piece.points.resize(corners.size(), 2);
  std::vector<int> border;
  for (int i = 0; i < std::ssize(corners); ++i) {
    piece.points.row(i) = corners[i].transpose();
    border.push_back(i);
    piece.surface_vertex.push_back(i);
  }
  piece.borders = {border};
  return piece;
}

}  // namespace geoprior::test
