#pragma once

#include <Eigen/Core>

#include "core/mesh.h"
#include "core/random.h"
#include "solvers/skinning/field/bones.h"
#include "solvers/skinning/implicit_options.h"

namespace geoprior::skinning {

/// Points and unit outward normals to which the field of one bone is fitted.
struct BoneSamples {
  Eigen::MatrixX3d points;   ///< rest pose, metres
  Eigen::MatrixX3d normals;  ///< unit
  int cap_count = 0;         ///< the last rows are caps on the bone's axis
};

/// Poisson-disk samples on the part of the skin that a bone owns, with caps at its joints.
///
/// Candidates are spread over the triangles whose vertices all belong to the bone, by area, and
/// dropped near joints (trimming) and where the skin folds back towards the bone (fold test). Dart
/// throwing in random order keeps those farther apart than a radius, which is bisected until
/// `options.samples` are left. If trimming leaves fewer than a third of the candidates it is given
/// up for that bone (short bones, torsos beside their bone). Caps close the field beyond a joint
/// like a hemisphere: one sample on the axis, as far from the joint as the nearest sample.
///
/// @param normals  of the mesh's vertices, unit
/// Source: Vaillant et al. 2013, section 4; trimming fractions from an independent implementation.
BoneSamples sample_bone(const TriMesh& mesh, const Eigen::MatrixX3d& normals,
                        const BonePartition& partition, int bone, const SamplingOptions& options,
                        RandomStream random);

}  // namespace geoprior::skinning
