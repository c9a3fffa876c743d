// What the user draws, in which unit and by how steady a hand: options of the scene that no sweep
// turns, each from an experiment file to its effect.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <string>

#include "experiments/sketch/scene/scene.h"
#include "experiments/sketch/topic.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

using geoprior::test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class SketchScenes : public geoprior::test::RunTest {
 protected:
  [[nodiscard]] std::shared_ptr<SketchScene> scene(const std::string& lines) const {
    const auto file = write_experiment(
        "sketch/scene", "title = \"A scene\"\ntopic = \"sketch\"\n[scene]\n" + lines +
                            "[[variant]]\nname = \"hull\"\nmethod = "
                            "\"visual-hull\"\n");
    const Experiment experiment = load_experiment(file, {make_topic()}, {});
    return std::dynamic_pointer_cast<SketchScene>(
        make_topic().load(*experiment.cases[0].scene, file.parent_path(), 1));
  }
  /// The record of one variant of this method.
  [[nodiscard]] VariantRecord run(const std::string& scene_lines, const std::string& method,
                                  const std::string& options, const std::string& out) const {
    const auto file = write_experiment(
        "sketch/run", "title = \"A run\"\ntopic = \"sketch\"\n[scene]\n" + scene_lines +
                          "[[variant]]\nname = \"one\"\nmethod = \"" + method + "\"\noptions = { " +
                          options + " }\n");
    ExecuteRequest request;
    request.out = folder() / out;
    request.timing = false;
    return execute(load_experiment(file, {make_topic()}, {}), {make_topic()}, request)
        .record.cases.at(0)
        .variants.at(0);
  }
  void write_input(const std::string& name, const std::string& text) const {
    const auto below = folder() / "experiments" / "sketch";
    std::filesystem::create_directories(below);
    std::ofstream(below / name) << text;
  }
  /// Front and side of a box of 40 x 40 x 20 mm, a millimetre a unit.
  void write_box(const std::string& front, const std::string& side) const {
    const auto view = [](const std::string& name, const std::string& path) {
      return "<g id='view:" + name + "'><path id='" + name + "' d='" + path +
             "' style='fill:none;stroke:#000000'/></g>\n";
    };
    write_input("box.svg",
                "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 60' width='100mm' "
                "height='60mm'>\n" +
                    view("front", front) + view("side", side) + "</svg>\n");
  }
  static constexpr const char* kFront = "M10 10h40v40h-40z";
  static constexpr const char* kSide = "M60 10h20v40h-20z";
};

double width_of_front(const SketchScene& scene) {
  double low = 1e9, high = -1e9;
  for (const Eigen::Vector2d& p : scene.silhouettes.at(0).outline) {
    low = std::min(low, p.x());
    high = std::max(high, p.x());
  }
  return high - low;
}

TEST_F(SketchScenes, ReadsASurfaceInItsUnit) {
  write_input("patch.off", "OFF\n4 2 0\n0 0 0\n5 0 0\n5 3 0\n0 3 0\n3 0 1 2\n3 0 2 3\n");
  const auto metres = scene("surface = \"patch.off\"\n");
  ASSERT_TRUE(metres->input.surface);
  EXPECT_EQ(metres->input.surface->V.col(0).maxCoeff(), 5);
  EXPECT_FALSE(metres->input.patterns);
  const auto centimetres = scene("surface = \"patch.off\"\nsurface_scale = 0.01\n");
  EXPECT_DOUBLE_EQ(centimetres->input.surface->V.col(0).maxCoeff(), 0.05);
}

TEST_F(SketchScenes, SaysWhatOfASurfaceIsLeftOut) {
  write_input("patch.off", "OFF\n4 2 0\n0 0 0\n5 0 0\n5 3 0\n5 3 0\n3 0 1 2\n3 0 2 3\n");
  EXPECT_THAT(scene("surface = \"patch.off\"\n")->load_warnings,
              ElementsAre("patch.off: 1 triangles with two corners in one place left out"));
  write_input("none.off", "OFF\n3 0 0\n0 0 0\n5 0 0\n5 3 0\n");
  EXPECT_THAT(error_of([&] { (void)scene("surface = \"none.off\"\n"); }),
              HasSubstr("none.off: has no triangles"));
}

TEST_F(SketchScenes, ReadsADrawingInItsUnit) {
  write_box(kFront, kSide);
  EXPECT_NEAR(width_of_front(*scene("drawing = \"box.svg\"\n")), 0.04, 1e-12);
  EXPECT_NEAR(width_of_front(*scene("drawing = \"box.svg\"\nread = { unit_m = 0.01 }\n")), 0.4,
              1e-12);
}

// The front's line ends 4 mm before its start: 7.2 percent of the view's diagonal.
TEST_F(SketchScenes, ClosesGapsUpToTheSnap) {
  write_box("M10 10h40v40h-40v-36", kSide);
  EXPECT_THAT(error_of([&] { (void)scene("drawing = \"box.svg\"\n"); }), HasSubstr("gap of 4 mm"));
  const auto closed = scene("drawing = \"box.svg\"\nread = { snap = 0.1 }\n");
  EXPECT_EQ(closed->silhouettes.size(), 2U);
}

// A tremor that the raw strokes survive without crossing themselves.
TEST_F(SketchScenes, FairsTremorUpToTheNoise) {
  write_box(kFront, kSide);
  const auto points = [&](const std::string& read) {
    const auto of =
        scene("drawing = \"box.svg\"\nread = { tremor = { sigma = 0.0015" + read + " }\n");
    return of->input.drawing.views.at(0).strokes.at(0).points;
  };
  const auto faired = points(" }");
  EXPECT_NE(points(" }, fairing = false"), faired);
  EXPECT_NE(points(", seed = 2 }"), faired);
  EXPECT_THAT(error_of([&] { (void)points(" }, noise = 0.001"); }), HasSubstr("scene.read.noise"));
}

// The side is drawn 10 percent higher than the front.
TEST_F(SketchScenes, AlignsViewsWithinTheTolerance) {
  write_box(kFront, "M60 6h20v44h-20z");
  EXPECT_THAT(error_of([&] { (void)scene("drawing = \"box.svg\"\n"); }), HasSubstr("side"));
  const auto aligned = scene("drawing = \"box.svg\"\nalign = { tolerance = 0.15 }\n");
  double high = 0;
  for (const Eigen::Vector2d& p : aligned->silhouettes.at(1).outline) high = std::max(high, p.y());
  EXPECT_NEAR(high, 0.04, 1e-12) << "scaled to the front's height";
}

TEST_F(SketchScenes, DrawsWhatIsKnownInPlaceOfAFile) {
  const auto frustum = scene("synthetic = {}\n");
  ASSERT_TRUE(frustum->truth);
  EXPECT_TRUE(frustum->truth->conical);
  const auto body = scene("layers = { arcs = 5 }\n");
  ASSERT_TRUE(body->truth);
  EXPECT_EQ(strokes_of(body->photo(), StrokeKind::arc).size(), 5U);
  const auto cap = scene("closed_form = { rings = 3 }\n");
  ASSERT_TRUE(cap->input.surface);
  EXPECT_EQ(cap->input.surface->V.rows(), 1 + 6 + 12 + 18);
  EXPECT_THAT(error_of([&] { (void)scene("synthetic = {}\nlayers = {}\n"); }),
              HasSubstr("2 of them are given"));
}

// Drawn points are off by 2 percent of the frustum's height.
TEST_F(SketchScenes, RefusesPairsBeyondTheTolerance) {
  const std::string unsteady = "synthetic = { noise = 0.02, lower_pairs = 3 }\n";
  EXPECT_EQ(run(unsteady, "one-view", "pair_tolerance = 0.3", "loose").status, "done");
  EXPECT_THAT(error_of([&] { (void)run(unsteady, "one-view", "pair_tolerance = 1e-5", "strict"); }),
              HasSubstr("symmetric pair contradicts the mirror plane"));
}

TEST_F(SketchScenes, GoesOnForAsManyIterationsAsAsked) {
  write_box(kFront, kSide);
  const std::string box = "drawing = \"box.svg\"\nhull = { triangles = 200 }\n";
  for (const int iterations : {1, 3}) {
    const std::string asked = "surface = { iterations = " + std::to_string(iterations) + " }";
    const VariantRecord record = run(box, "slow-road", asked, "run" + std::to_string(iterations));
    EXPECT_EQ(record.status, "done") << record.error;
    EXPECT_EQ(record.frames.size(), static_cast<std::size_t>(iterations + 1));
  }
}

}  // namespace
}  // namespace geoprior::sketch
