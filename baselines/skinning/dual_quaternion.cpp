#include "baselines/skinning/dual_quaternion.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>

#include "core/error.h"
#include "core/parallel.h"
#include "models/skinning/lanes.h"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace geoprior::skinning {
namespace {

using lanes::Double4;

/// Unit dual quaternion, coefficients in the order x, y, z, w.
struct alignas(32) DualQuaternion {
  std::array<double, 4> real;
  std::array<double, 4> dual;
};

/// Rotation of a transform. Rounding of a rotation is removed by steps of Newton's iteration for
/// the polar factor (Higham 1986), which square the error; anything else takes the full polar
/// decomposition.
Eigen::Matrix3d rotation_of(const Eigen::Affine3d& transform) {
  Eigen::Matrix3d R = transform.linear();
  for (int step = 0; step < 3; ++step) {
    const double error = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!(error < 1e-3) || R.determinant() < 0) break;
    if (error < 1e-14) return R;
    R = 0.5 * (R + Eigen::Matrix3d(R.inverse().transpose()));
    if (error < 1e-7) return R;
  }
  return rigid_part(transform).linear();
}

DualQuaternion dual_quaternion(const Eigen::Affine3d& transform, const Eigen::Vector3d& head) {
  const Eigen::Matrix3d R = rotation_of(transform);
  const Eigen::Vector3d t = transform * head - R * head;
  const Eigen::Quaterniond q = Eigen::Quaterniond(R).normalized();
  const Eigen::Quaterniond d = Eigen::Quaterniond(0, 0.5 * t.x(), 0.5 * t.y(), 0.5 * t.z()) * q;
  return {{q.x(), q.y(), q.z(), q.w()}, {d.x(), d.y(), d.z(), d.w()}};
}

struct Four {
  Double4 x, y, z, w;
};

[[gnu::always_inline]] inline Four real_parts(const DualQuaternion* table,
                                              const std::uint16_t* joint) {
  return {lanes::load(table[joint[0]].real.data()), lanes::load(table[joint[1]].real.data()),
          lanes::load(table[joint[2]].real.data()), lanes::load(table[joint[3]].real.data())};
}

[[gnu::always_inline]] inline void add(Four& sum, const Double4& w, const Four& q) {
  sum.x = lanes::multiply_add(lanes::spread<0>(w), q.x, sum.x);
  sum.y = lanes::multiply_add(lanes::spread<1>(w), q.y, sum.y);
  sum.z = lanes::multiply_add(lanes::spread<2>(w), q.z, sum.z);
  sum.w = lanes::multiply_add(lanes::spread<3>(w), q.w, sum.w);
}

[[gnu::always_inline]] inline Four dual_parts(const DualQuaternion* table,
                                              const std::uint16_t* joint) {
  return {lanes::load(table[joint[0]].dual.data()), lanes::load(table[joint[1]].dual.data()),
          lanes::load(table[joint[2]].dual.data()), lanes::load(table[joint[3]].dual.data())};
}

/// Blends the dual quaternions of four vertices; on return component by component.
[[gnu::always_inline]] inline void blend(const DualQuaternion* table, const lanes::Block& block,
                                         Four& real, Four& dual) {
  const Four pivot = real_parts(table, block.joints);
  real = dual = Four{lanes::all(0), lanes::all(0), lanes::all(0), lanes::all(0)};
  const Double4 first = lanes::first_weight(block);
  add(real, first, pivot);
  add(dual, first, dual_parts(table, block.joints));
  for (int s = 1; s < block.slots; ++s) {
    const Four q = real_parts(table, block.joints + 4 * s);
    const Double4 dot = lanes::sums(pivot.x * q.x, pivot.y * q.y, pivot.z * q.z, pivot.w * q.w);
    Double4 w = lanes::load(block.weights + 4 * (s - 1));
    w = dot < 0 ? -w : w;
    add(real, w, q);
    add(dual, w, dual_parts(table, block.joints + 4 * s));
  }
  lanes::transpose(real.x, real.y, real.z, real.w);
  lanes::transpose(dual.x, dual.y, dual.z, dual.w);
}

/// v' = v + 2 / |r|^2 ( r x (r x v + s v) + s e - u r + r x e ) with the blend's real part (r, s)
/// and dual part (e, u): Kavan et al. 2008, algorithm 1, the norm taken in once.
[[gnu::always_inline]] inline void transform(const Four& r, const Four& e, const double* rest,
                                             Double4& x, Double4& y, Double4& z) {
  const Double4 vx = lanes::load(rest), vy = lanes::load(rest + 4), vz = lanes::load(rest + 8);
  const Double4 factor = 2.0 / (r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
  // r x (r x v + s v + e) + s e - u r
  const Double4 cx = (r.y * vz - r.z * vy) + r.w * vx + e.x;
  const Double4 cy = (r.z * vx - r.x * vz) + r.w * vy + e.y;
  const Double4 cz = (r.x * vy - r.y * vx) + r.w * vz + e.z;
  x = vx + factor * ((r.y * cz - r.z * cy) + (r.w * e.x - e.w * r.x));
  y = vy + factor * ((r.z * cx - r.x * cz) + (r.w * e.y - e.w * r.y));
  z = vz + factor * ((r.x * cy - r.y * cx) + (r.w * e.z - e.w * r.z));
}

}  // namespace

DualQuaternionBlend::DualQuaternionBlend(const RiggedMesh& rig) : influences_(rig) {
  for (const Joint& joint : rig.skeleton.joints) heads_.push_back(joint.head);
}

void DualQuaternionBlend::deform(const Pose& pose, Eigen::MatrixX3d& posed) const {
  if (static_cast<int>(pose.size()) != influences_.joint_count) {
    throw Error("pose of " + std::to_string(pose.size()) + " transforms", "dual quaternion blend",
                std::to_string(influences_.joint_count));
  }
  lanes::JointTable<DualQuaternion> table(pose.size());
  for (std::size_t j = 0; j < pose.size(); ++j) {
    if (!pose[j].matrix().allFinite())
      throw Error("transform is not finite", "joint " + std::to_string(j) + " of the pose");
    table[j] = dual_quaternion(pose[j], heads_[j]);
  }
  posed.resize(influences_.vertex_count, 3);
  const auto kernel = [q = table.data()](const lanes::Block& block, Double4& x, Double4& y,
                                         Double4& z) {
    Four real, dual;
    blend(q, block, real, dual);
    transform(real, dual, block.rest, x, y, z);
  };
  parallel_blocks(influences_.chunk_slots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk)
      lanes::for_chunk(influences_, chunk, posed, kernel);
  });
}

}  // namespace geoprior::skinning
