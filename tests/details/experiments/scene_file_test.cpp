// What a [scene] table of the topic describes, and whole runs on it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "core/error.h"
#include "experiments/details/scene/scene.h"
#include "experiments/details/topic.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/view/mesh_text.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::details {
namespace {

using namespace test;

using ::testing::HasSubstr;

namespace fs = std::filesystem;

class DetailsScenes : public RunTest {
 protected:
  /// @param only  method; empty: all
  [[nodiscard]] Experiment experiment(const std::string& scene_lines, const std::string& only,
                                      std::optional<int> threads = {}) const {
    std::string text = "title = \"A scene\"\ntopic = \"details\"\n[scene]\n" + scene_lines;
    for (const MethodEntry& method : methods())
      if (only.empty() || method.name == only)
        text += "\n[[variant]]\nname = \"" + method.name + "\"\nmethod = \"" + method.name + "\"\n";
    LoadRequest request;
    request.threads = threads;
    return load_experiment(write_experiment("details/scene", text), {make_topic()}, request);
  }
  [[nodiscard]] std::shared_ptr<DetailsScene> scene(const std::string& scene_lines,
                                                    std::uint64_t seed = 1) const {
    const auto loaded = make_topic().load(*experiment(scene_lines, "").cases[0].scene,
                                          folder() / "experiments" / "details", seed);
    return std::dynamic_pointer_cast<DetailsScene>(loaded);
  }
  [[nodiscard]] ExecuteResult run(const std::string& scene_lines, const std::string& only,
                                  const std::string& out, std::optional<int> threads = {}) const {
    ExecuteRequest request;
    request.out = folder() / out;
    request.timing = false;
    request.only_declared = true;
    return execute(experiment(scene_lines, only, threads), {make_topic()}, request);
  }
};

const std::string kSmall =
    "surface = { kind = \"blob\", radius = 0.5, edge = 0.12 }\n"
    "pattern = { count = 60, types = 2 }\npair_frames = 1\n"
    "motion = { frames = 6, deform = [{ kind = \"inflate\", keys = [{ t = 0, value = 1 }, { t = 1, "
    "value = 1.3 }] }] }\n";

std::vector<Eigen::Vector3d> places_of(const DetailsScene& scene,
                                       const std::vector<Detail>& details) {
  std::vector<Eigen::Vector3d> places;
  for (const Detail& d : details)
    places.push_back(position_of(d.at, scene.input.surface.V, scene.input.surface.F));
  return places;
}

TEST_F(DetailsScenes, SeedOfTheExperimentReachesThePattern) {
  for (const std::string kind : {"poisson-disk", "uniform", "grid", "clusters"}) {
    const std::string lines = "pattern = { kind = \"" + kind + "\", count = 60 }\n";
    const auto one = scene(lines, 1), again = scene(lines, 1), two = scene(lines, 2);
    const auto places = places_of(*one, one->input.details);
    EXPECT_EQ(places, places_of(*again, again->input.details)) << kind;
    EXPECT_NE(places, places_of(*two, two->input.details)) << kind;
    for (std::size_t i = 0; i < one->resamples.size(); ++i) {
      EXPECT_NE(places, places_of(*one, one->resamples[i])) << kind;
      EXPECT_NE(places_of(*one, one->resamples[i]), places_of(*two, two->resamples[i])) << kind;
    }
  }
}

TEST_F(DetailsScenes, DefaultsToThousandDetailsOnASquareMetre) {
  const auto s = scene("");
  EXPECT_EQ(s->input.details.size(), 1000U);
  EXPECT_NEAR(triangle_areas(s->input.surface.V, s->input.surface.F).sum(), 1, 1e-12);
  EXPECT_EQ(s->input.motion->frame_count(), 241);
  EXPECT_EQ(s->resamples.size(), 3U);
  EXPECT_NE(s->resamples[0][0].at.barycentric, s->input.details[0].at.barycentric);
}

TEST_F(DetailsScenes, ReadSurfacesInTheirUnitAndTurnThem) {
  Part part;
  part.points.resize(4, 3);
  part.points << 0, 0, 0, 100, 0, 0, 100, 100, 0, 0, 100, 0;
  part.triangles.resize(2, 3);
  part.triangles << 0, 1, 2, 0, 2, 3;
  fs::create_directories(folder() / "experiments" / "details");
  std::ofstream(folder() / "experiments" / "details" / "cm.obj") << part_to_obj(part, "");
  const auto s = scene(
      "surface = { kind = \"file\", file = \"cm.obj\", scale = 0.01, turn_deg = [90, 0, 0] }\n"
      "pattern = { kind = \"uniform\", count = 10 }\n");
  EXPECT_NEAR((s->input.surface.V.row(2) - Eigen::RowVector3d(1, 0, 1)).norm(), 0, 1e-12);
  ASSERT_EQ(s->inputs().size(), 1U);
  EXPECT_EQ(s->inputs()[0].filename(), "cm.obj");
}

TEST_F(DetailsScenes, TakeTheirDensityFromAnArrayOfTheSurface) {
  Part part;
  part.points.resize(6, 3);
  part.points << 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0;
  part.triangles.resize(4, 3);
  part.triangles << 0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4;
  Eigen::VectorXd density(6);
  density << 1, 0, 0, 1, 0, 0;
  part.arrays.push_back({"rho", "1", NamedArray::On::points, density});
  fs::create_directories(folder() / "experiments" / "details");
  std::ofstream(folder() / "experiments" / "details" / "s.vtp", std::ios::binary)
      << part_to_vtk_xml(part, 0);
  const auto s = scene(
      "surface = { kind = \"file\", file = \"s.vtp\" }\npattern = { kind = \"uniform\", count = "
      "200, density = { kind = \"array\", array = \"rho\" } }\n");
  for (const Detail& d : s->input.details)
    EXPECT_LE(position_of(d.at, s->input.surface.V, s->input.surface.F).x(), 1 + 1e-12);
}

// The second position is 0.02 off the square of a metre: more than a hundredth of its diagonal.
TEST_F(DetailsScenes, ReadThePlacesOfDetailsUpToTheDistanceAllowed) {
  fs::create_directories(folder() / "experiments" / "details");
  std::ofstream(folder() / "experiments" / "details" / "places.csv")
      << "x,y,z,weight\n0,0,0,1\n0.2,0.1,0.02,0.5\n-0.3,0.4,0,1\n";
  const std::string pattern = "pattern = { kind = \"file\", file = \"places.csv\"";
  const auto s = scene(pattern + ", max_distance = 0.03 }\n");
  const std::vector<Eigen::Vector3d> places = places_of(*s, s->input.details);
  ASSERT_EQ(places.size(), 3U);
  EXPECT_NEAR((places[1] - Eigen::Vector3d(0.2, 0.1, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(s->input.details[1].weight, 0.5);
  EXPECT_TRUE(s->resamples.empty());
  EXPECT_THROW(scene(pattern + " }\n"), Error);
}

/// A rectangle of 200 x 100 in the plane that a file calls level, `stretch` times as long.
Part clip_frame(double stretch, bool y_up) {
  Part part;
  part.points.resize(4, 3);
  part.points << 0, 0, 0, 200, 0, 0, 200, 100, 0, 0, 100, 0;
  part.points.col(0) *= stretch;
  if (y_up) {
    part.points.col(2) = -part.points.col(1);
    part.points.col(1).setZero();
  }
  part.triangles.resize(2, 3);
  part.triangles << 0, 1, 2, 0, 2, 3;
  return part;
}

// Frames 1 to 3 of 0 … 4 in centimetres with y up, 10 a second, the first of them at 2 s.
TEST_F(DetailsScenes, ReadTheMotionFromFilesInTheirUnitsAndTimes) {
  fs::create_directories(folder() / "experiments" / "details");
  for (int i = 0; i < 5; ++i) {
    std::ofstream(folder() / "experiments" / "details" / ("clip_" + std::to_string(i) + ".obj"))
        << part_to_obj(clip_frame(1 + 0.1 * i, true), "");
  }
  const auto s = scene(
      "surface = { kind = \"sequence\" }\npattern = { kind = \"uniform\", count = 10 }\n"
      "motion.sequence = { path = \"clip_%d.obj\", up = \"y\", scale = 0.01, "
      "frames_per_second = 10, start = 2, first = 1, last = 3 }\n");
  ASSERT_EQ(s->input.motion->frame_count(), 3);
  EXPECT_NEAR(s->input.motion->parameter(0), 2, 1e-12);
  EXPECT_NEAR(s->input.motion->parameter(2), 2.2, 1e-12);
  EXPECT_NEAR(s->input.surface.V.col(0).maxCoeff(), 2.2, 1e-6);
  EXPECT_NEAR(s->input.surface.V.col(1).maxCoeff(), 1, 1e-6);
  EXPECT_NEAR(s->input.surface.V.col(2).cwiseAbs().maxCoeff(), 0, 1e-12);
  EXPECT_NEAR(s->input.motion->positions(2).col(0).maxCoeff(), 2.6, 1e-6);
}

TEST_F(DetailsScenes, ReadThePartOfARecordedMotion) {
  const fs::path frames = folder() / "experiments" / "details" / "frames";
  fs::create_directories(frames);
  for (int i = 0; i < 3; ++i) {
    const std::string number = "_000" + std::to_string(i) + ".vtp";
    std::ofstream(frames / ("sheet" + number), std::ios::binary)
        << part_to_vtk_xml(clip_frame(1 + 0.1 * i, false), i);
    std::ofstream(frames / ("surface" + number), std::ios::binary)
        << part_to_vtk_xml(clip_frame(5, false), i);
  }
  const auto s = scene(
      "surface = { kind = \"sequence\" }\npattern = { kind = \"uniform\", count = 10 }\n"
      "motion.sequence = { path = \"frames\", part = \"sheet\" }\n");
  EXPECT_EQ(s->input.motion->frame_count(), 3);
  EXPECT_NEAR(s->input.motion->positions(2).col(0).maxCoeff(), 240, 1e-6);
}

TEST_F(DetailsScenes, ReadTheMeshThatADetailIsDrawnAs) {
  Part tetrahedron;
  tetrahedron.points.resize(4, 3);
  tetrahedron.points << 1, 0, 0, -0.5, 0.9, 0, -0.5, -0.9, 0, 0, 0, 1;
  tetrahedron.triangles.resize(4, 3);
  tetrahedron.triangles << 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3;
  fs::create_directories(folder() / "experiments" / "details");
  std::ofstream(folder() / "experiments" / "details" / "thorn.obj") << part_to_obj(tetrahedron, "");
  const ExecuteResult result =
      run(kSmall +
              "drawing = { look = { kind = \"mesh\", instance = { shape = \"given\" } }, "
              "file = \"thorn.obj\" }\n",
          "naive-stretch", "given");
  const fs::path frames = result.folder / "frames" / "default" / "naive-stretch";
  const Part drawn = read_vtk_part(frames / "drawn_0000.vtp");
  const Part surface = read_vtk_part(frames / "surface_0000.vtp");
  EXPECT_EQ(drawn.points.rows(), surface.points.rows() + 4 * 60);
}

// Three details of weight 1/2 drawn with radius 0.1 m and height 0.2 m: the weight halves the
// height always, the width with it unless the height alone is scaled.
TEST_F(DetailsScenes, DrawSpikesWhoseWeightScalesWhatIsAskedFor) {
  fs::create_directories(folder() / "experiments" / "details");
  std::ofstream(folder() / "experiments" / "details" / "half.csv")
      << "x,y,z,weight\n0,0,0,0.5\n0.3,0.3,0,0.5\n-0.3,0.3,0,0.5\n";
  for (const std::string scales : {"size", "height"}) {
    const ExecuteResult result =
        run("pattern = { kind = \"file\", file = \"half.csv\" }\nmotion.frames = 1\n"
            "drawing.look = { unit = \"metre\", radius = 0.1, spike = { height = 0.2, "
            "weight_scales = \"" +
                scales + "\" } }\n",
            "naive-stretch", scales);
    const fs::path frames = result.folder / "frames" / "default" / "naive-stretch";
    const Part drawn = read_vtk_part(frames / "drawn_0000.vtp");
    const auto base = read_vtk_part(frames / "surface_0000.vtp").points.rows();
    const Eigen::MatrixX3d spikes = drawn.points.bottomRows(drawn.points.rows() - base);
    EXPECT_NEAR(spikes.col(2).maxCoeff(), 0.1, 1e-6) << scales;
    const double foot = spikes.col(0).maxCoeff() - 0.3;
    EXPECT_NEAR(foot, scales == "size" ? 0.05 : 0.1, 0.01) << scales;
  }
}

// What is measured once for all cases of a run is kept apart where cases differ in how it is
// measured.
TEST_F(DetailsScenes, MeasurePairsFromTheDetailsThatTheirCaseAsksFor) {
  const ExecuteResult result =
      run(kSmall + "[[sweep]]\nkey = \"scene.pair_sources\"\nvalues = [10]\n", "naive-stretch",
          "sources");
  std::vector<std::vector<double>> distances;
  for (const CaseRecord& c : result.record.cases)
    distances.push_back(c.variants.front().metrics.at("pair_distance").values);
  ASSERT_EQ(distances.size(), 2U);
  EXPECT_NE(distances[0].back(), distances[1].back());
}

TEST_F(DetailsScenes, WarnOfAPatternThatDoesNotFit) {
  const auto warnings = scene("pattern = { count = 200, radius = 0.95 }\n")->warnings();
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], HasSubstr("details of 200 found a place"));
}

TEST_F(DetailsScenes, RunWithEveryMethodAndAreTheSameForAnyNumberOfThreads) {
  const ExecuteResult one = run(kSmall, "", "one", 1);
  for (const VariantRecord& v : one.record.cases.front().variants) {
    EXPECT_EQ(v.status, "done") << v.name << ": " << v.error;
    EXPECT_EQ(v.frames.size(), 7U) << v.name;
    for (const char* metric : {"mean_edge_change", "visible_edge_change", "density_ratio"})
      EXPECT_EQ(v.metrics.at(metric).values.size(), 7U) << v.name;
    for (const char* metric : {"worst_edge_change", "popping", "weight_step", "churn"})
      EXPECT_TRUE(v.summary.contains(metric)) << v.name << ", " << metric;
  }
  const ExecuteResult two = run(kSmall, "", "two", 2);
  EXPECT_EQ(one.record.content_sha256, two.record.content_sha256);
}

// Frames 0, 3 and 6 of six; spikes stand on the surface, holes leave less of it.
TEST_F(DetailsScenes, AreDrawnInTheFramesAskedFor) {
  for (const std::string kind : {"spike", "mesh", "hole"}) {
    const std::string drawing =
        "drawing = { frames = 2, look = { kind = \"" + kind + "\", radius = 0.25 } }\n";
    const ExecuteResult result = run(kSmall + drawing, "self-replicating", kind);
    const VariantRecord& v = result.record.cases.front().variants.front();
    for (std::size_t i = 0; i < v.frames.size(); ++i) {
      const fs::path file = result.folder / "frames" / "default" / v.name /
                            ("drawn_000" + std::to_string(i) + ".vtp");
      EXPECT_EQ(fs::exists(file), i % 3 == 0) << file;
    }
    const fs::path frames = result.folder / "frames" / "default" / v.name;
    const Part drawn = read_vtk_part(frames / "drawn_0006.vtp");
    const Part surface = read_vtk_part(frames / "surface_0006.vtp");
    const double more = triangle_areas(drawn.points, drawn.triangles).sum() -
                        triangle_areas(surface.points, surface.triangles).sum();
    EXPECT_EQ(more < 0, kind == "hole") << kind;
    ASSERT_EQ(drawn.arrays.size(), 1U);
    EXPECT_EQ(drawn.arrays[0].name, "kind");
    EXPECT_EQ(drawn.arrays[0].values.maxCoeff(), kind == "hole" ? 0 : 2) << "born by now";
  }
}

}  // namespace
}  // namespace geoprior::details
