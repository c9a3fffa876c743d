#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "baselines/paper/pattern.h"
#include "core/trajectory.h"

namespace geoprior {

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
  double damping = 0;     ///< stiffness-proportional (Rayleigh), as a time (s)

  /// E h / (1 - nu^2) (N/m)
  [[nodiscard]] double membrane_stiffness() const {
    return young_modulus * thickness / (1 - poisson_ratio * poisson_ratio);
  }
  /// D = E h^3 / (12 (1 - nu^2)) (N m)
  [[nodiscard]] double bending_stiffness() const {
    return membrane_stiffness() * thickness * thickness / 12;
  }
};

/// A place where the sheet is held: pattern points, a straight segment or a disc of the pattern.
///
/// Every mesh of the sheet has vertices at `anchors()`; on each mesh all vertices that `covers`
/// accepts are held. A held vertex with rest place X0 (in space) goes to c + shift + turn (X0 - c),
/// c the centre of the anchors.
struct Handle {
  std::string name;
  std::vector<Eigen::Vector2d> points;  ///< the shape, unless segment or disc
  std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> segment;
  std::optional<double> disc_radius;     ///< about points.front() (m)
  std::optional<Trajectory> motion;      ///< prescribed, or …
  std::optional<Eigen::Vector3d> force;  ///< … a dead load (N), spread over the shape
  /// Times at which it holds or pulls; empty: always.
  std::vector<std::pair<double, double>> active;

  /// Points; ends of the segment; centre of the disc and `kDiscAnchors` points of its rim.
  [[nodiscard]] std::vector<Eigen::Vector2d> anchors() const;
  static constexpr int kDiscAnchors = 4;
  [[nodiscard]] bool covers(const Eigen::Vector2d& pattern_point, double tolerance = 1e-9) const;
  [[nodiscard]] bool is_active(double time) const;
  /// Where a covered pattern point is at `time` under `motion`. @param rest its place at the start
  [[nodiscard]] Eigen::Vector3d target(const Eigen::Vector3d& rest, const Eigen::Vector3d& centre,
                                       double time) const;
};

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

/// Everything a paper method is given: the sheet, what moves it and what is in its way.
struct Sheet {
  Pattern pattern;
  PaperMaterial material;
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
  int substeps = 8;              ///< of a frame

  /// Place of a pattern point at t = 0, imperfection included.
  [[nodiscard]] Eigen::Vector3d rest_place(const Eigen::Vector2d& p, std::uint64_t seed) const;
  [[nodiscard]] int frame_count() const;             ///< recorded frames, the start included
  [[nodiscard]] double frame_time(int frame) const;  ///< of a frame, counted from 0 (s)
};

/// Throws Error naming what is wrong and where ("scene.handles.1.keys.2.t" for `where` = "scene"):
/// a pattern that is not simple, a material out of range, a handle outside the pattern, two handles
/// that move one point differently at one time, key times that do not increase, an obstacle that
/// contains the sheet's start, a value that is not finite.
void require_valid(const Sheet& sheet, const std::string& where);

}  // namespace geoprior
