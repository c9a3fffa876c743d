#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "experiments/formats/gltf_skin.h"

namespace geoprior {
namespace gltf {
namespace {

using Property = GltfTrack::Property;
using Interpolation = GltfTrack::Interpolation;

GltfTrack read_track(const Model& model, const Sampler& sampler, Property property,
                     const std::string& where) {
  GltfTrack track;
  track.property = property;
  track.interpolation = sampler.interpolation == "STEP"          ? Interpolation::step
                        : sampler.interpolation == "CUBICSPLINE" ? Interpolation::cubic_spline
                                                                 : Interpolation::linear;
  const Accessor& input = model.accessors[sampler.input];
  const Accessor& output = model.accessors[sampler.output];
  const int columns = property == Property::rotation ? 4 : 3;
  const std::size_t rows = track.interpolation == Interpolation::cubic_spline ? 3 : 1;
  if (!input.view || input.columns != 1 || input.component != Component::f32)
    throw Error("the times are not float SCALAR with data", where);
  if (output.columns != columns || output.count != rows * input.count) {
    throw Error(
        "the values do not fit the times", where,
        std::to_string(rows * input.count) + " of " + std::to_string(columns) + " components");
  }
  track.times = decode(model, sampler.input);
  track.values = decode(model, sampler.output);
  for (Eigen::Index i = 0; i < track.times.size(); ++i) {
    const bool increases = i == 0 || track.times[i] > track.times[i - 1];
    if (!std::isfinite(track.times[i]) || !increases)
      throw Error("the times do not increase at key " + std::to_string(i), where);
  }
  if (!track.values.allFinite()) throw Error("a value is not finite", where);
  return track;
}

std::optional<Property> property_of(const std::string& path) {
  if (path == "translation") return Property::translation;
  if (path == "rotation") return Property::rotation;
  if (path == "scale") return Property::scale;
  return std::nullopt;
}

}  // namespace

std::vector<GltfClip> read_clips(const Model& model, const std::vector<int>& node_of_model,
                                 std::vector<std::string>& ignored) {
  std::vector<GltfClip> clips;
  bool other_paths = false;
  for (std::size_t a = 0; a < model.animations.size(); ++a) {
    GltfClip clip;
    clip.name = model.animations[a].name;
    for (std::size_t c = 0; c < model.animations[a].channels.size(); ++c) {
      const Channel& channel = model.animations[a].channels[c];
      const auto property = property_of(channel.path);
      if (!property) other_paths = true;
      if (!property || !channel.node) continue;
      const std::string where =
          place(model, "/animations/" + std::to_string(a) + "/channels/" + std::to_string(c));
      if (model.nodes[*channel.node].matrix)
        throw Error("animates a node that is given by a matrix", where,
                    "nodes with translation, rotation and scale");
      GltfTrack track =
          read_track(model, model.animations[a].samplers[channel.sampler], *property, where);
      track.node = node_of_model[*channel.node];
      const double first = track.times[0];
      const double last = track.times[track.times.size() - 1];
      clip.start_s = clip.tracks.empty() ? first : std::min(clip.start_s, first);
      clip.end_s = clip.tracks.empty() ? last : std::max(clip.end_s, last);
      clip.tracks.push_back(std::move(track));
    }
    if (!clip.tracks.empty()) clips.push_back(std::move(clip));
  }
  if (other_paths) ignored.emplace_back("animation of morph targets or other properties");
  return clips;
}

}  // namespace gltf

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

Pose clip_pose(const GltfCharacter& character, const GltfClip& clip, double time_s) {
  std::vector<GltfNode> nodes = character.binding.nodes;
  for (const GltfTrack& track : clip.tracks) {
    GltfNode& node = nodes[static_cast<std::size_t>(track.node)];
    const Eigen::VectorXd x = sample(track, time_s);
    switch (track.property) {
      case GltfTrack::Property::translation:
        node.translation = x;
        break;
      case GltfTrack::Property::rotation:
        node.rotation = quaternion(x);
        break;
      case GltfTrack::Property::scale:
        node.scale = x;
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
    world[i] = n.parent < 0 ? local : world[static_cast<std::size_t>(n.parent)] * local;
  }
  Pose pose;
  for (std::size_t j = 0; j < character.binding.joint_node.size(); ++j) {
    pose.push_back(world[static_cast<std::size_t>(character.binding.joint_node[j])] *
                   character.binding.from_rest[j]);
  }
  return pose;
}

}  // namespace geoprior
