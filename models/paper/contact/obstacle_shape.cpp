#include "models/paper/contact/obstacle_shape.h"

#include <cmath>
#include <functional>
#include <numbers>

#include "core/angles.h"

namespace geoprior::paper {
namespace {

/// Triangles under construction.
struct Shape {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;

  /// Grid of (columns + 1) x (rows + 1) points of `place(s, t)`, s and t from 0 to 1.
  void grid(int columns, int rows, const std::function<Eigen::Vector3d(double, double)>& place) {
    const int first = static_cast<int>(points.size());
    for (int j = 0; j <= rows; ++j) {
      for (int i = 0; i <= columns; ++i) {
        points.push_back(place(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
      }
    }
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const int a = first + j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
        triangles.emplace_back(a, b, d);
        triangles.emplace_back(a, d, c);
      }
    }
  }
};

/// Frame of an obstacle: z along its axis.
struct Axes {
  Eigen::Vector3d centre, x, y, z;
};

Axes axes_at(const Obstacle& obstacle, double time) {
  const Keyframe key = obstacle.motion ? obstacle.motion->at(time) : Keyframe{};
  Axes a;
  a.centre = obstacle.centre + key.shift;
  a.z = key.turn * obstacle.axis;
  a.x = key.turn * obstacle.axis.unitOrthogonal();
  a.y = a.z.cross(a.x);
  return a;
}

void add_ball(Shape& shape, const Eigen::Vector3d& centre, double radius, bool half) {
  // Half: longitudes from 0 to pi, about the direction (-1, 1, 0): the far side for an eye at +x-y.
  const double first = half ? std::numbers::pi / 4 : 0, span = half ? std::numbers::pi : kFullTurn;
  shape.grid(half ? 24 : 48, 24, [&](double s, double t) -> Eigen::Vector3d {
    const double longitude = first + span * s, polar = std::numbers::pi * (1 - t);
    return centre + radius * Eigen::Vector3d(std::sin(polar) * std::cos(longitude),
                                             std::sin(polar) * std::sin(longitude),
                                             std::cos(polar));
  });
}

void add_cylinder(Shape& shape, const Axes& a, double radius, double half_length) {
  const auto at = [&](double angle, double r, double z) -> Eigen::Vector3d {
    return a.centre + r * std::cos(angle) * a.x + r * std::sin(angle) * a.y + z * a.z;
  };
  shape.grid(48, 1, [&](double s, double t) {
    return at(kFullTurn * s, radius, (2 * t - 1) * half_length);
  });
  shape.grid(48, 1,
             [&](double s, double t) { return at(kFullTurn * s, radius * (1 - t), half_length); });
  shape.grid(48, 1,
             [&](double s, double t) { return at(kFullTurn * s, radius * t, -half_length); });
}

void add_torus(Shape& shape, const Axes& a, double radius, double tube) {
  shape.grid(96, 12, [&](double s, double t) -> Eigen::Vector3d {
    const double around = kFullTurn * s, about = kFullTurn * t;
    const double r = radius + tube * std::cos(about);
    return a.centre + r * (std::cos(around) * a.x + std::sin(around) * a.y) +
           tube * std::sin(about) * a.z;
  });
}

void add_plane(Shape& shape, const Axes& a, double half) {
  shape.grid(1, 1, [&](double s, double t) -> Eigen::Vector3d {
    return a.centre + half * ((2 * s - 1) * a.x + (2 * t - 1) * a.y);
  });
}

void add_obstacle(Shape& shape, const Obstacle& obstacle, double size, double time) {
  const Axes a = axes_at(obstacle, time);
  const double radius = ObstacleAt(obstacle, time).radius();
  switch (obstacle.kind) {
    case Obstacle::Kind::plane:
      return add_plane(shape, a, size);
    case Obstacle::Kind::sphere:
      return add_ball(shape, a.centre, radius, false);
    case Obstacle::Kind::hollow_sphere:
      return add_ball(shape, a.centre, radius, true);
    case Obstacle::Kind::cylinder:
      return add_cylinder(shape, a, radius, obstacle.half_length > 0 ? obstacle.half_length : size);
    case Obstacle::Kind::torus:
      return add_torus(shape, a, radius, obstacle.tube_radius);
  }
}

}  // namespace

std::optional<Part> obstacle_part(const Sheet& sheet, double time) {
  if (sheet.obstacles.empty()) return std::nullopt;
  Shape shape;
  std::vector<double> owner;
  for (std::size_t i = 0; i < sheet.obstacles.size(); ++i) {
    add_obstacle(shape, sheet.obstacles[i], diameter(sheet.pattern), time);
    owner.resize(shape.triangles.size(), static_cast<double>(i));
  }
  Part part;
  part.points.resize(shape.points.size(), 3);
  part.triangles.resize(shape.triangles.size(), 3);
  for (std::size_t i = 0; i < shape.points.size(); ++i) {
    part.points.row(i) = shape.points[i].transpose();
  }
  for (std::size_t i = 0; i < shape.triangles.size(); ++i) {
    part.triangles.row(i) = shape.triangles[i].transpose();
  }
  part.arrays.push_back({"obstacle", "1", NamedArray::On::cells,
                         Eigen::Map<const Eigen::VectorXd>(owner.data(), owner.size())});
  return part;
}

}  // namespace geoprior::paper
