#pragma once

#include <array>
#include <vector>

#include "core/inputs/rig.h"
#include "solvers/skinning/field/bones.h"
#include "solvers/skinning/field/composition.h"
#include "solvers/skinning/field/simd.h"
#include "solvers/skinning/projection/skin_state.h"

namespace geoprior::skinning {

/// The volume of the flesh about each joint, and a swelling of the skin that gives it back.
///
/// With c_j the place of joint j and m_j shares of the triangles (how far both sides of the joint
/// move them, times its turn; they sum to 1 over the joints that bend),
///
///   V_j = sum over triangles of  m_j (x_a - c_j) . ((x_b - c_j) x (x_c - c_j)) / 6
///
/// Skin that moves with one of the two bones turns about c_j, which that bone carries, and leaves
/// V_j as it is, wherever m_j ends; so what V_j loses, the skin between them has lost. The skin
/// swells along its smoothed normals by s_j p_j, p_j a bump about the joint that is less on the
/// inner side, until the loss is none; where V_j grew, it shrinks by a bump that is largest
/// on the outer side, the one that blended rotations inflate. Depends on the pose alone.
class JointVolumes {
 public:
  /// @param radius  local, of each slot (m)
  JointVolumes(const RiggedMesh& rig, const BonePartition& partition, const SkinState& state,
               const std::vector<float>& radius);

  /// Which joints bend in a pose, and where; nothing is swollen yet.
  /// @param rotations  of the slots: unit quaternions (x, y, z, w)
  void set_pose(const FieldComposition& field, const Pose& pose,
                const std::vector<Float4>& rotations);

  /// Swells `base` so that the volume of `position` comes back to first order; `position` moves
  /// with it. @return whether any joint bends
  bool restore(std::vector<Float4>& base, std::vector<Float4>& position);

 private:
  struct Triangle {
    int face;
    std::array<int, 3> slot;
    float below;     ///< weight of what hangs on the joint
    float mobility;  ///< how much the joint's turn moves it unlike a rigid piece
    float rest;      ///< six volumes of its cone at rest (m^3)
  };
  struct Swelling {
    int slot;
    float share;       ///< p_j
    float area;        ///< at rest (m^2)
    Float4 outward{};  ///< unit, at rest
    Float4 grow{};     ///< posed, for s_j = 1
    Float4 shrink{};   ///< posed, for s_j = -1, negated
  };
  struct JointFlesh {
    int joint = 0;
    int parent = 0;
    Eigen::Vector3d head;   ///< at rest
    Eigen::Vector3d along;  ///< unit, of the joint's bone at rest
    std::vector<Triangle> triangles;
    std::vector<Swelling> swellings;
    double growing = 0;     ///< dV_j / ds_j of skin that swells freely (m^2)
    double shrinking = 0;   ///< of skin that shrinks (m^2)
    double radius = 0;      ///< mean local radius of the skin that the joint moves (m)
    double swelling = 0;    ///< s_j (m)
    Float4 place{};         ///< c_j, as the joint carries it
    Float4 parent_place{};  ///< as the parent's bone does: elsewhere if a joint between them moves
    float turn = 0;         ///< of the two bones against each other, about its square (rad^2)
    bool bends = false;
  };

  /// Six volumes of the cone of a triangle over c_j (m^3).
  static float cone(const JointFlesh& flesh, const Triangle& triangle,
                    const std::vector<Float4>& position);
  /// V_j at rest less V_j (m^3).
  [[nodiscard]] double lost(const JointFlesh& flesh, const std::vector<Float4>& position);

  /// How the skin about a joint swells and shrinks in a pose.
  /// @param inner  way that the bone went, as long as the sine of half its turn
  static void set_ways(JointFlesh& flesh, const Float4& inner,
                       const std::vector<Float4>& rotations);

  std::vector<JointFlesh> joints_;
  std::vector<float> moved_;  // per face: sum of the joints' mobility times their turn
  std::vector<double> partial_;
};

}  // namespace geoprior::skinning
