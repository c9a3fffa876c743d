#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "experiments/details/drawing/detail_drawing.h"
#include "experiments/details/drawing/surface_rays.h"
#include "models/details/process.h"
#include "tests/core/geometry/shapes.h"
#include "tests/details/detail_scenes.h"
#include "tests/details/experiments/drawing_checks.h"

namespace geoprior::details {
namespace {

using namespace drawing_checks;

std::vector<DrawnAnchor> random_anchors(const TriMesh& mesh, int count) {
  RandomStream random(7, "drawing");
  std::vector<DrawnAnchor> anchors;
  for (const Detail& d : detail_scenes::random_details(mesh, count, 3)) {
    DrawnAnchor anchor;
    anchor.at = d.at;
    anchor.weight = random.uniform();
    anchor.tangent = {random.normal(), random.normal(), random.normal()};
    anchors.push_back(anchor);
  }
  return anchors;
}

DrawingOptions in_metres(DrawnKind kind, double radius) {
  DrawingOptions options;
  options.kind = kind;
  options.unit = DrawnUnit::metre;
  options.radius = radius;
  return options;
}

/// On a sphere a straight path of length s is an arc of a great circle. Here the curvature sits in
/// 16,386 vertices: a path that passes one turns against the arc by up to its angle defect, 8e-4,
/// to either side; about 60 of them on the longest path, at random: 8e-4 sqrt(60) = 0.006 of its
/// length.
TEST(SurfaceRays, RunAlongGreatCircles) {
  const TriMesh sphere = shapes::sphere(6);
  const SurfaceTopology topology(sphere);
  const auto x = points_of(sphere);
  SurfaceRays rays(topology, x);
  const std::array<double, 3> distance{0.1, 0.5, 1.5};
  std::array<Eigen::Vector3d, 3> points;
  double worst = 0;
  for (const DrawnAnchor& anchor : random_anchors(sphere, 50)) {
    rays.start(anchor.at, anchor.tangent);
    const Eigen::Vector3d p = rays.origin().normalized(), t = rays.tangent();
    const Eigen::Vector3d left = p.cross(t);
    for (const double angle : {0.0, 1.0, 3.0}) {
      rays.trace({std::cos(angle), std::sin(angle)}, distance, points);
      Eigen::Vector3d u = std::cos(angle) * t + std::sin(angle) * left;
      u = (u - p * p.dot(u)).normalized();
      for (std::size_t i = 0; i < 3; ++i) {
        const Eigen::Vector3d expected = std::cos(distance[i]) * p + std::sin(distance[i]) * u;
        worst = std::max(worst, (points[i] - expected).norm() / distance[i]);
      }
    }
  }
  EXPECT_LT(worst, 0.006);
}

TEST(SurfaceRays, AreStraightInThePlaneAndEndAtTheBorder) {
  const TriMesh square = shapes::square(17);
  const SurfaceTopology topology(square);
  const auto x = points_of(square);
  SurfaceRays rays(topology, x);
  // Vertex 7 of row 3: rays leave from a corner, along edges too.
  const SurfacePoint corner{topology.corners_of(3 * 18 + 7)[0] / 3, {0, 0, 1}};
  for (const SurfacePoint& at : {SurfacePoint{250, {0.2, 0.3, 0.5}}, corner}) {
    rays.start(at, Eigen::Vector3d::UnitX());
    const Eigen::Vector3d p = position_of(at, square.V, square.F);
    for (int k = 0; k < 16; ++k) {
      const double angle = std::numbers::pi * k / 8;
      const Eigen::Vector2d u(std::cos(angle), std::sin(angle));
      const std::array<double, 2> distance{0.1, 5};
      std::array<Eigen::Vector3d, 2> points;
      rays.trace(u, distance, points);
      EXPECT_LT((points[0] - p - 0.1 * Eigen::Vector3d(u.x(), u.y(), 0)).norm(), 1e-6);
      // 0 or 1 is reached first along the direction that runs out first.
      double reach = 5;
      for (int c = 0; c < 2; ++c)
        if (std::abs(u[c]) > 1e-9) reach = std::min(reach, ((u[c] > 0 ? 1 : 0) - p[c]) / u[c]);
      EXPECT_LT((points[1] - p - reach * Eigen::Vector3d(u.x(), u.y(), 0)).norm(), 1e-5);
    }
  }
}

TEST(Spikes, AreClosedAndStandOutwards) {
  const TriMesh sphere = shapes::sphere(4);
  const auto anchors = random_anchors(sphere, 60);
  for (const SpikeProfile profile : {SpikeProfile::cone, SpikeProfile::dome, SpikeProfile::thorn}) {
    DrawingOptions options = in_metres(DrawnKind::spike, 0.1);
    options.spike.profile = profile;
    options.spike.height = 0.3;
    const DrawnDetails drawn = draw_details(sphere, anchors, options, 0);
    EXPECT_TRUE(manifold(drawn.mesh));
    EXPECT_TRUE(boundary_edges(drawn.mesh.F).empty());
    EXPECT_EQ(euler(drawn.mesh), 2 * 60);  // a sphere each
    EXPECT_GT(signed_volume(drawn.mesh.V, drawn.mesh.F), 0);
    EXPECT_LT((drawn.normals.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-9);
  }
}

/// On a plane a cone of weight w has volume pi (w r)^2 (w h) / 3, times sin(2 pi / n) n / (2 pi)
/// for n sectors; its continuation below the plane is left out by cutting at z = 0: heights above.
TEST(Spikes, HaveTheRadiusAndHeightOfTheirWeight) {
  const TriMesh square = shapes::square(6);
  DrawnAnchor anchor;
  anchor.at = {30, {0.3, 0.3, 0.4}};
  anchor.weight = 0.5;
  DrawingOptions options = in_metres(DrawnKind::spike, 0.08);
  options.spike.height = 0.2;
  const auto widest_at_surface = [&](const DrawnDetails& drawn) {
    const Eigen::Vector3d centre = position_of(anchor.at, square.V, square.F);
    double widest = 0;
    for (Eigen::Index v = 0; v < drawn.mesh.V.rows(); ++v)
      if (std::abs(drawn.mesh.V(v, 2)) < 1e-12)
        widest = std::max(widest, (drawn.mesh.V.row(v).transpose() - centre).norm());
    return widest;
  };
  DrawnDetails drawn = draw_details(square, std::vector{anchor}, options, 0);
  EXPECT_NEAR(drawn.mesh.V.col(2).maxCoeff(), 0.1, 1e-12);
  EXPECT_NEAR(widest_at_surface(drawn), 0.04, 1e-8);
  EXPECT_NEAR(drawn.mesh.V.col(2).minCoeff(), -0.008, 1e-12);
  options.spike.weight_scales = WeightScales::height;
  drawn = draw_details(square, std::vector{anchor}, options, 0);
  EXPECT_NEAR(drawn.mesh.V.col(2).maxCoeff(), 0.1, 1e-12);
  EXPECT_NEAR(widest_at_surface(drawn), 0.08, 1e-8);
}

/// The foot of a spike lies on the surface: on a sphere of 64 x 64 facets its second ring from
/// below is as far from the centre as the facets are (between cos of half an edge and 1).
TEST(Spikes, StandOnACurvedSurface) {
  const TriMesh sphere = shapes::sphere(6);
  const auto anchors = random_anchors(sphere, 40);
  DrawingOptions options = in_metres(DrawnKind::spike, 0.3);
  const DrawnDetails drawn = draw_details(sphere, anchors, options, 0);
  const Eigen::Index per_spike = kSpikeSectors * (kSpikeRings + 1) + 2;
  ASSERT_EQ(drawn.mesh.V.rows(), 40 * per_spike);
  for (Eigen::Index spike = 0; spike < 40; ++spike) {
    for (Eigen::Index k = 0; k < kSpikeSectors; ++k) {
      EXPECT_NEAR(
          drawn.mesh.V.row(spike * per_spike + kSpikeSectors * (kSpikeRings - 1) + k).norm(), 1,
          2.4e-4);
      EXPECT_LT(drawn.mesh.V.row(spike * per_spike + kSpikeSectors * kSpikeRings + k).norm(), 1);
    }
  }
}

TEST(Spikes, ThornsLeanAlongTheTangent) {
  const TriMesh square = shapes::square(6);
  DrawnAnchor anchor;
  anchor.at = {30, {0.3, 0.3, 0.4}};
  anchor.tangent = {0, 2, 0};
  DrawingOptions options = in_metres(DrawnKind::spike, 0.05);
  options.spike.profile = SpikeProfile::thorn;
  options.spike.height = 0.2;
  options.spike.lean = 0.5;
  const DrawnDetails drawn = draw_details(square, std::vector{anchor}, options, 0);
  Eigen::Index tip = 0;
  drawn.mesh.V.col(2).maxCoeff(&tip);
  const Eigen::Vector3d expected =
      position_of(anchor.at, square.V, square.F) + Eigen::Vector3d(0, 0.1, 0.2);
  EXPECT_LT((drawn.mesh.V.row(tip).transpose() - expected).norm(), 1e-6);
}

TEST(Instances, ArePlacedByNormalTangentAndWeight) {
  const TriMesh square = shapes::square(4);
  DrawnAnchor anchor;
  anchor.at = {10, {0.2, 0.3, 0.5}};
  anchor.tangent = {0, 1, 0.3};  // projected: +y
  anchor.weight = 0.25;
  DrawingOptions options = in_metres(DrawnKind::mesh, 0.2);
  options.instance.shape = InstanceShape::given;
  options.instance.sink = 0.1;
  const DrawnDetails drawn =
      draw_details(square, std::vector{anchor}, options, 0, shapes::tetrahedron());
  // Corners 0, x, y, z become 0, +y, -x, +z, times 0.05, sunk by 0.1 x 0.05.
  const Eigen::Vector3d at = position_of(anchor.at, square.V, square.F);
  Eigen::MatrixX3d expected(4, 3);
  expected << 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0, 1;
  for (Eigen::Index v = 0; v < 4; ++v) {
    const Eigen::Vector3d p =
        at + 0.05 * (expected.row(v).transpose() - Eigen::Vector3d(0, 0, 0.1));
    EXPECT_LT((drawn.mesh.V.row(v).transpose() - p).norm(), 1e-12);
  }
  EXPECT_EQ(drawn.mesh.F, shapes::tetrahedron().F);
}

TEST(Instances, ShapesOfOurOwnAreClosed) {
  for (const InstanceShape shape : {InstanceShape::plate, InstanceShape::knob}) {
    const TriMesh mesh = instance_mesh(shape);
    EXPECT_TRUE(manifold(mesh));
    EXPECT_TRUE(boundary_edges(mesh.F).empty());
    EXPECT_EQ(euler(mesh), 2);
    EXPECT_GT(signed_volume(mesh.V, mesh.F), 0);
  }
  // Half a ball: 2 pi / 3 for ever more facets.
  const TriMesh knob = instance_mesh(InstanceShape::knob);
  EXPECT_NEAR(signed_volume(knob.V, knob.F), 2 * std::numbers::pi / 3, 0.2);
}

TEST(Drawing, LeavesOutOtherTypesAndWeightZero) {
  const TriMesh sphere = shapes::sphere(3);
  auto anchors = random_anchors(sphere, 10);
  for (std::size_t i = 0; i < anchors.size(); ++i) anchors[i].type = static_cast<int>(i % 2);
  anchors[0].weight = 0;
  DrawingOptions options = in_metres(DrawnKind::spike, 0.1);
  options.type = 0;
  const DrawnDetails drawn = draw_details(sphere, anchors, options, 0);
  const std::set<int> seen(drawn.detail.begin(), drawn.detail.end());
  EXPECT_EQ(seen, (std::set<int>{2, 4, 6, 8}));
}

TEST(Drawing, LengthsAreInMeanEdges) {
  const TriMesh sphere = shapes::sphere(3);
  const auto anchors = random_anchors(sphere, 10);
  DrawingOptions metres = in_metres(DrawnKind::mesh, 0.1), edges = metres;
  edges.unit = DrawnUnit::mean_edge;
  edges.radius = 0.5;
  EXPECT_EQ(draw_details(sphere, anchors, metres, 0).mesh.V,
            draw_details(sphere, anchors, edges, 0.2).mesh.V);
}

/// The part of a recorded frame, as pictures and exports get it.
TEST(Drawing, AddsAPartToARecordedFrame) {
  const TriMesh sphere = shapes::sphere(3);
  auto details = detail_scenes::even_details(sphere, 40, 1);
  details[3].weight = 0.5;
  Frame frame = detail_frame(build_detail_mesh(sphere, details), 0);
  DrawingOptions options;
  for (const auto& [kind, name] : {std::pair(DrawnKind::spike, "spikes"),
                                   {DrawnKind::mesh, "instances"},
                                   {DrawnKind::hole, "holes"}}) {
    options.kind = kind;
    EXPECT_EQ(add_drawing(frame, options, frame.diagnostics["mean_edge"]), name);
    const Part& part = frame.require_part(name);
    ASSERT_EQ(part.arrays.size(), 4u);
    EXPECT_EQ(part.arrays[0].name, "detail");
    EXPECT_EQ(part.arrays[0].values.maxCoeff(), 39);
    for (Eigen::Index v = 0; v < part.points.rows(); ++v) {
      const double i = part.arrays[0].values(v, 0);
      ASSERT_EQ(part.arrays[1].values(v, 0), i < 0 ? 0.0 : i == 3 ? 0.5 : 1.0);
    }
    for (const NamedArray& array : part.arrays) EXPECT_EQ(array.values.rows(), part.points.rows());
  }
}

TEST(Drawing, IsTheSameForAnyThreadCount) {
  const TriMesh sphere = shapes::sphere(5);
  const auto anchors = random_anchors(sphere, 1000);
  for (const DrawnKind kind : {DrawnKind::spike, DrawnKind::mesh}) {
    const DrawingOptions options = in_metres(kind, 0.03);
    DrawnDetails one, two;
    with_threads(1, [&] { one = draw_details(sphere, anchors, options, 0); });
    with_threads(2, [&] { two = draw_details(sphere, anchors, options, 0); });
    EXPECT_EQ(one.mesh.V, two.mesh.V);
    EXPECT_EQ(one.mesh.F, two.mesh.F);
    EXPECT_EQ(one.normals, two.normals);
  }
}

std::string message(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Drawing, NamesWhatIsWrong) {
  const TriMesh sphere = shapes::sphere(2);
  auto anchors = random_anchors(sphere, 5);
  const DrawingOptions spikes;
  const auto draw = [&](const DrawingOptions& options, double edge) {
    return message([&] { draw_details(sphere, anchors, options, edge); });
  };
  EXPECT_NE(draw(spikes, 0).find("mean edge"), std::string::npos);
  anchors[2].weight = std::nan("");
  EXPECT_NE(draw(spikes, 1).find("detail 2: weight"), std::string::npos);
  anchors[2].weight = 1;
  anchors[4].at.face = sphere.triangle_count();
  EXPECT_NE(draw(spikes, 1).find("detail 4: is off the surface"), std::string::npos);
  anchors[4].at.face = 0;
  DrawingOptions given = in_metres(DrawnKind::mesh, 1);
  given.instance.shape = InstanceShape::given;
  EXPECT_NE(draw(given, 1).find("no triangles"), std::string::npos);
  Frame empty;
  EXPECT_NE(message([&] { add_drawing(empty, spikes, 1); }).find("no part"), std::string::npos);
}

}  // namespace
}  // namespace geoprior::details
