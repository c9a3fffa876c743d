#pragma once

#include <Eigen/Core>
#include <functional>

#include "core/context.h"
#include "models/details/area_budget.h"
#include "models/details/mesh.h"

namespace geoprior::details {

/// What a step did beside the changes of the method itself.
struct StepReport {
  int flips = 0;  ///< of edges of M_d
  double max_weight_change = 0;
};

/// One step of a method that keeps M_d and changes it detail by detail: the surface moves to `V`
/// and the details with it (phase "move"); `change` lets details come and go, in phases of its own;
/// weights move to their targets by at most `weight_step` (phase "weights").
StepReport step_details(DetailMesh& details, const Eigen::MatrixX3d& V, LengthRule lengths,
                        double weight_step, RunContext& context,
                        const std::function<void()>& change);

/// How many frames ahead patches ask for details, when weights change by at most `weight_rate` a
/// frame, so that a detail takes K = 1 / weight_rate frames to appear or to fade: K / 4 where they
/// grow (a newborn is in M_d at once and visible after K / 2), 3 K / 4 where they shrink (a fading
/// detail is visible for K / 2 and in M_d for K). None without `anticipate`.
AreaBudget::Lead lead_of(bool anticipate, double weight_rate);

/// Lets a detail fade: its target weight is 0 from now on, and its patch counts it no more.
void fade_detail(DetailMesh& details, int site, AreaBudget& budget);

/// Details that fade turn back where their patch lacks `limit` or more, the largest weights first.
/// @return  number of details
int revive_details(DetailMesh& details, AreaBudget& budget, double limit);

}  // namespace geoprior::details
