#include "solvers/sketch/hidden/hidden_borders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/angles.h"
#include "core/geometry/planar.h"
#include "core/random.h"
#include "experiments/sketch/measures.h"
#include "experiments/sketch/truth/known_drawing.h"
#include "experiments/sketch/truth/known_view.h"
#include "experiments/sketch/truth/synthetic_views.h"
#include "solvers/sketch/drawing/faired_borders.h"
#include "solvers/sketch/hidden/border_models.h"
#include "solvers/sketch/one_view.h"

namespace geoprior::sketch {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

PictureCurve ellipse(double a, double b, int points) {
  PictureCurve curve{{}, true};
  for (int k = 0; k < points; ++k) {
    const double s = kFullTurn * k / points;
    curve.points.emplace_back(a * std::cos(s), b * std::sin(s));
  }
  return curve;
}

// p -> 0.6 p + (0.1, 0.8), seen for a third of the ellipse and without rulings.
TEST(ParallelCopies, AreFoundFromAPartOfThem) {
  const PictureCurve whole = ellipse(1, 0.4, 200);
  std::vector<Eigen::Vector2d> seen;
  for (int k = 100; k < 167; ++k)
    seen.emplace_back(0.6 * whole.points[k] + Eigen::Vector2d(0.1, 0.8));
  const auto copy = fit_parallel_copy(whole, seen, {});
  ASSERT_TRUE(copy);
  EXPECT_NEAR(copy->scale, 0.6, 1e-3);
  EXPECT_LT((copy->shift - Eigen::Vector2d(0.1, 0.8)).norm(), 1e-3);
  EXPECT_LT(copy->rms, 1e-4);
}

// Borders of a cylinder are of one size: a difference of 2 % may be noise of a hundredth of the
// ellipse's width, and one of 15 % cannot.
TEST(ParallelCopies, AreOfOneSizeWhereNoiseExplainsTheDifference) {
  const PictureCurve whole = ellipse(1, 0.4, 200);
  const auto scale = [&](double real, double noise) {
    std::vector<Eigen::Vector2d> seen;
    for (int k = 100; k < 167; ++k)
      seen.emplace_back(real * whole.points[k] + Eigen::Vector2d(0.1, 0.8));
    return fit_parallel_copy(whole, seen, {}, noise).value().scale;
  };
  EXPECT_EQ(scale(0.98, 0.01), 1);
  EXPECT_NEAR(scale(0.98, 0), 0.98, 1e-3);
  EXPECT_NEAR(scale(0.85, 0.01), 0.85, 1e-3);
}

// Every scale fits a straight part of a border.
TEST(ParallelCopies, AreOpenWhereAStraightPartIsSeen) {
  const PictureCurve whole{{{0, 0}, {1, 0}, {2, 0}, {3, 0}}, false};
  EXPECT_FALSE(fit_parallel_copy(whole, {{1, 1}, {1.2, 1}, {1.4, 1}, {1.6, 1}}, {}));
}

// Middles (0.1, 0) and (0.4, 1) lie on the axis, along u = x: (1, 0) has the image (-0.8, 0).
TEST(PictureMirrors, ReflectAlongTheNormalInTheLineOfMiddles) {
  const auto mirror = fit_picture_mirror({1, 0}, {{0.1, 0}, {0.4, 1}}, 0.1);
  ASSERT_TRUE(mirror);
  EXPECT_LT(((*mirror)({1, 0}) - Eigen::Vector2d(-0.8, 0)).norm(), 1e-12);
  EXPECT_LT(((*mirror)((*mirror)({0.3, 0.7})) - Eigen::Vector2d(0.3, 0.7)).norm(), 1e-12);
  EXPECT_FALSE(fit_picture_mirror({1, 0}, {{0.1, 0}, {0.4, 0}}, 0.1));
}

SyntheticView visible(KnownShape shape, double yaw, double pitch) {
  return known_view(shown_object({.shape = shape, .yaw_deg = yaw, .pitch_deg = pitch}), true);
}

OneViewOptions completing(Completion completion) {
  OneViewOptions options;
  options.curves.snap = 0.008;
  options.pair_tolerance = 0.3;
  options.complete = completion;
  return options;
}

double area_error(const SyntheticView& drawing, const OneViewResult& result) {
  double real = 0;
  for (const auto& [name, area] : drawing.panel_areas) real += area;
  const TriMesh& mesh = result.surface.mesh;
  return std::abs(triangle_areas(mesh.V, mesh.F).sum() / real - 1);
}

// Azimuths of the lower circle that the front hides: 180 degrees less twice what the silhouette
// reaches beyond a half, sin of which is (r1 - r2) tan(pitch) / h.
TEST(HiddenBorders, FrustumIsGuessedBehindItsSilhouettes) {
  const SyntheticView drawing = visible(KnownShape::frustum, 35, 25);
  EXPECT_TRUE(strokes_of(drawing.view, StrokeKind::occlusion).empty());
  const CompletedView completed = complete_borders(
      drawing.view, drawn_mirror_planes(drawing.view).chosen, 0.008, Completion::all);
  ASSERT_EQ(completed.guesses.size(), 1u);
  EXPECT_EQ(completed.guesses.front().border, "bottom");
  EXPECT_THAT(completed.guesses.front().from, HasSubstr("'top'"));
  const double pitch = 25 * kDegree;
  const double hidden = std::numbers::pi - 2 * std::asin(0.04 * std::tan(pitch) / 0.15);
  double length = 0, before = 0;
  constexpr int kSteps = 2000;
  for (int k = 0; k <= kSteps; ++k, before += hidden / kSteps) {
    const double s = before - hidden / 2;  // about the azimuth that points away from the eye
    length += 0.1 * std::hypot(std::cos(s), std::sin(pitch) * std::sin(s)) * hidden / kSteps;
  }
  EXPECT_NEAR(completed.guessed_length, length, 0.02 * length);
  EXPECT_THAT(completion_note(completed), HasSubstr("guessed"));
}

TEST(HiddenBorders, FrustumLosesAreaWithoutThem) {
  const SyntheticView drawing = visible(KnownShape::frustum, 35, 25);
  const OneViewResult whole = reconstruct_one_view(drawing.view, completing(Completion::all));
  EXPECT_LT(area_error(drawing, whole), 0.01);
  EXPECT_GT(whole.guessed_area, 0.1);
  EXPECT_LT(whole.guessed_area, 0.4);
  const OneViewResult part = reconstruct_one_view(drawing.view, completing(Completion::none));
  EXPECT_GT(area_error(drawing, part), 0.25);
  EXPECT_EQ(part.guessed_area, 0);
}

TEST(HiddenBorders, ObjectsRunAsPeopleDrawThem) {
  for (const auto& [shape, pitch] :
       {std::pair{KnownShape::bag, 25.0}, {KnownShape::tent, 28.0}, {KnownShape::helmet, 22.0}}) {
    const SyntheticView drawing = visible(shape, 35, pitch);
    const OneViewResult result = reconstruct_one_view(drawing.view, completing(Completion::all));
    EXPECT_LT(area_error(drawing, result), 0.05) << known_name(shape);
  }
}

// Each guessed node lies on no stroke, each other one on the stroke that it names.
TEST(HiddenBorders, KnowWhatIsDrawn) {
  const SyntheticView drawing = visible(KnownShape::tent, 35, 28);
  const OneViewResult result = reconstruct_one_view(drawing.view, completing(Completion::all));
  int guessed = 0, drawn = 0;
  for (const SketchCurve& curve : result.net.curves) {
    for (int i = 0; i < curve.size(); ++i) {
      const DrawnPlace place = result.completed.place(curve.stroke, curve.drawn_at[i]);
      ++(place.stroke < 0 ? guessed : drawn);
      if (place.stroke < 0) continue;
      const PictureCurve stroke{drawing.view.strokes[place.stroke].points,
                                drawing.view.strokes[place.stroke].closed};
      EXPECT_LT((point_at(stroke, place.at) - result.net.points[curve.nodes[i]]).norm(), 0.03);
    }
  }
  EXPECT_GT(guessed, 50);
  EXPECT_GT(drawn, 200);
}

Stroke stroke_through(const std::string& id, StrokeKind kind,
                      const std::vector<Eigen::Vector2d>& points, const std::string& name = "") {
  Stroke stroke;
  stroke.id = id;
  stroke.kind = kind;
  stroke.points = points;
  stroke.name = name;
  return stroke;
}

// An arch whose right third is covered by a border of another panel; two pairs lie on what is seen.
TEST(HiddenBorders, ArchIsContinuedByItsMirrorImage) {
  const auto arch_at = [](double s) { return Eigen::Vector2d(std::cos(s), 1.2 * std::sin(s)); };
  std::vector<Eigen::Vector2d> arch;
  for (int k = 0; k <= 40; ++k) arch.push_back(arch_at(std::numbers::pi * (1 - k / 60.0)));
  const Eigen::Vector2d end = arch.back();
  View view;
  view.kind = ViewKind::photo;
  view.strokes = {
      stroke_through("arch", StrokeKind::border, arch, "sheet"),
      stroke_through("wall", StrokeKind::border,
                     {end - Eigen::Vector2d(0, 1.5), end + Eigen::Vector2d(0, 0.5)}, "wall")};
  for (const double s : {62.0, 85.0}) {
    view.strokes.push_back(
        stroke_through("pair", StrokeKind::symmetric_pair,
                       {arch_at(std::numbers::pi - s * kDegree), arch_at(s * kDegree)}));
  }
  const MirrorPlane plane{Eigen::Vector3d(0.8, 0, 0.6), 0};
  const CompletedView completed = complete_borders(view, plane, 0.008, Completion::mirror);
  ASSERT_EQ(completed.guesses.size(), 1u);
  EXPECT_EQ(completed.guesses.front().from, "its mirror image");
  EXPECT_LT((completed.view.strokes[0].points.back() - Eigen::Vector2d(1, 0)).norm(), 0.02);
  EXPECT_THAT(complete_borders(view, plane, 0.008, Completion::none).guesses, IsEmpty());
  // With an occlusion the drawing says itself what is hidden.
  view.strokes.push_back(stroke_through("hidden", StrokeKind::occlusion, {{2, 0}, {3, 0}}));
  EXPECT_THAT(complete_borders(view, plane, 0.008, Completion::all).guesses, IsEmpty());
}

// Drawn points where they are; guessed ones on the lower circle, moved along its axis by a
// hundredth of the height, which is how far off they are.
TEST(GuessedOff, IsTheDistanceFromTheRealBorder) {
  SketchScene scene;
  scene.truth = visible(KnownShape::frustum, 35, 25);
  const SyntheticView& truth = *scene.truth;
  const std::vector<Eigen::Vector3d>&top = truth.truth[1], &bottom = truth.borders[0];
  Part lines;
  lines.kind = Part::Kind::lines;
  const auto n = static_cast<Eigen::Index>(top.size()),
             m = static_cast<Eigen::Index>(bottom.size());
  lines.points.resize(n + m, 3);
  NamedArray stroke{"stroke", "1", NamedArray::On::points, Eigen::MatrixXd::Constant(n + m, 1, -1)};
  NamedArray drawn_at{"drawn_at", "1", NamedArray::On::points, Eigen::MatrixXd::Zero(n + m, 1)};
  for (Eigen::Index i = 0; i < n; ++i) {
    lines.points.row(i) = top[i].transpose();
    stroke.values(i) = 1;
    drawn_at.values(i) = static_cast<double>(i);
  }
  for (Eigen::Index i = 0; i < m; ++i)
    lines.points.row(n + i) = (bottom[i] + 0.01 * truth.height * truth.axis).transpose();
  lines.arrays = {stroke, drawn_at};
  Frame frame;
  frame.parts["strokes"] = lines;
  const TruthMeasures measures = truth_measures(scene, frame);
  EXPECT_NEAR(measures.depth_rms.value(), 0, 1e-9);
  EXPECT_NEAR(measures.guessed_off.value(), 0.01, 1e-5);
}

/// An arc of radius 1 that is drawn with noise of 1 %.
std::vector<Eigen::Vector2d> trembling_arc(std::uint64_t seed, int points) {
  RandomStream random(seed, "tremor");
  std::vector<Eigen::Vector2d> drawn;
  for (int k = 0; k < points; ++k) {
    const double dx = 0.01 * random.normal(), dy = 0.01 * random.normal();
    drawn.emplace_back(std::cos(0.05 * k) + dx, std::sin(0.05 * k) + dy);
  }
  return drawn;
}

// A cubic in each coordinate, eight numbers of 144, is near to the arc: of independent noise it
// would leave the root of 8 / 144, a quarter; what is not told to be a cubic may leave twice that.
// The estimate of the noise has the relative deviation
// 1 / sqrt(2 * 138), a sixteenth.
TEST(FairedBorders, LoseTremorAndKeepTheLine) {
  std::vector<Eigen::Vector2d> clean;
  for (int k = 0; k < 72; ++k) clean.emplace_back(std::cos(0.05 * k), std::sin(0.05 * k));
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const FairedLine faired = fair_line(trembling_arc(seed, 72), false, {false, false}, 1e-4);
    EXPECT_NEAR(faired.noise, 0.01, 0.002);
    EXPECT_EQ(faired.freedom, 2 * (72 - 3));
    double sum = 0;
    for (int k = 0; k < 72; ++k) sum += (faired.points[k] - clean[k]).squaredNorm();
    EXPECT_LT(std::sqrt(sum / (2 * 72)), 0.5 * 0.01) << seed;
  }
  EXPECT_EQ(fair_line(clean, false, {false, false}, 1e-3).points, clean);
}

// Two borders of one hand: the noise of both together.
TEST(FairedBorders, ShareTheNoiseOfTheHand) {
  View view;
  view.kind = ViewKind::photo;
  for (const std::uint64_t seed : {1, 2}) {
    Stroke stroke;
    stroke.id = "arc-" + std::to_string(seed);
    stroke.kind = StrokeKind::border;
    stroke.points = trembling_arc(seed, 60);
    for (Eigen::Vector2d& p : stroke.points) p.x() += 3.0 * static_cast<double>(seed);
    view.strokes.push_back(stroke);
  }
  const FairedView faired = faired_borders(view, 0.01);
  EXPECT_NEAR(faired.noise, 0.01, 0.0015);
  EXPECT_EQ(faired.view.strokes[0].points.size(), 60u);
}

// Of an arc of nine points nothing would be known alone; a right angle of many points to the
// deviation of the noise keeps its corner, which is one.
TEST(FairedBorders, ShortLinesAndCornersAreToldFromTheNoiseOfAll) {
  View view;
  view.kind = ViewKind::photo;
  const auto add = [&](const char* id, std::vector<Eigen::Vector2d> points) {
    Stroke stroke;
    stroke.id = id;
    stroke.kind = StrokeKind::border;
    stroke.points = std::move(points);
    view.strokes.push_back(std::move(stroke));
  };
  add("long", trembling_arc(1, 90));
  add("short", trembling_arc(2, 9));
  std::vector<Eigen::Vector2d> bent;
  RandomStream random(3, "tremor");
  for (int k = -60; k <= 60; ++k) {
    const double dx = 0.01 * random.normal(), dy = 0.01 * random.normal();
    bent.emplace_back(3 + 0.005 * std::max(k, 0) + dx, 0.005 * std::max(-k, 0) + dy);
  }
  add("bent", bent);
  const FairedView faired = faired_borders(view, 0.01);
  EXPECT_NEAR(faired.noise, 0.01, 0.0015);
  double drawn = 0, left = 0;
  for (int k = 0; k < 9; ++k) {
    const Eigen::Vector2d clean(std::cos(0.05 * k), std::sin(0.05 * k));
    drawn += (view.strokes[1].points[k] - clean).squaredNorm();
    left += (faired.view.strokes[1].points[k] - clean).squaredNorm();
  }
  EXPECT_LT(left, drawn);
  int held = 0;
  for (std::size_t k = 1; k + 1 < bent.size(); ++k)
    held += faired.view.strokes[2].points[k] == bent[k] ? 1 : 0;
  EXPECT_LE(held, 1);
  const auto turned = [&](std::size_t k) {
    const std::vector<Eigen::Vector2d>& p = faired.view.strokes[2].points;
    return std::abs(signed_angle(p[k] - p[k - 20], p[k + 20] - p[k]));
  };
  EXPECT_GT(turned(60), 1.2);
}

OneViewResult rough_result(const SyntheticView& drawing) {
  return reconstruct_one_view(drawing.view, completing(Completion::all));
}

// Seeds on which nothing was set. Known of a frustum is its area; 1 % of the height is noise.
TEST(OneViewNoise, FrustumOfOnePercentKeepsItsArea) {
  for (const std::uint64_t seed : {101, 102, 103}) {
    SyntheticView drawing = visible(KnownShape::frustum, 35, 25);
    const double height = shown_object({.shape = KnownShape::frustum}).height;
    add_drawing_noise(drawing.view, 0.01 * height, seed);
    const OneViewResult result = rough_result(drawing);
    EXPECT_NEAR(result.noise, 0.01 * height, 0.002 * height) << seed;
    EXPECT_LT(area_error(drawing, result), 0.03) << seed;
  }
}

// From 20 to 45 degrees above, with the usual options.
TEST(HiddenBorders, ObjectsAreRightFromManySides) {
  for (const KnownShape shape : {KnownShape::bag, KnownShape::tent, KnownShape::helmet}) {
    for (const double pitch : {35.0, 45.0}) {
      const SyntheticView drawing = visible(shape, 35, pitch);
      const OneViewResult result = reconstruct_one_view(drawing.view, {});
      EXPECT_LT(area_error(drawing, result), 0.02) << known_name(shape) << " " << pitch;
    }
  }
}

// A seed on which nothing was set.
TEST(OneViewNoise, ObjectsOfOnePercentKeepTheirArea) {
  for (const KnownShape shape : {KnownShape::bag, KnownShape::tent, KnownShape::helmet}) {
    SyntheticView drawing = known_view(shown_object({.shape = shape}), true);
    add_drawing_noise(drawing.view, 0.01 * drawing.height, 101);
    EXPECT_LT(area_error(drawing, reconstruct_one_view(drawing.view, {})), 0.04)
        << known_name(shape);
  }
}

TEST(OneViewNoise, NarrowPanelsAreNamed) {
  SyntheticView drawing = visible(KnownShape::helmet, 35, 22);
  const auto notes = [&] { return one_view_notes(drawing.view, completing(Completion::all)); };
  EXPECT_EQ(notes().size(), 1u);
  add_drawing_noise(drawing.view, 0.01 * drawing.height, 101);
  EXPECT_THAT(notes(),
              testing::Contains(testing::AllOf(HasSubstr("relied upon"), HasSubstr("'flat-tip'"))));
}

// Of a rim without a pair rulings tell the shape, but not how far away it lies.
TEST(OneViewNotes, NameBordersWithoutAPair) {
  SyntheticViewOptions options;
  EXPECT_THAT(one_view_notes(synthetic_view(options).view, {}), IsEmpty());
  options.upper_point = false;
  EXPECT_THAT(one_view_notes(synthetic_view(options).view, {}),
              testing::ElementsAre(HasSubstr("no symmetric pair ends on 'top'")));
  for (const KnownShape shape : {KnownShape::bag, KnownShape::tent, KnownShape::helmet}) {
    EXPECT_THAT(one_view_notes(known_view(shown_object({.shape = shape})).view, {}), IsEmpty())
        << known_name(shape);
  }
}

// Ends are moved along their borders by noise: a pair of a trembling drawing slides to where it
// runs along the normal, one of an exact drawing stays.
TEST(OneViewNoise, PairsSlideAlongTheirBorders) {
  SyntheticView drawing = visible(KnownShape::frustum, 35, 25);
  const MirrorPlane plane = drawn_mirror_planes(drawing.view).chosen;
  for (Stroke& stroke : drawing.view.strokes)
    if (stroke.kind == StrokeKind::symmetric_pair)
      stroke.points.front() += 0.002 * across_pairs(plane);
  const CurveNet net = build_curve_net(drawing.view, completing(Completion::all).curves);
  const auto miss = [&](double noise) {
    double sum = 0;
    for (const SymmetricPair& pair : read_symmetric_pairs(drawing.view, net, plane, 0.3, noise))
      sum += std::abs(across_pairs(plane).dot(pair.image - pair.point));
    return sum;
  };
  EXPECT_LT(miss(0.002), 0.5 * miss(0));
}

}  // namespace
}  // namespace geoprior::sketch
