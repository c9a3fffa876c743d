// Options that are a matter of the user's input or taste, each from an experiment file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "core/error.h"
#include "experiments/fluid/scene/scene.h"
#include "experiments/fluid/topic.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::fluid {
namespace {

namespace fs = std::filesystem;

using ::testing::HasSubstr;

class FluidChoices : public test::RunTest {
 protected:
  [[nodiscard]] Experiment loaded(const std::string& scene_lines, const std::string& method,
                                  const std::string& options) const {
    const fs::path file = write_experiment(
        "fluid/choices", "title = \"Choices\"\ntopic = \"fluid\"\n[scene]\n" + scene_lines +
                             "\n[[variant]]\nname = \"v\"\nmethod = \"" + method +
                             "\"\noptions = { " + options + " }\n");
    return load_experiment(file, {make_topic()}, {});
  }
  /// What a [scene] table describes.
  [[nodiscard]] FluidScene scene(const std::string& lines) const {
    const Experiment experiment = loaded(lines, "liquid", "");
    const auto made =
        make_topic().load(*experiment.cases[0].scene, folder() / "experiments" / "fluid", 1);
    return dynamic_cast<const FluidScene&>(*made);
  }
  [[nodiscard]] ExecuteResult run(const std::string& scene_lines, const std::string& method,
                                  const std::string& options = "") const {
    ExecuteRequest request;
    request.out = folder() / "out";
    request.timing = false;
    return execute(loaded(scene_lines, method, options), {make_topic()}, request);
  }
  /// The error that ends a run, whether or not it leaves frames.
  [[nodiscard]] std::string failure(const std::string& scene_lines, const std::string& method,
                                    const std::string& options = "") const {
    std::string error;
    try {
      error = run(scene_lines, method, options).record.cases.front().variants.front().error;
    } catch (const Error& e) {
      error = e.what();
    }
    fs::remove_all(folder() / "out");
    return error;
  }
  /// A tetrahedron at (x, 0, 0) beside the experiment.
  void write_solid(const std::string& name, double x) const {
    const fs::path place = folder() / "experiments" / "fluid" / name;
    fs::create_directories(place.parent_path());
    const std::string a = std::to_string(x), b = std::to_string(x + 1);
    std::ofstream(place) << "v " << a << " 0 0\nv " << b << " 0 0\nv " << a << " 1 0\nv " << a
                         << " 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  }
  void write_sequences() const {
    for (int i = 0; i < 4; ++i) {
      write_solid("run/surface_" + std::to_string(i) + ".obj", i);
      write_solid("run/bed_" + std::to_string(i) + ".obj", 10 + i);
    }
  }
};

double first_x(const SurfaceSequence& sequence) { return sequence.frame(0).mesh.V(0, 0); }

void expect_choices(const std::function<const SurfaceSequence&(const std::string&)>& with) {
  EXPECT_EQ(with("").frame_count(), 4);
  EXPECT_EQ(first_x(with("")), 0);
  EXPECT_EQ(first_x(with(", part = \"bed\"")), 10);
  EXPECT_EQ(first_x(with(", part = \"bed\", scale = 0.5")), 5);
  EXPECT_EQ(with(", up = \"y\"").frame(0).mesh.V(2, 2), 1);
  EXPECT_EQ(with(", up = \"z\"").frame(0).mesh.V(2, 2), 0);
  EXPECT_NEAR(with(", frames_per_second = 10").time(1), 0.1, 1e-12);
  EXPECT_NEAR(with(", frames_per_second = 10, start = 3").time(1), 3.1, 1e-12);
  EXPECT_EQ(first_x(with(", first = 2")), 2);
  EXPECT_EQ(with(", first = 1, last = 2").frame_count(), 2);
}

TEST_F(FluidChoices, SequencesAreReadAsTheyAreDescribed) {
  write_sequences();
  std::shared_ptr<const SurfaceSequence> kept;
  expect_choices([&](const std::string& more) -> const SurfaceSequence& {
    kept = scene("sequences = [{ name = \"mine\", path = \"run\"" + more + " }]\n")
               .sculpt.sources.at("mine");
    return *kept;
  });
}

TEST_F(FluidChoices, TargetsAreReadAsTheyAreDescribed) {
  write_sequences();
  std::shared_ptr<const SurfaceSequence> kept;
  expect_choices([&](const std::string& more) -> const SurfaceSequence& {
    kept = scene("target = { kind = \"sequence\", path = \"run\"" + more + " }\n").sculpt.target;
    return *kept;
  });
  EXPECT_EQ(
      first_x(*scene("target = { kind = \"mesh\", file = \"run/bed_3.obj\" }\n").sculpt.target),
      13);
}

TEST_F(FluidChoices, InjectedFramesCarryVelocitiesWhenAsked) {
  const std::string lines =
      "injected = { bumps = 0, rings = 1, drops = 1, crossings = 0, frames = ";
  EXPECT_EQ(scene(lines + "2 }\n").injected->frame(0).velocity.rows(), 0);
  const SurfaceFrame frame = scene(lines + "2, velocity = true }\n").injected->frame(0);
  EXPECT_EQ(frame.velocity.rows(), frame.mesh.V.rows());
}

const std::string kTankSize = "duration = 0.1\ntank = { size = [2, 2, 2], cell = 0.25, ";
const std::string kWater = "volumes = [{ shape = { centre = [1, 1, 0.5], size = [2, 2, 1] } }]";

TEST_F(FluidChoices, NamesStandInMessages) {
  const std::string away = ", shape = { centre = [9, 9, 9] }";
  EXPECT_THAT(failure(kTankSize + "volumes = [{ name = \"lake\"" + away + " }] }\n", "liquid"),
              HasSubstr("'lake'"));
  EXPECT_THAT(
      failure(kTankSize + kWater + ", sources = [{ name = \"tap\"" + away + ", until = 1 }] }\n",
              "liquid"),
      HasSubstr("'tap'"));
  EXPECT_THAT(
      failure(kTankSize + kWater + ", solids = [{ name = \"rock\"" + away + " }] }\n", "liquid"),
      HasSubstr("'rock'"));
}

TEST_F(FluidChoices, BodiesAreReadFromTheFilesNamed) {
  write_solid("near.obj", 0.5);
  write_solid("far.obj", 0.75);
  for (const std::string file : {"near.obj", "far.obj"}) {
    const double x = file == "near.obj" ? 0.5 : 0.75;
    const std::string shape = "{ shape = { kind = \"mesh\", file = \"" + file + "\" }";
    const FluidScene filled = scene(kTankSize + "volumes = [" + shape + " }] }\n");
    EXPECT_EQ(filled.tank->volumes[0].shape.mesh.V(0, 0), x);
    const FluidScene poured = scene(kTankSize + "sources = [" + shape + ", until = 1 }] }\n");
    EXPECT_EQ(poured.tank->sources[0].shape.mesh.V(0, 0), x);
    const FluidScene solid = scene(kTankSize + "solids = [" + shape + " }] }\n");
    EXPECT_EQ(solid.tank->solids[0].shape.mesh.V(0, 0), x);
  }
}

TEST_F(FluidChoices, AFrameEndsTheRunBeyondItsSubsteps) {
  // 0.12 m a frame, in substeps of 0.025 m at most.
  const std::string flows = kTankSize +
                            "volumes = [{ shape = { centre = [1, 1, 0.5], size = [1, 1, 1] }, "
                            "velocity = [3, 0, 0] }] }\n";
  EXPECT_THAT(failure(flows, "liquid", "max_substeps = 1, cfl = 0.1"),
              HasSubstr("more than 1 substeps"));
  EXPECT_EQ(failure(flows, "liquid", "cfl = 0.1"), "");
}

const std::string kInjected =
    "injected = { bumps = 1, rings = 1, drops = 1, crossings = 0, frames = 5 }\n";

const std::string kPasted = kInjected + "target = { kind = \"injected\" }\n";

TEST_F(FluidChoices, AnEditTakesWhatMeetsItsInterval) {
  const std::string edit = "edits = [{ name = \"moved\", source = \"injected\", interval = ";
  EXPECT_THAT(failure(kPasted + edit + "[5, 6] }]\n", "sculpt"),
              HasSubstr("no feature meets its box, interval"));
  EXPECT_EQ(failure(kPasted + edit + "[0, 6] }]\n", "sculpt", "extraction.map.texel = 2"), "");
}

TEST_F(FluidChoices, TheMapAskedForIsRecorded) {
  const std::string lift = "lift = true, extraction = { map = { texel = 2 } }";
  EXPECT_EQ(failure(kInjected, "extract", lift), "");
  EXPECT_THAT(failure(kInjected, "extract", lift + ", map_feature = 99"),
              HasSubstr("no differential feature 99"));
}

TEST_F(FluidChoices, LibrariesAndEditListsAreReadFromTheirFiles) {
  const ExecuteResult stored =
      run(kInjected, "extract", "lift = true, extraction = { map = { texel = 2 } }");
  fs::path library;
  for (const auto& entry : fs::recursive_directory_iterator(stored.folder)) {
    if (entry.path().filename() == "features.h5") library = entry.path();
  }
  ASSERT_FALSE(library.empty());
  const fs::path here = folder() / "experiments" / "fluid";
  fs::copy_file(library, here / "mine.h5");
  std::ofstream(here / "edits.toml") << "[[edit]]\nname = \"second\"\nsource = \"stored\"\n";
  const FluidScene s =
      scene(kInjected +
            "libraries = [{ name = \"stored\", path = \"mine.h5\" }]\nedits = [{ name = "
            "\"first\", source = \"injected\" }]\nedit_list = \"edits.toml\"\n");
  EXPECT_FALSE(s.sculpt.libraries.at("stored").empty());
  ASSERT_EQ(s.sculpt.edits.size(), 2U);
  EXPECT_EQ(s.sculpt.edits[0].source, "injected");
  EXPECT_EQ(s.sculpt.edits[1].name, "second");
}

}  // namespace
}  // namespace geoprior::fluid
