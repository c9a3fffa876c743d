// What a user asks of the torus and is told: files beside the frames, warnings, and bad input.
#include "experiments/torus/scene/scene.h"

#include <gmock/gmock.h>

#include <numbers>

#include "baselines/torus/revolution.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "experiments/torus/measures.h"
#include "experiments/torus/print/solid.h"
#include "experiments/torus/topic.h"
#include "testbed/formats/mesh/stl_reader.h"
#include "testbed/formats/vtk/files.h"
#include "tests/support/recording.h"
#include "tests/testbed/run_fixture.h"
#include "tests/torus/torus_inputs.h"

namespace geoprior::torus {
namespace {

using namespace test;

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace fs = std::filesystem;

class TorusScenes : public RunTest {
 protected:
  [[nodiscard]] ExecuteResult run_torus(const std::string& scene_lines,
                                        const std::string& method = "exact",
                                        const std::string& options = "") const {
    const std::string windows = scene_lines.starts_with("windows") ? "" : "windows = 2\n";
    const fs::path file = write_experiment(
        "torus/asked", "title = \"t\"\ntopic = \"torus\"\n[scene]\nsurface = 12\n" + windows +
                           scene_lines + "\n[[variant]]\nname = \"v\"\nmethod = \"" + method +
                           "\"\noptions = { " + options + " }\n");
    ExecuteRequest request;
    request.out = folder() / "out";
    request.timing = false;
    return execute(load_experiment(file, {make_topic()}, {}), {make_topic()}, request);
  }
  [[nodiscard]] fs::path artifact(const std::string& name) const {
    return folder() / "out/artifacts/default/v" / name;
  }
  [[nodiscard]] std::string refusal(const std::string& scene_lines) const {
    const std::string error = error_of([&] { (void)run_torus(scene_lines); });
    EXPECT_FALSE(fs::exists(folder() / "out")) << error;
    return error;
  }
  static constexpr const char* kOne = "corrugations = [{ direction = 0, number = 3 }]\n";
};

TEST_F(TorusScenes, PrintAClosedBodyOfTheAskedSize) {
  const ExecuteResult result = run_torus(
      "corrugations = [{ direction = 0, number = 7 }]\nprint = { size = 0.2, thickness = 0.002 }");
  const TriMesh body = parse_stl(text_of(artifact("surface.stl")), "surface.stl").mesh;
  EXPECT_EQ(body.triangle_count(), 2 * 2 * 12 * 12);
  EXPECT_NO_THROW(require_closed_manifold(body, "a test", "surface.stl"));
  EXPECT_NEAR((body.V.colwise().maxCoeff() - body.V.colwise().minCoeff()).maxCoeff(), 200, 1e-3)
      << "millimetres";
  EXPECT_GT(signed_volume(body.V, body.F), 0);
  EXPECT_TRUE(text_of(artifact("surface.glb")).starts_with("glTF"));
  const auto last = [&](const char* metric) {
    return result.record.cases.front().variants.front().metrics.at(metric).values.back();
  };
  EXPECT_EQ(last("print_defects"), 0);
  EXPECT_EQ(last("print_intersecting_pairs"), 0);
  EXPECT_NEAR(last("print_volume") * 1e9, signed_volume(body.V, body.F), 1);
}

TEST_F(TorusScenes, PrintAPartWithWalls) {
  (void)run_torus(std::string(kOne) +
                  "view = { width = 0.2 }\nprint = { size = 0.1, thickness = 0.004 }");
  const TriMesh body = parse_stl(text_of(artifact("surface.stl")), "surface.stl").mesh;
  EXPECT_EQ(body.triangle_count(), 2 * 2 * 11 * 11 + 2 * 4 * 11);
  EXPECT_NO_THROW(require_closed_manifold(body, "a test", "surface.stl"));
  EXPECT_GT(signed_volume(body.V, body.F), 0);
}

// A square of 1 m above a plate of 0.1 m; a ring's tube of 1 m around a cavity of 0.4 m.
TEST(PrintedBodies, HaveTheVolumesOfAPlateAndOfARing) {
  TriMesh square;
  square.V.resize(4, 3);
  square.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0;
  square.F.resize(2, 3);
  square.F << 0, 1, 3, 0, 3, 2;
  const TriMesh plate = body_between(square, flat_plate(square, 0.1));
  EXPECT_NEAR(signed_volume(plate.V, plate.F), 0.1, 1e-12);
  EXPECT_NO_THROW(require_closed_manifold(plate, "a test", "plate"));

  TorusInput input;
  input.sampling.surface = 200;
  Recording run;
  RunContext context;
  make_revolution_torus(input, {})->run(run, context, std::nullopt);
  const Part& surface = run.frames.at(0).require_part("surface");
  const double ring = 0.5 / (2 * std::numbers::pi), tube = 0.2 / (2 * std::numbers::pi);
  const auto& at = surface.require_array("parameters", NamedArray::On::points, 2).values;
  const TriMesh torus{surface.points, surface.triangles};
  const TriMesh hollow = body_between(torus, round_cavity(torus, at, ring, 0.6 * tube));
  const double full = 2 * std::numbers::pi * std::numbers::pi * ring * tube * tube;
  EXPECT_NEAR(signed_volume(hollow.V, hollow.F), (1 - 0.16) * full, 1e-3 * full);
  EXPECT_THROW((void)round_cavity(torus, at, ring, 1.01 * tube), Error);
}

// The runner's differences, from points alone, against the derivatives that the method has.
TEST_F(TorusScenes, MeasureTheDefaultAsTheTangentsHaveIt) {
  const ExecuteResult result = run_torus(
      "windows = 256\ncorrugations = [{ direction = 0, number = 12 }, { direction = 1, number = "
      "80, share = 0.8 }, { direction = 2, number = 500 }]");
  const VariantRecord& variant = result.record.cases.front().variants.front();
  const auto& differences = variant.metrics.at("default_mean").values;
  const auto& tangents = variant.diagnostics.at("tangent_default").values;
  ASSERT_EQ(differences.size(), 4u);
  for (std::size_t i = 0; i < differences.size(); ++i)
    EXPECT_NEAR(differences[i], tangents[i], 0.005 * tangents[i]) << i << " corrugations";
  EXPECT_NEAR(differences[3], 0.62, 0.02);
  EXPECT_GT(std::abs(variant.metrics.at("default_8").values[3] - tangents[3]), 0.01)
      << "what a grid hides";
}

TEST_F(TorusScenes, RefuseAGridBeyondTheMemory) {
  ::setenv("GEOPRIOR_MEMORY_GB", "0.01", 1);
  const auto error_with = [&](const char* method, const char* options) {
    const std::string error = error_of([&] { (void)run_torus(kOne, method, options); });
    fs::remove_all(folder() / "out");
    return error;
  };
  EXPECT_THAT(error_with("grid", "points = 20000"),
              AllOf(HasSubstr("options.points"), HasSubstr("400000000 points of a grid")));
  EXPECT_THAT(error_with("integration", "points = 400"), HasSubstr("160000 points of a grid"));
  ::unsetenv("GEOPRIOR_MEMORY_GB");
}

TEST_F(TorusScenes, ShowTheNodesThatAGridHasAndRefuseAViewBetweenThem) {
  const std::string view =
      std::string(kOne) + "print = { thickness = 0.001 }\nview = { width = 0.1";
  (void)run_torus(view + " }", "grid", "points = 64");
  const TriMesh body = parse_stl(text_of(artifact("surface.stl")), "surface.stl").mesh;
  EXPECT_EQ(body.vertex_count(), 2 * 7 * 7) << "nodes of a tenth of the grid";
  fs::remove_all(folder() / "out");
  EXPECT_THAT(error_of([&] { (void)run_torus(view + ", zooms = 2 }", "grid", "points = 64"); }),
              AllOf(HasSubstr("scene.view"), HasSubstr("64 points")));
}

TEST_F(TorusScenes, WriteTheWholeTorusAsAGrid) {
  (void)run_torus(std::string(kOne) + "whole = 16");
  const Part grid = read_vtk_part(artifact("grid.vti"));
  EXPECT_EQ(grid.grid_size, (std::array{16, 16, 1}));
  const auto& position = grid.require_array("position", NamedArray::On::points, 3).values;
  EXPECT_EQ(position.rows(), 256);
  for (const auto& file : fs::directory_iterator(folder() / "out/frames/default/v"))
    EXPECT_NE(file.path().extension(), ".vti") << "the grid is no part of a frame";
}

TorusSceneOptions small_scene() {
  TorusSceneOptions options;
  options.surface = 10;
  options.windows = 2;
  options.corrugations = {{0, 4, {}}, {1, 12, 0.8}, {2, {}, {}}};
  options.detail = DetailOptions{0.25, 0.5, 0.1};
  return options;
}

// What a program from outside is given is what the torus of revolution fills: each place of each
// frame once.
TEST(TorusGiven, IsWhatFramesOfTheTorusOfRevolutionHold) {
  const auto scene = load_torus_scene(small_scene(), 1);
  const Frame given = scene->given();
  Recording run;
  RunContext context;
  make_revolution_torus(scene->input, {})->run(run, context, std::nullopt);
  ASSERT_EQ(run.frames.size(), 4u);
  std::size_t parts = 0;
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    const std::string number = "_000" + std::to_string(k);
    for (const auto& [name, part] : run.frames[k].parts) {
      if (name == "windows_before" || name == "windows_base") continue;
      const bool once = part.kind == Part::Kind::triangles;
      const Part& mine = given.require_part(once ? name : name + number, part.kind);
      EXPECT_EQ(mine.points, part.points) << name << number;
      EXPECT_EQ(mine.triangles, part.triangles) << name;
      EXPECT_EQ(mine.require_array("parameters", NamedArray::On::points, 2).values.rows(),
                part.points.rows());
      parts += once && k > 0 ? 0 : 1;
    }
    EXPECT_EQ(given.require_table("windows" + number).rows,
              run.frames[k].require_table("windows").rows);
  }
  EXPECT_EQ(given.parts.size(), parts);
  EXPECT_EQ(given.require_table("corrugations").rows,
            run.frames[3].require_table("corrugations").rows);
  EXPECT_EQ(given.require_table("corrugations").rows(2, 1), scene->facts().at("N_3")) << "chosen";
  // A window is a square of points from its corner, along x first.
  const Eigen::RowVector3d corner = given.require_table("windows_0003").rows.row(1);
  const Eigen::MatrixXd& at =
      given.require_array("windows_0003", "parameters", NamedArray::On::points).values;
  EXPECT_NEAR(at(144 + 12 + 2, 0), corner.x() + 2 * corner.z(), 1e-15);
  EXPECT_NEAR(at(144 + 12 + 2, 1), corner.y() + corner.z(), 1e-15);
}

TEST(TorusGiven, HasASurfaceForEachView) {
  TorusSceneOptions options = small_scene();
  options.detail.reset();
  options.view = ViewOptions{0.5, 0.5, 0.1, 2, 10};
  const Frame given = load_torus_scene(options, 1)->given();
  ASSERT_EQ(given.parts.size(), 2u);
  for (int k = 0; k < 2; ++k) {
    const Eigen::VectorXd x =
        given.require_array("surface_000" + std::to_string(k), "parameters", NamedArray::On::points)
            .values.col(0);
    EXPECT_NEAR(x.maxCoeff() - x.minCoeff(), k == 0 ? 0.1 : 0.01, 1e-12);
  }
}

// Frames of other programs may leave out what they do not know, and be wrong.
TEST(TorusMeasures, SayNothingOfAFrameThatDoesNotSayHowManyCorrugationsItHas) {
  const auto scene = load_torus_scene(small_scene(), 1);
  Recording run;
  RunContext context;
  make_revolution_torus(scene->input, {})->run(run, context, std::nullopt);
  Frame frame = run.frames[3];
  const auto whole = default_measures(*scene, frame);
  EXPECT_GT(*whole->miss, 0);
  frame.tables.erase("corrugations");
  const auto measured = default_measures(*scene, frame);
  EXPECT_EQ(measured->mean, whole->mean);
  EXPECT_FALSE(measured->miss);
  EXPECT_FALSE(measured->wanted);
  EXPECT_FALSE(miss_ratio(*scene, FramesInMemory({frame}))) << "the frames before are not there";
}

TEST(TorusMeasures, NameATableOrPartOfAnotherSize) {
  const auto scene = load_torus_scene(small_scene(), 1);
  Recording run;
  RunContext context;
  make_revolution_torus(scene->input, {})->run(run, context, std::nullopt);
  const auto error_with = [&](auto change) {
    Frame frame = run.frames[3];
    change(frame);
    return error_of([&] {
      (void)default_measures(*scene, frame);
      (void)intersections(*scene, frame);
    });
  };
  EXPECT_THAT(error_with([](Frame& f) { f.tables["corrugations"].rows.resize(0, 4); }),
              AllOf(HasSubstr("corrugations"), HasSubstr("1 to 3")));
  EXPECT_THAT(error_with([](Frame& f) { f.tables["corrugations"].rows.resize(9, 4); }),
              HasSubstr("9 rows"));
  EXPECT_THAT(error_with([](Frame& f) { f.tables["windows"].rows.resize(0, 3); }),
              HasSubstr("table windows"));
  EXPECT_THAT(error_with([](Frame& f) { f.parts["windows_base"].points.setZero(144, 3); }),
              AllOf(HasSubstr("windows_base"), HasSubstr("288")));
}

TEST_F(TorusScenes, WarnOfAGridTooCoarseAndNotOfAFineOne) {
  const std::string scene = "corrugations = [{ direction = 0, number = 12 }]";
  const auto warnings = [](const ExecuteResult& result) {
    return result.record.cases.front().warnings;
  };
  EXPECT_THAT(warnings(run_torus(scene, "grid", "points = 96")),
              Contains(AllOf(HasSubstr("variant 'v'"), HasSubstr("96 points has 8 a period"),
                             HasSubstr("needed: 192 points"))));
  fs::remove_all(folder() / "out");
  EXPECT_THAT(warnings(run_torus(scene, "grid", "points = 192")), IsEmpty());
  fs::remove_all(folder() / "out");
  EXPECT_THAT(warnings(run_torus(scene)), IsEmpty());
}

TEST_F(TorusScenes, RefuseWhatIsNone) {
  EXPECT_THAT(refusal("corrugations = [{ direction = 0, number = 0 }]"),
              AllOf(HasSubstr("number"), HasSubstr("1")));
  EXPECT_THAT(refusal("corrugations = [{ direction = 3, number = 9 }]"), HasSubstr("direction"));
  EXPECT_THAT(refusal("r1 = 0.5\nr2 = 0.5"), AllOf(HasSubstr("r1"), HasSubstr("r2")));
  EXPECT_THAT(refusal("view = { x = 0.9, width = 0.3 }"), HasSubstr("view"));
  EXPECT_THAT(refusal("detail = { y = 0.01 }"), HasSubstr("scene.detail"));
  EXPECT_THAT(refusal("view = { width = 0 }"), HasSubstr("view.width"));
  EXPECT_THAT(refusal("view = {}\nprint = {}"), HasSubstr("scene.print.thickness"));
}

// Of the published numbers the fifth coefficient is negative: which, and where.
TEST_F(TorusScenes, NameTheCoefficientThatTurnsNegative) {
  const ExecuteResult result = run_torus(
      "corrugations = [{ direction = 0, number = 12 }, { direction = 1, number = 13, share = 0.8 "
      "}, "
      "{ direction = 2, number = 14 }, { direction = 0, number = 15 }]");
  const VariantRecord& variant = result.record.cases.front().variants.front();
  EXPECT_THAT(variant.error, AllOf(HasSubstr("rho_"), HasSubstr("x = "), HasSubstr("y = ")));
}

}  // namespace
}  // namespace geoprior::torus
