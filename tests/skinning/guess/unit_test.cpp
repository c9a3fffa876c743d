// The unit that a character is taken to be in where the scene does not say it.

#include "experiments/skinning/scene/guess/unit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/skinning/rig_command.h"
#include "experiments/skinning/scene/scene.h"
#include "tests/testbed/formats/gltf_samples.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::skinning {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(UnitGuess, LeavesWhatIsPlausibleInMetresAlone) {
  for (const double extent : {0.05, 0.2, 0.7, 1.7, 2.3, 5.0}) {
    for (const bool has_sides : {false, true}) {
      const FileUnit unit = guess_unit(extent, has_sides);
      EXPECT_EQ(unit.metres, 1) << extent;
      EXPECT_THAT(unit.taken_for, IsEmpty());
      EXPECT_FALSE(unit.is_doubtful);
    }
  }
}

TEST(UnitGuess, ABodyHasTheHeightOfOne) {
  EXPECT_EQ(guess_unit(166, true).metres, 0.01);
  EXPECT_EQ(guess_unit(1750, true).metres, 0.001);
  EXPECT_EQ(guess_unit(70, true).metres, 0.0254);
  EXPECT_EQ(guess_unit(16.6, true).metres, 0.1);
  EXPECT_EQ(guess_unit(16.6, true).taken_for, "decimetres");
}

TEST(UnitGuess, WhatHasNoSidesIsInCentimetresOrMillimetres) {
  EXPECT_EQ(guess_unit(19, false).metres, 0.01) << "a hand";
  EXPECT_EQ(guess_unit(450, false).metres, 0.01) << "a giraffe";
  EXPECT_EQ(guess_unit(600, false).metres, 0.001);
}

TEST(UnitGuess, WhereNoUnitMakesItPlausibleItIsMetresAndDoubtful) {
  for (const double extent : {0.0, 1e-6, 0.04, 7000.0, 1e300}) {
    const FileUnit unit = guess_unit(extent, true);
    EXPECT_EQ(unit.metres, 1) << extent;
    EXPECT_TRUE(unit.is_doubtful) << extent;
  }
}

/// The square of the samples, of one unit, scaled by its positions and bind matrices.
class CharacterOfUnknownUnit : public test::ScratchFolder {
 protected:
  void write_scaled(float factor) const {
    test::GltfSample sample = test::skinned_square();
    const auto scale = [&](std::size_t accessor, std::size_t floats, std::size_t first) {
      const std::size_t view = sample.json["accessors"][accessor]["bufferView"];
      const std::size_t offset = sample.json["bufferViews"][view]["byteOffset"];
      for (std::size_t i = 0; i < floats; ++i) {
        if (first > 0 && (i % 16 < first || i % 16 == 15)) continue;  // translations alone
        float value = 0;
        std::memcpy(&value, sample.binary.data() + offset + 4 * i, 4);
        value *= factor;
        std::memcpy(sample.binary.data() + offset + 4 * i, &value, 4);
      }
    };
    const std::size_t positions =
        sample.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
    const std::size_t bind = sample.json["skins"][0]["inverseBindMatrices"];
    scale(positions, 3 * sample.json["accessors"][positions]["count"].get<std::size_t>(), 0);
    scale(bind, 16 * sample.json["accessors"][bind]["count"].get<std::size_t>(), 12);
    write("my.glb", test::text_of(sample.bytes()));
  }
  [[nodiscard]] std::shared_ptr<SkinningScene> load(std::optional<double> unit_m) const {
    SkinningSceneOptions options;
    options.character.character = "my.glb";
    options.character.unit_m = unit_m;
    options.motion.joint = "knee";
    options.motion.axis = "+z";
    options.motion.frames = 2;
    options.regions = {"hip"};
    return load_skinning_scene(options, folder());
  }
};

TEST_F(CharacterOfUnknownUnit, IsScaledWithALineThatSaysWhatWasTakenAndWhichKeySaysOtherwise) {
  write_scaled(100);
  const auto scene = load(std::nullopt);
  EXPECT_NEAR(scene->rig.mesh.V.maxCoeff(), 1, 1e-6);
  EXPECT_NEAR(scene->rig.skeleton.joints[1].head.y(), 1, 1e-6);
  EXPECT_EQ(scene->facts().at("unit_m"), 0.01);
  EXPECT_THAT(scene->load_warnings,
              Contains(AllOf(HasSubstr("my.glb"), HasSubstr("measures 100 m"),
                             HasSubstr("centimetres, for 1 m"), HasSubstr("unit_m = 0.01"))));
  TypedOptions<RigOptions> options;
  const CommandText rig = rig_command().run((folder() / "my.glb").string(), options);
  EXPECT_THAT(rig.notices, Contains(HasSubstr("taken in centimetres")));
  EXPECT_THAT(rig.text, HasSubstr("head = [0, 1, 0]"));
}

TEST_F(CharacterOfUnknownUnit, KeepsTheUnitThatIsGivenWithoutAWord) {
  write_scaled(100);
  for (const double unit_m : {1.0, 0.02}) {
    const auto scene = load(unit_m);
    EXPECT_NEAR(scene->rig.mesh.V.maxCoeff(), 100 * unit_m, 1e-4);
    EXPECT_EQ(scene->facts().at("unit_m"), unit_m);
    EXPECT_THAT(scene->load_warnings, testing::Not(Contains(HasSubstr("unit_m"))));
  }
}

TEST_F(CharacterOfUnknownUnit, InMetresIsTakenSilently) {
  write_scaled(1);
  EXPECT_EQ(load(std::nullopt)->facts().at("unit_m"), 1);
  EXPECT_THAT(load(std::nullopt)->load_warnings, IsEmpty());
}

TEST_F(CharacterOfUnknownUnit, ThatIsPlausibleInNoneIsTakenInMetresAndSaidSo) {
  write_scaled(10000);
  const auto scene = load(std::nullopt);
  EXPECT_EQ(scene->facts().at("unit_m"), 1);
  EXPECT_THAT(scene->load_warnings,
              Contains(AllOf(HasSubstr("measures 10000 m"), HasSubstr("no other unit"))));
}

}  // namespace
}  // namespace geoprior::skinning
