#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "models/paper/contact/obstacle.h"
#include "models/paper/sheet/handle.h"
#include "models/paper/sheet/pattern.h"
#include "models/paper/tear/toughness.h"

namespace geoprior::paper {

/// What the sheet is made of. Defaults: office paper, 80 g/m^2.
struct PaperMaterial {
  double thickness = 1e-4;       ///< h (m)
  double young_modulus = 4.5e9;  ///< E (Pa)
  double poisson_ratio = 0.3;    ///< nu
  double area_density = 0.08;    ///< rho_s (kg/m^2)
  double yield_curvature =
      200;                ///< elastic curvature (Frobenius norm) beyond which it creases (1/m)
  double weakening = 0;   ///< bending stiffness falls by 1 / (1 + weakening * damage)
  double friction = 0.4;  ///< Coulomb, against obstacles
  std::optional<double> grain_deg;  ///< direction of the fibres in the pattern, from u towards v
  double along = 1;                 ///< bending stiffness along the fibres over that across them
  double damping = 0;               ///< stiffness-proportional (Rayleigh), as a time (s)

  /// E h / (1 - nu^2) (N/m)
  [[nodiscard]] double membrane_stiffness() const {
    return young_modulus * thickness / (1 - poisson_ratio * poisson_ratio);
  }
  /// D = E h^3 / (12 (1 - nu^2)) (N m)
  [[nodiscard]] double bending_stiffness() const {
    return membrane_stiffness() * thickness * thickness / 12;
  }
};

/// Everything a paper method is given: the sheet, what moves it and what is in its way.
struct Sheet {
  Pattern pattern;
  PaperMaterial material;
  Toughness toughness;
  std::vector<Handle> handles;
  std::vector<Obstacle> obstacles;
  Eigen::Vector3d gravity{0, 0, -9.81};  ///< m/s^2
  Eigen::Isometry3d placement =
      Eigen::Isometry3d::Identity();  ///< pattern (u, v, 0) to space at t = 0
  /// Height of the out-of-plane imperfection at the start (m): a sum of smooth waves drawn from the
  /// seed as functions of the pattern point, the same on every mesh. It decides how a flat sheet
  /// buckles; without one a perfectly flat sheet under symmetric load has no reason to.
  double imperfection = 1e-4;
  double duration = 1;           ///< s
  double frame_interval = 0.04;  ///< s
  int substeps = 8;              ///< of a frame, at least
  double handle_step = 1e-4;     ///< farthest that a handle goes in a step (m)

  /// Place of a pattern point at t = 0, imperfection included.
  [[nodiscard]] Eigen::Vector3d rest_place(const Eigen::Vector2d& p, std::uint64_t seed) const;
  [[nodiscard]] int frame_count() const;             ///< recorded frames, the start included
  [[nodiscard]] double frame_time(int frame) const;  ///< of a frame, counted from 0 (s)
};

}  // namespace geoprior::paper
