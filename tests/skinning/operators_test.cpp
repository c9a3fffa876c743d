#include "solvers/skinning/operators.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/random.h"
#include "solvers/skinning/compact_support.h"

namespace geoprior::skinning {
namespace {

using Operator = std::function<BlendValue(double, double)>;

struct Named {
  std::string name;
  Operator g;
};

std::vector<Named> operators() {
  std::vector<Named> all{{"union", union_max},
                         {"ricci", [](double a, double b) { return ricci(a, b, 8); }},
                         {"contact", [](double a, double b) { return contact(a, b); }}};
  for (const double t : {0.0001, 0.2, 0.325, 0.6, 0.9, 1.0}) {
    const std::string suffix = " t = " + std::to_string(t);
    all.push_back({"gradient-controlled" + suffix,
                   [t](double a, double b) { return gradient_controlled(a, b, t); }});
    all.push_back({"bulge-in-contact" + suffix,
                   [t](double a, double b) { return bulge_in_contact(a, b, t); }});
  }
  return all;
}

TEST(Operators, LeaveAFieldAloneWhereTheOtherVanishes) {
  for (const Named& op : operators()) {
    for (double f = 0; f <= 1; f += 1.0 / 64) {
      EXPECT_NEAR(op.g(f, 0).value, f, 1e-12) << op.name << " f = " << f;
      EXPECT_NEAR(op.g(0, f).value, f, 1e-12) << op.name << " f = " << f;
    }
  }
}

TEST(Operators, AreSymmetric) {
  RandomStream random(1, "symmetry");
  for (const Named& op : operators()) {
    for (int i = 0; i < 500; ++i) {
      const double a = random.uniform(), b = random.uniform();
      const BlendValue ab = op.g(a, b), ba = op.g(b, a);
      EXPECT_NEAR(ab.value, ba.value, 1e-12) << op.name;
      EXPECT_NEAR(ab.d1, ba.d2, 1e-12) << op.name;
    }
  }
}

// Along random short segments the value changes by no more than a bounded slope allows: no jump
// between union, lower and upper areas.
TEST(Operators, AreContinuousAcrossTheirAreas) {
  RandomStream random(2, "continuity");
  for (const Named& op : operators()) {
    for (int i = 0; i < 20000; ++i) {
      const double a = random.uniform(), b = random.uniform();
      const double h = 1e-7;
      const double step = std::abs(op.g(a + h, b + h).value - op.g(a, b).value);
      ASSERT_LT(step, 60 * h) << op.name << " at " << a << ", " << b;
    }
  }
}

TEST(Operators, DerivativesAgreeWithFiniteDifferences) {
  RandomStream random(3, "derivatives");
  for (const Named& op : operators()) {
    int checked = 0, wrong = 0;
    for (int i = 0; i < 2000; ++i) {
      const double a = 0.02 + 0.96 * random.uniform(), b = 0.02 + 0.96 * random.uniform();
      const double h = 1e-6;
      const BlendValue g = op.g(a, b);
      const double right = (op.g(a + h, b).value - g.value) / h;
      const double left = (g.value - op.g(a - h, b).value) / h;
      if (std::abs(right - left) > 1e-3) continue;  // a kink: no derivative there
      ++checked;
      if (std::abs(0.5 * (left + right) - g.d1) > 1e-4 * std::max(1.0, std::abs(g.d1))) ++wrong;
    }
    EXPECT_GT(checked, 1500) << op.name;
    EXPECT_EQ(wrong, 0) << op.name;
  }
}

TEST(Operators, BlendsAreTheUnionAtThetaOfAQuarterPi) {
  RandomStream random(4, "union");
  const double t = std::tan(std::numbers::pi / 4);
  for (int i = 0; i < 1000; ++i) {
    const double a = random.uniform(), b = random.uniform();
    EXPECT_NEAR(gradient_controlled(a, b, t + 1e-12).value, std::max(a, b), 1e-9);
    EXPECT_NEAR(bulge_in_contact(a, b, t + 1e-12).value, std::max(a, b), 1e-9);
    EXPECT_NEAR(ricci(a, b, 1e4).value, std::max(a, b), 1e-4);
  }
}

TEST(Operators, BlendsAddMatterAndMoreForSmallerOpenings) {
  for (double f = 0.05; f < 0.5; f += 0.01) {
    double last = f;
    for (const double t : {0.9, 0.6, 0.3, 0.1}) {
      const double g = gradient_controlled(f, f, t).value;
      EXPECT_GT(g, last) << f;
      last = g;
    }
  }
}

// The closed form against the general construction (bisection, circular profile).
TEST(GradientControlled, ClosedFormSolvesTheArcConstruction) {
  RandomStream random(5, "arc");
  for (int i = 0; i < 5000; ++i) {
    const double a = random.uniform(), b = random.uniform();
    const double t = 0.01 + 0.97 * random.uniform();
    const BlendValue closed = gradient_controlled(a, b, t);
    const BlendValue general = profile_blend(a, b, t, 0.7, 0);
    ASSERT_NEAR(closed.value, general.value, 1e-9) << a << " " << b << " " << t;
    ASSERT_NEAR(closed.d1, general.d1, 1e-5) << a << " " << b << " " << t;
  }
}

TEST(BlendBoundary, IsTheDiagonalAtItsTip) {
  for (const double t : {0.1, 0.5, 0.9}) {
    EXPECT_NEAR(blend_boundary(0.7, t, 0.7), 0.7, 1e-15);
    EXPECT_NEAR(blend_boundary(0.5, t, 0.7), 0.5 * t, 1e-15);
    // k(f) = (7 - 5t)/2 f + 7 (t - 1)/4 on the upper piece.
    EXPECT_NEAR(blend_boundary(0.6, t, 0.7), 0.5 * (7 - 5 * t) * 0.6 + 1.75 * (t - 1), 1e-12);
  }
}

TEST(BulgeInContact, SwellsBesideTheContact) {
  // The profile lies inside the circle, so the value exceeds the arc's of the same boundary.
  EXPECT_GT(bulge_in_contact(0.42, 0.42, 0.01).value,
            profile_blend(0.42, 0.42, 0.01, 0.55, 0).value);
}

TEST(Contact, SurfaceOfTheOverlapIsWhereTheFieldsAgree) {
  for (double f = 0.5; f <= 1; f += 0.05) EXPECT_NEAR(contact(f, f).value, 0.5, 1e-12);
  EXPECT_GT(contact(0.8, 0.7).value, 0.5);
}

TEST(Opening, PresetsReachTheirEnds) {
  EXPECT_NEAR(Opening(OpeningPreset::smooth_finger).tan_theta(1), 1, 1e-6);
  EXPECT_NEAR(Opening(OpeningPreset::smooth_finger).tan_theta(-1), std::tan(std::numbers::pi / 10),
              1e-6);
  EXPECT_EQ(Opening(OpeningPreset::flat_max).tan_theta(0.3), 1);
  EXPECT_LT(Opening(OpeningPreset::flat_blend).tan_theta(0.3), 1e-4);
  for (const OpeningPreset p : {OpeningPreset::elbow, OpeningPreset::elbow_soft}) {
    EXPECT_NEAR(Opening(p).tan_theta(-0.5), 1, 1e-6);  // contact: union
    EXPECT_NEAR(Opening(p).tan_theta(1), 1, 1e-3);     // outside of the bend: union
    EXPECT_LT(Opening(p).tan_theta(0.65), 0.6);        // a blend between
  }
}

TEST(CompactSupport, GoesFromOneToZeroThroughAHalf) {
  for (const SupportKind kind : {SupportKind::quintic, SupportKind::cubic, SupportKind::logistic}) {
    EXPECT_NEAR(compact_support(kind, 0).value, 0.5, 1e-15);
    EXPECT_EQ(compact_support(kind, -1).value, 1);
    EXPECT_EQ(compact_support(kind, 1).value, 0);
    for (double s = -0.95; s < 1; s += 0.1) {
      const double h = 1e-6;
      const double slope =
          (compact_support(kind, s + h).value - compact_support(kind, s - h).value) / (2 * h);
      EXPECT_NEAR(compact_support(kind, s).derivative, slope, 1e-8);
      EXPECT_LT(slope, 0);
    }
  }
  // C2: value, slope and curvature (difference of slopes) vanish at the end of the quintic.
  EXPECT_NEAR(compact_support(SupportKind::quintic, 1 - 1e-6).derivative, 0, 1e-10);
}

}  // namespace
}  // namespace geoprior::skinning
