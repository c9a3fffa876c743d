#pragma once

#include <vector>

#include "solvers/skinning/implicit_options.h"

namespace geoprior::skinning {

/// Combined field value and its partial derivatives with respect to the two fields.
struct BlendValue {
  double value = 0;
  double d1 = 0;
  double d2 = 0;
};

// Binary operators on two fields f1, f2 in [0, 1] whose surfaces are at 1/2. All are symmetric and
// return f1 where f2 = 0. `t` is tan(theta), theta in [0, pi/4] the opening: t = 1 is the union,
// smaller values blend within a wider cone around the diagonal f1 = f2.

/// Union: the larger field. Gradient discontinuity on f1 = f2 (where the first is taken).
BlendValue union_max(double f1, double f2);

/// (f1^n + f2^n)^(1/n); n -> infinity is the union (Ricci 1973). Bulges wherever both are positive.
BlendValue ricci(double f1, double f2, double n);

/// Gradient-controlled blend with its iso-lines closed by circular arcs (Gourmel et al. 2013).
///
/// Union outside the boundary curve k_t(f) = t f (f <= 1/2), (7 - 5 t) f / 2 + 7 (t - 1) / 4 up to
/// f = 7/10 and its mirror image. Inside, the iso-line of value C is the arc of centre (k, k) and
/// radius C - k. Both branches of k are linear in C, so C is the root of a quadratic: no table.
BlendValue gradient_controlled(double f1, double f2, double t);

/// The boundary curve of the construction above, for any tip: t f up to 1/2, then a line to
/// (tip, tip). tip = 0.7 for the blend, 0.55 for the bulge.
double blend_boundary(double f, double t, double tip);

/// Bulge-in-contact: the same construction with the arc replaced by a polar profile P(u),
/// u = tan(phi) of the angle from the nearer axis: |(f1 - k, f2 - k)| = P(u) (C - k). P falls from
/// 1 on the axis to 1 - 4 p on the diagonal through 1 - 5 p, so the surface swells beside the
/// contact.
///
/// P is a uniform cubic B-spline with control values 1 - {0,0,0,p,2p,3p,4p,5p,4p,4p,4p}; C is found
/// by bisection. Source: the released code of Vaillant et al. 2013 (p = 0.025, tip 0.55).
BlendValue bulge_in_contact(double f1, double f2, double t, double p = 0.025);

/// The general construction, for tests of the closed form: profile P = 1 - p * bulge shape (p = 0:
/// arcs), boundary with the given tip.
BlendValue profile_blend(double f1, double f2, double t, double tip, double p);

/// Contact of deformable solids after Cani 1993: each surface recedes where it enters the other
/// and swells around, g = max(F1, F2) with F1 = f1 + 1/2 - f2 where f2 > 1/2 and
/// f1 + x (1 - x / w)^2, x = 1/2 - f2 < w, beside it. The surface 1/2 then lies on f1 = f2 in the
/// overlap. The swelling profile is ours: it continues the slope of the contact and ends flat at w.
BlendValue contact(double f1, double f2, double w = 0.25);

/// theta(alpha): opening of the blend for the angle alpha between the gradients, tabulated over
/// cos(alpha).
///
/// smooth_finger: theta falls from pi/4 (union, alpha <= pi/8) to pi/10 (alpha >= pi/2) along
/// kappa(x) = 1 - exp(1 - 1 / (1 - exp(1 - 1 / x))) to the power 1/2. The others are presets of
/// the released code: F(cos alpha) through three points, theta = 0.2499 pi F + 1e-5; its power is
/// applied to a kappa curve rescaled to reach its ends, which may differ in detail from theirs.
class Opening {
 public:
  explicit Opening(OpeningPreset preset);
  /// tan(theta) for a cosine in [-1, 1] (clamped).
  [[nodiscard]] double tan_theta(double cos_alpha) const;

 private:
  std::vector<float> table_;
};

/// The operator of one joint: kind, opening and parameters.
class JointOperator {
 public:
  JointOperator(BlendKind kind, OpeningPreset preset, double ricci_exponent);
  /// @param cos_alpha  cosine of the angle between the gradients of f1 and f2
  [[nodiscard]] BlendValue operator()(double f1, double f2, double cos_alpha) const;
  /// Union needs no angle and no derivative.
  [[nodiscard]] bool is_union() const { return kind_ == BlendKind::union_max; }

 private:
  BlendKind kind_;
  double ricci_exponent_;
  Opening opening_;
};

}  // namespace geoprior::skinning
