// Colours of a region go on beyond it along the lines that reach its border.

#include "solvers/sketch/photo/continued_colours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angles.h"

namespace geoprior::sketch {
namespace {

constexpr int kWidth = 60, kHeight = 60, kBorder = 40;

/// Soft stripes, eight pixels from one to the next, that run at an angle to the rows.
PixelImage stripes(double angle) {
  PixelImage image{kWidth, kHeight, {}};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double across = y * std::cos(angle) - x * std::sin(angle);
      const double wave = std::cos(2 * std::numbers::pi * across / 8);
      const auto grey = static_cast<std::uint8_t>(std::lround(128 + 80 * wave));
      image.pixels.push_back({grey, grey, grey});
    }
  }
  return image;
}

struct Split {
  std::vector<std::size_t> region, fill;
};

/// Columns left of the border, and `width` columns from there on.
Split at_border(int width) {
  Split split;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kBorder + width; ++x)
      (x < kBorder ? split.region : split.fill).push_back(static_cast<std::size_t>(y) * kWidth + x);
  }
  return split;
}

/// Root mean square differences (grey levels) from what is there, away from the picture's edges: of
/// continued colours, and of the nearest pixel's of the region.
struct Errors {
  double continued = 0, nearest = 0;
};

Errors errors_at(double angle, int width) {
  const PixelImage image = stripes(angle);
  const Split split = at_border(width);
  const auto colours = continued_colours(image, split.region, split.fill, 100);
  double own = 0, rival = 0;
  int count = 0;
  for (std::size_t i = 0; i < split.fill.size(); ++i) {
    const int x = static_cast<int>(split.fill[i] % kWidth);
    const int y = static_cast<int>(split.fill[i] / kWidth);
    if (y < 15 || y >= kHeight - 15) continue;
    const double truth = image.at(x, y)[0];
    own += std::pow(colours[i](0) - truth, 2);
    rival += std::pow(image.at(kBorder - 1, y)[0] - truth, 2);
    ++count;
  }
  return {std::sqrt(own / count), std::sqrt(rival / count)};
}

// Three pixels are what a drawing that is two pixels off asks for.
TEST(ContinuedColours, LinesGoStraightOn) {
  for (const double degrees : {-65.0, -50.0, -35.0, -20.0, 20.0, 35.0, 50.0, 65.0}) {
    const Errors errors = errors_at(degrees * kDegree, 3);
    EXPECT_LT(errors.continued, 0.4 * errors.nearest) << degrees;
  }
  EXPECT_LT(errors_at(0, 3).continued, 3) << "square to the border, where the nearest is right";
}

// Nothing of the region lies on lines that run beside it: the nearest colours are as good.
TEST(ContinuedColours, LinesAlongTheBorderAreNoWorseThanTheNearestColour) {
  for (const double degrees : {-85.0, -75.0, 75.0, 85.0, 90.0}) {
    const Errors errors = errors_at(degrees * kDegree, 3);
    EXPECT_LT(errors.continued, 1.1 * errors.nearest) << degrees;
  }
}

// A seam beside the border, on cloth that gets lighter: pixels are not read in the order in which
// they are filled.
TEST(ContinuedColours, AMirroredPictureIsContinuedAlike) {
  PixelImage image{kWidth, kHeight, {}}, mirrored;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto grey = static_cast<std::uint8_t>(x == kBorder - 4 ? 30 : 90 + y);
      image.pixels.push_back({grey, grey, grey});
    }
  }
  mirrored = image;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) mirrored.at(x, y) = image.at(x, kHeight - 1 - y);
  const Split split = at_border(3);
  const auto one = continued_colours(image, split.region, split.fill, 100);
  const auto other = continued_colours(mirrored, split.region, split.fill, 100);
  for (std::size_t i = 0; i < one.size(); ++i) {
    const std::size_t image_of_i = (kHeight - 1 - i / 3) * 3 + i % 3;
    EXPECT_NEAR(one[i](0), other[image_of_i](0), 1) << i;
    const int y = static_cast<int>(i / 3);
    if (y >= 15 && y < kHeight - 15) {
      EXPECT_NEAR(one[i](0), 90 + y, 3) << i;
    }
  }
}

TEST(ContinuedColours, OneColourStaysAndOutsideColoursDoNotCount) {
  PixelImage image{kWidth, kHeight, {}};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      image.pixels.push_back(x < kBorder ? PixelColour{200, 60, 50} : PixelColour{40, 160, 90});
  }
  const Split split = at_border(9);
  for (const Eigen::Vector3d& c : continued_colours(image, split.region, split.fill, 100))
    EXPECT_LT((c - Eigen::Vector3d(200, 60, 50)).norm(), 1e-4);
}

TEST(ContinuedColours, EndsAtItsReach) {
  const PixelImage image = stripes(0);
  const Split split = at_border(9);
  const auto colours = continued_colours(image, split.region, split.fill, 4);
  for (std::size_t i = 0; i < split.fill.size(); ++i) {
    const bool near = split.fill[i] % kWidth < kBorder + 4;
    EXPECT_EQ(colours[i](0) >= 0, near) << split.fill[i] % kWidth;
  }
}

TEST(ContinuedColours, NothingToFillIsNothing) {
  const PixelImage image = stripes(0);
  const Split split = at_border(0);
  EXPECT_TRUE(continued_colours(image, split.region, {}, 4).empty());
  for (const Eigen::Vector3d& c : continued_colours(image, {}, split.region, 4))
    EXPECT_LT(c(0), 0) << "nothing to begin with";
}

}  // namespace
}  // namespace geoprior::sketch
