#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/inputs/surface_sequence.h"
#include "solvers/fluid/edits.h"
#include "solvers/fluid/feature.h"

namespace geoprior::fluid {

/// Inputs of the processes `extract` and `sculpt`. Sequences are read frame by frame.
struct SculptScene {
  std::map<std::string, std::shared_ptr<const SurfaceSequence>> sources;
  std::map<std::string, std::vector<Feature>> libraries;  ///< features read from files
  std::shared_ptr<const SurfaceSequence> target;          ///< one frame: a still mesh
  std::vector<Edit> edits;
  std::vector<double> times;  ///< of the result (s)
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};

}  // namespace geoprior::fluid
