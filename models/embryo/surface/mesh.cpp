#include "models/embryo/surface/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include "core/disjoint_sets.h"
#include "core/error.h"
#include "core/parallel.h"
#include "models/embryo/surface/marching.h"

namespace geoprior::embryo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Triangles per squared box edge of surface, on average over its directions, measured.
constexpr double kTrianglesPerSquare = 11;
constexpr int kMostEmpty = 3;             ///< lattices that find no surface
constexpr double kLeastShare = 1.0 / 32;  ///< of a surface: what has less is all but swallowed
constexpr double kThinnestNeck = 0.01;    ///< in smallest radii
constexpr double kNeckCells = 0.25;       ///< box edge in thicknesses t of the neck
constexpr double kNeckWidthCells = 0.4;   ///< box edge along a neck's width in (r t)^(1/2)
constexpr double kSeptumCells = 0.35;     ///< box edge in thicknesses of the septum

std::string field_name(const SolidField& field) {
  return "structure " + std::to_string(field.solids().front().structure);
}

/// Box edge at which a surface of that area has the wanted number of triangles.
double edge_for(double area, int triangles) {
  return std::sqrt(kTrianglesPerSquare * area / std::max(triangles, 1));
}

/// In the unit ball that the ovoid is scaled to: how deep a half of it is, across the plane.
double depth_of_half(const SolidField& field) {
  const Solid& solid = field.solids().front();
  const Septum& septum = *solid.septum;
  const double extent =
      (solid.shape.axes.transpose() * septum.normal).cwiseProduct(solid.shape.radii).norm();
  const double center = septum.normal.dot(septum.point - solid.shape.center);
  const double depth = 1 - (septum.side * center + septum.thickness / 2) / extent;
  if (!(depth > kThinnestNeck))
    throw Error("its dividing plane leaves nothing on its side", field_name(field),
                "planes that cross the whole");
  return std::min(depth, 2.0);
}

Lattice ovoid_lattice(const SolidField& field, const SurfaceOptions& options) {
  const Shape& shape = field.solids().front().shape;
  double edge = std::min(options.cell, edge_for(4 * std::numbers::pi, options.triangles));
  if (field.solids().front().septum) edge = std::min(edge, options.cell * depth_of_half(field) / 2);
  return {shape.axes, shape.center, edge * shape.radii};
}

/// What is left to divide, in the plane of a septum, along the lattice's axes from its point.
struct Neck {
  double aside = 0, down = 0;  ///< of its middle (m)
  double thickness = 0;        ///< along the descent, where it is thickest; 0: it is cut through
};

/// Of the columns along the descent below the tip, in a grid of them, the one that is longest
/// inside the divided solid.
Neck find_neck(const SolidField& field, const Septum& septum, const Matrix3d& axes) {
  constexpr int kColumns = 64, kSteps = 128;
  const auto from_point = [&](const Vector3d& direction) {
    return field.support(direction) - direction.dot(septum.point);
  };
  const double low = -from_point(-axes.col(0)), high = from_point(axes.col(0));
  const double top = std::max(septum.tip, -from_point(-axes.col(1))), end = from_point(axes.col(1));
  Neck neck{0.5 * (low + high), end, 0};
  const double step = (end - top) / kSteps;
  for (int i = 0; i <= kColumns && step > 0; ++i) {
    const double aside = low + (high - low) * i / kColumns;
    double inside = 0, sum = 0;
    for (int j = 0; j < kSteps; ++j) {
      const double down = top + (j + 0.5) * step;
      if (field.value(septum.point + aside * axes.col(0) + down * axes.col(1)) >= 0) continue;
      inside += step;
      sum += step * down;
    }
    if (inside > neck.thickness) neck = {aside, sum / inside, inside};
  }
  return neck;
}

/// Axes: aside, along the descent, across the septum. Boxes grow from the neck and the septum, to
/// the edge they would have without them.
///
/// A sheet that only one layer of the lattice meets would have holes: across the neck boxes are so
/// flat that its thin rim is narrower than a box.
Lattice septum_lattice(const SolidField& field, const Septum& septum, double edge) {
  Lattice lattice;
  const Vector3d z = septum.normal;
  const Vector3d y = (septum.descent - septum.descent.dot(z) * z).normalized();
  if (!y.allFinite())
    throw Error("its septum descends along its own normal", field_name(field),
                "directions within the dividing plane");
  lattice.axes << y.cross(z), y, z;
  const Neck neck = find_neck(field, septum, lattice.axes);
  lattice.origin = septum.point + neck.aside * lattice.axes.col(0) + neck.down * y;
  lattice.spacing << edge, edge, std::min(edge, kSeptumCells * septum.thickness);
  if (neck.thickness > 0) {
    const double thick = std::max(neck.thickness, kThinnestNeck * field.smallest_radius());
    lattice.spacing.x() =
        std::min(edge, kNeckWidthCells * std::sqrt(thick * field.smallest_radius()));
    lattice.spacing.y() = std::min(edge, kNeckCells * thick);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d direction = lattice.axes.col(axis);
    const double center = direction.dot(lattice.origin), s = lattice.spacing[axis];
    const double extent =
        std::max(field.support(direction) - center, field.support(-direction) + center);
    lattice.growth[axis] = std::sqrt(std::max(edge * edge - s * s, 0.0)) / extent;
  }
  return lattice;
}

Lattice choose_lattice(const SolidField& field, const SurfaceOptions& options) {
  const std::vector<Solid>& solids = field.solids();
  const auto cut = std::find_if(solids.begin(), solids.end(), [](const Solid& solid) {
    return solid.septum && solid.septum->side == 0;
  });
  if (solids.size() == 1 && cut == solids.end() &&
      solids.front().shape.primitive == Primitive::ovoid)
    return ovoid_lattice(field, options);
  const double edge = std::min(options.cell * field.smallest_radius(),
                               edge_for(field.area_estimate(), options.triangles));
  if (cut != solids.end()) return septum_lattice(field, *cut->septum, edge);
  Lattice lattice;
  lattice.spacing.setConstant(edge);
  return lattice;
}

/// Triangles of the member that has fewest.
int fewest_triangles(const MarchedSurface& surface, std::size_t members) {
  std::vector<int> counts(members, 0);
  for (const int member : surface.member_of_triangle) ++counts[member];
  int fewest = surface.mesh.triangle_count();
  for (const int count : counts)
    if (count >= kLeastShare * surface.mesh.triangle_count()) fewest = std::min(fewest, count);
  return fewest;
}

Septum septum_of(const Cut& cut, int side) {
  return {cut.normal.normalized(), cut.point, cut.descent.normalized(), cut.tip,
          cut.thickness,           side};
}

/// The solids of a day by structure: those that exist, with their septa, and products as halves.
std::map<int, Solid> solids_of(const DayState& day) {
  std::map<int, Solid> out;
  for (const StructureState& state : day.structures)
    if (is_solid(state.shape.primitive)) out[state.structure] = {state.structure, state.shape, {}};
  for (const Cut& cut : day.cuts) {
    const auto whole = out.find(cut.whole);
    if (whole != out.end()) whole->second.septum = septum_of(cut, 0);
  }
  for (const Half& half : day.halves)
    out[half.product] = {half.product, half.shape, septum_of(half.cut, half.sign < 0 ? -1 : 1)};
  return out;
}

}  // namespace

StructureMesh solid_mesh(const SolidField& field, const SurfaceOptions& options) {
  if (!(options.cell > 0)) throw Error("cell out of range", "", "positive ratios");
  Lattice lattice = choose_lattice(field, options);
  MarchOptions march_options;
  march_options.most_triangles = options.most_triangles;
  MarchedSurface surface = march(field, lattice, march_options, field_name(field));
  // The area was an estimate: of what is cut or overlaps there is less, and of a group each member
  // has a part of it.
  for (int attempt = 0;; ++attempt) {
    const int found = fewest_triangles(surface, field.solids().size());
    if (found >= options.triangles) break;
    if (found == 0 && attempt == kMostEmpty)
      throw Error("nothing of it is left to draw", field_name(field),
                  "solids that no plane and no septum takes away");
    lattice.spacing *= 0.95 * std::sqrt(double(std::max(found, 200)) / options.triangles);
    surface = march(field, lattice, march_options, field_name(field));
  }
  StructureMesh out;
  for (const Solid& solid : field.solids()) out.structures.push_back(solid.structure);
  out.mesh = std::move(surface.mesh);
  out.structure_of_triangle.reserve(surface.member_of_triangle.size());
  for (const int member : surface.member_of_triangle)
    out.structure_of_triangle.push_back(out.structures[member]);
  out.deviation = surface.deviation;
  return out;
}

std::vector<SolidField> day_fields(const DayState& day, const SurfaceOptions& options) {
  const std::map<int, Solid> solids = solids_of(day);
  const int last = solids.empty() ? -1 : solids.rbegin()->first;
  DisjointSets groups(last + 1);
  std::vector<double> blend(last + 1, 0.0);  // of a structure: the widest that it takes part in
  for (const FusedGroup& group : day.fused) {
    std::optional<int> first;
    for (const int member : group.members) {
      if (!solids.contains(member)) continue;
      if (first) groups.join(*first, member);
      first = member;
      blend[member] = std::max(blend[member], group.blend);
    }
  }
  std::map<int, std::vector<Solid>> members;  // by the least structure
  for (const auto& [structure, solid] : solids) members[groups.find(structure)].push_back(solid);
  std::vector<SolidField> out;
  for (auto& [least, group] : members) {
    double widest = 0;
    for (const Solid& solid : group) widest = std::max(widest, blend[solid.structure]);
    out.emplace_back(std::move(group), widest, !options.blend);
  }
  return out;
}

std::vector<StructureMesh> day_meshes(const DayState& day, const SurfaceOptions& options) {
  const std::vector<SolidField> fields = day_fields(day, options);
  std::vector<StructureMesh> out(fields.size());
  parallel_blocks(fields.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out[i] = solid_mesh(fields[i], options);
  });
  return out;
}

}  // namespace geoprior::embryo
