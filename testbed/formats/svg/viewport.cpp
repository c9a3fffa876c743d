#include "testbed/formats/svg/viewport.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/planar.h"
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

using Points = std::vector<Eigen::Vector2d>;

/// Larger side of the box about the points of all lines.
double extent_of(const std::vector<SvgSubpath>& lines) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Vector2d low(kInfinity, kInfinity), high = -low;
  for (const SvgSubpath& line : lines) {
    for (const Eigen::Vector2d& p : line.points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  return low.x() <= high.x() ? (high - low).maxCoeff() : 0;
}

/// Distance to the left of the side of a region that begins at its corner i, negative outside.
double inside_of_side(const Points& region, std::size_t i, const Eigen::Vector2d& p) {
  const Eigen::Vector2d& a = region[i];
  const Eigen::Vector2d along = region[(i + 1) % region.size()] - a;
  const double length = along.norm();
  return length > 0 ? cross(along, p - a) / length : 0;
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

std::vector<Eigen::Vector2d> convex_region(const std::vector<SvgSubpath>& lines) {
  if (lines.size() != 1) return {};
  Points region = lines[0].points;
  while (region.size() > 1 && region.front() == region.back()) region.pop_back();
  const std::size_t n = region.size();
  if (n < 3) return {};
  double turned = 0;
  bool left = false, right = false;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle =
        signed_angle(region[(i + 1) % n] - region[i], region[(i + 2) % n] - region[(i + 1) % n]);
    turned += angle;
    left = left || angle > 0;
    right = right || angle < 0;
  }
  constexpr double kNoise = 1e-3;
  if (left == right || std::abs(std::abs(turned) - 2 * std::numbers::pi) > kNoise) return {};
  if (right) std::reverse(region.begin(), region.end());
  return region;
}

bool hides_part_of(const SvgClip& clip, const std::vector<SvgSubpath>& lines) {
  if (clip.region.empty()) return true;
  const double noise = 1e-9 * extent_of(lines);
  return std::any_of(lines.begin(), lines.end(), [&](const SvgSubpath& line) {
    return std::any_of(line.points.begin(), line.points.end(), [&](const Eigen::Vector2d& p) {
      for (std::size_t i = 0; i < clip.region.size(); ++i) {
        if (inside_of_side(clip.region, i, p) < -noise) return true;
      }
      return false;
    });
  });
}

std::vector<Eigen::Vector2d> clipped_loop(std::vector<Eigen::Vector2d> loop,
                                          const std::vector<Eigen::Vector2d>& region) {
  for (std::size_t side = 0; side < region.size(); ++side) {
    Points inside;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Eigen::Vector2d& p = loop[i];
      const Eigen::Vector2d& q = loop[i + 1 == loop.size() ? 0 : i + 1];
      const double at_p = inside_of_side(region, side, p), at_q = inside_of_side(region, side, q);
      if (at_p >= 0) inside.push_back(p);
      if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0))
        inside.emplace_back(p + at_p / (at_p - at_q) * (q - p));
    }
    loop = std::move(inside);
  }
  return loop;
}

}  // namespace geoprior
