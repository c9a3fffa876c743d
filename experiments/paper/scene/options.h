#pragma once

#include <array>
#include <vector>

#include "core/options.h"
#include "experiments/paper/scene/sheet_options.h"

namespace geoprior::paper {

/// Where the flat sheet lies at the start.
struct PlacementOptions {
  std::array<double, 3> move{0, 0, 0};
  std::array<double, 3> turn_deg{0, 0, 0};
};
void describe(OptionVisitor& v, PlacementOptions& options);

/// `[scene]` of a paper experiment.
struct PaperSceneOptions {
  PatternOptions pattern;
  PaperMaterial material;
  ToughnessOptions toughness;
  std::vector<HandleOptions> handles;
  std::vector<ObstacleOptions> obstacles;
  std::array<double, 3> gravity{0, 0, -9.81};
  PlacementOptions placement;
  double imperfection = 1e-4;
  double duration = 1;
  double frame_interval = 0.04;
  int substeps = 8;
  double handle_step = 1e-4;
  double fold_radius = 0.03;
};
void describe(OptionVisitor& v, PaperSceneOptions& options);

}  // namespace geoprior::paper
