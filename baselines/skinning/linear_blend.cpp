#include "baselines/skinning/linear_blend.h"

#include "baselines/skinning/lanes.h"
#include "core/error.h"
#include "core/parallel.h"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace geoprior {
namespace {

using lanes::Double4;

static_assert(sizeof(Eigen::Affine3d) == 16 * sizeof(double));

/// Columns of the blended 3 x 4 matrix of one vertex, applied to its rest position.
[[gnu::always_inline]] inline Double4 blend(const Eigen::Affine3d* pose, const lanes::Block& block,
                                            const Double4& first_weight, int lane) {
  const double* T = pose[block.joints[lane]].data();
  const Double4 w = lanes::all(first_weight[lane]);
  Double4 c0 = w * lanes::load(T), c1 = w * lanes::load(T + 4), c2 = w * lanes::load(T + 8),
          c3 = w * lanes::load(T + 12);
  for (int s = 1; s < block.slots; ++s) {
    T = pose[block.joints[4 * s + lane]].data();
    const Double4 ws = lanes::all(static_cast<double>(block.weights[4 * (s - 1) + lane]));
    c0 += ws * lanes::load(T);
    c1 += ws * lanes::load(T + 4);
    c2 += ws * lanes::load(T + 8);
    c3 += ws * lanes::load(T + 12);
  }
  return (c0 * lanes::all(block.rest[lane]) + c1 * lanes::all(block.rest[4 + lane])) +
         (c2 * lanes::all(block.rest[8 + lane]) + c3);
}

}  // namespace

LinearBlend::LinearBlend(const RiggedMesh& rig) : influences_(rig) {}

void LinearBlend::deform(const Pose& pose, Eigen::MatrixX3d& posed) const {
  if (static_cast<int>(pose.size()) != influences_.joint_count) {
    throw Error("pose of " + std::to_string(pose.size()) + " transforms", "linear blend",
                std::to_string(influences_.joint_count));
  }
  posed.resize(influences_.vertex_count, 3);
  const auto kernel = [T = pose.data()](const lanes::Block& block, Double4& x, Double4& y,
                                        Double4& z) {
    const Double4 w = lanes::first_weight(block);
    x = blend(T, block, w, 0);
    y = blend(T, block, w, 1);
    z = blend(T, block, w, 2);
    Double4 homogeneous = blend(T, block, w, 3);
    lanes::transpose(x, y, z, homogeneous);
  };
  parallel_blocks(influences_.chunk_slots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk)
      lanes::for_chunk(influences_, chunk, posed, kernel);
  });
}

}  // namespace geoprior
