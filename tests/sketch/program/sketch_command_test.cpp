// What somebody gets of `geoprior sketch`: of a drawing that is right, and of whatever else.

#include "experiments/sketch/sketch_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "experiments/sketch/command/drawn_experiment.h"
#include "experiments/sketch/command/result_folder.h"
#include "experiments/sketch/drawing/drawing_file.h"
#include "experiments/sketch/scene/scene.h"
#include "experiments/sketch/topic.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/runner/execute.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/spec/spec.h"
#include "tests/testbed/await.h"
#include "tests/testbed/program_process.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::sketch {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

using Words = std::vector<std::string>;

const fs::path kShippedDrawings = GEOPRIOR_SOURCE_DIR "/experiments/sketch";

std::string replaced(std::string text, const std::string& word, const std::string& by) {
  return text.replace(text.find(word), word.size(), by);
}

/// The element of that name, which has no content.
std::string without_element(std::string text, const std::string& name) {
  const std::size_t first = text.find("<" + name);
  return text.erase(first, text.find("/>", first) + 2 - first);
}

class SketchProgram : public test::ScratchFolder {
 protected:
  /// A drawing of the repository, in the test's own folder.
  [[nodiscard]] fs::path drawing(const std::string& name) const {
    return write(name, read_whole_file(kShippedDrawings / name));
  }

  [[nodiscard]] std::unique_ptr<test::ProgramProcess> start(Words words) const {
    words.insert(words.begin(), "sketch");
    return std::make_unique<test::ProgramProcess>(
        [words] { return test::run_as_program(words, {make_topic()}); }, folder() / "log");
  }
  [[nodiscard]] int sketch(const Words& words) const { return start(words)->wait(); }

  void expect_refused(const Words& words, const std::string& why) const {
    const std::vector<fs::path> before = sorted_entries(folder());
    EXPECT_EQ(sketch(words), 2) << log();
    const std::string text = log();
    EXPECT_THAT(text, AllOf(StartsWith("error: "), HasSubstr(why)));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    fs::remove(folder() / "log");
    EXPECT_EQ(sorted_entries(folder()), before) << "it leaves nothing";
  }

  [[nodiscard]] std::string log() const { return read_whole_file(folder() / "log"); }

  /// Runs the experiment that the command has left, as `geoprior run` does.
  [[nodiscard]] RunRecord run_again(const fs::path& file) const {
    ExecuteRequest request;
    request.out = folder() / "again";
    request.timing = false;
    return execute(load_experiment(file, {make_topic()}, {}), {make_topic()}, request).record;
  }
};

void expect_files(const fs::path& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
  for (const fs::path& entry : sorted_entries(folder)) {
    EXPECT_FALSE(is_temporary_file(entry)) << entry;
  }
}

Part pattern_of(const fs::path& run_folder) {
  const OpenedRun run(run_folder);
  for (const StoredFile& file : run.record().cases[0].variants[0].frames.back().files) {
    if (fs::path(file.name).filename().string().starts_with("pattern")) return run.part(file);
  }
  return {};
}

// A pot of 90 mm across and 80 mm high, as Inkscape 1.2 writes it: labels, layers and groups with
// transforms, rectangles and circles, styles, guides. Its wall is a rectangle and its bottom a
// disc, together pi d h + pi d^2 / 4.
TEST_F(SketchProgram, LongMakesThePiecesOfADrawingOfInkscapes) {
  const fs::path file = drawing("pot.svg");
  ASSERT_EQ(sketch({file.string()}), 0) << log();
  const fs::path result = folder() / "pot-sketch";
  expect_files(result, {"pot.toml", "picture.png", "pattern.svg", "pattern.dxf", "pattern.pdf",
                        "surface.obj", "run/run.h5"});
  EXPECT_THAT(log(), AllOf(HasSubstr("pot.svg: several views (front, side, top)\n"),
                           HasSubstr(result.string() + "\n"), HasSubstr("  pattern.svg "),
                           HasSubstr("piece 1 of 2 "), HasSubstr("piece 2 of 2 ")));
  const Part pattern = pattern_of(result / "run");
  const double d = 0.09, h = 0.08;
  const double area = std::numbers::pi * d * (h + d / 4);
  EXPECT_NEAR(triangle_areas(pattern.points, pattern.triangles).sum(), area, 0.02 * area);
}

TEST_F(SketchProgram, LongLeavesTheExperimentThatGivesTheSameRun) {
  const fs::path file = drawing("armadillo.svg");
  ASSERT_EQ(sketch({file.string(), "--out", (folder() / "shell").string()}), 0) << log();
  const fs::path result = folder() / "shell";
  expect_files(result, {"armadillo.toml", "picture.png", "pattern.svg", "layers.glb"});
  EXPECT_THAT(read_whole_file(result / "armadillo.toml"), HasSubstr("\"../armadillo.svg\""));
  EXPECT_EQ(run_again(result / "armadillo.toml").content_sha256,
            OpenedRun(result / "run").record().content_sha256);
}

using ResultFolders = test::ScratchFolder;

TEST_F(ResultFolders, AreBesideTheDrawingUnderAFreeName) {
  const fs::path file = folder() / "my.svg";
  EXPECT_EQ(unused_result_folder(file), folder() / "my-sketch");
  fs::create_directories(folder() / "my-sketch");
  EXPECT_EQ(unused_result_folder(file), folder() / "my-sketch-2");
}

TEST_F(ResultFolders, AreFilledAtTheEndOrNotAtAll) {
  const fs::path place = folder() / "new" / "result";
  {
    const ResultFolder unfinished(place);
    std::ofstream(unfinished.unfinished() / "my.toml") << "half of it";
  }
  EXPECT_FALSE(fs::exists(folder() / "new"));
  ResultFolder finished(place);
  std::ofstream(finished.unfinished() / "my.toml") << "all of it";
  EXPECT_FALSE(fs::exists(place / "my.toml"));
  finished.commit("my.toml");
  finished.discard();
  EXPECT_EQ(sorted_entries(place), std::vector<fs::path>{place / "my.toml"});
}

TEST_F(SketchProgram, LongCarriesAPhotographOver) {
  write("bag.png", read_whole_file(kShippedDrawings / "bag.png"));
  const fs::path photo = folder() / "camera.png";
  fs::rename(folder() / "bag.png", photo);
  const fs::path file =
      write("bag.svg", without_element(read_whole_file(kShippedDrawings / "bag.svg"), "image"));
  const int code = sketch({file.string(), "--photo", photo.string()});
  ASSERT_TRUE(code == 0 || code == 1) << log();
  expect_files(folder() / "bag-sketch", {"texture.png", "model.obj", "picture.png", "bag.toml"});
  EXPECT_THAT(read_whole_file(folder() / "bag-sketch" / "bag.toml"),
              AllOf(HasSubstr("photo       = \"../camera.png\""), HasSubstr("textures    = {}")));
}

TEST_F(SketchProgram, RefusesWhatItCannotReadInOneLine) {
  expect_refused({(folder() / "none.svg").string()}, "none.svg: there is no such drawing");
  expect_refused({folder().string()}, "is a folder");
  const fs::path text = write("letter.svg", "Dear Sir or Madam");
  expect_refused({text.string()}, "letter.svg");
  const fs::path page =
      write("page.svg", "<svg xmlns='http://www.w3.org/2000/svg'><path d='M0 0 1 1'/></svg>");
  expect_refused({page.string()}, "has no view");
  const fs::path bare =
      write("bare.svg",
            "<svg xmlns='http://www.w3.org/2000/svg' width='9mm' height='9mm' viewBox='0 0 9 9'>"
            "<g id='view:photo'><path class='ruling' d='M0 0 1 1'/></g></svg>");
  expect_refused({bare.string()}, "neither borders nor arcs");
  const fs::path uneven =
      write("uneven.svg",
            replaced(read_whole_file(kShippedDrawings / "pot.svg"), "r=\"45\"", "r=\"40\""));
  expect_refused({uneven.string()}, "its extent along x differs");
}

TEST_F(SketchProgram, RefusesPhotographsThatAreNone) {
  const fs::path file =
      write("bag.svg", without_element(read_whole_file(kShippedDrawings / "bag.svg"), "image"));
  const auto with = [&](const fs::path& drawn, const fs::path& photo) {
    return Words{drawn.string(), "--photo", photo.string()};
  };
  expect_refused(with(file, folder() / "none.png"), "there is no such photograph");
  const fs::path text = write("text.png", "no picture");
  expect_refused(with(file, text), "neither PNG nor JPEG");
  const fs::path photo = write("bag.png", read_whole_file(kShippedDrawings / "bag.png"));
  const fs::path cut = write("cut.png", read_whole_file(photo).substr(0, 3000));
  // The library that reads it has a line of its own.
  EXPECT_EQ(sketch(with(file, cut)), 2);
  EXPECT_THAT(log(), HasSubstr("cut.png: the picture cannot be read"));
  EXPECT_FALSE(fs::exists(folder() / "bag-sketch"));
  fs::remove(folder() / "log");
  expect_refused(with(drawing("pot.svg"), photo), "goes with a drawing of one view");
  const fs::path wide = write("wide.svg", replaced(read_whole_file(file), "width=\"", "width=\"9"));
  expect_refused(with(wide, photo), "does not fit the drawing");
}

TEST_F(SketchProgram, RefusesFoldersThatItMayNotFill) {
  const fs::path file = drawing("armadillo.svg");
  expect_refused({file.string(), "--out", "/proc/sketch"}, "/proc/sketch");
  const fs::path taken = write("taken/notes.txt", "mine").parent_path();
  expect_refused({file.string(), "--out", taken.string()}, "a result is never overwritten");
  EXPECT_EQ(read_whole_file(taken / "notes.txt"), "mine");
  expect_refused({file.string(), "--out", file.string()}, "is no folder");
}

TEST_F(SketchProgram, LeavesNothingWhenItIsStopped) {
  const fs::path file = drawing("coat.svg");
  const std::unique_ptr<test::ProgramProcess> program = start({file.string()});
  const fs::path result = folder() / "coat-sketch";
  ASSERT_TRUE(test::await([&] { return !sorted_entries(result).empty(); }));
  program->signal(SIGINT);
  EXPECT_EQ(program->wait(), 2) << log();
  EXPECT_THAT(log(), HasSubstr("stopped"));
  EXPECT_FALSE(fs::exists(result));
}

TEST(DrawnExperiment, TellsKindsByWhatIsDrawn) {
  const auto kind = [](const char* name) {
    return drawn_kind(read_drawing(kShippedDrawings / name, {}).drawing);
  };
  EXPECT_EQ(kind("boot.svg"), DrawnKind::several_views);
  EXPECT_EQ(kind("tent.svg"), DrawnKind::one_view);
  EXPECT_EQ(kind("lobster.svg"), DrawnKind::layers);
}

/// With the comments that propose a key taken for what they propose.
std::string uncommented(std::string text) {
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;
    if (text.compare(at, 2, "# ") == 0 && text.substr(at, end - at).find(" = {") < end)
      text.erase(at, 2);
  }
  return text;
}

TEST(DrawnExperiment, ProposesOnlyWhatTheProgramKnows) {
  for (const DrawnKind kind : {DrawnKind::several_views, DrawnKind::one_view, DrawnKind::layers}) {
    DrawnExperiment experiment;
    experiment.title = "A \"title\" with quotes";
    experiment.command = "geoprior sketch my.svg";
    experiment.drawing = "../my.svg";
    experiment.kind = kind;
    experiment.textured = kind == DrawnKind::one_view;
    experiment.force = true;
    const std::string text = experiment_text(experiment);
    for (const std::string& version : {text, uncommented(text)}) {
      const Experiment read =
          load_recorded_experiment(version, "my.toml", "my.toml", {make_topic()});
      EXPECT_EQ(read.title, experiment.title);
      const auto& scene =
          dynamic_cast<const TypedOptions<SketchSceneOptions>&>(*read.cases[0].scene).options;
      EXPECT_EQ(scene.drawing, "../my.svg");
      ASSERT_TRUE(scene.fabrication);
      EXPECT_TRUE(scene.fabrication->force);
      EXPECT_EQ(scene.textures.has_value(), kind == DrawnKind::one_view);
    }
    EXPECT_EQ(text == uncommented(text), kind == DrawnKind::layers);
  }
}

}  // namespace
}  // namespace geoprior::sketch
