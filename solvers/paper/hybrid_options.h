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
  double euler_factor = 1;     ///< compression / critical strain beyond which rulings start
  double least_slope_deg = 2;  ///< slope of a buckle that is worth rulings (Euler's test)
  double compression_threshold = 1e-3;  ///< eps_c of the plain test
  double group_angle_deg = 20;          ///< directions of neighbours that belong together
  double seeding_distance = 0.016;      ///< s: distance of parallel rulings (m)
  double flat_size = 0.025;             ///< largest edge of the mesh where nothing is bent yet (m)
  int ruling_parts = 6;                 ///< most edges along a ruling: 1 keeps it from ever bending
  double merge_angle_deg = 5;           ///< cylinders closer than this in direction become one
  double singular_spacing = 2;  ///< smallest distance of singular points, in seeding distances
  int settle_frames = 3;        ///< age from which a ruling can be in conflict
  double cone_reach = 3;  ///< farthest that a new singular point cuts rulings, in seeding distances
  double flatten_angle_deg = 45;  ///< most that the rulings it cuts on a side turn the sheet
  double fan_angle_deg = 25;      ///< widest sector of a new cone without a ruling
  double refine_angle_deg = 15;   ///< fold of a ruling beside which another is put
  /// A singular point is made only when rulings that turn do not serve, and the sheet has less
  /// energy with it; it goes again when it has no more without, unless the paper has yielded there.
  bool energy_test = true;
  bool tracking = true;
  double guide_edge = 0.018;     ///< edges of the even mesh that shows how the sheet bends (m)
  double follow_angle_deg = 15;  ///< how far a ruling may be from the direction of least bending
  double tracking_rate_deg = 5;  ///< most that a ruling turns in a frame
  double flat_curvature = 0.5;   ///< kappa_0 under which a piece counts as flat (1/m)
  int flat_frames = 10;          ///< frames under it until a piece without singular point goes
  bool projection = true;        ///< isometry projection at the end of every frame
  int projection_iterations = 6;
  double projection_strain = 1e-4;  ///< edge strain at which it stops
  /// Strain after the projection beyond which a change of the structure is taken back; the next
  /// frame tries again, with another draw. Only when the unchanged structure is strained as well
  /// are there more attempts in the same frame, and the best of all stays.
  double accepted_strain = 4e-3;
  int attempts = 3;                ///< in such a frame
  int last_iterations = 8;         ///< of the projection then, in those of a usual frame
  double weakening_radius = 4e-3;  ///< r_p about a singular point (m)
  SettleOptions settle;
  TearOptions tearing;
  StepperOptions stepper;
};
void describe(OptionVisitor& v, HybridOptions& options);

}  // namespace geoprior::paper
