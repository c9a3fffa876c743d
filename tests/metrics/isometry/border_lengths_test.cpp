#include "metrics/isometry/border_lengths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace geoprior {
namespace {

using ::testing::SizeIs;

/// Half a cylinder of radius 1 and height 0.7 in space, and the rectangle that it unrolls to, wider
/// by a factor.
struct Unrolled {
  Eigen::MatrixX2d flat;
  Eigen::MatrixX3i F;
  Eigen::MatrixX3d space;
};

Unrolled half_cylinder(int columns, double wider) {
  Unrolled u;
  u.flat.resize(2 * (columns + 1), 2);
  u.space.resize(2 * (columns + 1), 3);
  u.F.resize(2 * columns, 3);
  for (int i = 0; i <= columns; ++i) {
    const double s = M_PI * i / columns;
    for (int k = 0; k < 2; ++k) {
      u.flat.row(2 * i + k) << wider * s, 0.7 * k;
      u.space.row(2 * i + k) << std::cos(s), 0.7 * k, std::sin(s);
    }
    if (i == columns) continue;
    u.F.row(2 * i) << 2 * i, 2 * i + 2, 2 * i + 3;
    u.F.row(2 * i + 1) << 2 * i, 2 * i + 3, 2 * i + 1;
  }
  return u;
}

// Two rims of 8 chords each are half turns of radius 1, two generators straight: sums over chords
// would be 0.6 % short of pi.
TEST(BorderLengths, AreThoseOfArcsAndNotOfChords) {
  const Unrolled u = half_cylinder(8, 1);
  EXPECT_THAT(border_stretches(u.flat, u.F), SizeIs(4));
  EXPECT_NEAR(border_length_error(u.flat, u.F, u.space), 0, 1e-7);
}

// A cylinder cut obliquely: its rim is half an ellipse in space and a sine curve in the plane, of
// one length. Chords of either differ by a third of a percent.
TEST(BorderLengths, OfRimsThatAreNoArcsAreEqualToFourthOrder) {
  Unrolled u = half_cylinder(32, 1);
  for (int i = 0; i <= 32; ++i) {
    const double height = 0.7 + 0.3 * std::cos(M_PI * i / 32);
    u.flat(2 * i + 1, 1) = u.space(2 * i + 1, 1) = height;
  }
  EXPECT_NEAR(border_length_error(u.flat, u.F, u.space), 0, 2e-6);
  for (int i = 0; i <= 32; ++i) u.flat(2 * i + 1, 0) *= 1.02;
  EXPECT_GT(border_length_error(u.flat, u.F, u.space), 0.015);
}

TEST(BorderLengths, TellARimThatIsTooLong) {
  const Unrolled u = half_cylinder(8, 1.05);
  EXPECT_NEAR(border_length_error(u.flat, u.F, u.space), 0.05, 1e-7);
}

TEST(BorderLengths, HaveNoStretchWithoutACorner) {
  constexpr int kSides = 24;
  Eigen::MatrixX2d disc(kSides + 1, 2);
  Eigen::MatrixX3i F(kSides, 3);
  disc.row(kSides).setZero();
  for (int i = 0; i < kSides; ++i) {
    disc.row(i) << std::cos(2 * M_PI * i / kSides), std::sin(2 * M_PI * i / kSides);
    F.row(i) << kSides, i, (i + 1) % kSides;
  }
  EXPECT_THAT(border_stretches(disc, F), SizeIs(0));
}

}  // namespace
}  // namespace geoprior
