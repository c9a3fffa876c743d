#include "baselines/details/dart_throwing.h"
#include "baselines/details/delaunay_refinement.h"
#include "baselines/details/lloyd.h"
#include "baselines/details/naive_stretch.h"
#include "baselines/details/re_scatter.h"
#include "experiments/details/scene/drawing.h"
#include "experiments/details/scene/scene.h"
#include "experiments/details/topic.h"
#include "solvers/details/self_replicating.h"

namespace geoprior::details {

std::vector<MethodEntry> methods() {
  using S = DetailsScene;
  return {
      method_entry<S, SelfReplicatingOptions>(
          "self-replicating", false,
          "details multiply where the surface is stretched and merge where it is squeezed",
          "thesis 2.2.2; Rohmer, Hahmann and Cani 2015",
          [](const S& scene, const SelfReplicatingOptions& options, RunContext&) {
            return with_drawing(make_self_replicating_process(scene.input, options), scene);
          }),
      method_entry<S, NaiveStretchOptions>(
          "naive-stretch", true, "details go where the surface goes, none comes, none leaves",
          "what a texture does",
          [](const S& scene, const NaiveStretchOptions& options, RunContext&) {
            return with_drawing(make_naive_stretch_process(scene.input, options), scene);
          }),
      method_entry<S, ReScatterOptions>(
          "re-scatter", true, "all details are scattered anew in every frame",
          "Poisson-disk by dart throwing: Cook 1986",
          [](const S& scene, const ReScatterOptions& options, RunContext&) {
            return with_drawing(make_re_scatter_process(scene.input, options), scene);
          }),
      method_entry<S, DartThrowingOptions>(
          "dart-throwing", true, "darts thrown where the surface is stretched become details",
          "Poisson-disk by dart throwing: Cook 1986",
          [](const S& scene, const DartThrowingOptions& options, RunContext&) {
            return with_drawing(make_dart_throwing_process(scene.input, options), scene);
          }),
      method_entry<S, DelaunayRefinementOptions>(
          "delaunay-refinement", true, "details come at the points farthest from all others",
          "Chew 1989",
          [](const S& scene, const DelaunayRefinementOptions& options, RunContext&) {
            return with_drawing(make_delaunay_refinement_process(scene.input, options), scene);
          }),
      method_entry<S, LloydOptions>(
          "lloyd", true, "details slide to the centroids of their Voronoi cells in every frame",
          "Lloyd 1982; Du, Faber and Gunzburger 1999",
          [](const S& scene, const LloydOptions& options, RunContext&) {
            return with_drawing(make_lloyd_process(scene.input, options), scene);
          }),
  };
}

std::vector<DiagnosticEntry> diagnostics() {
  // Counts are exact on one machine; another compiler's round-off moves some of them.
  constexpr Tolerance kWork{0.1, 0.05};
  DiagnosticTable table;
  // Recorded by every method.
  table.measured("count_ratio", {"details", "1", "details, visible or not"});
  table.measured("visible_density_ratio", {"visible_details", "1", "details of weight above 1/2"});
  table.measured("mean_edge_change", {"mean_edge", "m", "mean edge of M_d among details"});
  table.measured("inserted_total", {"inserted", "1", "details that came in the frame"});
  table.measured("removed_total", {"removed", "1", "details that left in the frame"});
  table.measured("weight_step",
                 {"max_weight_change", "1", "largest change of a weight in the frame"});
  table.unmeasured(
      "work of the method, and of the mesh that it alone keeps",
      {{"ghosts", "1", "vertices of the surface that M_d keeps: along borders, around thin parts"},
       {"flips", "1", "edges of M_d flipped in the frame", true, kWork},
       // Recorded by self-replicating details.
       {"revived", "1", "fading details that were called back in the frame"},
       {"fading", "1", "details that began to fade in the frame"},
       {"refused_flips", "1", "flips that M_d refused since the start"},
       {"failed_queries", "1", "triangles for which the table held no triplet"},
       {"budget_target", "1", "details that the surface asks for"},
       {"triplets", "1", "triplets in the table (first frame)"},
       {"triplets_met", "1", "triplets that were looked at to fill it (first frame)", true, kWork},
       {"table_bytes", "B", "memory of the table (first frame)"},
       // Recorded by relaxation.
       {"mean_slide", "m", "mean way that the relaxation moved details in the frame"},
       {"max_slide", "m", "largest such way"},
       // Recorded by scattering.
       {"darts", "1", "darts thrown in the frame", true, kWork}});
  return table.rows();
}

}  // namespace geoprior::details
