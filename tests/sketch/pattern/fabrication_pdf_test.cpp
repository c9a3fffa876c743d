#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "core/error.h"
#include "experiments/sketch/fabrication/pattern_pdf.h"
#include "experiments/sketch/pattern/sheet_layout.h"
#include "tests/sketch/drawing/panel_check.h"
#include "tests/sketch/pattern/flat_patterns.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

using ::testing::HasSubstr;

constexpr double kPdfPointMm = 25.4 / 72;  // mm

/// Lines of a page by colour ("0 0 1"), in millimetres of the page, and its texts.
struct ReadPdfPage {
  Eigen::Vector2d size;
  std::vector<test::ReadLine> lines;  ///< layer: the colour of strokes
  std::vector<std::string> texts;
  int clips = 0;

  [[nodiscard]] std::vector<test::ReadLine> find(const std::string& colour) const {
    std::vector<test::ReadLine> found;
    for (const test::ReadLine& line : lines) {
      if (line.layer == colour) found.push_back(line);
    }
    return found;
  }
};

/// Follows the table of objects, not the order in the file.
class PdfTestReader {
 public:
  explicit PdfTestReader(std::string bytes) : bytes_(std::move(bytes)) {
    EXPECT_TRUE(bytes_.starts_with("%PDF-1.4\n"));
    EXPECT_TRUE(bytes_.ends_with("%%EOF\n"));
    const std::size_t table = std::stoul(bytes_.substr(bytes_.rfind("startxref") + 10));
    EXPECT_EQ(bytes_.substr(table, 7), "xref\n0 ");
    const std::size_t count = std::stoul(bytes_.substr(table + 7));
    const std::size_t first = bytes_.find('\n', table + 6) + 1;
    EXPECT_EQ(bytes_.substr(first, 20), "0000000000 65535 f \n");
    for (std::size_t i = 1; i < count; ++i) {
      const std::string entry = bytes_.substr(first + 20 * i, 20);
      EXPECT_EQ(entry.substr(10), " 00000 n \n");
      offsets_.push_back(std::stoul(entry));
      EXPECT_TRUE(bytes_.substr(offsets_.back()).starts_with(std::to_string(i) + " 0 obj\n"));
    }
    EXPECT_TRUE(bytes_.substr(first + 20 * count).starts_with("trailer"));
  }

  [[nodiscard]] std::string object(std::size_t number) const {
    const std::size_t from = bytes_.find('\n', offsets_.at(number - 1)) + 1;
    return bytes_.substr(from, bytes_.find("\nendobj\n", from) - from);
  }

  /// The number of an object that `key` refers to.
  static std::size_t reference(const std::string& text, const std::string& key) {
    return std::stoul(text.substr(text.find(key) + key.size()));
  }

  [[nodiscard]] std::vector<ReadPdfPage> pages() const {
    const std::string trailer = bytes_.substr(bytes_.rfind("trailer"));
    const std::string root = object(reference(trailer, "/Root "));
    EXPECT_THAT(root, HasSubstr("/PrintScaling /None"));
    const std::string tree = object(reference(root, "/Pages "));
    std::istringstream kids(tree.substr(tree.find("/Kids [") + 7));
    std::vector<ReadPdfPage> pages;
    for (std::size_t kid = 0, zero = 0; kids >> kid >> zero;) {
      std::string r;
      kids >> r;
      pages.push_back(page(object(kid)));
    }
    EXPECT_EQ(pages.size(), reference(tree, "/Count "));
    return pages;
  }

 private:
  [[nodiscard]] ReadPdfPage page(const std::string& text) const {
    ReadPdfPage page;
    std::istringstream box(text.substr(text.find("/MediaBox [") + 11));
    double x = 1, y = 1;
    box >> x >> y >> page.size.x() >> page.size.y();
    EXPECT_EQ(Eigen::Vector2d(x, y), Eigen::Vector2d(0, 0));
    page.size *= kPdfPointMm;
    const std::string contents = object(reference(text, "/Contents "));
    const std::size_t from = contents.find("stream\n") + 7;
    const std::size_t length = reference(contents, "/Length ");
    EXPECT_EQ(contents.substr(from + length), "\nendstream");
    run(contents.substr(from, length), page);
    return page;
  }

  /// The operators that a drawing of lines and texts needs; others fail the test.
  static void run(const std::string& content, ReadPdfPage& page) {
    std::istringstream lines(content);
    double scale = 1;
    std::string colour;
    test::ReadLine path;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("BT ")) {
        page.texts.push_back(line.substr(line.find('(')));
        EXPECT_TRUE(line.ends_with(" Tj ET"));
        continue;
      }
      std::istringstream words(line);
      std::vector<std::string> operands;
      for (std::string word; words >> word;) {
        const auto number = [&](std::size_t i) { return std::stod(operands.at(i)); };
        if (word == "cm")
          scale = number(0);
        else if (word == "RG")
          colour = operands[0] + " " + operands[1] + " " + operands[2];
        else if (word == "W")
          ++page.clips;
        else if (word == "m" || word == "l") {
          path.points.push_back(kPdfPointMm * scale * Eigen::Vector2d(number(0), number(1)));
        } else if (word == "s" || word == "S") {
          path.layer = colour;
          path.closed = word == "s";
          page.lines.push_back(std::exchange(path, {}));
        } else if (std::string_view("0123456789-.[").find(word[0]) != std::string_view::npos) {
          operands.push_back(word);
          continue;
        } else {
          EXPECT_THAT((std::vector<std::string>{"j", "J", "w", "q", "Q", "re", "n", "rg", "d"}),
                      ::testing::Contains(word));
        }
        operands.clear();
      }
    }
  }

  std::string bytes_;
  std::vector<std::size_t> offsets_;
};

std::vector<ReadPdfPage> read_pdf(const PatternSheet& sheet, const TileOptions& tiles = {}) {
  return PdfTestReader(pdf_document(sheet, sheet_pages(sheet, tiles), {})).pages();
}

TEST(PatternPdf, DrawsThePanelsAtTrueSize) {
  const Pattern pattern = test::bucket();
  const PatternSheet sheet = pattern_sheet(pattern, {});
  const auto pages = read_pdf(sheet);
  ASSERT_EQ(pages.size(), 1U);
  EXPECT_LT((pages[0].size - sheet.size).norm(), 1e-4);
  const auto sewn = pages[0].find("0 0 1"), cut = pages[0].find("1 0 0");
  ASSERT_EQ(sewn.size(), 2U);
  ASSERT_EQ(cut.size(), 2U);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    EXPECT_TRUE(sewn[k].closed && cut[k].closed);
    test::expect_panel(pattern.pieces[k], sewn[k].points);
    EXPECT_NEAR(test::distance_of_closed(cut[k].points, sewn[k].points), 7, 1e-4);
  }
  // Black lines: the scale bar first, then its ticks.
  const auto black = pages[0].find("0 0 0");
  ASSERT_EQ(black.size(), 12U);
  EXPECT_NEAR((black[0].points[1] - black[0].points[0]).norm(), 100, 1e-4);
}

TEST(PatternPdf, TellsPagesAndTextsApart) {
  SheetOptions options;
  options.title = "A (b) \\ \xC3\xA9 \xE2\x82\xAC \xE6\x9D\xB1";
  const PatternSheet sheet = pattern_sheet(test::bucket(), options);
  const std::string bytes = pdf_document(sheet, sheet_pages(sheet, {}), {});
  EXPECT_THAT(bytes, HasSubstr("(A \\(b\\) \\\\ \\351 ? ?) Tj ET"));
  EXPECT_THAT(bytes, HasSubstr("/Title <FEFF0041002000280062002900200"
                               "05C002000E9002020AC00206771>"));
  for (const char c : bytes.substr(15)) ASSERT_TRUE(c == '\n' || (c >= 0x20 && c < 0x7F));
  EXPECT_THAT(read_pdf(sheet)[0].texts, ::testing::Contains(HasSubstr("(wall)")));
}

// Every page shows the sheet's lines where its window says, so that all together show all of it.
TEST(PatternPdf, TilesAgreeWithTheSheet) {
  const PatternSheet sheet = pattern_sheet(test::bucket(), {});
  const TileOptions tiles{.paper = PaperFormat::a4};
  const auto windows = sheet_pages(sheet, tiles);
  const auto pages = read_pdf(sheet, tiles);
  ASSERT_EQ(pages.size(), windows.size());
  ASSERT_GT(pages.size(), 4U);
  std::set<std::size_t> seen;
  const PlaneLoop& wall = sheet.pieces[0].lines[0].points;
  for (std::size_t k = 0; k < pages.size(); ++k) {
    EXPECT_LT((pages[k].size - Eigen::Vector2d(210, 297)).norm(), 1e-4);
    EXPECT_EQ(pages[k].clips, 1);
    EXPECT_THAT(pages[k].texts, ::testing::Contains(HasSubstr("(" + windows[k].label + " ")));
    for (const test::ReadLine& line : pages[k].find("1 0 0")) {
      if (line.points.size() != wall.size()) continue;
      for (std::size_t i = 0; i < wall.size(); ++i) {
        const Eigen::Vector2d on_sheet = wall[i] + sheet.pieces[0].place;
        EXPECT_LT((line.points[i] - windows[k].on_page(on_sheet)).norm(), 1e-4);
        if (windows[k].window.contains(on_sheet)) seen.insert(i);
      }
    }
  }
  EXPECT_EQ(seen.size(), wall.size());
}

TEST(PatternPdf, RefusesADocumentWithoutPages) {
  const PatternSheet sheet = pattern_sheet(test::bucket(6), {});
  EXPECT_THAT(test::error_of([&] { pdf_document(sheet, {}, {}); }), HasSubstr("no page"));
}

}  // namespace
}  // namespace geoprior::sketch
