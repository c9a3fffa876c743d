#include "experiments/skinning/bvh/root.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "testbed/runner/number_text.h"

namespace geoprior::skinning {
namespace {

/// At most so many frames, equally spaced, are looked at.
constexpr int kSamples = 200;

std::vector<int> sampled_frames(const BvhMotion& motion) {
  std::vector<int> frames;
  const int count = std::min(motion.frame_count(), kSamples);
  for (int i = 0; i < count; ++i) {
    frames.push_back(static_cast<int>(static_cast<std::int64_t>(i) * (motion.frame_count() - 1) /
                                      std::max(count - 1, 1)));
  }
  return frames;
}

/// The value that a share of the finite ones do not exceed; 0 of none.
double quantile(std::vector<double> values, double share) {
  std::erase_if(values, [](double x) { return !std::isfinite(x); });
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

bool has_position(const BvhJoint& joint) {
  return std::any_of(joint.channels.begin(), joint.channels.end(),
                     [](const BvhChannel& c) { return !c.is_rotation; });
}

/// Position channels of a joint in a frame; zero for an axis without one.
Eigen::Vector3d channel_position(const BvhMotion& motion, const BvhJoint& joint, int frame) {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int c = 0; c < std::ssize(joint.channels); ++c) {
    if (joint.channels[c].is_rotation) continue;
    position[joint.channels[c].axis] += motion.values(frame, joint.first_column + c);
  }
  return position;
}

/// OFFSET along the axes that have a position channel.
Eigen::Vector3d channel_offset(const BvhJoint& joint) {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  for (const BvhChannel& channel : joint.channels)
    if (!channel.is_rotation) offset[channel.axis] = joint.offset[channel.axis];
  return offset;
}

/// Height of the lowest joint or end site.
double lowest_point(const BvhMotion& motion, const BvhFrame& frame) {
  double lowest = frame.position[0].y();
  for (std::size_t j = 0; j < motion.joints.size(); ++j) {
    lowest = std::min(lowest, frame.position[j].y());
    const auto& end = motion.joints[j].end_site;
    if (!end) continue;
    const Eigen::Vector3d tip = frame.rotation[j] * (motion.to_y_up * *end);
    lowest = std::min(lowest, frame.position[j].y() + tip.y());
  }
  return lowest;
}

/// To this height and above it the body comes in all but a twentieth of the frames.
double ground_of(BvhMotion motion, bool hold, const std::vector<int>& frames) {
  motion.joints[0].channels_hold_offset = hold;
  std::vector<double> lowest;
  for (const int f : frames) lowest.push_back(lowest_point(motion, bvh_frame(motion, f)));
  return quantile(lowest, 0.05);
}

/// Height of the root above the lowest point at rest.
double leg_height(const BvhMotion& motion) {
  BvhFrame rest;
  rest.position = rest_positions(motion);
  rest.rotation.resize(motion.joints.size(), Eigen::Quaterniond::Identity());
  return rest.position[0].y() - lowest_point(motion, rest);
}

struct Guess {
  bool replaced = false;
  std::string reason;
};

Guess guess_root(const BvhMotion& motion, double offset) {
  const std::vector<int> frames = sampled_frames(motion);
  const double leg = leg_height(motion);
  if (offset >= 0.5 * leg && offset <= 1.5 * leg) {
    const double added = ground_of(motion, false, frames);
    const double replaced = ground_of(motion, true, frames);
    return {std::abs(replaced) < std::abs(added),
            "the lowest point of the body then stands at a height of " +
                rounded_text(std::abs(replaced) < std::abs(added) ? replaced : added, 3) +
                ", else of " +
                rounded_text(std::abs(replaced) < std::abs(added) ? added : replaced, 3)};
  }
  std::vector<double> heights;
  for (const int f : frames)
    heights.push_back((motion.to_y_up * channel_position(motion, motion.joints[0], f)).y());
  const double median = quantile(heights, 0.5);
  return {median / offset > 0.5, "the channels' height is mostly " + rounded_text(median, 3) +
                                     ", that of the OFFSET " + rounded_text(offset, 3)};
}

}  // namespace

BvhMotion place_root(BvhMotion motion, BvhRoot root, const std::string& name) {
  BvhJoint& joint = motion.joints[0];
  joint.channels_hold_offset = root == BvhRoot::replaced;
  if (root != BvhRoot::guess) return motion;
  const double offset = (motion.to_y_up * channel_offset(joint)).y();
  if (std::abs(offset) <= 1e-6 * joint.offset.norm()) return motion;  // also of no offset
  const Guess guess = guess_root(motion, offset);
  joint.channels_hold_offset = guess.replaced;
  motion.notes.push_back(name + ": guessed bvh_root = \"" +
                         (guess.replaced ? "replaced" : "added") + "\" (the root's channels " +
                         (guess.replaced ? "hold its OFFSET already" : "are added to its OFFSET") +
                         "): " + guess.reason);
  return motion;
}

void find_held_offsets(BvhMotion& motion) {
  const std::vector<int> frames = sampled_frames(motion);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : rest_positions(motion)) box.extend(p);
  const double extent = box.diagonal().norm();
  std::string first;
  int count = 0;
  double most = 0;
  for (std::size_t j = 1; j < motion.joints.size(); ++j) {
    BvhJoint& joint = motion.joints[j];
    if (!has_position(joint)) continue;
    const Eigen::Vector3d offset = channel_offset(joint);
    std::vector<double> from_offset, from_zero;
    for (const int f : frames) {
      const Eigen::Vector3d position = channel_position(motion, joint, f);
      from_offset.push_back((position - offset).norm());
      from_zero.push_back(position.norm());
    }
    joint.channels_hold_offset = quantile(from_offset, 0.5) < quantile(from_zero, 0.5);
    const std::vector<double>& moved = joint.channels_hold_offset ? from_offset : from_zero;
    const double farthest = *std::max_element(moved.begin(), moved.end());
    if (!(farthest > 0.01 * extent)) continue;
    if (count++ == 0) first = joint.name;
    most = std::max(most, farthest);
  }
  if (count == 0) return;
  motion.notes.push_back("position channels of joint '" + first + "'" +
                         (count > 1 ? " and " + std::to_string(count - 1) + " more" : "") +
                         " stretch bones by up to " + rounded_text(most, 3) +
                         ": left out, bones keep their lengths");
}

}  // namespace geoprior::skinning
