// Outlines that are known, drawn in the ways that SVG allows: units of the page, viewBox,
// transforms, groups, use, symbols, commands of paths, styles, lines that touch, clips. What is
// right is computed from the outline by the matrices that were written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "experiments/paper/scene/svg_pattern.h"
#include "tests/support/perturbed.h"
#include "tests/support/svg_samples.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::paper {
namespace {

using Points = std::vector<Eigen::Vector2d>;

double area_of(const Points& points) {
  double twice = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d &a = points[i], &b = points[(i + 1) % points.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2;
}

class PerturbedSvg {
 public:
  explicit PerturbedSvg(int seed) : samples_(seed) {
    border_ = samples_.star({100, 80}, 40, 5 + samples_.below(8), samples_.maybe(2));
    if (samples_.maybe(2)) {
      same_way_ = samples_.maybe(2);
      const bool border_turned = signed_area_of(border_) < 0;
      hole_ = samples_.star({100, 80}, 8, 4, border_turned == same_way_);
    }
    even_odd_ = samples_.maybe(2);
    make_page();
    text_ = samples_.file(drawing());
  }

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const SvgPatternOptions& options() const { return options_; }
  [[nodiscard]] bool has_hole() const {
    return !hole_.empty() && (even_odd_ || !same_way_ || lines_);
  }
  [[nodiscard]] double area() const {
    return unit_.prod() * (area_of(border_) - (has_hole() ? area_of(hole_) : 0));
  }
  /// The corners where the pattern has them: in metres, y up, the middle of the box at the origin.
  [[nodiscard]] Points corners() const {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : border_) box.extend(p);
    Points all = border_;
    if (has_hole()) all.insert(all.end(), hole_.begin(), hole_.end());
    for (Eigen::Vector2d& p : all)
      p = (p - box.center()).cwiseProduct(Eigen::Vector2d(unit_.x(), -unit_.y()));
    return all;
  }

 private:
  static double signed_area_of(const Points& points) {
    double twice = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d &a = points[i], &b = points[(i + 1) % points.size()];
      twice += a.x() * b.y() - a.y() * b.x();
    }
    return twice;
  }

  /// Size and viewBox of the page, and how large a unit is by what the options say.
  void make_page() {
    const std::string unit = samples_.one_of({"mm", "cm", "in", "pt", "pc", "Q", "px", ""});
    const bool sized = !samples_.maybe(5);
    const auto width = test::svg_page_size(10 + samples_.below(40), unit);
    const auto height = test::svg_page_size(10 + samples_.below(40), unit);
    const Eigen::Vector2d box(200 + samples_.below(100), 150 + samples_.below(100));
    const Eigen::Vector2d corner(samples_.below(60) - 30, samples_.below(60) - 30);
    const std::string how = samples_.one_of(
        {"", "none", "xMidYMid meet", "xMinYMax slice", "xMaxYMid", "xMidYMin slice"});
    page_ = " viewBox=" + samples_.quoted(samples_.pair(corner) + " " + samples_.pair(box));
    if (sized) page_ += " width='" + width.text + "' height='" + height.text + "'";
    if (!how.empty()) page_ += " preserveAspectRatio='" + how + "'";
    Eigen::Vector2d by_page(0.0254 / 96, 0.0254 / 96);
    if (sized) {
      by_page = Eigen::Vector2d(width.metres, height.metres).cwiseQuotient(box);
      if (how.ends_with("slice")) by_page.setConstant(by_page.maxCoeff());
      if (how != "none" && !how.ends_with("slice")) by_page.setConstant(by_page.minCoeff());
    }
    choose_scale(by_page, sized && width.absolute);
  }

  void choose_scale(const Eigen::Vector2d& by_page, bool absolute) {
    options_.tolerance = 1e-5;
    const int way = samples_.below(4);
    if (way == 0) options_.unit = SvgScale::page;
    if (way == 1) options_.unit = SvgScale::view_box;
    if (way != 0 && samples_.maybe(2)) options_.unit_m = samples_.between(1e-3, 3e-3);
    const bool page = way == 0 || (way != 1 && !options_.unit_m && absolute);
    unit_ = page ? by_page : Eigen::Vector2d::Constant(options_.unit_m.value_or(1e-3));
  }

  /// What undoes all transforms around it.
  static Points pulled_back(const Points& points, const Eigen::Affine2d& map) {
    Points back;
    for (const Eigen::Vector2d& p : points) back.push_back(map.inverse() * p);
    return back;
  }

  std::string shape(const Eigen::Affine2d& map, const std::string& attributes) {
    Eigen::Affine2d own;
    const std::string transform = samples_.transform(own);
    const Points border = pulled_back(border_, map * own);
    if (hole_.empty() && samples_.maybe(2)) {
      std::string points;
      for (const Eigen::Vector2d& p : border) points += samples_.pair(p) + " ";
      return "<" + prefix_ + samples_.one_of({"polygon", "polyline"}) + attributes + transform +
             " points=" + samples_.quoted(points) + "/>";
    }
    samples_.begin_path();
    std::string d = samples_.path(border);
    if (!hole_.empty()) {
      const std::string hole = samples_.path(pulled_back(hole_, map * own));
      d += hole;
    }
    return "<" + prefix_ + "path" + attributes + transform + " d=" + samples_.quoted(d) + "/>";
  }

  /// Each edge an element, in any order and either way round.
  std::string separate_lines(const Eigen::Affine2d& map) {
    lines_ = true;
    std::vector<std::string> edges;
    for (const Points* loop : {&border_, &hole_}) {
      const Points points = pulled_back(*loop, map);
      for (std::size_t i = 0; i < points.size(); ++i) {
        Eigen::Vector2d a = points[i], b = points[(i + 1) % points.size()];
        if (samples_.maybe(2)) std::swap(a, b);
        samples_.begin_path();
        edges.push_back(samples_.maybe(2)
                            ? "<" + prefix_ + "path d='" + samples_.path({a, b}, false) + "'/>"
                            : "<" + prefix_ + "line x1='" + samples_.number(a.x()) + "' y1='" +
                                  samples_.number(a.y()) + "' x2='" + samples_.number(b.x()) +
                                  "' y2='" + samples_.number(b.y()) + "'/>");
      }
    }
    std::string text;
    while (!edges.empty()) {
      const auto at = edges.begin() + samples_.below(static_cast<int>(edges.size()));
      text += *at + "\n";
      edges.erase(at);
    }
    return text;
  }

  std::string fill_rule() {
    const std::string rule = even_odd_ ? "evenodd" : "nonzero";
    switch (samples_.below(even_odd_ ? 4 : 5)) {
      case 0:
        return " fill-rule='" + rule + "'";
      case 1:
        return " style='fill:#123; fill-rule: " + rule + "'";
      case 2:
        style_ = ".cut { fill-rule: " + rule + " }";
        return " class='sheet cut'";
      case 3:
        style_ = "path, polygon { fill-rule: " + rule + " !important }";
        return " fill-rule='" + std::string(even_odd_ ? "nonzero" : "evenodd") + "'";
      default:
        return "";  // nonzero is what holds without a word
    }
  }

  std::string drawing() {
    if (samples_.maybe(4)) prefix_ = "svg:";
    Eigen::Affine2d outer;
    const std::string around = samples_.transform(outer);
    std::string defs, inside;
    const int way = samples_.below(5);
    options_.path = "p";
    if (way == 0) {
      inside = shape(outer, " id='p'" + fill_rule());
    } else if (way == 1) {
      inside = "<" + prefix_ + "g id='p'>" + separate_lines(outer) + "</" + prefix_ + "g>";
    } else if (way == 2) {
      const Eigen::Vector2d by(samples_.below(50), -samples_.below(50));
      const Eigen::Affine2d moved = outer * Eigen::Translation2d(by);
      defs = shape(moved, " id='q'" + fill_rule());
      inside = "<" + prefix_ + "use id='p' " + samples_.one_of({"href", "xlink:href"}) +
               "='#q' x='" + samples_.number(by.x()) + "' y='" + samples_.number(by.y()) + "'/>";
    } else if (way == 3) {
      const Eigen::Affine2d in_symbol =
          outer * Eigen::Translation2d(-500, -500) * Eigen::AlignedScaling2d(2, 2);
      defs = "<" + prefix_ + "symbol id='s' overflow='visible' viewBox='0 0 500 500'>" +
             shape(in_symbol, fill_rule()) + "</" + prefix_ + "symbol>";
      inside =
          "<" + prefix_ + "use id='p' href='#s' x='-500' y='-500' width='1000' height='1000'/>";
    } else {
      const Eigen::Affine2d nested =
          outer * Eigen::Translation2d(-100, -50) * Eigen::AlignedScaling2d(0.5, 0.5);
      inside = "<" + prefix_ +
               "svg x='-100' y='-50' width='1000' height='900' "
               "viewBox='0 0 2000 1800' preserveAspectRatio='none' overflow='visible'>" +
               shape(nested, " id='p'" + fill_rule()) + "</" + prefix_ + "svg>";
    }
    std::string text = "<" + prefix_ + "svg xmlns" + (prefix_.empty() ? "" : ":svg") +
                       "='http://www.w3.org/2000/svg' "
                       "xmlns:xlink='http://www.w3.org/1999/xlink'" +
                       page_ + ">\n";
    if (!style_.empty())
      text += "<" + prefix_ + "style>/* cut */ " + style_ + "</" + prefix_ + "style>\n";
    if (samples_.maybe(2)) text += "<" + prefix_ + "rect id='other' width='9' height='9'/>\n";
    text += "<" + prefix_ + "defs>" + defs + "</" + prefix_ + "defs>\n<" + prefix_ + "g" + around +
            ">\n" + inside + "\n</" + prefix_ + "g></" + prefix_ + "svg>\n";
    return text;
  }

  test::SvgSamples samples_;
  Points border_, hole_;
  bool same_way_ = false, even_odd_ = false, lines_ = false;
  Eigen::Vector2d unit_{1e-3, 1e-3};
  SvgPatternOptions options_;
  std::string page_, style_, prefix_, text_;
};

using LongPerturbedSvgs = test::ScratchFolder;

TEST_F(LongPerturbedSvgs, GiveTheOutlineThatWasDrawn) {
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    const PerturbedSvg drawn(seed);
    const auto file = write("outline.svg", drawn.text());
    std::vector<std::string> notes;
    Pattern pattern;
    ASSERT_NO_THROW(pattern = read_svg_pattern(file, drawn.options(), notes))
        << "seed " << seed << "\n"
        << drawn.text();
    const double across = width(pattern);
    EXPECT_NEAR(signed_area(pattern), drawn.area(), 1e-8 * across * across)
        << "seed " << seed << "\n"
        << drawn.text();
    EXPECT_EQ(pattern.holes.size(), drawn.has_hole() ? 1U : 0U) << "seed " << seed;
    double farthest = 0;
    for (const Eigen::Vector2d& p : drawn.corners())
      farthest = std::max(farthest, nearest_on_loops(pattern, p).distance);
    EXPECT_LT(farthest, 1e-8 * across) << "seed " << seed << "\n" << drawn.text();
    if (HasFailure()) return;
  }
}

// Round shapes: the areas of the formulas, less what chords cut off.
TEST_F(LongPerturbedSvgs, GiveTheAreaOfRoundShapes) {
  const double pi = std::numbers::pi;
  for (int seed = 0; seed < perturbed_files(); ++seed) {
    test::SvgSamples samples(seed);
    const double a = samples.between(10, 50), b = samples.between(10, 50),
                 r = samples.between(1, 4);
    const auto n = [&](double x) { return samples.number(x); };
    const std::string ends = n(a) + "," + n(b) + " " + n(samples.below(180));
    const std::vector<std::pair<std::string, double>> shapes{
        {"<circle cx='" + n(r) + "' r='" + n(a) + "'/>", pi * a * a},
        {"<ellipse cy='" + n(r) + "' rx='" + n(a) + "' ry='" + n(b) + "'/>", pi * a * b},
        {"<rect x='" + n(r) + "' width='" + n(a) + "' height='" + n(b) + "' rx='" + n(r) + "'/>",
         a * b - (4 - pi) * r * r},
        {"<path d='M0 0A" + n(a) + " " + n(a) + " 0 1 0 " + n(2 * a) + " 0 " + n(a) + " " + n(a) +
             " 0 1 0 0 0Z'/>",
         pi * a * a},
        {"<path d='M0 0q" + n(a / 2) + " " + n(b) + " " + n(a) + " 0z'/>", a * b / 3},
        {"<path d='M0 0c0 " + n(b) + " " + n(a) + " " + n(b) + " " + n(a) + " 0z'/>", 0.6 * a * b}};
    const auto& [shape, area] = shapes[static_cast<std::size_t>(samples.below(6))];
    Eigen::Affine2d map;
    const std::string transform = samples.transform(map);
    const auto file = write("round.svg", samples.file("<svg xmlns='http://www.w3.org/2000/svg'><g" +
                                                      transform + ">" + shape + "</g></svg>"));
    std::vector<std::string> notes;
    SvgPatternOptions options;
    options.tolerance = 1e-5;
    const Pattern pattern = read_svg_pattern(file, options, notes);
    const double expected = 1e-6 * area * std::abs(map.linear().determinant());
    EXPECT_NEAR(signed_area(pattern), expected, 4e-3 * expected)
        << "seed " << seed << shape << transform;
  }
}

}  // namespace
}  // namespace geoprior::paper
