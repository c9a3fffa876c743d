#include "metrics/isometry/buckled_sector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/angles.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

using sheets::Sheet;

/// Profile of a d-cone in a ring whose buckled sector is 2 t1 wide: psi = c1 cos t + c2 cos(a t)
/// inside, 1 outside; psi, psi' and psi'' are continuous.
struct Profile {
  explicit Profile(double sector_deg) : t1(sector_deg * kDegree / 2) {
    const auto jump = [&](double x) {  // of psi'', when psi' has none
      return x * std::sin(t1) * std::cos(x * t1) - std::cos(t1) * std::sin(x * t1);
    };
    double low = 3 * std::numbers::pi / 2 / t1 * 0.9, high = 3 * std::numbers::pi / 2 / t1;
    for (int i = 0; i < 80; ++i) {
      a = (low + high) / 2;
      (jump(low) * jump(a) > 0 ? low : high) = a;
    }
    c2 = 1 / (std::cos(a * t1) - a * std::sin(a * t1) / std::tan(t1));
    c1 = -c2 * a * std::sin(a * t1) / std::sin(t1);
  }
  [[nodiscard]] double operator()(double t) const {
    return std::abs(t) < t1 ? c1 * std::cos(t) + c2 * std::cos(a * t) : 1;
  }
  double t1, a = 0, c1 = 0, c2 = 0;
};

/// The cone as a height field over the pattern, apex at `apex`.
Sheet cone(const Sheet& flat, const Profile& psi, const Eigen::Vector2d& apex, double slope,
           double sector_at) {
  return sheets::mapped(flat, [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d d = p - apex;
    const double angle = std::remainder(std::atan2(d(1), d(0)) - sector_at, 2 * std::numbers::pi);
    return Eigen::Vector3d(p(0), p(1), slope * d.norm() * psi(angle));
  });
}

std::optional<double> sector_of(const Sheet& s, const Eigen::Vector2d& apex = {0, 0},
                                const Eigen::Vector3d& axis = {0, 0, 1}) {
  return buckled_sector(s.pattern, s.x, s.triangles, apex, 0.06, axis);
}

TEST(BuckledSector, ProfileOfTheTestIsThatOfTheLiterature) {
  const Profile psi(138.99);
  EXPECT_NEAR(psi.a, 3.805, 1e-3);
  EXPECT_NEAR(psi(0), 3.825, 1e-3);
}

TEST(BuckledSector, FindsTheSectorOfTheClosedForm) {
  for (const double sector : {115.0, 138.99, 150.0}) {
    const Sheet s = cone(sheets::disc(0.1, 5, 180), Profile(sector), {0, 0}, 0.1, 0.7);
    EXPECT_NEAR(sector_of(s).value(), sector, 0.5) << sector;
  }
}

TEST(BuckledSector, DoesNotNeedRulingsForEdges) {
  const Eigen::Vector2d apex(0.01, 0);
  const Sheet flat = sheets::rectangle(0.2, 0.2, 40, 40, 0);
  for (const double at : {0.0, 1.0, 3.1}) {
    const Sheet s = cone(flat, Profile(138.99), apex, 0.1, at);
    EXPECT_NEAR(sector_of(s, apex).value(), 138.99, 2) << at;  // edges of 5 mm at 60 mm: 5 degrees
  }
}

TEST(BuckledSector, DoesNotDependOnPlaceNorOnTheSenseOfTheAxis) {
  Sheet s = cone(sheets::disc(0.1, 5, 180), Profile(138.99), {0, 0}, 0.1, -2);
  const double before = sector_of(s).value();
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 2).normalized()).toRotationMatrix();
  s.x = (s.x * R.transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3);
  EXPECT_NEAR(sector_of(s, {0, 0}, R.col(2)).value(), before, 1e-9);
  EXPECT_NEAR(sector_of(s, {0, 0}, -3 * R.col(2)).value(), before, 1e-9);
}

TEST(BuckledSector, IsAbsentWithoutACone) {
  const Sheet flat = sheets::disc(0.1, 5, 60);
  EXPECT_FALSE(sector_of(flat).has_value());
  const Sheet funnel = sheets::mapped(
      flat, [](const Eigen::Vector2d& p) { return Eigen::Vector3d(p(0), p(1), 0.1 * p.norm()); });
  EXPECT_FALSE(sector_of(funnel).has_value());
  // Two sectors: no d-cone.
  const Profile psi(110);
  const Sheet twice = sheets::mapped(sheets::disc(0.1, 5, 180), [&](const Eigen::Vector2d& p) {
    const double t = std::atan2(p(1), p(0));
    const double opposite = std::remainder(t - std::numbers::pi, 2 * std::numbers::pi);
    return Eigen::Vector3d(p(0), p(1), 0.1 * p.norm() * std::max(psi(t), psi(opposite)));
  });
  EXPECT_FALSE(sector_of(twice).has_value());
  // A circle that leaves the pattern.
  const Sheet small = cone(sheets::disc(0.05, 5, 60), Profile(138.99), {0, 0}, 0.1, 0);
  EXPECT_FALSE(sector_of(small).has_value());
}

}  // namespace
}  // namespace geoprior
