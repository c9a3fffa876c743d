#pragma once

#include <memory>

#include "core/method.h"
#include "core/options.h"
#include "models/torus/map.h"

namespace geoprior::torus {

/// Corrugations of most stages that are evaluated: jets of one order more than there are
/// corrugations are compiled for so many.
constexpr int kMostCorrugations = 6;

struct ExactOptions {};
void describe(OptionVisitor& v, ExactOptions& options);

/// What is known of a torus at some parameters.
struct ExactPoints {
  Eigen::MatrixX3d points;
  Eigen::MatrixX3d along_x, along_y;  ///< derivatives; empty unless they were asked for
};

/// The corrugation process without a grid: the formula of a corrugation takes the derivatives of
/// the surface before at one point and nothing else, so that Taylor polynomials of the torus of
/// revolution, carried through the corrugations, each of which takes one order, give any point
/// after any number of them. A window of the fifth corrugation costs its own points.
///
/// It does not see a grid's error, and no derivative is a difference. What it cannot do: more than
/// `kMostCorrugations`; points where a coefficient rho is not positive.
///
/// Source: thesis chapter 4; Borrelli, Jabrane, Lazarus and Thibert 2012; Theillière 2022.
/// @param derivatives  of the result too; an order more, half as slow again
/// @throws Error  naming corrugation, coefficient and the first place where it is not positive
ExactPoints exact_points(const TorusInput& input, int corrugations, const Eigen::MatrixX2d& at,
                         bool derivatives);

/// @throws Error  for more corrugations than `kMostCorrugations`
std::unique_ptr<Process> make_exact_torus(const TorusInput& input, const ExactOptions& options);

}  // namespace geoprior::torus
