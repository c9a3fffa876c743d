// Bad surfaces, details and motions given to a whole run: one error that names file and place, or a
// variant that ends with it and keeps its frames.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>

#include "experiments/details/scene/surfaces.h"
#include "experiments/details/topic.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/view/mesh_text.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::details {
namespace {

using namespace test;

using ::testing::AllOf;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

std::string ply_of(const TriMesh& mesh) {
  Part part;
  part.points = mesh.V;
  part.triangles = mesh.F;
  return part_to_ply(part, "");
}

class BadDetails : public RunTest {
 protected:
  /// A file beside the experiment.
  void write(const std::string& name, const std::string& text) const {
    const fs::path place = folder() / "experiments" / "details" / name;
    fs::create_directories(place.parent_path());
    std::ofstream(place, std::ios::binary) << text;
  }
  void write_ply(const std::string& name, const TriMesh& mesh) const { write(name, ply_of(mesh)); }

  [[nodiscard]] ExecuteResult run_details(const std::string& scene_lines,
                                          const std::string& options = "") const {
    const fs::path file = write_experiment(
        "details/bad",
        "title = \"Bad input\"\ntopic = \"details\"\n[scene]\n" + scene_lines +
            "\n[[variant]]\nname = \"v\"\nmethod = \"self-replicating\"\noptions = { " + options +
            " }\n");
    ExecuteRequest request;
    request.out = folder() / "out";
    request.timing = false;
    return execute(load_experiment(file, {make_topic()}, {}), {make_topic()}, request);
  }
  /// The error of a run that leaves nothing.
  [[nodiscard]] std::string refusal(const std::string& scene_lines,
                                    const std::string& options = "") const {
    const std::string error = error_of([&] { (void)run_details(scene_lines, options); });
    EXPECT_FALSE(fs::exists(folder() / "out")) << error;
    return error;
  }
};

const std::string kPlane = "surface = { kind = \"plane\", edge = 0.1 }\n";
const std::string kFew = "pattern = { kind = \"poisson-disk\", count = 30 }\n";
const std::string kFile = "surface = { kind = \"file\", file = \"s.ply\" }\n";
const std::string kCsv = "pattern = { kind = \"file\", file = \"d.csv\" }\n";
const std::string kStretch =
    "motion = { frames = 4, deform = [{ keys = [{ t = 0, value = 1 }, { t = 1, value = 1.2 }] }] "
    "}\n";

TEST_F(BadDetails, IsNoneWhenAllIsWell) {
  write("d.csv", "x, y, z, weight, type # metres\n0,0,0,1,0\n0.2, 0, 0, 0.5, 2\n\n0,0.3,0,1,1\n");
  const CaseRecord in = run_details(kPlane + kCsv + kStretch).record.cases.front();
  EXPECT_EQ(in.facts.at("details"), 3);
  EXPECT_EQ(in.variants.front().status, "done");
  EXPECT_EQ(in.variants.front().frames.size(), 5U);
}

TEST_F(BadDetails, InAPipeAreRefused) {
  write("other.csv", "");
  const fs::path pipe = folder() / "experiments/details/d.csv";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(refusal(kPlane + kCsv + kStretch), HasSubstr("d.csv: is a pipe"));
  ASSERT_EQ(::mkfifo((pipe.parent_path() / "s.ply").c_str(), 0600), 0);
  EXPECT_THAT(refusal(kFile + kFew + kStretch), HasSubstr("s.ply: is a pipe"));
}

TEST_F(BadDetails, AreNamedByTheirLine) {
  const auto message = [&](const std::string& text) {
    write("d.csv", text);
    return refusal(kPlane + kCsv + kStretch);
  };
  EXPECT_THAT(message("x,y,z\n0,0,0\n0.1,0,0\n"), HasSubstr("2 details"));
  EXPECT_THAT(message("x,y,z\n0,0,0\n0.1,0,0.2\n0,0.1,0\n"),
              AllOf(HasSubstr("d.csv:3: is off the surface by 0.2")));
  EXPECT_THAT(message("x,y,z\n0,0,0\n0.1,0,0\n0,0.1,0\n0,0,0\n"),
              AllOf(HasSubstr("d.csv:5: is in the place of"), HasSubstr("d.csv:2")));
  EXPECT_THAT(message("x,y\n0,0\n"), HasSubstr("d.csv:1: names no column 'z'"));
  EXPECT_THAT(message("x,y,z,x\n0,0,0,0\n"), HasSubstr("d.csv:1: names the column 'x' twice"));
  EXPECT_THAT(message("x,y,z\n0,nan,0\n"),
              HasSubstr("d.csv:2: column 'y': 'nan' is no finite number"));
  EXPECT_THAT(message("x,y,z\n0,0\n"), HasSubstr("d.csv:2: has no z"));
  EXPECT_THAT(message("x,y,z,weight\n0,0,0,1.5\n"), HasSubstr("d.csv:2: weight 1.5"));
  EXPECT_THAT(message("x,y,z,type\n0,0,0,0.5\n"), HasSubstr("d.csv:2: type 0.5"));
  EXPECT_THAT(message("# nothing\n"), HasSubstr("d.csv: is empty"));
}

TEST_F(BadDetails, MayBeTheVerticesOfAMesh) {
  TriMesh coarse = plane_surface(0.8, 0.8, 0.2);
  write_ply("d.ply", coarse);
  const std::string pattern = "pattern = { kind = \"file\", file = \"d.ply\" }\n";
  EXPECT_EQ(run_details(kPlane + pattern + kStretch).record.cases.front().facts.at("details"), 25);
  fs::remove_all(folder() / "out");
  coarse.V(7, 2) = 1;
  write_ply("d.ply", coarse);
  EXPECT_THAT(refusal(kPlane + pattern + kStretch),
              HasSubstr("d.ply, vertex 7: is off the surface by 1"));
}

TEST_F(BadDetails, StandOnNoBadSurface) {
  const TriMesh good = plane_surface(1, 1, 0.2);
  TriMesh nan = good;
  nan.V(7, 1) = std::numeric_limits<double>::quiet_NaN();
  write_ply("s.ply", nan);
  EXPECT_THAT(refusal(kFile + kFew + kStretch),
              AllOf(HasSubstr("s.ply"), HasSubstr("vertex 7 is not finite")));
  TriMesh fin = good;
  fin.F.conservativeResize(fin.F.rows() + 1, 3);
  fin.F.bottomRows(1) << fin.F(20, 0), fin.F(20, 1), 35;
  write_ply("s.ply", fin);
  EXPECT_THAT(refusal(kFile + kFew + kStretch),
              AllOf(HasSubstr("s.ply"), HasSubstr("belongs to 3 triangles")));
  TriMesh pieces;
  pieces.V.resize(72, 3);
  pieces.V << good.V, good.V.rowwise() + Eigen::RowVector3d(5, 0, 0);
  pieces.F.resize(100, 3);
  pieces.F << good.F, good.F.array() + 36;
  write_ply("s.ply", pieces);
  EXPECT_THAT(refusal(kFile + kFew + kStretch), HasSubstr("s.ply"));
  EXPECT_THAT(refusal(kFew + kStretch + "surface = { kind = \"file\", file = \"none.ply\" }\n"),
              AllOf(HasSubstr("no file 'none.ply'"), HasSubstr("scene.surface.file")));
}

// A few details on a thin tube or ring: their cells are bands, not discs. The mesh of details has
// the topology of the surface all the same: V - E + F = V - F / 2 of a closed one, loops and
// doubled edges counted, with vertices of the surface as ghosts where that takes them.
TEST_F(BadDetails, AreRepairedWhereCellsAreNoDiscs) {
  const std::map<std::string, double> euler{
      {"surface = { kind = \"capsule\", radius = 0.0064, length = 2, edge = 0.008 }\n", 2},
      {"surface = { kind = \"torus\", radius = 0.3, tube_radius = 0.02, edge = 0.02 }\n", 0}};
  for (const auto& [surface, expected] : euler) {
    const ExecuteResult result =
        run_details(surface + "pattern = { kind = \"uniform\", count = 4 }\n" + kStretch);
    const VariantRecord v = result.record.cases.front().variants.front();
    EXPECT_EQ(v.status, "done") << v.error;
    for (std::size_t i = 0; i < v.frames.size(); ++i) {
      const Part mesh = read_vtk_part(result.folder / "frames" / "default" / "v" /
                                      ("detail_mesh_000" + std::to_string(i) + ".vtp"));
      EXPECT_EQ(
          static_cast<double>(mesh.points.rows()) - static_cast<double>(mesh.triangles.rows()) / 2,
          expected);
    }
    fs::remove_all(result.folder);
  }
}

TEST_F(BadDetails, FollowNoSequenceWhoseTrianglesChange) {
  TriMesh mesh = plane_surface(1, 1, 0.1);
  for (int i = 0; i < 4; ++i) {
    mesh.V.col(0) *= 1.02;
    write_ply("m_" + std::to_string(i) + ".ply", mesh);
  }
  const std::string sequence =
      "surface = { kind = \"sequence\" }\nmotion.sequence = { path = \"m_%d.ply\", "
      "frames_per_second = 25 }\n";
  EXPECT_EQ(run_details(sequence + kFew).record.cases.front().variants.front().frames.size(), 4U);
  fs::remove_all(folder() / "out");
  write_ply("m_2.ply", plane_surface(1, 1, 0.125));
  EXPECT_THAT(refusal(sequence + kFew),
              HasSubstr("frame 2: its triangles are not those of the first frame"));
  EXPECT_THAT(refusal("surface = { kind = \"sequence\" }\n" + kFew + kStretch),
              HasSubstr("scene.motion.sequence: there is none"));
  EXPECT_THAT(refusal(kFew + "motion.sequence = { path = \"m_%d.ply\" }\n"),
              HasSubstr("scene.surface.kind: is not the one that moves"));
}

// A ball is blown up by more than its falloff can take: its rim folds over what is around.
TEST_F(BadDetails, EndAtTheFrameThatTurnsATriangleOver) {
  const std::string fold =
      "motion = { frames = 10, deform = [{ kind = \"scale\", radius = 0.4, keys = [{ t = 0, value "
      "= 1 }, { t = 1, value = 6 }] }] }\n";
  const VariantRecord v = run_details(kPlane + kFew + fold).record.cases.front().variants.front();
  EXPECT_EQ(v.status, "failed");
  EXPECT_THAT(v.error,
              AllOf(HasSubstr("frame "), HasSubstr("triangle "), HasSubstr("turned over")));
  EXPECT_GT(v.frames.size(), 1U);
  EXPECT_LT(v.frames.size(), 11U);
}

TEST_F(BadDetails, AreToldOfAMotionThatDoesNotStartAtRest) {
  EXPECT_THAT(
      refusal(kPlane + kFew + "motion = { deform = [{ keys = [{ t = 0, value = 2 }] }] }\n"),
      HasSubstr("frame 0 of the motion is not the surface at rest"));
}

TEST_F(BadDetails, NameTheKeyInTheFile) {
  EXPECT_THAT(refusal(kPlane + kFew +
                      "motion = { deform = [{ axis = [0, 0, 0], keys = [{ t = 0, "
                      "value = 1 }] }] }\n"),
              AllOf(HasSubstr("bad.toml:6"), HasSubstr("scene.motion.deform.0.axis")));
  EXPECT_THAT(refusal(kPlane + "pattern = { kind = \"uniform\", density = { kind = \"array\", "
                               "array = \"rho\" } }\n"),
              HasSubstr("scene.pattern.density.array: is in no file"));
  EXPECT_THAT(refusal("surface = { kind = \"plane\", edge = 1e-5 }\n" + kFew),
              HasSubstr("scene.surface.edge: asks for 20000000000 triangles"));
  EXPECT_THAT(refusal("surface = { kind = \"torus\", radius = 0.1, tube_radius = 0.2 }\n" + kFew),
              HasSubstr("scene.surface.tube_radius"));
}

TEST_F(BadDetails, AskForNoSurfaceAndNoGridThatWraps) {
  // Long and thin: few triangles by the area, 2e9 by the steps.
  EXPECT_THAT(
      refusal("surface = { kind = \"plane\", width = 1e6, height = 1e-6, edge = 1e-3 }\n" + kFew),
      AllOf(HasSubstr("bad.toml:4:"),
            HasSubstr("scene.surface.edge: asks for 2000000000 triangles")));
  EXPECT_THAT(
      refusal("surface = { kind = \"capsule\", radius = 1e-6, length = 1e6, edge = 0.01 }\n" +
              kFew),
      HasSubstr("scene.surface.edge: asks for"));
  EXPECT_THAT(refusal("surface = { kind = \"plane\", width = 1e6, height = 1e-6, edge = 10 }\n"
                      "pattern = { kind = \"grid\", count = 2000000 }\n"),
              HasSubstr("scene.pattern.count: asks for"));
}

TEST_F(BadDetails, AskForNoDrawingAndNoTableThatDoesNotFit) {
  ::setenv("GEOPRIOR_MEMORY_GB", "0.02", 1);
  EXPECT_THAT(refusal(kPlane + "pattern = { kind = \"uniform\", count = 5000 }\n" + kStretch +
                      "drawing = { look = { kind = \"spike\" } }\n"),
              AllOf(HasSubstr("bad.toml:7:"), HasSubstr("scene.drawing.look.spike: asks for")));
  EXPECT_THAT(refusal(kPlane + kFew +
                      "motion = { frames = 100000, drag = { handles = [{ radius = "
                      "0.1 }] } }\n"),
              AllOf(HasSubstr("bad.toml:6:"), HasSubstr("scene.motion.frames: asks for 100001")));
  ::unsetenv("GEOPRIOR_MEMORY_GB");
  EXPECT_THAT(
      refusal(kPlane + kFew + kStretch, "triplets = { cells = 1024, cell_capacity = 1024 }"),
      AllOf(HasSubstr("bad.toml:11:"), HasSubstr("options.triplets.cells: asks for")));
}

}  // namespace
}  // namespace geoprior::details
