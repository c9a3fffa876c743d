#include "metrics/isometry/seam_lengths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace geoprior {
namespace {

TEST(SeamLengths, EqualEdgesMatchHoweverTheyCurve) {
  // A straight edge and a right angle with the same segments.
  Eigen::MatrixX2d left(4, 2), right(4, 2);
  left << 0, 0, 1, 0, 2, 0, 3, 0;
  right << 5, 5, 5, 6, 5, 7, 6, 7;
  const SeamMismatch m = seam_mismatch(left, right);
  EXPECT_EQ(m.left_length, 3);
  EXPECT_EQ(m.relative, 0);
  EXPECT_EQ(m.shift_max, 0);
  EXPECT_EQ(m.segment_max, 0);
}

TEST(SeamLengths, ALongerEdgeIsRelativeToTheMean) {
  Eigen::MatrixX2d left(3, 2), right(3, 2);
  left << 0, 0, 0.1, 0, 0.2, 0;
  right = left * 1.1;
  const SeamMismatch m = seam_mismatch(left, right);
  EXPECT_NEAR(m.relative, 0.1 / 1.05, 1e-14);
  EXPECT_NEAR(m.segment_max, 0.1 / 1.05, 1e-14);
  EXPECT_NEAR(m.shift_max, 0.02, 1e-15);
  EXPECT_NEAR(seam_mismatch(right, left).relative, m.relative, 1e-15);
}

TEST(SeamLengths, AShiftAlongTheSeamIsSeenWhereTheLengthsAgree) {
  // Points of the right edge bunch up and spread again: s + c sin(2 pi s), which ends as it began.
  const int n = 400;
  const double c = 0.03;
  Eigen::MatrixX2d left(n + 1, 2), right(n + 1, 2);
  for (int i = 0; i <= n; ++i) {
    const double s = static_cast<double>(i) / n;
    left.row(i) << s, 0;
    right.row(i) << 0, s + c * std::sin(2 * std::numbers::pi * s);
  }
  const SeamMismatch m = seam_mismatch(left, right);
  EXPECT_NEAR(m.relative, 0, 1e-12);
  EXPECT_NEAR(m.shift_max, c, 1e-12);  // at a quarter, which is a point
  // Steepest at the ends: 1 + 2 pi c against 1, over their mean.
  const double slope = 2 * std::numbers::pi * c;
  EXPECT_NEAR(m.segment_max, slope / (1 - slope / 2), 1e-3);
  const Eigen::VectorXd shift = seam_shift(left, right);
  EXPECT_EQ(shift(0), 0);
  EXPECT_NEAR(shift(n / 4), -c, 1e-12);
  EXPECT_NEAR(shift(3 * n / 4), c, 1e-12);
}

TEST(SeamLengths, RefusesWhatIsNotSewn) {
  const Eigen::MatrixX2d one = Eigen::MatrixX2d::Zero(1, 2), two = Eigen::MatrixX2d::Zero(2, 2),
                         three = Eigen::MatrixX2d::Ones(3, 2);
  EXPECT_THROW(seam_mismatch(one, one), Error);
  EXPECT_THROW(seam_mismatch(two, three), Error);
  EXPECT_THROW(seam_mismatch(two, two), Error);  // no length
}

}  // namespace
}  // namespace geoprior
