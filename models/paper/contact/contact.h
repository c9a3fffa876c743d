#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// One push of a contact term: the point p = sum w_k x_k of the sheet at gap `gap` along `normal`.
///
///   energy (k/2) (d_c - gap)^2 for gap < d_c,  force on vertex i = w_i k (d_c - gap) normal
///
/// Weights of either sign and up to four vertices: a sample of a triangle against an obstacle now,
/// vertex-triangle and edge-edge pairs of the sheet itself in the same form.
struct ContactPoint {
  std::array<int, 4> vertex{-1, -1, -1, -1};
  std::array<double, 4> weight{};
  int count = 0;
  Eigen::Vector3d normal;            ///< gradient of the gap
  Eigen::Vector3d surface_velocity;  ///< of what it touches (m/s)
  double gap = 0;                    ///< at the end of the step, for the sheet where it is (m)
  double stiffness = 0;              ///< k (N/m)
};

/// Where the sheet is when contacts are looked for.
struct ContactQuery {
  const Eigen::MatrixX3d& x;
  /// Displacement to expect (m), or none: a point is reported when it is within the contact
  /// distance now or after that displacement. One linear solve thus stops a fast point at the
  /// surface instead of finding it deep inside a step later.
  const Eigen::MatrixX3d* displacement = nullptr;
  double time = 0;  ///< at which obstacles are taken (s)
};

/// Something that the sheet may touch.
class ContactTerm {
 public:
  virtual ~ContactTerm() = default;
  /// Appends the points in contact, in an order that depends on the query alone.
  virtual void find(const ContactQuery& query, std::vector<ContactPoint>& out) const = 0;
};

/// Contact with rigid obstacles, at the vertices and at samples inside of triangles and on their
/// edges, at most `spacing` apart: a long triangle cannot sink through an obstacle between its
/// corners. Samples carry the area that the composite trapezoidal rule gives them.
struct ObstacleContactOptions {
  double distance = 5e-4;   ///< d_c (m)
  double stiffness = 1e7;   ///< push per area of sheet (N/m^3)
  double spacing = 0.01;    ///< of samples (m)
  int most_divisions = 32;  ///< of a triangle's longest edge
};
std::unique_ptr<ContactTerm> make_obstacle_contact(const std::vector<Obstacle>& obstacles,
                                                   const ShellMesh& mesh,
                                                   const ObstacleContactOptions& options);

/// (k/2) (d_c - gap)^2 summed over the points that are within d_c (J).
double contact_energy(const std::vector<ContactPoint>& points, double distance);

/// Coulomb friction of a point, smoothed so that it has a derivative where sliding begins:
/// |friction| = mu N s / sqrt(s^2 + s_0^2) at slip speed s. What should stick therefore creeps, at
/// less than s_0 on slopes below atan(mu / sqrt 2).
struct FrictionPoint {
  ContactPoint contact;
  double limit = 0;  ///< mu N, the normal force that of the start of the step (N)
  double slip = 0;   ///< slip speed to expect, for the linear step (m/s)
};

}  // namespace geoprior::paper
