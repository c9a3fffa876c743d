#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/inputs/rig.h"
#include "models/grammar/hierarchy/hierarchy.h"
#include "models/grammar/maps/spatial_map.h"
#include "models/grammar/record.h"

/// Older deformers of objects that are hierarchies here, by the code of the topics that are about
/// them: what the same deformers written as rules are held against. The third of them, free-form
/// deformation, is `free_form`.
namespace geoprior::grammar {

/// Rigid parts on a chain or tree of joints, by skinning: the skeleton's forward kinematics, then
/// linear blend skinning with one influence of weight 1 a point.
///
/// Joints are the elements of type "joint", with their heads where these are at rest, and the root,
/// of which a turn moves everything. Every other element is rigid with the nearest joint above it.
/// Tags are not known here: what hangs on a joint goes with it.
class RigidParts {
 public:
  /// @param rest  outlives this
  explicit RigidParts(const Hierarchy& rest);
  explicit RigidParts(Hierarchy&&) = delete;

  /// Turns a joint, or the one that the element is rigid with, about where its head is now; what
  /// hangs on it goes with it.
  /// @param rotation  in the axes of the world
  void turn(int element, const Eigen::Quaterniond& rotation);

  /// Key points and triangles, skinned.
  [[nodiscard]] Geometry geometry(bool with_surface) const;
  /// Writes the elements' poses into a copy of the rest.
  void place(Hierarchy& state) const;

 private:
  [[nodiscard]] Eigen::MatrixX3d skinned(const Eigen::MatrixX3d& points,
                                         const std::vector<int>& element) const;

  const Hierarchy& rest_;
  Skeleton skeleton_;
  std::vector<int> joint_of_;  ///< of each element
  std::vector<JointRotation> rotations_;
  geoprior::Pose pose_;  ///< of the joints
};

/// Items on a triangle mesh that a map deforms, carried along as details are: the root's points go
/// where the map takes them, items that are present stay in their place on their triangle (naive
/// stretch of the topic `details`), and turn as its frame does, tangent along the first edge.
///
/// An item that stands off its place keeps its offset in that frame. Sizes stay.
/// @param before  a root with points and triangles, and elements with the parameters of an "item"
///                (models/grammar/objects/surface_set.h), at least three of them present
/// @throws Error  naming surface or item: what no mesh of details can be built of
Hierarchy carried_details(const Hierarchy& before, const SpatialMap& map);

}  // namespace geoprior::grammar
