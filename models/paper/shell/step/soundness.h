#pragma once

#include <Eigen/Core>

#include "models/paper/shell/elements.h"

namespace geoprior::paper {

/// Whether positions after a step are finite and no triangle has collapsed or turned over.
[[nodiscard]] bool is_sound(const ShellElements& elements, const Eigen::MatrixX3d& before,
                            const Eigen::MatrixX3d& after);

/// Whether an edge has grown so much that the step may have gone too far.
[[nodiscard]] bool stretches(const ShellElements& elements, const Eigen::MatrixX3d& before,
                             const Eigen::MatrixX3d& after);

}  // namespace geoprior::paper
