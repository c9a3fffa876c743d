// What somebody gets of `geoprior vary`, and of the models that an experiment names.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/assembly/files/gltf_parts.h"
#include "experiments/assembly/processes/process.h"
#include "experiments/assembly/scene/scene.h"
#include "experiments/assembly/topic.h"
#include "experiments/assembly/vary_command.h"
#include "models/assembly/exchange/embedding.h"
#include "testbed/formats/atomic_file.h"
#include "tests/assembly/assemblies.h"
#include "tests/assembly/files/gltf_scenes.h"
#include "tests/testbed/program_process.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::assembly {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

using Words = std::vector<std::string>;

const fs::path kVaryModels = GEOPRIOR_SOURCE_DIR "/experiments/assembly/models";

/// How many parts of each label a train has.
using TrainContents = std::map<std::string, int>;

class VaryProgram : public test::ScratchFolder {
 protected:
  fs::path write_train() const {
    return write("train.glb", test::text_of(test::ToyTrain().bytes()));
  }

  /// Runs `geoprior vary`, which writes into out/ unless the words say otherwise.
  int vary(const fs::path& scene, Words words = {}) const {
    words.insert(words.begin(), {"vary", scene.string()});
    if (std::find(words.begin(), words.end(), "--out") == words.end())
      words.insert(words.end(), {"--out", out().string()});
    test::ProgramProcess program([&] { return test::run_as_program(words, {make_topic()}); },
                                 folder() / "log");
    return program.wait();
  }

  /// The trains of a call, read again.
  [[nodiscard]] std::vector<TrainContents> trains(const Words& words) const {
    fs::remove_all(out());
    EXPECT_EQ(vary(write_train(), words), 0) << log();
    std::vector<TrainContents> all;
    for (const fs::path& file : files_in(out())) {
      const AssemblySet set = read_gltf_parts(file).read.set;
      TrainContents& train = all.emplace_back();
      for (const PlacedPart& part : set.models.front().parts) ++train[set.types[part.type].label];
    }
    return all;
  }

  [[nodiscard]] static std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    if (!fs::exists(folder)) return files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
  }

  void expect_refused(const fs::path& scene, const std::string& why,
                      const Words& words = {}) const {
    EXPECT_EQ(vary(scene, words), 2);
    EXPECT_THAT(log(), AllOf(StartsWith("error: "), HasSubstr(why)));
    const std::string text = log();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_THAT(files_in(out()), IsEmpty());
  }

  [[nodiscard]] fs::path out() const { return folder() / "out"; }
  [[nodiscard]] std::string log() const { return read_whole_file(folder() / "log"); }
};

nlohmann::json materials_of_glb(const fs::path& file) {
  return (*read_gltf_parts(file).scene.document)["materials"];
}

int longest_train(const std::vector<TrainContents>& trains) {
  int most = 0;
  for (const TrainContents& train : trains) most = std::max(most, train.at("wagon"));
  return most;
}

// Joints of the source are those of numbers in single precision.
TEST_F(VaryProgram, WritesScenesThatAreReadAgainWithTheirMaterials) {
  const fs::path scene = write_train();
  ASSERT_EQ(vary(scene), 0) << log();
  const GltfParts source = read_gltf_parts(scene);
  const std::vector<fs::path> files = files_in(out());
  ASSERT_THAT(files, SizeIs(16)) << "as many as it makes unless told otherwise";
  EXPECT_EQ(files.front().filename(), "train-01.glb");
  EXPECT_EQ(files.back().filename(), "train-16.glb");
  for (const fs::path& file : files) {
    EXPECT_THAT(log(), HasSubstr(file.string() + "\n"));
    const GltfParts read = read_gltf_parts(file);
    EXPECT_NO_THROW(require_valid(read.read.set)) << file;
    EXPECT_THAT(read.read.warnings, IsEmpty()) << file;
    const Assembly& model = read.read.set.models.front();
    EXPECT_EQ(components(model).count, 1) << file;
    EXPECT_EQ(model.connections.size() + 1, model.parts.size()) << file << ": no loops in a train";
    EXPECT_LT(largest(joint_misfits(model, read.read.set.types)).translation, 1e-6) << file;
    EXPECT_EQ(materials_of_glb(file), (*source.scene.document)["materials"]) << file;
  }
}

TEST_F(VaryProgram, LeavesTheTrainOnTheHeightThatItHad) {
  const fs::path scene = write_train();
  ASSERT_EQ(vary(scene), 0) << log();
  const auto lowest_engine = [](const fs::path& file) {
    const AssemblySet set = read_gltf_parts(file).read.set;
    for (const PlacedPart& part : set.models.front().parts) {
      const PartType& type = set.types[part.type];
      if (type.label == "engine") return lowest_point(type, part.pose);
    }
    return 0.0;
  };
  for (const fs::path& file : files_in(out()))
    EXPECT_NEAR(lowest_engine(file), lowest_engine(scene), 1e-6) << file;
}

// Over one connection a load is exchanged (three ways), or a rear end of one, two or three wagons
// for another: trains of one, two, four and five wagons.
TEST_F(VaryProgram, FindsTheSevenTrainsOfOneReplacementOverOneConnection) {
  const std::vector<TrainContents> all = trains({"--boundary", "1", "--generations", "1"});
  EXPECT_THAT(all, SizeIs(7));
  EXPECT_EQ(longest_train(all), 5);
}

TEST_F(VaryProgram, WritesNoMoreThanTheCount) {
  EXPECT_THAT(trains({"--count", "3"}), SizeIs(3));
  EXPECT_EQ(files_in(out()).back().filename(), "train-03.glb");
}

TEST_F(VaryProgram, FindsMoreOverTwoConnections) {
  const Words all{"--count", "500", "--generations", "1", "--boundary"};
  const auto up_to = [&](const std::string& boundary) {
    Words words = all;
    words.push_back(boundary);
    return trains(words);
  };
  const std::vector<TrainContents> one = up_to("1"), two = up_to("2");
  EXPECT_GT(two.size(), one.size());
  EXPECT_THAT(two, IsSupersetOf(one));
  // The wagon in the middle goes with its load.
  const TrainContents shorter{{"engine", 1}, {"wagon", 2}, {"crate", 2}};
  EXPECT_THAT(one, Not(::testing::Contains(shorter)));
  EXPECT_THAT(two, ::testing::Contains(shorter));
}

// A rear end of three wagons for one of one: two more each time.
TEST_F(VaryProgram, ReplacesAgainInEachGeneration) {
  const auto after = [&](const std::string& generations) {
    return longest_train(
        trains({"--count", "500", "--boundary", "1", "--generations", generations}));
  };
  EXPECT_EQ(after("1"), 5);
  EXPECT_EQ(after("2"), 7);
}

TEST_F(VaryProgram, KeepsThePartsThatStay) {
  const std::vector<TrainContents> all =
      trains({"--boundary", "1", "--generations", "1", "--keep", "crate"});
  EXPECT_THAT(all, SizeIs(3)) << "a crate for the barrel, and two longer trains";
  for (const TrainContents& train : all) EXPECT_GE(train.at("crate"), 2);
}

TEST_F(VaryProgram, HasNoVariationThatClosesBetterThanItsSourceAndSaysSo) {
  EXPECT_THAT(trains({"--gap-m", "0"}), IsEmpty());
  EXPECT_THAT(log(), HasSubstr("a larger gap (--gap-m)"));
  EXPECT_FALSE(fs::exists(out()));
  EXPECT_THAT(trains({"--gap-m", "0.001"}), SizeIs(16));
}

TEST_F(VaryProgram, WritesTheSameFilesAgain) {
  const fs::path scene = write_train(), second = folder() / "second";
  ASSERT_EQ(vary(scene), 0) << log();
  ASSERT_EQ(vary(scene, {"--out", second.string()}), 0) << log();
  const std::vector<fs::path> first = files_in(out());
  ASSERT_THAT(files_in(second), SizeIs(first.size()));
  for (const fs::path& file : first)
    EXPECT_EQ(read_whole_file(file), read_whole_file(second / file.filename())) << file;
}

TEST_F(VaryProgram, RefusesFilesThatAreNoScenesInOneLine) {
  expect_refused(folder() / "none.glb", "none.glb");
  const std::string train = read_whole_file(write_train());
  expect_refused(write("half.glb", train.substr(0, train.size() / 2)), "half.glb: truncated");
  expect_refused(write("train.txt", train), "train.txt");
  test::GltfToyScene plain;
  plain.add_node("box", -1, Eigen::Vector3d(0, 0, 0),
                 plain.add_box("box", {0, 0, 0}, {1, 1, 1}, plain.add_material("grey", {1, 1, 1})));
  expect_refused(write("plain.glb", test::text_of(plain.bytes())), "plain.glb");
}

TEST_F(VaryProgram, RefusesAFolderThatCannotBeMade) {
  const fs::path file = write("file", "no folder");
  expect_refused(write_train(), file.string(), {"--out", (file / "below").string()});
  EXPECT_EQ(read_whole_file(file), "no folder");
}

// Nobody, whatever the rights, makes a file in /proc.
TEST_F(VaryProgram, RefusesAFolderThatCannotBeWrittenInto) {
  expect_refused(write_train(), "/proc/train-01.glb", {"--out", "/proc"});
}

TEST_F(VaryProgram, VariesFilesOfAssembliesAndLayouts) {
  const auto expect_two_surfaces = [&](const fs::path& file) {
    fs::remove_all(out());
    ASSERT_EQ(vary(file, {"--count", "2"}), 0) << log();
    const std::vector<fs::path> files = files_in(out());
    ASSERT_THAT(files, SizeIs(2)) << file;
    for (const fs::path& glb : files) {
      EXPECT_THAT(glb.filename().string(), StartsWith(file.stem().string() + "-0"));
      EXPECT_THAT(read_whole_file(glb), StartsWith("glTF"));
    }
  };
  expect_two_surfaces(kVaryModels / "brick-track.assembly.toml");
  const fs::path layout = "/usr/share/xtrkcad/examples/timesavr.xtc";
  if (!fs::exists(layout)) GTEST_SKIP() << "the layouts of xtrkcad-common are not installed";
  expect_two_surfaces(layout);
}

std::vector<Assembly> models_of(const AssemblySceneOptions& options) {
  return load_assembly_scene(options, kVaryModels, 1)->input.set.models;
}

std::vector<std::string> model_names(const AssemblySceneOptions& options) {
  std::vector<std::string> names;
  for (const Assembly& model : models_of(options)) names.push_back(model.name);
  return names;
}

TEST(AssemblyScenes, TakeTheModelsAskedForFromTheirInputs) {
  AssemblySceneOptions options;
  options.inputs = {"rolling-toys.assembly.toml"};
  const std::vector<std::string> toys = model_names(options);
  EXPECT_THAT(toys, SizeIs(4));
  options.models = {toys[2]};
  EXPECT_THAT(model_names(options), ElementsAre(toys[2]));
  options.inputs.push_back("brick-track.assembly.toml");
  options.models.clear();
  EXPECT_THAT(model_names(options), AllOf(SizeIs(5), IsSupersetOf(toys)));
}

TEST(AssemblyScenes, LeaveOutModelsOfTooFewOrTooManyParts) {
  AssemblySceneOptions options;
  options.inputs = {"rolling-toys.assembly.toml"};
  std::vector<int> sizes;
  for (const Assembly& model : models_of(options))
    sizes.push_back(static_cast<int>(model.parts.size()));
  const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
  ASSERT_LT(*least, *most);
  const auto of_size = [&](int size) { return std::count(sizes.begin(), sizes.end(), size); };
  options.least_parts = *least + 1;
  EXPECT_THAT(model_names(options), SizeIs(4 - of_size(*least)));
  options.least_parts = 1;
  options.most_parts = *most - 1;
  EXPECT_THAT(model_names(options), SizeIs(4 - of_size(*most)));
}

/// Variations of a scene by one replacement.
int variation_count(const AssemblySceneOptions& options, const std::filesystem::path& folder) {
  const auto scene = load_assembly_scene(options, folder, 1);
  const auto run = recorded(*replacement_process(scene->input, exact_factory(2), true, {}));
  return static_cast<int>(std::count_if(run.frames.begin(), run.frames.end(),
                                        [](const Frame& frame) { return frame.parameter > 0; }));
}

class AssemblyScenesInFiles : public test::ScratchFolder {};

TEST_F(AssemblyScenesInFiles, OfSeveralPiecesVaryOnlyWhereTheyNeedNotHangTogether) {
  write("rods.toml", R"(
[[part]]
label = "long"
ports = [{ name = "a", at = [0, 0, 0], out = [-1, 0, 0] }, { name = "b", at = [0.2, 0, 0], out = [1, 0, 0] }]
[[part]]
label = "short"
ports = [{ name = "a", at = [0, 0, 0], out = [-1, 0, 0] }, { name = "b", at = [0.1, 0, 0], out = [1, 0, 0] }]
[[model]]
name = "rods"
parts = [{ id = "p", part = "long" }, { id = "q", part = "long" }, { id = "r", part = "short" }, { id = "s", part = "long" }]
joints = ["p.b q.a", "r.b s.a"]
place = [{ part = "p", at = [0, 0, 0] }, { part = "r", at = [0, 1, 0] }]
)");
  AssemblySceneOptions options;
  options.inputs = {"rods.toml"};
  EXPECT_EQ(variation_count(options, folder()), 0);
  options.rules.connected = false;
  EXPECT_GT(variation_count(options, folder()), 0);
}

}  // namespace
}  // namespace geoprior::assembly
