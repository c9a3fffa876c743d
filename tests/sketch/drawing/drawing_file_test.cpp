// Drawings as people make them: colours or classes, strokes that do not quite meet, views in
// layers.

#include "experiments/sketch/drawing/drawing_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "experiments/sketch/drawing/drawn_stroke.h"
#include "experiments/sketch/drawing/stroke_kinds.h"
#include "experiments/sketch/drawing/view_picture.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::sketch {
namespace {

using geoprior::test::expect_error;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kMm = 1e-3;

const std::string kBlack = " style='fill:none;stroke:#000000'";
/// A square of 40 mm.
const std::string kOutline = "<path id='outline' d='M10 10h40v40h-40z'" + kBlack + "/>";

std::string layer(const std::string& view, const std::string& inside) {
  return "<g inkscape:groupmode='layer' inkscape:label='view:" + view + "' id='layer-" + view +
         "'>\n" + inside + "\n</g>\n";
}

const std::string kSide = layer("side", "<path id='flank' d='M60 10h20v40h-20z'" + kBlack + "/>");

class DrawingFileTest : public geoprior::test::ScratchFolder {
 protected:
  /// A page of 100 mm x 60 mm with a millimetre as unit.
  DrawingFile read(const std::string& layers, const DrawingFileOptions& options = {},
                   const std::string& root = "width='100mm' height='60mm'") const {
    const auto file =
        write("boot.svg",
              "<svg xmlns='http://www.w3.org/2000/svg' "
              "xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' viewBox='0 0 100 60' " +
                  root + ">\n" + layers + "</svg>\n");
    return read_drawing(file, options);
  }
  /// Of a front view beside the side view.
  View front(const std::string& inside) const {
    const DrawingFile read_file = read(layer("front", inside) + kSide);
    return *read_file.drawing.find(ViewKind::front);
  }
  /// Lines 3, 4, … of the file are those of `inside`.
  void refuse(const std::string& inside, std::initializer_list<std::string> parts) const {
    expect_error([&] { front(inside); }, parts);
  }
};

/// Twice the enclosed area (mm²), positive when counter-clockwise.
double twice_area_mm2(const Stroke& stroke) {
  double sum = 0;
  for (std::size_t i = 0; i < stroke.points.size(); ++i) {
    const Eigen::Vector2d &a = stroke.points[i], &b = stroke.points[(i + 1) % stroke.points.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum / (kMm * kMm);
}

TEST_F(DrawingFileTest, ReadsViewsInMetresWithYUp) {
  const DrawingFile file = read(kSide + layer("front", kOutline));
  EXPECT_THAT(file.warnings, IsEmpty());
  EXPECT_THAT(file.inputs, ElementsAre(folder() / "boot.svg"));
  ASSERT_EQ(file.drawing.views.size(), 2U);
  EXPECT_EQ(file.drawing.views[0].kind, ViewKind::front) << "in the order of the kinds";
  const Stroke& outline = file.drawing.views[0].strokes.at(0);
  EXPECT_EQ(outline.id, "outline");
  EXPECT_EQ(outline.kind, StrokeKind::silhouette);
  EXPECT_TRUE(outline.closed);
  ASSERT_EQ(outline.points.size(), 4U);
  EXPECT_NEAR(twice_area_mm2(outline), 2 * 1600, 1e-6) << "counter-clockwise";
  EXPECT_NEAR(length(outline), 160 * kMm, 1e-12);
  for (const Eigen::Vector2d& p : outline.points) {
    EXPECT_TRUE(std::abs(p.y() - 50 * kMm) < 1e-12 || std::abs(p.y() - 10 * kMm) < 1e-12);
  }
}

TEST_F(DrawingFileTest, KnowsEveryKindByColourClassAndName) {
  for (const StrokeKindRow& row : stroke_kinds()) {
    EXPECT_EQ(row_of(row.kind).name, row.name);
    if (row.kind == StrokeKind::silhouette) continue;
    const std::string name(row.name);
    const std::string line = "<line id='sym-a' x1='20' y1='20' x2='30' y2='30' ";
    std::vector<std::string> ways{"data-kind='" + name + "'", "class='a " + name + "'",
                                  "stroke='red' class='" + name + "'"};
    for (const SvgColour& colour : row.colours) {
      ways.push_back("style='stroke:" + to_text(colour) +
                     (row.dashed ? ";stroke-dasharray:2,2'" : "'"));
    }
    for (const std::string& way : ways) {
      const View view = front(kOutline + line + way + "/>");
      ASSERT_EQ(view.strokes.size(), 2U) << way;
      EXPECT_EQ(view.strokes[1].kind, row.kind) << way;
      EXPECT_EQ(view.strokes[1].points.size(), 2U);
    }
  }
}

TEST_F(DrawingFileTest, TakesColoursNearTheTable) {
  EXPECT_EQ(kind_of_colour({212, 0, 0}, false), StrokeKind::seam) << "Inkscape's #d40000";
  EXPECT_EQ(kind_of_colour({35, 31, 32}, false), StrokeKind::silhouette) << "Illustrator's black";
  EXPECT_EQ(kind_of_colour({128, 128, 128}, false), std::nullopt) << "grey lines are dashed";
  EXPECT_EQ(kind_of_colour({255, 255, 0}, false), std::nullopt);
}

// Whichever colours stand in the table, one that is near to two kinds would be read by chance.
TEST(StrokeKinds, HaveColoursApart) {
  for (const StrokeKindRow& row : stroke_kinds()) {
    for (const SvgColour& colour : row.colours) {
      for (const int change : {-48, 48}) {
        const auto moved = [&](int c) {
          return static_cast<std::uint8_t>(std::clamp(c + change, 0, 255));
        };
        EXPECT_EQ(
            kind_of_colour({moved(colour.red), moved(colour.green), moved(colour.blue)}, true),
            row.kind);
      }
    }
  }
}

TEST_F(DrawingFileTest, ReadsAttributesOfStrokesAndGroups) {
  const View view = front(
      kOutline +
      "<g data-panel='toe' data-depth='back'><path id='s' d='M20 20 30 30' stroke='red'/>"
      "<path id='f' d='M20 30 30 20' stroke='green' data-depth='front' data-fold-angle='45' "
      "data-fold-width='0.5cm'/></g><g class='seam'><path d='M20 30 30 20' stroke='black'/></g>"
      "<path d='M1 1 2 2' stroke='green' data-fold-width='7'/>");
  ASSERT_EQ(view.strokes.size(), 5U);
  EXPECT_EQ(view.strokes[1].name, "toe");
  EXPECT_EQ(view.strokes[1].side, DepthSide::back);
  EXPECT_EQ(view.strokes[2].side, DepthSide::front);
  EXPECT_EQ(view.strokes[2].fold_angle_deg, 45);
  EXPECT_NEAR(view.strokes[2].fold_width.value(), 5 * kMm, 1e-15);
  EXPECT_EQ(view.strokes[3].kind, StrokeKind::seam);
  EXPECT_EQ(view.strokes[3].id, "path-on-line-3");
  EXPECT_NEAR(view.strokes[4].fold_width.value(), 7 * kMm, 1e-15);
  EXPECT_EQ(view.strokes[4].fold_angle_deg, std::nullopt);
}

TEST_F(DrawingFileTest, ReadsTheAnnotationsOfAPhoto) {
  const DrawingFile file =
      read(layer("photo",
                 "<path id='path12' inkscape:label='pair-3' d='M10 10 30 12' stroke='magenta'/>"
                 "<line id='sym-a' x1='10' y1='10' x2='10' y2='30' stroke='orange'/>"
                 "<line data-name='sym-b' x1='10' y1='10' x2='20' y2='15' stroke='#ffa500'/>"
                 "<path id='side' d='M10 10 10 40' stroke='black'/>"
                 "<path d='M5 5 25 5' stroke='#888' stroke-dasharray='4'/>"));
  const View& view = file.drawing.views.at(0);
  ASSERT_EQ(view.strokes.size(), 5U);
  EXPECT_EQ(view.strokes[0].name, "pair-3");
  EXPECT_EQ(view.strokes[1].name, "sym-a");
  EXPECT_EQ(view.strokes[2].name, "sym-b");
  EXPECT_EQ(view.strokes[3].kind, StrokeKind::silhouette);
  EXPECT_FALSE(view.strokes[3].closed) << "a straight silhouette is a ruling";
  EXPECT_EQ(view.strokes[4].kind, StrokeKind::occlusion);
}

// An edge of a layer is called by its own name, its panel, its label, or a layer of the drawing
// program in which nothing else lies.
TEST_F(DrawingFileTest, NamesTheEdgesOfRigidLayers) {
  const auto within = [](const std::string& label, const std::string& inside) {
    return "<g inkscape:groupmode='layer' inkscape:label='" + label + "'>" + inside + "</g>";
  };
  const auto arc = [](const std::string& id, const std::string& more) {
    return "<path id='" + id + "' " + more + " stroke='#800080' d='M1 1 2 2 3 1 5 4'/>";
  };
  const DrawingFile file = read(
      layer("photo", arc("a", "data-name='head'") + arc("b", "data-panel='neck'") +
                         within("back", arc("c", "")) + within("two", arc("d", "") + arc("e", "")) +
                         arc("f", "inkscape:label='tail'") +
                         "<line id='sym-a' x1='10' y1='10' x2='10' y2='30' stroke='orange'/>"
                         "<line id='sym-b' x1='10' y1='10' x2='20' y2='15' stroke='#ffa500'/>"));
  std::vector<std::string> names;
  for (const Stroke& stroke : file.drawing.views.at(0).strokes) names.push_back(stroke.name);
  EXPECT_THAT(names, ElementsAre("head", "neck", "back", "", "", "tail", "sym-a", "sym-b"));
}

TEST_F(DrawingFileTest, TakesTheScaleOfTheFileOrTheOption) {
  const std::string layers = layer("front", kOutline) + kSide;
  const auto perimeter = [](const DrawingFile& file) {
    return length(file.drawing.views[0].strokes[0]);
  };
  EXPECT_NEAR(perimeter(read(layers, {}, "width='100mm' data-scale='1:5'")), 0.8, 1e-12);
  const DrawingFile px = read(layers, {}, "width='100' height='60'");
  EXPECT_NEAR(perimeter(px), 160 * 0.0254 / 96, 1e-12);
  EXPECT_THAT(px.warnings, ElementsAre(HasSubstr("in px, of which 96")));
  DrawingFileOptions centimetre;
  centimetre.unit_m = 0.01;
  const DrawingFile given = read(layers, centimetre, "width='100' height='60'");
  EXPECT_NEAR(perimeter(given), 1.6, 1e-12);
  EXPECT_THAT(given.warnings, IsEmpty());
}

// Strokes as hands draw them.

// Four sides, drawn this way and that, in no order; a corner of each is 0.1 mm off.
TEST_F(DrawingFileTest, JoinsStrokesEndToEndIntoASilhouette) {
  const View view =
      front("<path id='a' d='M10 10 50 10.1'" + kBlack + "/><path id='b' d='M10 50 50 50'" +
            kBlack + "/><path id='c' d='M50 10 50.1 50'" + kBlack +
            "/><path id='d' d='M10 10 10 49.9'" + kBlack + "/>");
  ASSERT_EQ(view.strokes.size(), 1U);
  const Stroke& outline = view.strokes[0];
  EXPECT_TRUE(outline.closed);
  EXPECT_EQ(outline.id, "a+c+b+d");
  ASSERT_EQ(outline.points.size(), 4U);
  EXPECT_NEAR(twice_area_mm2(outline), 2 * 1600, 20);
  EXPECT_GT(twice_area_mm2(outline), 0);
}

TEST_F(DrawingFileTest, ClosesWhatNearlyCloses) {
  // Square of 40 mm: the diagonal is 56.6 mm, so that gaps of 0.28 mm are closed.
  const View closed = front("<path d='M10 10h40v40h-40v-39.8'" + kBlack +
                            "/><path d='M20 20h10v10h-10v-9.9' stroke='red'/>"
                            "<path d='M20 20h10v10h-10v-9' stroke='red'/>");
  ASSERT_EQ(closed.strokes.size(), 3U);
  EXPECT_TRUE(closed.strokes[0].closed);
  EXPECT_EQ(closed.strokes[0].points.size(), 4U);
  EXPECT_TRUE(closed.strokes[1].closed);
  EXPECT_FALSE(closed.strokes[2].closed) << "a seam may be open";
}

TEST_F(DrawingFileTest, LeavesOutPointsThatRepeat) {
  const View view = front("<path d='M10 10h40h0l1e-9 0v40h-40l0 0v-40z'" + kBlack + "/>");
  EXPECT_EQ(view.strokes[0].points.size(), 4U);
}

TEST_F(DrawingFileTest, ReadsSeveralLinesOfOnePath) {
  const View view = front(kOutline + "<path id='s' d='M20 20 30 30M20 30 30 20' stroke='red'/>");
  ASSERT_EQ(view.strokes.size(), 3U);
  EXPECT_EQ(view.strokes[1].id, "s/1");
  EXPECT_EQ(view.strokes[2].id, "s/2");
}

TEST_F(DrawingFileTest, SaysWhatItLeavesOut) {
  const DrawingFile file =
      read("<path d='M0 0 1 1' stroke='red'/>" +
           layer("front", kOutline + "<rect width='9' height='9' fill='white'/>"
                                     "<path d='M0 0 1 1' stroke='yellow' data-kind='none'/>") +
           kSide + "<g inkscape:label='view:top' style='display:none'/>");
  EXPECT_THAT(file.warnings,
              ElementsAre(HasSubstr("view:top is hidden"), HasSubstr("1 shapes outside"),
                          HasSubstr("1 shapes of the views have no stroke")));
}

// Layers of other programs.
TEST_F(DrawingFileTest, FindsViewsByTheIdsOfGroups) {
  const DrawingFile file = read("<g id='view_x3A_front'>" + kOutline +
                                "</g><g id='view:top'><g class='st0'>" + kOutline + "</g></g>");
  EXPECT_EQ(file.drawing.views.size(), 2U);
}

// What is wrong, and where.

TEST_F(DrawingFileTest, NamesViewsThatAreMissingDoubleOrUnknown) {
  const std::string one = layer("front", kOutline);
  expect_error([&] { read(kOutline); }, {"boot.svg: has no view", "view:photo"});
  expect_error([&] { read("<g inkscape:groupmode='layer' inkscape:label='front'/>"); },
               {"has no view: its layers are front"});
  expect_error([&] { read("<g id='view:front' display='none'/>"); }, {"every view is hidden"});
  expect_error([&] { read(one); }, {"a second view is missing", "only view:front"});
  expect_error([&] { read(one + layer("photo", kOutline)); }, {"view:photo and other views"});
  expect_error([&] { read(one + one); },
               {"boot.svg:5: layer 'layer-front'", "view:front is drawn twice", "line 2"});
  expect_error([&] { read(layer("back", kOutline)); },
               {"boot.svg:2: layer 'layer-back'", "unknown view 'view:back'", "view:side"});
  expect_error([&] { read(one + layer("side", "")); }, {"view:side has no strokes"});
}

TEST_F(DrawingFileTest, NamesTheStrokeOfAnUnknownKind) {
  const std::string line = "\n<path id='x' d='M20 20 30 30' ";
  refuse(kOutline + line + "stroke='#ffff00'/>",
         {"boot.svg:4: path 'x'", "unknown kind", "#ffff00", "seam red"});
  refuse(kOutline + line + "data-kind='dart'/>",
         {"path 'x': data-kind", "'dart'", "symmetric-pair"});
  refuse(kOutline + line + "class='seam fold'/>", {"path 'x'", "two kinds", "seam, fold"});
  refuse(kOutline + line + "stroke='url(#a)'/>", {"path 'x'", "no single one"});
  refuse(kOutline + line + "stroke='red' data-depth='behind'/>",
         {"path 'x': data-depth", "front, back, both"});
  refuse(kOutline + line + "stroke='green' data-fold-angle='120'/>",
         {"path 'x': data-fold-angle", "0 to 90"});
  refuse(kOutline + line + "stroke='green' data-fold-width='0'/>", {"path 'x': data-fold-width"});
  refuse(kOutline + line + "stroke='green' data-fold-width='2miles'/>",
         {"path 'x': data-fold-width", "miles"});
}

TEST_F(DrawingFileTest, NamesTheCrossingOfASilhouette) {
  // A bow: its diagonals cross in its middle, (30, 60 - 30) mm.
  refuse("<path id='bow' d='M10 10 50 50 50 10 10 50z'" + kBlack + "/>",
         {"boot.svg:3: path 'bow'", "crosses itself at x 30 mm, y 30 mm", "lower left"});
  // A needle: the line goes to (70, 10) mm on the page and back over itself to (50, 10).
  refuse("<path id='needle' d='M10 10h60h-20v40h-40z'" + kBlack + "/>",
         {"path 'needle'", "crosses itself at x 50 mm, y 50 mm"});
  // A loop that touches itself in a point.
  refuse("<path id='touch' d='M10 10h40v40h-20l-20 -20l-5 5l0 0z m0 0'" + kBlack +
             "/><path id='eight' d='M10 10 L30 30 L50 10 L50 50 L30 30 L10 50z'" + kBlack + "/>",
         {"path 'eight'", "x 30 mm, y 30 mm"});
}

TEST_F(DrawingFileTest, NamesTheGapOfASilhouette) {
  refuse("<path id='a' d='M10 10h40v40'" + kBlack + "/>\n<path id='b' d='M10 12v38h38'" + kBlack +
             "/>",
         {"boot.svg:3: path 'a'", "open", "end of 'a' at x 50 mm, y 10 mm",
          "'b' at x 48 mm, y 10 mm", "gap of 2 mm", "at most 0.283 mm"});
  refuse("<path id='u' d='M10 10v40h40v-40'" + kBlack + "/>", {"path 'u'", "gap of 40 mm"});
}

TEST_F(DrawingFileTest, NamesWhatHasNoLengthOrNoArea) {
  refuse(kOutline + "<path id='x' d='M20 20z' stroke='red'/>",
         {"path 'x'", "no length", "x 20 mm, y 40 mm"});
  refuse(kOutline + "<line id='x' x1='1' x2='1' stroke='red'/>", {"line 'x'", "no length"});
  refuse(kOutline + "<path id='x' d='' stroke='red'/>", {"path 'x'", "draws nothing"});
  refuse(kOutline + "<path id='x' d='M1 1 2 2M5 5h0' stroke='red'/>",
         {"path 'x', part 2", "no length"});
  refuse("<path id='x' d='M10 10 50 50z'" + kBlack + "/>", {"path 'x'", "open"});
}

TEST_F(DrawingFileTest, NamesPairsAndVectorsThatAreNoLines) {
  refuse(kOutline + "<path id='p' d='M1 1 2 2 3 1' stroke='magenta'/>",
         {"path 'p'", "symmetric-pair", "3 points"});
  refuse(kOutline + "<path id='v' d='M1 1 2 2' stroke='orange'/>",
         {"plane-vector 'v'", "named 'v'", "sym-a, sym-b"});
  refuse(kOutline +
             "<path id='sym-a' d='M1 1 2 2' stroke='orange'/>"
             "<path id='w' data-name='sym-a' d='M1 1 2 2' stroke='orange'/>",
         {"'w'", "sym-a is drawn twice", "'sym-a'"});
}

TEST_F(DrawingFileTest, PassesOnWhatTheFileGetsWrong) {
  refuse(kOutline + "\n<path id='x' d='M20 20 L' stroke='red'/>",
         {"boot.svg:4: path 'x': d, character", "number is missing"});
  refuse("<image id='i' width='1' height='1' href='../photo.png'/>",
         {"image 'i'", "folder of the drawing"});
  const auto file = write("entity.svg", "<!DOCTYPE svg [<!ENTITY e SYSTEM 'boot.svg'>]><svg/>");
  expect_error([&] { read_drawing(file, {}); }, {"entity.svg:1", "never read"});
}

TEST_F(DrawingFileTest, LimitsStrokesAndPoints) {
  std::string many = "<path id='a' d='M0 0 1 1'" + kBlack + "/>";
  for (int i = 0; i < kMostViewStrokes; ++i) many += "<path d='M0 0 1 1' class='seam'/>";
  refuse(many, {"boot.svg: view:front", "5001 strokes", "at most 5000"});
  std::string d = "M0 0";
  for (std::size_t i = 0; i <= kMostStrokePoints; ++i) d += i % 2 == 0 ? "l1 1" : "l1-1";
  refuse(kOutline + "<path id='long' d='" + d + "' stroke='red'/>",
         {"path 'long'", "20002 points", "tolerance"});
}

// Pictures.

/// The head of a PNG of 200 x 100 pixels.
std::string png_head() {
  std::string bytes = "\x89PNG\r\n\x1a\n";
  bytes += std::string("\0\0\0\rIHDR\0\0\0\xc8\0\0\0\x64\x08\x02\0\0\0", 21);
  return bytes;
}

TEST(PictureSize, IsInTheHeadOfPngAndJpeg) {
  EXPECT_EQ(picture_size(png_head()), Eigen::Vector2i(200, 100));
  for (std::size_t n = 0; n < 24; ++n)
    EXPECT_EQ(picture_size(png_head().substr(0, n)), std::nullopt);
  // Start, a comment of 2 bytes, a filling byte, a baseline frame of 3 x 2 with 8 bits.
  const std::string jpeg("\xff\xd8\xff\xfe\0\x04hi\xff\xff\xc0\0\x0b\x08\0\x02\0\x03\x01\x01\x11\0",
                         22);
  EXPECT_EQ(picture_size(jpeg), Eigen::Vector2i(3, 2));
  for (std::size_t n = 0; n < 18; ++n) EXPECT_EQ(picture_size(jpeg.substr(0, n)), std::nullopt);
  EXPECT_EQ(picture_size("GIF89a"), std::nullopt);
}

TEST_F(DrawingFileTest, PlacesThePictureWhereItIsSeen) {
  write("bag.png", png_head());
  const auto picture = [&](const std::string& attributes) {
    const DrawingFile file = read(layer("photo", "<image x='10' y='10' " + attributes +
                                                     "/><path d='M0 0 9 9' "
                                                     "stroke='cyan'/>"));
    return std::pair(file.drawing.views.at(0).picture, file.inputs.size());
  };
  const auto [stretched, inputs] =
      picture("width='40' height='40' href='bag.png' preserveAspectRatio='none'");
  EXPECT_EQ(stretched.file, (folder() / "bag.png").string());
  EXPECT_EQ(inputs, 2U);
  EXPECT_NEAR((stretched.origin - Eigen::Vector2d(10, 10) * kMm).norm(), 0, 1e-12);
  EXPECT_NEAR((stretched.size - Eigen::Vector2d(40, 40) * kMm).norm(), 0, 1e-12);
  // 200 x 100 pixels in a square: 40 x 20 mm in its middle, or at its upper side.
  const Picture middle = picture("width='40' height='40' href='bag.png'").first;
  EXPECT_NEAR((middle.origin - Eigen::Vector2d(10, 20) * kMm).norm(), 0, 1e-12);
  EXPECT_NEAR((middle.size - Eigen::Vector2d(40, 20) * kMm).norm(), 0, 1e-12);
  const Picture top =
      picture("width='40' height='40' href='bag.png' preserveAspectRatio='xMidYMin'").first;
  EXPECT_NEAR((top.origin - Eigen::Vector2d(10, 30) * kMm).norm(), 0, 1e-12);
}

TEST_F(DrawingFileTest, KeepsAnEmbeddedPicture) {
  // The first 24 bytes of a PNG of 1 x 1.
  const DrawingFile file =
      read(layer("photo",
                 "<image width='10' height='10' "
                 "href='data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAAB'/>"
                 "<path d='M0 0 9 9' stroke='cyan'/>"));
  const Picture& picture = file.drawing.views.at(0).picture;
  EXPECT_TRUE(picture.file.empty());
  EXPECT_EQ(picture_size(picture.content), Eigen::Vector2i(1, 1));
  EXPECT_EQ(file.inputs.size(), 1U);
}

TEST_F(DrawingFileTest, NamesThePictureThatCannotBeRead) {
  write("bag.png", png_head());
  write("text.png", "no picture");
  const auto refuse_picture = [&](const std::string& attributes,
                                  std::initializer_list<std::string> parts) {
    expect_error(
        [&] {
          read(layer("photo", "<image id='i' width='9' height='9' " + attributes +
                                  "/><path d='M0 0 9 9' stroke='cyan'/>"));
        },
        parts);
  };
  refuse_picture("href='none.png'", {"boot.svg:3: image 'i'", "cannot be read", "none.png"});
  refuse_picture("href='text.png'", {"image 'i'", "neither PNG nor JPEG"});
  refuse_picture("href='bag.png' transform='rotate(10)'", {"image 'i'", "turned or mirrored"});
  refuse_picture("href='bag.png' transform='scale(-1 1)'", {"image 'i'", "turned or mirrored"});
  refuse_picture("href='bag.png' preserveAspectRatio='xMidYMid slice'", {"image 'i'", "cut off"});
  refuse_picture("href='bag.png'/><image id='j' width='9' height='9' href='bag.png'",
                 {"image 'j'", "a second picture of view:photo"});
}

TEST(DrawingKeys, ListEveryKindAndAttribute) {
  const TopicFile file = drawing_keys();
  EXPECT_EQ(file.name, "drawing");
  EXPECT_EQ(file.keys.size(), stroke_kinds().size() + 9);
  EXPECT_EQ(file.keys.at(3).key, "fold");
  EXPECT_EQ(file.keys.at(3).range, "green");
}

}  // namespace
}  // namespace geoprior::sketch
