#include "testbed/formats/svg/transform.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "testbed/formats/svg/text.h"

namespace geoprior {
namespace {

constexpr const char* kFunctions = "matrix, translate, scale, rotate, skewX, skewY";

double svg_radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// The numbers between brackets.
std::vector<double> arguments_of(SvgText& text) {
  if (!text.skip('(')) text.fail("'(' is missing", "(…)");
  std::vector<double> values;
  while (!text.skip(')')) {
    constexpr std::size_t kMostArguments = 6;
    if (values.size() == kMostArguments) text.fail("too many numbers, or ')' is missing", "(…)");
    values.push_back(text.number());
  }
  return values;
}

Eigen::Affine2d svg_matrix(double a, double b, double c, double d, double e, double f) {
  Eigen::Affine2d map;
  map.matrix() << a, c, e, b, d, f, 0, 0, 1;
  return map;
}

Eigen::Affine2d svg_rotation(double degrees, const Eigen::Vector2d& about) {
  const double c = std::cos(svg_radians(degrees)), s = std::sin(svg_radians(degrees));
  const Eigen::Affine2d turn = svg_matrix(c, s, -s, c, 0, 0);
  return Eigen::Translation2d(about) * turn * Eigen::Translation2d(-about);
}

Eigen::Affine2d svg_function(SvgText& text) {
  const std::string_view name = text.word();
  if (name.empty()) text.fail("a transformation is missing", kFunctions);
  const std::vector<double> v = arguments_of(text);
  const std::size_t n = v.size();
  if (name == "matrix" && n == 6) return svg_matrix(v[0], v[1], v[2], v[3], v[4], v[5]);
  if (name == "translate" && (n == 1 || n == 2))
    return svg_matrix(1, 0, 0, 1, v[0], n == 2 ? v[1] : 0);
  if (name == "scale" && (n == 1 || n == 2))
    return svg_matrix(v[0], 0, 0, n == 2 ? v[1] : v[0], 0, 0);
  if (name == "rotate" && n == 1) return svg_rotation(v[0], Eigen::Vector2d::Zero());
  if (name == "rotate" && n == 3) return svg_rotation(v[0], {v[1], v[2]});
  if (name == "skewX" && n == 1) return svg_matrix(1, 0, std::tan(svg_radians(v[0])), 1, 0, 0);
  if (name == "skewY" && n == 1) return svg_matrix(1, std::tan(svg_radians(v[0])), 0, 1, 0, 0);
  text.fail("no transformation '" + std::string(name) + "' of " + std::to_string(n) + " numbers",
            kFunctions);
}

}  // namespace

Eigen::Affine2d parse_svg_transform(std::string_view text, const std::string& where) {
  SvgText reader(text, where);
  Eigen::Affine2d map = Eigen::Affine2d::Identity();
  while (reader.peek() != 0) {
    map = map * svg_function(reader);
    reader.skip(',');
  }
  return map;
}

double largest_stretch(const Eigen::Affine2d& map) {
  // Singular values of a 2 x 2 matrix: halves of sums of lengths of (a + d, c - b), (a - d, b + c).
  const Eigen::Matrix2d m = map.linear();
  return (std::hypot(m(0, 0) + m(1, 1), m(1, 0) - m(0, 1)) +
          std::hypot(m(0, 0) - m(1, 1), m(1, 0) + m(0, 1))) /
         2;
}

}  // namespace geoprior
