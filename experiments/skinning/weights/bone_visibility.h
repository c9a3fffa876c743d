#pragma once

#include <vector>

#include "core/connectivity.h"
#include "core/geometry/triangle_tree.h"
#include "core/inputs/skeleton.h"
#include "core/mesh.h"

namespace geoprior::skinning {

/// A bone as heat diffusion sees it: the segment from a joint's head to its tail.
struct Bone {
  int joint = 0;
  Eigen::Vector3d head;
  Eigen::Vector3d tail;

  /// Point of the segment nearest to `p`.
  [[nodiscard]] Eigen::Vector3d nearest(const Eigen::Vector3d& p) const;
};

/// Bones of all joints with a tail, in order of the joints.
std::vector<Bone> bones_of(const Skeleton& skeleton);

/// Answers whether a vertex sees a point through the inside of the mesh. Safe to ask from several
/// threads at once.
class InsideVisibility {
 public:
  /// @param mesh  kept by reference
  explicit InsideVisibility(const TriMesh& mesh);
  InsideVisibility(const InsideVisibility&) = delete;
  InsideVisibility& operator=(const InsideVisibility&) = delete;

  /// True when the segment from vertex `v` to `target` leaves the surface inwards and meets no
  /// triangle beyond its first thousandth.
  [[nodiscard]] bool sees(int v, const Eigen::Vector3d& target) const;

 private:
  [[nodiscard]] bool leaves_inwards(int v, const Eigen::Vector3d& way) const;

  const TriMesh& mesh_;
  VertexCorners corners_;
  TriangleTree tree_;
};

}  // namespace geoprior::skinning
