#include "metrics/spacing/detail_continuity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/error.h"

namespace geoprior {
namespace {

struct Stored {
  std::vector<std::int64_t> birth;
  std::vector<double> weight;
  std::vector<int> face;
  Eigen::MatrixX3d barycentric;

  [[nodiscard]] DetailsOfFrame state() const { return {birth, weight}; }
  [[nodiscard]] AnchoredDetails anchored() const { return {state(), face, barycentric}; }
};

// 4 is new, 1 is gone at weight 0.05, 3 grew by 0.1, 2 stayed; the order of rows says nothing.
TEST(DetailChanges, FollowIdentitiesAndNotRows) {
  const Stored before{{3, 1, 2}, {0.5, 0.05, 1}, {}, {}};
  const Stored now{{2, 4, 3}, {1, 0.02, 0.6}, {}, {}};
  const DetailChanges c = detail_changes(before.state(), now.state());
  EXPECT_EQ(c.inserted, 1);
  EXPECT_EQ(c.removed, 1);
  EXPECT_NEAR(c.largest_step, 0.1, 1e-15);
  // Scattering anew gives new identities: all details pop.
  const Stored scattered{{7, 8, 9}, {1, 1, 1}, {}, {}};
  const DetailChanges all = detail_changes(now.state(), scattered.state());
  EXPECT_EQ(all.inserted, 3);
  EXPECT_EQ(all.removed, 3);
  EXPECT_EQ(all.largest_step, 1);
}

// 5 is new; 1 begins to fade, 2 faded before, 3 is gone, 4 grows on: two begin.
TEST(DetailsThatBegin, AreNewOrBeginToFade) {
  const std::vector<std::int64_t> before{1, 2, 3, 4}, now{5, 4, 2, 1};
  const std::vector<double> targets_before{1, 0, 0, 1}, targets_now{1, 1, 0, 0};
  EXPECT_EQ(details_that_begin({before, targets_before}, {now, targets_now}), 2);
  EXPECT_EQ(details_that_begin({before, targets_before}, {before, targets_before}), 0);
  EXPECT_EQ(details_that_begin({{}, {}}, {now, targets_now}), 4);
}

// Net +3 from 5 insertions and 2 removals: 2 of each cancel.
TEST(DetailEvents, ChurnIsWhatCancels) {
  const std::vector<DetailChanges> steps{{4, 0, 0.1}, {0, 2, 0.3}, {1, 0, 0.2}};
  const DetailEvents events = detail_events(steps);
  EXPECT_EQ(events.inserted, 5);
  EXPECT_EQ(events.removed, 2);
  EXPECT_EQ(events.churn, 4);
  EXPECT_EQ(events.largest_step, 0.3);
  const std::vector<DetailChanges> growing{{4, 0, 0.1}, {3, 0, 0.1}};
  EXPECT_EQ(detail_events(growing).churn, 0);
}

// Five times there and back: ten monotonic runs, nine turns between them; ripples of 0.3 on top
// turn 'least' 0.1 into many more but not 'least' 5.
TEST(Turns, OfStretchingAndReturningFiveTimesAreNine) {
  std::vector<double> smooth, rippled;
  for (int i = 0; i <= 1000; ++i) {
    const double phase = std::numbers::pi * i / 100;
    smooth.push_back(100 + 50 * (1 - std::cos(phase)));
    rippled.push_back(smooth.back() + 0.3 * (i % 2));
  }
  EXPECT_EQ(turns(smooth, 5), 9);
  EXPECT_EQ(turns(rippled, 5), 9);
  EXPECT_GT(turns(rippled, 0.1), 20);
  EXPECT_EQ(turns(std::vector<double>(50, 3.), 1), 0);
  EXPECT_EQ(turns(std::vector<double>{0, 1, 0, 1, 0}, 1), 3);
  EXPECT_EQ(turns(std::vector<double>{0, 1, 0, 1, 0}, 1.5), 0);
  EXPECT_EQ(turns({}, 1), 0);
}

TriMesh flat_triangle(double scale) {
  TriMesh m;
  m.V.resize(3, 3);
  m.V << 0, 0, 0, scale, 0, 0, 0, scale, 0;
  m.F.resize(1, 3);
  m.F << 0, 1, 2;
  return m;
}

Stored one(double weight, const Eigen::RowVector3d& barycentric) {
  return {{5}, {weight}, {0}, barycentric};
}

TEST(LargestPop, IsZeroForWhatTheDeformationCarries) {
  const Stored still = one(0.8, {0.2, 0.3, 0.5});
  for (const double scale : {1., 3.}) {
    EXPECT_EQ(largest_pop(flat_triangle(scale), still.anchored(), still.anchored(), 0.1), 0);
  }
}

TEST(LargestPop, OfGrowthIsTheChangeOfHeightAndOfASlideItsLength) {
  const TriMesh m = flat_triangle(1);
  const Eigen::RowVector3d here(0.5, 0.25, 0.25), there(0.5 - 0.03, 0.25 + 0.03, 0.25);
  const Stored nothing{{}, {}, {}, Eigen::MatrixX3d(0, 3)};
  const auto pop = [&](const Stored& a, const Stored& b) {
    return largest_pop(m, a.anchored(), b.anchored(), 0.2);
  };
  EXPECT_NEAR(pop(one(0.4, here), one(0.5, here)), 0.02, 1e-15);
  EXPECT_NEAR(pop(nothing, one(0.1, here)), 0.02, 1e-15);
  EXPECT_NEAR(pop(one(1, here), nothing), 0.2, 1e-15);
  // The slide is along x by 0.03, seen at weight 0.5; growth is at a right angle to it.
  EXPECT_NEAR(pop(one(0.5, here), one(0.5, there)), 0.015, 1e-15);
  EXPECT_NEAR(pop(one(0.5, here), one(0.4, there)), std::hypot(0.015, 0.02), 1e-15);
  EXPECT_EQ(pop(one(0, here), one(0, there)), 0);
}

// The rim of a hole of radius 0.2: growth by 0.1 moves it by 0.02 everywhere, a slide of 0.03 seen
// at weight 1/2 by 0.015; on the side ahead both add.
TEST(LargestPop, OfAHoleIsThatOfItsRim) {
  const TriMesh m = flat_triangle(1);
  const Eigen::RowVector3d here(0.5, 0.25, 0.25), there(0.5 - 0.03, 0.25 + 0.03, 0.25);
  const auto pop = [&](const Stored& a, const Stored& b) {
    return largest_pop(m, a.anchored(), b.anchored(), 0.2, DetailExtent::around);
  };
  EXPECT_NEAR(pop(one(0.4, here), one(0.5, here)), 0.02, 1e-15);
  EXPECT_NEAR(pop(one(0.5, here), one(0.5, there)), 0.015, 1e-15);
  EXPECT_NEAR(pop(one(0.5, here), one(0.4, there)), 0.035, 1e-15);
  const Stored nothing{{}, {}, {}, Eigen::MatrixX3d(0, 3)};
  EXPECT_NEAR(pop(nothing, one(0.1, here)), 0.02, 1e-15);
  EXPECT_EQ(pop(one(0.8, here), one(0.8, here)), 0);
}

// Over a ridge of two triangles at a right angle, vertex normals turn from that of the slope at the
// far vertices to the bisector on the ridge: by 45 degrees.
TEST(LargestPop, OfATiltIsTheChordOfItsAngle) {
  TriMesh m;
  m.V.resize(4, 3);
  m.V << 0, -1, 0, 0, 1, 0, 1, 0, -1, -1, 0, -1;
  m.F.resize(2, 3);
  m.F << 0, 2, 1, 0, 1, 3;
  const double w = 1e-3;  // a short slide counts little against the tilt of a tall detail
  const Stored ridge = one(w, {0.5, 0, 0.5}), slope = one(w, {0, 1, 0});
  const double tilt = 2 * std::sin(std::numbers::pi / 8), slide = std::sqrt(2.);
  const double height = 1000;
  EXPECT_NEAR(largest_pop(m, ridge.anchored(), slope.anchored(), height, DetailExtent::around),
              w * slide + w * height * tilt, 1e-12);
}

TEST(DetailContinuity, NamesWhatIsWrong) {
  const Stored twice{{1, 1}, {1, 1}, {}, {}};
  EXPECT_THROW(detail_changes(twice.state(), twice.state()), Error);
  const Stored uneven{{1, 2}, {1}, {}, {}};
  EXPECT_THROW(detail_changes(uneven.state(), uneven.state()), Error);
  EXPECT_THROW(turns(std::vector<double>{1}, 0), Error);
  Stored lost = one(1, {1, 0, 0});
  lost.face[0] = 1;
  EXPECT_THROW(largest_pop(flat_triangle(1), lost.anchored(), lost.anchored(), 1), Error);
  EXPECT_THROW(largest_pop(flat_triangle(1), lost.anchored(), lost.anchored(), 0), Error);
}

}  // namespace
}  // namespace geoprior
