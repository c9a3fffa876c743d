#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/inputs/rig.h"

namespace geoprior::skinning {

/// @throws Error  when the weights are no partition of unity (names the vertex), a position is not
/// finite, or there are more than 65535 joints
void require_skinnable(const RiggedMesh& rig);

/// Rest positions and influences of every vertex, packed for streaming: what linear and dual
/// quaternion blending read.
///
/// Vertices keep their order and are taken four at a time ("block"; the last one is filled with
/// copies). A block has as many influence slots as its vertex with most; slot 0 is the strongest
/// influence of each vertex. Weights are floats, and that of slot 0 is not stored: it is one minus
/// the others, so that the weights of a vertex sum to 1 to double precision. With four influences a
/// vertex costs 24 (rest) + 8 (joints) + 12 (weights) + 0.5 (slot count) bytes read and 24 written.
struct PackedInfluences {
  static constexpr int kLanes = 4;
  static constexpr int kChunkBlocks = 128;  ///< blocks of a task: 512 vertices

  /// @throws Error  as require_skinnable()
  explicit PackedInfluences(const RiggedMesh& rig);

  int vertex_count = 0;
  int joint_count = 0;
  double bytes_per_vertex = 0;  ///< moved by one pass, output included

  std::vector<double> rest;              ///< per block: 4 x, 4 y, 4 z
  std::vector<std::uint16_t> slots;      ///< per block: influences of its vertices, >= 1
  std::vector<std::uint16_t> joints;     ///< per block and slot: 4 joints
  std::vector<float> weights;            ///< per block and slot >= 1: 4 weights
  std::vector<std::size_t> chunk_slots;  ///< slots of all blocks before each chunk of kChunkBlocks
};

}  // namespace geoprior::skinning
