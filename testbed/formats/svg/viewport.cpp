#include "testbed/formats/svg/viewport.h"

#include <algorithm>
#include <array>

#include "testbed/formats/svg/text.h"

namespace geoprior {
namespace {

/// "Min", "Mid" or "Max" at `at`.
double alignment(std::string_view word, std::size_t at, const SvgText& text) {
  constexpr std::array<std::string_view, 3> kPlaces{"Min", "Mid", "Max"};
  const auto found = std::find(kPlaces.begin(), kPlaces.end(), word.substr(at, 3));
  if (found == kPlaces.end()) text.fail("no alignment", "none, xMinYMin … xMaxYMax");
  return static_cast<double>(found - kPlaces.begin()) / 2;
}

}  // namespace

std::optional<SvgBox> parse_svg_view_box(std::string_view text, const std::string& where) {
  SvgText reader(text, where);
  if (reader.peek() == 0) return std::nullopt;
  SvgBox box;
  for (double* value : {&box.x, &box.y, &box.width, &box.height}) *value = reader.number();
  if (reader.peek() != 0) reader.fail("more than four numbers", "x y width height");
  if (box.width < 0 || box.height < 0) reader.fail("a size is negative", "at least 0");
  return box;
}

SvgAspect parse_svg_aspect(std::string_view text, const std::string& where) {
  SvgText reader(text, where);
  SvgAspect aspect;
  std::string_view word = reader.word();
  if (word == "defer") word = reader.word();
  if (word == "none") {
    aspect.stretched = true;
  } else if (!word.empty()) {
    constexpr std::size_t kLetters = 8;
    if (word.size() != kLetters || word[0] != 'x' || word[4] != 'Y')
      reader.fail("no alignment", "none, xMinYMin … xMaxYMax");
    aspect.align = {alignment(word, 1, reader), alignment(word, 5, reader)};
  }
  const std::string_view how = reader.word();
  aspect.covers = how == "slice";
  if (reader.peek() != 0 || !(how.empty() || how == "meet" || how == "slice"))
    reader.fail("unknown way to fit", "meet, slice");
  return aspect;
}

Eigen::Affine2d fit_svg_box(const SvgBox& from, const SvgBox& to, const SvgAspect& aspect) {
  Eigen::Vector2d scale(to.width / from.width, to.height / from.height);
  if (!aspect.stretched) scale.setConstant(aspect.covers ? scale.maxCoeff() : scale.minCoeff());
  const Eigen::Vector2d left_over = Eigen::Vector2d(to.width, to.height) -
                                    scale.cwiseProduct(Eigen::Vector2d(from.width, from.height));
  const Eigen::Vector2d corner = Eigen::Vector2d(to.x, to.y) + aspect.align.cwiseProduct(left_over);
  return Eigen::Translation2d(corner) * Eigen::AlignedScaling2d(scale) *
         Eigen::Translation2d(-from.x, -from.y);
}

}  // namespace geoprior
