#pragma once

#include "core/options.h"
#include "models/paper/tear/lip_detail.h"
#include "models/paper/tear/tip_pull.h"

namespace geoprior::paper {

/// midpoint: the direction in the middle of the step, extrapolated from those at its start and at
/// the start of the step before (Adams and Bashforth).
enum class TearIntegrator { euler, midpoint };
/// everywhere: every vertex of the mesh is a candidate, those of the thesis and tips too, and what
/// parts it is the largest tension over all directions of the triangles about it, on a flaw: the
/// general way, where nothing is known of the sheet (separation strength, Pfaff et al. 2014).
enum class TearSearch { candidates, everywhere };
/// bisector: away from both pulls; steepest: where most is released of what is opposed, which is
/// the bisector unless the paper has a grain; askew: 45 degrees from the bisector towards one pull
/// (a null).
enum class TearDirection { steepest, bisector, askew };

/// j_integral: what the outline of the piece about a tip says; resultants: 2 F cos(theta / 2) / e
/// of both resultants along the bisector of their images, whatever their lengths, as the thesis has
/// it; force: 2 F / e, whatever the angle between them (a null).
enum class TearRelease { j_integral, resultants, force };

/// How tears grow (thesis 3.2.2; what it leaves open is ours, see docs/methods/paper.md).
struct TearOptions {
  PullOptions pull;
  TearSearch search = TearSearch::candidates;
  TearRelease release = TearRelease::j_integral;
  double flaw = 4e-3;  ///< m
  double step = 2e-3;  ///< m
  TearIntegrator integrator = TearIntegrator::midpoint;
  TearDirection direction = TearDirection::steepest;
  double most_turn_deg = 30;
  int rest_steps = 20;
  double rest_turn_deg = 1;
  double rest_change = 0.02;
  double least_part = 1e-6;  ///< m^2
  LipDetailOptions detail;
};
void describe(OptionVisitor& v, TearOptions& options);

}  // namespace geoprior::paper
