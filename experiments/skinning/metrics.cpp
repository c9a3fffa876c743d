#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "experiments/skinning/measures.h"
#include "experiments/skinning/topic.h"
#include "testbed/metric_rows.h"

namespace geoprior::skinning {
namespace {

constexpr Tolerance kRatio{1e-6, 1e-6};
constexpr Tolerance kFineRatio{1e-9, 1e-6};
constexpr Tolerance kVolume{1e-12, 1e-6};
constexpr Tolerance kLength{1e-9, 1e-6};
constexpr Tolerance kAngle{1e-6, 1e-6};
constexpr Tolerance kPairs{2, 0.01};

constexpr Direction kLow = Direction::lower_is_better;
constexpr Direction kTarget = Direction::closer_to_target;

using SharedPtr = std::shared_ptr<Shared>;

/// A group of metrics of a frame.
template <class Measure>
auto of_frame(Measure measure) {
  return frame_metrics<SkinningScene>([measure](const SkinningScene& scene, const Frame& frame) {
    return measure(measured(scene, frame));
  });
}

/// A group of metrics of a frame against the reference variant's.
template <class Measure>
auto against_reference(Measure measure) {
  return reference_metrics<SkinningScene>(
      {"surface"},
      [measure](const SkinningScene& scene, const Frame& frame, const Frame& reference) {
        return measure(measured(scene, frame), measured(scene, reference));
      });
}

MetricGroup region_volume_group(const SharedPtr& shared) {
  return of_frame([shared](const Measured& m) { return volume_change(*shared, m); })
      .row("volume_change", "1",
           "change of the signed volume of the whole closed surface over the rest volume of the "
           "joints' regions",
           kTarget, kFineRatio)
      .row("volume_change_size", "1", "absolute value of volume_change", kLow, kFineRatio,
           [](double change) { return std::abs(change); });
}

MetricGroup global_volume_group(const SharedPtr& shared) {
  return of_frame([shared](const Measured& m) { return volume_change_global(*shared, m); })
      .row("volume_change_global", "1",
           "change of the signed volume of the whole closed surface over its rest volume", kTarget,
           kFineRatio);
}

/// Overlap counted once: a skin that swells into itself keeps its signed volume.
MetricGroup union_volume_group(const SharedPtr& shared) {
  return of_frame([shared](const Measured& m) { return volume_change_union(*shared, m); })
      .row("volume_change_union", "1",
           "change of the volume inside the whole closed surface over the rest volume of the "
           "joints' regions; what is inside twice counts once",
           kTarget, kRatio);
}

MetricGroup body_union_volume_group(const SharedPtr& shared) {
  return of_frame([shared](const Measured& m) { return volume_change_union_body(*shared, m); })
      .row("volume_change_union_body", "1",
           "change of the volume inside the whole closed surface over its rest volume; what is "
           "inside twice counts once",
           kTarget, kRatio);
}

auto above_rest(double OverlapStudy::*quantity) {
  return [quantity](const OverlapPair& pair) { return pair.above.*quantity; };
}

double above_floor(const OverlapPair& pair) { return pair.above.above_floor(); }

MetricGroup overlap_group(const SharedPtr& shared) {
  return of_frame([shared](const Measured& m) { return overlap_excess(*shared, m); })
      .row("overlap_excess", "m^3",
           "integral of max(0, winding number - 1) over the box about the region's "
           "joints (whole body without a region) minus the same at rest; 0 where it "
           "does not exceed overlap_noise_floor",
           kLow, kVolume, above_floor)
      .row("overlap_excess_raw", "m^3",
           "overlap_excess before it is set to 0; below 0 where less overlaps than at rest", kLow,
           kVolume, above_rest(&OverlapStudy::volume))
      .row("overlap_noise_floor", "m^3",
           "largest difference of the overlap between column spacings h and h/2 and "
           "between two column axes, at least the overlap that fits between columns",
           Direction::none, kVolume, above_rest(&OverlapStudy::noise_floor))
      .row("overlap_posed", "m^3", "what overlap_excess takes overlap_at_rest from",
           Direction::none, kVolume, &OverlapPair::posed)
      .row("overlap_at_rest", "m^3",
           "the overlap at rest that overlap_excess is beyond: parts that lie in one another, as "
           "clothes on a body, overlap in every pose",
           Direction::none, kVolume, &OverlapPair::at_rest);
}

MetricGroup body_overlap_group(const SharedPtr& shared) {
  return of_frame([shared](const Measured& m) { return overlap_excess_body(*shared, m); })
      .row("overlap_excess_body", "m^3",
           "integral of max(0, winding number - 1) over the whole body minus the same at rest; 0 "
           "where it does not exceed overlap_noise_floor_body",
           kLow, kVolume, above_floor)
      .row("overlap_excess_raw_body", "m^3", "overlap_excess_body before it is set to 0", kLow,
           kVolume, above_rest(&OverlapStudy::volume))
      .row("overlap_noise_floor_body", "m^3",
           "of overlap_excess_body, as overlap_noise_floor; columns a 768th of the body's diagonal "
           "apart, and half of that",
           Direction::none, kVolume, above_rest(&OverlapStudy::noise_floor))
      .row("overlap_posed_body", "m^3", "what overlap_excess_body takes overlap_at_rest_body from",
           Direction::none, kVolume, &OverlapPair::posed)
      .row("overlap_at_rest_body", "m^3", "overlap_at_rest of the whole body", Direction::none,
           kVolume, &OverlapPair::at_rest);
}

MetricGroup region_overlaps_group(const SharedPtr& shared) {
  return of_frame([shared](const Measured& m) { return overlap_of_regions(*shared, m); })
      .row("overlap_excess_largest", "m^3",
           "overlap_excess of the region of the motion that has most", kLow, kVolume,
           &RegionOverlaps::largest)
      .row("overlap_excess_sum", "m^3",
           "sum of overlap_excess over the regions of the motion; where their boxes overlap it "
           "counts twice",
           kLow, kVolume, &RegionOverlaps::sum)
      .row("overlap_excess_outside", "m^3",
           "overlap_excess_raw_body minus that of all regions of the motion; 0 where it does not "
           "exceed their noise floors; too small where boxes of regions share an overlap",
           kLow, kVolume, &RegionOverlaps::outside)
      .row("overlap_cut_area", "m^2",
           "largest area of the faces of a region's box through which its overlap goes on outside, "
           "minus the same at rest: above 0, overlap_excess misses a part that "
           "overlap_excess_body has",
           Direction::none, {1e-7, 1e-3}, &RegionOverlaps::cut_area);
}

MetricGroup overlap_ratio_group(const SharedPtr& shared) {
  return against_reference([shared](const Measured& m, const Measured& reference) {
           return overlap_excess_ratios(*shared, m, reference);
         })
      .row("overlap_excess_ratio", "1",
           "0 where overlap_excess_raw does not exceed the noise floor, else over that of the "
           "reference variant or the floor, whichever is larger",
           kLow, kRatio, &OverlapRatios::box)
      .row(
          "overlap_excess_ratio_body", "1",
          "of overlap_excess_body, as overlap_excess_ratio: overlaps that the region's box cuts or "
          "misses count too",
          kLow, kRatio, &OverlapRatios::body);
}

/// Both numbers, no difference: pairs that go away in a pose would hide as many that come.
MetricGroup pairs_group(const SharedPtr& shared) {
  return of_frame([shared](const Measured& m) { return pairs(*shared, m); })
      .row(
          "intersecting_pairs", "1",
          "pairs of triangles that intersect, at least one of them in the region (anywhere without "
          "a region)",
          kLow, kPairs, &Pairs::region)
      .row("intersecting_pairs_at_rest", "1",
           "intersecting_pairs of the rest pose: the same in every frame", Direction::none, kPairs,
           &Pairs::region_at_rest)
      .row("intersecting_pairs_body", "1", "pairs of triangles of the whole body that intersect",
           kLow, kPairs, &Pairs::body)
      .row("intersecting_pairs_body_at_rest", "1",
           "intersecting_pairs_body of the rest pose: the same in every frame", Direction::none,
           kPairs, &Pairs::body_at_rest);
}

/// Rows of one part of the skin.
template <class Rows, class Part>
void add_roughness_rows(Rows& rows, const std::string& suffix, const std::string& where,
                        const Part& part) {
  const auto read = [part](double RoughnessSummary::*quantity, double scale) {
    return [part, quantity, scale](const RoughnessMeasures& m) -> Value {
      const std::optional<RoughnessSummary> summary = part(m);
      if (!summary) return std::nullopt;
      return (*summary).*quantity * scale;
    };
  };
  const auto degrees = [&](double RoughnessSummary::*quantity) {
    return read(quantity, 180 / std::numbers::pi);
  };
  const auto metres = [&](double RoughnessSummary::*quantity) { return read(quantity, 1); };
  const std::string change = " of the change of an edge's dihedral angle against rest, " + where;
  const std::string lump =
      " difference of a vertex from the mean of its neighbours in the change against rest of the "
      "normal component of the umbrella vector, " +
      where;
  using S = RoughnessSummary;
  rows.row("roughness_p50" + suffix, "deg", "median, by rest area," + change, kLow, kAngle,
           degrees(&S::fold_p50))
      .row("roughness_p95" + suffix, "deg", "95th percentile, by rest area," + change, kLow, kAngle,
           degrees(&S::fold_p95))
      .row("roughness_p99" + suffix, "deg", "99th percentile, by rest area," + change, kLow, kAngle,
           degrees(&S::fold_p99))
      .row("roughness_max" + suffix, "deg", "largest size" + change, kLow, kAngle,
           degrees(&S::fold_max))
      .row("lumps_rms" + suffix, "m", "root mean square, by rest area, of the" + lump, kLow,
           kLength, metres(&S::lump_rms))
      .row("lumps_p95" + suffix, "m", "95th percentile, by rest area, of the" + lump, kLow, kLength,
           metres(&S::lump_p95))
      .row("lumps_max" + suffix, "m", "largest" + lump, kLow, kLength, metres(&S::lump_max));
}

MetricGroup roughness_group(const SharedPtr& shared) {
  auto rows = of_frame([shared](const Measured& m) { return roughness(*shared, m); });
  add_roughness_rows(rows, "", "over the regions of the motion (all of the body without one)",
                     [](const RoughnessMeasures& m) { return std::optional(m.all); });
  add_roughness_rows(rows, "_outer", "over the halves of the regions on the outer side of the bend",
                     [](const RoughnessMeasures& m) { return m.outer; });
  return rows;
}

MetricGroup harm_group(const SharedPtr& shared) {
  return of_frame([shared](const Measured& m) { return harm_of(*shared, m); })
      .row("harm", "1",
           "largest distance of a vertex from where dual quaternions have it, over the local "
           "radius, where they ask for no correction: farther than a local radius from any of "
           "their overlaps, section within 2 % of rest",
           kLow, kRatio, &Harm::max)
      .row("harm_area", "1", "share of the skin, by rest area, on which harm is measured",
           Direction::none, {1e-3, 0}, &Harm::unasked_share);
}

MetricGroup section_group() {
  return of_frame(section_summary)
      .row("section_shrink", "1",
           "smallest area ratio, against rest, of a half cross-section orthogonal to the bones "
           "within the region (whole sections when there is no bend axis)",
           Direction::higher_is_better, kRatio, &SectionSummary::shrink)
      .row("section_bulge", "1", "largest such area ratio", kTarget, kRatio, &SectionSummary::bulge)
      .target(1)
      .row("outer_bulge", "1",
           "largest relative growth of the half cross-sections on the outer side of the bend", kLow,
           kRatio, &SectionSummary::outer_bulge)
      .row("elbow_collapse", "1",
           "smallest ratio, against rest, of the distance of the outermost point of a "
           "cross-section from its centre",
           kTarget, kRatio, &SectionSummary::elbow_collapse)
      .target(1);
}

MetricGroup distortion_group() {
  return of_frame(region_distortion)
      .row("area_ratio_p05", "1",
           "5th percentile, by rest area, of the triangles' area ratio against rest in the region",
           kTarget, kRatio, &DistortionSummary::area_ratio_p05)
      .target(1)
      .row("area_ratio_p95", "1",
           "95th percentile, by rest area, of the triangles' area ratio against rest in the region",
           kTarget, kRatio, &DistortionSummary::area_ratio_p95)
      .target(1)
      .row("singular_value_max", "1",
           "largest singular value of a triangle's deformation gradient against rest in the region",
           kLow, kRatio, &DistortionSummary::singular_value_max)
      .row("symmetric_dirichlet", "1",
           "mean by rest area of |J|^2 + |J^-1|^2 over the region's triangles; 4 for an isometry",
           kLow, kRatio, &DistortionSummary::symmetric_dirichlet);
}

MetricGroup rest_group() {
  return of_frame(rest_identity)
      .row("rest_identity", "1",
           "largest distance of a vertex from the input in the rest pose, over the "
           "diagonal of the bounding box",
           kLow, {1e-9, 0})
      .oracle();
}

/// Oracles: linear blending and dual quaternions have closed forms of both on a bent and on a
/// twisted tube.
MetricGroup mid_ring_group() {
  return of_frame(mid_ring)
      .row("mid_ring_min", "1",
           "smaller half axis of the tube's mid-ring (from its second moments about the joint), "
           "over the rest radius",
           kTarget, kFineRatio, &RingRatio::min)
      .target(1)
      .oracle()
      .row("mid_ring_max", "1",
           "larger half axis of the tube's mid-ring (from its second moments about the joint), "
           "over the rest radius",
           kTarget, kFineRatio, &RingRatio::max)
      .target(1)
      .oracle();
}

auto of_motion(double MotionSmoothness::*quantity) {
  return [quantity](const Pops& pops) -> Value {
    if (!pops.motion) return std::nullopt;
    return (*pops.motion).*quantity;
  };
}

MetricGroup pops_group(const SharedPtr& shared) {
  return sequence_metrics<SkinningScene>(
             [shared](const SkinningScene& scene, const FrameSequence& frames) {
               return pops(*shared, scene, frames);
             })
      .row("second_difference_max", "m",
           "largest second difference of a vertex of the region over three successive frames of "
           "equal steps, in the frame of the joint of largest weight; falls with the step",
           kLow, kLength, &Pops::second_difference)
      .row("velocity_change_max", "m/deg^2",
           "largest change of a vertex' velocity (m per degree) per degree over three successive "
           "frames, in the frame of the joint of largest weight, over the whole body",
           kLow, {1e-9, 1e-6}, of_motion(&MotionSmoothness::velocity_change))
      .row("pop_max", "m",
           "largest distance, in the middle of a step, of where the two frames before and the two "
           "after it lead a vertex, in the frame of the joint of largest weight, over the whole "
           "body",
           kLow, kLength, of_motion(&MotionSmoothness::jump))
      .row("pose_return", "1",
           "largest distance of a vertex from where it was when the skeleton was in the same pose "
           "before, over the local radius",
           kLow, kRatio, &Pops::pose_return);
}

MetricGroup distance_group() {
  return against_reference(reference_distance)
      .row("distance_to_reference_rms", "m",
           "root mean square distance of the region's vertices (all without a region) from those "
           "of the reference variant",
           kLow, kLength, &VertexDistance::rms)
      .row("distance_to_reference_max", "m",
           "largest distance of a vertex of the region (any without a region) from that of the "
           "reference variant",
           kLow, kLength, &VertexDistance::max);
}

}  // namespace

std::vector<MetricGroup> metrics() {
  const auto shared = std::make_shared<Shared>();
  return {region_volume_group(shared),
          global_volume_group(shared),
          union_volume_group(shared),
          body_union_volume_group(shared),
          overlap_group(shared),
          body_overlap_group(shared),
          region_overlaps_group(shared),
          overlap_ratio_group(shared),
          pairs_group(shared),
          roughness_group(shared),
          harm_group(shared),
          section_group(),
          distortion_group(),
          rest_group(),
          mid_ring_group(),
          pops_group(shared),
          distance_group()};
}

}  // namespace geoprior::skinning
