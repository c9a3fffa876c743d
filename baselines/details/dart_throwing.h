#pragma once

#include <cstdint>
#include <memory>

#include "core/options.h"
#include "models/details/process.h"

namespace geoprior::details {

/// Poisson dart throwing where the surface is stretched: details stay where they are; every frame
/// darts are thrown into the triangles of M_d that have room (circumradius above r), and one that
/// lands on a stretched face at least r from every detail becomes a new detail of weight 0.
///
/// r = radius / sqrt(density at rest), so that darts go on until the stretched region is saturated.
/// Discs of diameter r placed at random cover 0.547 of the plane when no more fits (Feder 1980):
/// 0.547 / (pi r^2 / 4) = 0.697 / r^2 per area, which is the density at rest for
/// radius = sqrt(0.697) = 0.834.
///
/// What it cannot do: it never removes a detail, so a squeezed surface stays crowded; and gaps that
/// the pattern had on purpose (clusters) are filled once their region is stretched.
struct DartThrowingOptions {
  double radius = 0.834;
  double stretch_threshold = 1.1;
  int darts = 8;
  double weight_rate = 0.1;
  LengthRule lengths = LengthRule::chord;
};
void describe(OptionVisitor& v, DartThrowingOptions& options);

/// The method frame by frame. Phases inside a step: "move", "insert", "weights".
/// Diagnostics: inserted, flips, max_weight_change.
std::unique_ptr<DetailMethod> make_dart_throwing(const DetailScene& scene,
                                                 const DartThrowingOptions& options,
                                                 std::uint64_t seed);

/// The method as a process: `make_detail_process` around it.
std::unique_ptr<Process> make_dart_throwing_process(const DetailScene& scene,
                                                    const DartThrowingOptions& options);

}  // namespace geoprior::details
