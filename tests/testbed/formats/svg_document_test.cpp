// Drawings as programs write them, and drawings that must not be believed. Known answers are those
// of the formats' texts: 1 in = 25.4 mm = 96 px = 72 pt = 6 pc.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "testbed/formats/svg/document.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using test::expect_error;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kMm = 1e-3;
constexpr double kClose = 1e-12;

class SvgFile : public test::ScratchFolder {
 protected:
  SvgDocument read(const std::string& text, const SvgReadOptions& options = {}) const {
    return read_svg_document(write("drawing.svg", text), options);
  }
  /// Inside of a page of 100 mm x 50 mm, with a millimetre as unit.
  SvgDocument on_page(const std::string& inside, const SvgReadOptions& options = {}) const {
    return read(
        "<svg xmlns='http://www.w3.org/2000/svg' "
        "xmlns:xlink='http://www.w3.org/1999/xlink' width='100mm' height='50mm' "
        "viewBox='0 0 100 50'>\n" +
            inside + "\n</svg>",
        options);
  }
  void refuse(const std::string& inside, std::initializer_list<std::string> parts) const {
    expect_error([&] { on_page(inside); }, parts);
  }
};

std::string repeat(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

void expect_point(const Eigen::Vector2d& point, double x_mm, double y_mm) {
  EXPECT_NEAR(point.x(), x_mm * kMm, kClose);
  EXPECT_NEAR(point.y(), y_mm * kMm, kClose);
}

/// The ends of the only line of a drawing.
void expect_line(const SvgDocument& document, double x0, double y0, double x1, double y1) {
  ASSERT_EQ(document.shapes.size(), 1U);
  ASSERT_EQ(document.shapes[0].lines.size(), 1U);
  expect_point(document.shapes[0].lines[0].points.front(), x0, y0);
  expect_point(document.shapes[0].lines[0].points.back(), x1, y1);
}

const std::string kLine = "<line x1='10' y1='10' x2='30' y2='10'/>";

// The page.

TEST_F(SvgFile, MeasuresThePageInEveryUnit) {
  for (const char* width : {"127mm", "12.7cm", "508Q", "5in", "360pt", "30pc", "480px", "480"}) {
    const SvgDocument d = read("<svg width='" + std::string(width) + "' height='480'/>");
    EXPECT_NEAR(d.width_m, 0.127, kClose) << width;
    EXPECT_NEAR(d.height_m, 0.127, kClose);
    EXPECT_EQ(d.true_size, std::string(width).find("480") != 0) << width;
  }
}

TEST_F(SvgFile, TurnsThePageUpright) {
  const SvgDocument d = on_page(kLine);
  EXPECT_NEAR(d.width_m, 100 * kMm, kClose);
  EXPECT_NEAR(d.height_m, 50 * kMm, kClose);
  expect_line(d, 10, 40, 30, 40);
}

TEST_F(SvgFile, FitsTheViewBox) {
  const auto of = [&](const std::string& attributes) {
    return read("<svg width='100mm' height='50mm' " + attributes +
                "><line x2='10' y2='10'/></svg>");
  };
  // A square of 10 units in 100 mm x 50 mm: inside and in the middle, at the left, over it all.
  expect_line(of("viewBox='0 0 10 10'"), 25, 50, 75, 0);
  expect_line(of("viewBox='0 0 10 10' preserveAspectRatio='xMinYMid meet'"), 0, 50, 50, 0);
  expect_line(of("viewBox='0 0 10 10' preserveAspectRatio='xMidYMax slice'"), 0, 100, 100, 0);
  expect_line(of("viewBox='0 0 10 10' preserveAspectRatio='none'"), 0, 50, 100, 0);
  expect_line(of("viewBox='-10,-10,20,20' preserveAspectRatio='none'"), 50, 25, 100, 0);
}

TEST_F(SvgFile, TakesTheSizeOfTheViewBoxWhereThePageHasNone) {
  const SvgDocument d =
      read("<svg width='100%' viewBox='0 0 960 480'><line x2='96' y2='0'/></svg>");
  EXPECT_NEAR(d.width_m, 254 * kMm, kClose);
  EXPECT_FALSE(d.true_size);
  expect_line(d, 0, 127, 25.4, 127);
  EXPECT_NEAR(read("<svg height='50mm' viewBox='0 0 20 10'/>").width_m, 100 * kMm, kClose);
}

TEST_F(SvgFile, EnlargesToTrueSize) {
  const std::string line = "<line x2='10' y2='10'/></svg>";
  const std::string page = "<svg width='100mm' height='50mm' viewBox='0 0 100 50' data-scale=";
  expect_line(read(page + "'10'>" + line), 0, 500, 100, 400);
  expect_line(read(page + "'1:10'>" + line), 0, 500, 100, 400);
  SvgReadOptions metre;
  metre.unit_m = 1;
  expect_line(read(page + "'10'>" + line, metre), 0, 50000, 10000, 40000);
  expect_error([&] { read(page + "'0'>" + line); }, {"drawing.svg:1: svg: data-scale", "1:10"});
}

// Transforms.

TEST_F(SvgFile, AppliesEveryTransform) {
  const auto moved = [&](const std::string& transform) {
    return on_page("<line x1='10' y1='10' x2='30' y2='10' transform='" + transform + "'/>");
  };
  expect_line(moved("translate(5)"), 15, 40, 35, 40);
  expect_line(moved("translate(5,-5)"), 15, 45, 35, 45);
  expect_line(moved("scale(2)"), 20, 30, 60, 30);
  expect_line(moved("scale(2 -1)"), 20, 60, 60, 60);
  expect_line(moved("rotate(90)"), -10, 40, -10, 20);
  expect_line(moved("rotate(180 20 10)"), 30, 40, 10, 40);
  expect_line(moved("skewX(45)"), 20, 40, 40, 40);
  expect_line(moved("skewY(45)"), 10, 30, 30, 10);
  expect_line(moved("matrix(0 1 -1 0 20 0)"), 10, 40, 10, 20);
  expect_line(moved("translate(5) , scale(2)rotate(90)"), -15, 30, -15, -10);
}

TEST_F(SvgFile, NestsTransforms) {
  expect_line(on_page("<g transform='translate(10,0)'><g transform='scale(.5)'><svg x='4' y='8' "
                      "width='20' height='20' viewBox='0 0 40 40'>" +
                      kLine + "</svg></g></g>"),
              10 + (4 + 5) / 2.0, 50 - (8 + 5) / 2.0, 10 + (4 + 15) / 2.0, 50 - (8 + 5) / 2.0);
}

// Shapes.

// rotate, skew-free scale by 2: a circle of radius 8 mm about (60 - 2 * 10, 50 - 2 * 20) mm.
TEST_F(SvgFile, KeepsCentreAndRadiusOfATransformedCircle) {
  SvgReadOptions fine;
  fine.tolerance = 1e-6;
  const SvgDocument d = on_page(
      "<circle cx='20' cy='10' r='4' transform='translate(60 0) rotate(90) scale(2)'/>", fine);
  ASSERT_EQ(d.shapes.size(), 1U);
  const SvgSubpath& circle = d.shapes[0].lines.at(0);
  EXPECT_TRUE(circle.closed);
  const Eigen::Vector2d centre = Eigen::Vector2d(40, 10) * kMm;
  for (std::size_t i = 0; i < circle.points.size(); ++i) {
    EXPECT_NEAR((circle.points[i] - centre).norm(), 8 * kMm, kClose);
    const Eigen::Vector2d& next = circle.points[(i + 1) % circle.points.size()];
    EXPECT_GE(((circle.points[i] + next) / 2 - centre).norm(), 8 * kMm - fine.tolerance);
  }
}

double area_mm2(const SvgSubpath& line) {
  double twice = 0;
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const Eigen::Vector2d &a = line.points[i], &b = line.points[(i + 1) % line.points.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2 / (kMm * kMm);
}

TEST_F(SvgFile, KnowsTheBasicShapes) {
  SvgReadOptions fine;
  fine.tolerance = 1e-8;
  const double pi = std::numbers::pi;
  const auto area = [&](const std::string& shape) {
    const SvgDocument d = on_page(shape, fine);
    EXPECT_TRUE(d.shapes.at(0).lines.at(0).closed);
    return area_mm2(d.shapes[0].lines[0]);
  };
  EXPECT_NEAR(area("<ellipse cx='9' cy='9' rx='8' ry='4'/>"), 32 * pi, 1e-2);
  EXPECT_NEAR(area("<rect x='1' y='1' width='20' height='10'/>"), 200, 1e-9);
  // Rounded corners take (4 - pi) r^2 away; of ry alone, rx follows; radii are at most half.
  EXPECT_NEAR(area("<rect width='20' height='10' rx='2' ry='2'/>"), 200 - (4 - pi) * 4, 1e-2);
  EXPECT_NEAR(area("<rect width='20' height='10' ry='2'/>"), 200 - (4 - pi) * 4, 1e-2);
  EXPECT_NEAR(area("<rect width='10' height='10' rx='99' ry='99'/>"), 25 * pi, 1e-2);
  EXPECT_NEAR(area("<rect width='50%' height='50%'/>"), 50 * 25, 1e-9);
  EXPECT_NEAR(area("<circle r='1cm'/>"), pi * 100 * std::pow(96 / 25.4, 2), 1)
      << "a unit inside of a viewBox is of 96 px an inch";
  EXPECT_NEAR(area("<polygon points='0,0 10,0 10,10 0,0'/>"), 50, 1e-9);
  const SvgDocument open = on_page("<polyline points='0 0,10 0 10-10'/>");
  EXPECT_EQ(open.shapes.at(0).lines.at(0).points.size(), 3U);
  EXPECT_FALSE(open.shapes[0].lines[0].closed);
}

TEST_F(SvgFile, ReadsHolesAsFurtherLines) {
  const SvgDocument d =
      on_page("<path d='M0 0h20v20h-20z m5 5h10v10h-10z l1 1 M30 30 M40 40 50 50'/>");
  const std::vector<SvgSubpath>& lines = d.shapes.at(0).lines;
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_NEAR(area_mm2(lines[0]), 400, 1e-9);
  EXPECT_NEAR(area_mm2(lines[1]), 100, 1e-9);
  // Behind z the pen is where the closed line began; a mere move draws nothing.
  expect_point(lines[2].points.at(0), 5, 45);
  expect_point(lines[2].points.at(1), 6, 44);
  expect_point(lines[3].points.at(0), 40, 10);
  EXPECT_TRUE(lines[0].closed && lines[1].closed && !lines[2].closed && !lines[3].closed);
}

TEST_F(SvgFile, DrawsNoShapeWithoutExtent) {
  const SvgDocument d = on_page("<path d=''/><rect width='0' height='9'/><circle/><polygon/>");
  for (const SvgShape& shape : d.shapes) EXPECT_TRUE(shape.lines.empty()) << shape.element;
}

// What is drawn, and what not.

TEST_F(SvgFile, RepeatsWhatUseNames) {
  for (const char* href : {"href", "xlink:href"}) {
    const SvgDocument d =
        on_page("<defs><g id='pair'>" + kLine + "</g></defs><use " + std::string(href) +
                "='#pair' id='left' x='5' y='5' data-kind='fold'/>");
    expect_line(d, 15, 35, 35, 35);
    ASSERT_EQ(d.groups.size(), 2U);
    EXPECT_EQ(d.groups[0].tags.id, "left");
    EXPECT_EQ(d.groups[0].tags.data.at("kind"), "fold");
    EXPECT_EQ(d.groups[1].parent, 0);
    EXPECT_EQ(d.shapes[0].group, 1);
  }
  // 10 units of a symbol in 20 mm.
  expect_line(on_page("<symbol id='s' viewBox='0 0 10 10'><line x2='10' y2='10'/></symbol>"
                      "<use href='#s' x='10' y='10' width='20' height='20'/>"),
              10, 40, 30, 20);
}

TEST_F(SvgFile, DrawsNothingHiddenOrOnlyServing) {
  const SvgDocument d = on_page(
      "<defs>" + kLine + "</defs><clipPath>" + kLine + "</clipPath><marker>" + kLine +
      "</marker><mask>" + kLine + "</mask><symbol>" + kLine + "</symbol><pattern>" + kLine +
      "</pattern><g style='display:none' id='away'>" + kLine + "</g><g visibility='hidden'>" +
      kLine + "<g visibility='visible'><line id='back' x2='1'/></g></g><line display='none'/>");
  ASSERT_EQ(d.shapes.size(), 1U);
  EXPECT_EQ(d.shapes[0].tags.id, "back");
  EXPECT_TRUE(d.groups[0].hidden);
}

TEST_F(SvgFile, SaysWhatItLeavesOut) {
  const SvgDocument d = on_page(
      "<text>a</text>\n<text>b</text><style>g > path { stroke: red } @import 'x.css';</style>"
      "<use href='#nowhere'/><foreign:thing/>");
  EXPECT_THAT(d.notes, ElementsAre(HasSubstr("the selector 'g > path'"), HasSubstr("@import"),
                                   HasSubstr("svg:2: text: <text> is not read"),
                                   HasSubstr("#nowhere, which is not there")));
  EXPECT_THAT(d.notes[2], HasSubstr("(and 1 more)"));
}

// Style.

TEST_F(SvgFile, ResolvesTheColourOfStrokes) {
  const SvgColour red{255, 0, 0}, blue{0, 0, 255}, orange{255, 165, 0};
  const auto colour = [&](const std::string& inside) {
    const SvgDocument d = on_page(inside);
    EXPECT_EQ(d.shapes.size(), 1U);
    return d.shapes.at(0).stroke;
  };
  for (const char* text : {"red", "RED", "#f00", "#FF0000", "#f00f", "#ff000080", "rgb(255,0,0)",
                           "rgb( 100% , 0% , 0% )", "rgba(255 0 0 / 0.5)"}) {
    EXPECT_EQ(colour("<path d='M0 0' stroke='" + std::string(text) + "'/>"), red) << text;
  }
  EXPECT_EQ(colour("<g stroke='red'><g><path d='M0 0'/></g></g>"), red) << "inherited";
  EXPECT_EQ(colour("<g stroke='red'><path d='M0 0' stroke='inherit'/></g>"), red);
  EXPECT_EQ(colour("<path d='M0 0' stroke='red' style='fill:none;stroke:#00f'/>"), blue);
  EXPECT_EQ(colour("<g color='blue'><path d='M0 0' stroke='currentColor'/></g>"), blue);
  EXPECT_EQ(colour("<path d='M0 0' style='stroke:orange'/>"), orange);
  EXPECT_EQ(colour("<path d='M0 0'/>"), std::nullopt);
  EXPECT_EQ(colour("<g stroke='red'><path d='M0 0' stroke='none'/></g>"), std::nullopt);
}

TEST_F(SvgFile, TakesASwatchForItsColour) {
  const std::string swatch =
      "<defs><linearGradient id='swatch' xlink:href='#stops'/><linearGradient id='stops'>"
      "<stop style='stop-color:#00ff00;stop-opacity:1'/></linearGradient>"
      "<linearGradient id='two'><stop stop-color='red'/><stop stop-color='blue'/>"
      "</linearGradient></defs>";
  const SvgDocument d = on_page(swatch +
                                "<path d='M0 0' style='stroke:url(#swatch)'/>"
                                "<path d='M0 0' style='stroke:url(#two)'/>"
                                "<path d='M0 0' style='stroke:url(#none) blue'/>");
  EXPECT_EQ(d.shapes.at(0).stroke, (SvgColour{0, 255, 0}));
  EXPECT_TRUE(d.shapes.at(1).stroked);
  EXPECT_EQ(d.shapes.at(1).stroke, std::nullopt) << "two colours are none";
  EXPECT_EQ(d.shapes.at(2).stroke, (SvgColour{0, 0, 255}));
}

TEST_F(SvgFile, AppliesRulesByTheirSpecificity) {
  const std::string style =
      "<style type='text/css'><![CDATA[ /* } */ #own { stroke: #0000ff } .st0, .st1{stroke:lime}\n"
      "path.st1 { stroke: orange } path { stroke: red; stroke-dasharray: 3 3 } "
      "@media print { path { stroke: black } } line{stroke:red!important} ]]></style>";
  const SvgDocument d =
      on_page(style +
              "<path d='M0 0' stroke='black'/><path d='M0 0' class='a st0'/>"
              "<path d='M0 0' class='st1'/><path d='M0 0' class='st1' id='own'/>"
              "<path d='M0 0' class='st1' style='stroke:white;stroke-dasharray:none'/>"
              "<line style='stroke:white'/>");
  std::vector<std::string> colours;
  for (const SvgShape& shape : d.shapes) colours.push_back(to_text(shape.stroke.value()));
  EXPECT_THAT(colours,
              ElementsAre("#ff0000", "#00ff00", "#ffa500", "#0000ff", "#ffffff", "#ff0000"));
  EXPECT_TRUE(d.shapes[0].dashed);
  EXPECT_FALSE(d.shapes[4].dashed);
  EXPECT_THAT(d.notes, ElementsAre(HasSubstr("@media print")));
}

// As programs write them.

TEST_F(SvgFile, ReadsWhatInkscapeWrites) {
  const SvgDocument d = read(R"svg(<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<!-- Created with Inkscape (http://www.inkscape.org/) -->
<svg width="210mm" height="297mm" viewBox="0 0 210 297" version="1.1" id="svg5"
   inkscape:version="1.2.2 (b0a8486541, 2022-12-01)" sodipodi:docname="boot.svg"
   xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"
   xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"
   xmlns:xlink="http://www.w3.org/1999/xlink"
   xmlns="http://www.w3.org/2000/svg" xmlns:svg="http://www.w3.org/2000/svg">
  <sodipodi:namedview id="namedview7" pagecolor="#ffffff" inkscape:document-units="mm">
    <inkscape:grid type="xygrid" id="grid9" />
    <sodipodi:guide position="10,20" orientation="0,-1" id="guide3" />
  </sodipodi:namedview>
  <defs id="defs2">
    <inkscape:path-effect effect="spiro" id="path-effect1" is_visible="true" />
  </defs>
  <g inkscape:label="view:front" inkscape:groupmode="layer" id="layer1"
     transform="translate(10,-20)">
    <g inkscape:groupmode="layer" id="layer2" inkscape:label="seams">
      <path style="fill:none;stroke:#ff0000;stroke-width:0.26458332px;stroke-opacity:1"
         d="m 20,40 c 0,0 10,0 20,0" id="path236" sodipodi:nodetypes="cc"
         inkscape:label="seam-left" inkscape:original-d="M 0,0" class="seam  toe"
         data-panel="toe" />
    </g>
    <path sodipodi:type="arc" sodipodi:cx="50" id="path9" style="stroke:#000000"
       d="m 60,50 a 10,10 0 0 1 -10,10 10,10 0 0 1 -10,-10 10,10 0 0 1 10,-10 10,10 0 0 1 10,10 z" />
  </g>
  <g inkscape:groupmode="layer" id="layer3" style="display:none" inkscape:label="notes">
    <path d="broken"/>
  </g>
</svg>
)svg");
  EXPECT_THAT(d.notes, ElementsAre());
  EXPECT_TRUE(d.true_size);
  ASSERT_EQ(d.shapes.size(), 2U);
  const SvgShape& seam = d.shapes[0];
  EXPECT_EQ(seam.tags.id, "path236");
  EXPECT_EQ(seam.tags.label, "seam-left");
  EXPECT_THAT(seam.tags.classes, ElementsAre("seam", "toe"));
  EXPECT_EQ(seam.tags.data.at("panel"), "toe");
  EXPECT_EQ(seam.tags.line, 19U);
  EXPECT_EQ(seam.layer, "seams");
  EXPECT_EQ(d.groups.at(0).name(), "view:front");
  EXPECT_TRUE(d.groups[0].layer);
  EXPECT_TRUE(d.groups.at(2).hidden);
  EXPECT_EQ(seam.stroke, (SvgColour{255, 0, 0}));
  expect_point(seam.lines.at(0).points.front(), 30, 297 - 20);
  expect_point(seam.lines[0].points.back(), 50, 277);
  EXPECT_EQ(d.shapes[1].layer, "view:front");
  EXPECT_TRUE(d.shapes[1].lines.at(0).closed);
  for (const Eigen::Vector2d& p : d.shapes[1].lines[0].points)
    EXPECT_NEAR((p - Eigen::Vector2d(60, 267) * kMm).norm(), 10 * kMm, 1e-9);
}

// Prefixes are the file's own, and a document type is nothing to follow.
TEST_F(SvgFile, ReadsWhatOtherProgramsWrite) {
  const SvgDocument d = read(
      "\xEF\xBB\xBF<?xml version='1.0'?><!DOCTYPE svg PUBLIC '-//W3C//DTD SVG 1.1//EN' "
      "'http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd' [<!ENTITY ns_ai "
      "\"http://ns.adobe.com/\">]>"
      "<s:svg xmlns:s='http://www.w3.org/2000/svg' xmlns:i='http://www.inkscape.org/namespaces/"
      "inkscape' xmlns:x='&ns_ai;' width='96' height='96'><s:switch><s:foreignObject "
      "requiredExtensions='&ns_ai;'/><s:g i:groupmode='layer' i:label='view:top'>"
      "<s:line x1='0' y1='96' x2='48' y2='48'/><g/></s:g></s:switch></s:svg>");
  expect_line(d, 0, 0, 12.7, 12.7);
  EXPECT_EQ(d.shapes[0].layer, "view:top");
  EXPECT_FALSE(d.true_size);
}

// Pictures.

TEST_F(SvgFile, PlacesPictures) {
  const SvgDocument d = on_page(
      "<g transform='rotate(90)'><image id='photo' x='10' y='-30' width='20' height='8' "
      "xlink:href='pictures/my%20bag.png' preserveAspectRatio='none'/></g>"
      "<image width='1' height='1' href='data:image/png;base64,aGVs\nbG8='/>");
  ASSERT_EQ(d.images.size(), 2U);
  EXPECT_EQ(d.images[0].file, folder() / "pictures/my bag.png");
  EXPECT_TRUE(d.images[0].aspect.stretched);
  // (x, y) goes to (-y, x): the lower left corner (10, -22) to (22, 10), which is 40 mm up.
  expect_point(d.images[0].origin, 22, 40);
  expect_point(d.images[0].right, 0, -20);
  expect_point(d.images[0].up, 8, 0);
  EXPECT_EQ(d.images[1].media_type, "image/png");
  EXPECT_EQ(d.images[1].bytes, "hello");
  EXPECT_TRUE(d.images[1].file.empty());
}

TEST_F(SvgFile, ReadsNoPictureOutsideOfItsFolder) {
  namespace fs = std::filesystem;
  const auto image = [](const std::string& href) {
    return "<image id='p' width='1' height='1' href='" + href + "'/>";
  };
  for (const char* href : {"../secret.png", "a/../../secret.png", "/etc/passwd",
                           "%2e%2e/secret.png", "http://example.org/a.png", "file:///etc/passwd",
                           "C:/a.png", "a%00.png", "//host/a.png", "."}) {
    refuse(image(href), {"drawing.svg:2: image 'p'", "folder of the drawing"});
  }
  fs::create_directory(folder() / "real");
  fs::create_symlink("/etc", folder() / "link");
  refuse(image("link/passwd"), {"image 'p'", "symbolic link"});
  EXPECT_EQ(on_page(image("real/../real/a.png")).images.at(0).file, folder() / "real/a.png");
  const std::string absolute = "file://" + (folder() / "real/a.png").string();
  EXPECT_EQ(on_page(image(absolute)).images.at(0).file, folder() / "real/a.png");
  refuse(image("data:image/png;base64,??"), {"image 'p'", "no base64"});
  refuse(image("data:image/png"), {"image 'p'", "holds no data"});
  refuse("<image href='a.png'/>", {"image", "width and height"});
}

// Files that must not be believed.

TEST_F(SvgFile, FollowsNoEntity) {
  const std::string document = "<svg><path id='a' d='&x;'/></svg>";
  expect_error(
      [&] { read("<!DOCTYPE svg [\n<!ENTITY x SYSTEM 'file:///etc/passwd'>]>" + document); },
      {"drawing.svg:1", "entity of another file", "never read"});
  expect_error([&] { read("<!DOCTYPE svg [<!ENTITY % x PUBLIC 'a' 'b'> %x;]>" + document); },
               {"never read"});
  expect_error([&] { read("<!DOCTYPE svg [<!ENTITY x 'M0 0 1 1'>]>" + document); },
               {"path 'a': d, character 1", "command"});
  // A thousand million letters, if they were expanded.
  std::string bomb = "<!DOCTYPE svg [<!ENTITY a0 'lol'>";
  for (int i = 1; i < 10; ++i)
    bomb += "<!ENTITY a" + std::to_string(i) + " '" +
            repeat("&a" + std::to_string(i - 1) + ";", 10) + "'>";
  EXPECT_EQ(read(bomb + "]><svg><g id='&a9;'/></svg>").groups.at(0).tags.id, "&a9;");
}

TEST_F(SvgFile, FollowsNoUseThatLeadsToItself) {
  refuse("<g id='a'><use href='#b'/></g><g id='b'><use id='u' href='#a'/></g>",
         {"drawing.svg:2: use", "leads to itself"});
  refuse("<use id='u' href='other.svg#a'/>", {"use 'u'", "out of the file"});
}

TEST_F(SvgFile, LimitsWhatUseRepeats) {
  std::string bomb = "<g id='g0'>" + kLine + "</g>";
  for (int i = 1; i < 10; ++i)
    bomb += "<g id='g" + std::to_string(i) + "'>" +
            repeat("<use href='#g" + std::to_string(i - 1) + "'/>", 10) + "</g>";
  refuse(bomb, {"drawing.svg", "elements", "1000000"});
  // A chain of 60 groups is 120 levels when it is drawn.
  std::string chain = "<defs><g id='g0'>" + kLine + "</g>";
  for (int i = 1; i < 60; ++i)
    chain += "<g id='g" + std::to_string(i) + "'><use href='#g" + std::to_string(i - 1) + "'/></g>";
  refuse(chain + "</defs><use href='#g59'/>", {"nested too deep", "at most 100"});
}

TEST_F(SvgFile, RefusesWhatIsNoDrawing) {
  expect_error([&] { read("<html/>"); }, {"drawing.svg", "no SVG file", "<html>"});
  expect_error([&] { read("<svg>\n<g>\n</svg>"); }, {"drawing.svg:3", "no valid XML"});
  expect_error([&] { read(""); }, {"drawing.svg", "no valid XML"});
  expect_error([&] { read(std::string("<\0s\0v\0g\0", 8)); }, {"drawing.svg", "UTF-8"});
  expect_error([&] { read(repeat("<g>", 1000)); }, {"drawing.svg", "nested too deep"});
  expect_error([&] { read_svg_document(folder() / "none.svg", {}); }, {"none.svg"});
  expect_error([&] { read_svg_document(folder(), {}); }, {folder().string()});
  const auto large = write("large.svg", "<svg/>");
  std::filesystem::resize_file(large, 200'000'000);
  expect_error([&] { read_svg_document(large, {}); },
               {"large.svg", "200.0 MB", "at most 100.0 MB"});
}

TEST_F(SvgFile, NamesLineElementAndCharacter) {
  refuse("\n<path id='a' d='M0 0 X'/>", {"drawing.svg:3: path 'a': d, character 6", "command 'X'"});
  refuse("<polygon points='0 0 1'/>", {"drawing.svg:2: polygon: points, character 6", "number"});
  refuse("<rect id='r' width='-1' height='2'/>", {"rect 'r'", "width is negative"});
  refuse("<circle r='2em'/>", {"circle: r, character 4", "unit 'em'"});
  refuse("<circle r='1e999'/>", {"circle: r", "finite"});
  refuse("<g transform='scale(2' id='g'/>", {"g 'g': transform, character 8", "number"});
  refuse("<g transform='turn(2)'/>", {"no transformation 'turn'", "rotate"});
  refuse("<g transform='scale(1 2 3)'/>", {"'scale' of 3 numbers"});
  refuse("<g style='transform: scale(2)' id='g'/>", {"g 'g'", "transform in its style"});
  refuse("<path d='M0 0' stroke='rad'/>", {"svg:2: path", "'rad' is no colour", "#rrggbb"});
  refuse(repeat("<g transform='scale(1e15)'>", 20) + repeat("</g>", 20), {"beyond all numbers"});
  expect_error([&] { read("<svg viewBox='0 0 1'/>"); }, {"svg: viewBox", "number"});
  expect_error([&] { read("<svg viewBox='0 0 -1 1'/>"); }, {"svg: viewBox", "negative"});
  expect_error([&] { read("<svg width='0'/>"); }, {"width is not positive"});
  expect_error([&] { read("<svg preserveAspectRatio='xMidyMid' viewBox='0 0 1 1'/>"); },
               {"preserveAspectRatio", "no alignment"});
}

}  // namespace
}  // namespace geoprior
