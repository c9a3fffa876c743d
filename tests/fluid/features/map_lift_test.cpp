#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "solvers/fluid/lift/displacement_map.h"
#include "solvers/fluid/lift/displacement_map_sampler.h"
#include "solvers/fluid/paste/paste.h"
#include "tests/core/geometry/shapes.h"
#include "tests/fluid/features/map_waves.h"
#include "tests/fluid/paste/sculpt_fixture.h"

namespace geoprior::fluid {
namespace {

using namespace waves;

constexpr double kSize = 2;  // m

Labelled waves_in_tank(const Hill& h, int n, int frames = 7) {
  return labelled(tank(n, kSize, 1, 0.25), (n + 1) * (n + 1), hill(h), frames, 0.04, kSize / n);
}

/// Largest RMS over the frames of the pasted surface against the source, in cells.
double round_trip(const Labelled& source, const MapOptions& options = {}) {
  const Feature feature = source.lift(options);
  double worst = 0;
  for (int f = 0; f < source.sequence->frame_count(); ++f) {
    const SurfaceFrame frame = source.sequence->frame(f), bed = source.bed(f, options);
    const SurfaceFrame pasted = paste(bed, {identity(feature)}, bed.time, kUp, {});
    require_closed_manifold(pasted.mesh, "round trip", "tank");
    const auto& label = source.labels[f].label;
    worst = std::max(worst, rms_over_region(pasted.mesh.V, frame.mesh.V, label));
  }
  return worst / source.extraction.cell;
}

TEST(MapRaster, IsLinearOnTrianglesAndFillsTheRestWithin) {
  MapPatch patch;
  patch.uv = {{-0.4, -0.4}, {0.4, -0.4}, {0.4, 0.4}, {-0.4, 0.4}};
  for (const auto& p : patch.uv) {
    MapPatch::Value v = MapPatch::Value::Zero();
    v[0] = static_cast<float>(2 * p.x() - p.y());
    patch.value.push_back(v);
  }
  patch.triangles = {{0, 1, 2}, {0, 2, 3}};
  MapRaster raster = rasterise(patch, 20, 1.0);
  int covered = 0;
  for (int k = 0; k < 400; ++k) {
    const double u = (k % 20 + 0.5) / 20 - 0.5, v = (k / 20 + 0.5) / 20 - 0.5;
    const bool in = std::abs(u) <= 0.4 && std::abs(v) <= 0.4;
    const std::size_t i = k;
    ASSERT_EQ(raster.covered[i] == 1, in) << u << " " << v;
    if (!in) continue;
    ++covered;
    EXPECT_NEAR(raster.value[i][0], 2 * u - v, 1e-6);
  }
  EXPECT_EQ(covered, 256);  // 16 x 16 texel centres lie in the square: no seam along the diagonal
  fill_uncovered(raster);
  for (const auto& v : raster.value) {
    EXPECT_LE(std::abs(v[0]), 1.2F);  // averages never leave the range of what is known
  }
  EXPECT_GT(raster.value[19][0], 0.5F);  // lower right corner follows its neighbourhood
}

TEST(MapSampler, ReproducesQuadraticMapsAndTheirTimeCourse) {
  // Catmull-Rom interpolation reproduces quadratics, in space and in time.
  Feature feature;
  feature.resolution = 32;
  feature.extent = 2;
  for (int f = 0; f < 5; ++f) {
    feature.times.push_back(0.1 * f);
    MapFrame map;
    map.displacement.resize(32 * 32, 3);
    map.alpha = Eigen::VectorXf::Ones(32 * 32);
    for (int k = 0; k < 32 * 32; ++k) {
      const double u = ((k % 32 + 0.5) / 32 - 0.5) * 2, v = ((k / 32 + 0.5) / 32 - 0.5) * 2;
      const double t = 0.1 * f;
      map.displacement.row(k) << static_cast<float>(u * v), static_cast<float>(t * t),
          static_cast<float>(u * u - v);
    }
    feature.maps.push_back(map);
  }
  const DisplacementSampler sampler(feature, 0.23);
  for (const auto& [u, v] : {std::pair{0.1, 0.2}, {-0.333, 0.5}, {0.71, -0.48}}) {
    const auto value = sampler.at({u, v});
    EXPECT_NEAR(value[0], u * v, 1e-6);
    EXPECT_NEAR(value[1], 0.23 * 0.23, 1e-6);
    EXPECT_NEAR(value[2], u * u - v, 1e-6);
    EXPECT_NEAR(value[3], 1, 1e-6);
  }
  EXPECT_TRUE((sampler.at({1.2, 0}) == 0).all());
}

TEST(MapSampler, JacobianOfAStretchIsItsDeterminant) {
  // d = (a u, b v): det(I + grad d) = (1 + a)(1 + b).
  Feature feature;
  feature.resolution = 16;
  feature.extent = 1;
  feature.times = {0};
  MapFrame map;
  map.displacement = Eigen::MatrixX3f::Zero(256, 3);
  map.alpha = Eigen::VectorXf::Zero(256);
  for (int k = 0; k < 256; ++k) {
    const int i = k % 16, j = k / 16;
    map.displacement.row(k) << static_cast<float>(-0.5 * ((i + 0.5) / 16 - 0.5)),
        static_cast<float>(-0.2 * ((j + 0.5) / 16 - 0.5)), 0;
    map.alpha[k] = 1;
  }
  feature.maps = {map};
  // At the map's edge the map ends: only there the differences see 0.
  EXPECT_NEAR(DisplacementSampler(feature, 0).min_jacobian(1), 0.5 * 0.8, 0.05);
}

TEST(MapLift, RoundTripOfAHillIsFarBelowAQuarterCell) {
  // Acceptance: 0.25 cells. What is left is the sampling of the map (texels of h/2) and of its
  // border.
  EXPECT_LT(round_trip(waves_in_tank({}, 60)), 0.02);
  EXPECT_LT(round_trip(waves_in_tank({.velocity = {1, 0.3}}, 60)), 0.02);
}

TEST(MapLift, RoundTripKeepsAnOverhang) {
  const Hill breaker{.throw_forward = 0.25, .velocity = {1, 0}};
  const Labelled source = waves_in_tank(breaker, 80, 4);
  // It does overhang: normals of the surface point down somewhere.
  const TriMesh mesh = source.sequence->frame(0).mesh;
  const Eigen::MatrixX3d normals = triangle_normals(mesh);
  int overhanging = 0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    overhanging += mesh.V(mesh.F(t, 0), 2) > 0.02 && normals(t, 2) < -0.1 ? 1 : 0;
  }
  EXPECT_GT(overhanging, 10);
  EXPECT_LT(round_trip(source), 0.1);
}

TEST(MapLift, HeightsAloneLoseAnOverhang) {
  const Labelled source = waves_in_tank({.throw_forward = 0.25}, 80, 3);
  MapOptions heights;
  heights.vector_map = false;
  EXPECT_GT(round_trip(source, heights), 5 * round_trip(source));
}

TEST(MapLift, RoundTripConvergesWithTheTexel) {
  const Labelled source = waves_in_tank({.sigma = 0.1}, 60, 3);
  MapOptions coarse, fine;
  // Down to 0.01 cells, what the fall of alpha over the border takes.
  coarse.texel = 3;
  fine.texel = 1;
  coarse.min_resolution = fine.min_resolution = 8;
  EXPECT_LT(3 * round_trip(source, fine), round_trip(source, coarse));
}

TEST(MapLift, FrameFollowsTheFeature) {
  const Labelled source = waves_in_tank({.centre = {0.8, 0.9}, .velocity = {1, 0.5}}, 50, 9);
  const Feature feature = source.lift();
  ASSERT_EQ(feature.frame_count(), 9);
  for (std::size_t f = 0; f < 9; ++f) {
    const Eigen::Isometry3d& p = feature.placement[f];
    const double t = feature.times[f];
    // Labels are vertices: their middle jitters by a fraction of a cell (0.04 m), smoothed.
    EXPECT_NEAR(p.translation().x(), 0.8 + t, 0.01);
    EXPECT_NEAR(p.translation().y(), 0.9 + 0.5 * t, 0.01);
    // The label ends at three sigma, where the hill is still 1.1 mm high.
    EXPECT_NEAR(p.translation().z(), 0, 1.2e-3);
    EXPECT_GT(p.linear().col(2).z(), 1 - 1e-5);
    EXPECT_GT(p.linear().col(0).dot(Eigen::Vector3d(1, 0.5, 0).normalized()), 0.99);
    EXPECT_LT((p.linear().transpose() * p.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  }
}

TEST(MapLift, FillsGapsOfTheTrack) {
  Labelled source = waves_in_tank({.velocity = {1, 0}}, 50, 7);
  const Feature whole = source.lift();
  source.extraction.tracking.tracks[0].regions = {0, 1, 2, 4, 5, 6};
  const Feature filled = source.lift();
  ASSERT_EQ(filled.frame_count(), 7);
  ASSERT_EQ(filled.maps.size(), 7U);
  const SurfaceFrame bed = source.bed(3);
  const auto at = [&](const Feature& f) {
    return Eigen::MatrixX3d(
        paste(bed, {identity(f)}, bed.time, kUp, {}).mesh.V.topRows(bed.mesh.V.rows()));
  };
  // The hill moves 0.04 m a frame without changing: the interpolated frame is the true one but for
  // the jitter of the labels.
  const Eigen::MatrixX3d a = at(whole), b = at(filled);
  EXPECT_LT(largest_distance(a, b), 0.25 * source.extraction.cell);
}

TEST(MapLift, IsTheSameForAnyNumberOfThreads) {
  const Labelled source = waves_in_tank({.velocity = {1, 0}}, 40, 4);
  Feature one, two;
  with_threads(1, [&] { one = source.lift(); });
  with_threads(2, [&] { two = source.lift(); });
  for (std::size_t f = 0; f < one.maps.size(); ++f) {
    EXPECT_EQ(one.maps[f].displacement, two.maps[f].displacement);
    EXPECT_EQ(one.maps[f].alpha, two.maps[f].alpha);
  }
}

TEST(MapLift, NamesTheFeaturesThatExist) {
  const Labelled source = waves_in_tank({}, 20, 2);
  RunContext context;
  try {
    lift_tracks(*source.sequence, source.extraction, source.labeller(), {}, {7}, context);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("feature 7"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("allowed: 1"), std::string::npos) << error.what();
  }
}

TEST(MapLift, RefusesAFeatureThatCoversItsComponent) {
  Labelled source;
  SurfaceFrame frame;
  frame.mesh = shapes::sphere(2);
  FrameLabels labels;
  labels.label.assign(frame.mesh.vertex_count(), 1);
  source.sequence = std::make_shared<StoredSequence>(std::vector<SurfaceFrame>{frame}, "ball");
  source.labels = {labels};
  Region region;
  region.label = 1;
  source.extraction.regions = {region};
  source.extraction.times = {0};
  source.extraction.cell = 0.1;
  source.extraction.tracking.tracks = {{1, RegionKind::differential, {0}}};
  EXPECT_THROW(source.lift(), Error);
}

TEST(MapLift, DropsComeOutWhole) {
  // A sphere on a parabola: least-squares parabolas meet it, so meshes relative to the frames are
  // the sphere about its centre.
  const double g = 9.81;
  Labelled source;
  std::vector<SurfaceFrame> frames;
  source.extraction.cell = 0.1;
  Track track{1, RegionKind::isolated, {}};
  for (int f = 0; f < 8; ++f) {
    const double t = 0.04 * f;
    const Eigen::Vector3d centre(t, 0, 2 - 0.5 * g * t * t);
    SurfaceFrame frame;
    frame.time = t;
    frame.mesh = shapes::sphere(2);
    frame.mesh.V = (0.1 * frame.mesh.V).rowwise() + centre.transpose();
    FrameLabels labels;
    labels.label.assign(frame.mesh.vertex_count(), 1);
    Region region;
    region.frame = f;
    region.label = 1;
    region.kind = RegionKind::isolated;
    region.centre = centre;
    source.extraction.regions.push_back(region);
    source.extraction.times.push_back(t);
    track.regions.push_back(f);
    source.labels.push_back(labels);
    frames.push_back(frame);
  }
  source.extraction.tracking.tracks = {track};
  source.sequence = std::make_shared<StoredSequence>(frames, "drop");
  const Feature drop = source.lift();
  ASSERT_EQ(drop.meshes.size(), 8U);
  for (const TriMesh& mesh : drop.meshes) {
    EXPECT_NEAR(mesh.V.rowwise().norm().maxCoeff(), 0.1, 1e-12);
    EXPECT_NEAR(mesh.V.rowwise().norm().minCoeff(), 0.1, 1e-12);
  }
  // Taken out of its animation nothing is left.
  EXPECT_EQ(without_regions(frames[0], source.labels[0], {source.extraction.regions[0]}, 0.3)
                .mesh.triangle_count(),
            0);
}

TEST(MapLift, CutsAWaveOutOfAFrameThatItsTrackMisses) {
  // The hill of frame 8, 0.14 m high, is cut out with its region and, its region forgotten, with
  // those of frames 7 and 9, which are 0.01 m lower and higher: the same bed but for their rims.
  const auto sequence = sculpt_fixture::splash();
  RunContext context;
  const ExtractionOptions options;
  Extraction extraction = extract_regions(*sequence, options, context);
  const auto hill =
      std::find_if(extraction.tracking.tracks.begin(), extraction.tracking.tracks.end(),
                   [](const Track& track) { return track.kind == RegionKind::differential; });
  ASSERT_NE(hill, extraction.tracking.tracks.end());
  const SurfaceFrame frame = sequence->frame(8);
  const TriMesh known = without_feature(frame, 8, extraction, options, {hill->id}).mesh;
  ASSERT_EQ(std::erase_if(hill->regions, [&](int r) { return extraction.regions[r].frame == 8; }),
            1U);
  const TriMesh missed = without_feature(frame, 8, extraction, options, {hill->id}).mesh;
  EXPECT_GT((frame.mesh.V - known.V).rowwise().norm().maxCoeff(), 0.1);
  EXPECT_LT((missed.V - known.V).rowwise().norm().maxCoeff(), 0.01);
  // Before its first frame there is nothing to cut.
  EXPECT_EQ(without_feature(sequence->frame(1), 1, extraction, options, {hill->id}).mesh.V,
            sequence->frame(1).mesh.V);
}

}  // namespace
}  // namespace geoprior::fluid
