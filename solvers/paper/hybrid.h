#pragma once

#include <memory>

#include "baselines/paper/sheet_process.h"
#include "solvers/paper/structure.h"

namespace geoprior {

enum class CompressionTest { euler, threshold };

/// Options of the hybrid model (thesis 3.2.1; what it leaves open is ours, see
/// docs/methods/paper.md).
struct HybridOptions {
  CompressionTest test = CompressionTest::euler;
  double euler_factor = 1;  ///< compression / Euler's critical strain beyond which rulings start
  double compression_threshold = 1e-3;  ///< eps_c of the plain test
  double group_angle_deg = 20;          ///< directions of neighbours that belong together
  double seeding_distance = 0.02;       ///< s: distance of parallel rulings (m)
  double flat_size = 0.1;               ///< largest edge of the mesh where nothing is bent yet (m)
  double merge_angle_deg = 5;           ///< cylinders closer than this in direction become one
  double singular_spacing = 2;  ///< smallest distance of singular points, in seeding distances
  bool tracking = true;
  double tracking_rate_deg = 5;  ///< most that a ruling turns in a frame
  double flat_curvature = 0.5;   ///< kappa_0 under which a piece counts as flat (1/m)
  int flat_frames = 10;          ///< frames under it until a piece without singular point goes
  bool projection = true;        ///< isometry projection after remeshing and at frames
  int projection_iterations = 4;
  double projection_strain = 1e-4;  ///< edge strain at which it stops
  double weakening_radius = 4e-3;   ///< r_p about a singular point (m)
  StepperOptions stepper;
};
void describe(OptionVisitor& v, HybridOptions& options);

/// The hybrid model as a process: parts "rulings" (lines; cell arrays "piece", "kind": 0 flat,
/// 1 cylinder, 2 cone), "singular_points" (points; "id", "birth" [s], "weakening"), cell arrays
/// "piece" and "kind" on "surface", tables "pieces" and "singular_points".
std::unique_ptr<Process> make_hybrid_sheet(const Sheet& sheet, const HybridOptions& options);

}  // namespace geoprior
