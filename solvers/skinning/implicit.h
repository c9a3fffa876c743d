#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/context.h"
#include "core/inputs/rig.h"
#include "solvers/skinning/implicit_options.h"

namespace geoprior::skinning {

/// Implicit skinning (thesis 3.1; Vaillant et al. 2013): skin that blends the motion of its joints,
/// corrected by a field that knows what the skin encloses.
///
/// Once, in the rest pose: the skin is split among the bones; each part is turned into a field
/// f_b in [0, 1] by Hermite radial basis functions (hrbf.h, eq. 3.1) and compact support; every
/// vertex remembers iso = F(rest position) of the composed field F, which keeps the details that
/// the smooth fields do not have.
/// Per pose: the fields move rigidly with their bones and meet through the operators of the joints
/// (composition.h). By default the base (base/base_skin.h, over weights that are spread) is
/// corrected by one smooth displacement of all vertices (smooth/projection.h). As published
/// (`ProjectionKind::marching`) vertices start at their dual quaternion positions, or those of
/// another base, and march along grad F to their iso-value (projection.h, eq. 3.2 with its sign
/// corrected), spread by tangential relaxation (relaxation.h); they stop where the gradient turns:
/// a contact, smoothed at the end (contact_smoothing.h).
///
/// It keeps the volume of joints and resolves contact at vertices, without collision detection. It
/// does not know time: each pose is solved from its base, so a vertex that starts on the far side
/// of a bone it should not have entered stays there (but with tracking). Details thinner than the
/// spacing of the samples are only carried along.
class ImplicitSkinning {
 public:
  /// Samples, HRBF fields, caches and rest iso-values.
  /// @param rig      welded closed mesh of n vertices, skeleton of m joints, weights n x m
  /// @param context  its seed places the samples
  /// @throws Error   for an open or non-manifold mesh (names edges), bad weights or skeleton, an
  ///                 unknown joint in `options.joint_blends`, or a rig none of whose joints has
  ///                 skin
  ImplicitSkinning(const RiggedMesh& rig, const ImplicitOptions& options, RunContext& context);
  ~ImplicitSkinning();
  ImplicitSkinning(ImplicitSkinning&&) noexcept;
  ImplicitSkinning& operator=(ImplicitSkinning&&) noexcept;

  /// Writes the posed positions (n x 3, metres). Phases "start", "projection", "relaxation",
  /// "smoothing". No allocation once warm; the same bits for any number of threads.
  /// @param pose   m transforms; parts that are not rigid are dropped
  /// @throws Error unless `pose` has m finite transforms
  void deform(const Pose& pose, Eigen::MatrixX3d& posed, RunContext& context);

  /// Whether `deform` begins where the call before ended (`ProjectionKind::tracking`): poses must
  /// come in order, and the first is reached from rest.
  [[nodiscard]] bool path_dependent() const;
  /// The next call of `deform` is the first of a path.
  void restart();

  /// What the last call of `deform` did: `evaluations_per_vertex` (bone fields sampled),
  /// `iterations`, `field_error_rms` and `field_error_max` (|F - target| of vertices that neither
  /// stopped in contact nor were smoothed), `stopped_fraction` (in contact), `unfinished_fraction`
  /// (out of iterations), `contact_gap_max` (|f1 - f2| at stopped vertices after smoothing).
  [[nodiscard]] std::map<std::string, double> diagnostics() const;

  /// F - iso of every vertex at given positions (n x 3) in the pose of the last deform; the
  /// vertex' own part of the body only. 0 for vertices without a bone.
  [[nodiscard]] Eigen::VectorXd field_error(const Eigen::MatrixX3d& positions) const;

  /// Samples of all bones in the rest pose, for drawing.
  struct Samples {
    Eigen::MatrixX3d points;   ///< metres
    Eigen::MatrixX3d normals;  ///< unit
    std::vector<int> joint;    ///< whose bone it belongs to
    std::vector<bool> is_cap;
  };
  [[nodiscard]] Samples samples() const;

  /// Memory of the field caches.
  [[nodiscard]] std::size_t cache_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace geoprior::skinning
