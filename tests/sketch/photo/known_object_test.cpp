// Bag, tent and helmet: what is drawn of them is what they are.

#include "experiments/sketch/truth/known_object.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>

#include "experiments/sketch/drawing/drawing_file.h"
#include "experiments/sketch/drawing/picture_file.h"
#include "experiments/sketch/truth/known_drawing.h"
#include "experiments/sketch/truth/known_photo.h"
#include "experiments/sketch/truth/known_view.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class KnownObjects : public ::testing::TestWithParam<KnownShape> {
 protected:
  const KnownObject object_ = known_object(GetParam());
  [[nodiscard]] std::filesystem::path file(const std::string& ending) const {
    return std::filesystem::path(GEOPRIOR_SOURCE_DIR) / "experiments/sketch" /
           (known_name(GetParam()) + ending);
  }
};

INSTANTIATE_TEST_SUITE_P(Shapes, KnownObjects,
                         ::testing::Values(KnownShape::bag, KnownShape::tent, KnownShape::helmet),
                         [](const auto& shape) { return known_name(shape.param); });

const KnownPanel& panel_of(const KnownObject& object, const std::string& name) {
  return *std::find_if(object.panels.begin(), object.panels.end(),
                       [&](const KnownPanel& panel) { return panel.name == name; });
}

/// det(T1, r, T2) over the lengths: the sine of the angle by which tangent planes turn along a
/// ruling, times those between ruling and borders.
double twist(const KnownPanel& panel, std::size_t k) {
  const Eigen::Vector3d t1 = (panel.first[k + 1] - panel.first[k - 1]).normalized();
  const Eigen::Vector3d t2 = (panel.second[k + 1] - panel.second[k - 1]).normalized();
  return t1.cross((panel.second[k] - panel.first[k]).normalized()).dot(t2);
}

// A ruled surface is developable where its tangent plane is the same all along each ruling.
TEST_P(KnownObjects, RuledPanelsAreDevelopable) {
  for (const KnownPanel& panel : object_.panels) {
    if (panel.flat) continue;
    for (std::size_t k = 1; k + 1 < panel.first.size(); ++k)
      ASSERT_LT(std::abs(twist(panel, k)), 1e-9) << panel.name << ", ruling " << k;
  }
}

TEST_P(KnownObjects, FlatPanelsLieInPlanes) {
  for (const KnownPanel& panel : object_.panels) {
    if (!panel.flat) continue;
    const Eigen::Vector3d normal =
        (panel.first[80] - panel.first[0]).cross(panel.first[160] - panel.first[0]).normalized();
    for (const Eigen::Vector3d& p : panel.first)
      ASSERT_LT(std::abs(normal.dot(p - panel.first[0])), 1e-12) << panel.name;
  }
}

// Every border has its mirror image in x = 0 among the borders.
TEST_P(KnownObjects, IsSymmetric) {
  const auto distance = [&](const Eigen::Vector3d& p) {
    double nearest = 1e9;
    for (const KnownBorder& border : object_.borders) {
      const std::size_t n = border.points.size();
      for (std::size_t k = 0; k < n - (border.closed ? 0 : 1); ++k) {
        const Eigen::Vector3d a = border.points[k], d = border.points[(k + 1) % n] - a;
        const double t = std::clamp(d.dot(p - a) / d.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (a + t * d - p).norm());
      }
    }
    return nearest;
  };
  for (const KnownBorder& border : object_.borders) {
    for (const Eigen::Vector3d& p : border.points)
      ASSERT_LT(distance({-p.x(), p.y(), p.z()}), 2e-3 * object_.height) << border.id;
  }
}

// The circumference of an ellipse with half axes a < b is 4 b E(sqrt(1 - a^2 / b^2)).
TEST(KnownAreas, CylindersHaveCircumferenceTimesLength) {
  const auto circumference = [](double a, double b) {
    return 4 * b * std::comp_ellint_2(std::sqrt(1 - a * a / (b * b)));
  };
  const TriMesh band = panel_mesh(panel_of(known_object(KnownShape::helmet), "brow-band"));
  EXPECT_NEAR(triangle_areas(band.V, band.F).sum(), 0.05 * circumference(0.1, 0.12), 1e-6);
  const TriMesh room = panel_mesh(panel_of(known_object(KnownShape::tent), "room"));
  EXPECT_NEAR(triangle_areas(room.V, room.F).sum(), 0.75 * circumference(0.5, 0.625) / 2, 1e-4);
  const TriMesh door = panel_mesh(panel_of(known_object(KnownShape::tent), "flat-door"));
  EXPECT_NEAR(triangle_areas(door.V, door.F).sum(),
              0.72 * 0.72 * std::numbers::pi * 0.5 * 0.625 / 2, 1e-4);
}

// On the cylinder x = 0.5 cos t, y = 0.625 sin t the normal is (cos t / 0.5, sin t / 0.625, 0).
TEST(KnownViews, SilhouetteIsWhereTheNormalIsOrthogonalToTheView) {
  const KnownObject tent = known_object(KnownShape::tent);
  const KnownPlacement place = known_placement(tent);
  const SyntheticView view = known_view(tent);
  const auto stroke = std::find_if(view.view.strokes.begin(), view.view.strokes.end(),
                                   [](const Stroke& s) { return s.id == "room-silhouette-1"; });
  ASSERT_NE(stroke, view.view.strokes.end());
  const std::size_t number = stroke - view.view.strokes.begin();
  for (const Eigen::Vector3d& q : view.truth[number]) {
    const Eigen::Vector3d p = place.frame.transpose() * (q - place.shift);
    const Eigen::Vector3d normal(p.x() / 0.25, p.y() / (0.625 * 0.625), 0);
    EXPECT_NEAR(normal.normalized().dot(place.frame.row(2)), 0, 1e-3);
  }
}

// The strap of the bag hides nothing of its front; the far foot of the outline is hidden.
TEST(KnownViews, OcclusionsMarkWhatLiesBehind) {
  const SyntheticView view = known_view(known_object(KnownShape::bag));
  const auto has = [&](const std::string& id) {
    return std::any_of(view.view.strokes.begin(), view.view.strokes.end(),
                       [&](const Stroke& s) { return s.id == id; });
  };
  EXPECT_TRUE(has("back-outline-hidden-1"));
  EXPECT_TRUE(has("front-top-hidden-1")) << "below the flap";
  EXPECT_FALSE(has("front-outline-hidden-1"));
}

// The rear end of the flap is seen by nobody. The room of the tent is whole: where its arches stand
// behind it, that of the door says how far they go.
TEST(KnownViews, AreasEndWhereNoBorderShowsThem) {
  const auto shown = [](KnownShape shape, const std::string& panel, bool visible_only) {
    return known_view(known_object(shape), visible_only).panel_areas.at(panel);
  };
  EXPECT_LT(shown(KnownShape::bag, "flap", true), 0.95 * shown(KnownShape::bag, "flap", false));
  EXPECT_EQ(shown(KnownShape::bag, "gusset", true), shown(KnownShape::bag, "gusset", false));
  EXPECT_EQ(shown(KnownShape::tent, "room", true), shown(KnownShape::tent, "room", false));
  EXPECT_EQ(shown(KnownShape::frustum, "shade", true), shown(KnownShape::frustum, "shade", false));
}

// Noise has the spread that is asked for, and plane vectors none unless they are noisy too.
TEST(KnownViews, NoiseHasItsSpread) {
  SyntheticView noisy = known_view(known_object(KnownShape::helmet));
  const SyntheticView exact = noisy;
  add_drawing_noise(noisy.view, 0.001, 3);
  double sum = 0;
  int count = 0;
  for (std::size_t s = 0; s < exact.view.strokes.size(); ++s) {
    for (std::size_t k = 0; k < exact.view.strokes[s].points.size(); ++k) {
      const Eigen::Vector2d d = noisy.view.strokes[s].points[k] - exact.view.strokes[s].points[k];
      if (exact.view.strokes[s].kind == StrokeKind::plane_vector) {
        EXPECT_EQ(d.norm(), 0);
        continue;
      }
      sum += d.squaredNorm() / 2;
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(sum / count), 0.001, 5e-5);
}

TEST(KnownViews, NoisyVectorsHaveTheSpreadOfTheRest) {
  const SyntheticView exact = known_view(known_object(KnownShape::helmet));
  constexpr int kDrawings = 400;
  double sum = 0;
  int count = 0;
  for (int seed = 1; seed <= kDrawings; ++seed) {
    SyntheticView noisy = exact;
    add_drawing_noise(noisy.view, 0.001, seed, true);
    for (std::size_t s = 0; s < exact.view.strokes.size(); ++s) {
      if (exact.view.strokes[s].kind != StrokeKind::plane_vector) continue;
      for (std::size_t k = 0; k < exact.view.strokes[s].points.size(); ++k) {
        sum += (noisy.view.strokes[s].points[k] - exact.view.strokes[s].points[k]).squaredNorm();
        ++count;
      }
    }
  }
  EXPECT_EQ(count, kDrawings * 4) << "two vectors, both ends";
  EXPECT_NEAR(std::sqrt(sum / (2 * count)), 0.001, 5e-5);
}

// The photograph beside the experiment is that of the model. A run of a scene with `known` and
// without `drawing` writes it, and the drawing.
TEST_P(KnownObjects, PhotographInTheRepositoryIsTheModels) {
  Picture picture;
  picture.file = file(".png").string();
  const PixelImage photo = read_picture(picture);
  const PixelImage made = known_photo(GetParam(), object_, photo.width);
  ASSERT_EQ(photo.height, made.height);
  for (std::size_t i = 0; i < made.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_LE(std::abs(int{photo.pixels[i][c]} - int{made.pixels[i][c]}), 2) << "pixel " << i;
  }
  EXPECT_LT(std::filesystem::file_size(file(".png")), 60000u);
}

// And so is the drawing, whose strokes are written in steps of 0.1 mm of paper.
TEST_P(KnownObjects, DrawingInTheRepositoryIsTheModels) {
  const DrawingFile read = read_drawing(file(".svg"), {});
  EXPECT_THAT(read.warnings, ::testing::IsEmpty());
  const View& view = read.drawing.views.front();
  const SyntheticView known = known_view(object_);
  ASSERT_EQ(view.strokes.size(), known.view.strokes.size());
  const double step = 1e-4 * object_.drawing_scale;
  for (const Stroke& stroke : known.view.strokes) {
    const auto drawn = std::find_if(view.strokes.begin(), view.strokes.end(),
                                    [&](const Stroke& s) { return s.id == stroke.id; });
    ASSERT_NE(drawn, view.strokes.end()) << stroke.id;
    EXPECT_EQ(drawn->kind, stroke.kind) << stroke.id;
    EXPECT_EQ(drawn->name, stroke.name) << stroke.id;
    EXPECT_EQ(drawn->panels, stroke.panels) << stroke.id;
    EXPECT_EQ(drawn->side, stroke.side) << stroke.id;
    EXPECT_EQ(drawn->closed, stroke.closed) << stroke.id;
    ASSERT_EQ(drawn->points.size(), stroke.points.size()) << stroke.id;
    for (std::size_t k = 0; k < stroke.points.size(); ++k)
      ASSERT_LT((drawn->points[k] - stroke.points[k]).norm(), step) << stroke.id;
  }
  EXPECT_LT((view.picture.size - known_placement(object_).page).norm(), 1e-9);
  EXPECT_LT(view.picture.origin.norm(), 1e-9);
}

// Truth is found for every stroke that was read, in its own order.
TEST_P(KnownObjects, TruthBelongsToTheDrawing) {
  const DrawingFile read = read_drawing(file(".svg"), {});
  const SyntheticView truth = known_truth(read.drawing.views.front(), {.shape = GetParam()}, 1);
  ASSERT_EQ(truth.truth.size(), truth.view.strokes.size());
  for (std::size_t s = 0; s < truth.truth.size(); ++s) {
    for (std::size_t k = 0; k < truth.truth[s].size(); ++k) {
      ASSERT_LT((truth.view.strokes[s].points[k] - truth.truth[s][k].head<2>()).norm(),
                1e-4 * object_.drawing_scale)
          << truth.view.strokes[s].id;
    }
  }
}

TEST_P(KnownObjects, AnotherDrawingIsRefused) {
  View view = known_drawing({.shape = GetParam()}).views.front();
  view.strokes.front().points.pop_back();
  EXPECT_THAT(geoprior::test::error_of([&] { known_truth(view, {.shape = GetParam()}, 1); }),
              AllOf(HasSubstr("is no stroke of the known " + known_name(GetParam())),
                    HasSubstr(view.strokes.front().id)));
}

}  // namespace
}  // namespace geoprior::sketch
