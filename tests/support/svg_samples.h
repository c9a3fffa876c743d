#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "core/random.h"

namespace geoprior::test {

/// What SVG allows to be written in several ways, drawn at random. Knows what it wrote by its own
/// arithmetic and calls no reader.
class SvgSamples {
 public:
  using Points = std::vector<Eigen::Vector2d>;

  explicit SvgSamples(int seed) : random_(static_cast<std::uint64_t>(seed), "perturbed SVG") {}

  int below(int n) { return static_cast<int>(random_.below(static_cast<std::uint32_t>(n))); }
  bool maybe(int one_in) { return below(one_in) == 0; }
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  std::string one_of(const std::vector<std::string>& texts) {
    return texts[static_cast<std::size_t>(below(static_cast<int>(texts.size())))];
  }

  /// With 12 digits, plain, with an exponent or without a leading zero.
  std::string number(double x) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), maybe(6) ? "%.12e" : "%.12g", x);
    std::string written = text.data();
    if (maybe(3) && written.starts_with("0.")) written.erase(0, 1);
    if (maybe(3) && written.starts_with("-0.")) written.erase(1, 1);
    return written;
  }

  /// A pair and what parts its numbers.
  std::string pair(const Eigen::Vector2d& p) {
    return number(p.x()) + one_of({" ", ",", " , ", "\n"}) + number(p.y());
  }

  /// A polygon about a centre, counter-clockwise in its axes or not, no edge level or upright.
  Points star(const Eigen::Vector2d& centre, double radius, int corners, bool turned) {
    Points points;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * (i + between(0.1, 0.9)) / corners;
      points.push_back(centre + radius * between(0.6, 1) *
                                    Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    if (turned) return {points.rbegin(), points.rend()};
    return points;
  }

  /// Path data of a closed line, absolute and relative commands mixed.
  std::string path(const Points& points, bool closed = true) {
    std::string d = maybe(2) ? "M" + pair(points[0]) : "m" + pair(points[0]);
    // A relative move at the beginning of later subpaths would count from the pen.
    if (!d.starts_with('M') && !first_) d = "M" + d.substr(1);
    first_ = false;
    Eigen::Vector2d pen = points[0];
    for (std::size_t i = 1; i < points.size(); ++i) {
      d += line(pen, points[i]);
      pen = points[i];
    }
    return d + (closed ? one_of({"z", "Z", " Z "}) : "");
  }
  void begin_path() { first_ = true; }

  /// A list for `transform`, and its map.
  std::string transform(Eigen::Affine2d& map) {
    map = Eigen::Affine2d::Identity();
    std::string text;
    for (int n = below(3); n > 0; --n) {
      text += one_function(map);
      text += one_of({" ", ", ", ""});
    }
    return text.empty() ? "" : " transform=" + quoted(text);
  }

  /// In either kind of quotes.
  std::string quoted(const std::string& value) {
    const std::string mark = maybe(2) ? "\"" : "'";
    return mark + value + mark;
  }

  /// Line ends, a byte order mark and a declaration.
  std::string file(std::string text) {
    if (maybe(2)) text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- a drawing -->\n" + text;
    if (maybe(3)) text.insert(0, "\xef\xbb\xbf");
    if (!maybe(3)) return text;
    std::string windows;
    for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    return windows;
  }

 private:
  std::string line(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const Eigen::Vector2d step = to - from;
    switch (below(5)) {
      case 0:
        return "l" + pair(step);
      case 1:  // a curve whose control points lie on the chord
        return "C" + pair(from + step / 3) + " " + pair(from + 2 * step / 3) + " " + pair(to);
      case 2:
        return "q" + pair(step / 2) + "," + pair(step);
      case 3:  // an arc without a radius is a line
        return "A0 0 0 01" + pair(to);
      default:
        return "L" + pair(to);
    }
  }

  std::string one_function(Eigen::Affine2d& map) {
    const double degree = std::numbers::pi / 180;
    switch (below(5)) {
      case 0: {
        const Eigen::Vector2d by(between(-20, 20), between(-20, 20));
        map.translate(rounded(by));
        return "translate(" + written(rounded(by).x()) + " " + written(rounded(by).y()) + ")";
      }
      case 1: {
        const Eigen::Vector2d by =
            rounded({between(0.5, 2), between(0.5, 2) * (maybe(3) ? -1 : 1)});
        map.scale(by);
        return "scale(" + written(by.x()) + "," + written(by.y()) + ")";
      }
      case 2: {
        const double angle = std::round(between(-180, 180));
        map.rotate(angle * degree);
        return "rotate(" + written(angle) + ")";
      }
      case 3: {
        const double angle = std::round(between(-40, 40));
        Eigen::Affine2d skew = Eigen::Affine2d::Identity();
        skew(0, 1) = std::tan(angle * degree);
        map = map * skew;
        return "skewX(" + written(angle) + ")";
      }
      default: {
        Eigen::Affine2d matrix = Eigen::Affine2d::Identity();
        matrix.matrix().topRows<2>() << 1.25, 0.5, -3, -0.25, 0.75, 7;
        map = map * matrix;
        return "matrix(1.25 -.25 .5 .75,-3 7)";
      }
    }
  }

  static Eigen::Vector2d rounded(const Eigen::Vector2d& p) {
    return (100 * p).array().round() / 100;
  }
  static std::string written(double x) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.4g", x);
    return text.data();
  }

  RandomStream random_;
  bool first_ = true;
};

/// A size of the page in one of its units, or none.
struct SvgPageSize {
  std::string text;
  double metres = 0;
  bool absolute = false;
};

/// @param unit  "mm", "cm", "in", "pt", "pc", "Q", "px" or nothing
inline SvgPageSize svg_page_size(double count, const std::string& unit) {
  const double inch = 0.0254;
  double metres = inch / 96;
  if (unit == "mm") metres = 1e-3;
  if (unit == "cm") metres = 1e-2;
  if (unit == "in") metres = inch;
  if (unit == "pt") metres = inch / 72;
  if (unit == "pc") metres = inch / 6;
  if (unit == "Q") metres = 0.25e-3;
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.10g", count);
  return {text.data() + unit, count * metres, !unit.empty() && unit != "px"};
}

}  // namespace geoprior::test
