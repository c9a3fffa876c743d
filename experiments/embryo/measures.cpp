#include "experiments/embryo/measures.h"

#include <algorithm>

#include "solvers/embryo/ontology/consistency.h"

namespace geoprior::embryo {

OntologyMeasures ontology_measures(const EmbryoScene& scene, const Frame& /*frame*/) {
  OntologyMeasures m;
  for (const Violation& one : scene.violations) {
    ++m.violations;
    switch (violation_kind(one.kind).theme) {
      case ViolationKind::Theme::sources:
        ++m.sources;
        break;
      case ViolationKind::Theme::time:
        ++m.time;
        break;
      case ViolationKind::Theme::geometry:
        ++m.geometry;
        break;
      case ViolationKind::Theme::relations:
        ++m.relations;
        break;
    }
  }
  return m;
}

OrganMeasures organ_measures(const EmbryoScene& scene, const Frame& frame) {
  OrganMeasures m;
  if (frame.find_table(recorded::kBody) == nullptr) return m;
  const RecordedDay day(frame);
  const auto kidney = left_kidney(scene);
  const auto of = [&](const char* quantity) { return reading(scene, day, quantity, kidney); };
  m.crown_rump = of("crown_rump_length");
  m.kidney_length = of("kidney_length");
  m.hilum_angle = of("hilum_angle");
  for (const RecordedShape& one : day.shapes) {
    if (scene.ontology.structures[one.structure].side == "left")
      m.branchings = std::max(m.branchings.value_or(0), one.shape.branchings);
  }
  m.upper_pole = of("upper_pole_height");
  m.lower_pole = of("lower_pole_height");
  m.level = of("vertebral_level");
  m.mirror = mirror_error(scene, day);
  m.duct_end = duct_end_gap(scene, frame);
  return m;
}

}  // namespace geoprior::embryo
