#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "solvers/skinning/projection/skin_state.h"

namespace geoprior::skinning {

/// Finds skin that faces a vertex: an opposite side that the pose has brought near, or through.
///
/// A grid of cells over the posed vertices, sorted by cell: the same order for any number of
/// threads.
class SkinProximity {
 public:
  /// @param position  posed, one a slot
  void build(const std::vector<Float4>& position);

  /// The skin that faces a vertex, as one.
  struct Facing {
    float depth;  ///< how far the vertex is behind it (m), negative: in front of it
    float sure;   ///< that there is any: in (0, 1], without jumps
  };
  /// Of the vertices within `reach` whose normal opposes that of `slot`, and which are less than
  /// half as far as at rest (the other side of the own limb has not come nearer): the mean of the
  /// planes that touch the skin there, each by its nearness and by how surely it faces. No vertex
  /// comes into it or leaves it abruptly.
  [[nodiscard]] std::optional<Facing> facing(const SkinState& state, std::size_t slot,
                                             float reach) const;

 private:
  [[nodiscard]] int cell_of(float x, int axis) const;

  const std::vector<Float4>* position_ = nullptr;
  Float4 low_{};
  float cell_ = 1;
  int size_[3] = {1, 1, 1};
  std::vector<int> offset_;  // of cells
  std::vector<int> slots_;   // by cell
  std::vector<int> cell_of_slot_, cursor_;
};

}  // namespace geoprior::skinning
