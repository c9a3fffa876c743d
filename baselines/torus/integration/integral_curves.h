#pragma once

#include "baselines/torus/integration/spline_surface.h"
#include "models/torus/directions.h"

namespace geoprior::torus {

/// An integral curve at the n + 1 steps t = 0, 1/n, …, 1: phi(t) = a(t) V + t U.
struct IntegralCurve {
  Eigen::VectorXd a, slope;  ///< and its derivative zeta
};

/// zeta = -<f_U, f_V> / |f_V|^2.
double drift(const SplineSurface& surface, const WaveDirection& direction, double a, double t);

/// From (a, 0), by Dormand and Prince's formula of order 5 with an error estimate of order 4,
/// below 1e-10 a step.
IntegralCurve integral_curve(const SplineSurface& surface, const WaveDirection& direction, double a,
                             int n);

}  // namespace geoprior::torus
