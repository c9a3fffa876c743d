#pragma once

#include "core/options.h"
#include "models/paper/sheet/settle.h"
#include "models/paper/shell/stepper_options.h"
#include "models/paper/tear/options.h"

namespace geoprior::paper {

enum class CompressionTest { euler, threshold };

/// Options of the hybrid model (thesis 3.2.1; what it leaves open is ours, see
/// docs/methods/paper.md).
struct HybridOptions {
  CompressionTest test = CompressionTest::euler;
  double euler_factor = 1;
  double least_slope_deg = 2;
  double compression_threshold = 1e-3;  ///< eps_c
  double group_angle_deg = 20;
  double seeding_distance = 0.016;  ///< s (m)
  double flat_size = 0.025;         ///< m
  int refinements = 2;              ///< most halvings of `flat_size` where the sheet strains
  int ruling_parts = 6;
  double merge_angle_deg = 5;
  double singular_spacing = 2;
  int settle_frames = 3;
  double cone_reach = 3;
  double flatten_angle_deg = 45;
  double fan_angle_deg = 25;
  double refine_angle_deg = 15;
  /// A singular point is made only when rulings that turn do not serve, and the sheet has less
  /// energy with it; it goes again when it has no more without, unless the paper has yielded there.
  bool energy_test = true;
  /// In every so many frames there is a look at where rulings should be; between them the structure
  /// stays, unless the sheet strains.
  int look_frames = 5;
  double jump_share = 0.4;
  bool tracking = true;
  double guide_edge = 0.018;  ///< m
  double follow_angle_deg = 15;
  double tracking_rate_deg = 5;
  double flat_curvature = 0.5;  ///< kappa_0 (1/m)
  int flat_frames = 10;
  bool projection = true;
  int projection_iterations = 6;
  double projection_strain = 1e-4;
  /// Strain after the projection beyond which a change of the structure is taken back; the next
  /// look tries again, with another draw. Only when the unchanged structure is strained as well
  /// are there more attempts in the same frame, and the best of all stays.
  double accepted_strain = 4e-3;
  int attempts = 3;
  int last_iterations = 8;
  double weakening_radius = 4e-3;  ///< r_p (m)
  SettleOptions settle;
  TearOptions tearing;
  StepperOptions stepper;
};
void describe(OptionVisitor& v, HybridOptions& options);

}  // namespace geoprior::paper
