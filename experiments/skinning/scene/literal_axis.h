#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

#include "core/inputs/skeleton.h"

namespace geoprior::skinning {

/// An axis in words: [world | local] (+ | -)(x | y | z).
///
///     "+x", "world +x"   the mesh's x axis, in its coordinates at rest
///     "local -z"         against the z axis of the joint's own frame at rest (Joint::frame)
struct LiteralAxis {
  bool is_local = false;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit, in the frame that is meant
};

/// Absent when the text is no such axis.
std::optional<LiteralAxis> parse_literal_axis(std::string_view text);

/// The unit direction in the coordinates of the mesh.
/// @throws Error  naming the joint, when the axis is local and the joint has no frame
Eigen::Vector3d rest_direction(const LiteralAxis& axis, const Joint& joint);

/// What an Error gives as allowed.
inline constexpr const char* kWorldAxes = "\"+x\" … \"-z\" (of the mesh)";
inline constexpr const char* kLiteralAxes =
    "\"+x\" … \"-z\" (of the mesh), \"local +x\" … \"local -z\" (the joint's own)";

}  // namespace geoprior::skinning
