#include "baselines/torus/integration/integral_curves.h"

#include <algorithm>
#include <cmath>

namespace geoprior::torus {
namespace {

/// One step of Dormand and Prince 1980: value after it, slope there, estimate of its error.
struct Step {
  double a, slope, error;
};

Step dormand_prince(const SplineSurface& f, const WaveDirection& d, double a, double t, double h,
                    double k1) {
  const auto slope = [&](double c, double y) { return drift(f, d, y, t + c * h); };
  const double k2 = slope(1. / 5, a + h * k1 / 5);
  const double k3 = slope(3. / 10, a + h * (3. / 40 * k1 + 9. / 40 * k2));
  const double k4 = slope(4. / 5, a + h * (44. / 45 * k1 - 56. / 15 * k2 + 32. / 9 * k3));
  const double k5 = slope(8. / 9, a + h * (19372. / 6561 * k1 - 25360. / 2187 * k2 +
                                           64448. / 6561 * k3 - 212. / 729 * k4));
  const double k6 = slope(1, a + h * (9017. / 3168 * k1 - 355. / 33 * k2 + 46732. / 5247 * k3 +
                                      49. / 176 * k4 - 5103. / 18656 * k5));
  const double after = a + h * (35. / 384 * k1 + 500. / 1113 * k3 + 125. / 192 * k4 -
                                2187. / 6784 * k5 + 11. / 84 * k6);
  const double k7 = slope(1, after);
  const double error = h * (71. / 57600 * k1 - 71. / 16695 * k3 + 71. / 1920 * k4 -
                            17253. / 339200 * k5 + 22. / 525 * k6 - 1. / 40 * k7);
  return {after, k7, std::abs(error)};
}

}  // namespace

double drift(const SplineSurface& surface, const WaveDirection& d, double a, double t) {
  const SplineSurface::Point at = surface.at(a * d.along + t * d.across);
  const Eigen::Vector3d U = d.across.x() * at.along_x + d.across.y() * at.along_y;
  const Eigen::Vector3d V = d.along.x() * at.along_x + d.along.y() * at.along_y;
  return -U.dot(V) / V.squaredNorm();
}

IntegralCurve integral_curve(const SplineSurface& surface, const WaveDirection& direction, double a,
                             int n) {
  constexpr double kTolerance = 1e-10;  // of a step, as published
  constexpr double kSafety = 0.9, kMostGrowth = 5, kLeastGrowth = 0.2, kLeastStep = 1e-9;
  IntegralCurve curve{Eigen::VectorXd(n + 1), Eigen::VectorXd(n + 1)};
  double slope = drift(surface, direction, a, 0), h = 1. / n;
  curve.a(0) = a;
  curve.slope(0) = slope;
  for (int k = 1; k <= n; ++k) {
    double t = (k - 1.) / n;
    const double end = static_cast<double>(k) / n;
    while (t < end) {
      const bool last = t + h >= end * (1 - 1e-14);
      const double step = last ? end - t : h;
      const Step next = dormand_prince(surface, direction, a, t, step, slope);
      if (next.error <= kTolerance || step <= kLeastStep) {
        t = last ? end : t + step;
        a = next.a;
        slope = next.slope;
      }
      h = step * std::clamp(kSafety * std::pow(kTolerance / std::max(next.error, 1e-30), 0.2),
                            kLeastGrowth, kMostGrowth);
    }
    curve.a(k) = a;
    curve.slope(k) = slope;
  }
  return curve;
}

}  // namespace geoprior::torus
