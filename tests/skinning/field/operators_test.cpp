#include "solvers/skinning/field/operators.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/random.h"
#include "solvers/skinning/field/compact_support.h"

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

/// A uniform cubic B-spline over [0, 1] by de Boor's recursion: control value i belongs to the
/// knots i - 3 … i + 1, in spans.
double uniform_cubic_spline(const std::vector<double>& control, double u) {
  const std::function<double(int, int, double)> basis = [&](int i, int degree, double x) {
    if (degree == 0) return x >= i && x < i + 1 ? 1.0 : 0.0;
    return ((x - i) * basis(i, degree - 1, x) +
            (i + degree + 1 - x) * basis(i + 1, degree - 1, x)) /
           degree;
  };
  const int spans = static_cast<int>(control.size()) - 3;
  const double x = std::min(u * spans, spans * (1 - 1e-15));
  double sum = 0;
  for (int i = 0; i < std::ssize(control); ++i) sum += control[i] * basis(i - 3, 3, x);
  return sum;
}

/// Profile of the bulge at the angle phi from an axis, mirrored on the diagonal (Vaillant 2013).
double bulge_profile(double phi, double p) {
  std::vector<double> control{0, 0, 0, p, 2 * p, 3 * p, 4 * p, 5 * p, 4 * p, 4 * p, 4 * p};
  for (double& c : control) c = 1 - c;
  return uniform_cubic_spline(control, std::tan(std::min(phi, std::numbers::pi / 2 - phi)));
}

/// Iso-lines of an operator drawn forwards: the line of value c is (k, k) + P(phi) (c - k) (cos
/// phi, sin phi), k the boundary at c; the operator must find c at each of its points.
template <class Profile>
void expect_iso_lines(const Operator& g, double t, double tip, const Profile& profile) {
  for (double c = 0.02; c < tip - 0.005; c += 0.01) {
    const double k = c <= 0.5 ? t * c : 0.5 * t + (tip - 0.5 * t) * (c - 0.5) / (tip - 0.5);
    for (int i = 0; i <= 40; ++i) {
      const double phi = std::numbers::pi / 2 * i / 40;
      const double radius = profile(phi) * (c - k);
      const double f1 = k + radius * std::cos(phi), f2 = k + radius * std::sin(phi);
      ASSERT_NEAR(g(f1, f2).value, c, 1e-9) << "t = " << t << ", angle " << phi;
    }
  }
}

TEST(GradientControlled, HasTheArcsOfItsConstructionForIsoLines) {
  for (const double t : {0.001, 0.2, 0.325, 0.6, 0.9}) {
    expect_iso_lines([t](double a, double b) { return gradient_controlled(a, b, t); }, t, 0.7,
                     [](double) { return 1.0; });
  }
}

TEST(BulgeInContact, HasTheProfileOfItsConstructionForIsoLines) {
  for (const double p : {0.01, 0.025}) {
    for (const double t : {0.001, 0.2, 0.325, 0.6, 0.9}) {
      expect_iso_lines([=](double a, double b) { return bulge_in_contact(a, b, t, p); }, t, 0.55,
                       [p](double phi) { return bulge_profile(phi, p); });
    }
  }
}

// The profile lies within the circle: between the boundary curves the value exceeds the arc's of
// the same boundary, and outside of them both are the union.
TEST(BulgeInContact, SwellsBesideTheContactAndNowhereElse) {
  int swollen = 0;
  for (const double t : {0.001, 0.2, 0.6}) {
    for (double a = 0.01; a < 1; a += 0.01) {
      for (double b = 0.01; b < 1; b += 0.01) {
        const double bulge = bulge_in_contact(a, b, t).value;
        const double arc = profile_blend(a, b, t, 0.55, 0).value;
        if (std::min(a, b) <= blend_boundary(std::max(a, b), t, 0.55)) {
          ASSERT_EQ(bulge, std::max(a, b)) << a << ' ' << b << ' ' << t;
          continue;
        }
        ASSERT_GE(bulge, arc - 1e-12) << a << ' ' << b << ' ' << t;
        swollen += bulge > arc + 1e-4 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(swollen, 1000);
}

TEST(Ricci, IsThePowerMeanWithoutItsFactor) {
  for (const double n : {2.0, 8.0, 20.0}) {
    for (double a = 0; a <= 1; a += 0.05) {
      for (double b = 0; b <= 1; b += 0.05) {
        ASSERT_NEAR(std::pow(ricci(a, b, n).value, n), std::pow(a, n) + std::pow(b, n), 1e-12)
            << a << ' ' << b << ' ' << n;
      }
    }
  }
}

// The surfaces are where the fields are 1/2. In the overlap they meet on f1 = f2 and the field
// grows with the distance from it; beside it they swell by x (1 - x / w)^2, whose largest value is
// 4 w / 27 at x = w / 3; beyond w they are the union.
TEST(Contact, RecedesInTheOverlapSwellsBesideItAndIsTheUnionBeyond) {
  constexpr double kWidth = 0.25;
  for (double a = 0; a <= 1; a += 0.01) {
    for (double b = 0; b <= a; b += 0.01) {
      const double g = contact(a, b, kWidth).value;
      if (b >= 0.5 - 1e-9) {
        ASSERT_NEAR(g, 0.5 + (a - b), 1e-12) << a << ' ' << b;
      } else if (b <= 0.5 - kWidth + 1e-9) {
        ASSERT_NEAR(g, a, 1e-12) << a << ' ' << b;
      } else if (a >= 0.5) {
        ASSERT_GT(g, a) << b;
        ASSERT_LE(g, a + 4 * kWidth / 27 + 1e-12) << b;
      }
    }
  }
  const double crest = 0.5 - kWidth / 3;
  EXPECT_NEAR(contact(0.7, crest, kWidth).value, 0.7 + 4 * kWidth / 27, 1e-12);
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
