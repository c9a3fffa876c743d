#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/inputs/skeleton.h"

namespace geoprior::skinning {

/// Where the body of a skeleton stands, by its joints at rest.
///
/// Its sides are those of x, z or y across which most joints have a mirror image (a third of those
/// off the plane, and two pairs, or it has none). Limbs are what hangs on the plane beside it: they
/// reach down, which of a standing body in any pose its legs decide, of a lying one as well; where
/// they reach aside too (of one that sits), the trunk decides. Its front is where the lowest bones
/// (feet) point. What the joints do not show is taken as glTF has it, up +y and front +z, and is a
/// doubt.
///
/// What it misjudges: a body on its hands, and one whose heels are longer than its feet.
struct Body {
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  Eigen::Vector3d front = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d left = Eigen::Vector3d::UnitX();
  bool is_symmetric = false;
  double middle = 0;     ///< of the plane of symmetry, along `left`
  double tolerance = 0;  ///< of mirror images, in the unit of the joints
  double size = 0;       ///< diagonal of the joints' box
  double lowest = 0;     ///< along `up`
  double height = 0;
  int legs = 0;  ///< limbs that reach the ground
  /// Why `up`, or `front` (and with it `left`), may be another; absent: they are found.
  std::optional<std::string> up_doubt;
  std::optional<std::string> front_doubt;

  [[nodiscard]] bool in_plane(const Eigen::Vector3d& p) const {
    return is_symmetric && std::abs(left.dot(p) - middle) <= tolerance;
  }
  [[nodiscard]] bool is_at_ground(const Eigen::Vector3d& p) const {
    return is_symmetric && up.dot(p) <= lowest + kFoot * height;
  }

  static constexpr double kFoot = 0.15;  ///< share of the height that feet are in
};

/// @param skeleton  with a joint at least
Body find_body(const Skeleton& skeleton);

}  // namespace geoprior::skinning
