#include "baselines/fluid/liquid/tank/tank.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/limits.h"
#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

/// What turns of a trajectory turn about: where the shape's centre is at t = 0.
Eigen::Vector3d pivot_of(const LiquidShape& shape) {
  if (shape.kind != LiquidShape::Kind::mesh || shape.mesh.vertex_count() == 0) return shape.centre;
  const Eigen::Vector3d low = shape.mesh.V.colwise().minCoeff(),
                        high = shape.mesh.V.colwise().maxCoeff();
  return 0.5 * (low + high);
}

}  // namespace

int Tank::frame_count() const {
  // A duration that is a multiple of the interval but for round-off still has its last frame.
  return 1 + static_cast<int>(std::floor(duration / frame_interval + 1e-9));
}

double Tank::frame_time(int frame) const { return frame * frame_interval; }

double PlacedSolid::distance_at(const Eigen::Vector3d& x) const {
  // The inverse of a rigid placement, without forming it for every point.
  return (*distance)(placement.linear().transpose() * (x - placement.translation()));
}

Eigen::Vector3d PlacedSolid::velocity_at(const Eigen::Vector3d& x) const {
  return linear + angular.cross(x - centre);
}

PlacedSolid place_solid(const TankSolid& solid, const ShapeDistance& distance, double time,
                        double dt) {
  PlacedSolid placed;
  placed.distance = &distance;
  const Eigen::Vector3d pivot = pivot_of(solid.shape);
  placed.centre = pivot;
  if (!solid.motion) return placed;
  const Keyframe now = solid.motion->at(time);
  placed.placement =
      Eigen::Translation3d(pivot + now.shift) * now.turn * Eigen::Translation3d(-pivot);
  placed.centre = pivot + now.shift;
  if (!(dt > 0)) return placed;
  const Keyframe before = solid.motion->at(time - 0.5 * dt),
                 after = solid.motion->at(time + 0.5 * dt);
  placed.linear = (after.shift - before.shift) / dt;
  const Eigen::AngleAxisd turned(after.turn * before.turn.conjugate());
  // AngleAxis gives angles up to pi from a quaternion with w >= 0 and more otherwise.
  double angle = turned.angle();
  if (angle > std::numbers::pi) angle -= 2 * std::numbers::pi;
  placed.angular = angle / dt * turned.axis();
  return placed;
}

namespace {

/// Bytes of every cell: four velocities and sums of two numbers a face (3 faces a cell), fractions
/// and velocities of solids and their resting copy, eight node or cell grids; marks of faces thrice
/// and of cells; and of every unknown of the pressure.
constexpr double kBytesPerCell = 4 * (4 * 3 + 2 * 3 + 4 * 3 + 8) + 3 * 3 + 4;
constexpr double kBytesPerLiquidCell = 5 * 8 + 4 * 12 * 8 / 7.0;
/// Bytes of a particle: position, velocity and affine matrix, twice while they are sorted; its cell
/// and two places in the order.
constexpr double kBytesPerParticle = 2 * (12 + 12 + 36) + 3 * 4;

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", value);
  return buffer;
}

std::string in_gigabytes(double bytes) { return text(bytes / 1e9) + " GB"; }

void require_positive(double value, const std::string& where) {
  if (!(value > 0) || !std::isfinite(value)) throw Error(text(value), where, "positive, finite");
}

void require_finite(const Eigen::Vector3d& value, const std::string& where) {
  if (!value.allFinite()) throw Error("a value that is not finite", where, "finite numbers");
}

void require_mesh(const TriMesh& mesh, const std::string& where) {
  if (mesh.triangle_count() == 0) throw Error("the mesh has no triangles", where, "a closed mesh");
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (!mesh.V.row(v).allFinite())
      throw Error("vertex " + std::to_string(v) + " is not finite", where, "finite numbers");
  require_closed_manifold(mesh, "tank", where);
  if (!(signed_volume(mesh.V, mesh.F) > 0))
    throw Error("the mesh is inside out", where, "triangles counter-clockwise seen from outside");
}

void require_shape(const LiquidShape& shape, const std::string& where) {
  using Kind = LiquidShape::Kind;
  if (shape.kind == Kind::mesh) return require_mesh(shape.mesh, where + ".mesh");
  require_finite(shape.centre, where + ".centre");
  if (shape.kind == Kind::box)
    for (int a = 0; a < 3; ++a) require_positive(shape.half_size[a], where + ".half_size");
  if (shape.kind == Kind::sphere || shape.kind == Kind::cylinder)
    require_positive(shape.radius, where + ".radius");
  if (shape.kind == Kind::cylinder) require_positive(shape.half_length, where + ".half_length");
  if (shape.kind == Kind::cylinder || shape.kind == Kind::half_space) {
    require_finite(shape.axis, where + ".axis");
    if (std::abs(shape.axis.norm() - 1) > 1e-6)
      throw Error("length " + text(shape.axis.norm()), where + ".axis", "a unit vector");
  }
}

Eigen::AlignedBox3d domain_of(const Tank& tank) {
  return {tank.origin, Eigen::Vector3d(tank.origin + tank.cell * tank.cells.cast<double>())};
}

void require_domain(const Tank& tank, const std::string& where) {
  require_finite(tank.origin, where + ".origin");
  require_positive(tank.cell, where + ".cell");
  for (int a = 0; a < 3; ++a)
    if (tank.cells[a] < 1)
      throw Error(std::to_string(tank.cells[a]) + " cells", where + ".cells", "at least 1");
  require_finite(tank.gravity, where + ".gravity");
  require_positive(tank.density, where + ".density");
  require_positive(tank.frame_interval, where + ".frame_interval");
  if (!(tank.duration >= 0) || !std::isfinite(tank.duration))
    throw Error(text(tank.duration), where + ".duration", "0 or more seconds");
  require_frames(tank.duration, tank.frame_interval, where + ".duration");
}

void require_memory(const Tank& tank, int particles_per_cell, double limit,
                    const std::string& where) {
  const double cells = tank.cells.cast<double>().prod();
  const double needed = memory_estimate(tank, particles_per_cell);
  const std::string grid = std::to_string(tank.cells.x()) + " x " + std::to_string(tank.cells.y()) +
                           " x " + std::to_string(tank.cells.z()) + " cells";
  const std::string problem = grid + " need about " + in_gigabytes(needed);
  if (needed > limit)
    throw Error(problem, where + ".cells", "a grid that fits into " + in_gigabytes(limit));
  if (cells > 2e9) throw Error(problem, where + ".cells", "at most 2e9 cells");
}

Eigen::AlignedBox3d moved_bounds(const PlacedSolid& solid) {
  const Eigen::AlignedBox3d bounds = solid.distance->bounds();
  if (!bounds.sizes().allFinite()) return bounds;
  Eigen::AlignedBox3d moved;
  for (int c = 0; c < 8; ++c)
    moved.extend(solid.placement * bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c)));
  return moved;
}

void require_keys(const Trajectory& motion, const std::string& where) {
  if (motion.keys.empty()) throw Error("no keys", where, "at least one key");
  for (std::size_t k = 0; k < motion.keys.size(); ++k) {
    const Keyframe& key = motion.keys[k];
    const std::string at = where + "." + std::to_string(k);
    if (!std::isfinite(key.time)) throw Error("a time that is not finite", at + ".time");
    if (k > 0 && !(key.time > motion.keys[k - 1].time))
      throw Error("time " + text(key.time) + " s after " + text(motion.keys[k - 1].time) + " s",
                  at + ".time", "times that increase");
    require_finite(key.shift, at + ".shift");
    if (!key.turn.coeffs().allFinite() || std::abs(key.turn.norm() - 1) > 1e-6)
      throw Error("a turn that is no rotation", at + ".turn", "a unit quaternion");
  }
}

/// A body may stand in a wall or pass through it; it must not be wholly outside.
void require_on_stage(const Tank& tank, const TankSolid& solid, const std::string& where) {
  const ShapeDistance distance(solid.shape, tank.cell);
  if (!distance.bounds().sizes().allFinite()) return;
  constexpr int kLooksPerFrame = 4;
  const int looks = solid.motion ? kLooksPerFrame * (tank.frame_count() - 1) : 0;
  for (int l = 0; l <= looks; ++l) {
    const double time = l * tank.frame_interval / kLooksPerFrame;
    const Eigen::AlignedBox3d box = moved_bounds(place_solid(solid, distance, time, 0));
    if (!domain_of(tank).intersects(box))
      throw Error("'" + solid.name + "' is outside the domain at " + text(time) + " s", where,
                  "a solid that stays in touch with the domain");
  }
}

/// True when a cell centre of the domain lies in the shape and in no solid.
bool has_liquid_cells(const Tank& tank, const LiquidShape& shape,
                      const std::vector<PlacedSolid>& solids) {
  const ShapeDistance distance(shape, tank.cell);
  Eigen::AlignedBox3d box = distance.bounds().intersection(domain_of(tank));
  if (box.isEmpty()) return false;
  const Eigen::Array3d h = Eigen::Array3d::Constant(tank.cell);
  const Eigen::Array3i from = ((box.min() - tank.origin).array() / h).floor().cast<int>().max(0);
  const Eigen::Array3i to =
      ((box.max() - tank.origin).array() / h).floor().cast<int>().min(tank.cells.array() - 1);
  for (int k = from.z(); k <= to.z(); ++k)
    for (int j = from.y(); j <= to.y(); ++j)
      for (int i = from.x(); i <= to.x(); ++i) {
        const Eigen::Vector3d x =
            tank.origin + tank.cell * Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5);
        if (distance(x) < 0 &&
            std::none_of(solids.begin(), solids.end(),
                         [&](const PlacedSolid& s) { return s.distance_at(x) < 0; }))
          return true;
      }
  return false;
}

void require_volumes(const Tank& tank, const std::string& where) {
  std::vector<ShapeDistance> distances;
  std::vector<PlacedSolid> solids;
  for (const TankSolid& solid : tank.solids) distances.emplace_back(solid.shape, tank.cell);
  for (std::size_t s = 0; s < tank.solids.size(); ++s)
    solids.push_back(place_solid(tank.solids[s], distances[s], 0, 0));
  for (std::size_t i = 0; i < tank.volumes.size(); ++i)
    if (!has_liquid_cells(tank, tank.volumes[i].shape, solids))
      throw Error(
          "'" + tank.volumes[i].name + "' holds no cell of the domain that is free of solids",
          where + ".volumes." + std::to_string(i) + ".shape",
          "a shape over at least one cell centre of the domain");
  for (std::size_t i = 0; i < tank.sources.size(); ++i)
    if (!has_liquid_cells(tank, tank.sources[i].shape, {}))
      throw Error("'" + tank.sources[i].name + "' holds no cell of the domain",
                  where + ".sources." + std::to_string(i) + ".shape",
                  "a shape over at least one cell centre of the domain");
}

}  // namespace

double memory_estimate(const Tank& tank, int particles_per_cell) {
  const double cells = tank.cells.cast<double>().prod();
  const Eigen::AlignedBox3d domain = domain_of(tank);
  double liquid = 0;
  const auto add = [&](const LiquidShape& shape) {
    if (shape.kind == LiquidShape::Kind::half_space) {
      liquid += cells;
      return;
    }
    LiquidShape plain = shape;
    Eigen::AlignedBox3d box;
    if (shape.kind == LiquidShape::Kind::mesh) {
      for (int v = 0; v < shape.mesh.vertex_count(); ++v)
        box.extend(Eigen::Vector3d(shape.mesh.V.row(v)));
    } else {
      plain.mesh = {};
      box = ShapeDistance(plain, tank.cell).bounds();
    }
    const Eigen::AlignedBox3d part = box.intersection(domain);
    if (!part.isEmpty()) liquid += part.volume() / std::pow(tank.cell, 3);
  };
  for (const LiquidVolume& volume : tank.volumes) add(volume.shape);
  // A source may pour until the domain is full; half of it is a guess that the caller can read.
  if (!tank.sources.empty()) liquid = std::max(liquid, 0.5 * cells);
  liquid = std::min(liquid, cells);
  return cells * kBytesPerCell +
         liquid * (kBytesPerLiquidCell + particles_per_cell * kBytesPerParticle);
}

void require_valid(const Tank& tank, int particles_per_cell, double memory_limit,
                   const std::string& where) {
  require_domain(tank, where);
  for (std::size_t i = 0; i < tank.volumes.size(); ++i) {
    const std::string at = where + ".volumes." + std::to_string(i);
    require_shape(tank.volumes[i].shape, at + ".shape");
    require_finite(tank.volumes[i].velocity, at + ".velocity");
  }
  for (std::size_t i = 0; i < tank.sources.size(); ++i) {
    const LiquidSource& source = tank.sources[i];
    const std::string at = where + ".sources." + std::to_string(i);
    require_shape(source.shape, at + ".shape");
    require_finite(source.velocity, at + ".velocity");
    if (!std::isfinite(source.from) || !std::isfinite(source.until) || source.until < source.from)
      throw Error("active from " + text(source.from) + " s until " + text(source.until) + " s",
                  at + ".until", "not before 'from'");
  }
  for (std::size_t i = 0; i < tank.solids.size(); ++i) {
    const std::string at = where + ".solids." + std::to_string(i);
    require_shape(tank.solids[i].shape, at + ".shape");
    if (tank.solids[i].motion) require_keys(*tank.solids[i].motion, at + ".motion");
  }
  require_memory(tank, particles_per_cell, memory_limit, where);
  for (std::size_t i = 0; i < tank.solids.size(); ++i)
    require_on_stage(tank, tank.solids[i], where + ".solids." + std::to_string(i));
  require_volumes(tank, where);
}

}  // namespace geoprior::fluid
