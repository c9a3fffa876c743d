// Good motion capture files, written in all the ways that programs write them, against positions
// that the generator computes from its own numbers; it calls no reader of ours.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "experiments/skinning/bvh/bvh.h"
#include "experiments/skinning/bvh/root.h"
#include "tests/support/dice.h"
#include "tests/support/perturbed.h"

namespace geoprior::skinning {
namespace {

/// A joint of the generator. Numbers have two decimals, so that any way to write them is exact.
struct CapturedJoint {
  std::string name;
  int parent = -1;
  Eigen::Vector3d offset{0, 0, 0};
  Eigen::Vector3d end{0, 0, 0};  ///< of a leaf
  bool is_leaf = true;
  std::vector<int> rotations;  ///< axes in the order of the channels
  bool has_position = false;   ///< before the rotations
  bool position_last = false;  ///< or behind them
};

class PerturbedCapture {
 public:
  explicit PerturbedCapture(int seed) : dice_(seed, "motion capture") {
    holds_ = dice_.coin();
    joints_hold_ = dice_.coin();
    frames_ = 1 + dice_.below(6);
    make_joints();
    make_motion();
    write();
  }

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] bool root_holds_offset() const { return holds_; }
  [[nodiscard]] int frame_count() const { return frames_; }
  [[nodiscard]] double frame_time() const { return 0.25; }
  [[nodiscard]] const std::vector<CapturedJoint>& joints() const { return joints_; }
  [[nodiscard]] int note_count() const { return note_count_; }

  /// Places of the joints in a frame: p_j = p_parent + R_parent (offset + moved), and the matrices
  /// R_j = R_parent R_1 R_2 R_3 in the order of the channels.
  [[nodiscard]] std::vector<Eigen::Vector3d> places(int frame) const {
    std::vector<Eigen::Vector3d> place;
    std::vector<Eigen::Matrix3d> turn;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const CapturedJoint& joint = joints_[j];
      Eigen::Matrix3d local = Eigen::Matrix3d::Identity();
      for (std::size_t k = 0; k < joint.rotations.size(); ++k)
        local *= about(joint.rotations[k], degrees_[frame][j][k]);
      const Eigen::Vector3d from_parent = joint.offset + moved_[frame][j];
      if (joint.parent < 0) {
        place.push_back(from_parent);
        turn.push_back(local);
      } else {
        place.push_back(place[joint.parent] + turn[joint.parent] * from_parent);
        turn.push_back(turn[joint.parent] * local);
      }
    }
    return place;
  }

 private:
  static Eigen::Matrix3d about(int axis, double degrees) {
    const double c = std::cos(degrees * std::numbers::pi / 180);
    const double s = std::sin(degrees * std::numbers::pi / 180);
    const int a = (axis + 1) % 3;
    const int b = (axis + 2) % 3;
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    R(a, a) = R(b, b) = c;
    R(b, a) = s;
    R(a, b) = -s;
    return R;
  }

  double decimal(double low, double high) {
    return std::round(100 * dice_.uniform(low, high)) / 100;
  }

  /// A hip 100 above the ground, legs that reach down to it, and a few more joints.
  void make_joints() {
    const auto add = [&](int parent, const Eigen::Vector3d& offset) {
      CapturedJoint joint;
      joint.name = dice_.one_of({"Hips", "Bip01 L Thigh", "mixamorig:Hips", "left.knee", "End"}) +
                   std::to_string(joints_.size());
      joint.parent = parent;
      joint.offset = offset;
      joint.end = {0, -10, 5};
      joint.rotations = {0, 1, 2};
      dice_.shuffle(joint.rotations);
      joint.has_position = parent < 0 || dice_.below(3) == 0;
      joint.position_last = dice_.coin();
      if (parent >= 0) joints_[parent].is_leaf = false;
      joints_.push_back(joint);
    };
    add(-1, {decimal(-50, 50), 100, decimal(-50, 50)});
    add(0, {10, -50, 0});
    add(1, {0, -40, 0});
    // In the order of the file, depth first: each next joint hangs on the last or on an ancestor.
    const int more = dice_.below(6);
    for (int i = 0; i < more; ++i) {
      int parent = static_cast<int>(joints_.size()) - 1;
      while (parent > 0 && dice_.coin()) parent = joints_[parent].parent;
      add(parent, {decimal(-20, 20), decimal(5, 20), decimal(-20, 20)});
    }
  }

  /// Near the rest pose, so that the feet stay near the ground.
  void make_motion() {
    for (int f = 0; f < frames_; ++f) {
      degrees_.emplace_back();
      moved_.emplace_back();
      for (const CapturedJoint& joint : joints_) {
        degrees_.back().emplace_back();
        for (std::size_t k = 0; k < joint.rotations.size(); ++k)
          degrees_.back().back().push_back(decimal(-15, 15));
        moved_.back().emplace_back(0, 0, 0);
        if (joint.parent < 0)
          moved_.back().back() = {decimal(-80, 80), decimal(-5, 5), decimal(-80, 80)};
      }
    }
  }

  std::string number(double x) {
    char text[64];
    const char* format = "%.2f";
    switch (dice_.below(5)) {
      case 0:
        format = "%.6f";
        break;
      case 1:
        format = "%.10e";
        break;
      case 2:
        format = "%g";
        break;
      case 3:
        format = "%+.2f";
        break;
      default:
        break;
    }
    std::snprintf(text, sizeof text, format, x);
    std::string word = text;
    if (dice_.coin() && word.starts_with("0.")) word.erase(0, 1);
    return word;
  }

  std::string blank() { return dice_.one_of({" ", "  ", "\t", " \t "}); }
  std::string end_of_line() { return dice_.one_of({"", "", " ", "\t"}) + line_end_; }
  std::string cased(std::string word) {
    const int kind = dice_.below(4);
    for (std::size_t i = 0; i < word.size(); ++i) {
      const auto c = static_cast<unsigned char>(word[i]);
      if (kind == 0) word[i] = static_cast<char>(std::toupper(c));
      if (kind == 1) word[i] = static_cast<char>(std::tolower(c));
    }
    return word;
  }
  std::string vector(const Eigen::Vector3d& v) {
    return number(v[0]) + blank() + number(v[1]) + blank() + number(v[2]);
  }
  void line(const std::string& text) {
    text_ += dice_.one_of({"", "  ", "\t", "\t\t"}) + text + end_of_line();
    if (dice_.below(10) == 0) text_ += end_of_line();
  }
  void open_brace(const std::string& head) {
    if (dice_.below(3) == 0) {
      line(head + blank() + "{");
    } else {
      line(head);
      line("{");
    }
  }

  void write() {
    line_end_ = dice_.coin() ? "\n" : "\r\n";
    line(cased("HIERARCHY"));
    write_joint(0);
    if (dice_.below(3) == 0) write_second_root();
    line(cased("MOTION"));
    const std::string frames = std::to_string(frames_);
    line(dice_.one_of({"Frames:", "Frames: ", "Frames:\t", "frames : ", "FRAMES :"}) + frames);
    line(dice_.one_of({"Frame Time:", "Frame Time: ", "FrameTime: ", "frame  time :\t"}) +
         number(frame_time()));
    for (int f = 0; f < frames_; ++f) write_row(f);
    if (dice_.below(4) > 0) return;
    write_row(0);  // one row more than there are frames
    ++note_count_;
  }

  void write_joint(int j) {
    const CapturedJoint& joint = joints_[j];
    open_brace(cased(j == 0 ? "ROOT" : "JOINT") + blank() + joint.name);
    line(cased("OFFSET") + blank() + vector(joint.offset));
    std::vector<std::string> channels;
    for (const int axis : joint.rotations)
      channels.push_back(cased(std::string(1, "XYZ"[axis]) + "rotation"));
    if (joint.has_position) {
      const std::vector<std::string> positions{cased("Xposition"), cased("Yposition"),
                                               cased("Zposition")};
      channels.insert(joint.position_last ? channels.end() : channels.begin(), positions.begin(),
                      positions.end());
    }
    std::string all = cased("CHANNELS") + blank() + std::to_string(channels.size());
    for (const std::string& channel : channels) all += blank() + channel;
    line(all);
    for (int child = j + 1; child < static_cast<int>(joints_.size()); ++child)
      if (joints_[child].parent == j) write_joint(child);
    if (joint.is_leaf && dice_.below(4) > 0) {
      open_brace(dice_.one_of(
          {"End Site", "End site", "end site", "END SITE", "EndSite", "End Site Nub"}));
      line("OFFSET" + blank() + vector(joint.end));
      line("}");
    }
    line("}");
  }

  void write_second_root() {
    has_second_root_ = true;
    ++note_count_;
    open_brace("ROOT Prop");
    line("OFFSET 1 2 3");
    line("CHANNELS 1 Yposition");
    line("}");
  }

  void write_row(int f) {
    std::string row;
    // Columns stand in the order in which the joints are opened: that of the list.
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const CapturedJoint& joint = joints_[j];
      std::string rotations, position;
      for (const double angle : degrees_[f][j]) rotations += number(angle) + blank();
      const bool holds = j == 0 ? holds_ : joints_hold_;
      Eigen::Vector3d stored = moved_[f][j];
      if (holds) stored += joint.offset;
      if (joint.has_position) position = vector(stored) + blank();
      row += joint.position_last ? rotations + position : position + rotations;
    }
    if (has_second_root_) row += "7";
    line(row);
  }

  test::Dice dice_;
  bool holds_ = false;
  bool joints_hold_ = false;
  bool has_second_root_ = false;
  int note_count_ = 0;
  int frames_ = 1;
  std::vector<CapturedJoint> joints_;
  std::vector<std::vector<std::vector<double>>> degrees_;  ///< frame, joint, channel
  std::vector<std::vector<Eigen::Vector3d>> moved_;        ///< besides the offset
  std::string line_end_ = "\n";
  std::string text_;
};

void expect_places(const BvhMotion& motion, const PerturbedCapture& capture) {
  ASSERT_EQ(motion.frame_count(), capture.frame_count());
  for (int f = 0; f < capture.frame_count(); ++f) {
    const std::vector<Eigen::Vector3d> places = capture.places(f);
    const BvhFrame frame = bvh_frame(motion, f);
    for (std::size_t j = 0; j < places.size(); ++j)
      ASSERT_NEAR((frame.position[j] - places[j]).norm(), 0, 1e-6) << "joint " << j;
  }
}

TEST(LongPerturbedBvh, MeansWhatItsGeneratorWrote) {
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    const PerturbedCapture capture(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + capture.text());
    BvhMotion motion;
    try {
      motion = parse_bvh(capture.text(), "perturbed.bvh");
    } catch (const Error& e) {
      ADD_FAILURE() << e.what();
      break;
    }
    ASSERT_EQ(motion.joints.size(), capture.joints().size());
    for (std::size_t j = 0; j < motion.joints.size(); ++j) {
      EXPECT_EQ(motion.joints[j].name, capture.joints()[j].name);
      EXPECT_EQ(motion.joints[j].parent, capture.joints()[j].parent);
    }
    EXPECT_EQ(motion.frame_time_s, capture.frame_time());
    EXPECT_EQ(static_cast<int>(motion.notes.size()), capture.note_count());
    const auto named = capture.root_holds_offset() ? BvhRoot::replaced : BvhRoot::added;
    expect_places(place_root(motion, named, "perturbed.bvh"), capture);
    expect_places(place_root(motion, BvhRoot::guess, "perturbed.bvh"), capture);
    if (HasFailure()) break;
  }
}

}  // namespace
}  // namespace geoprior::skinning
