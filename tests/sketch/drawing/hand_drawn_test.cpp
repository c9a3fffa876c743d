// Drawings by hand, which are put right and said to be; and drawings that are broken, each of which
// ends in one error or one warning that names the view and the stroke.
#include "experiments/sketch/drawing/hand_drawn.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "experiments/sketch/drawing/drawing_checks.h"
#include "experiments/sketch/drawing/drawing_file.h"
#include "models/sketch/drawing/align_views.h"
#include "models/sketch/surface/visual_hull.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::sketch {
namespace {

using geoprior::test::expect_error;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// An element of one view: a path with a colour.
std::string path(const std::string& id, const std::string& d, const std::string& colour = "black",
                 const std::string& more = "") {
  return "<path id='" + id + "' d='" + d + "' fill='none' stroke='" + colour + "' " + more + "/>\n";
}

std::string layer(const std::string& label, const std::string& inside,
                  const std::string& more = "") {
  return "<g inkscape:groupmode='layer' inkscape:label='" + label + "' id='" + label + "-layer' " +
         more + ">\n" + inside + "</g>\n";
}

// A box: front of 100 mm by 100 mm, side of 60 mm by 100 mm, their diagonals 141.4 and 116.6 mm.
const std::string kSquare = path("outline", "M10 10h100v100h-100z");
const std::string kFlank = path("flank", "M150 10h60v100h-60z");
const std::string kFrontRim = path("rim", "M10 10h100", "blue");
const std::string kSideRim = path("side-rim", "M150 10h60", "blue");

class HandDrawn : public geoprior::test::ScratchFolder {
 protected:
  [[nodiscard]] DrawingFile read(const std::string& layers,
                                 const DrawingFileOptions& options = {}) const {
    const auto file =
        write("box.svg",
              "<svg xmlns='http://www.w3.org/2000/svg' "
              "xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' width='300mm' "
              "height='200mm' viewBox='0 0 300 200'>\n" +
                  layers + "</svg>\n");
    return read_drawing(file, options);
  }
  /// A front view beside a good side view.
  [[nodiscard]] DrawingFile front(const std::string& inside,
                                  const DrawingFileOptions& options = {}) const {
    return read(layer("view:front", inside) + layer("view:side", kFlank), options);
  }
  /// All that is said of a drawing until its views are put together.
  [[nodiscard]] std::vector<std::string> said_of(const std::string& layers) const {
    DrawingFile file = read(layers);
    const Drawing aligned = align_views(file.drawing, {}, &file.warnings);
    for (const std::string& doubt : doubtful_views(aligned)) file.warnings.push_back(doubt);
    return file.warnings;
  }
};

Eigen::Vector2d extent_of(const Stroke& stroke) {
  Eigen::Vector2d low = stroke.points[0], high = low;
  for (const Eigen::Vector2d& p : stroke.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return high - low;
}

/// One closed silhouette of about 100 mm by 100 mm.
void expect_square(const DrawingFile& file, double tolerance) {
  const View& view = *file.drawing.find(ViewKind::front);
  const std::vector<const Stroke*> outlines = strokes_of(view, StrokeKind::silhouette);
  ASSERT_EQ(outlines.size(), 1U);
  EXPECT_TRUE(outlines[0]->closed);
  EXPECT_LT((extent_of(*outlines[0]) - Eigen::Vector2d(0.1, 0.1)).norm(), tolerance);
}

TEST_F(HandDrawn, SaysNothingOfWhatIsDrawnExactly) {
  const DrawingFile file = front(kSquare + kFrontRim);
  EXPECT_THAT(file.warnings, IsEmpty());
  const Stroke& outline = file.drawing.find(ViewKind::front)->strokes.at(0);
  EXPECT_EQ(outline.points.size(), 4U);
}

TEST_F(HandDrawn, ClosesAnOpenEndAndSaysByHowMuch) {
  const DrawingFile file = front(path("outline", "M10 10h100v100h-100v-96"));
  expect_square(file, 0.003);
  EXPECT_THAT(file.warnings, ElementsAre(AllOf(HasSubstr("view:front"), HasSubstr("'outline'"),
                                               HasSubstr("2 mm (1.4 % of the view's diagonal)"))));
}

TEST_F(HandDrawn, NamesTheOptionForAWiderGap) {
  expect_error([&] { (void)front(path("outline", "M10 10h100v100h-100v-90")); },
               {"box.svg:3: path 'outline'", "gap of 10 mm", "at most 7.07 mm", "scene.read.snap"});
  DrawingFileOptions wide;
  wide.hand.snap = 0.1;
  EXPECT_EQ(front(path("outline", "M10 10h100v100h-100v-90"), wide).warnings.size(), 1U);
}

TEST_F(HandDrawn, LeavesOutALineThatWasDrawnTwice) {
  const DrawingFile file = front(kSquare + path("again", "M12 12l50 -1h45l2 97l-99 2l1 -96"));
  expect_square(file, 1e-9);
  EXPECT_THAT(file.warnings,
              ElementsAre(AllOf(HasSubstr("view:front"), HasSubstr("'again' lies along 'outline'"),
                                HasSubstr("% of the view's diagonal"))));
}

TEST_F(HandDrawn, CutsALineThatGoesOnBesideItsStart) {
  const DrawingFile file = front(path("outline", "M10 10h100v100h-100v-99l20 1"));
  expect_square(file, 0.003);
  EXPECT_THAT(file.warnings, Contains(HasSubstr("'outline' goes on along its own start")));
}

TEST_F(HandDrawn, CutsTheOverlapOfTwoStrokes) {
  const DrawingFile file =
      front(path("a", "M10 60v-50h100v50") + path("b", "M110.5 40v70h-101v-70"));
  expect_square(file, 0.003);
  EXPECT_THAT(file.warnings, Contains(HasSubstr("goes on along")));
}

TEST_F(HandDrawn, CutsLinesThatOvershoot) {
  const DrawingFile file = front(path("a", "M7 10h106") + path("b", "M110 8v105") +
                                 path("c", "M113 110h-106") + path("d", "M10 113v-106"));
  expect_square(file, 1e-9);
  EXPECT_EQ(file.warnings.size(), 4U);
  EXPECT_THAT(file.warnings, Contains(AllOf(HasSubstr("crosses"), HasSubstr("3 mm"))));
}

TEST_F(HandDrawn, LaysABorderOntoTheSilhouette) {
  const DrawingFile file = front(kSquare + path("rim", "M12 12l50 1l46 -2", "blue"));
  const Stroke& rim = *strokes_of(*file.drawing.find(ViewKind::front), StrokeKind::border).at(0);
  EXPECT_LT((extent_of(rim) - Eigen::Vector2d(0.1, 0)).norm(), 1e-9) << "from corner to corner";
  EXPECT_THAT(file.warnings,
              ElementsAre(AllOf(HasSubstr("border 'rim'"), HasSubstr("3 mm (2.1 %"))));
}

// Side drawn 4 % lower than the front.
TEST_F(HandDrawn, ScalesViewsThatDisagree) {
  const std::vector<std::string> said = said_of(
      layer("view:front", kSquare + kFrontRim) +
      layer("view:side", path("flank", "M150 14h60v96h-60z") + path("r", "M150 14h60", "blue")));
  EXPECT_THAT(said, ElementsAre(AllOf(HasSubstr("view:side"), HasSubstr("along y"),
                                      HasSubstr("view:front"), HasSubstr("4 mm (4.2 %)"))));
  expect_error(
      [&] {
        (void)said_of(layer("view:front", kSquare) +
                      layer("view:side", path("flank", "M150 20h60v90h-60z")));
      },
      {"view side", "differs from that in view front", "scene.align.tolerance"});
}

TEST_F(HandDrawn, FairsTremorUnlessToldNotTo) {
  DrawingFileOptions options;
  options.tremor = TremorOptions{};
  const DrawingFile faired = front(kSquare, options);
  EXPECT_THAT(faired.warnings,
              Contains(AllOf(HasSubstr("view:front: stroke 'outline' trembles by"),
                             HasSubstr("moved by at most"), HasSubstr("corners kept"))));
  expect_square(faired, 0.004);
  options.hand.fairing = false;
  std::string raw;
  try {
    for (const std::string& said : front(kSquare, options).warnings) raw += said;
  } catch (const std::exception& error) {
    raw = error.what();
  }
  EXPECT_THAT(raw, Not(HasSubstr("faired")));
  options.hand.fairing = true;
  options.tremor->sigma = 0.03;
  options.hand.snap = 0.1;
  expect_error([&] { (void)front(kSquare, options); }, {"trembles by", "scene.read.noise"});
}

// What was silent.

TEST_F(HandDrawn, SaysThatABorderIsInOneViewOnly) {
  EXPECT_THAT(said_of(layer("view:front", kSquare + kFrontRim) + layer("view:side", kFlank)),
              ElementsAre(AllOf(HasSubstr("view:front: stroke 'rim' is a border"),
                                HasSubstr("view:side has none there"))));
  EXPECT_THAT(said_of(layer("view:front", kSquare) + layer("view:side", kFlank + kSideRim)),
              ElementsAre(HasSubstr("view:side: stroke 'side-rim' is a border")));
  EXPECT_THAT(
      said_of(layer("view:front", kSquare + kFrontRim) + layer("view:side", kFlank + kSideRim)),
      IsEmpty());
}

TEST_F(HandDrawn, SaysThatAClosedSurfaceCannotBeLaidFlat) {
  EXPECT_THAT(said_of(layer("view:front", kSquare) + layer("view:side", kFlank)),
              ElementsAre(AllOf(HasSubstr("no view has a border or a seam"),
                                HasSubstr("the whole surface is one closed piece"))));
  EXPECT_THAT(said_of(layer("view:front", kSquare + path("cut", "M20 20v60", "red")) +
                      layer("view:side", kFlank)),
              IsEmpty());
}

TEST_F(HandDrawn, SaysThatAViewIsUpsideDown) {
  const std::string cone = path("cone", "M40 10h40l30 100h-100z"),
                    upright = path("flank", "M170 10h20l20 100h-60z"),
                    turned = path("flank", "M150 10h60l-20 100h-20z"),
                    seam = path("cut", "M60 20v60", "red");
  EXPECT_THAT(said_of(layer("view:front", cone + seam) + layer("view:side", upright)), IsEmpty());
  EXPECT_THAT(
      said_of(layer("view:front", cone + seam) + layer("view:side", turned)),
      ElementsAre(AllOf(HasSubstr("upside down"), HasSubstr("'cone'"), HasSubstr("'flank'"))));
  // Boxes have no up; their openings have.
  EXPECT_THAT(said_of(layer("view:front", kSquare + kFrontRim) +
                      layer("view:side", kFlank + path("r", "M150 110h60", "blue"))),
              ElementsAre(HasSubstr("upside down")));
}

TEST_F(HandDrawn, DoesNotDoubtTheDrawingsOfTheRepository) {
  for (const char* name : {"boot", "coat", "hat-1", "hat-2", "hat-3", "purse", "tunic"}) {
    const DrawingFile file =
        read_drawing(std::string(GEOPRIOR_SOURCE_DIR) + "/experiments/sketch/" + name + ".svg", {});
    std::vector<std::string> warnings = file.warnings;
    const Drawing aligned = align_views(file.drawing, {}, &warnings);
    EXPECT_THAT(warnings, IsEmpty()) << name;
    EXPECT_THAT(doubtful_views(aligned), IsEmpty()) << name;
  }
}

TEST_F(HandDrawn, TakesLayersHoweverTheirNamesAreWritten) {
  const DrawingFile file = read(layer("View: Front", kSquare) + layer(" VIEW : side ", kFlank));
  EXPECT_EQ(file.drawing.views.size(), 2U);
  EXPECT_THAT(file.warnings, IsEmpty());
}

TEST_F(HandDrawn, NamesLayersThatAreNotRead) {
  const std::string one = layer("view:front", kSquare), two = layer("view:side", kFlank);
  EXPECT_THAT(read(one + two + layer("notes", kSquare)).warnings,
              ElementsAre(AllOf(HasSubstr("1 shapes outside"), HasSubstr("'notes'"))));
  EXPECT_THAT(read(one + two + layer("guides", kSquare, "style='display:none'")).warnings,
              ElementsAre(HasSubstr("guides is hidden, and not read")));
  expect_error([&] { (void)read(one + layer("view:side", kFlank, "style='display:none'")); },
               {"a second view is missing", "'view:side' hidden, and not read"});
  expect_error([&] { (void)read(one + layer("Seite", kFlank)); },
               {"a second view is missing", "layer 'Seite' of no view"});
}

/// A drawing that cannot be meant so, and what the error says of it.
struct Broken {
  const char* name;
  std::string layers;
  std::vector<std::string> says;
};

std::vector<Broken> broken_drawings() {
  const std::string side = layer("view:side", kFlank);
  const auto front = [&](const std::string& inside) { return layer("view:front", inside) + side; };
  return {
      {"nothing", "", {"has no view"}},
      {"one view", layer("view:front", kSquare), {"a second view is missing"}},
      {"a view twice", front(kSquare) + layer("View:Side", kFlank), {"View:Side is drawn twice"}},
      {"an unknown view",
       front(kSquare) + layer("view:left", kFlank),
       {"unknown view 'view:left'"}},
      {"photo beside others",
       front(kSquare) + layer("view:photo", kFlank),
       {"view:photo and other"}},
      {"an empty view", layer("view:front", "") + side, {"view:front has no strokes"}},
      {"no silhouette", front(kFrontRim), {"there is no silhouette", "view front"}},
      {"two shapes",
       front(kSquare + path("other", "M30 30h20v20h-20z")),
       {"2 silhouettes", "view front"}},
      {"an open line", front(path("o", "M10 10h100v100")), {"open", "'o'"}},
      {"a point", front(path("p", "M10 10z")), {"'p'"}},
      {"a line back and forth", front(path("p", "M10 10h100h-100z")), {"'p'"}},
      {"a bow", front(path("bow", "M10 10l100 100v-100l-100 100z")), {"'bow'", "crosses itself"}},
      {"an eight of curves",
       front(path("eight", "M10 10C200 110 -80 110 110 10z")),
       {"'eight'", "crosses"}},
      {"yellow", front(kSquare + path("y", "M20 20h20", "yellow")), {"'y'"}},
      {"a gradient", front(kSquare + path("g", "M20 20h20", "url(#x)")), {"'g'"}},
      {"an unknown kind",
       front(kSquare + path("k", "M20 20h20", "red", "data-kind='hem'")),
       {"'k'", "hem"}},
      {"an unknown depth",
       front(kSquare + path("s", "M20 20h20", "red", "data-depth='left'")),
       {"'s'", "left"}},
      {"a fold of 120 degrees",
       front(kSquare + path("f", "M20 20h20", "green", "data-fold-angle='120'")),
       {"'f'", "120"}},
      {"a fold of no width",
       front(kSquare + path("f", "M20 20h20", "green", "data-fold-width='0'")),
       {"'f'"}},
      {"a broken number", front(path("n", "M10 10h1e")), {"'n'"}},
      {"a command of no path", front(path("n", "M10 10 Y 3")), {"'n'"}},
      {"no unit of that name",
       front(kSquare + path("f", "M20 20h20", "green", "data-fold-width='3ells'")),
       {"'f'"}},
      {"a side far too high",
       layer("view:front", kSquare) + layer("view:side", path("s", "M150 10h60v150h-60z")),
       {"view side", "along y"}},
      {"a silhouette without area",
       front(path("w", "M10 10h100v100l-100 -100z m0 0") + path("v", "M10 10 60 60 110 110z")),
       {"'v'"}},
      {"a transform of no inverse",
       front("<g transform='scale(0)'>" + kSquare + "</g>"),
       {"front"}},
      {"not a number", front(path("n", "M10 10h1e999v10z")), {"'n'"}},
      {"text for a path", front("<path id='t' d='hello' stroke='black'/>"), {"'t'"}},
      {"a border as a point", front(kSquare + path("b", "M10 10z", "blue")), {"'b'"}},
      {"a layer in another view",
       layer("view:front", kSquare + layer("view:front", kSquare)) + side,
       {"drawn twice"}},
      {"no end of the file", "<g id='view:front'>", {"box.svg"}},
  };
}

TEST_F(HandDrawn, RefusesBrokenDrawingsByName) {
  for (const Broken& broken : broken_drawings()) {
    SCOPED_TRACE(broken.name);
    std::string error;
    try {
      const Drawing aligned = align_views(read(broken.layers).drawing);
      (void)outlined_views(aligned);
    } catch (const Error& caught) {
      error = caught.what();
    }
    ASSERT_NE(error, "") << "it was read";
    for (const std::string& part : broken.says) EXPECT_THAT(error, HasSubstr(part));
    EXPECT_EQ(error.find('\n'), std::string::npos) << "one line: " << error;
  }
}

}  // namespace
}  // namespace geoprior::sketch
