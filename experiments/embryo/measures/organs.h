#pragma once

#include <optional>
#include <string>

#include "experiments/embryo/frames/recorded.h"
#include "experiments/embryo/scene/scene.h"
#include "testbed/frame_sequence.h"

namespace geoprior::embryo {

/// A quantity of the literature as a frame has it (SI, rad); absent where there is nothing that has
/// it. Lengths, poles and gaps are read off the surface, along the recorded axis or the body's.
///
/// - crown_rump_length (m)
/// - kidney_length: extent of the surface along the shape's long axis (m)
/// - hilum_angle: of the shape's local x from ventral, about the body's long axis towards the
/// median
///   plane (rad)
/// - branchings: as recorded (1)
/// - upper_pole_height, lower_pole_height: largest and least z of the surface over the origin (m)
/// - interpole_upper, interpole_lower: distance across (x) of the upper, lower poles of both sides
/// - vertebral_level: of the centre, a number that grows caudally: T12 is 12, L1 is 13, … S1 is 18
std::optional<double> reading(const EmbryoScene& scene, const RecordedDay& day,
                              const std::string& quantity, std::optional<int> structure);

/// The left kidney of the healthy system: the first structure of kind "kidney" and side "left" that
/// is not absent without a disease.
std::optional<int> left_kidney(const EmbryoScene& scene);

/// Measurements of the literature against the frames at the middles of their stages.
struct ScoreMeasures {
  double scored = 0;          ///< that the parameter set was not authored from, with a frame
  double inside = 0;          ///< of these, within their range
  double inputs = 0;          ///< that the set was authored from
  std::optional<double> rms;  ///< of (value - mean) over the deviation, of the scored
  std::optional<double> worst;
};
std::optional<ScoreMeasures> score_measures(const EmbryoScene& scene, const FrameSequence& frames);

/// A left structure mirrored in the median plane against its right partner: largest distance of a
/// vertex from the other surface, over the body's length. Absent under a disease or without pairs.
std::optional<double> mirror_error(const EmbryoScene& scene, const RecordedDay& day);

/// Distance of a duct's recorded end from where its anchor is by the recorded shapes, over the
/// body's length; the largest of those with one anchor at the key frames before and after.
std::optional<double> duct_end_gap(const EmbryoScene& scene, const Frame& frame);

}  // namespace geoprior::embryo
