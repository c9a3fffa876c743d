#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/inputs/rig.h"

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
  /// Of every vertex; NaN where it is absent.
  [[nodiscard]] Eigen::VectorXd radii() const;

  /// Area of each vertex' ring, or of the quarter of it (about the bone) that has changed most,
  /// over that at rest, by the mean square distance from the bone as the pose carries it; NaN where
  /// `radius` is absent. Quarters see a bulge on one side, and a ring that has left its bone: by a
  /// hundredth of the radius is about 2 %.
  /// @param posed  n x 3 (m)
  [[nodiscard]] Eigen::VectorXd section_ratios(const Eigen::MatrixX3d& posed,
                                               const Pose& pose) const;

  [[nodiscard]] int vertex_count() const { return static_cast<int>(ring_of_.size()); }
  /// A third of the rest area of the triangles at each vertex (m^2).
  [[nodiscard]] const Eigen::VectorXd& vertex_area() const { return vertex_area_; }

 private:
  static constexpr int kQuarters = 4;
  /// Skin and its squared distance from the bone.
  struct Sector {
    double area = 0;    ///< of its vertices (m^2)
    double moment = 0;  ///< sum of area times squared distance at rest (m^4)
  };
  struct Ring {
    int joint = -1;
    int vertices = 0;
    Sector whole;
    std::array<Sector, kQuarters> quarters;
  };
  struct Axis {
    Eigen::Vector3d origin, direction;  ///< unit; zero for a joint without a bone
  };
  void make_axes(const Skeleton& skeleton);
  void make_rings(const RiggedMesh& rig);
  /// Ratio of the ring or of the quarter that is farthest from 1.
  static double most_changed(const Ring& ring, const std::array<double, kQuarters>& moments);

  std::vector<Axis> axes_;       ///< of the joints
  std::vector<int> ring_of_;     ///< of each vertex; -1: none
  std::vector<int> quarter_of_;  ///< of its ring
  std::vector<Ring> rings_;
  Eigen::VectorXd vertex_area_;
};

}  // namespace geoprior
