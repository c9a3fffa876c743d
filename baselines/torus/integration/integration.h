#pragma once

#include <memory>

#include "core/method.h"
#include "core/options.h"
#include "models/torus/input.h"

namespace geoprior::torus {

struct IntegrationOptions {
  int points = 2000;
};
void describe(OptionVisitor& v, IntegrationOptions& options);

/// The published road: convex integration along integral curves (Borrelli et al. 2012). On the
/// torus cut open along the closed line s V, s in [0, 1), each corrugation
/// 1. follows phi' = U + zeta(phi) V from n places of that line to the next, zeta = -<f_U, f_V> /
///    |f_V|^2, with the embedded Runge-Kutta formula of Dormand and Prince;
/// 2. integrates F(phi(t)) = f(phi(0)) + int_0^t r (cos(a cos 2 pi N u) t + sin(a cos 2 pi N u) n)
/// du
///    along each, with four Gauss points a step of the grid;
/// 3. glues the two ends: F + w(t) (f - F)(phi(1)), w = 6 t^5 - 15 t^4 + 10 t^3;
/// 4. samples the result at the points of the grid again, by cubic splines.
/// Derivatives are those of a bicubic spline through the grid.
///
/// @throws Error  while running, naming corrugation and place where a coefficient is not positive,
///                and for integral curves that meet
std::unique_ptr<Process> make_integration_torus(const TorusInput& input,
                                                const IntegrationOptions& options);

}  // namespace geoprior::torus
