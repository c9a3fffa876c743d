#pragma once

#include <optional>

#include "core/frame.h"
#include "experiments/assembly/scene/scene.h"
#include "testbed/frame_sequence.h"

namespace geoprior::assembly {

/// What the groups of the table of metrics (metrics.cpp) measure, from the parts and tables of a
/// frame and the scene's catalogue alone.
using Value = std::optional<double>;

/// Joints of an assembly, from its poses.
struct JointMeasures {
  Value gap, angle;       ///< largest (m, deg); absent without joints
  double unseen = 0;      ///< joints of ports that no input joins
  double over_input = 0;  ///< joints that are further off than the worst of the inputs
};
JointMeasures joint_measures(const AssemblyScene& scene, const Frame& frame);

/// How an assembly stands, and how a ball rolls through it.
struct StandMeasures {
  Value ground_gap;  ///< m: largest |lowest z| of the parts that are to be on the floor
  Value rise;        ///< m: largest rise of a way; absent where none begins inside a part
  Value lost_ways;   ///< ways that do not end in an exit
  Value entries, exits;
};
StandMeasures stand_measures(const AssemblyScene& scene, const Frame& frame);

/// Pairs of parts that are not joined and whose triangles intersect; absent in a survey, and where
/// the rules do not ask.
Value meeting_parts(const AssemblyScene& scene, const Frame& frame);

/// How unlike the inputs a variation is; absent for the inputs.
struct VarietyMeasures {
  double labels = 0;     ///< histogram distance of labels to the nearest input
  double spectrum = 0;   ///< spectral distance to the nearest input
  double exchanged = 0;  ///< share of the parts that are copied
  double parts = 0;
};
std::optional<VarietyMeasures> variety_measures(const AssemblyScene& scene, const Frame& frame);

/// Distance to the guide's target; absent without one.
struct TargetMeasures {
  Value distance;  ///< m: mean of both directions, of an outline
  Value fill;      ///< share of a region within a spacing of a way
};
TargetMeasures target_measures(const AssemblyScene& scene, const Frame& frame);

/// Over all variations of a run.
struct RunMeasures {
  double variations = 0;
  double distinct = 0;  ///< classes of isomorphic ones, without those of the inputs
  double spread = 0;    ///< mean histogram distance of labels between two of them
};
std::optional<RunMeasures> run_measures(const AssemblyScene& scene, const FrameSequence& frames);

/// The smallest distance to the outline, or the largest fill, of any frame so far.
struct BestMeasures {
  Value distance, fill;
};
BestMeasures best_measures(const AssemblyScene& scene, const FrameSequence& frames);

/// What a survey lists of one model; absent for other frames.
struct SurveyMeasures {
  double boundaries[4] = {0, 0, 0, 0};  ///< distinct boundaries of 1, 2, 3, 4 connections
  double substructures = 0;
  double unions = 0;  ///< of them, those that leave several pieces
  Value pairs;
  double outputs = 0;
  double residuals = 0;
  Value residual_median;  ///< m
  Value closing_share;
};
std::optional<SurveyMeasures> survey_measures(const AssemblyScene& scene, const Frame& frame);

/// A survey against that of the reference variant; absent for other frames.
struct CoverageMeasures {
  Value substructures, pairs, outputs;  ///< shares of the reference's that are there
  double false_substructures = 0, false_pairs = 0, false_outputs = 0;
  double substructure_errors = 0;  ///< what is missing, or listed and not the reference's, or again
};
std::optional<CoverageMeasures> coverage_measures(const AssemblyScene& scene, const Frame& frame,
                                                  const Frame& reference);

}  // namespace geoprior::assembly
