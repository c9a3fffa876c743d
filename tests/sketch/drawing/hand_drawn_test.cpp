// Drawings by hand, which are put right and said to be; and drawings that are broken, each of which
// ends in one error or one warning that names the view and the stroke.
#include "experiments/sketch/hand/hand_drawn.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
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
std::string drawn_path(const std::string& id, const std::string& d,
                       const std::string& colour = "black", const std::string& more = "") {
  return "<path id='" + id + "' d='" + d + "' fill='none' stroke='" + colour + "' " + more + "/>\n";
}

std::string named_layer(const std::string& label, const std::string& inside,
                        const std::string& more = "") {
  return "<g inkscape:groupmode='layer' inkscape:label='" + label + "' id='" + label + "-layer' " +
         more + ">\n" + inside + "</g>\n";
}

// A box: front of 100 mm by 100 mm, side of 60 mm by 100 mm, their diagonals 141.4 and 116.6 mm.
const std::string kBoxFront = drawn_path("outline", "M10 10h100v100h-100z");
const std::string kBoxSide = drawn_path("flank", "M150 10h60v100h-60z");
const std::string kBoxFrontRim = drawn_path("rim", "M10 10h100", "blue");
const std::string kBoxSideRim = drawn_path("side-rim", "M150 10h60", "blue");

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
    return read(named_layer("view:front", inside) + named_layer("view:side", kBoxSide), options);
  }
  /// All that is said of a drawing until its views are put together.
  [[nodiscard]] std::vector<std::string> said_of(const std::string& layers) const {
    DrawingFile file = read(layers);
    const Drawing aligned = align_views(file.drawing, {}, &file.warnings);
    for (const std::string& doubt : doubtful_views(aligned)) file.warnings.push_back(doubt);
    return file.warnings;
  }
};

Eigen::Vector2d extent_of_stroke(const Stroke& stroke) {
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
  EXPECT_LT((extent_of_stroke(*outlines[0]) - Eigen::Vector2d(0.1, 0.1)).norm(), tolerance);
}

TEST_F(HandDrawn, SaysNothingOfWhatIsDrawnExactly) {
  const DrawingFile file = front(kBoxFront + kBoxFrontRim);
  EXPECT_THAT(file.warnings, IsEmpty());
  const Stroke& outline = file.drawing.find(ViewKind::front)->strokes.at(0);
  EXPECT_EQ(outline.points.size(), 4U);
}

TEST_F(HandDrawn, ClosesAnOpenEndAndSaysByHowMuch) {
  const DrawingFile file = front(drawn_path("outline", "M10 10h100v100h-100v-96"));
  expect_square(file, 0.003);
  EXPECT_THAT(file.warnings, ElementsAre(AllOf(HasSubstr("view:front"), HasSubstr("'outline'"),
                                               HasSubstr("2 mm (1.4 % of the view's diagonal)"))));
}

TEST_F(HandDrawn, NamesTheOptionForAWiderGap) {
  expect_error([&] { (void)front(drawn_path("outline", "M10 10h100v100h-100v-90")); },
               {"box.svg:3: path 'outline'", "gap of 10 mm", "at most 7.07 mm", "scene.read.snap"});
  DrawingFileOptions wide;
  wide.hand.snap = 0.1;
  EXPECT_EQ(front(drawn_path("outline", "M10 10h100v100h-100v-90"), wide).warnings.size(), 1U);
}

TEST_F(HandDrawn, LeavesOutALineThatWasDrawnTwice) {
  const DrawingFile file =
      front(kBoxFront + drawn_path("again", "M12 12l50 -1h45l2 97l-99 2l1 -96"));
  expect_square(file, 1e-9);
  EXPECT_THAT(file.warnings,
              ElementsAre(AllOf(HasSubstr("view:front"), HasSubstr("'again' lies along 'outline'"),
                                HasSubstr("% of the view's diagonal"))));
}

TEST_F(HandDrawn, CutsALineThatGoesOnBesideItsStart) {
  const DrawingFile file = front(drawn_path("outline", "M10 10h100v100h-100v-99l20 1"));
  expect_square(file, 0.003);
  EXPECT_THAT(file.warnings, Contains(HasSubstr("'outline' goes on along its own start")));
}

TEST_F(HandDrawn, CutsTheOverlapOfTwoStrokes) {
  const DrawingFile file =
      front(drawn_path("a", "M10 60v-50h100v50") + drawn_path("b", "M110.5 40v70h-101v-70"));
  expect_square(file, 0.003);
  EXPECT_THAT(file.warnings, Contains(HasSubstr("goes on along")));
}

TEST_F(HandDrawn, CutsLinesThatOvershoot) {
  const DrawingFile file =
      front(drawn_path("a", "M7 10h106") + drawn_path("b", "M110 8v105") +
            drawn_path("c", "M113 110h-106") + drawn_path("d", "M10 113v-106"));
  expect_square(file, 1e-9);
  EXPECT_EQ(file.warnings.size(), 4U);
  EXPECT_THAT(file.warnings, Contains(AllOf(HasSubstr("crosses"), HasSubstr("3 mm"))));
}

TEST_F(HandDrawn, LaysABorderOntoTheSilhouette) {
  const DrawingFile file = front(kBoxFront + drawn_path("rim", "M12 12l50 1l46 -2", "blue"));
  const Stroke& rim = *strokes_of(*file.drawing.find(ViewKind::front), StrokeKind::border).at(0);
  EXPECT_LT((extent_of_stroke(rim) - Eigen::Vector2d(0.1, 0)).norm(), 1e-9)
      << "from corner to corner";
  EXPECT_THAT(file.warnings,
              ElementsAre(AllOf(HasSubstr("border 'rim'"), HasSubstr("3 mm (2.1 %"))));
}

// Side drawn 4 % lower than the front.
TEST_F(HandDrawn, ScalesViewsThatDisagree) {
  const std::vector<std::string> said =
      said_of(named_layer("view:front", kBoxFront + kBoxFrontRim) +
              named_layer("view:side", drawn_path("flank", "M150 14h60v96h-60z") +
                                           drawn_path("r", "M150 14h60", "blue")));
  EXPECT_THAT(said, ElementsAre(AllOf(HasSubstr("view:side"), HasSubstr("along y"),
                                      HasSubstr("view:front"), HasSubstr("4 mm (4.2 %)"))));
  expect_error(
      [&] {
        (void)said_of(named_layer("view:front", kBoxFront) +
                      named_layer("view:side", drawn_path("flank", "M150 20h60v90h-60z")));
      },
      {"view side", "differs from that in view front", "scene.align.tolerance"});
}

TEST_F(HandDrawn, FairsTremorUnlessToldNotTo) {
  DrawingFileOptions options;
  options.tremor = TremorOptions{};
  const DrawingFile faired = front(kBoxFront, options);
  EXPECT_THAT(faired.warnings,
              Contains(AllOf(HasSubstr("view:front: stroke 'outline' trembles by"),
                             HasSubstr("moved by at most"), HasSubstr("corners kept"))));
  expect_square(faired, 0.004);
  options.hand.fairing = false;
  std::string raw;
  try {
    for (const std::string& said : front(kBoxFront, options).warnings) raw += said;
  } catch (const std::exception& error) {
    raw = error.what();
  }
  EXPECT_THAT(raw, Not(HasSubstr("faired")));
  options.hand.fairing = true;
  options.tremor->sigma = 0.03;
  options.hand.snap = 0.1;
  expect_error([&] { (void)front(kBoxFront, options); }, {"trembles by", "scene.read.noise"});
}

// What was silent.

TEST_F(HandDrawn, SaysThatABorderIsInOneViewOnly) {
  EXPECT_THAT(said_of(named_layer("view:front", kBoxFront + kBoxFrontRim) +
                      named_layer("view:side", kBoxSide)),
              ElementsAre(AllOf(HasSubstr("view:front: stroke 'rim' is a border"),
                                HasSubstr("view:side has none there"))));
  EXPECT_THAT(said_of(named_layer("view:front", kBoxFront) +
                      named_layer("view:side", kBoxSide + kBoxSideRim)),
              ElementsAre(HasSubstr("view:side: stroke 'side-rim' is a border")));
  EXPECT_THAT(said_of(named_layer("view:front", kBoxFront + kBoxFrontRim) +
                      named_layer("view:side", kBoxSide + kBoxSideRim)),
              IsEmpty());
}

TEST_F(HandDrawn, SaysThatAClosedSurfaceCannotBeLaidFlat) {
  EXPECT_THAT(said_of(named_layer("view:front", kBoxFront) + named_layer("view:side", kBoxSide)),
              ElementsAre(AllOf(HasSubstr("no view has a border or a seam"),
                                HasSubstr("the whole surface is one closed piece"))));
  EXPECT_THAT(said_of(named_layer("view:front", kBoxFront + drawn_path("cut", "M20 20v60", "red")) +
                      named_layer("view:side", kBoxSide)),
              IsEmpty());
}

TEST_F(HandDrawn, SaysThatAViewIsUpsideDown) {
  const std::string cone = drawn_path("cone", "M40 10h40l30 100h-100z"),
                    upright = drawn_path("flank", "M170 10h20l20 100h-60z"),
                    turned = drawn_path("flank", "M150 10h60l-20 100h-20z"),
                    seam = drawn_path("cut", "M60 20v60", "red");
  EXPECT_THAT(said_of(named_layer("view:front", cone + seam) + named_layer("view:side", upright)),
              IsEmpty());
  EXPECT_THAT(
      said_of(named_layer("view:front", cone + seam) + named_layer("view:side", turned)),
      ElementsAre(AllOf(HasSubstr("upside down"), HasSubstr("'cone'"), HasSubstr("'flank'"))));
  // Boxes have no up; their openings have.
  EXPECT_THAT(said_of(named_layer("view:front", kBoxFront + kBoxFrontRim) +
                      named_layer("view:side", kBoxSide + drawn_path("r", "M150 110h60", "blue"))),
              ElementsAre(HasSubstr("upside down")));
}

// The coat's and the tunic's openings are drawn in the front view only: that is one doubt each. The
// coat says its size in px, which is warned of when it is read.
TEST_F(HandDrawn, DoesNotDoubtTheDrawingsOfTheRepository) {
  const auto doubts_of = [](const std::string& name, bool px) {
    const DrawingFile file =
        read_drawing(std::string(GEOPRIOR_SOURCE_DIR) + "/experiments/sketch/" + name + ".svg", {});
    std::vector<std::string> warnings = file.warnings;
    const Drawing aligned = align_views(file.drawing, {}, &warnings);
    if (px) {
      EXPECT_THAT(warnings, ElementsAre(HasSubstr("says its size in px"))) << name;
    } else {
      EXPECT_THAT(warnings, IsEmpty()) << name;
    }
    return doubtful_views(aligned);
  };
  for (const char* name : {"boot", "hat-1", "hat-2", "hat-3", "purse"})
    EXPECT_THAT(doubts_of(name, false), IsEmpty()) << name;
  EXPECT_THAT(doubts_of("coat", true),
              ElementsAre(HasSubstr("view:front: stroke 'path-on-line-16' and 3 more are borders, "
                                    "and view:side has none")));
  EXPECT_THAT(doubts_of("tunic", false),
              ElementsAre(HasSubstr("view:front: stroke 'neck' and 3 more are borders, and "
                                    "view:side has none")));
}

TEST_F(HandDrawn, TakesLayersHoweverTheirNamesAreWritten) {
  const DrawingFile file =
      read(named_layer("View: Front", kBoxFront) + named_layer(" VIEW : side ", kBoxSide));
  EXPECT_EQ(file.drawing.views.size(), 2U);
  EXPECT_THAT(file.warnings, IsEmpty());
}

TEST_F(HandDrawn, NamesLayersThatAreNotRead) {
  const std::string one = named_layer("view:front", kBoxFront),
                    two = named_layer("view:side", kBoxSide);
  EXPECT_THAT(read(one + two + named_layer("notes", kBoxFront)).warnings,
              ElementsAre(AllOf(HasSubstr("1 shapes outside"), HasSubstr("'notes'"))));
  EXPECT_THAT(read(one + two + named_layer("guides", kBoxFront, "style='display:none'")).warnings,
              ElementsAre(HasSubstr("guides is hidden, and not read")));
  expect_error(
      [&] { (void)read(one + named_layer("view:side", kBoxSide, "style='display:none'")); },
      {"a second view is missing", "'view:side' hidden, and not read"});
  expect_error([&] { (void)read(one + named_layer("Seite", kBoxSide)); },
               {"a second view is missing", "layer 'Seite' of no view"});
}

/// A drawing that cannot be meant so, and what the error says of it.
struct BrokenDrawing {
  const char* name;
  std::string layers;
  std::vector<std::string> says;
};

std::vector<BrokenDrawing> drawings_with_broken_views() {
  const std::string side = named_layer("view:side", kBoxSide);
  const auto front = [&](const std::string& inside) {
    return named_layer("view:front", inside) + side;
  };
  return {
      {"nothing", "", {"has no view"}},
      {"one view", named_layer("view:front", kBoxFront), {"a second view is missing"}},
      {"a view twice",
       front(kBoxFront) + named_layer("View:Side", kBoxSide),
       {"View:Side is drawn twice"}},
      {"an unknown view",
       front(kBoxFront) + named_layer("view:left", kBoxSide),
       {"unknown view 'view:left'"}},
      {"photo beside others",
       front(kBoxFront) + named_layer("view:photo", kBoxSide),
       {"view:photo and other"}},
      {"an empty view", named_layer("view:front", "") + side, {"view:front has no strokes"}},
      {"no silhouette", front(kBoxFrontRim), {"there is no silhouette", "view front"}},
      {"two shapes",
       front(kBoxFront + drawn_path("other", "M30 30h20v20h-20z")),
       {"2 silhouettes", "view front"}},
      {"an open line", front(drawn_path("o", "M10 10h100v100")), {"open", "'o'"}},
      {"a point", front(drawn_path("p", "M10 10z")), {"'p'"}},
      {"a line back and forth", front(drawn_path("p", "M10 10h100h-100z")), {"'p'"}},
      {"a bow",
       front(drawn_path("bow", "M10 10l100 100v-100l-100 100z")),
       {"'bow'", "crosses itself"}},
      {"an eight of curves",
       front(drawn_path("eight", "M10 10C200 110 -80 110 110 10z")),
       {"'eight'", "crosses"}},
  };
}

std::vector<BrokenDrawing> drawings_with_broken_strokes() {
  const std::string side = named_layer("view:side", kBoxSide);
  const auto front = [&](const std::string& inside) {
    return named_layer("view:front", inside) + side;
  };
  return {
      {"yellow", front(kBoxFront + drawn_path("y", "M20 20h20", "yellow")), {"'y'"}},
      {"a gradient", front(kBoxFront + drawn_path("g", "M20 20h20", "url(#x)")), {"'g'"}},
      {"an unknown kind",
       front(kBoxFront + drawn_path("k", "M20 20h20", "red", "data-kind='hem'")),
       {"'k'", "hem"}},
      {"an unknown depth",
       front(kBoxFront + drawn_path("s", "M20 20h20", "red", "data-depth='left'")),
       {"'s'", "left"}},
      {"a fold of 120 degrees",
       front(kBoxFront + drawn_path("f", "M20 20h20", "green", "data-fold-angle='120'")),
       {"'f'", "120"}},
      {"a fold of no width",
       front(kBoxFront + drawn_path("f", "M20 20h20", "green", "data-fold-width='0'")),
       {"'f'"}},
      {"a broken number", front(drawn_path("n", "M10 10h1e")), {"'n'"}},
      {"a command of no path", front(drawn_path("n", "M10 10 Y 3")), {"'n'"}},
      {"no unit of that name",
       front(kBoxFront + drawn_path("f", "M20 20h20", "green", "data-fold-width='3ells'")),
       {"'f'"}},
      {"a side far too high",
       named_layer("view:front", kBoxFront) +
           named_layer("view:side", drawn_path("s", "M150 10h60v150h-60z")),
       {"view side", "along y"}},
      {"a silhouette without area",
       front(drawn_path("w", "M10 10h100v100l-100 -100z m0 0") +
             drawn_path("v", "M10 10 60 60 110 110z")),
       {"'v'"}},
      {"a transform of no inverse",
       front("<g transform='scale(0)'>" + kBoxFront + "</g>"),
       {"'outline'", "has no length"}},
      {"not a number", front(drawn_path("n", "M10 10h1e999v10z")), {"'n'"}},
      {"text for a path", front("<path id='t' d='hello' stroke='black'/>"), {"'t'"}},
      {"a border as a point", front(kBoxFront + drawn_path("b", "M10 10z", "blue")), {"'b'"}},
      {"a layer in another view",
       named_layer("view:front", kBoxFront + named_layer("view:front", kBoxFront)) + side,
       {"drawn twice"}},
      {"no end of the file", "<g id='view:front'>", {"box.svg"}},
  };
}

TEST_F(HandDrawn, RefusesBrokenDrawingsByName) {
  std::vector<BrokenDrawing> all = drawings_with_broken_views();
  for (BrokenDrawing& more : drawings_with_broken_strokes()) all.push_back(std::move(more));
  for (const BrokenDrawing& broken : all) {
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
