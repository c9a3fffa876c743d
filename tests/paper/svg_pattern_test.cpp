#include "experiments/paper/svg_pattern.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/error.h"
#include "core/random.h"
#include "experiments/paper/svg_outline.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::paper {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Points = std::vector<Eigen::Vector2d>;

Points path(const std::string& d, double tolerance = 1e-3) {
  return flatten_svg_path(d, tolerance, "drawing");
}

std::string refusal(const std::string& d) {
  return test::error_of([&] { path(d); });
}

double area(const Points& points) { return signed_area(Pattern{points}); }

TEST(SvgPath, ReadsLinesAbsoluteAndRelative) {
  const Points square{{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  EXPECT_EQ(path("M0 0 L2 0 L2 2 L0 2 Z"), square);
  EXPECT_EQ(path("m0,0 2,0 0,2-2,0z"), square) << "pairs after m are relative lines";
  EXPECT_EQ(path("M0 0H2V2H0Z"), square);
  EXPECT_EQ(path("M 0 0 h 2 v 2 h -2 z"), square);
  EXPECT_EQ(path("M0 0L2 0 2 2 0 2 0 0"), square) << "closed by hand";
  EXPECT_EQ(path(" M+0 0e3,2.0.0 20e-1 2 .0,2"), square) << "numbers run together";
}

// A quadratic with its control point at the corner of a 1 x 1 square: area under it is 2/3.
TEST(SvgPath, FlattensBezierCurvesWithinTheTolerance) {
  EXPECT_NEAR(std::abs(area(path("M0 0 Q0 1 1 1 L1 0 Z", 1e-6))), 5.0 / 6, 1e-5);
  // T reflects the control point: the S-shaped double arc has the area of its chord's triangle.
  EXPECT_NEAR(std::abs(area(path("M0 0 Q1 1 2 0 T4 0 L4 -2 0 -2Z", 1e-6))), 8, 1e-5);
  // C and its continuation by S, the same curve in two ways.
  const Points by_c = path("M0 0C0 1 1 2 2 2C3 2 4 1 4 0Z"),
               by_s = path("M0 0C0 1 1 2 2 2S4 1 4 0Z");
  EXPECT_EQ(by_c, by_s);
  EXPECT_EQ(path("m0 0c0 1 1 2 2 2s2 -1 2 -2z").size(), by_c.size());
}

TEST(SvgPath, FlattensArcsWithinTheTolerance) {
  for (const double tolerance : {1e-2, 1e-4}) {
    const Points circle = path("M1 0 A1 1 0 0 1 -1 0 A1 1 0 0 1 1 0Z", tolerance);
    for (std::size_t i = 0; i < circle.size(); ++i) {
      EXPECT_NEAR(circle[i].norm(), 1, 1e-14);
      const Eigen::Vector2d middle = (circle[i] + circle[(i + 1) % circle.size()]) / 2;
      EXPECT_GE(middle.norm(), 1 - tolerance);
    }
    EXPECT_GT(area(circle), std::numbers::pi * (1 - 2 * tolerance));
  }
}

// Flags choose among the four arcs of two circles; areas of the segment of a quarter circle.
TEST(SvgPath, TakesTheArcThatTheFlagsName) {
  const double small = std::numbers::pi / 4 - 0.5, large = std::numbers::pi - small;
  const auto closed_area = [](const std::string& flags) {
    return area(path("M1 0A1 1 0 " + flags + " 0 1Z", 1e-6));
  };
  EXPECT_NEAR(closed_area("0 1"), small, 1e-5);
  EXPECT_NEAR(closed_area("1 1"), large, 1e-5);
  EXPECT_NEAR(closed_area("0 0"), -small, 1e-5);
  EXPECT_NEAR(closed_area("1 0"), -large, 1e-5);
  EXPECT_NEAR(area(path("M1 0A1 1 0 010 1Z", 1e-6)), small, 1e-5) << "flags without spaces";
}

// An ellipse turned by 30 degrees: half of it has the area pi a b / 2; radii too small are scaled.
TEST(SvgPath, TurnsAndEnlargesEllipses) {
  const double c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
  const auto number = [](double x) { return std::to_string(x); };
  const std::string ends = "M" + number(2 * c) + " " + number(2 * s);
  const std::string to = number(-2 * c) + " " + number(-2 * s) + "Z";
  EXPECT_NEAR(area(path(ends + "A2 1 30 0 1 " + to, 1e-6)), std::numbers::pi, 1e-5);
  EXPECT_NEAR(area(path(ends + "A1 0.5 30 0 1 " + to, 1e-6)), std::numbers::pi, 1e-4);
  EXPECT_EQ(path("M0 0A0 1 0 0 1 1 1L0 1Z"), (Points{{0, 0}, {1, 1}, {0, 1}}));
}

TEST(SvgPath, NamesTheCharacterThatIsWrong) {
  EXPECT_THAT(refusal(""), HasSubstr("path data is empty"));
  EXPECT_THAT(refusal("1 2"), HasSubstr("does not begin with a command"));
  EXPECT_THAT(refusal("L1 2 3 4 5 6"), HasSubstr("does not begin with M"));
  EXPECT_THAT(refusal("M0 0 X1 1"), AllOf(HasSubstr("character 6"), HasSubstr("command 'X'")));
  EXPECT_THAT(refusal("M0 0 L1"), AllOf(HasSubstr("character 8"), HasSubstr("number is missing")));
  EXPECT_THAT(refusal("M0 0 Lx 1"), HasSubstr("number is missing"));
  EXPECT_THAT(refusal("M0 0 L1e999 1 2 2"), HasSubstr("no finite number"));
  EXPECT_THAT(refusal("M0 0 Lnan 1"), HasSubstr("number is missing"));
  EXPECT_THAT(refusal("M0 0 A1 1 0 2 0 1 1"), HasSubstr("flag of an arc"));
  EXPECT_THAT(refusal("M0 0 1 0 1 1Z M3 3 4 3 4 4Z"), HasSubstr("second subpath"));
  EXPECT_THAT(refusal("M0 0 1 0 1 1Z 5"), HasSubstr("number follows Z"));
  EXPECT_THAT(refusal("M0 0 1 1Z"), HasSubstr("fewer than three points"));
}

// 20,000 paths with characters exchanged, doubled and cut: points or an Error, nothing else.
TEST(SvgPath, AnswersMutatedPathsWithPointsOrAnError) {
  const std::string good = "M1 0c0-1.5e-1 1 2 2 2S4,1 4 0q1 1 2 0t3 .5A2 1 30 0 1 -2 -1h3V-4l1 1z";
  const std::string letters = "MLHVCSQTAZmlhvcsqtaz0123456789.,-+eE \n#";
  RandomStream random(1, "mutated paths");
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string d = good;
    const std::uint32_t changes = 1 + random.below(4);
    for (std::uint32_t k = 0; k < changes && !d.empty(); ++k) {
      const std::uint32_t at = random.below(static_cast<std::uint32_t>(d.size()));
      const char letter = letters[random.below(static_cast<std::uint32_t>(letters.size()))];
      const std::uint32_t kind = random.below(4);
      if (kind == 0) d[at] = letter;
      if (kind == 1) d.insert(at, 1, letter);
      if (kind == 2) d.erase(at, 1 + random.below(3));
      if (kind == 3) d = d.substr(0, at + 1);
    }
    try {
      for (const Eigen::Vector2d& p : path(d)) ASSERT_TRUE(p.allFinite()) << d;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 19000);
}

class SvgPattern : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("geoprior-svg-" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::filesystem::path file(const std::string& inside) const {
    const auto name = folder_ / "shape.svg";
    std::ofstream(name) << "<svg xmlns='http://www.w3.org/2000/svg'>" << inside << "</svg>";
    return name;
  }
  [[nodiscard]] std::string refusal(const std::string& inside,
                                    const SvgPatternOptions& options = {}) const {
    const auto name = file(inside);
    const std::string error = test::error_of([&] { read_svg_pattern(name, options); });
    EXPECT_THAT(error, HasSubstr(name.string()));
    return error;
  }

 private:
  std::filesystem::path folder_;
};

// Millimetres, y down: the point that is highest in the drawing is highest in the pattern.
TEST_F(SvgPattern, LooksLikeTheDrawing) {
  const Pattern p = read_svg_pattern(file("<g><path id='triangle' d='M10 30 L30 30 L10 10Z'/></g>"),
                                     SvgPatternOptions{});
  ASSERT_EQ(p.border.size(), 3U);
  EXPECT_NEAR(signed_area(p), 2e-4, 1e-15);
  bool top_left = false;
  for (const Eigen::Vector2d& corner : p.border) {
    top_left = top_left || (corner - Eigen::Vector2d(-0.01, 0.01)).norm() < 1e-12;
  }
  EXPECT_TRUE(top_left);
}

TEST_F(SvgPattern, ChoosesByIdAndScales) {
  SvgPatternOptions options;
  options.path = "b";
  options.unit_m = 1;
  options.centred = false;
  const Pattern p = read_svg_pattern(
      file("<path id='a' d='M0 0 9 0 9 9Z'/><path id='b' d='M0 0H2V1H0Z'/>"), options);
  EXPECT_NEAR(signed_area(p), 2, 1e-15);
  EXPECT_NEAR(nearest_on_border(p, {2, -1}).distance, 0, 1e-15);
}

TEST_F(SvgPattern, NamesFileAndPathOfWhatItRefuses) {
  SvgPatternOptions b;
  b.path = "b";
  EXPECT_THAT(refusal("<rect/>"), HasSubstr("no path element"));
  EXPECT_THAT(refusal("<path d='M0 0 1 0 1 1Z'/><path id='c' d='M0 0 1 0 1 1Z'/>"),
              AllOf(HasSubstr("2 paths"), HasSubstr("c")));
  EXPECT_THAT(refusal("<path id='a' d='M0 0 1 0 1 1Z'/>", b),
              AllOf(HasSubstr("no path with id 'b'"), HasSubstr("allowed: a")));
  EXPECT_THAT(refusal("<g transform='scale(2)'><path id='b' d='M0 0 1 0 1 1Z'/></g>", b),
              AllOf(HasSubstr("path 'b'"), HasSubstr("transform on <g>")));
  EXPECT_THAT(refusal("<path id='b' d='M0 0 1 ?'/>", b), HasSubstr("path 'b', character 8"));
  EXPECT_THAT(refusal("<path id='b'"), HasSubstr("no valid XML"));
}

}  // namespace
}  // namespace geoprior::paper
