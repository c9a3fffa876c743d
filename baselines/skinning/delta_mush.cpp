#include "baselines/skinning/delta_mush.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "baselines/skinning/shared/lanes.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace geoprior::skinning {
namespace {

using lanes::Double4;

constexpr std::size_t kBlock = 1024;

/// Frames whose two tangents span less than this share of the square of their lengths are taken for
/// collapsed.
constexpr double kFlat = 1e-12;

/// Rows t, b, n of a frame; `valid` is false where the tangents span no plane.
struct LocalFrame {
  Eigen::Vector3d t, b, n;
  bool valid;
};

LocalFrame orthonormal(const Eigen::Vector3d& along, const Eigen::Vector3d& across) {
  const Eigen::Vector3d n = along.cross(across);
  const double scale = along.squaredNorm() + across.squaredNorm();
  const double length = n.norm();
  if (!(length > kFlat * scale)) return {{}, {}, {}, false};
  const Eigen::Vector3d normal = n / length;
  // The rotation nearest to (along, across) in the plane: the mean of `along` and of `across`
  // turned back by a right angle.
  const Eigen::Vector3d t = (along / std::sqrt(scale) + across.cross(normal) / std::sqrt(scale));
  const double t_length = t.norm();
  if (!(t_length > kFlat)) return {{}, {}, {}, false};
  const Eigen::Vector3d tangent = t / t_length;
  return {tangent, normal.cross(tangent), normal, true};
}

Eigen::Vector3d any_normal_to(const Eigen::Vector3d& n) { return n.unitOrthogonal(); }

}  // namespace

void describe(OptionVisitor& v, DeltaMushOptions& options) {
  v.value("iterations", options.iterations,
          {.doc = "smoothing passes, at rest and posed alike", .min = 0, .max = 10000});
  v.value("step", options.step,
          {.doc = "move towards the mean of the neighbours in one pass", .min = 0, .max = 1});
  v.value("pin_border", options.pin_border,
          {.doc = "border vertices of an open mesh stay where linear blending put them"});
}

DeltaMush::DeltaMush(const RiggedMesh& rig, const DeltaMushOptions& options)
    : blend_(rig), options_(options) {
  if (options.iterations < 0) throw Error("delta mush iterations are negative", "", ">= 0");
  if (!(options.step >= 0 && options.step <= 1)) throw Error("delta mush step", "", "0 to 1");
  const std::size_t n = rig.mesh.vertex_count();
  current_.resize(n);
  next_.resize(n);
  detail_.resize(n);
  rest_offset_.resize(n);
  strongest_joint_.resize(n);
  for (std::size_t v = 0; v < n; ++v) {
    double strongest = -1;
    for (SkinWeights::InnerIterator it(rig.weights, static_cast<int>(v)); it; ++it) {
      if (it.value() <= strongest) continue;
      strongest = it.value();
      strongest_joint_[v] = static_cast<int>(it.col());
    }
  }
  build_rings(rig, options.pin_border);
  load(rig.mesh.V);
  smooth();
  for (std::size_t v = 0; v < n; ++v) {
    const Point& s = current_[v];
    rest_offset_[v] = {rig.mesh.V(v, 0) - s.x, rig.mesh.V(v, 1) - s.y, rig.mesh.V(v, 2) - s.z, 0};
  }
  build_frames();
}

void DeltaMush::build_rings(const RiggedMesh& rig, bool pin_border) {
  const VertexGraph rings = one_rings(rig.mesh.F, rig.mesh.vertex_count());
  ring_offset_.assign(rings.offset.begin(), rings.offset.end());
  ring_.assign(rings.neighbours.begin(), rings.neighbours.end());
  const std::vector<bool> border = boundary_vertices(rig.mesh.F, rig.mesh.vertex_count());
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const std::size_t size = rings.of(v).size();
    const bool stays = size == 0 || (pin_border && border[v]);
    pull_.push_back(stays ? 0 : options_.step / static_cast<double>(size));
  }
}

/// Fits e_i = a x_i + b y_i over the ring, (x_i, y_i) the tangential rest coordinates of neighbour
/// i: a = sum alpha_i e_i with alpha = M^-1 (x, y), M the second moments of the ring.
void DeltaMush::build_frames() {
  frame_weight_.assign(ring_.size(), {0, 0});
  const auto at = [&](std::size_t v) {
    return Eigen::Vector3d(current_[v].x, current_[v].y, current_[v].z);
  };
  for (std::size_t v = 0; v < current_.size(); ++v) {
    const std::size_t begin = ring_offset_[v], end = ring_offset_[v + 1];
    // The plane that fits the ring: its normal is the axis of least spread.
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d e = at(ring_[i]) - at(v);
      const Eigen::Vector3d f = at(ring_[i + 1 < end ? i + 1 : begin]) - at(v);
      spread += e * e.transpose();
      area += e.cross(f);
    }
    const double size = spread.trace();
    if (end - begin < 2 || !(area.norm() > kFlat * size)) continue;
    const Eigen::Vector3d normal = area.normalized();
    const Eigen::Vector3d x = any_normal_to(normal), y = normal.cross(x);
    Eigen::Matrix2d moments;
    moments << x.dot(spread * x), x.dot(spread * y), x.dot(spread * y), y.dot(spread * y);
    if (!(moments.determinant() > kFlat * size * size)) continue;
    const Eigen::Matrix2d inverse = moments.inverse();
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d e = at(ring_[i]) - at(v);
      const Eigen::Vector2d c = inverse * Eigen::Vector2d(x.dot(e), y.dot(e));
      frame_weight_[i] = {c.x(), c.y()};
    }
    Eigen::Vector3d along = Eigen::Vector3d::Zero(), across = along;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d e = at(ring_[i]) - at(v);
      along += frame_weight_[i].along * e;
      across += frame_weight_[i].across * e;
    }
    const LocalFrame frame = orthonormal(along, across);
    if (!frame.valid) {
      std::fill(frame_weight_.begin() + begin, frame_weight_.begin() + end, FrameWeight{0, 0});
      continue;
    }
    const Eigen::Vector3d offset(rest_offset_[v].x, rest_offset_[v].y, rest_offset_[v].z);
    detail_[v] = {frame.t.dot(offset), frame.b.dot(offset), frame.n.dot(offset), 0};
  }
}

void DeltaMush::load(const Eigen::MatrixX3d& V) {
  parallel_blocks(current_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      current_[v] = {V(v, 0), V(v, 1), V(v, 2), 0};
    }
  });
}

void DeltaMush::smooth() {
  for (int pass = 0; pass < options_.iterations; ++pass) {
    parallel_blocks(current_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
      const Point* points = current_.data();
      for (std::size_t v = begin; v < end; ++v) {
        const std::uint32_t first = ring_offset_[v], last = ring_offset_[v + 1];
        const Double4 p = lanes::load(&points[v].x);
        Double4 sum = lanes::all(0);
        for (std::uint32_t i = first; i < last; ++i) sum += lanes::load(&points[ring_[i]].x);
        // p + step (mean of the ring - p), with pull = step / size.
        const double size = last - first;
        lanes::store(&next_[v].x, p + lanes::all(pull_[v]) * (sum - lanes::all(size) * p));
      }
    });
    std::swap(current_, next_);
  }
}

void DeltaMush::deform(const Pose& pose, Eigen::MatrixX3d& posed) {
  blend_.deform(pose, posed);
  load(posed);
  smooth();
  parallel_blocks(current_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    const Point* points = current_.data();
    for (std::size_t v = begin; v < end; ++v) {
      const Double4 p = lanes::load(&points[v].x);
      Double4 along4 = lanes::all(0), across4 = lanes::all(0);
      for (std::uint32_t i = ring_offset_[v]; i < ring_offset_[v + 1]; ++i) {
        const Double4 edge = lanes::load(&points[ring_[i]].x) - p;
        along4 += lanes::all(frame_weight_[i].along) * edge;
        across4 += lanes::all(frame_weight_[i].across) * edge;
      }
      // v' = s' + R' d.
      const LocalFrame frame =
          orthonormal({along4[0], along4[1], along4[2]}, {across4[0], across4[1], across4[2]});
      const Eigen::Vector3d s(p[0], p[1], p[2]);
      if (frame.valid) {
        const Point& d = detail_[v];
        posed.row(v) = s + d.x * frame.t + d.y * frame.b + d.z * frame.n;
      } else {
        const Point& d = rest_offset_[v];
        const auto& T = pose[strongest_joint_[v]];
        posed.row(v) = s + T.linear() * Eigen::Vector3d(d.x, d.y, d.z);
      }
    }
  });
}

}  // namespace geoprior::skinning
