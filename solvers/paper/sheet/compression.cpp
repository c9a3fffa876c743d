#include "solvers/paper/sheet/compression.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angles.h"
#include "core/connectivity.h"
#include "core/geometry/planar.h"
#include "models/paper/contact/segments.h"

namespace geoprior::paper {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// On flat ground rulings are still free: about a point handle the directions of compression fan
/// out, and their mean is meant (rad).
constexpr double kFlatGroupAngle = std::numbers::pi / 4;

struct Eigenpair {
  double value;
  Vector2d direction;
};

/// Eigenvalue of largest modulus of a symmetric 2 x 2 matrix, or the smallest one.
Eigenpair principal(double uu, double uv, double vv, bool smallest) {
  const double mean = (uu + vv) / 2, difference = (uu - vv) / 2;
  const double radius = std::hypot(difference, uv);
  const bool upper = !smallest && mean >= 0;
  // The upper eigenvalue has its direction at half the angle of (difference, uv).
  const double angle = std::atan2(uv, difference) / 2 + (upper ? 0 : std::numbers::pi / 2);
  return {mean + (upper ? radius : -radius), {std::cos(angle), std::sin(angle)}};
}

Vector2d centroid(const ShellMesh& mesh, int f) {
  return (mesh.pattern.row(mesh.triangles(f, 0)) + mesh.pattern.row(mesh.triangles(f, 1)) +
          mesh.pattern.row(mesh.triangles(f, 2)))
             .transpose() /
         3;
}

double area(const ShellMesh& mesh, int f) {
  const Vector2d a = mesh.pattern.row(mesh.triangles(f, 0));
  const Vector2d b = mesh.pattern.row(mesh.triangles(f, 1));
  const Vector2d c = mesh.pattern.row(mesh.triangles(f, 2));
  return cross(b - a, c - a) / 2;
}

/// Direction of the rulings in a bent piece at a point; zero in a flat one.
Vector2d ruling_direction(const PaperStructure& structure, int piece, const Vector2d& p) {
  const PaperPiece& at = structure.pieces[piece];
  if (at.kind == PaperPiece::Kind::cylinder) return at.direction;
  if (at.kind == PaperPiece::Kind::cone) return (p - *at.apex).normalized();
  return Vector2d::Zero();
}

/// Free length of the sheet along d through p: to the border, a ruling or a singular point.
double span(const RulingEditor& editor, const Vector2d& p, const Vector2d& d) {
  return editor.propagate(p, d).distance + editor.propagate(p, -d).distance;
}

/// Strain at which the sheet buckles under compression along d.
double critical_strain(const PaperMaterial& material, double length, double kappa) {
  const double h = material.thickness, nu = material.poisson_ratio;
  const double plate = 4 * std::numbers::pi * std::numbers::pi * material.bending_stiffness() /
                       (material.young_modulus * h * length * length);
  return plate + std::abs(kappa) * h / std::sqrt(3 * (1 - nu * nu));
}

}  // namespace

Compression compression(const ShellState& state, int f) {
  const Eigen::RowVector3i t = state.mesh.triangles.row(f);
  Matrix2d rest;
  rest.col(0) = state.mesh.pattern.row(t[1]) - state.mesh.pattern.row(t[0]);
  rest.col(1) = state.mesh.pattern.row(t[2]) - state.mesh.pattern.row(t[0]);
  Eigen::Matrix<double, 3, 2> now;
  now.col(0) = state.x.row(t[1]) - state.x.row(t[0]);
  now.col(1) = state.x.row(t[2]) - state.x.row(t[0]);
  const Eigen::Matrix<double, 3, 2> F = now * rest.inverse();
  const Matrix2d G = (F.transpose() * F - Matrix2d::Identity()) / 2;
  const Eigenpair g = principal(G(0, 0), G(0, 1), G(1, 1), true);
  return {-g.value, g.direction};
}

namespace {

/// True when no ruling runs along the triangle and none is near: its curvature is then that of the
/// ground, not of the fold beside it.
bool inside_flat_cell(const RulingMesh& mesh, const EdgeConnectivity& edges, int f) {
  const auto cell = [&](int g) { return mesh.cell[g]; };
  for (int k = 0; k < 3; ++k) {
    const int next = edges.across(f, k);
    if (next >= 0 && cell(next) != cell(f)) return false;
  }
  return true;
}

/// Strain beyond which compression along d at p asks for rulings.
double admissible_strain(const Sheet& sheet, const RulingEditor& editor,
                         const HybridOptions& options, const Vector2d& p, const Vector2d& d,
                         const Eigen::Vector3d& curvature) {
  if (options.test == CompressionTest::threshold) return options.compression_threshold;
  const Vector2d t = perpendicular(d);
  const double across = t.x() * t.x() * curvature[0] + 2 * t.x() * t.y() * curvature[1] +
                        t.y() * t.y() * curvature[2];
  const double slope = options.least_slope_deg * kDegree;
  return std::max(
      options.euler_factor * critical_strain(sheet.material, span(editor, p, d), across),
      slope * slope / 4);
}

/// What a ruling's path through space shows: by how much its ends have approached, relative to its
/// length, and the vertex at which it turns most.
struct BentRuling {
  double shortening = 0;
  int sharpest = -1;
  double turn = 0;  ///< there (rad)
};
BentRuling bent_ruling(const ShellState& state, const std::vector<int>& path) {
  BentRuling result;
  double length = 0;
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    const Eigen::RowVector3d along = state.x.row(path[k + 1]) - state.x.row(path[k]);
    length += along.norm();
    if (k == 0) continue;
    const Eigen::RowVector3d before = state.x.row(path[k]) - state.x.row(path[k - 1]);
    const double turn = std::atan2(along.cross(before).norm(), along.dot(before));
    if (turn < result.turn) continue;
    result.turn = turn;
    result.sharpest = path[k];
  }
  result.shortening = 1 - (state.x.row(path.back()) - state.x.row(path.front())).norm() / length;
  return result;
}

/// Rulings that are straight no longer: the compression along them that this has released.
void demand_of_bent_rulings(const Sheet& sheet, const ShellState& state,
                            const Eigen::MatrixX3d& curvature, const RulingMesh& mesh,
                            const RulingEditor& editor, const HybridOptions& options,
                            std::vector<Demand>& demands) {
  const bool plain = options.test == CompressionTest::threshold;
  const double least_turn = plain ? 0 : options.refine_angle_deg * kDegree;
  for (std::size_t r = 0; r < mesh.ruling_paths.size(); ++r) {
    if (mesh.ruling_paths[r].size() < 3) continue;
    const BentRuling bent = bent_ruling(state, mesh.ruling_paths[r]);
    if (bent.turn < least_turn) continue;
    const Ruling& ruling = editor.structure().rulings[r];
    const Vector2d d = (ruling.b - ruling.a).normalized();
    for (int f = 0; f < state.mesh.triangle_count(); ++f) {
      Demand& demand = demands[f];
      if (demand.weight > bent.shortening ||
          !(state.mesh.triangles.row(f).array() == bent.sharpest).any()) {
        continue;
      }
      const double limit =
          admissible_strain(sheet, editor, options, centroid(state.mesh, f), d, curvature.row(f));
      if (bent.shortening > limit) {
        demand = {bent.shortening, bent.shortening / limit, d, true, false};
      }
    }
  }
}

}  // namespace

std::vector<Demand> find_demands(const Sheet& sheet, const ShellState& state,
                                 const Eigen::MatrixX3d& curvature, const RulingMesh& mesh,
                                 const RulingEditor& editor, const HybridOptions& options) {
  const int m = state.mesh.triangle_count();
  const EdgeConnectivity edges(state.mesh.triangles);
  std::vector<Demand> demands(m);
  for (int f = 0; f < m; ++f) {
    Demand& demand = demands[f];
    const Vector2d p = centroid(state.mesh, f);
    const Eigen::Vector3d S = curvature.row(f);
    const Vector2d ruling = ruling_direction(editor.structure(), mesh.piece[f], p);
    const bool bent = !ruling.isZero();
    const Compression c = compression(state, f);
    const bool served =
        bent && line_angle(perpendicular(c.direction), ruling) < options.group_angle_deg * kDegree;
    if (c.strain > 0 && !served) {
      const double limit = admissible_strain(sheet, editor, options, p, c.direction, S);
      if (c.strain > limit) {
        demand = {c.strain, c.strain / limit, c.direction, bent, false};
        continue;
      }
    }
    if (bent) continue;
    const Eigenpair kappa = principal(S[0], S[1], S[2], false);
    if (std::abs(kappa.value) > options.flat_curvature && inside_flat_cell(mesh, edges, f)) {
      const double shortening =
          kappa.value * span(editor, p, kappa.direction) / (2 * std::numbers::pi);
      demand = {shortening * shortening, 0, kappa.direction, false, true};
    }
  }
  demand_of_bent_rulings(sheet, state, curvature, mesh, editor, options, demands);
  return demands;
}

namespace {

double strength_of(const std::vector<Demand>& demands, const ShellMesh& mesh, int f) {
  return demands[f].weight * area(mesh, f);
}

/// Demands in triangles that touch, each within `limit` of the direction of the first.
class GroupGrower {
 public:
  GroupGrower(const std::vector<Demand>& demands, const ShellMesh& mesh)
      : demands_(demands), mesh_(mesh), edges_(mesh.triangles), taken_(demands.size(), false) {}

  [[nodiscard]] bool is_taken(int f) const { return taken_[f]; }

  [[nodiscard]] DemandGroup grow(int seed, double limit) {
    const Demand& first = demands_[seed];
    DemandGroup group;
    group.bent_ground = first.bent_ground;
    group.by_bending = first.by_bending;
    take(seed, group);
    Matrix2d sum = Matrix2d::Zero();
    for (std::size_t k = 0; k < group.triangles.size(); ++k) {
      const int f = group.triangles[k];
      const Vector2d& d = demands_[f].direction;
      const double strength = strength_of(demands_, mesh_, f);
      sum += strength * d * d.transpose();
      group.strength += strength;
      group.excess = std::max(group.excess, demands_[f].excess);
      group.centre += strength * centroid(mesh_, f);
      for (int corner = 0; corner < 3; ++corner) {
        const int next = edges_.across(f, corner);
        if (next >= 0 && !taken_[next] && is_like(demands_[next], first, limit)) take(next, group);
      }
    }
    group.centre /= group.strength;
    group.direction = principal(sum(0, 0), sum(0, 1), sum(1, 1), false).direction;
    measure_extent(group);
    return group;
  }

 private:
  void take(int f, DemandGroup& group) {
    taken_[f] = true;
    group.triangles.push_back(f);
  }
  static bool is_like(const Demand& other, const Demand& first, double limit) {
    return other.weight > 0 && other.bent_ground == first.bent_ground &&
           other.by_bending == first.by_bending &&
           line_angle(other.direction, first.direction) <= limit;
  }
  void measure_extent(DemandGroup& group) const {
    for (const int f : group.triangles) {
      for (int k = 0; k < 3; ++k) {
        const Vector2d p = mesh_.pattern.row(mesh_.triangles(f, k));
        const double along = (p - group.centre).dot(group.direction);
        group.low = std::min(group.low, along);
        group.high = std::max(group.high, along);
      }
    }
  }

  const std::vector<Demand>& demands_;
  const ShellMesh& mesh_;
  EdgeConnectivity edges_;
  std::vector<bool> taken_;
};

}  // namespace

std::vector<DemandGroup> group_demands(const std::vector<Demand>& demands, const ShellMesh& mesh,
                                       double group_angle_deg) {
  const double group_angle = group_angle_deg * kDegree;
  std::vector<int> order;
  for (int f = 0; f < std::ssize(demands); ++f) {
    if (demands[f].weight > 0) order.push_back(f);
  }
  std::stable_sort(order.begin(), order.end(), [&](int f, int g) {
    return strength_of(demands, mesh, f) > strength_of(demands, mesh, g);
  });
  GroupGrower grower(demands, mesh);
  std::vector<DemandGroup> groups;
  for (const int seed : order) {
    if (grower.is_taken(seed)) continue;
    const double limit =
        demands[seed].bent_ground ? group_angle : std::max(group_angle, kFlatGroupAngle);
    groups.push_back(grower.grow(seed, limit));
  }
  std::stable_sort(groups.begin(), groups.end(), [](const DemandGroup& a, const DemandGroup& b) {
    return a.strength > b.strength;
  });
  return groups;
}

}  // namespace geoprior::paper
