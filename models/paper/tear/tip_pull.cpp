#include "models/paper/tear/tip_pull.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angles.h"
#include "core/geometry/planar.h"
#include "models/paper/contact/segments.h"
#include "models/paper/shell/shape_gradients.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A force on the piece, where it acts.
struct Acting {
  Vector2d side;   ///< from C towards the piece's part at which it acts (m)
  Vector3d place;  ///< in space (m)
  Vector3d force;  ///< N
  Vector2d image;  ///< N
};

Vector2d centroid(const ShellMesh& mesh, int f) {
  return (mesh.pattern.row(mesh.triangles(f, 0)) + mesh.pattern.row(mesh.triangles(f, 1)) +
          mesh.pattern.row(mesh.triangles(f, 2))) /
         3;
}

bool is_held(const Sheet& sheet, const ShellMesh& mesh, int v, double time) {
  return std::any_of(sheet.handles.begin(), sheet.handles.end(), [&](const Handle& handle) {
    return handle.is_active(time) && handle.covers(mesh.pattern.row(v));
  });
}

/// Triangles about the vertex, and from there over edges as far as the reach, ascending.
std::vector<int> piece_about(const ShellMesh& mesh, const MeshNeighbours& neighbours, int vertex,
                             double reach) {
  std::vector<int> piece;
  std::vector<bool> in(mesh.triangle_count(), false);
  const auto take = [&](int f) {
    if (f < 0 || in[f]) return;
    in[f] = true;
    piece.push_back(f);
  };
  for (const int corner : neighbours.corners.of(vertex)) take(corner / 3);
  const Vector2d c = mesh.pattern.row(vertex);
  for (std::size_t i = 0; i < piece.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const int next = neighbours.edges.across(piece[i], k);
      if (next >= 0 && (centroid(mesh, next) - c).norm() <= reach) take(next);
    }
  }
  std::sort(piece.begin(), piece.end());
  return piece;
}

/// Of the membrane, times area (N m).
struct Stress {
  Eigen::Matrix2d second_piola_kirchhoff;
  Eigen::Matrix2d seen_in_pattern;  ///< F'F S: forces F S grad N go with F' to the pattern
  double energy = 0;                ///< density
};

/// Map from the pattern to space in a triangle.
Eigen::Matrix<double, 3, 2> deformation(const ShellState& state, int f,
                                        const std::array<Vector2d, 3>& gradient) {
  Eigen::Matrix<double, 3, 2> F = Eigen::Matrix<double, 3, 2>::Zero();
  for (int k = 0; k < 3; ++k) {
    F += state.x.row(state.mesh.triangles(f, k)).transpose() * gradient[k].transpose();
  }
  return F;
}

Stress stress(const Sheet& sheet, const ShellState& state, int f,
              const std::array<Vector2d, 3>& gradient, double area) {
  const Eigen::Matrix<double, 3, 2> F = deformation(state, f, gradient);
  const Eigen::Matrix2d G = (F.transpose() * F - Eigen::Matrix2d::Identity()) / 2;
  const double nu = sheet.material.poisson_ratio;
  const Eigen::Matrix2d S = area * sheet.material.membrane_stiffness() *
                            ((1 - nu) * G + nu * G.trace() * Eigen::Matrix2d::Identity());
  return {S, F.transpose() * F * S, S.cwiseProduct(G).sum() / 2};
}

/// What the outside does to the membrane of the piece, seen in the pattern. Vertices within the
/// piece have only triangles of it about them: what acts on them acts from inside.
struct Images {
  Eigen::MatrixX2d force;               ///< of each vertex (N)
  Eigen::MatrixX2d energy;              ///< density of elastic energy times outline, likewise (N)
  Eigen::MatrixX2d middle;              ///< of its triangles in the piece (m)
  std::vector<bool> outer;              ///< whether the outside acts on it
  Vector2d release = Vector2d::Zero();  ///< J integral (N): energy set free a unit of way of C
};

Images images_on(const Sheet& sheet, const ShellState& state, const std::vector<int>& piece,
                 const VertexCorners& corners, int vertex) {
  const ShellMesh& mesh = state.mesh;
  const int n = mesh.vertex_count();
  Images images{Eigen::MatrixX2d::Zero(n, 2), Eigen::MatrixX2d::Zero(n, 2),
                Eigen::MatrixX2d::Zero(n, 2), std::vector<bool>(n, false)};
  std::vector<int> count(n, 0);
  for (const int f : piece) {
    const Eigen::RowVector3i t = mesh.triangles.row(f);
    const double area = pattern_area(mesh, f);
    const std::array<Vector2d, 3> gradient = shape_gradients(mesh, f, area);
    const Stress of_triangle = stress(sheet, state, f, gradient, area);
    const Eigen::Matrix2d& S = of_triangle.seen_in_pattern;
    for (std::size_t k = 0; k < 3; ++k) {
      const int v = t[k];
      images.force.row(v) += (S * gradient[k]).transpose();
      images.energy.row(v) += (of_triangle.energy * gradient[k]).transpose();
      images.middle.row(v) += centroid(mesh, f).transpose();
      ++count[v];
    }
  }
  for (int v = 0; v < n; ++v) {
    if (count[v] == 0 || v == vertex) continue;
    images.middle.row(v) /= count[v];
    images.outer[v] = count[v] < corners.count(v) || is_held(sheet, mesh, v, state.time);
    if (images.outer[v]) images.release += (images.energy.row(v) - images.force.row(v)).transpose();
  }
  return images;
}

/// The same in space, bending included.
std::vector<Acting> forces_on(const ShellStepper& stepper, const ShellState& state,
                              const std::vector<int>& piece, const Images& images, int vertex) {
  const Eigen::MatrixX3d inner = stepper.elastic_forces(state, piece);
  const Eigen::RowVector2d c = state.mesh.pattern.row(vertex);
  std::vector<Acting> acting;
  for (int v = 0; v < state.mesh.vertex_count(); ++v) {
    const bool beyond = images.middle.row(v).isZero(0);  // an element reaches over its triangle
    if (v == vertex || inner.row(v).isZero(0) || !(images.outer[v] || beyond)) continue;
    // Seen from C: lips in one place lie on different sides.
    const Eigen::RowVector2d at =
        beyond ? state.mesh.pattern.row(v) : Eigen::RowVector2d(images.middle.row(v));
    acting.push_back({(at - c).transpose(), state.x.row(v).transpose(), -inner.row(v).transpose(),
                      images.force.row(v).transpose()});
  }
  return acting;
}

/// Image of the force that the sheet itself takes up at a vertex where it is held.
Vector2d held_image(const ShellStepper& stepper, const ShellState& state,
                    const VertexCorners& corners, int vertex) {
  std::vector<int> about;
  Eigen::Matrix<double, 3, 2> F = Eigen::Matrix<double, 3, 2>::Zero();  // times area
  double area = 0;
  for (const int corner : corners.of(vertex)) {
    const int f = corner / 3;
    about.push_back(f);
    const double a = pattern_area(state.mesh, f);
    area += a;
    F += a * deformation(state, f, shape_gradients(state.mesh, f, a));
  }
  const Vector3d taken = stepper.elastic_forces(state, about).row(vertex);
  return F.transpose() / area * taken;
}

/// Forces that act on one side.
struct Resultant {
  Vector3d force = Vector3d::Zero();
  Vector2d image = Vector2d::Zero();
  Vector3d moment = Vector3d::Zero();  ///< of the places, weighted with the forces' norms
  double weight = 0;
  [[nodiscard]] Vector3d place() const { return moment / weight; }
};

struct Parting {
  Vector2d line = Vector2d::Zero();
  Resultant left, right;
  [[nodiscard]] double sum() const { return left.force.norm() + right.force.norm(); }
};

Parting part_along(const std::vector<Acting>& acting, const Vector2d& line) {
  Parting parting{line, {}, {}};
  for (const Acting& a : acting) {
    Resultant& r = cross(line, a.side) > 0 ? parting.left : parting.right;
    r.force += a.force;
    r.image += a.image;
    r.moment += a.force.norm() * a.place;
    r.weight += a.force.norm();
  }
  return parting;
}

/// Of all lines through C that which parts the largest resultants.
Parting strongest_parting(const std::vector<Acting>& acting, int lines) {
  Parting best;
  for (int k = 0; k < lines; ++k) {
    const double angle = std::numbers::pi * k / lines;
    Parting parting = part_along(acting, {std::cos(angle), std::sin(angle)});
    if (parting.sum() > best.sum()) best = parting;
  }
  return best;
}

}  // namespace

std::optional<TipPull> pull_at(const Sheet& sheet, const ShellStepper& stepper,
                               const ShellState& state, const MeshNeighbours& neighbours,
                               int vertex, const PullOptions& options, double least_release) {
  const std::vector<int> piece = piece_about(state.mesh, neighbours, vertex, options.reach);
  Images images = images_on(sheet, state, piece, neighbours.corners, vertex);
  if (is_held(sheet, state.mesh, vertex, state.time))
    images.release += held_image(stepper, state, neighbours.corners, vertex);
  if (images.release.norm() < least_release * sheet.material.thickness) return {};
  const std::vector<Acting> acting = forces_on(stepper, state, piece, images, vertex);
  const auto [line, left, right] = strongest_parting(acting, options.lines);
  const double l = left.force.norm(), r = right.force.norm();
  if (!(std::min(l, r) > 0)) return {};
  const double cosine = std::clamp(left.force.dot(right.force) / (l * r), -1.0, 1.0);
  if (!(std::acos(cosine) >= options.least_opposition_deg * kDegree)) return {};
  // Pushed together, or folded over itself.
  if (!((left.force - right.force).dot(left.place() - right.place()) > 0)) return {};
  if (left.image.isZero(0) || right.image.isZero(0)) return {};
  TipPull pull;
  pull.left_force = left.force;
  pull.right_force = right.force;
  pull.left = left.image;
  pull.right = right.image;
  pull.release = images.release;
  pull.line = line;
  pull.normal = vertex_normal(state, neighbours.corners, vertex);
  pull.force = (l + r) / 2;
  pull.angle = std::abs(signed_angle(pull.left, pull.right));
  return pull;
}

Eigen::Matrix2d membrane_tension(const Sheet& sheet, const ShellState& state, int triangle) {
  const double area = pattern_area(state.mesh, triangle);
  const auto gradient = shape_gradients(state.mesh, triangle, area);
  return stress(sheet, state, triangle, gradient, area).second_piola_kirchhoff / area;
}

std::optional<TipPull> pull_on_flaw(const Sheet& sheet, const ShellState& state,
                                    const MeshNeighbours& neighbours, int vertex, double flaw) {
  constexpr double kEdgeCrack = 1.12;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 3, 2> F = Eigen::Matrix<double, 3, 2>::Zero();
  Vector2d middle = Vector2d::Zero();
  double area = 0;
  bool border = false;
  for (const int corner : neighbours.corners.of(vertex)) {
    const int f = corner / 3;
    const double a = pattern_area(state.mesh, f);
    const std::array<Vector2d, 3> gradient = shape_gradients(state.mesh, f, a);
    sum += stress(sheet, state, f, gradient, a).second_piola_kirchhoff;
    F += a * deformation(state, f, gradient);
    middle += a * centroid(state.mesh, f);
    area += a;
    const int k = corner % 3;
    border =
        border || neighbours.edges.across(f, k) < 0 || neighbours.edges.across(f, (k + 2) % 3) < 0;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(sum / area);
  const double tension = axes.eigenvalues()[1];  // N/m
  if (!(tension > 0)) return {};
  const Vector2d across = axes.eigenvectors().col(1);
  Vector2d along = perpendicular(across);
  if (along.dot(middle / area - state.mesh.pattern.row(vertex).transpose()) < 0) along = -along;
  const double q = border ? kEdgeCrack : 1;
  const double e = sheet.material.thickness;
  TipPull pull;
  pull.left = flaw * tension * perpendicular(along);
  pull.right = -pull.left;
  pull.left_force = F / area * pull.left;
  pull.right_force = -pull.left_force;
  pull.force = pull.left_force.norm();
  pull.angle = std::numbers::pi;
  pull.release = q * q * std::numbers::pi * flaw * tension * tension /
                 (sheet.material.young_modulus * e) * along;
  pull.line = along;
  pull.normal = vertex_normal(state, neighbours.corners, vertex);
  return pull;
}

void describe(OptionVisitor& v, PullOptions& o) {
  v.value("reach", o.reach,
          {.doc = "radius of the part of the sheet about a tip on which its pull is measured",
           .unit = "m",
           .min = 1e-6,
           .max = 100});
  v.value("lines", o.lines,
          {.doc = "number of directions tried for the line that parts left from right at a tip",
           .min = 1,
           .max = 10000});
  v.value("least_opposition_deg", o.least_opposition_deg,
          {.doc = "smallest angle in space between the two resultants of a pull that tears",
           .unit = "deg",
           .min = 0,
           .max = 180});
}

}  // namespace geoprior::paper
