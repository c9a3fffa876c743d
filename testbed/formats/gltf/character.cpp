#include "testbed/formats/gltf/character.h"

#include <algorithm>

namespace geoprior {
namespace {

/// Rows of `values` to read at a time: key `i`, the next one, and the fraction between them.
struct Between {
  Eigen::Index i = 0;
  Eigen::Index next = 0;
  double fraction = 0;
  double span = 0;
};

Between between(const Eigen::VectorXd& times, double t) {
  const double* begin = times.data();
  const double* end = begin + times.size();
  const double* after = std::upper_bound(begin, end, t);
  if (after == begin) return {};
  const Eigen::Index i = after - begin - 1;
  if (after == end) return {i, i, 0, 0};
  const double span = times[i + 1] - times[i];
  return {i, i + 1, (t - times[i]) / span, span};
}

/// Hermite spline of glTF 2.0 appendix C: values and tangents (per second) at both keys.
Eigen::VectorXd cubic_spline(const Eigen::MatrixXd& values, const Between& b) {
  const double t = b.fraction;
  const double t2 = t * t;
  const double t3 = t2 * t;
  return ((2 * t3 - 3 * t2 + 1) * values.row(3 * b.i + 1) +
          b.span * (t3 - 2 * t2 + t) * values.row(3 * b.i + 2) +
          (-2 * t3 + 3 * t2) * values.row(3 * b.next + 1) +
          b.span * (t3 - t2) * values.row(3 * b.next))
      .transpose();
}

Eigen::Quaterniond quaternion(const Eigen::VectorXd& xyzw) {
  const Eigen::Quaterniond q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  return q.norm() > 1e-9 ? q.normalized() : Eigen::Quaterniond::Identity();
}

Eigen::VectorXd sample(const GltfTrack& track, double time_s) {
  const Between b = between(track.times, time_s);
  if (track.interpolation == GltfTrack::Interpolation::cubic_spline)
    return cubic_spline(track.values, b);
  if (track.interpolation == GltfTrack::Interpolation::step || b.next == b.i)
    return track.values.row(b.i).transpose();
  if (track.property == GltfTrack::Property::rotation) {
    const Eigen::Quaterniond q = quaternion(track.values.row(b.i).transpose())
                                     .slerp(b.fraction, quaternion(track.values.row(b.next)));
    return q.coeffs();
  }
  return ((1 - b.fraction) * track.values.row(b.i) + b.fraction * track.values.row(b.next))
      .transpose();
}

}  // namespace

Pose clip_pose(const GltfCharacter& character, const GltfClip& clip, double time_s,
               ClipScale scale) {
  std::vector<GltfNode> nodes = character.binding.nodes;
  for (const GltfTrack& track : clip.tracks) {
    GltfNode& node = nodes[track.node];
    const Eigen::VectorXd x = sample(track, time_s);
    switch (track.property) {
      case GltfTrack::Property::translation:
        node.translation = x;
        break;
      case GltfTrack::Property::rotation:
        node.rotation = quaternion(x);
        break;
      case GltfTrack::Property::scale:
        if (scale == ClipScale::played) node.scale = x;
        break;
    }
  }
  std::vector<Eigen::Affine3d> world(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const GltfNode& n = nodes[i];
    Eigen::Affine3d local;
    if (n.matrix) {
      local = *n.matrix;
    } else {
      local = Eigen::Translation3d(n.translation) * n.rotation * Eigen::Scaling(n.scale);
    }
    world[i] = n.parent < 0 ? local : world[n.parent] * local;
  }
  Pose pose;
  for (std::size_t j = 0; j < character.binding.joint_node.size(); ++j) {
    pose.push_back(world[character.binding.joint_node[j]] * character.binding.from_rest[j]);
  }
  return pose;
}

}  // namespace geoprior
