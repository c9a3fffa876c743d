// The skeleton file that `geoprior rig` writes.

#include "experiments/skinning/rig_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "experiments/skinning/scene/characters.h"
#include "testbed/formats/gltf/reader.h"
#include "tests/skinning/guess/skeletons.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::skinning {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string rig_text(const std::string& file) {
  return rig_command().run(file, TypedOptions<RigOptions>()).text;
}

TEST(RigCommand, WritesWhatIsReadBackAsTheSameSkeleton) {
  for (const char* name : {"animation_with_skeleton.glb", "glTF2/simple_skin/simple_skin.gltf"}) {
    const Skeleton own = *read_gltf(find_input(name, ".")).skeleton;
    const Skeleton back = parse_skeleton(rig_text(name), name).skeleton;
    ASSERT_EQ(back.size(), own.size());
    for (int j = 0; j < own.size(); ++j) {
      const Joint& a = own.joints[j];
      const Joint& b = back.joints[j];
      EXPECT_EQ(b.name, a.name);
      EXPECT_EQ(b.parent, a.parent);
      EXPECT_LE((b.head - a.head).norm(), 1e-6 * (1 + a.head.norm())) << a.name;
      ASSERT_EQ(b.tail.has_value(), a.tail.has_value()) << a.name;
      EXPECT_TRUE(b.axes.contains("flexion"));
    }
  }
}

TEST(RigCommand, IsAcceptedForTheSameCharacterAndKeepsItsWeights) {
  const std::string name = "animation_with_skeleton.glb";
  const auto file = std::filesystem::temp_directory_path() / "geoprior-rig.skeleton.toml";
  std::ofstream(file) << rig_text(name);
  CharacterOptions options;
  options.character = name;
  const Character own = load_character(options, ".");
  options.skeleton = file.string();
  const Character helped = load_character(options, ".");
  std::filesystem::remove(file);
  EXPECT_EQ(helped.rig.skeleton.size(), own.rig.skeleton.size());
  EXPECT_LT((helped.rig.weights - own.rig.weights).norm(), 1e-12);
  EXPECT_EQ(helped.warnings, own.warnings);
}

TEST(RigCommand, QuotesNamesThatAreNoBareKeys) {
  const std::vector<std::string> names{"mixamorig:Hips", "a.b",         "\"quoted\"\\", "",
                                       "Bein-Ä",         "tab\tand\x7f"};
  Skeleton skeleton;
  for (int i = 0; i < std::ssize(names); ++i) {
    skeleton.joints.push_back(fixtures::joint_at(names[i], i - 1, {0, static_cast<double>(i), 0}));
  }
  const Skeleton back =
      parse_skeleton(skeleton_file_text(fixtures::with_tails(skeleton), "x"), "x").skeleton;
  ASSERT_EQ(back.size(), skeleton.size());
  for (int j = 0; j < back.size(); ++j) EXPECT_EQ(back.joints[j].name, names[j]);
}

TEST(RigCommand, SaysWhatItGuessedFromAndWhatElseItCouldBe) {
  EXPECT_THAT(rig_text("animation_with_skeleton.glb"),
              AllOf(HasSubstr("# flexion: "), HasSubstr("# axes = { flexion = "),
                    HasSubstr("  # local "), HasSubstr("geoprior describe skeleton")));
}

TEST(RigCommand, RefusesWhatHasNoSkeletonAndNamesWhatIsRead) {
  EXPECT_THAT(test::error_of([] { rig_text("glTF2/BoxTextured-glTF-Binary/BoxTextured.glb"); }),
              HasSubstr("no skin: the file has no skeleton"));
  EXPECT_THAT(test::error_of([] { rig_text("nofile.glb"); }),
              HasSubstr("nofile.glb: no such file"));
  EXPECT_THAT(test::error_of([] { rig_text("bunny.off"); }), HasSubstr("glTF 2.0 (.glb, .gltf)"));
}

TEST(RigCommand, ScalesToMetres) {
  TypedOptions<RigOptions> centimetres;
  centimetres.options.unit_m = 0.01;
  const std::string name = "animation_with_skeleton.glb";
  const Skeleton large = parse_skeleton(rig_text(name), name).skeleton;
  const Skeleton small = parse_skeleton(rig_command().run(name, centimetres).text, name).skeleton;
  for (int j = 0; j < large.size(); ++j) {
    EXPECT_TRUE(small.joints[j].head.isApprox(0.01 * large.joints[j].head, 1e-6));
  }
}

}  // namespace
}  // namespace geoprior::skinning
