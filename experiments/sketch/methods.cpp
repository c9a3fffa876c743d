#include <map>
#include <memory>
#include <string>
#include <utility>

#include "baselines/sketch/angle_defect_flow.h"
#include "baselines/sketch/developability_flow.h"
#include "baselines/sketch/frustum_formula.h"
#include "baselines/sketch/gauss_thinning/gauss_thinning.h"
#include "baselines/sketch/visual_hull/visual_hull.h"
#include "experiments/sketch/drawing/suggested_drawing.h"
#include "experiments/sketch/flattened.h"
#include "experiments/sketch/scene/scene.h"
#include "experiments/sketch/slow_road.h"
#include "experiments/sketch/topic.h"
#include "solvers/sketch/layers/layers.h"
#include "solvers/sketch/one_view_process.h"
#include "solvers/sketch/several_views.h"
#include "testbed/formats/artifact.h"

namespace geoprior::sketch {
namespace {

/// A flow of baselines/sketch as a method of the topic.
template <class Options>
struct FlowRun {
  int iterations = 100;
  Options flow;
};

template <class Options>
void describe(OptionVisitor& v, FlowRun<Options>& o) {
  v.value("iterations", o.iterations,
          {.doc = "number of steps; a frame each", .min = 1, .max = 100000});
  describe(v, o.flow);
}

template <class Flow>
class FlowMethod final : public SketchMethod {
 public:
  template <class Options>
  FlowMethod(const PreparedSketch& prepared, const Options& options)
      : flow_({prepared.start, prepared.surface.hull.mesh.F}, options) {}
  void step(RunContext& /*context*/) override { flow_.step(); }
  [[nodiscard]] const Eigen::MatrixX3d& positions() const override { return flow_.surface().V; }
  void load(StateReader& /*in*/) override {}
  /// What a flow remembers of its steps is its own.
  [[nodiscard]] bool can_resume() const override { return false; }
  void diagnose(std::map<std::string, double>& into) const override {
    into["flow_energy"] = flow_.energy();
  }

 private:
  Flow flow_;
};

template <class Flow, class Options>
MethodEntry flow_entry(std::string name, std::string summary, std::string source) {
  return method_entry<SketchScene, FlowRun<Options>>(
      std::move(name), true, std::move(summary), std::move(source),
      [](const SketchScene& scene, const FlowRun<Options>& options, RunContext&) {
        return make_sketch_process(
            scene.input, options.iterations,
            [flow = options.flow](const PreparedSketch& prepared, RunContext&) {
              return std::make_unique<FlowMethod<Flow>>(prepared, flow);
            });
      });
}

std::vector<Artifact> suggestion_files(const SketchInput& input,
                                       const std::vector<SuggestedSeam>& suggestions) {
  if (input.surface) return {};
  return {artifact_of("suggestions.svg",
                      suggested_drawing_svg(align_views(input.drawing, input.align), suggestions))};
}

/// What is guessed of hidden borders, and what noise leaves unsure.
std::vector<std::string> one_view_warnings(const SketchScene& scene,
                                           const OneViewOptions& options) {
  const View* view = scene.input.drawing.find(ViewKind::photo);
  return view == nullptr ? std::vector<std::string>{} : one_view_notes(*view, options);
}

/// What is decided before anything is solved.
void add_readings(DiagnosticTable& table) {
  table.unmeasured(
      "how the drawing was read: of known shapes depth and axes are measured",
      {{"axis_residual", "deg",
        "between the mirror plane and the axis that a free ellipse has, the reading that was "
        "kept; the largest"},
       {"axis_residual_other", "deg", "of the other reading, the least"},
       {"vector_ratio", "1", "length of sym-a over that of sym-b in space, as found"},
       {"perspective", "1", "growth of the image over one diagonal of depth, as found"}});
  table.unmeasured(
      "what the hull's sections were taken for: of known things areas are measured",
      {{"openings", "1", "drawn borders that end tubes, of all views together"},
       {"round_tubes", "1", "tubes with round sections that end in them"},
       {"top_sections", "1", "share of the closed hull's area on the scaled top view's outline"},
       {"round_sections", "1", "share on round sections"},
       {"box_sections", "1", "share on the faces that the views see"}});
  table.unmeasured(
      "where a texture's points came from: its picture alone is recorded",
      {{"texture_seen", "1", "share of the pattern that the photograph shows"},
       {"texture_mirrored", "1", "share that has the colour of its visible mirror image"},
       {"texture_flat", "1", "share that nothing shows: the mean colour of its panel"},
       {"texture_continued", "1",
        "share that is shown beside a silhouette only: colours go on from around"}});
}

}  // namespace

std::vector<MethodEntry> methods() {
  using S = SketchScene;
  std::vector<MethodEntry> all{
      method_entry<S, SeveralViewsOptions>(
          "several-views", false,
          "the hull is pulled onto the silhouettes and made developable, in turns",
          "thesis 2.1.2; Jung et al. 2015",
          [](const S& scene, const SeveralViewsOptions& options, RunContext&) {
            return make_several_views_process(
                scene.input, options,
                [&input = scene.input](const std::vector<SuggestedSeam>& suggestions) {
                  return suggestion_files(input, suggestions);
                });
          }),
      with_warnings<S, OneViewOptions>(
          method_entry<S, OneViewOptions>(
              "one-view", false, "depth of one annotated view by symmetry and rulings, mirrored",
              "thesis 2.1.3; Fondevilla et al. 2017",
              [](const S& scene, const OneViewOptions& options, RunContext&) {
                return make_one_view_process(scene.photo_input(), options);
              }),
          one_view_warnings),
      method_entry<S, LayerOptions>(
          "layers", false, "rigid layers through drawn arcs, riveted, within their joints' range",
          "thesis 2.1.4, figure 2.14",
          [](const S& scene, const LayerOptions& options, RunContext&) {
            return make_layers_process(scene.photo(), options, scene.input.pattern,
                                       scene.layer_files());
          }),
      method_entry<S, FrustumFormulaOptions>(
          "frustum-formula", true, "circles from their own ellipses, depth from their tilt",
          "closed form; no mirror plane",
          [](const S& scene, const FrustumFormulaOptions& options, RunContext&) {
            return make_frustum_formula_process(scene.photo(), options);
          }),
      method_entry<S, VisualHullOptions>(
          "visual-hull", true, "all points that every view sees, as it is or smoothed",
          "Rivers, Durand and Igarashi 2010; Taubin 1995",
          [](const S& scene, const VisualHullOptions& options, RunContext&) {
            return make_visual_hull_process(scene.input, options);
          }),
      flow_entry<GaussThinning, GaussThinningOptions>(
          "gauss-thinning", "normals are turned onto great circles, silhouettes are not known",
          "Binninger, Verhoeven, Herholz and Sorkine-Hornung 2021"),
      flow_entry<DevelopabilityFlow, DevelopabilityFlowOptions>(
          "developability-flow", "the hinge energy is descended, silhouettes are not known",
          "Stein, Grinspun and Crane 2018"),
      flow_entry<AngleDefectFlow, AngleDefectFlowOptions>(
          "angle-defect-flow", "the squared angle defects are descended, silhouettes are not known",
          "Wang and Tang 2004"),
  };
  all.push_back(flattened_method());
  all.push_back(slow_road_method());
  return all;
}

std::vector<DiagnosticEntry> diagnostics() {
  DiagnosticTable table;
  table.measured("silhouette_gaps",
                 {"gaps", "1", "stretches of silhouettes that no edge of the surface can cover"});
  table.measured("silhouette_gaps", {"gap_length", "m", "their length in all"});
  table.unmeasured(
      "what a solver minimises, and its work: the surface does not say how it was found",
      {{"silhouette_edges", "1", "edges that carry the silhouettes of all views"},
       {"residual_accuracy", "m", "root mean square of the rows of the term, as all of these"},
       {"residual_variation", "m", "of even variation of depth along curves"},
       {"residual_pairs", "m", "of drawn symmetric pairs"},
       {"residual_dense", "m", "of matches between them"},
       {"residual_developability", "m", "of tangent planes along rulings"},
       {"residual_planarity", "m", "of flat panels"},
       {"residual_parallel", "m", "of parallel ends of patches"},
       {"condition", "1", "greatest over least eigenvalue of the normal matrix"},
       {"matches", "1", "dense symmetric correspondences"},
       {"guessed_length", "1", "share of the length of borders in the view that is not drawn"},
       {"guessed_area", "1",
        "share of the surface, before it is mirrored, between borders that are not drawn"},
       {"arc_condition", "1", "greatest over least singular value of an arc's fit, the worst"},
       {"ratio_gain", "1",
        "cost of the refinement with the ratio of the drawn vectors held over that without"},
       {"refine_iterations", "1", "steps of the non-linear refinement"},
       {"flow_energy", "1", "what a flow descends, as it defines it"}});
  table.unmeasured(
      "of the joints' limits, of which the recorded poses are single points",
      {{"joint_share", "1", "share of the joints' limits: 1 curled up, -1 bent back"},
       {"curl", "deg", "sum of the largest angles of all joints that curl the body up"},
       {"bend_back", "deg", "and that bend it back"},
       {"least_range", "deg", "of a joint, both ways together, the least"}});
  table.unmeasured(
      "what was chosen, of which the surface shows the result",
      {{"overlap_least", "1",
        "overlap of a layer below the one before over that one's visible length, the least"},
       {"overlap_most", "1", "and the largest of all joints"},
       {"room_least", "deg", "angle either way for which the strip below has room, the least"}});
  add_readings(table);
  return table.rows();
}

}  // namespace geoprior::sketch
