#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "experiments/fluid/injected/sequence.h"
#include "solvers/fluid/features/segmentation.h"
#include "solvers/fluid/features/segmentation_thresholds.h"
#include "solvers/fluid/features/surface_components.h"
#include "tests/fluid/liquid/test_surfaces.h"

namespace geoprior::fluid {
namespace {

using surfaces::append;
using surfaces::still;

constexpr double kRegionCell = 0.025;

double two_bumps(double x, double y) {
  const auto bump = [](double r2) { return 0.08 * std::exp(-r2 / (2 * 0.09 * 0.09)); };
  return bump((x - 0.5) * (x - 0.5) + y * y) + bump((x + 0.5) * (x + 0.5) + y * y);
}
TriMesh pool_with_bumps() { return surfaces::graph(1, 80, 0.3, two_bumps); }

SegmentationOptions given(double high, double low) {
  SegmentationOptions options;
  options.cell = kRegionCell;
  options.thresholds = ThresholdKind::given;
  options.high = high;
  options.low = low;
  return options;
}

SegmentedFrame segmented(const TriMesh& mesh, const SegmentationOptions& options) {
  return Segmenter(still(mesh), options).segment({0, mesh, {}, {}}, 0);
}

bool warns(const std::vector<std::string>& warnings, const std::string& text) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const auto& w) { return w.find(text) != std::string::npos; });
}

TEST(Segmentation, FindsTheBumpsOfAPoolWhereTheyAre) {
  const SegmentedFrame frame = segmented(pool_with_bumps(), given(0.12, 0.04));
  ASSERT_EQ(frame.regions.size(), 2u);
  for (const Region& region : frame.regions) {
    EXPECT_EQ(region.kind, RegionKind::differential);
    EXPECT_NEAR(std::abs(region.centre.x()), 0.5, kRegionCell);
    EXPECT_NEAR(region.centre.y(), 0, kRegionCell);
    EXPECT_GT(region.crest_share, 0.5);
    EXPECT_FALSE(region.support.empty());
    EXPECT_LT(region.box_min.z(), region.box_max.z());
    // |H| h > 0.04 holds inside of about sqrt(2) sigma, where H changes its sign.
    EXPECT_NEAR(std::sqrt(region.area / std::numbers::pi), std::sqrt(2.0) * 0.09,
                1.5 * kRegionCell);
  }
}

TEST(Segmentation, LabelsFollowTheRegions) {
  const TriMesh mesh = pool_with_bumps();
  const SegmentedFrame frame = segmented(mesh, given(0.12, 0.04));
  std::vector<double> area(frame.regions.size() + 1, 0.0);
  const std::vector<double> of_vertex = surface_shape(surface_graph(mesh), {}).area;
  for (std::size_t v = 0; v < frame.label.size(); ++v) area.at(frame.label[v]) += of_vertex[v];
  for (int r = 0; r < std::ssize(frame.regions); ++r) {
    EXPECT_EQ(frame.regions[r].label, r + 1);
    EXPECT_NEAR(area[r + 1], frame.regions[r].area, 1e-12);
  }
}

// Seeds above the bumps' peak a / sigma^2 h = 0.247: nothing grows, however low the lower one is.
TEST(Segmentation, HysteresisNeedsASeed) {
  EXPECT_TRUE(segmented(pool_with_bumps(), given(0.3, 0.01)).regions.empty());
  EXPECT_EQ(segmented(pool_with_bumps(), given(0.15, 0.04)).regions.size(), 2u);
}

TEST(Segmentation, SmallRegionsAreDropped) {
  SegmentationOptions options = given(0.12, 0.04);
  options.smallest_area = 200;
  EXPECT_TRUE(segmented(pool_with_bumps(), options).regions.empty());
}

TEST(Segmentation, DropsAreIsolatedWholeAndHaveTheirVolume) {
  TriMesh mesh = pool_with_bumps();
  const double radius = 0.12;
  append(surfaces::sphere({0.1, 0.2, 0.7}, radius, 0.02), mesh);
  const SegmentedFrame frame = segmented(mesh, given(0.12, 0.04));
  ASSERT_EQ(frame.regions.size(), 3u);
  const Region& drop = frame.regions[2];
  EXPECT_EQ(drop.kind, RegionKind::isolated);
  // Contoured spheres lie inside: the error is h^2 / R^2 at most.
  EXPECT_NEAR(drop.volume / (4.0 / 3 * std::numbers::pi * std::pow(radius, 3)), 1, 0.03);
  EXPECT_LT((drop.centre - Eigen::Vector3d(0.1, 0.2, 0.7)).norm(), 0.01 * radius);
  EXPECT_EQ(std::count(frame.label.begin(), frame.label.end(), 3),
            mesh.vertex_count() - pool_with_bumps().vertex_count());
}

TEST(Segmentation, ClosedComponentsTurnedInwardsAreBubblesNotDrops) {
  TriMesh mesh = pool_with_bumps();
  append(surfaces::turned_over(surfaces::sphere({0.1, 0.2, -0.7}, 0.12, 0.02)), mesh);
  const SegmentedFrame frame = segmented(mesh, given(0.12, 0.04));
  EXPECT_EQ(frame.regions.size(), 2u);
  EXPECT_TRUE(warns(frame.warnings, "bubbles"));
}

TEST(Segmentation, AnInsideOutMeshIsTurnedOverAndReported) {
  const TriMesh mesh = pool_with_bumps();
  const SegmentedFrame as_it_is = segmented(mesh, given(0.12, 0.04));
  const SegmentedFrame turned = segmented(surfaces::turned_over(mesh), given(0.12, 0.04));
  EXPECT_TRUE(warns(turned.warnings, "turned over"));
  EXPECT_EQ(turned.label, as_it_is.label);
  EXPECT_LT((turned.curvature - as_it_is.curvature).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Segmentation, RingsWithHandlesAreDrops) {
  TriMesh mesh = pool_with_bumps();
  append(surfaces::contour({Eigen::Vector3d(-0.3, -0.3, 0.5), Eigen::Vector3d(0.3, 0.3, 0.8)}, 0.02,
                           [](const Eigen::Vector3d& x) {
                             return std::hypot(std::hypot(x.x(), x.y()) - 0.13, x.z() - 0.65) -
                                    0.05;
                           }),
         mesh);
  EXPECT_EQ(segmented(mesh, given(0.12, 0.04)).regions.back().kind, RegionKind::isolated);
}

TEST(Segmentation, ComponentsKnowTheirShape) {
  TriMesh mesh = surfaces::sphere({1, 2, 3}, 0.5, 0.07);
  append(pool_with_bumps(), mesh);
  const SurfaceComponents components = surface_components(surface_graph(mesh));
  ASSERT_EQ(components.list.size(), 2u);
  EXPECT_TRUE(components.list[0].closed);
  EXPECT_LT((components.list[0].centre - Eigen::Vector3d(1, 2, 3)).norm(), 0.01);
  EXPECT_FALSE(components.list[1].closed);
  EXPECT_NEAR(components.list[1].upward, 4, 1e-9);  // the shadow of the pool
}

InjectedOptions calm_tank() {
  InjectedOptions options;
  options.tank = true;
  options.bumps = 2;
  options.rings = options.drops = options.crossings = 0;
  options.frames = 20;
  return options;
}

// The edges of a tank bend more than any wave. Its walls are seen, but for the free surface.
TEST(Segmentation, WallsOfAClosedTankAreInferredAndMasked) {
  const InjectedSequence tank(calm_tank());
  const SegmentationOptions options;
  const Segmenter segmenter(tank, options);
  ASSERT_EQ(segmenter.walls().tanks.size(), 1u);
  for (const bool side : segmenter.walls().tanks[0].side) EXPECT_TRUE(side);
  for (const int f : {0, 10}) {
    const SurfaceFrame frame = tank.frame(f);
    EXPECT_TRUE(boundary_edges(frame.mesh.F).empty());
    EXPECT_EQ(segmenter.segment(frame, f).regions.size(), f == 0 ? 0u : 2u);
  }
  SegmentationOptions blind = options;
  blind.mask.infer_walls = false;
  EXPECT_FALSE(Segmenter(tank, blind).segment(tank.frame(0), 0).regions.empty());
}

TEST(Segmentation, AnOpenHeightFieldHasNoWalls) {
  const Segmenter segmenter(still(pool_with_bumps()), {});
  for (const bool side : segmenter.walls().tanks[0].side) EXPECT_FALSE(side);
}

TEST(Segmentation, SolidsAndContainersCanBeGiven) {
  SegmentationOptions options = given(0.12, 0.04);
  options.mask.solids = {{{0.3, -0.2, -0.1}, {0.7, 0.2, 0.2}}};
  SegmentedFrame frame = segmented(pool_with_bumps(), options);
  ASSERT_EQ(frame.regions.size(), 1u);
  EXPECT_LT(frame.regions[0].centre.x(), 0);
  // A tank whose side passes through the other bump.
  options.mask.containers = {{{-0.5, -1, -1}, {1, 1, 1}}};
  options.mask.band = 12;
  EXPECT_TRUE(segmented(pool_with_bumps(), options).regions.empty());
}

TEST(Segmentation, ThresholdsRestOnTheMedianAndMadOfTheCalmFrames) {
  // 1 ... 101 thousandths: median 51, MAD 25; a stormy frame does not count.
  std::vector<float> calm, stormy(500, 0.5F);
  for (int i = 1; i <= 101; ++i) calm.push_back(5e-4F * static_cast<float>(i));
  std::vector<std::string> warnings;
  const std::vector<std::vector<float>> frames{calm, stormy};
  const Thresholds t = automatic_thresholds(frames, 1e-4, {}, warnings);
  EXPECT_NEAR(t.low, 5e-4 * (51 + 6 * 25), 1e-6);
  EXPECT_NEAR(t.high, 3 * t.low, 1e-12);
  EXPECT_TRUE(warnings.empty());
}

TEST(Segmentation, WithoutACalmFrameTwoClassesAreSplitAndReported) {
  std::vector<float> s(700, 0.03F);
  s.resize(1000, 0.6F);
  std::vector<std::string> warnings;
  const std::vector<std::vector<float>> frames{s};
  const Thresholds t = automatic_thresholds(frames, 1e-4, {}, warnings);
  EXPECT_GT(t.high, 0.03);
  EXPECT_LT(t.high, 0.6);
  EXPECT_TRUE(warns(warnings, "no frame is calm"));
}

TEST(Segmentation, EmptyFramesAreReportedAndAnEmptySequenceIsAnError) {
  const TriMesh mesh = pool_with_bumps();
  const Segmenter segmenter(still(mesh), {});
  const SegmentedFrame empty = segmenter.segment({}, 3);
  EXPECT_TRUE(empty.regions.empty());
  EXPECT_TRUE(warns(empty.warnings, "empty"));
  EXPECT_THROW(Segmenter(still(TriMesh{}), {}), Error);
}

TEST(Segmentation, IsTheSameForOneThreadAndTwo) {
  const InjectedSequence sequence{InjectedOptions{}};
  SegmentedFrame one, two;
  const Segmenter segmenter(sequence, {});
  const SurfaceFrame frame = sequence.frame(20);
  with_threads(1, [&] { one = segmenter.segment(frame, 20); });
  with_threads(2, [&] { two = segmenter.segment(frame, 20); });
  EXPECT_TRUE(one.curvature == two.curvature);
  EXPECT_EQ(one.label, two.label);
}

}  // namespace
}  // namespace geoprior::fluid
