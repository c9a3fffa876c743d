#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/inputs/trajectory.h"

namespace geoprior::paper {

/// A rigid body that the sheet does not enter.
struct Obstacle {
  enum class Kind { plane, sphere, cylinder, hollow_sphere, torus };
  Kind kind = Kind::plane;
  std::string name;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< a point of the plane; centre otherwise
  Eigen::Vector3d axis =
      Eigen::Vector3d::UnitZ();      ///< unit: normal of the plane, axis of cylinder, torus
  double radius = 0.1;               ///< of sphere, cylinder, ring of the torus (m)
  double tube_radius = 0.002;        ///< of the torus (m)
  double half_length = 0;            ///< of the cylinder (m); 0: endless
  std::optional<Trajectory> motion;  ///< of centre and axis
  /// Radius over time (t, r), linear between; empty: constant. "hollow_sphere" shrinks by it.
  std::vector<std::pair<double, double>> radii;

  struct Contact {
    double distance = 0;                                 ///< signed, positive outside the body (m)
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< gradient of the distance
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the body's surface there (m/s)
  };
  [[nodiscard]] Contact contact(const Eigen::Vector3d& x, double time) const;
};

/// An obstacle at one time: made once a step, asked for every point of contact.
class ObstacleAt {
 public:
  ObstacleAt(const Obstacle& obstacle, double time);
  [[nodiscard]] Obstacle::Contact contact(const Eigen::Vector3d& x) const;
  [[nodiscard]] double radius() const { return radius_; }

 private:
  Obstacle::Kind kind_;
  double tube_radius_, half_length_;
  Eigen::Vector3d centre_, axis_;
  double radius_ = 0, radius_rate_ = 0;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d spin_ = Eigen::Matrix3d::Zero();  ///< velocity of a point about the centre
};

}  // namespace geoprior::paper
