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

std::vector<DiagnosticEntry> diagnostics() {
  // Counts are exact on one machine; another compiler's round-off moves some of them.
  constexpr Tolerance kWork{0.1, 0.05};
  return {
      // Recorded by every method.
      {"triangles", "1", "triangles of the mesh"},
      {"vertices", "1", "vertices of the mesh"},
      {"substeps", "1", "time steps of the frame: more where handles are fast"},
      {"newton_iterations", "1", "linear solves of its steps", true, kWork},
      {"halvings", "1", "times a step was halved because Newton's iteration did not converge", true,
       kWork},
      {"factor_nonzeros", "1", "non-zeros of the factor of the last step's system"},
      {"handle_work", "J", "work done on the sheet by the prescribed handles since the start"},
      // Recorded by those whose mesh changes.
      {"settle_steps", "1", "steps from rest that the sheet settled for after the change", true,
       kWork},
      // Recorded where the paper tears.
      {"tears", "1", "tears, the cuts of the start included"},
      {"tear_length", "m", "length of all tears"},
      {"tear_energy", "J",
       "energy that tearing took since the start: the integral of E_f over the "
       "torn section"},
      {"tear_released", "J",
       "by which the elastic energy fell in the steps of tears since the start"},
      {"tear_steps", "1", "steps of tears since the start", true, kWork},
      {"tears_given_up", "1",
       "tears ended since the start for want of a mesh, or of least_part to cut off", true, kWork},
      {"tear_candidates", "1", "places tested since the start", true, kWork},
      {"tear_force", "N", "pull under which a tear grew last"},
      {"tear_angle", "deg", "angle of its two images in the pattern"},
      // Recorded by the adaptive mesh.
      {"splits", "1", "edges split by the frame's remeshing"},
      {"collapses", "1", "edges collapsed by it"},
      {"flips", "1", "edges flipped by it"},
      {"pop_filter_steps", "1", "steps that take back the pop of the remeshing"},
      // Recorded by the hybrid.
      {"flats", "1", "planar pieces"},
      {"cylinders", "1", "cylindrical pieces"},
      {"cones", "1", "conical pieces"},
      {"rulings", "1", "rulings of all pieces"},
      {"singular_points", "1", "singular points", true, kWork},
      {"new_rulings", "1", "rulings inserted in the frame"},
      {"new_singular_points", "1", "singular points inserted in the frame"},
      {"rejected_changes", "1", "changes of the structure given up since the start"},
      {"unborn_points", "1",
       "singular points that took no energy out of the settled sheet, and were not made, since the "
       "start"},
      {"remeshed", "1", "1 when the frame changed the structure, else 0"},
      {"meshes_made", "1", "meshes made in the frame, those of changes taken back too", true,
       kWork},
      {"projection_iterations", "1", "iterations of the projection to isometry", true, kWork},
      {"strain_before", "1", "largest principal Green strain of a triangle before it, in modulus"},
      {"strain_after", "1", "the same after it"},
  };
}

}  // namespace geoprior::paper
