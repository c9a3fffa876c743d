#pragma once

#include <string>

#include "solvers/sketch/layers/articulated_layers.h"

namespace geoprior::sketch {

/// What `layers.txt` says: of every edge how it was met, of every joint how far its layers overlap,
/// whether that was chosen or given, and how far it turns; in millimetres and degrees.
std::string joint_table(const ArticulatedLayers& layers);

}  // namespace geoprior::sketch
