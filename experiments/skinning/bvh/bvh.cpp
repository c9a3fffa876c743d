#include "experiments/skinning/bvh/bvh.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "experiments/skinning/bvh/root.h"
#include "testbed/formats/text/letters.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior::skinning {
namespace {

/// A word of the file for a message, shortened.
std::string quoted(std::string_view word) {
  std::string text("'");
  text.append(word.substr(0, 40));
  text.push_back('\'');
  return text;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f'; }
bool is_brace(char c) { return c == '{' || c == '}'; }

/// Whether a word is this keyword, in any case.
bool is_word(std::string_view word, std::string_view keyword) {
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](char a, char b) { return lower(a) == lower(b); });
}

/// Words of a text, with the line of the last one. Braces are words of their own.
class Words {
 public:
  Words(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  [[noreturn]] void fail(const std::string& problem, const std::string& allowed = {}) const {
    throw Error(problem, name_ + ":" + std::to_string(line_), allowed);
  }
  [[nodiscard]] bool at_end() {
    skip_space();
    return at_ == text_.size();
  }
  std::string_view next(const char* expected) {
    skip_space();
    if (at_ == text_.size()) fail("the file ends", expected);
    const std::size_t begin = at_;
    if (is_brace(text_[at_])) return text_.substr(at_++, 1);
    while (at_ < text_.size() && !is_space(text_[at_]) && !is_brace(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  void expect(std::string_view word) {
    const std::string_view found = next(std::string(word).c_str());
    if (!is_word(found, word)) fail(quoted(found), std::string(word));
  }
  [[nodiscard]] bool next_is(std::string_view word) {
    const std::size_t at = at_;
    const int line = line_;
    const bool found = !at_end() && is_word(next("a word"), word);
    at_ = at;
    line_ = line;
    return found;
  }
  /// The rest of the line, up to a brace, without the blanks around it.
  std::string_view rest_of_line() {
    while (at_ < text_.size() && is_space(text_[at_]) && text_[at_] != '\n') ++at_;
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r' && !is_brace(text_[at_]))
      ++at_;
    std::string_view rest = text_.substr(begin, at_ - begin);
    while (!rest.empty() && is_space(rest.back())) rest.remove_suffix(1);
    return rest;
  }
  /// A name, which may have blanks in it.
  std::string_view name() {
    skip_space();
    if (at_ == text_.size()) fail("the file ends", "the joint's name");
    const std::string_view found = rest_of_line();
    if (found.empty()) fail("a joint without a name", "the joint's name");
    return found;
  }
  /// "Frames:" or "Frame Time:", with or without blanks between the parts and before the number.
  void expect_key(std::string_view key) {
    skip_space();
    const std::size_t begin = at_;
    for (const char c : key) {
      if (c == ' ' || c == ':') skip_space();
      if (c == ' ') continue;
      if (at_ == text_.size()) fail("the file ends", std::string(key));
      if (lower(text_[at_]) != lower(c)) {
        at_ = begin;
        fail(quoted(next("a word")), std::string(key));
      }
      ++at_;
    }
  }
  double number() {
    std::string_view word = next("a number");
    const std::string shown = quoted(word);
    if (word.starts_with('+')) word.remove_prefix(1);
    double x = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(x))
      fail(shown + " is no number", "a finite number");
    return x;
  }
  int integer(int min, int max) {
    const double x = number();
    if (x != std::floor(x) || x < min || x > max) {
      fail(std::to_string(x) + " is out of range",
           std::to_string(min) + " to " + std::to_string(max));
    }
    return static_cast<int>(x);
  }
  Eigen::Vector3d vector() {
    Eigen::Vector3d v;
    for (int i = 0; i < 3; ++i) v[i] = number();
    return v;
  }
  [[nodiscard]] std::size_t bytes_left() const { return text_.size() - at_; }

 private:
  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) {
      if (text_[at_] == '\n') ++line_;
      ++at_;
    }
  }
  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

BvhChannel channel_of(const Words& words, std::string_view word) {
  static constexpr std::string_view kAxes = "xyz";
  const std::size_t axis = word.empty() ? std::string_view::npos : kAxes.find(lower(word[0]));
  const std::string_view kind = word.empty() ? word : word.substr(1);
  const bool is_rotation = is_word(kind, "rotation");
  if (axis == std::string_view::npos || (!is_rotation && !is_word(kind, "position")))
    words.fail("channel " + quoted(word),
               "Xposition, Yposition, Zposition, Xrotation, Yrotation, Zrotation");
  return {is_rotation, static_cast<int>(axis)};
}

void parse_end_site(Words& words, std::string_view first, BvhJoint& joint) {
  if (is_word(first, "End")) words.expect("Site");
  words.rest_of_line();  // a name that nothing refers to
  words.expect("{");
  words.expect("OFFSET");
  joint.end_site = words.vector();
  words.expect("}");
}

/// Parses a root and what hangs on it. Iterative: the depth of the hierarchy is the file's choice.
void parse_root(Words& words, std::vector<BvhJoint>& joints, int& columns) {
  words.expect("ROOT");
  std::vector<int> open;
  const auto begin_joint = [&] {
    BvhJoint joint;
    joint.name = std::string(words.name());
    joint.parent = open.empty() ? -1 : open.back();
    joint.first_column = columns;
    words.expect("{");
    open.push_back(static_cast<int>(joints.size()));
    joints.push_back(std::move(joint));
  };
  begin_joint();
  while (!open.empty()) {
    const std::string_view word = words.next("OFFSET, CHANNELS, JOINT, End Site or }");
    BvhJoint& joint = joints[open.back()];
    if (is_word(word, "OFFSET")) {
      joint.offset = words.vector();
    } else if (is_word(word, "CHANNELS")) {
      if (!joint.channels.empty()) words.fail("CHANNELS of joint '" + joint.name + "' again");
      const int n = words.integer(0, 6);
      for (int i = 0; i < n; ++i)
        joint.channels.push_back(channel_of(words, words.next("channel")));
      joint.first_column = columns;
      columns += n;
    } else if (is_word(word, "JOINT")) {
      begin_joint();
    } else if (is_word(word, "End") || is_word(word, "EndSite")) {
      parse_end_site(words, word, joint);
    } else if (word == "}") {
      open.pop_back();
    } else {
      words.fail(quoted(word), "OFFSET, CHANNELS, JOINT, End Site or }");
    }
  }
}

/// "1 joint", "12 joints".
std::string joints_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " joint" : " joints");
}

/// The first root, and the columns of all.
void parse_hierarchy(Words& words, BvhMotion& motion, int& columns) {
  words.expect("HIERARCHY");
  parse_root(words, motion.joints, columns);
  std::string others;
  std::size_t count = 0;
  while (words.next_is("ROOT")) {
    constexpr std::size_t kShown = 12;
    std::vector<BvhJoint> joints;
    parse_root(words, joints, columns);
    if (++count > kShown) continue;
    others +=
        (others.empty() ? "'" : ", '") + joints[0].name + "' of " + joints_text(joints.size());
  }
  if (count == 0) return;
  motion.notes.push_back("of " + std::to_string(count + 1) + " roots the first, '" +
                         motion.joints[0].name + "' of " + joints_text(motion.joints.size()) +
                         ", is read; left out: " + others);
}

/// Numbers behind the last frame: one whole row becomes a note.
void parse_rest(Words& words, BvhMotion& motion, int columns) {
  if (words.at_end()) return;
  const std::string frames = std::to_string(motion.frame_count());
  int more = 0;
  for (; more < columns && !words.at_end(); ++more) words.number();
  if (more < columns || !words.at_end()) {
    words.fail(
        "more numbers than " + frames + " frames of " + std::to_string(columns) + " channels",
        "as many rows as \"Frames:\" says");
  }
  motion.notes.push_back("one row of motion more than the " + frames +
                         " that \"Frames:\" says is left out");
}

void parse_motion(Words& words, BvhMotion& motion, int columns) {
  words.expect("MOTION");
  words.expect_key("Frames:");
  const int frames = words.integer(1, 100000000);
  words.expect_key("Frame Time:");
  motion.frame_time_s = words.number();
  if (!(motion.frame_time_s > 0)) words.fail("the frame time is not positive", "seconds above 0");
  if (columns == 0) words.fail("no joint has a channel");
  // A number and its space take two bytes: bounds the allocation by the size of the file.
  const double needed = 2.0 * frames * columns - 1;
  if (needed > static_cast<double>(words.bytes_left())) {
    words.fail("the file is too short for " + std::to_string(frames) + " frames of " +
               std::to_string(columns) + " channels");
  }
  motion.values.resize(frames, columns);
  for (int f = 0; f < frames; ++f)
    for (int c = 0; c < columns; ++c) motion.values(f, c) = words.number();
  parse_rest(words, motion, columns);
}

/// From the joint to the mean of its children's offsets, or to its end site, in world coordinates;
/// zero without either.
Eigen::Vector3d rest_bone(const BvhMotion& motion, int joint) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const BvhJoint& child : motion.joints) {
    if (child.parent == joint) sum += child.offset;
  }
  const auto& end = motion.joints[joint].end_site;
  return motion.to_y_up * (end ? Eigen::Vector3d(sum + *end) : sum);
}

int driver_of(const BvhMotion& motion, const std::string& bvh, const std::string& joint) {
  std::string names;
  for (int b = 0; b < std::ssize(motion.joints); ++b) {
    if (motion.joints[b].name == bvh) return b;
    names += (b == 0 ? "" : ", ") + motion.joints[b].name;
  }
  throw Error("the motion has no joint '" + bvh + "'", "joint '" + joint + "'", names);
}

/// Height of the root above the lowest joint, over positions in any unit.
double root_height(const std::vector<Eigen::Vector3d>& positions) {
  double lowest = positions[0].y();
  for (const Eigen::Vector3d& p : positions) lowest = std::min(lowest, p.y());
  return positions[0].y() - lowest;
}

}  // namespace

BvhMotion parse_bvh(std::string_view text, const std::string& name) {
  Words words(text, name);
  BvhMotion motion;
  int columns = 0;
  parse_hierarchy(words, motion, columns);
  parse_motion(words, motion, columns);
  find_held_offsets(motion);
  for (std::string& note : motion.notes) note.insert(0, name + ": ");
  return motion;
}

BvhMotion read_bvh(const std::filesystem::path& file) {
  return parse_bvh(read_text_file(file), file.string());
}

BvhRetarget::BvhRetarget(const BvhMotion& motion, const SkeletonFile& skeleton, int origin_frame)
    : motion_(motion), skeleton_(skeleton) {
  const auto& joints = skeleton.skeleton.joints;
  driver_.assign(joints.size(), -1);
  align_.assign(joints.size(), Eigen::Quaterniond::Identity());
  bool any = false;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!skeleton.bvh_joint[j]) continue;
    any = true;
    driver_[j] = driver_of(motion, *skeleton.bvh_joint[j], joints[j].name);
    const Eigen::Vector3d target = rest_bone(motion, driver_[j]);
    if (skeleton.bvh_align[j] && joints[j].tail && target.norm() > 0)
      align_[j] = Eigen::Quaterniond::FromTwoVectors(*joints[j].tail - joints[j].head, target);
  }
  if (!any) throw Error("no joint of the skeleton names a joint of the motion", "", "bvh = \"…\"");
  std::vector<Eigen::Vector3d> ours;
  for (const Joint& joint : joints) ours.push_back(joint.head);
  const double height = root_height(rest_positions(motion));
  if (height > 0 && root_height(ours) > 0) scale_ = root_height(ours) / height;
  origin_ = bvh_frame(motion, origin_frame).position[0];
  // The root is at rest at the height at which the lowest joint would stand as high as ours.
  double lowest = ours[0].y();
  for (const Eigen::Vector3d& p : ours) lowest = std::min(lowest, p.y());
  origin_.y() = height + lowest / scale_;
}

Pose BvhRetarget::pose(int frame) const {
  const BvhFrame state = bvh_frame(motion_, frame);
  const auto& joints = skeleton_.skeleton.joints;
  Pose pose(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const Joint& joint = joints[j];
    const std::size_t p = std::max(joint.parent, 0);
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    if (driver_[j] >= 0) {
      rotation = (state.rotation[driver_[j]] * align_[j]).toRotationMatrix();
    } else if (joint.parent >= 0) {
      rotation = pose[p].linear();
    }
    const Eigen::Vector3d head =
        joint.parent >= 0 ? Eigen::Vector3d(pose[p] * joint.head)
                          : Eigen::Vector3d(joint.head + scale_ * (state.position[0] - origin_));
    pose[j].linear() = rotation;
    pose[j].translation() = head - rotation * joint.head;
  }
  return pose;
}

}  // namespace geoprior::skinning
