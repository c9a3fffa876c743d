#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/skinning/measures.h"
#include "experiments/skinning/topic.h"

namespace geoprior::skinning {
namespace {

MetricEntry entry(std::string name, std::string unit, std::string definition, Direction direction,
                  Tolerance tolerance, std::function<Value(const Measured&)> measure,
                  double target = 0) {
  MetricEntry e;
  e.name = std::move(name);
  e.unit = std::move(unit);
  e.definition = std::move(definition);
  e.direction = direction;
  e.tolerance = tolerance;
  e.target = target;
  e.of_frame = [measure = std::move(measure)](const Scene& scene, const Frame& frame,
                                              const Frame*) {
    return measure(measured(scene, frame));
  };
  return e;
}

MetricEntry reference_entry(std::string name, std::string unit, std::string definition,
                            Tolerance tolerance,
                            std::function<Value(const Measured&, const Measured&)> measure) {
  MetricEntry e = entry(std::move(name), std::move(unit), std::move(definition),
                        Direction::lower_is_better, tolerance, {});
  e.needs_reference = true;
  e.of_frame = [measure = std::move(measure)](const Scene& scene, const Frame& frame,
                                              const Frame* reference) -> Value {
    if (!reference) return std::nullopt;
    return measure(measured(scene, frame), measured(scene, *reference));
  };
  return e;
}

using SharedPtr = std::shared_ptr<Shared>;

void add_volume_metrics(std::vector<MetricEntry>& table, const SharedPtr& shared) {
  const Tolerance ratio{1e-9, 1e-6};
  table.push_back(entry("volume_change", "1",
                        "change of the volume of the joint's region, closed by fans from the "
                        "centroids of its border loops, over its rest volume",
                        Direction::closer_to_target, ratio, volume_change));
  table.push_back(entry("volume_change_size", "1", "absolute value of volume_change",
                        Direction::lower_is_better, ratio, [](const Measured& m) -> Value {
                          const Value change = volume_change(m);
                          return change ? Value(std::abs(*change)) : std::nullopt;
                        }));
  table.push_back(entry("volume_change_global", "1",
                        "change of the signed volume of the whole closed surface over its rest "
                        "volume",
                        Direction::closer_to_target, ratio,
                        [shared](const Measured& m) { return volume_change_global(*shared, m); }));
}

void add_contact_metrics(std::vector<MetricEntry>& table, const SharedPtr& shared) {
  const Tolerance volume{1e-12, 1e-6};
  table.push_back(entry("overlap_excess", "m^3",
                        "integral of max(0, winding number - 1) over the box about the region's "
                        "joints (whole body without a region) minus the same at rest; 0 where it "
                        "does not exceed overlap_noise_floor",
                        Direction::lower_is_better, volume, [shared](const Measured& m) {
                          return clipped(overlap_excess(*shared, m));
                        }));
  table.push_back(entry("overlap_excess_raw", "m^3", "overlap_excess before it is set to 0",
                        Direction::lower_is_better, volume, [shared](const Measured& m) -> Value {
                          const auto study = overlap_excess(*shared, m);
                          return study ? Value(study->volume) : std::nullopt;
                        }));
  table.push_back(entry("overlap_noise_floor", "m^3",
                        "largest difference of the overlap between column spacings h and h/2 and "
                        "between two column axes, at least the overlap that fits between columns",
                        Direction::none, volume, [shared](const Measured& m) -> Value {
                          const auto study = overlap_excess(*shared, m);
                          return study ? Value(study->noise_floor) : std::nullopt;
                        }));
  table.push_back(reference_entry(
      "overlap_excess_ratio", "1",
      "0 where overlap_excess_raw does not exceed the noise floor, else over that of the reference "
      "variant or the floor, whichever is larger",
      {1e-6, 1e-6}, [shared](const Measured& m, const Measured& reference) {
        return overlap_excess_ratio(*shared, m, reference);
      }));
  table.push_back(entry("intersecting_pairs", "1",
                        "pairs of triangles that intersect, at least one of them in the region "
                        "(anywhere without a region), minus the same at rest",
                        Direction::lower_is_better, {2, 0.01},
                        [shared](const Measured& m) { return pairs_excess(*shared, m); }));
}

void add_section_metrics(std::vector<MetricEntry>& table, const SharedPtr& shared) {
  const Tolerance ratio{1e-6, 1e-6};
  const auto add = [&](const char* name, const char* definition, Direction direction, double target,
                       std::optional<double> SectionSummary::*member) {
    table.push_back(entry(
        name, "1", definition, direction, ratio,
        [shared, member](const Measured& m) -> Value {
          const std::optional<SectionSummary> summary = sections_of(*shared, m);
          return summary ? (*summary).*member : std::nullopt;
        },
        target));
  };
  add("section_shrink",
      "smallest area ratio, against rest, of a half cross-section orthogonal to the bones within "
      "the region (whole sections when there is no bend axis)",
      Direction::higher_is_better, 0, &SectionSummary::shrink);
  add("section_bulge", "largest such area ratio", Direction::closer_to_target, 1,
      &SectionSummary::bulge);
  add("outer_bulge",
      "largest relative growth of the half cross-sections on the outer side of the bend",
      Direction::lower_is_better, 0, &SectionSummary::outer_bulge);
  add("elbow_collapse",
      "smallest ratio, against rest, of the distance of the outermost point of a cross-section "
      "from its centre",
      Direction::closer_to_target, 1, &SectionSummary::elbow_collapse);
}

void add_distortion_metrics(std::vector<MetricEntry>& table, const SharedPtr& shared) {
  const Tolerance ratio{1e-6, 1e-6};
  const auto add = [&](const char* name, const char* definition, Direction direction, double target,
                       double DistortionSummary::*member) {
    table.push_back(entry(
        name, "1", definition, direction, ratio,
        [shared, member](const Measured& m) -> Value {
          const std::optional<DistortionSummary> summary = distortion_of(*shared, m);
          return summary ? Value((*summary).*member) : std::nullopt;
        },
        target));
  };
  add("area_ratio_p05",
      "5th percentile, by rest area, of the triangles' area ratio against rest in the region",
      Direction::closer_to_target, 1, &DistortionSummary::area_ratio_p05);
  add("area_ratio_p95",
      "95th percentile, by rest area, of the triangles' area ratio against rest in the region",
      Direction::closer_to_target, 1, &DistortionSummary::area_ratio_p95);
  add("singular_value_max",
      "largest singular value of a triangle's deformation gradient against rest in the region",
      Direction::lower_is_better, 0, &DistortionSummary::singular_value_max);
  add("symmetric_dirichlet",
      "mean by rest area of |J|^2 + |J^-1|^2 over the region's triangles; 4 for an isometry",
      Direction::lower_is_better, 0, &DistortionSummary::symmetric_dirichlet);
}

void add_position_metrics(std::vector<MetricEntry>& table) {
  table.push_back(entry("rest_identity", "1",
                        "largest distance of a vertex from the input in the rest pose, over the "
                        "diagonal of the bounding box",
                        Direction::lower_is_better, {1e-9, 0}, rest_identity));
  const Tolerance ring{1e-9, 1e-6};
  table.push_back(entry(
      "mid_ring_min", "1",
      "smaller half axis of the tube's mid-ring (from its second moments about the joint), over "
      "the "
      "rest radius",
      Direction::closer_to_target, ring,
      [](const Measured& m) -> Value {
        const std::optional<RingRatio> ratio = mid_ring(m);
        return ratio ? Value(ratio->min) : std::nullopt;
      },
      1));
  table.push_back(entry(
      "mid_ring_max", "1",
      "larger half axis of the tube's mid-ring (from its second moments about the joint), over the "
      "rest radius",
      Direction::closer_to_target, ring,
      [](const Measured& m) -> Value {
        const std::optional<RingRatio> ratio = mid_ring(m);
        return ratio ? Value(ratio->max) : std::nullopt;
      },
      1));
  MetricEntry pops;
  pops.name = std::string("second_difference_max");
  pops.unit = std::string("m");
  pops.definition =
      "largest second difference of a vertex of the region over three successive frames of equal "
      "steps, in the frame of the joint of largest weight";
  pops.tolerance = {1e-9, 1e-6};
  pops.of_sequence = second_difference;
  table.push_back(std::move(pops));
}

void add_reference_metrics(std::vector<MetricEntry>& table) {
  table.push_back(reference_entry(
      "distance_to_reference_rms", "m",
      "root mean square distance of the region's vertices (all without a region) from those of the "
      "reference variant",
      {1e-9, 1e-6}, [](const Measured& m, const Measured& reference) -> Value {
        return reference_distance(m, reference).rms;
      }));
  table.push_back(reference_entry(
      "distance_to_reference_max", "m",
      "largest distance of a vertex of the region (any without a region) from that of the "
      "reference variant",
      {1e-9, 1e-6}, [](const Measured& m, const Measured& reference) -> Value {
        return reference_distance(m, reference).max;
      }));
}

}  // namespace

std::vector<MetricEntry> metrics() {
  const auto shared = std::make_shared<Shared>();
  std::vector<MetricEntry> table;
  add_volume_metrics(table, shared);
  add_contact_metrics(table, shared);
  add_section_metrics(table, shared);
  add_distortion_metrics(table, shared);
  add_position_metrics(table);
  add_reference_metrics(table);
  return table;
}

}  // namespace geoprior::skinning
