#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/topology.h"
#include "core/inputs/rig.h"
#include "solvers/skinning/field/bones.h"
#include "solvers/skinning/field/simd.h"

namespace geoprior::skinning {

/// Why a vertex no longer moves.
enum class VertexStop : std::uint8_t {
  active,     ///< still moving, or out of iterations
  converged,  ///< |F - iso| below the tolerance
  contact,    ///< gradient discontinuity
  pit,        ///< the error grew
  no_field,   ///< zero gradient, or a vertex without bone
};

/// The skin as the per-frame passes see it: vertices sorted by bone and then along a Morton curve,
/// so that a block of consecutive vertices meets the same few bones and shares cache lines.
struct SkinState {
  static constexpr std::size_t kBlock = 64;  ///< vertices of a block of the projection

  // Fixed at construction.
  std::vector<int> vertex;       ///< mesh vertex of each slot
  std::vector<int> owner;        ///< bone, -1 for none
  std::vector<int> ring_offset;  ///< one rings in slots, compressed rows, cyclic order
  std::vector<int> ring;
  std::vector<float> ring_weight;  ///< mean-value coordinates at rest; all zero: do not relax
  std::vector<float> iso;          ///< F at rest
  std::vector<float> rest_other;   ///< largest field of other parts of the body at rest

  std::vector<Float4> rest;           ///< rest positions
  std::vector<Float4> rest_normal;    ///< unit, outward: of the field at rest
  std::vector<int> influence_offset;  ///< skinning weights, compressed rows
  std::vector<int> influence_joint;
  std::vector<float> influence_weight;

  // What one frame computes; the next one overwrites it.
  std::vector<Float4> start;    ///< positions of the base
  std::vector<Float4> outward;  ///< rest normal turned by the blended joints; no unit length
  std::vector<Float4> position;
  std::vector<Float4> next;           ///< second buffer of Jacobi passes
  std::vector<Float4> last_position;  ///< before the last step
  std::vector<Float4> gradient;       ///< of F at `last_position`; w: F - target there
  std::vector<int> last_bone;         ///< of the largest field at `last_position`
  std::vector<int> contact_bone;      ///< the other bone of a contact, -1: none
  std::vector<VertexStop> stop;
  std::vector<float> beta;  ///< contact mark
  std::vector<float> next_beta;

  // Slots still active, packed at the beginning of each block.
  std::vector<int> active;
  std::vector<int> active_count;          ///< per block
  std::vector<int> live_blocks;           ///< blocks that have any
  std::vector<std::int64_t> evaluations;  ///< bone fields sampled, per block

  SkinState(const RiggedMesh& rig, const VertexGraph& graph,
            const std::vector<int>& bone_of_vertex);

  [[nodiscard]] std::size_t size() const { return vertex.size(); }
  [[nodiscard]] std::size_t block_count() const { return active_count.size(); }

  /// Makes every vertex active that has a bone.
  void activate();
  /// Drops blocks without active vertices, keeping the order.
  void drop_dead_blocks();
};

}  // namespace geoprior::skinning
