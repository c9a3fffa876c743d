#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "baselines/fluid/liquid/tank/tank.h"
#include "core/error.h"

namespace geoprior::fluid {
namespace {

constexpr double kPlenty = 1e11;

/// A pool of water with a ball over it: nothing is wrong.
Tank sound_tank() {
  Tank tank;
  tank.cells = {20, 20, 20};
  tank.cell = 0.05;
  LiquidVolume pool;
  pool.name = "pool";
  pool.shape.centre = {0.5, 0.5, 0.2};
  pool.shape.half_size = {0.5, 0.5, 0.2};
  tank.volumes = {pool};
  TankSolid ball;
  ball.name = "ball";
  ball.shape.kind = LiquidShape::Kind::sphere;
  ball.shape.centre = {0.5, 0.5, 0.7};
  ball.shape.radius = 0.1;
  tank.solids = {ball};
  return tank;
}

std::string problem_of(const Tank& tank, double memory_limit = kPlenty) {
  try {
    require_valid(tank, 8, memory_limit, "scene");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

struct Fault {
  const char* name;
  std::function<void(Tank&)> make;
  const char* where;  ///< what the message must start with
  const char* what;   ///< what it must say
};

class TankCheckOf : public testing::TestWithParam<Fault> {};

TEST_P(TankCheckOf, NamesWhatIsWrongAndWhere) {
  Tank tank = sound_tank();
  GetParam().make(tank);
  const std::string problem = problem_of(tank);
  EXPECT_THAT(problem, testing::StartsWith(GetParam().where));
  EXPECT_THAT(problem, testing::HasSubstr(GetParam().what));
}

const double kNotANumber = std::numeric_limits<double>::quiet_NaN();

TriMesh tetrahedron() {
  TriMesh mesh;
  mesh.V.resize(4, 3);
  mesh.V << 0.2, 0.2, 0.5, 0.6, 0.2, 0.5, 0.2, 0.6, 0.5, 0.2, 0.2, 0.9;
  mesh.F.resize(4, 3);
  mesh.F << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  return mesh;
}

void use_mesh(Tank& tank, const TriMesh& mesh) {
  tank.solids[0].shape.kind = LiquidShape::Kind::mesh;
  tank.solids[0].shape.mesh = mesh;
}

std::vector<Fault> faults_of_numbers() {
  return {
      Fault{"ZeroCell", [](Tank& t) { t.cell = 0; }, "scene.cell", "positive"},
      Fault{"NanCell", [](Tank& t) { t.cell = kNotANumber; }, "scene.cell", "positive"},
      Fault{"NoCells", [](Tank& t) { t.cells.y() = 0; }, "scene.cells", "at least 1"},
      Fault{"NanGravity", [](Tank& t) { t.gravity.x() = kNotANumber; }, "scene.gravity", "finite"},
      Fault{"ZeroDensity", [](Tank& t) { t.density = 0; }, "scene.density", "positive"},
      Fault{"ZeroInterval", [](Tank& t) { t.frame_interval = 0; }, "scene.frame_interval",
            "positive"},
      Fault{"NegativeDuration", [](Tank& t) { t.duration = -1; }, "scene.duration", "-1"},
      Fault{"ZeroRadius", [](Tank& t) { t.solids[0].shape.radius = 0; },
            "scene.solids.0.shape.radius", "positive"},
      Fault{"NanCentre", [](Tank& t) { t.solids[0].shape.centre.z() = kNotANumber; },
            "scene.solids.0.shape.centre", "finite"},
      Fault{"NanVelocity", [](Tank& t) { t.volumes[0].velocity.x() = kNotANumber; },
            "scene.volumes.0.velocity", "finite"},
      Fault{"LongAxis",
            [](Tank& t) {
              t.solids[0].shape.kind = LiquidShape::Kind::half_space;
              t.solids[0].shape.axis = {0, 0, 2};
            },
            "scene.solids.0.shape.axis", "unit"}};
}

std::vector<Fault> faults_of_places() {
  return {Fault{"VolumeOutside", [](Tank& t) { t.volumes[0].shape.centre.x() = 9; },
                "scene.volumes.0.shape", "'pool' holds no cell"},
          Fault{"VolumeBetweenCentres",
                [](Tank& t) {
                  t.volumes[0].shape.centre.setConstant(0.5);
                  t.volumes[0].shape.half_size.setConstant(0.02);
                },
                "scene.volumes.0.shape", "at least one cell centre"},
          Fault{"VolumeInsideASolid",
                [](Tank& t) {
                  t.volumes[0].shape.centre = t.solids[0].shape.centre;
                  t.volumes[0].shape.half_size.setConstant(0.04);
                },
                "scene.volumes.0.shape", "free of solids"},
          Fault{"SolidOutside", [](Tank& t) { t.solids[0].shape.centre.y() = -3; },
                "scene.solids.0", "'ball' is outside the domain at 0 s"},
          Fault{"SolidThatLeaves",
                [](Tank& t) {
                  t.solids[0].motion = Trajectory{
                      {{.time = 0, .shift = {0, 0, 0}}, {.time = 1, .shift = {2, 0, 0}}}};
                },
                "scene.solids.0", "is outside the domain at 0."},
          Fault{"KeysOutOfOrder",
                [](Tank& t) {
                  t.solids[0].motion = Trajectory{
                      {{.time = 0.5, .shift = {0, 0, 0}}, {.time = 0.5, .shift = {0.1, 0, 0}}}};
                },
                "scene.solids.0.motion.1.time", "increase"},
          Fault{"NoKeys", [](Tank& t) { t.solids[0].motion = Trajectory{}; },
                "scene.solids.0.motion", "at least one key"}};
}

std::vector<Fault> faults_of_meshes() {
  return {Fault{"OpenMesh",
                [](Tank& t) {
                  TriMesh mesh = tetrahedron();
                  mesh.F.conservativeResize(3, 3);
                  use_mesh(t, mesh);
                },
                "scene.solids.0.shape.mesh", ""},
          Fault{"InsideOutMesh",
                [](Tank& t) {
                  TriMesh mesh = tetrahedron();
                  mesh.F.col(1).swap(mesh.F.col(2));
                  use_mesh(t, mesh);
                },
                "scene.solids.0.shape.mesh", "inside out"},
          Fault{"NanVertex",
                [](Tank& t) {
                  TriMesh mesh = tetrahedron();
                  mesh.V(2, 1) = kNotANumber;
                  use_mesh(t, mesh);
                },
                "scene.solids.0.shape.mesh", "vertex 2"},
          Fault{"EmptyMesh", [](Tank& t) { use_mesh(t, {}); }, "scene.solids.0.shape.mesh",
                "no triangles"}};
}

std::vector<Fault> faults_of_sources_and_size() {
  return {Fault{"SourceThatEndsBeforeItStarts",
                [](Tank& t) {
                  LiquidSource source;
                  source.shape.centre = {0.5, 0.5, 0.5};
                  source.shape.half_size.setConstant(0.1);
                  source.from = 1;
                  source.until = 0.5;
                  t.sources = {source};
                },
                "scene.sources.0.until", "from 1 s until 0.5 s"},
          Fault{"GridOverTwoBillionCells",
                [](Tank& t) {
                  t.cells = {4000, 4000, 4000};
                },
                "scene.cells", "4000 x 4000 x 4000 cells"}};
}

std::string name_of(const testing::TestParamInfo<Fault>& fault) { return fault.param.name; }

INSTANTIATE_TEST_SUITE_P(Numbers, TankCheckOf, testing::ValuesIn(faults_of_numbers()), name_of);
INSTANTIATE_TEST_SUITE_P(Places, TankCheckOf, testing::ValuesIn(faults_of_places()), name_of);
INSTANTIATE_TEST_SUITE_P(Meshes, TankCheckOf, testing::ValuesIn(faults_of_meshes()), name_of);
INSTANTIATE_TEST_SUITE_P(Sources, TankCheckOf, testing::ValuesIn(faults_of_sources_and_size()),
                         name_of);

TEST(TankCheck, ASoundTankPasses) {
  EXPECT_EQ(problem_of(sound_tank()), "");
  Tank tank = sound_tank();
  use_mesh(tank, tetrahedron());
  EXPECT_EQ(problem_of(tank), "");
}

TEST(TankCheck, AWallThatPassesThroughTheDomainsSideIsSound) {
  Tank tank = sound_tank();
  tank.solids[0].shape.kind = LiquidShape::Kind::box;
  tank.solids[0].shape.centre = {1, 0.5, 0.5};
  tank.solids[0].shape.half_size = {0.1, 2, 2};
  EXPECT_EQ(problem_of(tank), "");
}

TEST(TankCheck, SaysHowMuchMemoryAGridNeedsBeforeItStarts) {
  Tank tank = sound_tank();
  tank.cells = {1000, 1000, 1000};
  const std::string problem = problem_of(tank, 24e9);
  EXPECT_THAT(problem, testing::StartsWith("scene.cells: 1000 x 1000 x 1000 cells need about"));
  EXPECT_THAT(problem, testing::HasSubstr("24 GB"));
}

TEST(TankCheck, TheEstimateGrowsWithCellsAndParticles) {
  Tank tank = sound_tank();
  const double once = memory_estimate(tank, 8);
  EXPECT_GT(memory_estimate(tank, 16), 1.3 * once);
  // 8000 cells, 3200 of them full: between 100 and 2000 bytes a cell.
  EXPECT_GT(once, 8000 * 100);
  EXPECT_LT(once, 8000 * 2000);
  tank.cell /= 2;
  tank.cells *= 2;
  EXPECT_NEAR(memory_estimate(tank, 8), 8 * once, 0.01 * once);
}

TEST(TankCheck, FramesAreMultiplesOfTheInterval) {
  Tank tank;
  tank.duration = 1;
  tank.frame_interval = 0.1;
  EXPECT_EQ(tank.frame_count(), 11);
  EXPECT_DOUBLE_EQ(tank.frame_time(10), 1);
}

}  // namespace
}  // namespace geoprior::fluid
