#include "baselines/paper/adaptive/adaptive.h"
#include "baselines/paper/dense.h"
#include "experiments/paper/scene/scene.h"
#include "experiments/paper/topic.h"
#include "solvers/paper/hybrid.h"

namespace geoprior::paper {
std::vector<MethodEntry> methods() {
  using S = PaperScene;
  return {
      method_entry<S, DenseOptions>("dense", true, "shell elements on one uniform mesh",
                                    "implicit Euler: Baraff and Witkin 1998; docs/methods/paper.md",
                                    [](const S& scene, const DenseOptions& options, RunContext&) {
                                      return make_dense_sheet(scene.sheet, options);
                                    }),
      method_entry<S, AdaptiveOptions>(
          "adaptive", true, "shell elements, anisotropic remeshing in the pattern",
          "Narain, Samii and O'Brien 2012; Narain, Pfaff and O'Brien 2013",
          [](const S& scene, const AdaptiveOptions& options, RunContext&) {
            return make_adaptive_sheet(scene.sheet, options);
          }),
      method_entry<S, HybridOptions>(
          "hybrid", false, "planes, cylinders and cones decide the mesh of a coarse elastic sheet",
          "thesis 3.2.1; Schreck et al. 2015",
          [](const S& scene, const HybridOptions& options, RunContext&) {
            return make_hybrid_sheet(scene.sheet, options);
          }),
  };
}

namespace {

// Counts are exact on one machine; another compiler's round-off moves some of them.
constexpr Tolerance kWork{0.1, 0.05};

/// Recorded by every method, or by those whose mesh changes.
void add_solver(DiagnosticTable& table) {
  table.measured("triangles", {"triangles", "1", "triangles of the mesh"});
  table.measured(
      "handle_work",
      {"handle_work", "J", "work done on the sheet by the prescribed handles since the start"});
  table.unmeasured(
      "work of the solver, which leaves no trace in the sheet",
      {{"vertices", "1", "vertices of the mesh, unknowns of the solver"},
       {"substeps", "1", "time steps of the frame: more where handles are fast"},
       {"newton_iterations", "1", "linear solves of its steps", true, kWork},
       {"halvings", "1", "times a step was halved because Newton's iteration did not converge",
        true, kWork},
       {"factor_nonzeros", "1", "non-zeros of the factor of the last step's system"},
       // Recorded by those whose mesh changes.
       {"settle_steps", "1", "steps from rest that the sheet settled for after the change", true,
        kWork}});
}

/// Recorded of every sheet, whoever made its mesh.
void add_picture(DiagnosticTable& table) {
  table.unmeasured(
      "of the surface that pictures show: metrics are those of the simulated mesh",
      {{"drawn_distance", "m", "farthest of the part drawn from the triangles of surface"}});
}

/// Recorded where the paper tears.
void add_tears(DiagnosticTable& table) {
  table.measured("tear_length", {"tear_length", "m", "length of all tears"});
  table.measured("fracture_energy", {"tear_energy", "J",
                                     "energy that tearing took since the start: the integral of "
                                     "E_f over the torn section"});
  table.measured("tearing_force", {"tear_force", "N", "pull under which a tear grew last"});
  table.unmeasured(
      "of single steps of a tear: frames are farther apart",
      {{"tears", "1", "tears, the cuts of the start included"},
       {"tear_released", "J",
        "by which the elastic energy fell in the steps of tears since the start"},
       {"tear_steps", "1", "steps of tears since the start", true, kWork},
       {"tears_given_up", "1",
        "tears ended since the start for want of a mesh, or of least_part to cut off", true, kWork},
       {"tear_candidates", "1", "places tested since the start", true, kWork},
       {"tear_angle", "deg", "angle of the two images of the pull in the pattern"}});
}

/// Recorded by the adaptive mesh and by the hybrid.
void add_structure(DiagnosticTable& table) {
  table.unmeasured("work of the remeshing: a mesh does not say how it was made",
                   {{"splits", "1", "edges split by the frame's remeshing"},
                    {"collapses", "1", "edges collapsed by it"},
                    {"flips", "1", "edges flipped by it"},
                    {"pop_filter_steps", "1", "steps that take back the pop of the remeshing"}});
  table.measured("dcone_count", {"singular_points", "1", "singular points", true, kWork});
  table.measured("dcone_count",
                 {"new_singular_points", "1", "singular points inserted in the frame"});
  table.measured("isometry_max",
                 {"strain_after", "1",
                  "largest principal Green strain of a triangle after the projection, in modulus"});
  table.unmeasured("of the sheet before the projection, which is not recorded",
                   {{"strain_before", "1", "strain_after, before it"}});
  table.unmeasured(
      "the structure that only the hybrid has, and the work for it",
      {{"flats", "1", "planar pieces"},
       {"cylinders", "1", "cylindrical pieces"},
       {"cones", "1", "conical pieces"},
       {"rulings", "1", "rulings of all pieces"},
       {"new_rulings", "1", "rulings inserted in the frame"},
       {"rejected_changes", "1", "changes of the structure given up since the start"},
       {"unborn_points", "1",
        "singular points that took no energy out of the settled sheet, and were not made, since "
        "the start"},
       {"remeshed", "1", "1 when the frame changed the structure, else 0"},
       {"meshes_made", "1", "meshes made in the frame, those of changes taken back too", true,
        kWork},
       {"projection_iterations", "1", "iterations of the projection to isometry", true, kWork}});
}

}  // namespace

std::vector<DiagnosticEntry> diagnostics() {
  DiagnosticTable table;
  add_solver(table);
  add_picture(table);
  add_tears(table);
  add_structure(table);
  return table.rows();
}

}  // namespace geoprior::paper
