#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/rig.h"

namespace geoprior {

/// Rest positions and influences of every vertex, packed for streaming: what linear and dual
/// quaternion blending read.
///
/// The layout is the owner's choice (measured in benchmarks/); `bytes_per_vertex` is what one pass
/// moves, output included, and is what the fraction of the copy bandwidth is computed from.
struct PackedInfluences {
  explicit PackedInfluences(const RiggedMesh& rig);

  int vertex_count = 0;
  int joint_count = 0;
  double bytes_per_vertex = 0;
};

}  // namespace geoprior
