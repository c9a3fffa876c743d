// Which borders meet, face each other across a panel, and are each other's mirror image.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "solvers/sketch/drawing/curve_net.h"
#include "solvers/sketch/drawing/dense_matches.h"
#include "solvers/sketch/drawing/symmetric_pairs.h"
#include "solvers/sketch/surface/ruled_patches.h"

namespace geoprior::sketch {
namespace {

Stroke line(const std::string& id, StrokeKind kind, const std::string& panels, Eigen::Vector2d a,
            Eigen::Vector2d b) {
  constexpr int kPoints = 20;
  Stroke stroke;
  stroke.id = id;
  stroke.kind = kind;
  stroke.name = panels;
  for (int k = 0; k <= kPoints; ++k) stroke.points.emplace_back(a + (b - a) * k / kPoints);
  return stroke;
}

Stroke pair(const std::string& id, const std::string& panels, Eigen::Vector2d a,
            Eigen::Vector2d b) {
  Stroke stroke;
  stroke.id = id;
  stroke.kind = StrokeKind::symmetric_pair;
  stroke.panels = panels;
  stroke.points = {a, b};
  return stroke;
}

View view_of(std::vector<Stroke> strokes) {
  View view;
  view.kind = ViewKind::photo;
  view.strokes = std::move(strokes);
  return view;
}

// The nearest border of the first end is number 1, which the second end needs.
TEST(TwoBorders, HaveTheLeastSumOfDistances) {
  EXPECT_EQ(two_borders({0.009, 0.005}, {0.03, 0.003}, 0.04), (std::array<int, 2>{0, 1}));
  EXPECT_EQ(two_borders({0.009, 0.005}, {0.5, 0.003}, 0.04), (std::array<int, 2>{0, 1}));
  // Without two borders: one for both ends, or none for an end.
  EXPECT_EQ(two_borders({0.5, 0.005}, {0.5, 0.003}, 0.04), (std::array<int, 2>{1, 1}));
  EXPECT_EQ(two_borders({0.5, 0.005}, {0.5, 0.5}, 0.04), (std::array<int, 2>{1, -1}));
  EXPECT_EQ(two_borders({}, {}, 0.04), (std::array<int, 2>{-1, -1}));
}

int curves_with(const CurveNet& net, int node) {
  int count = 0;
  for (const SketchCurve& curve : net.curves)
    for (const int other : curve.nodes) count += other == node ? 1 : 0;
  return count;
}

// The lower end of the post lies near the sill. A ruling says that they are two sides of a panel:
// the post then merely ends in front of the sill, unless it touches it, as the tip of a visor.
TEST(CurveNetJoints, SidesOfOnePanelStayApart) {
  std::vector<Stroke> strokes{
      line("sill", StrokeKind::border, "wall", {0, 0}, {1, 0}),
      line("post", StrokeKind::border, "wall", {0.5, 0.01}, {0.9, 1}),
  };
  const CurveNet joined = build_curve_net(view_of(strokes), {});
  EXPECT_EQ(curves_with(joined, joined.curves[1].nodes.front()), 2);
  strokes.push_back(line("ruling", StrokeKind::ruling, "wall", {0.9, 0}, {0.85, 0.875}));
  const CurveNet apart = build_curve_net(view_of(strokes), {});
  EXPECT_EQ(curves_with(apart, apart.curves[1].nodes.front()), 1);
  strokes[1].points.front().y() = 0.001;
  const CurveNet touching = build_curve_net(view_of(strokes), {});
  EXPECT_EQ(curves_with(touching, touching.curves[1].nodes.front()), 2);
}

// A strap 0.06 wide whose two edges are each other's image; of the third pair both ends were drawn
// nearer to the left edge.
TEST(SymmetricPairs, JoinTheBordersThatOthersJoin) {
  const MirrorPlane plane{Eigen::Vector3d(0.8, 0, 0.6), 0};
  std::vector<Stroke> strokes{
      line("left", StrokeKind::border, "strap", {0, 0}, {0, 1}),
      line("right", StrokeKind::border, "strap", {0.06, 0}, {0.06, 1}),
      pair("low", "strap", {0, 0.2}, {0.06, 0.2}),
      pair("high", "strap", {0, 0.8}, {0.06, 0.8}),
      pair("narrow", "strap", {0.005, 0.5}, {0.026, 0.5}),
  };
  const auto ends = [&] {
    const View view = view_of(strokes);
    const CurveNet net = build_curve_net(view, {});
    const SymmetricPair last = read_symmetric_pairs(view, net, plane, 0.3).back();
    return std::array<int, 2>{last.point_at.front().curve, last.image_at.front().curve};
  };
  EXPECT_EQ(ends(), (std::array<int, 2>{0, 1}));
  // A point of the plane says that the left edge is its own image.
  strokes.insert(strokes.begin() + 2, pair("tick", "strap", {0, 0.35}, {0.0002, 0.35}));
  EXPECT_EQ(ends(), (std::array<int, 2>{0, 0}));
  // One other pair is no majority.
  strokes.erase(strokes.begin() + 2, strokes.begin() + 4);
  EXPECT_EQ(ends(), (std::array<int, 2>{0, 0}));
}

// An arch on a sill that runs along the normal's image and trembles: slopes of the sill are noise.
TEST(DenseMatches, LeaveOutWhatRunsAlongTheNormal) {
  const MirrorPlane plane{Eigen::Vector3d(0.8, 0, 0.6), 0};
  Stroke arch = line("arch", StrokeKind::border, "door", {-1, 0}, {1, 0});
  for (Eigen::Vector2d& p : arch.points) p.y() = 1 - p.x() * p.x();
  Stroke sill = line("sill", StrokeKind::border, "door", {-1, 0}, {1, 0});
  for (std::size_t k = 1; k + 1 < sill.points.size(); ++k)
    sill.points[k].y() = (k / 2) % 2 == 0 ? 0.022 : -0.022;
  const View view = view_of({arch, sill, pair("feet", "door", {-1, 0}, {1, 0}),
                             pair("top", "door", {-0.001, 1}, {0.001, 1})});
  const CurveNet net = build_curve_net(view, {});
  const auto matches = dense_matches(net, read_symmetric_pairs(view, net, plane, 0.3), plane, 1);
  EXPECT_GT(matches.size(), 10u);
  for (const DenseMatch& match : matches) EXPECT_EQ(match.image.curve, 0);
}

// The right border ends with a hook, drawn beyond the ruling: the two still run alike.
TEST(RuledPatches, KnowTheirSenseBesideAHook) {
  Stroke right = line("right", StrokeKind::border, "flap", {1, 0}, {1, 1});
  right.points.insert(right.points.end(), {{0.99, 0.985}, {0.985, 0.97}});
  const View view = view_of({line("left", StrokeKind::border, "flap", {0, 0}, {0, 1}), right,
                             line("crest", StrokeKind::silhouette, "flap", {0, 1}, {1, 0.99})});
  const CurveNet net = build_curve_net(view, {});
  const std::vector<RuledPatch> patches = sweep_ruled_patches(view, net, 3, {});
  ASSERT_EQ(patches.size(), 1u);
  EXPECT_EQ(patches.front().second_way, 1);
  EXPECT_GT(patches.front().rulings.size(), 20u);
}

// Borders that begin at a ruling and leave it to either side have no patch.
TEST(RuledPatches, OfBordersThatPartAreRefused) {
  const View view = view_of({line("left", StrokeKind::border, "flap", {0, 0}, {-1, 0}),
                             line("right", StrokeKind::border, "flap", {0, 1}, {1, 1}),
                             line("fold", StrokeKind::ruling, "flap", {0, 0}, {0, 1})});
  const CurveNet net = build_curve_net(view, {});
  EXPECT_THROW(sweep_ruled_patches(view, net, 3, {}), Error);
}

}  // namespace
}  // namespace geoprior::sketch
