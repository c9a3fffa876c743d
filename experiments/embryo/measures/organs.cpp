#include "experiments/embryo/measures/organs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "metrics/shape/surface_distance.h"

namespace geoprior::embryo {
namespace {

/// Null where the structure has none.
const TriMesh* surface_of(const RecordedDay& day, int structure) {
  const auto found = day.surfaces.find(structure);
  return found == day.surfaces.end() ? nullptr : &found->second;
}

double extent_along(const TriMesh& mesh, const Eigen::Vector3d& axis) {
  const Eigen::VectorXd along = mesh.V * axis;
  return along.maxCoeff() - along.minCoeff();
}

/// Angle of the hilum from ventral towards the median plane. The body's x points left, y dorsally:
/// for a left kidney medial is -x, for a right one +x.
double hilum_angle(const Structure& structure, const Shape& shape) {
  const Eigen::Vector3d hilum = shape.axes.col(0);
  const double medial = structure.side == "right" ? hilum.x() : -hilum.x();
  const double angle = std::atan2(medial, -hilum.y());
  return angle < -std::numbers::pi / 2 ? angle + 2 * std::numbers::pi : angle;
}

/// The vertex of the highest, or least, z.
Eigen::Vector3d pole(const TriMesh& mesh, bool upper) {
  Eigen::Index at = 0;
  if (upper) {
    mesh.V.col(2).maxCoeff(&at);
  } else {
    mesh.V.col(2).minCoeff(&at);
  }
  return mesh.V.row(at).transpose();
}

std::optional<double> interpole(const Ontology& ontology, const RecordedDay& day, int left,
                                bool upper) {
  for (std::size_t i = 0; i < ontology.structures.size(); ++i) {
    const Structure& other = ontology.structures[i];
    const bool are_pair =
        other.mirror_of == left || ontology.structures[left].mirror_of == static_cast<int>(i);
    if (!are_pair) continue;
    const TriMesh *a = surface_of(day, left), *b = surface_of(day, static_cast<int>(i));
    if (a == nullptr || b == nullptr) return std::nullopt;
    return std::abs(pole(*a, upper).x() - pole(*b, upper).x());
  }
  return std::nullopt;
}

/// Between the landmarks T12, L1 … L5, S1, linear; beyond the last two as between them. T12 is 12.
std::optional<double> vertebral_level(const Ontology& ontology, const RecordedDay& day, double z) {
  constexpr std::array<const char*, 7> kNames{"T12", "L1", "L2", "L3", "L4", "L5", "S1"};
  std::vector<double> heights;
  for (const char* name : kNames) {
    const auto code = ontology.find_structure(name);
    const RecordedShape* shape = code ? find_shape(day.shapes, *code) : nullptr;
    if (shape == nullptr) return std::nullopt;
    heights.push_back(shape->shape.center.z());
  }
  std::size_t i = 0;
  while (i + 2 < heights.size() && z < heights[i + 1]) ++i;
  return 12 + static_cast<double>(i) + (heights[i] - z) / (heights[i] - heights[i + 1]);
}

}  // namespace

std::optional<double> reading(const EmbryoScene& scene, const RecordedDay& day,
                              const std::string& quantity, std::optional<int> structure) {
  const Ontology& ontology = scene.ontology;
  if (quantity == "crown_rump_length") return day.body;
  if (!structure && quantity.starts_with("interpole")) structure = left_kidney(scene);
  if (!structure) return std::nullopt;
  const RecordedShape* recorded = find_shape(day.shapes, *structure);
  if (quantity == "branchings")
    return recorded == nullptr ? std::nullopt : std::optional(recorded->shape.branchings);
  if (quantity == "hilum_angle") {
    if (recorded == nullptr) return std::nullopt;
    return hilum_angle(ontology.structures[*structure], recorded->shape);
  }
  if (quantity == "vertebral_level") {
    if (recorded == nullptr) return std::nullopt;
    return vertebral_level(ontology, day, recorded->shape.center.z());
  }
  if (quantity == "interpole_upper" || quantity == "interpole_lower")
    return interpole(ontology, day, *structure, quantity == "interpole_upper");
  const TriMesh* surface = surface_of(day, *structure);
  if (surface == nullptr) return std::nullopt;
  if (quantity == "upper_pole_height") return pole(*surface, true).z();
  if (quantity == "lower_pole_height") return pole(*surface, false).z();
  if (quantity == "kidney_length" && recorded != nullptr)
    return extent_along(*surface, recorded->shape.axes.col(2));
  return std::nullopt;
}

std::optional<int> left_kidney(const EmbryoScene& scene) {
  for (std::size_t i = 0; i < scene.ontology.structures.size(); ++i) {
    const Structure& one = scene.ontology.structures[i];
    if (one.kind == "kidney" && one.side == "left" && !scene.healthy_effects.absent[i])
      return static_cast<int>(i);
  }
  return std::nullopt;
}

std::optional<double> mirror_error(const EmbryoScene& scene, const RecordedDay& day) {
  if (scene.disease) return std::nullopt;
  std::optional<double> worst;
  for (const auto& [code, mesh] : day.surfaces) {
    const auto partner = scene.ontology.structures[code].mirror_of;
    if (!partner) continue;
    const TriMesh* other = surface_of(day, *partner);
    if (other == nullptr) return 1;  // one of a pair alone
    Eigen::MatrixX3d mirrored = mesh.V;
    mirrored.col(0) *= -1;
    worst = std::max(worst.value_or(0), largest_distance(mirrored, *other) / day.body);
  }
  return worst;
}

std::optional<double> duct_end_gap(const EmbryoScene& scene, const Frame& frame) {
  const Part* part = frame.find_part(recorded::kCentrelines);
  if (part == nullptr) return std::nullopt;
  const NamedArray& codes =
      part->require_array(recorded::kStructure, NamedArray::On::cells, 1, recorded::kCentrelines);
  std::vector<RecordedShape> shapes = recorded_shapes(frame);
  // Ducts that are anchors themselves: their shapes are their recorded lines.
  for (RecordedShape& one : shapes) {
    for (std::size_t l = 0; l < part->lines.size(); ++l) {
      if (static_cast<int>(codes.values(static_cast<Eigen::Index>(l), 0)) != one.structure)
        continue;
      for (const int i : part->lines[l])
        one.shape.points.push_back(part->points.row(i).transpose());
    }
  }
  std::optional<double> worst;
  for (std::size_t l = 0; l < part->lines.size(); ++l) {
    const int code = static_cast<int>(codes.values(static_cast<Eigen::Index>(l), 0));
    const Structure& duct = scene.ontology.structures[code];
    const Key *key = nullptr, *next = nullptr;
    for (const Key& one : duct.keys) {
      if (key == nullptr || one.day <= frame.parameter) key = &one;
      if (next == nullptr && one.day >= frame.parameter) next = &one;
    }
    if (key == nullptr) continue;
    if (next == nullptr) next = key;
    const auto gap = [&](const Anchor& anchor, const Anchor& later, int point) {
      // Between key frames with other anchors the end is on its way from one to the other.
      if (!anchor.structure || anchor.structure != later.structure || anchor.at != later.at) return;
      const RecordedShape* shape = find_shape(shapes, *anchor.structure);
      if (shape == nullptr) return;
      // A point on a duct is on its recorded line only up to how finely that is sampled: its ends.
      if (shape->shape.primitive == Primitive::duct && anchor.at.z() != 0 && anchor.at.z() != 1)
        return;
      const Eigen::Vector3d x = part->points.row(point).transpose();
      const double distance = (x - anchor_point(shape->shape, anchor.at)).norm();
      worst = std::max(worst.value_or(0), distance / crown_rump_length(frame));
    };
    gap(key->geometry.start, next->geometry.start, part->lines[l].front());
    gap(key->geometry.end, next->geometry.end, part->lines[l].back());
  }
  return worst;
}

}  // namespace geoprior::embryo
