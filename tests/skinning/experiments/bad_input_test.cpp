// Bad characters given to a whole run: one error that names file and place, and no folder is left.

#include <gmock/gmock.h>

#include <fstream>
#include <limits>

#include "core/error.h"
#include "experiments/skinning/topic.h"
#include "tests/testbed/formats/gltf_samples.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::skinning {
namespace {

using namespace test;

using ::testing::AllOf;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

template <class T>
void overwrite(GltfSample& s, std::size_t accessor, std::size_t at, T value) {
  const std::size_t view = s.json["accessors"][accessor]["bufferView"];
  const std::size_t offset = s.json["bufferViews"][view]["byteOffset"];
  std::memcpy(s.binary.data() + offset + at * sizeof(T), &value, sizeof(T));
}

/// A tetrahedron instead of the square; `inside_out` turns its triangles.
GltfSample skinned_tetrahedron(bool inside_out) {
  GltfSample s = skinned_square();
  const std::vector<std::uint16_t> out{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  const std::vector<std::uint16_t> in{0, 1, 2, 0, 3, 1, 1, 3, 2, 0, 2, 3};
  const auto positions = s.accessor<float>({0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 1}, "VEC3", 3, 5126);
  const auto indices = s.accessor<std::uint16_t>(inside_out ? in : out, "SCALAR", 1, 5123);
  auto& primitive = s.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["POSITION"] = positions;
  primitive["indices"] = indices;
  return s;
}

class BadCharacter : public RunTest {
 protected:
  [[nodiscard]] fs::path character() const { return folder() / "character.glb"; }
  [[nodiscard]] fs::path out() const { return folder() / "out"; }

  void write(const GltfSample& sample, std::size_t without_last = 0) const {
    const std::vector<std::byte> bytes = sample.bytes();
    std::ofstream(character(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size() - without_last));
  }

  [[nodiscard]] fs::path experiment(const std::string& scene_lines,
                                    const std::string& method = "linear-blend") const {
    return write_experiment("skinning/bad",
                            "title = \"Bad input\"\ntopic = \"skinning\"\n[scene]\n" + scene_lines +
                                "\n[[variant]]\nname = \"a\"\nmethod = \"" + method + "\"\n");
  }

  ExecuteResult run_skinning(const fs::path& file, bool resume = false) const {
    ExecuteRequest request;
    request.out = out();
    request.resume = resume;
    request.timing = false;
    return execute(load_experiment(file, {make_topic()}, {}), {make_topic()}, request);
  }

  /// The error of a run of the character's clip; fails when the run left anything.
  std::string refusal(const std::string& method = "linear-blend") const {
    const auto file = experiment(
        "character = \"character.glb\"\nmotion = { kind = \"clip\", frames = 2 }", method);
    fs::copy_file(character(), file.parent_path() / "character.glb",
                  fs::copy_options::overwrite_existing);
    const std::string error = error_of([&] { run_skinning(file); });
    EXPECT_THAT(error, HasSubstr((file.parent_path() / "character.glb").string()));
    EXPECT_FALSE(fs::exists(out())) << error;
    return error;
  }
};

TEST_F(BadCharacter, NamesFileAndPlaceAndLeavesNoFolder) {
  write(skinned_square(), 7);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("truncated"), HasSubstr("bad.toml")));

  GltfSample nan = skinned_square();
  overwrite(nan, 0, 4, std::numeric_limits<float>::quiet_NaN());
  write(nan);
  EXPECT_THAT(refusal(), HasSubstr("vertex 1: position is not finite"));

  GltfSample index = skinned_square();
  overwrite<std::uint16_t>(index, 1, 5, 4);
  write(index);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("index 4 at place 5"), HasSubstr("allowed: 0 to 3")));

  GltfSample weightless = skinned_square();
  overwrite<float>(weightless, 3, 8, 0);
  write(weightless);
  EXPECT_THAT(refusal(), HasSubstr("vertex 2: its weights sum to 0"));

  GltfSample singular = skinned_square();
  overwrite<float>(singular, 4, 16, 0);
  write(singular);
  EXPECT_THAT(refusal(), HasSubstr("bind matrix of joint 1: singular"));

  GltfSample cyclic = skinned_square();
  cyclic.json["nodes"][2]["children"] = {1};
  write(cyclic);
  EXPECT_THAT(refusal(), HasSubstr("cyclic"));

  GltfSample bare = skinned_square();
  bare.json.erase("skins");
  bare.json["nodes"][0].erase("skin");
  write(bare);
  EXPECT_THAT(refusal(), HasSubstr("no skin, and the scene names no skeleton file"));
}

TEST_F(BadCharacter, OpenOrNonManifoldIsRefusedWhereAnInsideIsNeeded) {
  write(skinned_square());
  EXPECT_THAT(refusal("implicit"), AllOf(HasSubstr("closed mesh"), HasSubstr("0-1")));

  GltfSample fin = skinned_tetrahedron(false);
  fin.json["meshes"][0]["primitives"][0]["indices"] =
      fin.accessor<std::uint16_t>({0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2, 0, 2, 1}, "SCALAR", 1, 5123);
  write(fin);
  EXPECT_THAT(refusal("implicit"), AllOf(HasSubstr("manifold mesh"), HasSubstr("0-2")));
}

TEST_F(BadCharacter, ClosedSkinThatFacesInwardsIsTurnedWithAWarning) {
  const auto file =
      experiment("character = \"character.glb\"\nmotion = { kind = \"clip\", frames = 2 }");
  for (const bool inside_out : {false, true}) {
    fs::remove_all(out());
    write(skinned_tetrahedron(inside_out));
    fs::copy_file(character(), file.parent_path() / "character.glb",
                  fs::copy_options::overwrite_existing);
    const CaseRecord record = run_skinning(file).record.cases.at(0);
    EXPECT_EQ(record.warnings.size(), inside_out ? 1U : 0U);
    for (const auto& warning : record.warnings) EXPECT_THAT(warning, HasSubstr("faced inwards"));
  }
}

TEST_F(BadCharacter, OpenMeshOfTheTestModelsRunsThroughTheBaselines) {
  for (const char* method : {"linear-blend", "dual-quaternion", "centers-of-rotation", "delta-mush",
                             "direct-delta-mush"}) {
    fs::remove_all(out());
    const auto result =
        run_skinning(experiment("character = \"glTF2/simple_skin/simple_skin.gltf\"\n"
                                "motion = { kind = \"clip\", frames = 3 }",
                                method));
    EXPECT_EQ(result.record.cases.at(0).variants.at(0).frames.size(), 3U) << method;
  }
}

TEST_F(BadCharacter, MotionOfAnUnknownJointNamesTheExperiment) {
  const auto file =
      experiment("character = \"cylinder\"\nmotion = { joint = \"knee\", frames = 2 }");
  EXPECT_THAT(error_of([&] { run_skinning(file); }),
              AllOf(HasSubstr("bad.toml"), HasSubstr("no joint 'knee'"), HasSubstr("upper")));
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(BadCharacter, FolderThatWasThereStays) {
  const auto file =
      experiment("character = \"character.glb\"\nmotion = { kind = \"clip\", frames = 2 }");
  write(skinned_square(), 7);
  fs::copy_file(character(), file.parent_path() / "character.glb");
  fs::create_directories(out());
  EXPECT_THAT(error_of([&] { run_skinning(file); }), HasSubstr("truncated"));
  EXPECT_TRUE(fs::is_empty(out()));
}

// What the first variant has done is kept for --resume.
TEST_F(BadCharacter, EarlierResultsAreKept) {
  const auto file =
      experiment("character = \"cylinder\"\nmotion = { joint = \"upper\", frames = 2 }");
  std::ofstream(file, std::ios::app) << "[[variant]]\nname = \"b\"\nmethod = \"implicit\"\n"
                                        "options = { joint_blends = [{ joint = \"knee\" }] }\n";
  EXPECT_THAT(error_of([&] { run_skinning(file); }), HasSubstr("variant 'b'"));
  EXPECT_TRUE(fs::exists(out() / "journal.jsonl"));
  EXPECT_FALSE(fs::exists(out() / "run.h5"));
}

TEST_F(BadCharacter, AnOpenMeshIsNoneForFieldsAndTheOthersRun) {
  const auto file =
      experiment("character = \"character.glb\"\nmotion = { kind = \"clip\", frames = 2 }");
  write(skinned_square());
  fs::copy_file(character(), file.parent_path() / "character.glb");
  std::ofstream(file, std::ios::app) << "[[variant]]\nname = \"b\"\nmethod = \"implicit\"\n";
  const ExecuteResult result = run_skinning(file);
  const std::vector<VariantRecord>& variants = result.record.cases.at(0).variants;
  EXPECT_EQ(variants.at(0).frames.size(), 2U);
  EXPECT_EQ(variants.at(1).status, "failed");
  EXPECT_THAT(variants.at(1).error,
              AllOf(HasSubstr("character.glb"), HasSubstr("closed mesh"), HasSubstr("0-1")));
}

TEST_F(BadCharacter, FileGivenAsFolderIsNamed) {
  std::ofstream(out()) << "precious";
  const auto file =
      experiment("character = \"cylinder\"\nmotion = { joint = \"upper\", frames = 2 }");
  EXPECT_THAT(error_of([&] { run_skinning(file); }),
              AllOf(HasSubstr(out().string()), HasSubstr("is no folder")));
  EXPECT_EQ(text_of(out()), "precious");
}

TEST_F(BadCharacter, AsksForNoMeshThatDoesNotFit) {
  const std::string motion = "motion = { joint = \"upper\", frames = 2 }\n";
  const auto refused = [&](const std::string& lines) {
    const auto file = experiment("character = \"cylinder\"\n" + lines + motion);
    const std::string error = error_of([&] { run_skinning(file); });
    EXPECT_FALSE(fs::exists(out())) << error;
    return error;
  };
  EXPECT_THAT(refused("cylinder = { segments = 100000, rings_per_half = 10000 }\n"),
              AllOf(HasSubstr("bad.toml:5:"), HasSubstr("scene.cylinder.segments: asks for"),
                    HasSubstr("TB of memory")));
  EXPECT_THAT(
      refused("refine = [{ levels = 5 }, { levels = 0 }, { levels = 5 }, { levels = 5 }]\n"),
      AllOf(HasSubstr("bad.toml:5:"), HasSubstr("scene.refine."), HasSubstr(".levels: asks for"),
            HasSubstr("vertices")));
  ::setenv("GEOPRIOR_MEMORY_GB", "0.1", 1);
  EXPECT_THAT(refused("refine = [{ region = [\"upper\"], levels = 1 }, { region = [\"upper\"], "
                      "levels = 5 }]\n"),
              HasSubstr("scene.refine.1.levels: asks for"));
  ::unsetenv("GEOPRIOR_MEMORY_GB");
}

TEST_F(BadCharacter, AsksForNoFieldsThatDoNotFit) {
  const auto file = write_experiment(
      "skinning/bad",
      "title = \"Bad input\"\ntopic = \"skinning\"\n[scene]\ncharacter = \"cylinder\"\n"
      "motion = { joint = \"upper\", frames = 2 }\n[[variant]]\nname = \"a\"\n"
      "method = \"implicit\"\noptions = { grid = 256 }\n");
  ::setenv("GEOPRIOR_MEMORY_GB", "0.3", 1);
  EXPECT_THAT(error_of([&] { run_skinning(file); }),
              AllOf(HasSubstr("bad.toml:9:13"), HasSubstr("options.grid: asks for 33554432 nodes "
                                                          "of the fields of 2 bones")));
  ::unsetenv("GEOPRIOR_MEMORY_GB");
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(BadCharacter, NamesTheSkeletonThatIsNestedTooDeep) {
  std::string deep = "[joint.a";
  for (int i = 0; i < 100000; ++i) deep += ".a";
  const fs::path skeleton = folder() / "experiments" / "skinning" / "deep.skeleton.toml";
  fs::create_directories(skeleton.parent_path());
  std::ofstream(skeleton) << deep << "]\n";
  const auto file = experiment(
      "character = \"cylinder\"\nskeleton = \"deep.skeleton.toml\"\n"
      "motion = { joint = \"upper\", frames = 2 }\n");
  EXPECT_THAT(error_of([&] { run_skinning(file); }),
              AllOf(HasSubstr("deep.skeleton.toml:1"), HasSubstr("too many parts")));
}

}  // namespace
}  // namespace geoprior::skinning
