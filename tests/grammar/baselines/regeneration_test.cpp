#include "baselines/grammar/regeneration.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

/// A block of stretched sizes about (2, 1, 0) and a post on it; key points: the block's corners,
/// the post's ends.
Hierarchy block_with_post(const Eigen::Vector3d& stretch) {
  Hierarchy h;
  const std::vector<ParameterType> sizes{{"x", "m", 0, 9}, {"y", "m", 0, 9}, {"z", "m", 0, 9}};
  const int block = h.add_type(
      {.name = "block",
       .parameters = sizes,
       .keys = [](std::span<const double> p, std::vector<Eigen::Vector3d>& out) {
         for (int k = 0; k < 8; ++k)
           out.emplace_back(k % 2 == 0 ? 0 : p[0], k / 2 % 2 == 0 ? 0 : p[1], k < 4 ? 0 : p[2]);
       }});
  const int post =
      h.add_type({.name = "post",
                  .parameters = {{"height", "m", 0, 9}},
                  .keys = [](std::span<const double> p, std::vector<Eigen::Vector3d>& out) {
                    out.emplace_back(0, 0, 0);
                    out.emplace_back(0, 0, p[0]);
                  }});
  const Eigen::Vector3d size = stretch.cwiseProduct(Eigen::Vector3d(3, 2, 1));
  const Eigen::Vector3d root(2, 1, 0);
  h.add(block, -1, {root}, std::array{size.x(), size.y(), size.z()});
  h.add(post, 0, {root + stretch.cwiseProduct(Eigen::Vector3d(1, .5, 1))}, std::array{stretch.z()});
  return h;
}

Hierarchy rest_block() { return block_with_post({1, 1, 1}); }

Eigen::Affine3d yaw_of_stretch(double yaw, const Eigen::Vector3d& stretch) {
  Eigen::Affine3d a = Eigen::Affine3d::Identity();
  a.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * stretch.asDiagonal();
  a.translation() = Eigen::Vector3d(.3, -.2, .1);
  return a;
}

class WavySpace final : public SpatialMap {
 public:
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& x) const override {
    return {1.2 * x.x() + .3 * std::sin(x.y()), x.y() - .4 * x.x(), x.z() * (1 + .1 * x.x())};
  }
};

double weighted_misfit(const Hierarchy& rest, const StretchFit& fit, const SpatialMap& map) {
  double sum = 0;
  for (int e = 0; e < rest.size(); ++e) {
    std::vector<Eigen::Vector3d> keys;
    rest.keys(e, keys);
    for (const Eigen::Vector3d& x : keys) {
      const Eigen::AngleAxisd yaw(fit.yaw, Eigen::Vector3d::UnitZ());
      const Eigen::Vector3d fitted =
          fit.position + yaw * fit.stretch.cwiseProduct(x - rest.position(0));
      sum += (fitted - map.at(x)).squaredNorm() / static_cast<double>(keys.size());
    }
  }
  return sum;
}

TEST(GrammarRegeneration, FindsTheStretchTheYawAndTheShift) {
  const Eigen::Vector3d stretch(1.3, .7, 1.6);
  for (const double yaw : {0., .4, -1.5, 2.9}) {
    const AffineMap map(yaw_of_stretch(yaw, stretch));
    const StretchFit fit = fit_stretch(rest_block(), map);
    EXPECT_NEAR(fit.yaw, yaw, 1e-12);
    EXPECT_NEAR((fit.stretch - stretch).norm(), 0, 1e-12);
    EXPECT_NEAR((fit.position - map.at({2, 1, 0})).norm(), 0, 1e-12);
  }
}

TEST(GrammarRegeneration, KeysOfAStretchComeWhereTheyShould) {
  const AffineMap map(yaw_of_stretch(.4, {1.3, .7, 1.6}));
  const Hierarchy rest = rest_block(), made = regenerate(rest, block_with_post, map);
  ASSERT_EQ(made.size(), rest.size());
  for (int e = 0; e < rest.size(); ++e) {
    std::vector<Eigen::Vector3d> before, after;
    rest.keys(e, before);
    made.keys(e, after);
    for (std::size_t k = 0; k < before.size(); ++k)
      EXPECT_NEAR((after[k] - map.at(before[k])).norm(), 0, 1e-12);
  }
}

TEST(GrammarRegeneration, NoFitNearbyIsBetter) {
  const WavySpace map;
  const Hierarchy rest = rest_block();
  const StretchFit best = fit_stretch(rest, map);
  const double least = weighted_misfit(rest, best, map);
  EXPECT_GT(least, 1e-3);
  for (const double step : {-.01, .01}) {
    StretchFit other = best;
    other.yaw += step;
    EXPECT_GT(weighted_misfit(rest, other, map), least);
    for (int k = 0; k < 3; ++k) {
      other = best;
      other.stretch[k] += step;
      EXPECT_GT(weighted_misfit(rest, other, map), least);
      other = best;
      other.position[k] += step;
      EXPECT_GT(weighted_misfit(rest, other, map), least);
    }
  }
}

TEST(GrammarRegeneration, TheIdentityAsksForNoStretch) {
  const StretchFit fit = fit_stretch(rest_block(), AffineMap(Eigen::Affine3d::Identity()));
  EXPECT_EQ(fit.stretch, Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(fit.yaw, 0);
  EXPECT_EQ(fit.position, Eigen::Vector3d(2, 1, 0));
}

TEST(GrammarRegeneration, LosesEdits) {
  Hierarchy edited = rest_block();
  edited.set_parameter(1, 0, 5);
  const AffineMap identity(Eigen::Affine3d::Identity());
  EXPECT_EQ(regenerate(edited, block_with_post, identity).parameter(1, 0), 1);
}

TEST(GrammarRegeneration, AnObjectWithoutKeyPointsIsRefused) {
  Hierarchy empty;
  empty.add(empty.add_type({.name = "root"}), -1, {});
  test::expect_error([&] { fit_stretch(empty, WavySpace()); }, {"has no key points"});
}

}  // namespace
}  // namespace geoprior::grammar
