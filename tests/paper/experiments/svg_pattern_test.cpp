#include "experiments/paper/scene/svg_pattern.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/error.h"
#include "core/random.h"
#include "testbed/formats/svg/path.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::paper {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Points = std::vector<Eigen::Vector2d>;

/// The first line of path data, closed.
Points path(const std::string& d, double tolerance = 1e-3) {
  Points points = flatten_svg_subpaths(d, tolerance, "drawing")[0].points;
  if (points.front() == points.back()) points.pop_back();
  return points;
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
  EXPECT_THAT(refusal("M0 0 1 0 1 1Z 5"), HasSubstr("number follows Z"));
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
      for (const SvgSubpath& line : flatten_svg_subpaths(d, 1e-3, "drawing")) {
        for (const Eigen::Vector2d& p : line.points) ASSERT_TRUE(p.allFinite()) << d;
      }
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 19000);
}

/// Whatever the reader has to say of it.
Pattern read_pattern(const std::filesystem::path& file, const SvgPatternOptions& options) {
  std::vector<std::string> notes;
  return read_svg_pattern(file, options, notes);
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
  /// Of a whole file; `notes` are what was said of it.
  Pattern noted(const std::string& text, const SvgPatternOptions& options) {
    const auto name = folder_ / "noted.svg";
    std::ofstream(name) << text;
    notes_.clear();
    return read_svg_pattern(name, options, notes_);
  }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  [[nodiscard]] std::string refusal(const std::string& inside,
                                    const SvgPatternOptions& options = {}) const {
    const auto name = file(inside);
    const std::string error = test::error_of([&] { read_pattern(name, options); });
    EXPECT_THAT(error, HasSubstr(name.string()));
    return error;
  }

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> notes_;
};

// Millimetres, y down: the point that is highest in the drawing is highest in the pattern.
TEST_F(SvgPattern, LooksLikeTheDrawing) {
  const Pattern p = read_pattern(file("<g><path id='triangle' d='M10 30 L30 30 L10 10Z'/></g>"),
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
  const Pattern p =
      read_pattern(file("<path id='a' d='M0 0 9 0 9 9Z'/><path id='b' d='M0 0H2V1H0Z'/>"), options);
  EXPECT_NEAR(signed_area(p), 2, 1e-15);
  EXPECT_NEAR(nearest_on_border(p, {2, -1}).distance, 0, 1e-15);
}

/// User units of 1 m, where they are drawn.
SvgPatternOptions as_drawn(const std::optional<std::string>& id = {}) {
  SvgPatternOptions options;
  options.path = id;
  options.unit_m = 1;
  options.tolerance = 1e-4;
  options.centred = false;
  return options;
}

// Areas of circle and ellipse, less what chords of sagitta 1e-4 cut off: about 4/3 of it a radius.
TEST_F(SvgPattern, ReadsEveryShapeThatEnclosesSomething) {
  const double pi = std::numbers::pi;
  const std::vector<std::pair<std::string, double>> shapes{
      {"<polygon points='0,0 4,0 4,3'/>", 6},
      {"<polyline points='0,0 4,0 4,3'/>", 6},
      {"<polyline points='0,0 4,0 4,3 0,0'/>", 6},
      {"<rect x='1' y='2' width='3' height='4'/>", 12},
      {"<rect x='1' y='2' width='3' height='4' rx='0.5'/>", 12 - (4 - pi) * 0.25},
      {"<rect x='1' y='2' width='3' height='4' rx='9' ry='0.5'/>", 12 - (4 - pi) * 0.75},
      {"<circle cx='5' cy='6' r='2'/>", 4 * pi},
      {"<ellipse cx='5' cy='6' rx='2' ry='0.5'/>", pi},
      {"<path d='M0 0 4 0 4 3'/>", 6}};
  for (const auto& [shape, area] : shapes) {
    const Pattern p = read_pattern(file(shape), as_drawn());
    EXPECT_NO_THROW(require_simple(p, shape));
    EXPECT_NEAR(signed_area(p), area, 2e-3) << shape;
    EXPECT_TRUE(p.holes.empty()) << shape;
  }
  // A line encloses nothing and is no choice beside the shape; what is not shown is none either.
  EXPECT_EQ(read_pattern(file("<line x2='4'/><defs><rect width='3' height='3'/></defs>"
                              "<rect width='9' height='9' display='none'/>"
                              "<polygon points='0,0 4,0 4,3'/>"),
                         as_drawn())
                .border.size(),
            3U);
}

// A square of 10 with two of 2: whichever way they run, and in whatever order they are drawn.
TEST_F(SvgPattern, SubpathsInTheBorderAreHoles) {
  const std::string border = "M0 0H10V10H0Z", hole = "M2 2h2v2h-2z", other = "M6 6v2h2v-2z";
  for (const std::string& d : {border + hole + other, border + other + hole, hole + border + other,
                               other + hole + border}) {
    const Pattern p =
        read_pattern(file("<path id='a' fill-rule='evenodd' d='" + d + "'/>"), as_drawn());
    EXPECT_NO_THROW(require_simple(p, d));
    EXPECT_NEAR(signed_area(p), 92, 1e-12) << d;
    ASSERT_EQ(p.holes.size(), 2U);
    EXPECT_TRUE(contains(p, {1, -1}));
    EXPECT_FALSE(contains(p, {3, -3}));
    EXPECT_FALSE(contains(p, {7, -7}));
    EXPECT_TRUE(contains(p, {5, -5}));
  }
  // The box of the border, not that of all, is centred: here they are the same.
  SvgPatternOptions centred = as_drawn();
  centred.centred = true;
  const Pattern p = read_pattern(file("<path d='" + border + hole + "' fill='none'/>"), centred);
  EXPECT_TRUE(contains(p, {0, 0}));
  EXPECT_FALSE(contains(p, {-2, 2}));
}

// The L of a path with a hole, by matrices that are written down beside it.
TEST_F(SvgPattern, AppliesTheTransformsOfTheShapeAndAroundIt) {
  const std::string ell = "M0 0H4V1H2V3H0ZM.5 .5V1H1V.5Z";
  const auto with = [&](const std::string& outer, const std::string& own) {
    return read_pattern(
        file("<g transform='" + outer + "'><path transform='" + own + "' d='" + ell + "'/></g>"),
        as_drawn());
  };
  const Pattern plain = with("", "");
  const auto expect_image = [&](const Pattern& p, const Eigen::Matrix2d& map,
                                const Eigen::Vector2d& shift) {
    EXPECT_NO_THROW(require_simple(p, "transformed"));
    EXPECT_NEAR(signed_area(p), std::abs(map.determinant()) * signed_area(plain), 1e-12);
    ASSERT_EQ(corners(p).size(), corners(plain).size());
    // In the drawing's axes, y down.
    const Eigen::DiagonalMatrix<double, 2> flip(1, -1);
    for (const Eigen::Vector2d& q : corners(plain)) {
      const Eigen::Vector2d image = flip * (map * (flip * q) + shift);
      EXPECT_NEAR(nearest_on_border(p, image).distance, 0, 1e-12);
      const std::vector<Eigen::Vector2d> all = corners(p);
      EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Eigen::Vector2d& c) {
        return (c - image).norm() < 1e-12;
      }));
    }
  };
  const double s = std::sin(std::numbers::pi / 6), c = std::cos(std::numbers::pi / 6);
  Eigen::Matrix2d map;
  map << c, -s, s, c;
  expect_image(with("rotate(30)", "translate(1 2)"), map, map * Eigen::Vector2d(1, 2));
  map << 2, 0, 0, 0.5;
  expect_image(with("translate(3)", "scale(2 .5)"), map, {3, 0});
  map << 1, std::tan(std::numbers::pi / 9), 0, 1;
  expect_image(with("", "skewX(20)"), map, {0, 0});
  map << 1, 3, 2, 4;
  expect_image(with("matrix(1 2 3 4 5 6)", ""), map, {5, 6});
  // Mirrored, it runs the other way in the drawing and the right way in the pattern.
  map << -1, 0, 0, 1;
  expect_image(with("scale(-1 1)", ""), map, {0, 0});
  map << 0, 1, 1, 0;
  expect_image(with("", "matrix(0 1 1 0 0 0)"), map, {0, 0});
}

// `use` draws a shape where it stands; a viewBox does not change what a unit is.
TEST_F(SvgPattern, ReadsWhatUseDrawsInUnitsOfTheViewBox) {
  const Pattern p = read_pattern(
      file("<defs><circle id='dot' r='1'/></defs><g id='there'><use href='#dot' x='5'/></g>"),
      as_drawn("dot"));
  EXPECT_NEAR(bounding_box(p).center().x(), 5, 1e-12);
  const auto boxed = folder() / "boxed.svg";
  std::ofstream(boxed) << "<svg xmlns='http://www.w3.org/2000/svg' width='10mm' height='20mm' "
                          "viewBox='-3 -2 5 10'><rect x='1' y='2' width='3' height='1'/></svg>";
  const Pattern q = read_pattern(boxed, as_drawn());
  EXPECT_NEAR(signed_area(q), 3, 1e-12);
  EXPECT_NEAR((bounding_box(q).min() - Eigen::Vector2d(1, -3)).norm(), 0, 1e-12);
}

/// A rectangle of 100 x 50 units on a page.
std::string on_page(const std::string& attributes, const std::string& more = {}) {
  return "<svg xmlns='http://www.w3.org/2000/svg' " + attributes +
         "><path id='p' d='M10 10h100v50h-100z'" + more + "/></svg>";
}

// 1 in = 25.4 mm = 72 pt = 6 pc, and 96 px where nothing says more.
TEST_F(SvgPattern, BelievesThePageWhereItHasASizeInTheWorld) {
  const auto area = [&](const std::string& attributes, const SvgPatternOptions& options = {}) {
    return 1e6 * signed_area(noted(on_page(attributes), options));
  };
  const auto is_noted = [&](const std::string& text) {
    EXPECT_THAT(notes(), ElementsAre(HasSubstr(text))) << text;
  };
  const double point = 25.4 / 72;
  EXPECT_NEAR(area("width='300pt' height='300pt' viewBox='0 0 300 300'"), 5000 * point * point,
              1e-6);
  is_noted("a unit of its viewBox is 0.352778 mm by the size of its page; unit_m says otherwise");
  EXPECT_NEAR(area("width='2in' height='2in' viewBox='0 0 200 200'"), 5000 * 0.254 * 0.254, 1e-6);
  EXPECT_NEAR(area("width='20cm' viewBox='0 0 100 100'"), 5000 * 4, 1e-6);
  EXPECT_NEAR(area("width='200mm' height='100mm' viewBox='0 0 100 100' preserveAspectRatio='none'"),
              5000 * 2, 1e-6);
  is_noted("2 mm x 1 mm");
  EXPECT_NEAR(area("width='200mm' height='100mm' viewBox='0 0 100 100'"), 5000, 1e-6);
  EXPECT_NEAR(area("width='200mm' height='100mm' viewBox='0 0 100 100' "
                   "preserveAspectRatio='xMinYMin slice'"),
              5000 * 4, 1e-6);
  // Nothing in the world: a millimetre, as ever.
  EXPECT_NEAR(area("width='200' height='200' viewBox='0 0 100 100'"), 5000, 1e-6);
  is_noted("is taken for 1 mm; unit_m says otherwise");
  EXPECT_NEAR(area("width='100%' viewBox='0 0 100 100'"), 5000, 1e-6);
}

TEST_F(SvgPattern, TakesTheScaleThatIsAskedFor) {
  const std::string inches = "width='2in' height='2in' viewBox='0 0 200 200'";
  SvgPatternOptions options;
  options.unit_m = 2e-3;
  EXPECT_NEAR(signed_area(noted(on_page(inches), options)), 5000 * 4e-6, 1e-12);
  EXPECT_THAT(notes(), IsEmpty());
  (void)noted(on_page("width='9mm' height='3mm' viewBox='0 0 3 3' preserveAspectRatio='none'"),
              options);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("stretches what it draws, a unit of its viewBox is "
                                             "3 mm x 1 mm, and unit_m does not")));
  options.unit = SvgScale::view_box;
  EXPECT_NEAR(signed_area(noted(on_page(inches), options)), 5000 * 4e-6, 1e-12);
  options.unit_m.reset();
  EXPECT_NEAR(signed_area(noted(on_page(inches), options)), 5000 * 1e-6, 1e-12);
  options.unit = SvgScale::page;
  EXPECT_NEAR(signed_area(noted(on_page(inches), options)), 5000 * 0.254e-3 * 0.254e-3, 1e-12);
  const double pixel = 25.4e-3 / 96;
  EXPECT_NEAR(signed_area(noted(on_page(""), options)), 5000 * pixel * pixel, 1e-12);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("96 are taken for an inch")));
  options.unit_m = 1;
  EXPECT_THAT(test::error_of([&] { (void)noted(on_page(inches), options); }),
              AllOf(HasSubstr("scene.pattern.unit"), HasSubstr("not both")));
}

// Both run the same way round: with nonzero the inner one is a line on a filled square.
TEST_F(SvgPattern, LeavesOutWhatIsNoHoleByItsFillRule) {
  const std::string same = "M10 10h100v100h-100z M30 30h20v20h-20z";
  const std::string other = "M10 10h100v100h-100z M30 30v20h20v-20z";
  const auto area = [&](const std::string& shape) {
    return signed_area(
        noted("<svg xmlns='http://www.w3.org/2000/svg'>" + shape + "</svg>", as_drawn()));
  };
  const auto path = [](const std::string& d, const std::string& more = {}) {
    return "<path d='" + d + "' " + more + "/>";
  };
  EXPECT_NEAR(area(path(same)), 10000, 1e-9);
  EXPECT_THAT(notes(), ElementsAre(AllOf(HasSubstr("line 0"), HasSubstr("nonzero"),
                                         HasSubstr("no hole, and is left out"))));
  EXPECT_NEAR(area(path(same, "transform='scale(-1 1)'")), 10000, 1e-9);
  EXPECT_NEAR(area(path(other)), 9600, 1e-9);
  EXPECT_THAT(notes(), IsEmpty());
  for (const char* more : {"fill-rule='evenodd'", "style='fill-rule:evenodd'", "fill='none'",
                           "style='fill:none' fill-rule='nonzero'"})
    EXPECT_NEAR(area(path(same, more)), 9600, 1e-9) << more;
  EXPECT_NEAR(area("<g fill-rule='evenodd'>" + path(same) + "</g>"), 9600, 1e-9);
  EXPECT_NEAR(area("<style>path { fill-rule: evenodd }</style>" + path(same)), 9600, 1e-9);
  // A hole in the inner line leaves a hole as deep as the paper is thick: none.
  EXPECT_NEAR(area(path(same + "M35 35v5h5v-5z")), 10000, 1e-9);
  EXPECT_EQ(notes().size(), 2U);
  EXPECT_THAT(test::error_of([&] { area(path("M0 0h9v9h-9z M8 8h4v1h-4z")); }),
              HasSubstr("of the border"));
}

// A convex clip path cuts; what it does not reach is as it was.
TEST_F(SvgPattern, IsCutOffByAClipPath) {
  const auto clipped = [&](const std::string& clip, const std::string& shape,
                           const std::string& group = "clip-path='url(#c)'") {
    return noted("<svg xmlns='http://www.w3.org/2000/svg'><defs><clipPath id='c'>" + clip +
                     "</clipPath></defs><g id='g' " + group + ">" + shape + "</g></svg>",
                 as_drawn());
  };
  const std::string box = "<path d='M10,10 h100 v50 h-100 z'/>";
  const Pattern left = clipped("<rect width='60' height='200'/>", box);
  EXPECT_NEAR(signed_area(left), 2500, 1e-9);
  EXPECT_NEAR(bounding_box(left).max().x(), 60, 1e-9);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("clip-path 'c' of g 'g' cuts off a part of it")));
  EXPECT_NEAR(signed_area(clipped("<rect width='60' height='200' transform='scale(.5 1)'/>", box,
                                  "style='clip-path:url(#c)' transform='translate(7 0)'")),
              1000, 1e-9)
      << "in the axes of the group";
  EXPECT_NEAR(signed_area(clipped("<polygon points='60,0 60,200 300,200 300,0'/>", box)), 2500,
              1e-9);
  EXPECT_NEAR(signed_area(clipped("<rect width='500' height='500'/>", box)), 5000, 1e-9);
  EXPECT_THAT(notes(), IsEmpty());
  const std::string holes =
      "<path fill-rule='evenodd' d='M10 10h100v50h-100z M20 20h9v9h-9z "
      "M90 20h9v9h-9z'/>";
  EXPECT_NEAR(signed_area(clipped("<rect width='60' height='200'/>", holes)), 2500 - 81, 1e-9);
  EXPECT_THAT(test::error_of([&] { clipped("<rect width='25' height='200'/>", holes); }),
              HasSubstr("runs across a hole"));
  EXPECT_THAT(test::error_of([&] { clipped("<rect width='5' height='200'/>", box); }),
              HasSubstr("hides all of it"));
}

TEST_F(SvgPattern, SaysWhatOfClipsIsNotApplied) {
  const auto noted_area = [&](const std::string& inside) {
    return signed_area(
        noted("<svg xmlns='http://www.w3.org/2000/svg'>" + inside + "</svg>", as_drawn()));
  };
  const std::string box = "<path d='M10,10 h100 v50 h-100 z'/>";
  EXPECT_NEAR(noted_area("<clipPath id='c'><path d='M0 0H60V99H0ZM5 5v5h5z'/></clipPath>"
                         "<g clip-path='url(#c)'>" +
                         box + "</g>"),
              5000, 1e-9);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("clip-path 'c' of g is not applied")));
  EXPECT_NEAR(noted_area("<mask id='m'><rect width='60' height='99' fill='#fff'/></mask>"
                         "<g mask='url(#m)'>" +
                         box + "</g>"),
              5000, 1e-9);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("mask 'm' of g is not applied")));
  EXPECT_NEAR(noted_area("<svg id='s' width='60' height='90'>" + box + "</svg>"), 5000, 1e-9);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("the viewport of svg 's' hides a part of it")));
  EXPECT_NEAR(noted_area("<svg overflow='visible' width='60' height='90'>" + box + "</svg>"), 5000,
              1e-9);
  EXPECT_THAT(notes(), IsEmpty());
  (void)noted_area(box + "<text>leaf</text>");
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("<text> is not read")));
}

TEST_F(SvgPattern, IsTheIdOfAUseOrAGroup) {
  const auto of = [&](const std::string& inside, const std::string& id) {
    return noted("<svg xmlns='http://www.w3.org/2000/svg'>" + inside + "</svg>", as_drawn(id));
  };
  const std::string dot = "<defs><path id='q' d='M0 0h100v50h-100z'/></defs>";
  const Pattern p =
      of(dot + "<use id='p' href='#q' x='5' y='5'/><use id='r' href='#q' x='300'/>", "p");
  EXPECT_NEAR(signed_area(p), 5000, 1e-9);
  EXPECT_NEAR(bounding_box(p).min().x(), 5, 1e-9);
  EXPECT_NEAR(signed_area(of("<rect width='1' height='1'/><g id='p'><g>" + dot +
                                 "<circle r='0.1' display='none'/><use href='#q'/></g></g>",
                             "p")),
              5000, 1e-9);
  EXPECT_THAT(test::error_of([&] { of("<rect id='a' width='1' height='1'/><g id='p'/>", "p"); }),
              HasSubstr("draws no shape"));
  EXPECT_THAT(
      test::error_of([&] { of(dot + "<g id='p' display='none'><use href='#q'/></g>", "p"); }),
      HasSubstr("is not displayed"));
}

// Four sides in any order and direction, and a circle in them that is cut out.
TEST_F(SvgPattern, JoinsLinesThatTouch) {
  const std::string sides =
      "<line x2='100'/><path d='M100 50V0'/>"
      "<polyline points='0,50 40,50.00005 100,50.00004'/><line y2='50'/>";
  const auto of = [&](const std::string& inside, const std::optional<std::string>& id = {}) {
    return noted("<svg xmlns='http://www.w3.org/2000/svg'>" + inside + "</svg>", as_drawn(id));
  };
  EXPECT_NEAR(signed_area(of("<g fill='none'>" + sides + "</g>")), 5000, 1e-2);
  EXPECT_THAT(notes(),
              ElementsAre(AllOf(HasSubstr("4 open lines were joined"), HasSubstr("0.04 mm"))));
  const Pattern p = of("<rect width='9' height='9'/><g id='p'>" + sides +
                           "<rect x='10' y='10' width='10' height='20'/></g>",
                       "p");
  EXPECT_NEAR(signed_area(p), 4800, 1e-2);
  EXPECT_EQ(p.holes.size(), 1U);
  EXPECT_THAT(test::error_of([&] { of("<g id='p'><line x2='9'/><path d='M9 0V9'/></g>", "p"); }),
              AllOf(HasSubstr("the outline is open"), HasSubstr("scene.pattern.tolerance")));
}

TEST_F(SvgPattern, NamesFileAndShapeOfWhatItRefuses) {
  SvgPatternOptions b;
  b.path = "b";
  EXPECT_THAT(refusal("<text/>"), HasSubstr("draws no shape that encloses anything"));
  EXPECT_THAT(refusal("<line id='b' x2='4'/>", b), HasSubstr("a line encloses nothing"));
  EXPECT_THAT(refusal("<path d='M0 0 1 0 1 1Z'/><rect id='c' width='1' height='1'/>"),
              AllOf(HasSubstr("2 shapes"), HasSubstr("(a path without id), c")));
  EXPECT_THAT(refusal("<path id='a' d='M0 0 1 0 1 1Z'/>", b),
              AllOf(HasSubstr("no shape with id 'b'"), HasSubstr("allowed: a")));
  EXPECT_THAT(refusal("<rect id='b' width='1' height='1'/><use href='#b' x='3'/>", b),
              HasSubstr("'b' is drawn 2 times"));
  EXPECT_THAT(refusal("<path id='b' d='M0 0 1 ?'/>", b),
              AllOf(HasSubstr(":1: path 'b'"), HasSubstr("character 8")));
  EXPECT_THAT(refusal("<path id='b'"), HasSubstr("no valid XML"));
  EXPECT_THAT(refusal("<path id='b' d='M0 0 1 1Z'/>"), HasSubstr("fewer than three points"));
}

TEST_F(SvgPattern, RefusesShapesWithoutArea) {
  for (const std::string shape :
       {"<rect id='a' width='0' height='3'/>", "<rect id='a' width='3'/>", "<circle id='a' r='0'/>",
        "<ellipse id='a' rx='2' ry='0'/>", "<path id='a'/>", "<polygon id='a'/>"}) {
    EXPECT_THAT(refusal(shape), AllOf(HasSubstr("'a'"), HasSubstr("draws nothing"))) << shape;
  }
  EXPECT_THAT(refusal("<rect id='a' width='-1' height='3'/>"), HasSubstr("width is negative"));
  EXPECT_THAT(refusal("<path id='a' d='M0 0H9V9ZM5 5 5 5'/>"),
              AllOf(HasSubstr("character"), HasSubstr("fewer than three points")));
  EXPECT_THAT(refusal("<path id='a' d='M0 0H9V9H0ZM5 5 6 6 7 7Z'/>"),
              AllOf(HasSubstr("path 'a'"), HasSubstr("flattened to a line")));
  for (const std::string map :
       {"scale(1 0)", "scale(0)", "matrix(1 2 2 4 0 0)", "rotate(33) scale(0 1) rotate(12)"}) {
    EXPECT_THAT(refusal("<g transform='" + map + "'><circle id='a' r='3'/></g>"),
                AllOf(HasSubstr("circle 'a'"),
                      AnyOf(HasSubstr("flattened to a line"), HasSubstr("three points"))))
        << map;
  }
}

TEST_F(SvgPattern, NamesTheHolesThatAreNone) {
  const auto holes = [&](const std::string& d) {
    return refusal("<path id='a' style='fill-rule:evenodd' d='M0 0H10V10H0Z" + d + "'/>");
  };
  EXPECT_THAT(holes("M12 2h2v2h-2z"),
              AllOf(HasSubstr("path 'a' hole 0"), HasSubstr("outside of the border")));
  EXPECT_THAT(holes("M2 2h2v2h-2zM8 8h4v1h-4z"),
              AllOf(HasSubstr("path 'a' hole 1 edge"), HasSubstr("of the border")));
  EXPECT_THAT(holes("M2 2h6v6h-6zM4 4h1v1h-1z"),
              AllOf(HasSubstr("hole 1"), HasSubstr("lies in hole 0"), HasSubstr("islands")));
  EXPECT_THAT(holes("M2 2h4v4h-4zM5 5h3v3h-3z"), HasSubstr("of hole 0"));
  EXPECT_THAT(holes("M0 2h2v2h-2z"), HasSubstr("crosses or touches edge 3 of the border"));
  std::string many = "M0 0";
  for (int i = 0; i <= kMostCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / (kMostCorners + 1);
    many +=
        " " + std::to_string(1000 * std::cos(angle)) + " " + std::to_string(1000 * std::sin(angle));
  }
  EXPECT_THAT(refusal("<path id='a' d='" + many + "Z'/>"),
              AllOf(HasSubstr("path 'a'"), HasSubstr("too many corners")));
}

}  // namespace
}  // namespace geoprior::paper
