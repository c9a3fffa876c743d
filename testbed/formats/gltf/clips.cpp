#include "testbed/formats/gltf/clips.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"

namespace geoprior::gltf {
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
  for (Eigen::Index r = 0; r < track.values.rows(); ++r) {
    if (track.values.row(r).allFinite()) continue;
    throw Error("a value is not finite at " +
                    std::to_string(track.times[r / static_cast<Eigen::Index>(rows)]) + " s",
                where);
  }
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
          place(model, "/animations/" + std::to_string(a) + "/channels/" + std::to_string(c)) +
          ", " + channel.path + " of '" + model.nodes[*channel.node].name + "'";
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

}  // namespace geoprior::gltf
