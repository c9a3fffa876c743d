#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "baselines/fluid/liquid/tank/liquid_shape.h"
#include "baselines/fluid/liquid/tank/shape_distance.h"
#include "core/inputs/trajectory.h"

namespace geoprior::fluid {

/// Something that liquid does not enter. It stands still or follows keyframes (about its centre).
struct TankSolid {
  std::string name;
  LiquidShape shape;
  std::optional<Trajectory> motion;
};

/// Liquid that is there at the start (`from` = `until` = 0) or poured in while it is active.
struct LiquidVolume {
  std::string name;
  LiquidShape shape;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the liquid put there (m/s)
};
struct LiquidSource {
  std::string name;
  LiquidShape shape;  ///< cells without particles in it are filled anew every step
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  double from = 0, until = 0;  ///< s
};

/// Everything a liquid simulation is given. z is up when gravity says so; nothing assumes it.
struct Tank {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< lower corner of the domain (m)
  Eigen::Vector3i cells{32, 32, 32};
  double cell = 1.0 / 32;                ///< edge of a cell h (m)
  Eigen::Vector3d gravity{0, 0, -9.81};  ///< m/s^2
  double density = 1000;                 ///< kg/m^3
  /// The domain's six sides are walls (free slip); an open top lets liquid leave and is a pressure
  /// of 0.
  bool open_top = true;
  std::vector<LiquidVolume> volumes;
  std::vector<LiquidSource> sources;
  std::vector<TankSolid> solids;
  double duration = 1;               ///< s
  double frame_interval = 1.0 / 30;  ///< s

  [[nodiscard]] int frame_count() const;             ///< the start included
  [[nodiscard]] double frame_time(int frame) const;  ///< a multiple, never a sum (s)
};

/// A solid at one time: distance, velocity of its points.
struct PlacedSolid {
  const ShapeDistance* distance = nullptr;
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();  ///< from t = 0 to now
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();             ///< now (m)
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();             ///< m/s
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();            ///< rad/s
  [[nodiscard]] double distance_at(const Eigen::Vector3d& x) const;
  [[nodiscard]] Eigen::Vector3d velocity_at(const Eigen::Vector3d& x) const;
};

/// Where a solid is at `time`; its velocity by central differences of the trajectory over `dt`.
PlacedSolid place_solid(const TankSolid& solid, const ShapeDistance& distance, double time,
                        double dt);

/// Bytes that a simulation of the tank will need, before it starts.
double memory_estimate(const Tank& tank, int particles_per_cell);

/// Throws Error naming what is wrong and where ("scene.solids.1.shape.radius" for `where` =
/// "scene"): sizes that are not positive, values that are not finite, a volume outside the domain
/// or without liquid cells, a solid that leaves the domain on its way, key times that do not
/// increase, a mesh that is not closed, a grid that does not fit into `memory_limit` bytes (with
/// the estimate).
void require_valid(const Tank& tank, int particles_per_cell, double memory_limit,
                   const std::string& where);

}  // namespace geoprior::fluid
