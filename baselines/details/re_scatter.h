#pragma once

#include <cstdint>
#include <memory>

#include "core/options.h"
#include "models/details/process.h"

namespace geoprior::details {

/// Re-scatter: every frame all details are thrown away and scattered anew on the deformed surface
/// at the density they had at rest (Poisson-disk by dart throwing, seeded per frame), and M_d is
/// built from scratch. Good spacing whatever the motion, under compression too, and nothing else:
/// every detail pops in every frame. A frame in which the surface does not move changes nothing.
///
/// Darts fall with the density at rest per area now; one that is at least
/// r = radius / sqrt(density at rest) from all before it stays, until there are as many as the
/// surface asks for. At random no more than 0.697 / r^2 per area fit (Feder 1980), so the number is
/// reached for radius < 0.834, with the more darts the nearer to it. Types and tangent directions
/// are those of details at rest, drawn at random.
struct ReScatterOptions {
  double radius = 0.78;
};
void describe(OptionVisitor& v, ReScatterOptions& options);

/// The method frame by frame. Phases inside a step: "move", "scatter", "build".
/// Diagnostics: inserted, removed (all of the frame before), darts.
std::unique_ptr<DetailMethod> make_re_scatter(const DetailScene& scene,
                                              const ReScatterOptions& options, std::uint64_t seed);

/// The method as a process: `make_detail_process` around it.
std::unique_ptr<Process> make_re_scatter_process(const DetailScene& scene,
                                                 const ReScatterOptions& options);

}  // namespace geoprior::details
