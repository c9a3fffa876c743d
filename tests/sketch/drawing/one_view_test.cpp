#include "solvers/sketch/one_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "core/connectivity.h"
#include "core/geometry/topology.h"
#include "experiments/sketch/truth/synthetic_views.h"
#include "metrics/developability/developability.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// True place of a node: the stroke's, between the points that the node lies between.
Eigen::Vector3d true_place(const SyntheticView& drawing, const SketchCurve& curve, int i) {
  const std::vector<Eigen::Vector3d>& truth = drawing.truth[curve.stroke];
  const double at = curve.drawn_at[i];
  const auto low = static_cast<std::size_t>(at);
  const double t = at - std::floor(at);
  return (1 - t) * truth[low % truth.size()] + t * truth[(low + 1) % truth.size()];
}

/// RMS error of depth over all nodes of all borders, of the height. No alignment: z = 0 at the tail
/// of sym-a in both.
double depth_error(const SyntheticView& drawing, const OneViewResult& result) {
  double sum = 0;
  int count = 0;
  for (const SketchCurve& curve : result.net.curves) {
    for (int i = 0; i < curve.size(); ++i, ++count) {
      const double error =
          result.depth.nodes(curve.nodes[i], 2) - true_place(drawing, curve, i).z();
      sum += error * error;
    }
  }
  return std::sqrt(sum / count) / drawing.height;
}

/// The linear system alone, of what is drawn as it is drawn.
OneViewOptions linear_system() {
  OneViewOptions options;
  options.refine.reset();
  options.fair = false;
  options.complete = Completion::none;
  return options;
}

double depth_error(const SyntheticViewOptions& drawn,
                   const OneViewOptions& options = linear_system()) {
  const SyntheticView drawing = synthetic_view(drawn);
  return depth_error(drawing, reconstruct_one_view(drawing.view, options));
}

OneViewOptions without_developability() {
  OneViewOptions options = linear_system();
  options.depth.developability = 0;
  return options;
}

/// Drawn pairs alone: what is between them is not matched.
OneViewOptions unmatched() {
  OneViewOptions options = linear_system();
  options.depth.dense = 0;
  return options;
}

// Four pairs on the lower circle fix it; of the upper one a single point is known, and the rulings
// must carry depth across. Measured 1.4 % with and 25 % without them.
TEST(OneView, FrustumDepthComesFromDevelopability) {
  OneViewOptions without = unmatched();
  without.depth.developability = 0;
  EXPECT_LT(depth_error({}, unmatched()), 0.02);
  EXPECT_GT(depth_error({}, without), 0.09);
}

// That point makes the upper circle its own image all around: 0.4 % without rulings.
TEST(OneView, OnePointOfThePlaneMatchesAClosedBorder) {
  EXPECT_LT(depth_error({}, without_developability()), 0.006);
}

// Measured over these seeds: 0.5 to 1.1 %; without rulings as much, without matches 1.0 to 2.3 %.
TEST(OneView, FrustumDepthHoldsUnderDrawingNoise) {
  for (int seed = 1; seed <= 10; ++seed) {
    SyntheticViewOptions drawn;
    drawn.noise = 0.003;
    drawn.seed = seed;
    EXPECT_LT(depth_error(drawn), 0.013) << "seed " << seed;
    EXPECT_GT(depth_error(drawn, unmatched()), 1.2 * depth_error(drawn)) << "seed " << seed;
  }
}

// Over views in which the ellipses are open and the mirror plane is not seen edge on. Measured:
// means of ten seeds from 0.7 to 1.7 %, largest 2.9 % (pitch 20, yaw 35). A pair or a silhouette
// that is put onto the wrong place costs 7 % and more.
TEST(OneView, FrustumDepthHoldsInEveryGenericView) {
  for (const double pitch : {20.0, 30.0, 45.0}) {
    for (const double yaw : {35.0, 60.0, 80.0}) {
      for (int seed = 1; seed <= 10; ++seed) {
        SyntheticViewOptions drawn;
        drawn.pitch_deg = pitch;
        drawn.yaw_deg = yaw;
        drawn.noise = 0.003;
        drawn.seed = seed;
        EXPECT_LT(depth_error(drawn), 0.035)
            << "pitch " << pitch << ", yaw " << yaw << ", seed " << seed;
      }
    }
  }
}

TEST(OneView, CylinderDepth) {
  SyntheticViewOptions drawn;
  drawn.top_radius = drawn.radius;
  EXPECT_LT(depth_error(drawn), 0.01);
}

// Rulings must not spoil what pairs on both circles determine already.
TEST(OneView, DevelopabilityDoesNoHarmWherePairsSuffice) {
  for (int seed = 1; seed <= 5; ++seed) {
    SyntheticViewOptions drawn;
    drawn.upper_pairs = 4;
    drawn.noise = 0.003;
    drawn.seed = seed;
    EXPECT_LT(depth_error(drawn), 0.012) << "seed " << seed;
  }
}

// The thesis bounds cones by parallel planes. As a term it makes the frustum exact up to sampling.
TEST(OneView, ParallelPlanesAsATermDetermineTheFrustum) {
  OneViewOptions options = linear_system();
  options.depth.parallel_planes = 1;
  EXPECT_LT(depth_error({}, options), 0.0015);
}

SyntheticViewOptions tent() {
  SyntheticViewOptions drawn;
  drawn.shape = SyntheticShape::tent;
  return drawn;
}

/// Cuts the hidden part away from the lower circle and drops the stroke that marks it.
void keep_front_of_lower_circle(SyntheticView& drawing) {
  std::vector<Stroke>& strokes = drawing.view.strokes;
  const auto at = [&](const std::string& id) {
    return static_cast<std::size_t>(
        std::find_if(strokes.begin(), strokes.end(), [&](const Stroke& s) { return s.id == id; }) -
        strokes.begin());
  };
  const std::size_t circle = at("bottom"), back = at("bottom-back");
  const std::size_t n = strokes[circle].points.size();
  const auto nearest = [&](const Eigen::Vector3d& p) {
    const std::vector<Eigen::Vector3d>& all = drawing.truth[circle];
    return static_cast<std::size_t>(std::min_element(all.begin(), all.end(),
                                                     [&](const auto& a, const auto& b) {
                                                       return (a - p).norm() < (b - p).norm();
                                                     }) -
                                    all.begin());
  };
  const std::size_t from = nearest(drawing.truth[back].back());
  const std::size_t to = nearest(drawing.truth[back].front());
  std::vector<Eigen::Vector2d> points;
  std::vector<Eigen::Vector3d> truth;
  for (std::size_t k = from; k % n != to; ++k) {
    points.push_back(strokes[circle].points[k % n]);
    truth.push_back(drawing.truth[circle][k % n]);
  }
  strokes[circle].closed = false;
  strokes[circle].points = points;
  drawing.truth[circle] = truth;
  strokes.erase(strokes.begin() + back);
  drawing.truth.erase(drawing.truth.begin() + back);
}

// As in a photograph: the hidden part of the lower circle is not drawn. All pairs are on the upper
// one, which is seen whole, and one point of the mirror plane is marked on the front of the lower.
TEST(OneView, FrontOfTheLowerCircleIsEnough) {
  SyntheticViewOptions drawn;
  drawn.lower_pairs = 0;
  drawn.upper_pairs = 4;
  drawn.upper_point = false;
  SyntheticView drawing = synthetic_view(drawn);
  Stroke point;
  point.id = "bottom-plane-point";
  point.kind = StrokeKind::symmetric_pair;
  // Azimuth pi / 2, a quarter of the way around.
  point.points = {drawing.view.strokes.front().points[60]};
  keep_front_of_lower_circle(drawing);
  drawing.view.strokes.push_back(point);
  const OneViewResult result = reconstruct_one_view(drawing.view, linear_system());
  EXPECT_LT(depth_error(drawing, result), 0.02);
  ASSERT_EQ(result.rulings.size(), 1u);
  EXPECT_FALSE(result.rulings.front().around);
}

// Every corner of the tent is in a pair, and everything between is straight.
TEST(OneView, TentIsExact) {
  const SyntheticView drawing = synthetic_view(tent());
  const OneViewResult result = reconstruct_one_view(drawing.view, linear_system());
  EXPECT_LT(depth_error(drawing, result), 1e-5);
  EXPECT_EQ(result.patches.size(), 4u) << "two slopes, two gables";
  for (const OneViewPatch& patch : result.patches) EXPECT_TRUE(patch.flat) << patch.name;
}

// Without the pair of its front corners the tent has no other source of their depth than the planes
// of its slopes, each of which three other corners fix.
TEST(OneView, PlanePanelsCarryDepthToCornersWithoutPairs) {
  SyntheticView drawing = synthetic_view(tent());
  std::erase_if(drawing.view.strokes, [](const Stroke& s) { return s.id == "pair-front"; });
  // The pair is drawn after all borders, so that the truth of these keeps its numbers.
  EXPECT_LT(depth_error(drawing, reconstruct_one_view(drawing.view, linear_system())), 1e-3);
}

// Mirrored vertices coincide with vertices: the result is symmetric exactly, and welded.
TEST(OneView, SurfaceIsSymmetricAndWelded) {
  for (const SyntheticViewOptions& drawn : {SyntheticViewOptions{}, tent()}) {
    const SyntheticView drawing = synthetic_view(drawn);
    const OneViewResult result = reconstruct_one_view(drawing.view, linear_system());
    const TriMesh& mesh = result.surface.mesh;
    const auto half = mesh.F.rows() / 2;
    for (Eigen::Index t = 0; t < half; ++t) {
      const Eigen::Vector3d a = mesh.V.row(mesh.F(t, 0)).transpose();
      const Eigen::Vector3d b = mesh.V.row(mesh.F(half + t, 0)).transpose();
      EXPECT_LT((mirrored(result.planes.chosen, a) - b).norm(), 1e-12);
      EXPECT_FALSE(result.surface.mirror_image[t]);
      EXPECT_TRUE(result.surface.mirror_image[half + t]);
    }
    EXPECT_FALSE(EdgeConnectivity(mesh.F).first_repeated());
    EXPECT_TRUE(non_manifold_edges(mesh.F).empty());
  }
}

/// Number of closed loops of the border.
int border_loops(const TriMesh& mesh) {
  std::vector<int> next(static_cast<std::size_t>(mesh.vertex_count()), -1);
  for (const Edge& edge : boundary_edges(mesh.F)) next[edge[0]] = edge[1];
  int loops = 0;
  for (int v = 0; v < std::ssize(next); ++v) {
    if (next[v] < 0) continue;
    ++loops;
    int w = v;
    while (next[w] >= 0) w = std::exchange(next[w], -1);
  }
  return loops;
}

// A frustum is a band with two borders; a tent drawn with its gables lacks its floor only.
TEST(OneView, SurfaceHasTheBordersOfTheShape) {
  const OneViewResult frustum = reconstruct_one_view(synthetic_view({}).view, linear_system());
  EXPECT_EQ(border_loops(frustum.surface.mesh), 2);
  const OneViewResult house = reconstruct_one_view(synthetic_view(tent()).view, linear_system());
  EXPECT_EQ(border_loops(house.surface.mesh), 1);
}

// The area of a frustum is pi (r1 + r2) s; a strip of chords lies inside it.
TEST(OneView, FrustumHasItsArea) {
  const OneViewResult result = reconstruct_one_view(synthetic_view({}).view, linear_system());
  const double slant = std::hypot(1.5, 0.4);
  EXPECT_NEAR(triangle_areas(result.surface.mesh.V, result.surface.mesh.F).sum(),
              std::numbers::pi * 1.6 * slant, 0.02 * std::numbers::pi * 1.6 * slant);
}

// No interior vertex but those of cuts in the mirror plane: nothing to bend two ways.
TEST(OneView, RuledStripUnrollsWithEveryEdgeItsLength) {
  const OneViewResult result = reconstruct_one_view(synthetic_view({}).view, linear_system());
  ASSERT_EQ(result.patches.size(), 1u);
  const OneViewPatch& patch = result.patches.front();
  for (Eigen::Index t = 0; t < patch.strip.triangles.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int u = patch.strip.triangles(t, k), v = patch.strip.triangles(t, (k + 1) % 3);
      const double in_space = (result.depth.nodes.row(patch.strip.node[u]) -
                               result.depth.nodes.row(patch.strip.node[v]))
                                  .norm();
      EXPECT_NEAR((patch.unrolled.row(u) - patch.unrolled.row(v)).norm(), in_space, 1e-12);
    }
  }
}

// A cone of radius r and apex distance rho unrolls into a sector of 2 pi r / rho.
TEST(OneView, FrustumUnrollsIntoTheSectorOfItsCone) {
  const OneViewResult result = reconstruct_one_view(synthetic_view({}).view, linear_system());
  const OneViewPatch& patch = result.patches.front();
  const auto last = patch.unrolled.rows() - 1;
  const Eigen::RowVector2d from = patch.unrolled.row(1) - patch.unrolled.row(0);
  // The last ruling joins the last vertices of the two borders, made last.
  const bool last_is_second = patch.strip.node[last] == patch.strip.node[1];
  const Eigen::RowVector2d to =
      (patch.unrolled.row(last) - patch.unrolled.row(last - 1)) * (last_is_second ? 1 : -1);
  const double turn = std::acos(from.dot(to) / (from.norm() * to.norm()));
  const double rho = std::hypot(1.5, 0.4) / 0.4;
  EXPECT_NEAR(turn, 2 * std::numbers::pi / rho, 0.03);
}

TEST(OneView, HiddenHalfHasTheTextureOfTheVisibleOne) {
  SyntheticView drawing = synthetic_view({});
  drawing.view.picture = {.file = "photo.png", .content = {}, .origin = {-2, -2}, .size = {4, 5}};
  const OneViewResult result = reconstruct_one_view(drawing.view, linear_system());
  const TexturedSurface& surface = result.surface;
  const auto half = surface.mesh.F.rows() / 2;
  for (Eigen::Index t = 0; t < half; ++t) {
    const int source = surface.mesh.F(t, 0), image = surface.mesh.F(half + t, 0);
    EXPECT_EQ(surface.texture.row(source), surface.texture.row(image));
    const Eigen::RowVector2d drawn =
        surface.texture.row(source).cwiseProduct(Eigen::RowVector2d(4, 5)) -
        Eigen::RowVector2d(2, 2);
    EXPECT_LT((drawn - surface.mesh.V.row(source).head<2>()).norm(), 0.02);
  }
}

TEST(OneView, OtherReadingOfThePictureIsMirroredInDepth) {
  SyntheticView drawing = synthetic_view(tent());
  const OneViewResult one = reconstruct_one_view(drawing.view, linear_system());
  for (Stroke& stroke : drawing.view.strokes) {
    stroke.side = stroke.side == DepthSide::front ? DepthSide::back : DepthSide::front;
  }
  const OneViewResult other = reconstruct_one_view(drawing.view, linear_system());
  EXPECT_LT((one.planes.other.normal - other.planes.chosen.normal).norm(), 1e-12);
  EXPECT_LT((one.depth.nodes.col(2) + other.depth.nodes.col(2)).norm(), 1e-6);
}

TEST(OneView, IsTheSameInEveryUnit) {
  SyntheticView drawing = synthetic_view({});
  const OneViewResult one = reconstruct_one_view(drawing.view, linear_system());
  for (Stroke& stroke : drawing.view.strokes)
    for (Eigen::Vector2d& p : stroke.points) p *= 1000;
  const OneViewResult other = reconstruct_one_view(drawing.view, linear_system());
  EXPECT_LT((one.depth.nodes - other.depth.nodes / 1000).norm(), 1e-6);
  EXPECT_NEAR(one.depth.condition / other.depth.condition, 1, 1e-3);
}

/// What is said of a drawing after a change.
std::string refusal(const SyntheticViewOptions& drawn, const std::function<void(View&)>& change) {
  View view = synthetic_view(drawn).view;
  change(view);
  return test::error_of([&] { reconstruct_one_view(view, {}); });
}

Stroke& stroke_of(View& view, const std::string& id) {
  return *std::find_if(view.strokes.begin(), view.strokes.end(),
                       [&](const Stroke& s) { return s.id == id; });
}

TEST(OneViewBadInput, NoSymmetricPair) {
  EXPECT_THAT(refusal({},
                      [](View& view) {
                        std::erase_if(view.strokes, [](const Stroke& s) {
                          return s.kind == StrokeKind::symmetric_pair;
                        });
                      }),
              HasSubstr("no symmetric pair"));
}

TEST(OneViewBadInput, MirrorPlaneSeenEdgeOn) {
  EXPECT_THAT(refusal({},
                      [](View& view) {
                        stroke_of(view, "sym-b").points[1] = 2 * stroke_of(view, "sym-a").points[1];
                      }),
              AllOf(HasSubstr("edge on"), HasSubstr("sym-b")));
}

TEST(OneViewBadInput, VectorWithoutLength) {
  EXPECT_THAT(refusal({},
                      [](View& view) {
                        stroke_of(view, "sym-b").points[1] = {0, 0};
                      }),
              AllOf(HasSubstr("no length"), HasSubstr("sym-b")));
}

TEST(OneViewBadInput, PairAcrossTheNormal) {
  EXPECT_THAT(refusal({},
                      [](View& view) {
                        stroke_of(view, "bottom-pair-2").points[1] =
                            stroke_of(view, "bottom-pair-4").points[1];
                      }),
              AllOf(HasSubstr("contradicts the mirror plane"), HasSubstr("bottom-pair-2"),
                    HasSubstr("misses the normal by")));
}

// A pair led along the normal to another place of the circle: its order along the circle differs.
TEST(OneViewBadInput, PairsThatCross) {
  SyntheticViewOptions drawn;
  drawn.lower_pairs = 6;
  EXPECT_THAT(refusal(drawn,
                      [](View& view) {
                        Stroke& pair = stroke_of(view, "bottom-pair-3");
                        const Eigen::Vector2d start = pair.points[0], end = pair.points[1];
                        const Eigen::Vector2d along = (end - start).normalized();
                        const Eigen::Vector2d across(-along.y(), along.x());
                        double least = 1e9;
                        for (const Eigen::Vector2d& p : stroke_of(view, "bottom").points) {
                          const double off = std::abs(across.dot(p - start));
                          if ((p - start).norm() < 0.3 || (p - end).norm() < 0.3 || off >= least)
                            continue;
                          least = off;
                          pair.points[1] = p;
                        }
                      }),
              HasSubstr("symmetric pair"));
}

// A point of the tent has one partner only; a second one contradicts it.
TEST(OneViewBadInput, OnePointWithTwoPartners) {
  EXPECT_THAT(refusal(tent(),
                      [](View& view) {
                        Stroke second = stroke_of(view, "pair-back");
                        second.id = "pair-wrong";
                        second.points[1] = (second.points[0] + second.points[1]) / 2;
                        view.strokes.push_back(second);
                      }),
              AllOf(HasSubstr("two partners"), HasSubstr("pair-back"), HasSubstr("pair-wrong")));
}

TEST(OneViewBadInput, PairOfAPanelThatNoBorderHas) {
  EXPECT_THAT(refusal(tent(), [](View& view) { stroke_of(view, "pair-back").panels = "roof"; }),
              AllOf(HasSubstr("'roof'"), HasSubstr("pair-back")));
}

TEST(OneViewBadInput, NoVectorOfTheMirrorPlane) {
  EXPECT_THAT(refusal(tent(),
                      [](View& view) {
                        std::erase_if(view.strokes,
                                      [](const Stroke& s) { return s.name == "sym-b"; });
                      }),
              HasSubstr("sym-b"));
}

TEST(OneViewBadInput, RulingThatJoinsNoBorder) {
  EXPECT_THAT(
      refusal({}, [](View& view) { stroke_of(view, "left").points[1] += Eigen::Vector2d(-1, 1); }),
      AllOf(HasSubstr("joins no border"), HasSubstr("left")));
  EXPECT_THAT(refusal({},
                      [](View& view) {
                        Stroke& left = stroke_of(view, "left");
                        left.points[1] = stroke_of(view, "right").points[0];
                      }),
              AllOf(HasSubstr("two different borders"), HasSubstr("left")));
}

TEST(OneViewBadInput, BentRuling) {
  EXPECT_THAT(refusal({},
                      [](View& view) {
                        Stroke& left = stroke_of(view, "left");
                        left.points.insert(
                            left.points.begin() + 1,
                            (left.points[0] + left.points[1]) / 2 + Eigen::Vector2d(0.5, 0));
                      }),
              AllOf(HasSubstr("bent"), HasSubstr("left")));
}

// Without its rulings and its one point the upper circle floats: any depth has the same picture.
TEST(OneViewBadInput, UndeterminedDepthIsNamedNotGuessed) {
  SyntheticViewOptions drawn;
  drawn.upper_point = false;
  EXPECT_THAT(
      refusal(drawn,
              [](View& view) {
                std::erase_if(view.strokes,
                              [](const Stroke& s) { return s.kind == StrokeKind::silhouette; });
              }),
      AllOf(HasSubstr("depth is not determined"), HasSubstr("'top'"), Not(HasSubstr("'bottom'"))));
}

TEST(OneViewBadInput, PanelThatIsNotClosed) {
  EXPECT_THAT(refusal(tent(), [](View& view) { stroke_of(view, "edge-8").name = ""; }),
              AllOf(HasSubstr("'back'"), HasSubstr("one closed loop")));
}

TEST(OneViewBadInput, NoBorderAndOtherViews) {
  EXPECT_THAT(refusal({},
                      [](View& view) {
                        std::erase_if(view.strokes, [](const Stroke& s) {
                          return s.kind == StrokeKind::border || s.kind == StrokeKind::occlusion;
                        });
                      }),
              HasSubstr("no border"));
  EXPECT_THAT(refusal({}, [](View& view) { view.kind = ViewKind::front; }), HasSubstr("photo"));
}

}  // namespace
}  // namespace geoprior::sketch
