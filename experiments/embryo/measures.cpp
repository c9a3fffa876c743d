#include "experiments/embryo/measures.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace geoprior::embryo {
namespace {

using Kinds = std::span<const std::string_view>;

constexpr std::array<std::string_view, 5> kOfSources{"missing_source", "missing_unit", "two_units",
                                                     "unknown_source", "unknown_unit"};
constexpr std::array<std::string_view, 18> kOfTime{"child_before_progenitor",
                                                   "hole_in_keys",
                                                   "interval_reversed",
                                                   "key_outside_existence",
                                                   "part_outside_whole",
                                                   "process_span_empty",
                                                   "process_span_reversed",
                                                   "product_begins_elsewhere",
                                                   "stage_next_against_order",
                                                   "stage_order_against_days",
                                                   "stage_order_gap",
                                                   "stage_order_repeated",
                                                   "stage_reversed",
                                                   "stages_overlap",
                                                   "structure_without_stages",
                                                   "two_keys_at_one_stage",
                                                   "unknown_stage",
                                                   "key_without_stage"};
constexpr std::array<std::string_view, 24> kOfGeometry{"anchor_cycle",
                                                       "anchor_on_no_structure",
                                                       "axis_parallel_to_up",
                                                       "axis_zero",
                                                       "crown_rump_missing",
                                                       "crown_rump_not_line",
                                                       "crown_rump_twice",
                                                       "duct_with_two_ends",
                                                       "duct_without_end",
                                                       "egg_out_of_range",
                                                       "fixation_without_duct",
                                                       "frame_cycle",
                                                       "key_with_two_geometries",
                                                       "key_without_geometry",
                                                       "not_finite",
                                                       "not_positive",
                                                       "negative_number",
                                                       "placed_on_absent",
                                                       "primitive_changes",
                                                       "structure_without_keys",
                                                       "unknown_geometry",
                                                       "unknown_primitive",
                                                       "vector_length",
                                                       "product_with_keys"};

bool is_of(Kinds kinds, const std::string& kind) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

}  // namespace

OntologyMeasures ontology_measures(const EmbryoScene& scene, const Frame& /*frame*/) {
  OntologyMeasures m;
  for (const Violation& one : scene.violations) {
    ++m.violations;
    double& theme = is_of(kOfSources, one.kind)    ? m.sources
                    : is_of(kOfTime, one.kind)     ? m.time
                    : is_of(kOfGeometry, one.kind) ? m.geometry
                                                   : m.relations;
    ++theme;
  }
  return m;
}

OrganMeasures organ_measures(const EmbryoScene& scene, const Frame& frame) {
  const auto kidney = left_kidney(scene);
  const auto of = [&](const char* quantity) { return reading(scene, frame, quantity, kidney); };
  OrganMeasures m;
  if (frame.find_table(recorded::kBody) == nullptr) return m;
  m.crown_rump = of("crown_rump_length");
  m.kidney_length = of("kidney_length");
  m.hilum_angle = of("hilum_angle");
  for (const RecordedShape& one : recorded_shapes(frame)) {
    if (scene.ontology.structures[one.structure].side == "left")
      m.branchings = std::max(m.branchings.value_or(0), one.shape.branchings);
  }
  m.upper_pole = of("upper_pole_height");
  m.lower_pole = of("lower_pole_height");
  m.level = of("vertebral_level");
  m.mirror = mirror_error(scene, frame);
  m.duct_end = duct_end_gap(scene, frame);
  return m;
}

}  // namespace geoprior::embryo
