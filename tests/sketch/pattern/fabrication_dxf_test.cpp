#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "experiments/sketch/fabrication/pattern_dxf.h"
#include "experiments/sketch/pattern/sheet_layout.h"
#include "tests/sketch/drawing/panel_check.h"
#include "tests/sketch/pattern/flat_patterns.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

using ::testing::HasSubstr;

/// What a reader found in a DXF file.
struct ReadDxf {
  struct Entity {
    std::string block, kind, text;  ///< block: empty for the drawing itself
    test::ReadLine line;
  };
  std::vector<Entity> entities;
  std::map<std::string, Eigen::Vector2d> inserts;
  std::vector<std::string> layers;
  std::map<std::string, std::string> variables;

  [[nodiscard]] std::vector<test::ReadLine> find(const std::string& block, const std::string& layer,
                                                 const std::string& kind) const {
    std::vector<test::ReadLine> found;
    for (const Entity& e : entities) {
      if (e.block == block && e.line.layer == layer && e.kind == kind) found.push_back(e.line);
    }
    return found;
  }
};

/// Group codes and values; knows of the format what Autodesk's reference of release 12 says.
class DxfTestReader {
 public:
  explicit DxfTestReader(const std::string& text) : in_(text) {}

  ReadDxf read() {
    while (next()) {
      if (code_ == 9)
        variable_ = value_;
      else if (!variable_.empty() && code_ != 0)
        read_.variables[std::exchange(variable_, {})] = value_;
      if (code_ == 0)
        begin(value_);
      else
        take();
    }
    EXPECT_EQ(kind_, "EOF");
    return std::move(read_);
  }

 private:
  bool next() {
    std::string code;
    if (!std::getline(in_, code)) return false;
    EXPECT_TRUE(std::getline(in_, value_)) << "a group code without a value";
    code_ = std::stoi(code);
    return true;
  }

  void begin(const std::string& kind) {
    variable_.clear();
    const std::string before = std::exchange(kind_, kind);
    if (before == "BLOCK") block_ = name_;
    if (before == "INSERT") read_.inserts[name_] = read_.entities.back().line.points.at(0);
    if (before == "LAYER") read_.layers.push_back(name_);
    if (kind == "ENDBLK") block_.clear();
    if (kind == "VERTEX" || kind == "SEQEND") return;
    read_.entities.push_back({block_, kind, {}, {}});
  }

  void take() {
    if (read_.entities.empty()) return;
    ReadDxf::Entity& entity = read_.entities.back();
    const bool header = kind_ == "POLYLINE";  // its own point is the elevation
    if (code_ == 2) name_ = value_;
    if (code_ == 1) entity.text = value_;
    if (code_ == 8 && kind_ != "VERTEX") entity.line.layer = value_;
    if (code_ == 70 && header) entity.line.closed = value_ == "1";
    if (header) return;
    if (code_ == 10 || code_ == 11) entity.line.points.emplace_back(std::stod(value_), 0);
    if (code_ == 20 || code_ == 21) entity.line.points.back().y() = std::stod(value_);
  }

  std::istringstream in_;
  ReadDxf read_;
  int code_ = 0;
  std::string value_, kind_, name_, block_, variable_;
};

const char* const kWallBlock = "P1-WALL";
const char* const kDiscBlock = "P2-DISC";

TEST(PatternDxf, HoldsEachPieceInABlock) {
  const Pattern pattern = test::bucket();
  const PatternSheet sheet = pattern_sheet(pattern, {});
  const ReadDxf dxf = DxfTestReader(dxf_drawing(sheet)).read();
  EXPECT_EQ(dxf.variables.at("$ACADVER"), "AC1009");
  EXPECT_EQ(dxf.variables.at("$INSUNITS"), "4") << "millimetres";
  EXPECT_EQ(dxf.variables.at("$MEASUREMENT"), "1") << "metric";
  EXPECT_THAT(dxf.layers, ::testing::IsSupersetOf({"1", "4", "7", "8", "14", "15"}));
  ASSERT_EQ(dxf.inserts.size(), 2U);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const std::string block = k == 0 ? kWallBlock : kDiscBlock;
    EXPECT_LT((dxf.inserts.at(block) - sheet.pieces[k].place).norm(), 1e-5);
    const auto cut = dxf.find(block, "1", "POLYLINE"), sewn = dxf.find(block, "14", "POLYLINE");
    ASSERT_EQ(cut.size(), 1U);
    ASSERT_EQ(sewn.size(), 1U);
    EXPECT_TRUE(cut[0].closed && sewn[0].closed);
    test::expect_panel(pattern.pieces[k], sewn[0].points);
    EXPECT_NEAR(test::distance_of_closed(cut[0].points, sewn[0].points), 7, 1e-5);
    EXPECT_EQ(dxf.find(block, "2", "POINT").size() + dxf.find(block, "3", "POINT").size(),
              cut[0].points.size());
    const auto grain = dxf.find(block, "7", "LINE");
    ASSERT_EQ(grain.size(), 1U);
    EXPECT_NEAR(grain[0].points[0].x(), grain[0].points[1].x(), 1e-9);
    EXPECT_GT(grain[0].points[1].y() - grain[0].points[0].y(), 50);
  }
  EXPECT_EQ(dxf.find(kWallBlock, "2", "POINT").size(), 4U) << "the corners of the wall";
  EXPECT_EQ(dxf.find(kDiscBlock, "2", "POINT").size(), 0U);
}

TEST(PatternDxf, PutsNotchesOnTheCuttingLine) {
  const PatternSheet sheet = pattern_sheet(test::bucket(), {});
  const ReadDxf dxf = DxfTestReader(dxf_drawing(sheet)).read();
  std::size_t count = 0;
  for (const std::string block : {kWallBlock, kDiscBlock}) {
    const PlaneLoop cut = dxf.find(block, "1", "POLYLINE").at(0).points;
    for (const test::ReadLine& notch : dxf.find(block, "4", "POINT")) {
      EXPECT_LT(test::distance_to_closed(notch.points.at(0), cut), 1e-5);
      ++count;
    }
  }
  EXPECT_EQ(count, sheet.pieces[0].notches.size() + sheet.pieces[1].notches.size());
  EXPECT_EQ(count % 2, 0U);
}

TEST(PatternDxf, PutsHolesOnALayerOfTheirOwn) {
  PatternPiece plate = test::polygon_piece(
      "plate", {{0, 0}, {0.1, 0}, {0.1, 0.1}, {0, 0.1}, {0.03, 0.03}, {0.06, 0.03}, {0.06, 0.06}});
  plate.borders = {{0, 1, 2, 3}, {4, 5, 6}};
  plate.folds = {{0, 4}};
  SheetOptions options;
  options.hem_mm = 2;
  const ReadDxf dxf = DxfTestReader(dxf_drawing(pattern_sheet({{plate}}, options))).read();
  EXPECT_EQ(dxf.find("P1-PLATE", "1", "POLYLINE").size(), 1U);
  EXPECT_EQ(dxf.find("P1-PLATE", "11", "POLYLINE").size(), 1U);
  EXPECT_EQ(dxf.find("P1-PLATE", "14", "POLYLINE").size(), 2U);
  EXPECT_EQ(dxf.find("P1-PLATE", "8", "LINE").size(), 1U) << "the fold";
}

TEST(PatternDxf, WritesNamesOfStrangersInAscii) {
  Pattern pattern = test::bucket(12);
  pattern.pieces[0].name = "\xC3\x84rmel\n 0\nEOF %%d ^J \\P \xF0\x9F\x91\x9E \xFF";
  const std::string text = dxf_drawing(pattern_sheet(pattern, {}));
  for (const char c : text) ASSERT_TRUE(c == '\n' || (c >= 0x20 && c < 0x7F));
  const ReadDxf dxf = DxfTestReader(text).read();
  std::string name;
  for (const ReadDxf::Entity& e : dxf.entities) {
    if (e.kind == "TEXT" && e.text.starts_with("PIECE NAME: ") && name.empty()) name = e.text;
  }
  EXPECT_EQ(name,
            "PIECE NAME: \\U+00C4rmel  0 EOF \\U+0025\\U+0025d \\U+005EJ \\U+005CP ? \\U+FFFD");
  EXPECT_EQ(dxf.inserts.count("P1-_RMEL__0_EOF___D__J__P____"), 1U);
}

class PatternDxfInEzdxf : public test::RunTest {
 protected:
  /// What the script that uses ezdxf says of the drawing.
  [[nodiscard]] std::vector<std::string> read_by_ezdxf(const PatternSheet& sheet) const {
    const auto file = folder() / "pattern.dxf", said = folder() / "said.txt";
    std::ofstream(file) << dxf_drawing(sheet);
    test::ProgramProcess python(
        [&] {
          return test::become_program(
              "/usr/bin/python3",
              {"-B", GEOPRIOR_SOURCE_DIR "/tests/sketch/read_dxf.py", file.string()});
        },
        said);
    EXPECT_EQ(python.wait(), 0) << test::text_of(said) << "(needs the package python3-ezdxf)";
    std::istringstream text(test::text_of(said));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }
};

TEST_F(PatternDxfInEzdxf, AgreesWithThePanels) {
  Pattern pattern = test::bucket();
  pattern.pieces[1].name = "Sohle \xC3\xBC";
  const PatternSheet sheet = pattern_sheet(pattern, {});
  std::map<std::string, PlaneLoop> sewn;
  std::map<std::string, int> counts;
  const auto lines = read_by_ezdxf(sheet);
  for (const std::string& line : lines) {
    std::istringstream words(line);
    std::string where, name, layer, kind;
    int closed = 0;
    words >> where >> name >> layer >> kind >> closed;
    ++counts[where + " " + layer + " " + kind];
    if (layer != "14" || kind != "POLYLINE") continue;
    EXPECT_EQ(closed, 1);
    for (double x = 0, y = 0; words >> x >> y;) sewn[name].emplace_back(x, y);
  }
  ASSERT_EQ(sewn.size(), 2U);
  test::expect_panel(pattern.pieces[0], sewn["P1-WALL"]);
  test::expect_panel(pattern.pieces[1], sewn["P2-SOHLE__"]);
  EXPECT_EQ(counts["block 1 POLYLINE"], 2);
  EXPECT_EQ(counts["block 7 LINE"], 2);
  EXPECT_EQ(counts["model 1 INSERT"], 2);
  EXPECT_EQ(counts["block 4 POINT"],
            static_cast<int>(sheet.pieces[0].notches.size() + sheet.pieces[1].notches.size()));
  EXPECT_THAT(lines, ::testing::IsSupersetOf({"version R12", "units 4", "errors 0",
                                              "text P2-SOHLE__ 1 PIECE NAME: Sohle \xC3\xBC"}));
}

}  // namespace
}  // namespace geoprior::sketch
