#pragma once

#include "experiments/embryo/measures/answers.h"
#include "experiments/embryo/measures/changes.h"
#include "experiments/embryo/measures/motion.h"
#include "experiments/embryo/measures/organs.h"
#include "experiments/embryo/measures/surfaces.h"

namespace geoprior::embryo {

/// What the groups of the table of metrics (metrics.cpp) measure, from the parts and tables of a
/// frame and the scene.
struct OntologyMeasures {
  double violations = 0;
  double sources = 0, time = 0, geometry = 0, relations = 0;  ///< of these
};
OntologyMeasures ontology_measures(const EmbryoScene& scene, const Frame& frame);

/// Readings of a day (SI units, rad).
struct OrganMeasures {
  std::optional<double> crown_rump, kidney_length, hilum_angle, branchings, upper_pole, lower_pole,
      level, mirror, duct_end;
};
OrganMeasures organ_measures(const EmbryoScene& scene, const Frame& frame);

}  // namespace geoprior::embryo
