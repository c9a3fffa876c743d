#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <string_view>

#include "models/grammar/maps/spatial_map.h"

namespace geoprior::grammar {

/// Kinds of deformations, the symbols of the language.
enum class DeltaKind {
  identity,
  free,           ///< any map of space
  rigid,          ///< a motion, one an element
  affine,         ///< an affine map, one an element
  translate,      ///< a shift, one an element
  extrude,        ///< a parameter that is a length grows by an amount
  set_parameter,  ///< a parameter gets a value
  children        ///< the number of children is to change by an amount
};
std::string_view name_of(DeltaKind kind);

/// Who asks an element for a deformation.
enum class Origin { user, parent, child, self };
std::string_view name_of(Origin origin);

/// First up to the element that bounds the locality, then down from it.
enum class Phase { up, down };
std::string_view name_of(Phase phase);

/// A deformation that is asked for. What the kind does not need is unused.
struct Delta {
  DeltaKind kind = DeltaKind::identity;
  std::shared_ptr<const SpatialMap> map = {};               ///< free
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();  ///< rigid, affine, translate
  int parameter = 0;                                        ///< extrude, set_parameter
  double value = 0;  ///< extrude: by how much (m); set_parameter: the value; children: by how many

  static Delta free(std::shared_ptr<const SpatialMap> map) {
    return {DeltaKind::free, std::move(map)};
  }
  static Delta rigid(const Eigen::Affine3d& transform) { return {DeltaKind::rigid, {}, transform}; }
  static Delta translate(const Eigen::Vector3d& shift) {
    return {DeltaKind::translate, {}, Eigen::Affine3d(Eigen::Translation3d(shift))};
  }
  static Delta extrude(int parameter, double by) {
    return {DeltaKind::extrude, {}, Eigen::Affine3d::Identity(), parameter, by};
  }
  static Delta children(int by) {
    return {DeltaKind::children, {}, Eigen::Affine3d::Identity(), 0, static_cast<double>(by)};
  }
  static Delta set(int parameter, double value) {
    return {DeltaKind::set_parameter, {}, Eigen::Affine3d::Identity(), parameter, value};
  }
};

}  // namespace geoprior::grammar
