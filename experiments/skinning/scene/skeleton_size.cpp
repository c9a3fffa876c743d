#include "experiments/skinning/scene/skeleton_size.h"

#include <Eigen/Geometry>

#include "core/error.h"
#include "experiments/skinning/scene/skeleton_file.h"
#include "testbed/runner/number_text.h"

namespace geoprior::skinning {
namespace {

/// The box of no points has no size.
double size_of(const Eigen::AlignedBox3d& box) { return box.isEmpty() ? 0 : box.diagonal().norm(); }

struct Sizes {
  double of_file = 0;
  double of_character = 0;
};

Sizes namesake_sizes(const Skeleton& skeleton, const Skeleton& own) {
  Eigen::AlignedBox3d of_file, of_character;
  for (const Joint& joint : skeleton.joints) {
    const auto namesake = find_joint(own, joint.name);
    if (!namesake) continue;
    of_file.extend(joint.head);
    of_character.extend(own.joints[*namesake].head);
  }
  return {size_of(of_file), size_of(of_character)};
}

Sizes sizes_with_mesh(const Skeleton& skeleton, const TriMesh& mesh) {
  Eigen::AlignedBox3d of_file, of_character;
  for (const Joint& joint : skeleton.joints) {
    of_file.extend(joint.head);
    of_file.extend(joint.tail.value_or(joint.head));
  }
  for (const auto& x : mesh.V.rowwise()) of_character.extend(x.transpose());
  return {size_of(of_file), size_of(of_character)};
}

void require_ratio(const Sizes& sizes, double least, double most, const std::string& what,
                   const std::string& name) {
  if (!(sizes.of_file > 0) || !(sizes.of_character > 0)) return;  // a point has any size
  const double ratio = sizes.of_file / sizes.of_character;
  if (ratio >= least && ratio <= most) return;
  throw Error("the skeleton is " + rounded_text(ratio, 3) + " times as large as " + what + " (" +
                  rounded_text(sizes.of_file, 3) + " m, " + rounded_text(sizes.of_character, 3) +
                  " m)",
              name,
              rounded_text(least, 2) + " to " + rounded_text(most, 2) +
                  "; skeleton files are in metres, unit_m scales the character");
}

}  // namespace

void require_size(const Skeleton& skeleton, const Skeleton& own, const TriMesh& mesh,
                  const std::string& name) {
  const Sizes namesakes = namesake_sizes(skeleton, own);
  if (namesakes.of_character > 0) {
    require_ratio(namesakes, 1.0 / 3, 3, "that of the character", name);
  } else {
    require_ratio(sizes_with_mesh(skeleton, mesh), 0.15, 3, "the mesh", name);
  }
}

}  // namespace geoprior::skinning
