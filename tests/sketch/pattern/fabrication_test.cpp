#include "experiments/sketch/fabrication/fabrication.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "core/error.h"
#include "core/random.h"
#include "experiments/sketch/fabrication/escaped_text.h"
#include "experiments/sketch/fabrication/pattern_map.h"
#include "experiments/sketch/fabrication/pattern_svg.h"
#include "experiments/sketch/fabrication/written_number.h"
#include "experiments/sketch/pattern/clear_box.h"
#include "experiments/sketch/pattern/sheet_layout.h"
#include "experiments/sketch/pattern/sheet_text.h"
#include "tests/sketch/drawing/panel_check.h"
#include "tests/sketch/pattern/flat_patterns.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// An SVG drawing as pugixml reads it.
struct ReadPatternSvg {
  pugi::xml_document document;
  double height = 0;

  explicit ReadPatternSvg(const std::string& text) {
    const auto result = document.load_buffer(text.data(), text.size());
    EXPECT_TRUE(result) << result.description();
    height = millimetres("height");
    std::istringstream box(root().attribute("viewBox").value());
    double x = 1, y = 1, w = 0, h = 0;
    box >> x >> y >> w >> h;
    EXPECT_EQ(std::vector({x, y, w, h}), std::vector({0.0, 0.0, millimetres("width"), height}))
        << "a user unit is a millimetre";
  }

  [[nodiscard]] pugi::xml_node root() const { return document.child("svg"); }
  [[nodiscard]] double millimetres(const char* name) const {
    const std::string value = root().attribute(name).value();
    EXPECT_TRUE(value.ends_with("mm")) << value;
    return std::stod(value);
  }
  [[nodiscard]] pugi::xml_node layer(const std::string& name) const {
    return root().find_child_by_attribute("g", "id", name.c_str());
  }
  /// Up is up.
  [[nodiscard]] test::ReadLine line(pugi::xml_node path) const {
    std::string d = path.attribute("d").value();
    test::ReadLine line;
    line.closed = d.ends_with("Z");
    std::replace_if(
        d.begin(), d.end(), [](char c) { return c == 'M' || c == 'L' || c == 'Z'; }, ' ');
    std::istringstream numbers(d);
    for (double x = 0, y = 0; numbers >> x >> y;) line.points.emplace_back(x, height - y);
    return line;
  }
  [[nodiscard]] std::vector<test::ReadLine> lines(const std::string& layer_name) const {
    std::vector<test::ReadLine> found;
    for (const pugi::xml_node path : layer(layer_name).children("path")) {
      found.push_back(line(path));
    }
    return found;
  }
};

std::string pattern_svg_text(const Pattern& pattern, const FabricationOptions& options = {}) {
  const PatternSheet sheet = pattern_sheet(pattern, options.sheet);
  return svg_page(sheet, whole_sheet(sheet), options.layers);
}

TEST(PatternSvg, AgreesWithThePanels) {
  const Pattern pattern = test::bucket();
  const ReadPatternSvg svg(pattern_svg_text(pattern));
  const auto sewn = svg.lines("sew"), cut = svg.lines("cut");
  ASSERT_EQ(sewn.size(), 2U);
  ASSERT_EQ(cut.size(), 2U);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    EXPECT_TRUE(sewn[k].closed && cut[k].closed);
    test::expect_panel(pattern.pieces[k], sewn[k].points);
    EXPECT_NEAR(test::distance_of_closed(cut[k].points, sewn[k].points), 7, 1e-4);
    for (const Eigen::Vector2d& p : cut[k].points) {
      EXPECT_TRUE(p.x() > 0 && p.y() > 0 && p.x() < svg.millimetres("width") && p.y() < svg.height);
    }
  }
}

TEST(PatternSvg, HasALayerForEachKindOfLine) {
  FabricationOptions options;
  options.layers.cut = "#12aBcF";
  Pattern pattern = test::bucket();
  pattern.pieces[1].folds = {{0, 24}};
  const ReadPatternSvg svg(pattern_svg_text(pattern, options));
  std::vector<std::string> names;
  for (const pugi::xml_node layer : svg.root().children("g")) {
    names.push_back(layer.attribute("inkscape:label").value());
    EXPECT_STREQ(layer.attribute("inkscape:groupmode").value(), "layer");
    EXPECT_TRUE(layer.first_child()) << names.back();
  }
  EXPECT_THAT(names, ::testing::ElementsAre("cut", "sew", "fold", "notch", "grain", "text"));
  EXPECT_STREQ(svg.layer("cut").attribute("stroke").value(), "#12aBcF");
  std::set<std::string> colours;
  for (const std::string& name : names) colours.insert(svg.layer(name).attribute("stroke").value());
  EXPECT_EQ(colours.size(), names.size()) << "a laser cutter tells layers by colour";
  const auto folds = svg.lines("fold");
  ASSERT_EQ(folds.size(), 1U);
  EXPECT_NEAR((folds[0].points[1] - folds[0].points[0]).norm(), 240, 0.3);
}

TEST(PatternSvg, PairsNotches) {
  const ReadPatternSvg svg(pattern_svg_text(test::bucket()));
  const auto cut = svg.lines("cut");
  std::map<int, std::vector<int>> pieces;  // of each label's ticks
  for (const pugi::xml_node path : svg.layer("notch").children("path")) {
    const auto piece = path.attribute("data-piece").as_uint();
    pieces[path.attribute("data-notch").as_int()].push_back(static_cast<int>(piece));
    const test::ReadLine tick = svg.line(path);
    EXPECT_LT(test::distance_to_closed(tick.points[0], cut[piece].points), 1e-4);
    EXPECT_NEAR((tick.points[1] - tick.points[0]).norm(), 4, 1e-4);
  }
  ASSERT_GE(pieces.size(), 10U);
  for (const auto& [label, of] : pieces) {
    const auto at_disc = std::count(of.begin(), of.end(), 1);
    EXPECT_TRUE(at_disc == 0 || 2 * at_disc == std::ssize(of)) << label;
    EXPECT_TRUE(of.size() == 2 || of.size() == 4) << label;
  }
  // The numbers are written once on each side.
  std::map<std::string, int> numbers;
  for (const pugi::xml_node text : svg.layer("text").children("text")) {
    ++numbers[text.child_value()];
  }
  for (const auto& [label, of] : pieces) EXPECT_EQ(numbers[std::to_string(label)], 2) << label;
}

TEST(PatternSvg, DrawsABarOfAHundredMillimetres) {
  const ReadPatternSvg svg(pattern_svg_text(test::bucket(12)));
  const auto bar = svg.root().find_node([](pugi::xml_node node) {
    return std::string(node.attribute("class").value()) == "scale-bar";
  });
  const test::ReadLine line = svg.line(bar);
  EXPECT_DOUBLE_EQ((line.points[1] - line.points[0]).norm(), 100);
}

TEST(PatternSvg, KeepsNamesOfStrangers) {
  RandomStream random(5, "names");
  for (int round = 0; round < 100; ++round) {
    Pattern pattern = test::bucket(6);
    std::string& name = pattern.pieces[0].name;
    name = round == 0 ? "a\"><script>&amp;'\n\t\x01" : "";
    while (round > 0 && name.size() < random.below(60)) {
      name += static_cast<char>(random.below(256));
    }
    const ReadPatternSvg svg(pattern_svg_text(pattern));
    const std::string read = svg.layer("cut").child("path").attribute("data-name").value();
    EXPECT_EQ(read, utf8_text(label_text(name, 40)));
    if (round == 0) {
      EXPECT_EQ(read, "a\"><script>&amp;'   ");
    }
  }
}

TEST(PatternSvg, NamesTheLayerOfABadColour) {
  for (const std::string colour : {"red", "#12345", "#12345g", "#-12345", "#1234567", "\"/>"}) {
    FabricationOptions options;
    options.layers.sew = colour;
    EXPECT_THAT(test::error_of([&] { pattern_svg_text(test::bucket(6), options); }),
                AllOf(HasSubstr("layer sew"), HasSubstr("#rrggbb")));
  }
}

// Names, numbers and arrows touch no sewing line, fold or notch, nor each other.
TEST(PatternSheet, KeepsTextClearOfLines) {
  Pattern pattern = test::bucket();
  pattern.pieces.push_back(test::polygon_piece("a strap with a long name",
                                               {{0, 0}, {0.3, 0}, {0.3, 0.012}, {0, 0.012}}));
  pattern.pieces.push_back(
      test::polygon_piece("wedge", {{0, 0}, {0.2, 0.01}, {0.03, 0.03}, {0.02, 0.15}}));
  PatternPiece tube = test::polygon_piece(
      "tube", {{0, 0}, {0.09, 0.002}, {0.09, 0.005}, {0.04, 0.006}, {0, 0.004}});
  const int index = static_cast<int>(pattern.pieces.size());
  tube.edges = {{{0, 1}, 5, index, 1}, {{2, 3, 4}, 5, index, 0}};
  pattern.pieces.push_back(tube);
  for (const double spacing : {80.0, 10.0}) {
    SheetOptions options;
    options.notch_spacing_mm = spacing;
    for (const SheetPiece& piece : pattern_sheet(pattern, options).pieces) {
      std::vector<PlaneLoop> free;
      std::vector<PlaneSegment> drawn;
      for (const SheetLine& line : piece.lines) {
        if (line.layer == SheetLayer::cut) continue;
        if (line.closed) free.push_back(line.points);
        for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
          drawn.push_back({line.points[i], line.points[i + 1]});
        }
      }
      for (const SheetText& text : piece.texts) {
        const Eigen::Vector2d half(helvetica_width(text.text) * text.height / 2,
                                   0.45 * text.height);
        EXPECT_TRUE(is_clear({Eigen::Vector2d(text.at - half), Eigen::Vector2d(text.at + half)},
                             free, drawn))
            << piece.name << ": " << utf8_text(text.text);
        for (const SheetText& other : piece.texts) {
          if (&other == &text) continue;
          const Eigen::Vector2d apart = (other.at - text.at).cwiseAbs();
          const double wide = (helvetica_width(text.text) * text.height +
                               helvetica_width(other.text) * other.height) /
                              2;
          EXPECT_TRUE(apart.x() > wide || apart.y() > 0.36 * (text.height + other.height));
        }
      }
    }
  }
}

TEST(PatternSheet, TurnsTheGrainUpwards) {
  PatternPiece piece = test::polygon_piece("a", {{0, 0}, {0.3, 0}, {0.3, 0.1}, {0, 0.1}});
  piece.grain = {1, 0};
  const SheetPiece drawn = pattern_sheet({{piece}}, {}).pieces[0];
  EXPECT_NEAR(drawn.size.x(), 114, 1e-9);
  EXPECT_NEAR(drawn.size.y(), 314, 1e-9);
  EXPECT_EQ(std::count_if(drawn.lines.begin(), drawn.lines.end(),
                          [](const SheetLine& l) { return l.layer == SheetLayer::grain; }),
            2);
}

// 25 pieces of all sizes: no two boxes come nearer than the gap, none leaves the sheet.
TEST(PatternSheet, KeepsPiecesApart) {
  Pattern pattern;
  RandomStream random(6, "sizes");
  for (int i = 0; i < 25; ++i) {
    const double w = 0.01 + 0.3 * random.below(100) / 100, h = 0.01 + 0.3 * random.below(100) / 100;
    pattern.pieces.push_back(test::polygon_piece("p", {{0, 0}, {w, 0}, {w, h}, {0, h}}));
  }
  const PatternSheet sheet = pattern_sheet(pattern, {});
  for (std::size_t i = 0; i < 25; ++i) {
    const SheetPiece& a = sheet.pieces[i];
    EXPECT_GE(a.place.minCoeff(), 10 - 1e-9);
    EXPECT_GE((sheet.size - a.place - a.size).minCoeff(), 10 - 1e-9);
    for (std::size_t j = 0; j < i; ++j) {
      const SheetPiece& b = sheet.pieces[j];
      const Eigen::Array2d gap = (a.place - b.place - b.size).cwiseMax(b.place - a.place - a.size);
      EXPECT_GE(gap.maxCoeff(), 10 - 1e-9) << i << " " << j;
    }
  }
  EXPECT_LT(sheet.size.x() / sheet.size.y(), 2);
  EXPECT_GT(sheet.size.x() / sheet.size.y(), 0.5);
}

TEST(PatternSheet, WithoutAllowanceCutsOnTheSewingLine) {
  SheetOptions options;
  options.allowance_mm = options.hem_mm = 0;
  for (const SheetPiece& piece : pattern_sheet(test::bucket(), options).pieces) {
    EXPECT_EQ(piece.lines[0].points, piece.lines[1].points);
    for (const SheetNotch& notch : piece.notches) EXPECT_LT((notch.cut - notch.sewn).norm(), 1e-9);
  }
}

TEST(PatternTiles, CoverTheSheet) {
  for (const PaperFormat paper : {PaperFormat::a4, PaperFormat::letter}) {
    PatternSheet sheet;
    for (const Eigen::Vector2d& size : {Eigen::Vector2d(50, 60), Eigen::Vector2d(190, 277),
                                        Eigen::Vector2d(191, 278), Eigen::Vector2d(700, 620)}) {
      sheet.size = size;
      const auto pages = sheet_pages(sheet, {.paper = paper});
      for (double x = 0.05; x < size.x(); x += 3.3) {
        for (double y = 0.05; y < size.y(); y += 3.3) {
          ASSERT_TRUE(std::any_of(pages.begin(), pages.end(), [&](const SheetPage& page) {
            return page.window.contains(Eigen::Vector2d(x, y));
          }));
        }
      }
      for (const SheetPage& page : pages) {
        EXPECT_NEAR((page.paper - page.window.sizes() - Eigen::Vector2d(20, 20)).norm(), 0, 1e-9);
      }
    }
  }
}

// 190 x 277 mm of an A4 page are printed; each further one adds 180 x 267.
TEST(PatternTiles, AreAsManyAsNeeded) {
  const auto count = [](double width, double height) {
    PatternSheet sheet;
    sheet.size = {width, height};
    return sheet_pages(sheet, {.paper = PaperFormat::a4}).size();
  };
  EXPECT_EQ(count(190, 277), 1U);
  EXPECT_EQ(count(190.1, 277), 2U);
  EXPECT_EQ(count(370, 277), 2U);
  EXPECT_EQ(count(371, 278), 6U);
  EXPECT_EQ(count(550, 811), 9U);
}

TEST(PatternTiles, ShareTheirRegistrationCrosses) {
  PatternSheet sheet;
  sheet.size = {500, 700};
  const auto pages = sheet_pages(sheet, {.paper = PaperFormat::a4});
  ASSERT_EQ(pages.size(), 9U);
  std::map<std::pair<long, long>, int> crosses;  // horizontal arms by their middle, in micrometres
  for (const SheetPage& page : pages) {
    for (const SheetLine& mark : page.marks) {
      EXPECT_EQ(mark.points.size(), mark.closed ? 4U : 2U);
      for (const Eigen::Vector2d& p : mark.points) {
        EXPECT_GT((p - page.window.min()).minCoeff(), -1e-9);
        EXPECT_GT((page.window.max() - p).minCoeff(), -1e-9);
      }
      if (mark.closed || mark.points[0].y() != mark.points[1].y()) continue;
      const Eigen::Vector2d middle = 500 * (mark.points[0] + mark.points[1]);
      ++crosses[{std::lround(middle.x()), std::lround(middle.y())}];
    }
  }
  EXPECT_EQ(crosses.size(), 24U) << "two on each of twelve shared strips";
  for (const auto& [at, times] : crosses) EXPECT_EQ(times, 2);
}

TEST(PatternTiles, AreLabelledByRowAndColumn) {
  PatternSheet sheet;
  sheet.size = {300, 277 + 26 * 267};
  const auto pages = sheet_pages(sheet, {.paper = PaperFormat::a4});
  ASSERT_EQ(pages.size(), 54U);
  EXPECT_EQ(pages[0].label, "A1");
  EXPECT_EQ(pages[1].label, "A2");
  EXPECT_EQ(pages[51].label, "Z2");
  EXPECT_EQ(pages[52].label, "AA1");
  EXPECT_GT(pages[0].window.min().y(), pages[2].window.min().y()) << "A is the upper row";
}

TEST(PatternTiles, RefuseWhatPaperCannotHold) {
  PatternSheet sheet;
  sheet.size = {6000, 300};
  EXPECT_THAT(test::error_of([&] { sheet_pages(sheet, {}); }), HasSubstr("5080"));
  const TileOptions wide{.paper = PaperFormat::a4, .margin_mm = 50, .overlap_mm = 95};
  EXPECT_THAT(test::error_of([&] { sheet_pages(sheet, wide); }), HasSubstr("too little"));
  sheet.size = {60000, 60000};
  EXPECT_THAT(test::error_of([&] { sheet_pages(sheet, {.paper = PaperFormat::a4}); }),
              HasSubstr("225 x 334 pages"));
}

TEST(PatternMap, FindsEveryPointOnTheSheet) {
  Pattern pattern = test::bucket(20);
  pattern.pieces[0].grain = Eigen::Vector2d(3, 4) / 5;
  const PatternSheet sheet = pattern_sheet(pattern, {});
  const ReadPatternSvg svg(svg_page(sheet, whole_sheet(sheet), {}));
  const auto sewn = svg.lines("sew");
  std::istringstream csv(pattern_map_csv(pattern, sheet));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "piece,point,surface_vertex,x_mm,y_mm,sheet_x_mm,sheet_y_mm,name");
  std::map<int, int> occurrences;
  int count = 0;
  for (; std::getline(csv, line); ++count) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::size_t piece = 0, point = 0;
    int vertex = 0;
    Eigen::Vector2d own, on_sheet;
    words >> piece >> point >> vertex >> own.x() >> own.y() >> on_sheet.x() >> on_sheet.y();
    const PatternPiece& asked = pattern.pieces.at(piece);
    EXPECT_EQ(vertex, asked.surface_vertex.at(point));
    EXPECT_LT((own - 1000 * asked.points.row(point).transpose()).norm(), 1e-4);
    EXPECT_LT((on_sheet - sewn[piece].points[point]).norm(), 1e-4);
    ++occurrences[vertex];
  }
  EXPECT_EQ(count, 42 + 20);
  for (int v = 0; v < 20; ++v) EXPECT_EQ(occurrences[v], v == 0 ? 3 : 2) << "on the seam";
}

TEST(PatternMap, TellsSeamsInJson) {
  Pattern pattern = test::bucket(20);
  pattern.pieces[0].name = "wall \xFF\"";
  const auto json = nlohmann::json::parse(pattern_json(pattern, pattern_sheet(pattern, {})));
  EXPECT_EQ(json["unit"], "mm");
  ASSERT_EQ(json["pieces"].size(), 2U);
  const auto& wall = json["pieces"][0];
  EXPECT_EQ(wall["name"], "wall \xEF\xBF\xBD\"");
  EXPECT_EQ(wall["edges"][0]["sewn_to"]["piece"], 1);
  EXPECT_FALSE(wall["edges"][2].contains("sewn_to"));
  EXPECT_NEAR(wall["edges"][0]["length_mm"].get<double>(),
              json["pieces"][1]["edges"][0]["length_mm"].get<double>(), 1e-9);
  EXPECT_EQ(wall["points_mm"].size(), 42U);
  pattern.pieces[0].surface_vertex.pop_back();
  EXPECT_THAT(test::error_of([&] { pattern_json(pattern, pattern_sheet(pattern, {})); }),
              HasSubstr("surface vertices for 41 points"));
}

TEST(Fabrication, WritesAllFilesTheSameEachTime) {
  FabricationOptions options;
  options.pages.paper = PaperFormat::letter;
  const auto files = fabrication_files(test::bucket(), options);
  const auto again = fabrication_files(test::bucket(), options);
  std::set<std::string> names;
  ASSERT_EQ(files.size(), again.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    names.insert(files[i].name);
    EXPECT_EQ(files[i].bytes, again[i].bytes) << files[i].name;
  }
  EXPECT_EQ(names.size(), files.size());
  EXPECT_THAT(names, ::testing::IsSupersetOf({"pattern.svg", "pattern.dxf", "pattern.pdf",
                                              "pattern.csv", "pattern.json", "pattern-A1.svg"}));
}

TEST(WrittenNumber, IsShortAndNeverInExponents) {
  EXPECT_EQ(written_number(0), "0");
  EXPECT_EQ(written_number(-1e-9), "0");
  EXPECT_EQ(written_number(210), "210");
  EXPECT_EQ(written_number(-0.5), "-0.5");
  EXPECT_EQ(written_number(1.23456789), "1.23457");
  EXPECT_EQ(written_number(1e12), "1000000000000");
  EXPECT_EQ(written_number(100, 0), "100");
}

// The largest square in a triangle of base and height 1 (right angle at the origin) has the side
// 1/2; of boxes twice as wide as high, 2 h + h = 1.
TEST(ClearBox, IsTheLargestOfItsShape) {
  const PlaneLoop triangle{{0, 0}, {1, 0}, {0, 1}};
  EXPECT_NEAR(largest_clear_box({triangle}, {}, 1).sizes().y(), 0.5, 0.01);
  EXPECT_NEAR(largest_clear_box({triangle}, {}, 2).sizes().y(), 1.0 / 3, 0.007);
  const PlaneLoop square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const PlaneLoop hole{{0.4, 0.4}, {0.6, 0.4}, {0.6, 0.6}, {0.4, 0.6}};
  EXPECT_NEAR(largest_clear_box({square, hole}, {}, 1).sizes().y(), 0.4, 0.01);
  const auto beside = largest_clear_box({square}, {{{0.3, 0}, {0.3, 1}}}, 1);
  EXPECT_NEAR(beside.sizes().x(), 0.7, 0.015);
  EXPECT_GE(beside.min().x(), 0.3);
  EXPECT_TRUE(largest_clear_box({}, {}, 1).isEmpty());
}

TEST(SheetText, CleansWhatStrangersWrite) {
  EXPECT_EQ(label_text("a\nb\tc\x7F", 40), U"a b c ");
  EXPECT_EQ(label_text("\xC3\xA9\xE2\x82\xAC\xF0\x9F\x91\x9E", 40), U"\u00E9\u20AC\U0001F45E");
  EXPECT_EQ(label_text("\xC0\xAF|\xED\xA0\x80|\xF4\x90\x80\x80|\xE2\x82", 40),
            U"\uFFFD\uFFFD|\uFFFD|\uFFFD|\uFFFD\uFFFD");
  EXPECT_EQ(label_text("a\xE2\x80\xAE"
                       "b",
                       40),
            U"a\uFFFDb")
      << "turns the direction of writing";
  EXPECT_EQ(label_text("1234567", 6), U"123...");
  EXPECT_EQ(label_text("123456", 6), U"123456");
  EXPECT_NEAR(helvetica_width(U"Ai 1"), (667 + 222 + 278 + 556) / 1000.0, 1e-15);
}

}  // namespace
}  // namespace geoprior::sketch
