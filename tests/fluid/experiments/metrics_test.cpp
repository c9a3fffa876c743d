// Rows of the fluid metric table on frames made by hand, whose answers are known.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>

#include "core/error.h"
#include "experiments/fluid/measures.h"
#include "experiments/fluid/topic.h"
#include "tests/core/geometry/shapes.h"
#include "tests/testbed/runner/metric_table.h"

namespace geoprior::fluid {
namespace {

/// A closed box; the triangles of each side wind outwards.
TriMesh box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriMesh mesh;
  mesh.V.resize(8, 3);
  for (int i = 0; i < 8; ++i) {
    mesh.V.row(i) << ((i & 1) != 0 ? high : low).x(), ((i & 2) != 0 ? high : low).y(),
        ((i & 4) != 0 ? high : low).z();
  }
  mesh.F.resize(12, 3);
  mesh.F << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4,
      6, 1, 3, 5, 3, 7, 5;
  return mesh;
}

TriMesh both(const TriMesh& a, const TriMesh& b) {
  TriMesh mesh;
  mesh.V.resize(a.V.rows() + b.V.rows(), 3);
  mesh.V << a.V, b.V;
  mesh.F.resize(a.F.rows() + b.F.rows(), 3);
  mesh.F << a.F, b.F.array() + static_cast<int>(a.V.rows());
  return mesh;
}

Frame frame_of(const TriMesh& mesh, double time = 0) {
  Frame frame;
  frame.parameter = time;
  Part& part = frame.parts["surface"];
  part.points = mesh.V;
  part.triangles = mesh.F;
  return frame;
}

/// A tank of 1 x 0.4 x 0.6 m with a block of water, a = 0.2 m wide and 2a high, at its wall.
class TankMetrics : public ::testing::Test {
 protected:
  TankMetrics() {
    Tank tank;
    tank.cell = 0.05;
    tank.cells = {20, 8, 12};
    tank.density = 1000;
    LiquidVolume column;
    column.shape.kind = LiquidShape::Kind::box;
    column.shape.centre = {0.1, 0.2, 0.2};
    column.shape.half_size = {0.1, 0.2, 0.2};
    tank.volumes.push_back(column);
    scene.gauges = ColumnGrid{Eigen::Vector2d::Zero(), tank.cell, 20, 8};
    scene.cell = tank.cell;
    scene.tank = tank;
  }
  [[nodiscard]] std::optional<double> value(const std::string& name, const Frame& frame,
                                            const Frame* reference = nullptr) const {
    return table.of_frame(name, scene, frame, reference);
  }
  [[nodiscard]] std::optional<double> over(const std::string& name,
                                           const std::vector<Frame>& frames) const {
    return table.of_sequence(name, scene, frames);
  }

  FluidScene scene;
  test::MetricTable table{fluid::metrics()};
  Frame block = frame_of(box({0, 0, 0}, {0.2, 0.4, 0.4}));
};

// Potential energy: rho g V z of the centre = 1000 * 9.81 * 0.032 * 0.2 J.
TEST_F(TankMetrics, ABlockOfWaterIsMeasured) {
  EXPECT_NEAR(value("volume", block).value(), 0.032, 1e-15);
  EXPECT_NEAR(value("potential_energy", block).value(), 62.784, 1e-10);
  EXPECT_EQ(value("manifold_defects", block), 0);
  EXPECT_EQ(value("border_edges", block), 0);
  EXPECT_EQ(value("components", block), 1);
  EXPECT_EQ(value("triangles", block), 12);
  EXPECT_EQ(value("top", block), 0.4);
}

// Without one triangle: three edges of the border, and no volume that would mean anything.
TEST_F(TankMetrics, AnOpenSurfaceHasABorderAndNoVolume) {
  TriMesh open = box({0, 0, 0}, {0.2, 0.4, 0.4});
  open.F.conservativeResize(11, 3);
  const Frame frame = frame_of(open);
  EXPECT_EQ(value("border_edges", frame), 3);
  EXPECT_FALSE(value("volume", frame).has_value());
}

TEST_F(TankMetrics, ADropBesideThePoolIsAComponent) {
  EXPECT_EQ(value("components", frame_of(both(box({0, 0, 0}, {1, 0.4, 0.1}),
                                              box({0.4, 0.2, 0.3}, {0.5, 0.3, 0.4})))),
            2);
}

/// To which the front is searched: a thousandth of a cell, over a.
constexpr double kFrontTolerance = 1e-3 * 0.05 / 0.2;

// At the start the front is at x = a and the height is 2a.
TEST_F(TankMetrics, TheDamStartsAtOneAndOne) {
  EXPECT_NEAR(value("dam_front", block).value(), 1, kFrontTolerance);
  EXPECT_NEAR(value("dam_height", block).value(), 1, 1e-12);
  scene.tank->solids.emplace_back();
  EXPECT_FALSE(value("dam_front", block).has_value());
}

// A layer of two half cells lies deeper than half a cell: the front is where it ends, 3a.
TEST_F(TankMetrics, TheFrontIsWhereTheWaterIsDeeperThanHalfACell) {
  const Frame spread = frame_of(box({0, 0, 0}, {0.6, 0.4, 0.05}));
  EXPECT_NEAR(value("dam_front", spread).value(), 3, kFrontTolerance);
  const Frame film =
      frame_of(both(box({0, 0, 0}, {0.2, 0.4, 0.05}), box({0.2, 0, 0}, {0.6, 0.4, 0.02})));
  EXPECT_NEAR(value("dam_front", film).value(), 1, kFrontTolerance);
}

// A pool that rose by 10 mm everywhere: heights differ by 10 mm, the volume by a tenth.
TEST_F(TankMetrics, ComparisonOfTwoPools) {
  const Frame low = frame_of(box({0, 0, 0}, {1, 0.4, 0.1}));
  const Frame high = frame_of(box({0, 0, 0}, {1, 0.4, 0.11}));
  EXPECT_NEAR(value("height_rms", high, &low).value(), 0.01, 1e-12);
  EXPECT_NEAR(value("landed_height_rms", high, &low).value(), 0.01, 1e-12);
  EXPECT_NEAR(value("distance_max", high, &low).value(), 0.01, 1e-12);
  EXPECT_NEAR(value("volume_change", high, &low).value(), 0.1, 1e-12);
  // Round-off of the nearest points, of coordinates of 1 m.
  EXPECT_NEAR(value("distance_rms", low, &low).value(), 0, 1e-15);
}

TEST_F(TankMetrics, HeightsBelowADropInTheAirAreNotThoseOfLandedWater) {
  const Frame pool = frame_of(box({0, 0, 0}, {1, 0.4, 0.1}));
  const Frame falling =
      frame_of(both(box({0, 0, 0}, {1, 0.4, 0.1}), box({0.4, 0.2, 0.3}, {0.5, 0.3, 0.4})));
  EXPECT_TRUE(value("height_rms", pool, &falling).has_value());
  EXPECT_FALSE(value("landed_height_rms", pool, &falling).has_value());
}

// Volumes 0.04, 0.0408, 0.0396 m^3: at most 2 % from the first. Heights 0.1, 0.102, 0.099 m have
// the second difference -0.005 m.
TEST_F(TankMetrics, DriftAndJitterOverTime) {
  std::vector<Frame> frames;
  for (const double height : {0.1, 0.102, 0.099}) {
    frames.push_back(frame_of(box({0, 0, 0}, {1, 0.4, height}), 0.1 * double(frames.size())));
  }
  EXPECT_NEAR(over("volume_drift", frames).value(), 0.02, 1e-12);
  EXPECT_NEAR(over("second_difference", frames).value(), 0.005, 1e-12);
}

/// A pool with vertices at the quarters of every gauge's square: a gauge stands between vertices of
/// its own square and sees their height. Where `pasted(i)` holds for the gauge's column, a feature
/// has lifted the pool by `lift`.
template <class Pasted>
Frame pool_with_a_ridge(const ColumnGrid& grid, double height, double lift, Pasted pasted,
                        double time) {
  const int nx = 2 * grid.nx, ny = 2 * grid.ny;
  TriMesh mesh;
  mesh.V.resize(nx * ny, 3);
  mesh.F.resize(2 * (nx - 1) * (ny - 1), 3);
  Eigen::VectorXd feature(nx * ny);
  int t = 0;
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      const int v = i * ny + j;
      feature[v] = pasted(i / 2) ? 1 : 0;
      mesh.V.row(v) << grid.spacing * (i + 0.5) / 2, grid.spacing * (j + 0.5) / 2,
          height + lift * feature[v];
      if (i + 1 == nx || j + 1 == ny) continue;
      mesh.F.row(t++) << v, v + ny, v + ny + 1;
      mesh.F.row(t++) << v, v + ny + 1, v + 1;
    }
  }
  Frame frame = frame_of(mesh, time);
  frame.parts["surface"].arrays.push_back({"feature", "1", NamedArray::On::points, feature});
  return frame;
}

/// The pool alone, at three heights whose second difference is -0.005 m.
constexpr std::array<double, 3> kPool{0.1, 0.102, 0.099};

std::shared_ptr<const SurfaceSequence> pool_alone(const ColumnGrid& grid) {
  std::vector<SurfaceFrame> frames;
  for (const double height : kPool) {
    const double time = 0.1 * static_cast<double>(frames.size());
    const Frame frame = pool_with_a_ridge(
        grid, height, 0, [](int) { return false; }, time);
    const Part& surface = frame.parts.at("surface");
    frames.push_back({time, {surface.points, surface.triangles}, {}, {}});
  }
  return std::make_shared<StoredSequence>(std::move(frames), "pool");
}

// The ridge over the gauges 8 to 11 is lifted by 0.02, 0.03 and 0.01 m: with the pool's own, its
// second difference is -0.035 m, seven times the pool's.
TEST_F(TankMetrics, SeamJitterOfARidgeThatRisesAndFallsIsItsSecondDifference) {
  scene.sculpt.target = pool_alone(*scene.gauges);
  constexpr std::array<double, 3> lift{0.02, 0.03, 0.01};
  std::vector<Frame> frames;
  for (std::size_t f = 0; f < 3; ++f) {
    frames.push_back(pool_with_a_ridge(
        *scene.gauges, kPool[f], lift[f], [](int i) { return i >= 8 && i < 12; },
        0.1 * static_cast<double>(f)));
  }
  EXPECT_NEAR(over("seam_jitter", frames).value(), 7, 1e-9);
}

// A ridge of 0.02 m that moves on by one gauge a frame: at its border a gauge is lifted (0, 1, 1)
// or (1, 1, 0) times, a second difference of -0.02 m beside the pool's -0.005 m. The same border
// fixed in place: that of the pool alone.
TEST_F(TankMetrics, SeamJitterOfARidgeThatMovesIsItsHeight) {
  scene.sculpt.target = pool_alone(*scene.gauges);
  for (const int step : {0, 1}) {
    std::vector<Frame> frames;
    for (int f = 0; f < 3; ++f) {
      const int first = 8 + step * f;
      frames.push_back(pool_with_a_ridge(
          *scene.gauges, kPool[f], 0.02, [=](int i) { return i >= first && i < first + 4; },
          0.1 * f));
    }
    EXPECT_NEAR(over("seam_jitter", frames).value(), step == 0 ? 1 : 5, 1e-9) << step;
  }
}

// Both sides of the ridge are planes, 0.02 m apart: no slope and no curvature between them,
// whatever the triangles that bridge the step say.
TEST_F(TankMetrics, TheSeamOfARidgeIsAStepOfItsHeight) {
  const auto ridge = [](int i) { return i >= 8 && i < 12; };
  const Frame frame = pool_with_a_ridge(*scene.gauges, 0.1, 0.02, ridge, 0);
  EXPECT_NEAR(value("seam_position_jump", frame).value(), 0.02, 1e-12);
  EXPECT_NEAR(value("seam_position_rms", frame).value(), 0.02, 1e-12);
  EXPECT_NEAR(value("seam_angle_jump", frame).value(), 0, 1e-9);
  EXPECT_NEAR(value("seam_curvature_jump", frame).value(), 0, 1e-9);
  EXPECT_GT(value("seam_angle", frame).value(), 30);  // atan(0.02 / 0.025) = 38.7
  const auto nowhere = [](int) { return false; };
  EXPECT_FALSE(
      value("seam_position_jump", pool_with_a_ridge(*scene.gauges, 0.1, 0.02, nowhere, 0)));
  EXPECT_FALSE(value("seam_position_jump", block));
}

/// Particles as far apart as `spacing`, of which the first is that far from the wall by half.
Part particles_of(const Eigen::Vector3d& size, double spacing) {
  Part part;
  part.kind = Part::Kind::points;
  const Eigen::Vector3i count = (size / spacing).array().round().cast<int>();
  part.points.resize(count.prod(), 3);
  int row = 0;
  for (int i = 0; i < count.x(); ++i)
    for (int j = 0; j < count.y(); ++j)
      for (int k = 0; k < count.z(); ++k)
        part.points.row(row++) = spacing * Eigen::RowVector3d(i + 0.5, j + 0.5, k + 0.5);
  return part;
}

// Balls of half a cell that stand a cell apart fill pi / 6 of the block; four columns a diameter
// see 3 % more of each.
TEST_F(TankMetrics, ParticlesShareTheBlockAsFarAsTheirBallsFillIt) {
  EXPECT_FALSE(value("particle_iou", block).has_value());
  block.parts["particles"] = particles_of({0.2, 0.4, 0.4}, 0.05);
  EXPECT_NEAR(value("particle_iou", block).value(), std::numbers::pi / 6, 0.02);
  // Half of the particles beside the block: b / 2 of it shared, of 1 + b / 2 together.
  Part& particles = block.parts["particles"];
  particles.points.bottomRows(128).col(0).array() += 0.5;
  const double half = std::numbers::pi / 12;
  EXPECT_NEAR(value("particle_iou", block).value(), half / (1 + half), 0.02);
}

/// Frames with an octahedron at every true object, labelled by `id_of(true id, frame)`, 0: none.
template <class IdOf>
std::vector<Frame> labelled(const InjectedSequence& injected, IdOf id_of) {
  std::vector<Frame> frames;
  for (int f = 0; f < injected.frame_count(); ++f) {
    TriMesh mesh;
    std::vector<double> track, kind;
    for (const InjectedTruth& truth : injected.truth()) {
      const int id = truth.frame == f ? id_of(truth.id, f) : 0;
      if (id == 0) continue;
      TriMesh ball = shapes::octahedron();
      ball.V = (0.01 * ball.V).rowwise() + truth.centre.transpose();
      mesh = mesh.V.rows() == 0 ? ball : both(mesh, ball);
      track.insert(track.end(), 6, id);
      kind.insert(kind.end(), 6, truth.isolated ? 1 : 2);
    }
    Frame frame = frame_of(mesh, injected.time(f));
    const auto add = [&](const char* name, const std::vector<double>& values) {
      frame.parts["surface"].arrays.push_back(
          {name, "1", NamedArray::On::points,
           Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()))});
    };
    add("track", track);
    add("kind", kind);
    frames.push_back(std::move(frame));
  }
  return frames;
}

TEST_F(TankMetrics, TracksThatAreTheTruthScoreOne) {
  InjectedOptions options;
  options.bumps = 2;
  options.rings = options.drops = options.crossings = 0;
  options.frames = 10;
  scene.injected = std::make_shared<InjectedSequence>(options);
  const auto truth = labelled(*scene.injected, [](int id, int) { return id; });
  EXPECT_EQ(over("idf1", truth), 1);
  EXPECT_EQ(over("mota", truth), 1);
  EXPECT_EQ(over("track_switches", truth), 0);
  EXPECT_EQ(over("track_fragments", truth), 0);
}

// Two tracks of equal length swap their names half way: each true track keeps the name that half of
// it has, so IDTP is half of the objects, IDF1 = 1/2; and each switches once.
TEST_F(TankMetrics, NamesThatAreSwappedHalfWayCostHalf) {
  InjectedOptions options;
  options.bumps = 2;
  options.rings = options.drops = options.crossings = 0;
  options.frames = 10;
  scene.injected = std::make_shared<InjectedSequence>(options);
  std::map<int, std::vector<int>> lives;
  for (const InjectedTruth& t : scene.injected->truth()) lives[t.id].push_back(t.frame);
  ASSERT_EQ(lives.size(), 2U);
  const int a = lives.begin()->first, b = lives.rbegin()->first;
  ASSERT_EQ(lives[a], lives[b]);
  ASSERT_EQ(lives[a].size() % 2, 0U);
  const int middle = lives[a][lives[a].size() / 2];
  const auto swapped = labelled(*scene.injected, [&](int id, int f) {
    if (f < middle) return id;
    return id == a ? b : a;
  });
  EXPECT_EQ(over("idf1", swapped), 0.5);
  EXPECT_EQ(over("track_switches", swapped), 2);
}

/// A sea of n x n samples at rest.
Frame sea_of(int n, double time = 0) {
  Frame frame;
  frame.parameter = time;
  Part& samples = frame.parts["samples"];
  samples.kind = Part::Kind::grid;
  samples.grid_size = {n, n, 1};
  for (const char* name : {"height", "rate"}) {
    samples.arrays.push_back({name, "m", NamedArray::On::points, Eigen::VectorXd::Zero(n * n)});
  }
  frame.tables["sea"] = {{"depth [m]", "gravity [m/s^2]", "wind [deg]", "variance [m^2]"},
                         Eigen::RowVector4d(10, 9.81, 0, 0)};
  return frame;
}

// Of frames from outside, which may have any number of rows and columns.
TEST_F(TankMetrics, SeasOfAnotherShapeAreRefused) {
  EXPECT_EQ(value("significant_wave_height", sea_of(4)), 0);
  const auto refused = [&](const std::function<void(Frame&)>& change) {
    Frame frame = sea_of(4);
    change(frame);
    EXPECT_THROW((void)value("significant_wave_height", frame), Error);
  };
  refused([](Frame& f) { f.tables["sea"].rows.resize(0, 4); });
  refused([](Frame& f) { f.tables["sea"].rows.conservativeResize(1, 3); });
  refused([](Frame& f) { f.parts["samples"].grid_size = {4, 4, 2}; });
  refused([](Frame& f) { f.parts["samples"].grid_size = {8, 4, 1}; });
  refused([](Frame& f) { f.parts["samples"].arrays.pop_back(); });
  EXPECT_NO_THROW((void)over("dispersion_error", {sea_of(4, 0), sea_of(4, 1), sea_of(4, 2)}));
  EXPECT_THROW((void)over("dispersion_error", {sea_of(4, 0), sea_of(4, 1), sea_of(8, 2)}), Error);
  EXPECT_THROW((void)over("dispersion_error", {sea_of(4, 0), sea_of(8, 1), sea_of(8, 2)}), Error);
}

TEST_F(TankMetrics, AFlagOfThreeNumbersIsRefused) {
  block.parts["surface"].arrays.push_back(
      {"feature", "1", NamedArray::On::points, Eigen::MatrixX3d::Ones(8, 3)});
  EXPECT_THROW((void)value("seam_angle", block), Error);
}

// A ground truth without an injected animation does not exist.
TEST_F(TankMetrics, ScoresNeedATruth) { EXPECT_FALSE(over("idf1", {block, block}).has_value()); }

}  // namespace
}  // namespace geoprior::fluid
