// [scene] of the fluid topic: what it means, and what it refuses.
#include "experiments/fluid/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/mesh.h"
#include "experiments/fluid/topic.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::fluid {
namespace {

using namespace test;

using ::testing::AllOf;
using ::testing::HasSubstr;

class FluidScenes : public RunTest {
 protected:
  /// What a [scene] table describes.
  [[nodiscard]] std::shared_ptr<const Scene> load_scene(const std::string& scene_lines,
                                                        std::uint64_t seed = 1) const {
    const auto file = write_experiment(
        "fluid/scene", "title = \"A scene\"\ntopic = \"fluid\"\n[scene]\n" + scene_lines +
                           "\n[[variant]]\nname = \"flip\"\nmethod = \"liquid\"\n");
    const Experiment experiment = load_experiment(file, {make_topic()}, {});
    return make_topic().load(*experiment.cases[0].scene, file.parent_path(), seed);
  }
  [[nodiscard]] FluidScene scene(const std::string& scene_lines, std::uint64_t seed = 1) const {
    return dynamic_cast<const FluidScene&>(*load_scene(scene_lines, seed));
  }
  [[nodiscard]] std::string refusal(const std::string& scene_lines) const {
    return error_of([&] { (void)load_scene(scene_lines); });
  }
  /// A file beside the experiment.
  void write(const std::string& name, const std::string& text) const {
    const auto place = folder() / "experiments" / "fluid" / name;
    std::filesystem::create_directories(place.parent_path());
    std::ofstream(place) << text;
  }
};

const std::string kTank =
    "tank = { size = [0.4, 0.2, 0.2], cell = 0.05, volumes = [{ shape = { kind = \"box\", centre = "
    "[0.1, 0.1, 0.05], size = [0.2, 0.2, 0.1] } }] }\n";
const std::string kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// Vertices of all frames, in order.
Eigen::MatrixX3d vertices_of(const SurfaceSequence& sequence) {
  Eigen::MatrixX3d all(0, 3);
  for (int f = 0; f < sequence.frame_count(); ++f) {
    const Eigen::MatrixX3d V = sequence.frame(f).mesh.V;
    all.conservativeResize(all.rows() + V.rows(), 3);
    all.bottomRows(V.rows()) = V;
  }
  return all;
}

bool same_bytes(const Eigen::MatrixX3d& a, const Eigen::MatrixX3d& b) {
  return a.rows() == b.rows() && (a.array() == b.array()).all();
}

TEST_F(FluidScenes, SeedOfTheExperimentReachesInjectedFeaturesAndTheirNoise) {
  for (const std::string lines :
       {"injected = { frames = 4 }\n", "injected = { frames = 4, noise = 0.05 }\n"}) {
    const Eigen::MatrixX3d one = vertices_of(*scene(lines, 1).injected);
    EXPECT_TRUE(same_bytes(one, vertices_of(*scene(lines, 1).injected)));
    EXPECT_FALSE(same_bytes(one, vertices_of(*scene(lines, 2).injected)));
  }
}

TEST_F(FluidScenes, NoiseOfAStillPoolIsThatOfTheSeed) {
  const std::string still =
      "injected = { bumps = 0, rings = 0, drops = 0, crossings = 0, frames = 3";
  const std::string noisy = still + ", noise = 0.05 }\n";
  // Without noise and features nothing is drawn.
  EXPECT_TRUE(same_bytes(vertices_of(*scene(still + " }\n", 1).injected),
                         vertices_of(*scene(still + " }\n", 2).injected)));
  const Eigen::MatrixX3d one = vertices_of(*scene(noisy, 1).injected);
  const Eigen::MatrixX3d two = vertices_of(*scene(noisy, 2).injected);
  EXPECT_TRUE(same_bytes(one, vertices_of(*scene(noisy, 1).injected)));
  EXPECT_FALSE(same_bytes(one, two));
}

TEST_F(FluidScenes, SeedOfTheExperimentReachesTheWavesOfAnOcean) {
  const std::string start = "duration = 0.1\nframe_interval = 0.05\n";
  const auto ocean = [&](const std::string& more) {
    return start + "target = { kind = \"ocean\", ocean = { samples = 32, size = 20 }" + more +
           " }\n";
  };
  const Eigen::MatrixX3d one = vertices_of(*scene(ocean(""), 1).sculpt.target);
  EXPECT_TRUE(same_bytes(one, vertices_of(*scene(ocean(""), 1).sculpt.target)));
  EXPECT_FALSE(same_bytes(one, vertices_of(*scene(ocean(""), 2).sculpt.target)));
  EXPECT_FALSE(same_bytes(one, vertices_of(*scene(ocean(", ocean_seed = 2"), 1).sculpt.target)));
}

TEST_F(FluidScenes, TankIsWholeCellsWithGaugesOverIt) {
  const FluidScene s = scene("duration = 0.1\nframe_interval = 0.02\n" + kTank);
  EXPECT_EQ(s.require_tank("test").cells, Eigen::Vector3i(8, 4, 4));
  EXPECT_EQ(s.cell, 0.05);
  EXPECT_EQ(s.gauges->nx * s.gauges->ny, 32);
  EXPECT_EQ(s.sculpt.times.size(), 6U);
  EXPECT_DOUBLE_EQ(s.dam_width().value(), 0.2);
  EXPECT_EQ(s.facts().at("cells"), 128);
}

TEST_F(FluidScenes, UpIsAgainstGravity) {
  EXPECT_EQ(scene("gravity = [0, -2, 0]\n").sculpt.up, Eigen::Vector3d::UnitY());
}

TEST_F(FluidScenes, TargetMeshIsScaledTurnedThenMoved) {
  write("solid.obj", kTetrahedron);
  const FluidScene s = scene(
      "target = { kind = \"mesh\", file = \"solid.obj\", scale = 2, turn_deg = [0, 0, 90], move = "
      "[0, 0, 5] }\n");
  const Eigen::MatrixX3d V = s.sculpt.target->frame(0).mesh.V;
  EXPECT_NEAR((V.row(1) - Eigen::RowVector3d(0, 2, 5)).norm(), 0, 1e-12);
  EXPECT_EQ(s.input_files.size(), 1U);
}

TEST_F(FluidScenes, InjectedAnimationIsSourceAndTarget) {
  const FluidScene s = scene(
      "injected = { frames = 4 }\ntarget = { kind = \"injected\" }\nedits = [{ source = "
      "\"injected\", cut = true }]\n");
  EXPECT_EQ(s.sculpt.target, s.sculpt.sources.at("injected"));
  EXPECT_TRUE(s.sculpt.edits.at(0).cut);
}

TEST_F(FluidScenes, RefusalsNameTheKey) {
  EXPECT_THAT(refusal("tank = { size = [0.43, 0.2, 0.2], cell = 0.05 }\n"),
              AllOf(HasSubstr("scene.tank.size.0"), HasSubstr("whole number of cells")));
  EXPECT_THAT(refusal("target = { kind = \"injected\" }\n"), HasSubstr("scene.target.kind"));
  EXPECT_THAT(refusal("edits = [{ name = \"e\", source = \"sea\" }]\n"),
              AllOf(HasSubstr("scene.edits.0.source"), HasSubstr("'sea'")));
  EXPECT_THAT(refusal("tank = { size = [0.4, 0.2, 0.2], cell = 0.05, volumes = [{ shape = { kind = "
                      "\"half-space\", axis = [0, 0, 0] } }] }\n"),
              HasSubstr("scene.tank.volumes.0.shape.axis"));
  EXPECT_THAT(error_of([&] { (void)scene("duration = 1\n").require_tank("the method 'liquid'"); }),
              AllOf(HasSubstr("the method 'liquid'"), HasSubstr("scene.tank")));
}

TEST_F(FluidScenes, RefusalsNameTheFile) {
  EXPECT_THAT(refusal("target = { kind = \"mesh\", file = \"none.obj\" }\n"),
              AllOf(HasSubstr("scene.target.file"), HasSubstr("none.obj")));
  EXPECT_THAT(refusal("edit_list = \"none.toml\"\n"), HasSubstr("none.toml"));
  EXPECT_THAT(refusal("libraries = [{ name = \"l\", path = \"none.h5\" }]\n"),
              HasSubstr("none.h5"));
  write("cut.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
        "0\n");
  EXPECT_THAT(refusal("sequences = [{ name = \"s\", path = \"cut.ply\" }]\n"),
              HasSubstr("cut.ply"));
  write("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THAT(refusal("sequences = [{ name = \"s\", path = \"nan.obj\" }]\n"),
              HasSubstr("nan.obj"));
  write("solid.obj", kTetrahedron);
  EXPECT_THAT(refusal("sequences = [{ name = \"s\", path = \"solid.obj\" }, { name = \"s\", path = "
                      "\"solid.obj\" }]\n"),
              HasSubstr("scene.sequences.1.name"));
}

// Turned over, the tetrahedron has volume -1/6.
TEST_F(FluidScenes, MeshesThatAreInsideOutAreTurnedOverWithAWarning) {
  write("inside-out.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
  const FluidScene s = scene("target = { kind = \"mesh\", file = \"inside-out.obj\" }\n");
  EXPECT_FALSE(s.load_warnings.empty());
  const TriMesh mesh = s.sculpt.target->frame(0).mesh;
  double volume = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::Vector3d a = mesh.V.row(mesh.F(t, 0)), b = mesh.V.row(mesh.F(t, 1)),
                          c = mesh.V.row(mesh.F(t, 2));
    volume += a.dot(b.cross(c)) / 6;
  }
  EXPECT_NEAR(volume, 1.0 / 6, 1e-12);
}

TEST_F(FluidScenes, GridsTooLargeForMemoryAreRefusedBeforeTheyStart) {
  EXPECT_THAT(refusal("tank = { size = [4, 4, 4], cell = 0.0005 }\n"),
              AllOf(HasSubstr("scene.tank"), HasSubstr("8000 x 8000 x 8000 cells need about"),
                    HasSubstr("a grid that fits into")));
}

TEST_F(FluidScenes, GiveATankWithItsBodiesAndTheMapsOfThoseThatMove) {
  write("body.obj", kTetrahedron);
  const Frame given =
      scene(
          "duration = 0.1\nframe_interval = 0.05\ntank = { size = [0.4, 0.2, 0.2], cell = 0.05, "
          "volumes = [{ shape = { kind = \"box\", centre = [0.1, 0.1, 0.05], size = [0.2, 0.2, "
          "0.1] } }], solids = [{ name = \"body\", shape = { kind = \"mesh\", file = \"body.obj\", "
          "scale = 0.1, centre = [0.2, 0.05, 0.05] }, keys = [{ t = 0 }, { t = 0.1, move = [0, 0, "
          "0.04], turn_deg = [0, 0, 90] }] }] }\n")
          .given();
  EXPECT_EQ(given.require_table("tank").rows.row(0).segment<4>(3),
            Eigen::RowVector4d(8, 4, 4, 0.05));
  EXPECT_EQ(
      given.require_table("volumes").rows.row(0).segment<6>(1).cast<float>(),
      (Eigen::Matrix<double, 1, 6>() << 0.1, 0.1, 0.05, 0.1, 0.1, 0.05).finished().cast<float>());
  const Part& body = given.require_part("solid_0000", Part::Kind::triangles);
  const Eigen::Matrix<double, 1, 12> last =
      given.require_table("solid_transforms").rows.bottomRightCorner<1, 12>();
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> map(last.data());
  // About the middle of its box, a quarter of a turn about z.
  const Eigen::Vector3d middle =
      (body.points.colwise().minCoeff() + body.points.colwise().maxCoeff()) / 2;
  EXPECT_NEAR((map * middle.homogeneous() - middle - Eigen::Vector3d(0, 0, 0.04)).norm(), 0, 1e-12);
  EXPECT_NEAR((map.leftCols<3>() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 0,
              1e-12);
}

}  // namespace
}  // namespace geoprior::fluid
