#include "baselines/skinning/linear_blend.h"

#include "core/error.h"
#include "core/parallel.h"
#include "models/skinning/lanes.h"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace geoprior::skinning {
namespace {

using lanes::Double4;

/// Upper three rows of a transform, padded to two cache lines: a joint's index becomes its address
/// by one shift.
struct alignas(128) Rows {
  std::array<double, 12> row;
};

struct Blended {
  Double4 row0, row1, row2;
};

template <int lane>
[[gnu::always_inline]] inline void add(const Rows* table, std::uint16_t joint,
                                       const Double4& weights, Blended& sum) {
  const double* row = table[joint].row.data();
  const Double4 w = lanes::spread<lane>(weights);
  sum.row0 = lanes::multiply_add(w, lanes::load(row), sum.row0);
  sum.row1 = lanes::multiply_add(w, lanes::load(row + 4), sum.row1);
  sum.row2 = lanes::multiply_add(w, lanes::load(row + 8), sum.row2);
}

/// Rows of the blended matrix of one vertex. `Slots` > 0 is the number of influences known when
/// compiling; 0 asks the block. The strongest influence comes last: its weight is known last.
template <int Slots, int lane>
[[gnu::always_inline]] inline Blended blend(const Rows* table, const lanes::Block& block,
                                            const Double4& first_weight) {
  Blended sum{lanes::all(0), lanes::all(0), lanes::all(0)};
  const int slots = Slots > 0 ? Slots : block.slots;
#pragma GCC unroll 4
  for (int s = 1; s < slots; ++s) {
    add<lane>(table, block.joints[4 * s + lane], lanes::load(block.weights + 4 * (s - 1)), sum);
  }
  add<lane>(table, block.joints[lane], first_weight, sum);
  return sum;
}

/// One row of four blended matrices, applied to the four rest positions.
[[gnu::always_inline]] inline Double4 apply(Double4 a, Double4 b, Double4 c, Double4 d,
                                            const Double4& x, const Double4& y, const Double4& z) {
  lanes::transpose(a, b, c, d);
  return lanes::multiply_add(a, x, lanes::multiply_add(b, y, lanes::multiply_add(c, z, d)));
}

template <int Slots>
[[gnu::always_inline]] inline void blend_block(const Rows* table, const lanes::Block& block,
                                               Double4& x, Double4& y, Double4& z) {
  const Double4 w = lanes::first_weight(block);
  const Blended a = blend<Slots, 0>(table, block, w), b = blend<Slots, 1>(table, block, w),
                c = blend<Slots, 2>(table, block, w), d = blend<Slots, 3>(table, block, w);
  const Double4 rest_x = lanes::load(block.rest), rest_y = lanes::load(block.rest + 4),
                rest_z = lanes::load(block.rest + 8);
  x = apply(a.row0, b.row0, c.row0, d.row0, rest_x, rest_y, rest_z);
  y = apply(a.row1, b.row1, c.row1, d.row1, rest_x, rest_y, rest_z);
  z = apply(a.row2, b.row2, c.row2, d.row2, rest_x, rest_y, rest_z);
}

}  // namespace

LinearBlend::LinearBlend(const RiggedMesh& rig) : influences_(rig) {}

void LinearBlend::deform(const Pose& pose, Eigen::MatrixX3d& posed) const {
  if (static_cast<int>(pose.size()) != influences_.joint_count) {
    throw Error("pose of " + std::to_string(pose.size()) + " transforms", "linear blend",
                std::to_string(influences_.joint_count));
  }
  lanes::JointTable<Rows> table(pose.size());
  for (std::size_t j = 0; j < pose.size(); ++j)
    Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(table[j].row.data()) =
        pose[j].matrix().topRows<3>();
  posed.resize(influences_.vertex_count, 3);
  const auto kernel = [T = table.data()](const lanes::Block& block, Double4& x, Double4& y,
                                         Double4& z) {
    switch (block.slots) {
      case 1:
        return blend_block<1>(T, block, x, y, z);
      case 2:
        return blend_block<2>(T, block, x, y, z);
      case 3:
        return blend_block<3>(T, block, x, y, z);
      case 4:
        return blend_block<4>(T, block, x, y, z);
      default:
        return blend_block<0>(T, block, x, y, z);
    }
  };
  parallel_blocks(influences_.chunk_slots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk)
      lanes::for_chunk(influences_, chunk, posed, kernel);
  });
}

}  // namespace geoprior::skinning
