#include "solvers/torus/jets/bessel.h"

namespace geoprior::torus {
namespace {

constexpr double kLeastAmplitude = 1e-6;

/// J_0(a) and 2 J_1(a) / a as power series in x = a^2 / 4 <= 1.45.
struct LowOrders {
  Lane j0, j1;
};

LowOrders low_orders(const Lane& x) {
  constexpr int kTerms = 12;  // 1.45^13 / 13!^2 = 3e-18
  LowOrders out{Lane::Ones(), Lane::Ones()};
  for (int m = kTerms; m >= 1; --m) {
    out.j0 = 1 - x * out.j0 * (1. / (m * m));
    out.j1 = 1 - x * out.j1 * (1. / (m * (m + 1)));
  }
  return out;
}

}  // namespace

Lane inverse_bessel(const Lane& value) {
  // J_0 = 1 - x + x^2/4 - …; the first zero is at x = 1.4458.
  Lane x = (1 - value) * (1 + 0.25 * (1 - value) + 0.1958 * (1 - value).square());
  for (int step = 0; step < 4; ++step) {  // Newton: dJ_0/dx = -2 J_1(a) / a
    const LowOrders low = low_orders(x);
    x += (low.j0 - value) / low.j1;
  }
  return (2 * x.max(0).sqrt()).max(kLeastAmplitude);
}

}  // namespace geoprior::torus
