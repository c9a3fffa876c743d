// Bad animations, tanks and edits given to a whole run: one error or a named warning, and an
// interrupted simulation that ends as an undisturbed one does.

#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "core/mesh.h"
#include "experiments/fluid/topic.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/view/mesh_text.h"
#include "tests/fluid/features/map_waves.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::fluid {
namespace {

using namespace test;

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace fs = std::filesystem;

Part part_of(const TriMesh& mesh) {
  Part part;
  part.points = mesh.V;
  part.triangles = mesh.F;
  return part;
}

/// A tank of 2 m, calm at first; from the fifth frame on a hill grows in it, to 0.26 m.
TriMesh splash_frame(int i) {
  TriMesh mesh = waves::tank(40, 2, 1, 0.2);
  const double height = i < 4 ? 0 : 0.1 + 0.015 * i;
  for (Eigen::Index v = 0; v < 41 * 41; ++v) {
    const double r = std::hypot(mesh.V(v, 0) - 1, mesh.V(v, 1) - 1) / 0.2;
    mesh.V(v, 2) += height * std::exp(-0.5 * r * r);
  }
  return mesh;
}

class BadFluid : public RunTest {
 protected:
  void SetUp() override {
    RunTest::SetUp();
    for (int i = 0; i < 12; ++i) write_ply(i, splash_frame(i));
    write("still.ply", part_to_ply(part_of(waves::tank(40, 2, 1, 0.2)), ""));
    write("coarse.ply", part_to_ply(part_of(waves::tank(4, 2, 1, 0)), ""));
  }
  /// A file beside the experiment.
  void write(const std::string& name, const std::string& text) const {
    const fs::path place = folder() / "experiments" / "fluid" / name;
    fs::create_directories(place.parent_path());
    std::ofstream(place, std::ios::binary) << text;
  }
  void write_ply(int i, const TriMesh& mesh) const {
    write("s_" + std::to_string(i) + ".ply", part_to_ply(part_of(mesh), ""));
  }

  ExecuteResult run_fluid(const std::string& method, const std::string& scene_lines,
                          const std::string& options = "", bool resume = false) const {
    const fs::path file =
        write_experiment("fluid/bad", "title = \"Bad input\"\ntopic = \"fluid\"\n[scene]\n" +
                                          scene_lines + "\n[[variant]]\nname = \"v\"\nmethod = \"" +
                                          method + "\"\noptions = { " + options + " }\n");
    ExecuteRequest request;
    request.out = folder() / "out";
    request.timing = false;
    request.resume = resume;
    return execute(load_experiment(file, {make_topic()}, {}), {make_topic()}, request);
  }
  /// The error of a run that leaves nothing.
  [[nodiscard]] std::string refusal(const std::string& method, const std::string& scene_lines,
                                    const std::string& options = "") const {
    const std::string error = error_of([&] { run_fluid(method, scene_lines, options); });
    EXPECT_FALSE(fs::exists(folder() / "out")) << error;
    return error;
  }
  /// Warnings of the scene, and events of kind "warning: …" of its run.
  [[nodiscard]] std::vector<std::string> warnings(const std::string& method,
                                                  const std::string& scene_lines,
                                                  const std::string& options = "") const {
    const CaseRecord record = run_fluid(method, scene_lines, options).record.cases.front();
    std::vector<std::string> all = record.warnings;
    for (const Event& event : record.variants.front().events) all.push_back(event.kind);
    fs::remove_all(folder() / "out");
    return all;
  }
};

const std::string kSplash =
    "sequences = [{ name = \"splash\", path = \"s_%d.ply\", frames_per_second = 25 }]\n";
const std::string kPaste = "start = 0.4\nduration = 0.04\n" + kSplash;
const std::string kStill = "target = { kind = \"mesh\", file = \"still.ply\" }\n";
const std::string kHill = "edits = [{ name = \"hill\", source = \"splash\", ids = [1] }]\n";

TEST_F(BadFluid, IsNoneWhenAllIsWell) {
  EXPECT_THAT(warnings("extract", kSplash), IsEmpty());
  EXPECT_THAT(warnings("sculpt", kPaste + kStill + kHill), IsEmpty());
}

// Frame 4 is none of those that are read when the sequence is opened.
TEST_F(BadFluid, NamesTheFrameThatCannotBeRead) {
  const std::string good = part_to_ply(part_of(splash_frame(4)), "");
  write("s_4.ply", good.substr(0, good.size() / 2));
  EXPECT_THAT(refusal("extract", kSplash),
              AllOf(HasSubstr("s_4.ply, byte"), HasSubstr("is truncated")));
  write("s_4.ply", part_to_ply(part_of({}), ""));
  EXPECT_THAT(refusal("extract", kSplash), AllOf(HasSubstr("s_4.ply"), HasSubstr("empty frame")));
  TriMesh nan = splash_frame(4);
  nan.V(17, 2) = std::nan("");
  write_ply(4, nan);
  EXPECT_THAT(refusal("extract", kSplash),
              AllOf(HasSubstr("s_4.ply"), HasSubstr("vertex 17 is not finite")));
  TriMesh fin = splash_frame(4);
  fin.F.conservativeResize(fin.F.rows() + 1, 3);
  fin.F.bottomRows(1) << fin.F(500, 0), fin.F(500, 1), 3;
  write_ply(4, fin);
  EXPECT_THAT(refusal("extract", kSplash),
              AllOf(HasSubstr("s_4.ply"), HasSubstr("belongs to 3 triangles")));
}

TEST_F(BadFluid, IsToldOfAFrameThatIsInsideOutWhereverItIs) {
  TriMesh inward = splash_frame(4);
  inward.F.col(0).swap(inward.F.col(1));
  write_ply(4, inward);
  EXPECT_THAT(warnings("extract", kSplash),
              Contains(AllOf(HasSubstr("frame 4"), HasSubstr("the mesh is inside out"))));
  const std::string target =
      "target = { kind = \"sequence\", path = \"s_%d.ply\", frames_per_second = 25 }\n";
  EXPECT_THAT(warnings("sculpt", "duration = 0.04\nstart = 0.16\n" + kSplash + target + kHill),
              Contains(AllOf(HasSubstr("target: "), HasSubstr("inside out"))));
}

TEST_F(BadFluid, IsToldOfOneFrameAndOfTwoRates) {
  EXPECT_THAT(warnings("extract", "sequences = [{ name = \"one\", path = \"s_5.ply\" }]\n"),
              Contains(AllOf(HasSubstr("s_5.ply"), HasSubstr("one frame"))));
  std::vector<PvdEntry> entries;
  double time = 0;
  for (int i = 0; i < 12; ++i) {
    entries.push_back({time, "s_" + std::to_string(i) + ".ply", ""});
    time += i < 6 ? 0.04 : 0.05;
  }
  write("two.pvd", pvd_text(entries));
  EXPECT_THAT(warnings("extract", "sequences = [{ name = \"two\", path = \"two.pvd\" }]\n"),
              Contains(AllOf(HasSubstr("two.pvd"), HasSubstr("more than one frame rate"))));
}

TEST_F(BadFluid, NamesTheFeatureThatIsNotThere) {
  EXPECT_THAT(refusal("sculpt", kPaste + kStill +
                                    "edits = [{ name = \"e\", source = \"splash\", ids = [7] }]\n"),
              AllOf(HasSubstr("edit 'e': there is no feature 7"), HasSubstr("allowed: 1")));
  EXPECT_THAT(
      refusal("sculpt", kPaste + kStill + "edits = [{ name = \"e\", source = \"splash\" }]\n",
              "extraction = { shortest_track = 50 }"),
      AllOf(HasSubstr("edit 'e': no feature"), HasSubstr("shortest_track")));
}

TEST_F(BadFluid, NamesTheEditThatLeavesTheTarget) {
  EXPECT_THAT(refusal("sculpt", kPaste + kStill +
                                    "edits = [{ name = \"e\", source = \"splash\", ids = [1], move "
                                    "= [9, 0, 0] }]\n"),
              AllOf(HasSubstr("edit 'e', feature 1"), HasSubstr("off the target at all times")));
  // At first on the target, one frame later 7 m beside it.
  EXPECT_THAT(warnings("sculpt",
                       kPaste + kStill +
                           "edits = [{ name = \"e\", source = \"splash\", ids = [1], trajectory = "
                           "[{ t = 0.4, position = [1, 1, 0] }, { t = 0.44, position = [9, 1, "
                           "0] }] }]\n"),
              Contains(HasSubstr("edit 'e' lies off the target at")));
}

TEST_F(BadFluid, IsToldOfEditsThatOverlap) {
  EXPECT_THAT(
      warnings("sculpt", kPaste + kStill +
                             "edits = [{ name = \"a\", source = \"splash\", ids = [1] }, { name = "
                             "\"b\", source = \"splash\", ids = [1], move = [0.1, 0, 0] }]\n"),
      Contains(HasSubstr("edits 'a' and 'b' overlap")));
}

// Edges of half a metre under a hill whose standard deviation is 0.2 m.
TEST_F(BadFluid, CoarseTargetsAreRefinedOrRefusedWithTheEdgeNeeded) {
  const std::string coarse = "start = 0.4\nduration = 0.01\n" + kSplash +
                             "target = { kind = \"mesh\", file = \"coarse.ply\" }\n" + kHill;
  EXPECT_THAT(refusal("sculpt", coarse, "paste = { refine = false }"),
              AllOf(HasSubstr("edit 'hill'"), HasSubstr("too coarse for the map"),
                    HasSubstr("edges of about")));
  EXPECT_THAT(
      refusal("sculpt", coarse, "paste = { max_triangles = 100 }"),
      AllOf(HasSubstr("the refined target would have more than"), HasSubstr("max_triangles, 100")));
  EXPECT_THAT(warnings("sculpt", coarse), IsEmpty());
}

const std::string kPoolScene =
    "volumes = [{ name = \"pool\", shape = { kind = \"box\", centre = [0.1, 0.1, 0.05], size = "
    "[0.2, 0.2, 0.1] } }]";
std::string tank_of(const std::string& lines) {
  return "duration = 0.1\nframe_interval = 0.02\ntank = { size = [0.4, 0.2, 0.2], cell = 0.025, " +
         lines + " }\n";
}

TEST_F(BadFluid, NamesWhatATankCannotHold) {
  EXPECT_THAT(
      refusal("liquid", "tank = { size = [10, 10, 10], cell = 0.001, " + kPoolScene + " }\n"),
      AllOf(HasSubstr("bad.toml:4:"), HasSubstr("scene.tank"), HasSubstr("cells need about"),
            HasSubstr("GB"), HasSubstr("fits into")));
  EXPECT_THAT(refusal("liquid",
                      tank_of(kPoolScene + ", solids = [{ name = \"hull\", shape = { kind = "
                                           "\"sphere\", centre = [0.3, 0.1, 0.1], radius = 0.05 }, "
                                           "keys = [{ t = 0 }, { t = 0.1, move = [1, 0, 0] }] }]")),
              AllOf(HasSubstr("bad.toml:6:"), HasSubstr("scene.tank.solids.0"),
                    HasSubstr("'hull' is outside the domain at")));
  EXPECT_THAT(refusal("liquid", tank_of("open_top = true")),
              AllOf(HasSubstr("scene.tank"), HasSubstr("no liquid")));
}

TEST_F(BadFluid, NamesTheUnknownKey) {
  EXPECT_THAT(refusal("liquid", tank_of("cells = 8, " + kPoolScene)),
              AllOf(HasSubstr("bad.toml:6:"), HasSubstr("scene.tank.cells: unknown key"),
                    HasSubstr("did you mean 'cell'?")));
  EXPECT_THAT(refusal("liquid", tank_of(kPoolScene), "flip = 0.9"),
              HasSubstr("variant.v.options.flip: unknown key"));
  write("edits.toml", "[[edit]]\nsource = \"splash\"\nmovee = [1, 0, 0]\n");
  EXPECT_THAT(refusal("sculpt", kPaste + kStill + "edit_list = \"edits.toml\"\n"),
              AllOf(HasSubstr("edits.toml:3:"), HasSubstr("unknown key")));
}

TEST_F(BadFluid, NamesFileAndPlaceOfAnEditWithoutMeaning) {
  write("edits.toml", "[[edit]]\nname = \"a\"\nsource = \"sea\"\n");
  const std::string list = kPaste + kStill + "edit_list = \"edits.toml\"\n";
  EXPECT_THAT(refusal("sculpt", list),
              AllOf(HasSubstr("edits.toml: edit.0.source"), HasSubstr("allowed: splash")));
  write("edits.toml", "[[edit]]\nname = \"a\"\n[[edit]]\nname = \"a\"\n");
  EXPECT_THAT(refusal("sculpt", list),
              AllOf(HasSubstr("edits.toml: edit.1.name"), HasSubstr("'a' is taken")));
  EXPECT_THAT(refusal("sculpt", kPaste + kStill + "edits = [{ name = \"e\", box = [1, 2] }]\n"),
              AllOf(HasSubstr("scene.edits.0"), HasSubstr("six numbers")));
}

/// A block of water that collapses, in 16 frames.
class KilledLiquid : public BadFluid {
 protected:
  void SetUp() override { RunTest::SetUp(); }

  [[nodiscard]] ExecuteResult run_dam(const fs::path& out, bool resume) const {
    const fs::path file = write_experiment(
        "fluid/killed",
        "title = \"A killed simulation\"\ntopic = \"fluid\"\nseed = 1\n[scene]\nduration = 0.3\n"
        "frame_interval = 0.02\ntank = { size = [0.4, 0.2, 0.2], cell = 0.025, " +
            kPoolScene + " }\n[[variant]]\nname = \"v\"\nmethod = \"liquid\"\n");
    ExecuteRequest request;
    request.out = out;
    request.timing = false;
    request.resume = resume;
    return execute(load_experiment(file, {make_topic()}, {}), {make_topic()}, request);
  }
  static std::size_t frames_logged(const fs::path& out) {
    const std::string text = text_of(out / "journal.jsonl"), line = "\"kind\":\"frame\"";
    std::size_t count = 0;
    for (auto at = text.find(line); at != std::string::npos; at = text.find(line, at + 1)) ++count;
    return count;
  }
  /// Runs the simulation and kills the program once some frames are logged.
  void die_in_the_middle(const fs::path& out) const {
    std::thread([&] {
      while (frames_logged(out) < 3) std::this_thread::sleep_for(std::chrono::microseconds(100));
      ::kill(::getpid(), SIGKILL);
    }).detach();
    static_cast<void>(run_dam(out, false));
  }
};

TEST_F(KilledLiquid, GoesOnAtItsLastFrameAndEndsAsUndisturbed) {
  // The program that dies runs this test again from its beginning, in the folder of this one.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  constexpr const char* kFolder = "GEOPRIOR_TEST_KILLED";
  const char* of_parent = std::getenv(kFolder);
  const fs::path out = of_parent != nullptr ? fs::path(of_parent) : folder() / "out";
  ::setenv(kFolder, out.c_str(), 1);
  EXPECT_EXIT(die_in_the_middle(out), ::testing::KilledBySignal(SIGKILL), "");
  ::unsetenv(kFolder);
  const std::size_t before = frames_logged(out);
  ASSERT_GE(before, 3U);
  ASSERT_LT(before, 16U);
  ASSERT_FALSE(fs::exists(out / "run.h5"));
  const ExecuteResult resumed = run_dam(out, true);
  EXPECT_LE(frames_logged(out), 16U + 1U) << "one frame may lack its checkpoint";
  const ExecuteResult undisturbed = run_dam(folder() / "undisturbed", false);
  EXPECT_EQ(resumed.record.content_sha256, undisturbed.record.content_sha256);
  EXPECT_EQ(lasting_files(out), lasting_files(undisturbed.folder));
}

TEST_F(BadFluid, AsksForNoMoreFramesThanCanBeNumbered) {
  EXPECT_THAT(refusal("liquid", "duration = 1e12\ntank = { " + kPoolScene + " }\n"),
              AllOf(HasSubstr("bad.toml:4:1"), HasSubstr("scene.duration: asks for"),
                    HasSubstr("frames of 0.04 s"), HasSubstr("at most 100000")));
}

TEST_F(BadFluid, AsksForNoGridThatDoesNotFit) {
  EXPECT_THAT(
      refusal("liquid", "tank = { size = [1e18, 1, 1], cell = 1e-3, " + kPoolScene + " }\n"),
      AllOf(HasSubstr("bad.toml:4:"), HasSubstr("scene.tank.size.0: asks for"),
            HasSubstr("cells")));
  ::setenv("GEOPRIOR_MEMORY_GB", "0.004", 1);
  EXPECT_THAT(refusal("ocean", "duration = 1\n", "samples = 1024, tiles = 8"),
              AllOf(HasSubstr("bad.toml:9:"), HasSubstr("options.samples: asks for 67125249"),
                    HasSubstr("GB of memory")));
  EXPECT_THAT(refusal("ocean", "target = { kind = \"ocean\", ocean = { samples = 1024 } }\n"),
              AllOf(HasSubstr("bad.toml:4:"), HasSubstr("scene.target.ocean.samples: asks for")));
  EXPECT_THAT(refusal("liquid", tank_of(kPoolScene), "surface = { cells_per_cell = 8 }"),
              AllOf(HasSubstr("bad.toml:"), HasSubstr("options.surface.cells_per_cell: asks for")));
  EXPECT_THAT(refusal("extract", "injected = { resolution = 16 }\n"),
              HasSubstr("scene.injected.resolution: asks for"));
  ::unsetenv("GEOPRIOR_MEMORY_GB");
}

}  // namespace
}  // namespace geoprior::fluid
