#include "experiments/skinning/rig_command.h"

#include <cmath>
#include <map>

#include "core/error.h"
#include "experiments/skinning/scene/characters.h"
#include "experiments/skinning/scene/guess/axes.h"
#include "experiments/skinning/scene/guess/body.h"
#include "testbed/runner/names.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/options/json.h"

namespace geoprior::skinning {
namespace {

constexpr int kDigits = 7;  ///< of positions: those of the files' floats

std::string vector_text(const Eigen::Vector3d& x, int digits) {
  const double least = 0.5 * std::pow(10, -digits) * x.cwiseAbs().maxCoeff();
  std::string text;
  for (const double value : x) {
    // What the largest coordinate's digits do not reach is round-off.
    const double shown = std::abs(value) <= least ? 0 : value;
    text += (text.empty() ? "[" : ", ") + rounded_text(shown, digits);
  }
  return text + "]";
}

std::string axes_line(const Eigen::Vector3d& flexion, const Eigen::Vector3d& twist) {
  return "axes = { flexion = " + vector_text(flexion, 4) + ", twist = " + vector_text(twist, 4) +
         " }";
}

std::string joint_text(const Skeleton& skeleton, const Joint& joint, const JointAxes& axes) {
  std::string text = "\n[joint." + toml_key(joint.name) + "]\n";
  if (joint.parent >= 0)
    text += "parent = " + toml_string(skeleton.joints[joint.parent].name) + "\n";
  const std::string head = vector_text(joint.head, kDigits);
  text += "head = " + head + "\n";
  const std::string tail = joint.tail ? vector_text(*joint.tail, kDigits) : head;
  if (tail != head) text += "tail = " + tail + "\n";
  const std::string doubt = axes.doubt ? "doubtful: " + *axes.doubt + "; " : "";
  text += "# flexion: " + doubt + axes.flexion.reason + "\n";
  text += axes_line(axes.flexion.direction, axes.twist) + "\n";
  for (const GuessedAxis& other : axes.alternatives)
    text += "# " + axes_line(other.direction, axes.twist) + "  # " + other.reason + "\n";
  return text;
}

constexpr const char* kPreface = R"(#
# Metres, in the coordinates of the mesh. An angle turns a joint, with all that hangs on it, about
# an axis through its head, right-handed. `flexion` and `twist` are names for motions and poses;
# others can be added. Flexion is a guess from the rest pose: the comment above it says why, and
# where it is doubtful. Where a picture shows that it is wrong, take a line of a comment instead;
# where only the side is wrong, turn the signs. Twist is the direction of the bone.
#
# The file helps the character's own rig: joints may be taken out, their weights stay. For motion
# capture add bvh = "<joint of the .bvh file>" to the joints that it drives.
#
#   geoprior describe skeleton
)";

/// "flexion of 3 of 25 joints is doubtful: a thumb … (2), no feet … (1)"; absent: of none.
std::optional<std::string> doubts_line(const std::vector<JointAxes>& axes) {
  std::map<std::string, int> count;
  int doubtful = 0;
  for (const JointAxes& joint : axes) {
    if (!joint.doubt) continue;
    ++doubtful;
    ++count[*joint.doubt];
  }
  if (doubtful == 0) return std::nullopt;
  std::string reasons;
  for (const auto& [reason, joints] : count)
    reasons += (reasons.empty() ? "" : ", ") + reason + " (" + std::to_string(joints) + ")";
  return "flexion of " + std::to_string(doubtful) + " of " + std::to_string(axes.size()) +
         " joints is doubtful, as their comments say: " + reasons;
}

/// "the body stands along +z, not +y"; absent: it stands along +y, or nothing shows how it stands.
std::optional<std::string> stance_line(const Skeleton& skeleton) {
  const Body body = find_body(skeleton);
  if (!body.is_symmetric || body.up_doubt || body.up == Eigen::Vector3d::UnitY())
    return std::nullopt;
  int axis = 0;
  const double up = body.up.cwiseAbs().maxCoeff(&axis) * body.up.sum();
  return std::string("by its limbs the body stands along ") + (up > 0 ? '+' : '-') + "xyz"[axis] +
         ", or lies: axes are guessed so, glTF has +y up";
}

CommandText write_rig(const std::string& input, const RigOptions& options) {
  const std::filesystem::path file = find_input(input, ".");
  CharacterSkeleton own = read_character_skeleton(file, options.mesh, options.unit_m);
  CommandText out;
  out.text = skeleton_file_text(own.skeleton, quoted_name(file.filename().string()));
  out.notices = std::move(own.warnings);
  for (const auto& line : {stance_line(own.skeleton), doubts_line(guess_axes(own.skeleton))}) {
    if (line) out.notices.push_back(file.string() + ": " + *line);
  }
  return out;
}

}  // namespace

void describe(OptionVisitor& v, RigOptions& options) {
  v.value("mesh", options.mesh, {.doc = "name of the file's mesh, as in [scene]"});
  v.value("unit_m", options.unit_m,
          {.doc = "metres for one unit of the file, as in [scene]; absent: guessed",
           .unit = "m",
           .min = 1e-9,
           .max = 1e9});
}

std::string skeleton_file_text(const Skeleton& skeleton, const std::string& title) {
  const std::vector<JointAxes> axes = guess_axes(skeleton);
  std::string text = "# Skeleton of " + title + ", " + std::to_string(skeleton.size()) +
                     " joints, written by `geoprior rig`.\n" + kPreface;
  for (int j = 0; j < skeleton.size(); ++j)
    text += joint_text(skeleton, skeleton.joints[j], axes[j]);
  return text;
}

TopicCommand rig_command() {
  return topic_command<RigOptions>("rig", "write the skeleton file of a rigged character",
                                   "character", "a skinned .glb or .gltf file", write_rig);
}

}  // namespace geoprior::skinning
