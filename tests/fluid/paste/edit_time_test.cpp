#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "solvers/fluid/edits.h"

namespace geoprior::fluid {
namespace {

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

/// A feature whose frame moves along x at 1 m/s for two seconds from t = 1 s.
Feature runner() {
  Feature feature;
  feature.id = 3;
  for (int f = 0; f <= 20; ++f) {
    feature.times.push_back(1 + 0.1 * f);
    feature.placement.emplace_back(Eigen::Translation3d(0.1 * f, 2, 0.5));
    feature.area.push_back(0.1 * f);
  }
  return feature;
}

Edit named(const std::string& name = "test") {
  Edit edit;
  edit.name = name;
  return edit;
}

TEST(EditTime, RetimingMeetsItsKeysAndNeverTurnsBack) {
  const std::vector<TimeKey> keys{{0, 0}, {1, 0.1}, {1.5, 2}, {2, 2}, {4, 3}};
  for (const TimeKey& k : keys) EXPECT_DOUBLE_EQ(retimed(keys, k.target), k.source);
  double last = retimed(keys, -1);
  for (int i = 1; i <= 600; ++i) {
    const double value = retimed(keys, -1 + 0.01 * i);
    EXPECT_GE(value, last - 1e-12) << i;  // Fritsch and Carlson: monotone data, monotone curve
    last = value;
  }
  for (int i = 0; i <= 50; ++i) EXPECT_DOUBLE_EQ(retimed(keys, 1.5 + 0.01 * i), 2);
}

TEST(EditTime, RetimingIsLinearBeyondItsKeys) {
  const std::vector<TimeKey> keys{{1, 0}, {2, 2}};
  EXPECT_DOUBLE_EQ(retimed(keys, 0), -2);
  EXPECT_DOUBLE_EQ(retimed(keys, 3), 4);
  EXPECT_DOUBLE_EQ(retimed({{5, 1}}, 7), 3);  // one key shifts the clock
}

TEST(EditTime, StartAndSpeedSetTheInterval) {
  const Feature f = runner();
  Edit edit = named();
  EXPECT_EQ(edited_interval(f, edit), (std::array<double, 2>{1, 3}));
  edit.start = 10;
  edit.speed = 2;
  const auto interval = edited_interval(f, edit);
  EXPECT_DOUBLE_EQ(interval[0], 10);
  EXPECT_DOUBLE_EQ(interval[1], 11);
  EXPECT_FALSE(edited_frame(f, edit, 9.99, kUp));
  EXPECT_FALSE(edited_frame(f, edit, 11.01, kUp));
  const auto frame = edited_frame(f, edit, 10.5, kUp);
  ASSERT_TRUE(frame);
  EXPECT_NEAR(frame->source_time, 2, 1e-12);
  EXPECT_NEAR(frame->placement.translation().x(), 1, 1e-12);
}

TEST(EditTime, RetimedIntervalsEndWhereTheSourceDoes) {
  const Feature f = runner();  // lives from 1 to 3
  Edit edit = named();
  edit.retime = {{0, 1.5}, {2, 2.5}};  // half speed
  const auto interval = edited_interval(f, edit);
  EXPECT_NEAR(interval[0], -1, 1e-12);
  EXPECT_NEAR(interval[1], 3, 1e-12);
  edit.retime = {{0, 1}, {1, 2}, {5, 2}};  // holds a frame: ends with the last key
  EXPECT_NEAR(edited_interval(f, edit)[1], 5, 1e-12);
}

TEST(EditTime, FroudeScalingKeepsTheDispersionOfGravityWaves) {
  // Lengths times s, times times sqrt(s): omega^2 / k = g stays, speeds grow by sqrt(s).
  const Feature f = runner();
  Edit edit = named();
  edit.scale = {4, 4, 4};
  edit.froude = true;
  const auto interval = edited_interval(f, edit);
  EXPECT_NEAR(interval[1] - interval[0], 2 * 2, 1e-12);
  const auto a = edited_frame(f, edit, interval[0], kUp),
             b = edited_frame(f, edit, interval[1], kUp);
  ASSERT_TRUE(a && b);
  const Eigen::Vector3d way = b->placement.translation() - a->placement.translation();
  EXPECT_NEAR(way.norm() / (interval[1] - interval[0]), 1 * std::sqrt(4.0), 1e-12);
  EXPECT_NEAR(a->placement.linear()(0, 0), 4, 1e-12);
}

TEST(EditTime, FadesAreFlatToSecondOrderAtTheirEnds) {
  const Feature f = [] {
    Feature differential = runner();
    differential.kind = RegionKind::differential;
    return differential;
  }();
  Edit edit = named();
  edit.fade_in = 0.5;
  edit.fade_out = 1;
  const auto fade = [&](double t) { return edited_frame(f, edit, t, kUp)->fade; };
  EXPECT_DOUBLE_EQ(fade(1), 0);
  EXPECT_NEAR(fade(1.25), 0.5, 1e-12);  // a quintic is odd about its middle
  EXPECT_DOUBLE_EQ(fade(1.5), 1);
  EXPECT_NEAR(fade(2.5), 0.5, 1e-12);
  EXPECT_NEAR(fade(3), 0, 1e-15);
  const double e = 1e-3;  // 10 x^3 at first: rate and acceleration vanish
  EXPECT_NEAR(fade(1 + e), 10 * std::pow(e / 0.5, 3), 1e-9);
  EXPECT_NEAR(1 - fade(1.5 - e), 10 * std::pow(e / 0.5, 3), 1e-9);
}

TEST(EditSpace, TurnsAboutThePivotThenMoves) {
  const Feature f = runner();
  Edit edit = named();
  edit.turn_deg = 90;
  edit.move = {0, 0, 3};
  auto frame = edited_frame(f, edit, 2, kUp);  // centre (1, 2, 0.5); pivot (0, 2, 0.5)
  EXPECT_LT((frame->placement.translation() - Eigen::Vector3d(0, 3, 3.5)).norm(), 1e-12);
  EXPECT_LT((frame->placement.linear().col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  edit.pivot_x = 1;
  frame = edited_frame(f, edit, 2, kUp);
  EXPECT_LT((frame->placement.translation() - Eigen::Vector3d(1, 2, 3.5)).norm(), 1e-12);
}

TEST(EditSpace, ScaleStretchesThePathOnlyWhenAsked) {
  const Feature f = runner();
  Edit edit = named();
  edit.scale = {2, 1, 1};
  EXPECT_NEAR(edited_frame(f, edit, 3, kUp)->placement.translation().x(), 2, 1e-12);
  edit.scale_path = true;
  EXPECT_NEAR(edited_frame(f, edit, 3, kUp)->placement.translation().x(), 4, 1e-12);
}

TEST(EditSpace, MirrorTwiceIsNothing) {
  Feature f = runner();
  for (auto& p : f.placement) {
    p.linear() = Eigen::AngleAxisd(0.3 + 0.1 * p.translation().x(), kUp).toRotationMatrix();
    p.translation().y() += std::sin(p.translation().x());
  }
  Edit edit = named();
  edit.mirror = true;
  for (const double t : {1.0, 1.7, 3.0}) {
    const auto once = edited_frame(f, edit, t, kUp);
    const auto plain = edited_frame(f, named(), t, kUp);
    EXPECT_NEAR(once->placement.linear().determinant(), -1, 1e-12);
    EXPECT_NEAR(once->placement.translation().z(), plain->placement.translation().z(), 1e-12);
    // The mirror plane holds the first centre and the first x axis: a reflection undoes itself.
    const Eigen::Vector3d n = kUp.cross(f.placement[0].linear().col(0)).normalized();
    const Eigen::Vector3d o = f.placement[0].translation();
    const Eigen::Vector3d back =
        once->placement.translation() - 2 * (once->placement.translation() - o).dot(n) * n;
    EXPECT_LT((back - plain->placement.translation()).norm(), 1e-12);
  }
}

TEST(EditSpace, TrajectoryKeysAreMetAndKeepTheFineMotion) {
  Feature f = runner();
  for (std::size_t i = 0; i < f.placement.size(); ++i) {
    f.placement[i].translation().z() += i % 2 == 0 ? 0.01 : -0.01;  // shaking
  }
  Edit edit = named();
  edit.trajectory = {{1, {0, 0, 0}}, {2, {5, 0, 1}}, {3, {5, 5, 0}}};
  for (const EditKey& key : edit.trajectory) {
    const Eigen::Vector3d p(key.position[0], key.position[1], key.position[2]);
    EXPECT_LT((edited_frame(f, edit, key.t, kUp)->placement.translation() - p).norm(), 1e-12);
  }
  const auto z = [&](double t) {
    return edited_frame(f, edit, t, kUp)->placement.translation().z();
  };
  // Second difference of a smooth offset over 0.1 s is small; that of the shaking is 0.04.
  EXPECT_NEAR(std::abs(z(1.5) - 2 * z(1.6) + z(1.7)), 0.04, 0.025);
}

TEST(EditSpace, BetweenFramesTheCentreMovesSmoothly) {
  Feature f = runner();
  for (std::size_t i = 0; i < f.times.size(); ++i) {
    const double t = f.times[i] - 1;
    f.placement[i].translation().z() = -0.5 * 9.81 * t * t;  // free fall
  }
  for (const double t : {1.15, 1.77, 2.34}) {
    const double fallen = edited_frame(f, named(), t, kUp)->placement.translation().z();
    EXPECT_NEAR(fallen, -0.5 * 9.81 * (t - 1) * (t - 1), 1e-9);  // a cubic through a parabola
  }
}

TEST(EditSelection, NamesTheIdsThatExist) {
  std::vector<FeatureSummary> all{{1, {0, 1}, {{0, 0, 0}, {1, 0, 0}}, 2}, {4, {3}, {{5, 5, 0}}, 7}};
  Edit edit = named("splash");
  edit.ids = {4, 1, 4};
  EXPECT_EQ(select_features(all, edit), (std::vector<int>{1, 4}));
  edit.ids = {9};
  try {
    select_features(all, edit);
    FAIL();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("edit 'splash'"), std::string::npos) << text;
    EXPECT_NE(text.find("feature 9"), std::string::npos) << text;
    EXPECT_NE(text.find("1, 4"), std::string::npos) << text;
  }
}

TEST(EditSelection, TakesWhatMeetsBoxIntervalAndArea) {
  std::vector<FeatureSummary> all{{1, {0, 1}, {{0, 0, 0}, {1, 0, 0}}, 2}, {4, {3}, {{5, 5, 0}}, 7}};
  Edit edit = named();
  EXPECT_EQ(select_features(all, edit), (std::vector<int>{1, 4}));
  edit.box = {0.9, -1, -1, 1.1, 1, 1};
  EXPECT_EQ(select_features(all, edit), std::vector<int>{1});
  edit.box = {};
  edit.interval = {2, 10};
  EXPECT_EQ(select_features(all, edit), std::vector<int>{4});
  edit.interval = {};
  edit.smallest_area = 3;
  EXPECT_EQ(select_features(all, edit), std::vector<int>{4});
  edit.smallest_area = 100;
  EXPECT_THROW(select_features(all, edit), Error);
}

TEST(EditSelection, RefusesEditsWithoutMeaning) {
  const auto refused = [](auto change) {
    Edit edit = named();
    change(edit);
    EXPECT_THROW(require_valid(edit), Error);
  };
  refused([](Edit& e) { e.box = {1, 2, 3}; });
  refused([](Edit& e) { e.box = {1, 0, 0, 0, 1, 1}; });
  refused([](Edit& e) { e.interval = {2, 1}; });
  refused([](Edit& e) { e.speed = 0; });
  refused([](Edit& e) { e.scale = {1, -1, 1}; });
  refused([](Edit& e) { e.retime = {{0, 0}, {0, 1}}; });
  refused([](Edit& e) { e.retime = {{0, 1}, {1, 0}}; });
  refused([](Edit& e) { e.trajectory = {{1, {}}, {1, {}}}; });
  EXPECT_NO_THROW(require_valid(named()));
}

}  // namespace
}  // namespace geoprior::fluid
