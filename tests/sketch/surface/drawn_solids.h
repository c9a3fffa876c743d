#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch::solids {

inline Stroke stroke_of(std::string id, StrokeKind kind, std::vector<Eigen::Vector2d> points,
                        bool closed) {
  Stroke stroke;
  stroke.id = std::move(id);
  stroke.kind = kind;
  stroke.closed = closed;
  stroke.points = std::move(points);
  return stroke;
}

inline Stroke rectangle(double width, double height) {
  return stroke_of("outline", StrokeKind::silhouette,
                   {{0, 0}, {width, 0}, {width, height}, {0, height}}, true);
}

inline Stroke ellipse(double width, double height, int points) {
  std::vector<Eigen::Vector2d> p;
  for (int i = 0; i < points; ++i) {
    const double a = 2 * std::numbers::pi * i / points;
    p.emplace_back(width / 2 * std::cos(a), height / 2 * std::sin(a));
  }
  return stroke_of("outline", StrokeKind::silhouette, std::move(p), true);
}

/// Box of width x, height y, depth z, from the front and from the side.
inline Drawing drawn_box(double x, double y, double z) {
  return {"box",
          {View{ViewKind::front, {rectangle(x, y)}}, View{ViewKind::side, {rectangle(z, y)}}}};
}

/// Upright cylinder from three sides.
inline Drawing drawn_cylinder(double diameter, double height, int points) {
  return {"cylinder",
          {View{ViewKind::front, {rectangle(diameter, height)}},
           View{ViewKind::side, {rectangle(diameter, height)}},
           View{ViewKind::top, {ellipse(diameter, diameter, points)}}}};
}

}  // namespace geoprior::sketch::solids
