// Motions, skeletons and poses come from editors of every system.

#include "tests/support/text_forms.h"

#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include "experiments/skinning/bvh/bvh.h"
#include "experiments/skinning/scene/skeleton_file.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::skinning {
namespace {

namespace fs = std::filesystem;

class TextFormsOfRigs : public test::ScratchFolder {
 protected:
  void expect_equal(const std::string& name, const std::string& text,
                    const std::function<std::string(const fs::path&)>& read) const {
    const std::string plain = read(write(name, text));
    EXPECT_GT(plain.size(), 3U);
    for (const test::TextForm& form : test::text_forms(text)) {
      try {
        EXPECT_EQ(read(write(name, form.bytes)), plain) << name << ", " << form.name;
      } catch (const Error& error) {
        ADD_FAILURE() << name << ", " << form.name << ": " << error.what();
      }
    }
    const fs::path wide = write(name, test::in_utf16(text));
    test::expect_error([&] { read(wide); }, {name, "UTF-16", "iconv"});
  }
};

TEST_F(TextFormsOfRigs, AreReadAlike) {
  expect_equal(
      "a.bvh",
      "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 10 0\n  CHANNELS 6 Xposition Yposition Zposition "
      "Zrotation Yrotation Xrotation\n  End Site\n  {\n    OFFSET 0 -3 0\n  }\n}\nMOTION\n"
      "Frames: 2\nFrame Time: 0.5\n0 0 0 0 0 0\n1 2 3 90 0 0\n",
      [](const fs::path& file) {
        const BvhMotion motion = read_bvh(file);
        std::ostringstream out;
        out << motion.joints.at(0).name << " " << motion.frame_time_s << " " << motion.values;
        return out.str();
      });
  expect_equal("a.skeleton.toml",
               "[joint.knee]\nparent = \"hip\"\nhead = [0, 0.5, 0]\n\n[joint.hip] # above\nhead = "
               "[\n0, 0.9, 0]\n",
               [](const fs::path& file) {
                 std::string out;
                 for (const Joint& joint : read_skeleton_file(file).skeleton.joints)
                   out += joint.name + " " + std::to_string(joint.head.y()) + "\n";
                 return out;
               });
  expect_equal("a.poses.toml", "[pose.sit]\nhip = { flexion = 90 }\n[pose.\"other one\"]\n",
               [](const fs::path& file) {
                 std::string out;
                 for (const NamedPose& pose : read_pose_file(file))
                   out += pose.name + " " + std::to_string(pose.angles.size()) + "\n";
                 return out;
               });
}

}  // namespace
}  // namespace geoprior::skinning
