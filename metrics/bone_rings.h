#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/rig.h"

namespace geoprior {

/// Rings of skin about the bones of a character, chosen at rest: every vertex belongs to the joint
/// of largest weight, and to a slice of that joint's skin orthogonal to its bone.
///
/// The bone runs from the joint's head to its tail, else to the mean of its children, else on along
/// the parent's; slices go on beyond its ends and are a third of the root mean square distance of
/// the joint's skin from it long.
class BoneRings {
 public:
  explicit BoneRings(const RiggedMesh& rig);

  /// Root mean square distance of the vertex' ring from its bone at rest (m): the local radius.
  /// Absent where the joint has no bone, or the ring fewer than six vertices.
  [[nodiscard]] std::optional<double> radius(int vertex) const;

  /// Area of each vertex' ring over that at rest, by its mean square distance from the bone as the
  /// pose carries it; NaN where `radius` is absent. So a ring that is displaced from its bone has
  /// grown, by the square of the displacement over that of the radius.
  /// @param posed  n x 3 (m)
  [[nodiscard]] Eigen::VectorXd section_ratios(const Eigen::MatrixX3d& posed,
                                               const Pose& pose) const;

  [[nodiscard]] int vertex_count() const { return static_cast<int>(ring_of_.size()); }
  /// A third of the rest area of the triangles at each vertex (m^2).
  [[nodiscard]] const Eigen::VectorXd& vertex_area() const { return vertex_area_; }

 private:
  struct Ring {
    int joint = -1;
    int vertices = 0;
    double area = 0;         ///< of its vertices (m^2)
    double mean_square = 0;  ///< distance from the bone at rest, by area (m^2)
  };
  struct Axis {
    Eigen::Vector3d origin, direction;  ///< unit; zero for a joint without a bone
  };
  void make_axes(const Skeleton& skeleton);
  void make_rings(const RiggedMesh& rig);

  std::vector<Axis> axes_;    ///< of the joints
  std::vector<int> ring_of_;  ///< of each vertex; -1: none
  std::vector<Ring> rings_;
  Eigen::VectorXd vertex_area_;
};

}  // namespace geoprior
