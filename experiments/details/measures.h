#pragma once

#include <optional>

#include "core/frame.h"
#include "experiments/details/scene/scene.h"
#include "metrics/spacing/detail_continuity.h"
#include "metrics/spacing/detail_spacing.h"
#include "metrics/spacing/pair_curve.h"
#include "metrics/spacing/radial_spectrum.h"
#include "testbed/frame_sequence.h"
#include "testbed/memo.h"

namespace geoprior::details {

/// What the groups of the table of metrics (metrics.cpp) measure: quantities of one frame or of a
/// motion, absent where they have no meaning.
using Value = std::optional<double>;

/// Lengths of the edges of "detail_mesh" (all details) or "visible_mesh" (those that one sees), in
/// the frame and at rest; `outside` is against the mean at rest. Absent without edges.
struct SpacingPair {
  DetailSpacing rest, now;
  SpacingChange change;
};
std::optional<SpacingPair> spacing_pair(const DetailsScene& scene, const Frame& frame,
                                        const char* mesh);

/// Details over how many the surface asks for, and over those at rest.
struct DensityMeasures {
  double all = 0, visible = 0;  ///< over those wanted
  double count = 0;             ///< over those at rest
};
DensityMeasures density_measures(const DetailsScene& scene, const Frame& frame);

/// Pair correlation of a scene's pattern before anything moves.
struct PairAtRest {
  PairCurve curve;
  double unit = 0;  ///< mean edge (m); 0: without edges
  Value noise;      ///< mean distance between independent patterns of the process
};
/// What frames and variants share: the pattern at rest is that of every frame, and doing nothing is
/// the same for every variant. Each takes longer than a step of the method.
struct PairMemo {
  Memo<PairCurve, 64> curves;
  Memo<PairAtRest, 16> at_rest;
};

/// Pair correlation of the visible details against that of the original, in units of its mean edge.
/// Absent but in the frames that the scene chooses: it costs more than what it judges.
struct PairMeasures {
  double distance = 0;  ///< of the curve to that of the original
  double naive = 0;     ///< of the curve of the original details, carried along
  Value noise;          ///< mean distance between independent patterns of the process, at rest
};
std::optional<PairMeasures> pair_measures(PairMemo& memo, const DetailsScene& scene,
                                          const Frame& frame);

/// The spectrum before anything moves.
struct SpectrumAtRest {
  RadialSpectrum spectrum;
  Value noise;  ///< mean distance of independent patterns of the process
};
/// That of every frame.
using SpectrumMemo = Memo<SpectrumAtRest, 16>;

/// Radial power spectrum of the visible details of a plane, in the frames that the scene chooses
/// for pairs. Absent in others, where the surface is no rectangle, and where the details are more
/// than 5,000: the cost grows with the square of their number.
struct SpectrumMeasures {
  double distance = 0;    ///< to that of the original
  Value noise;            ///< mean distance of independent patterns of the process, at rest
  double elongation = 0;  ///< mean up to the ring of the spacing: how much one axis is preferred
};
std::optional<SpectrumMeasures> spectrum_measures(SpectrumMemo& memo, const DetailsScene& scene,
                                                  const Frame& frame);

/// What happened to the details over a motion.
struct MotionMeasures {
  Value worst_edge_change;     ///< largest magnitude of the change of the mean edge
  Value worst_visible_change;  ///< of that of the visible details
  DetailEvents events;
  int turns = 0;               ///< of the number of details, by 1 % of the first or more
  Value popping;               ///< largest, over the height of a detail
  std::optional<int> at_rest;  ///< insertions and details that begin to fade while nothing moves
};
/// Frames count as at rest once the surface has not moved for ten frames: weights that change by a
/// tenth a frame are then done.
MotionMeasures motion_measures(const DetailsScene& scene, const FrameSequence& frames);

/// Largest displacement of the drawn surface from one frame to the next that the deformation of the
/// bare one does not explain (metrics/contact/drawn_pop.h), over the size of a detail of weight 1,
/// a unit of the parameter, at the frames that the scene chooses. Both frames are drawn from their
/// parts "surface" and "details". Samples of surfaces with holes, whose deepest points are no
/// vertices, are a quarter of a radius apart: a hole is missed by at most a sixth of its radius.
/// Absent without a `drawing`.
Value drawn_popping(const DetailsScene& scene, const FrameSequence& frames);

}  // namespace geoprior::details
