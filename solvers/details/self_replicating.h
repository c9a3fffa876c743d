#pragma once

#include <memory>

#include "core/options.h"
#include "models/details/process.h"
#include "solvers/details/pattern_copier.h"

namespace geoprior::details {

/// When a triangle of M_d counts as stretched or shrunk.
enum class AreaRule {
  own,    ///< against its own initial area, carried through flips (the thesis)
  mean,   ///< against the mean initial area of all triangles
  budget  ///< against the density around it at rest, and only while its patch has fewer (to
          ///< shrink: more) details than its area asks for
};

/// What a weight may change by in a frame.
enum class WeightLaw {
  frame,   ///< weight_rate
  motion,  ///< motion_rate x (largest displacement of the frame / mean edge), at most weight_rate
};

/// Self-replicating details (thesis 2.2.2): details that multiply where the surface is stretched
/// and merge where it is squeezed, so that their spacing stays.
///
/// Every frame: the surface moves and details with it; the edges of M_d are measured, and flipped
/// to Delaunay; triangles with area A' > tau A_ref are filled, most stretched first, no two that
/// share a vertex: the most similar triangle of three details of the original (area, smallest
/// angle, then edge lengths) says where inside details lie, and they are copied by barycentric
/// coordinates with weight 0. In triangles with A' < A_ref / tau_c one detail of the shortest edge
/// fades, the closest two first, and leaves M_d at weight 0. Weights move to their targets at a
/// limited rate.
///
/// What it cannot do: it knows positions, not pictures; the plain method makes patterns with
/// structure beyond neighbours (clusters) more uniform; `histogram` counters that.
struct SelfReplicatingOptions {
  AreaRule area_rule = AreaRule::budget;
  double stretch_threshold = 1.75;
  double shrink_threshold = 1.75;
  int patch_details = 48;
  double dead_band = 0.1;
  bool anticipate = true;  ///< see `lead_of`
  WeightLaw weight_law = WeightLaw::frame;
  double weight_rate = 0.1;
  double motion_rate = 1;
  LengthRule lengths = LengthRule::chord;
  PatternCopierOptions copies;
};
void describe(OptionVisitor& v, SelfReplicatingOptions& options);

/// The method frame by frame. Phases inside a step: "move", "insert", "merge", "weights".
///
/// Diagnostics: inserted, revived, fading (started in the frame), removed, flips, refused_flips,
/// failed_queries, max_weight_change, budget_target; of the first frame also triplets,
/// triplets_met, table_bytes.
std::unique_ptr<DetailMethod> make_self_replicating(const DetailScene& scene,
                                                    const SelfReplicatingOptions& options,
                                                    std::uint64_t seed);

/// The method as a process: `make_detail_process` around it.
std::unique_ptr<Process> make_self_replicating_process(const DetailScene& scene,
                                                       const SelfReplicatingOptions& options);

}  // namespace geoprior::details
