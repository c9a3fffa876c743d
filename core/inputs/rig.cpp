#include "core/inputs/rig.h"

#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior {

void validate(const SkinWeights& weights, int vertex_count, int joint_count) {
  if (weights.rows() != vertex_count || weights.cols() != joint_count) {
    throw Error("skin weights are " + std::to_string(weights.rows()) + " x " +
                    std::to_string(weights.cols()) + ", not vertices x joints",
                "", std::to_string(vertex_count) + " x " + std::to_string(joint_count));
  }
  for (int v = 0; v < vertex_count; ++v) {
    double sum = 0;
    for (SkinWeights::InnerIterator it(weights, v); it; ++it) {
      if (!std::isfinite(it.value()) || it.value() < 0) {
        throw Error("weight " + std::to_string(it.value()), "vertex " + std::to_string(v),
                    "finite and >= 0");
      }
      sum += it.value();
    }
    if (!(std::abs(sum - 1) < 1e-6)) {
      throw Error("weights sum to " + std::to_string(sum), "vertex " + std::to_string(v), "1");
    }
  }
}

}  // namespace geoprior
