#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior {

/// A feature seen in a frame, of a track named by its id (any number).
struct TrackedObject {
  int id = 0;
  int kind = 0;                                      ///< objects of different kinds never match
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero(), box_max = Eigen::Vector3d::Zero();  ///< m
};
using TrackedFrames = std::vector<std::vector<TrackedObject>>;  ///< of every frame; no id twice

enum class TrackSimilarity {
  box_overlap,  ///< intersection over union of the boxes
  distance,     ///< 1 - distance of centres / `reach`, at least 0
};

struct TrackingScoreOptions {
  TrackSimilarity similarity = TrackSimilarity::box_overlap;
  double reach = 1;        ///< distance at which the similarity of centres is 0 (m)
  double threshold = 0.5;  ///< least similarity of a match (HOTA takes 0.05, 0.10, … 0.95)
};

/// How well found tracks are the true ones.
///
/// CLEAR (Bernardin and Stiefelhagen 2008): frame after frame, pairs matched before stay matched
/// while they are similar enough, the rest is matched for the largest number, then similarity.
///   MOTA = 1 - (misses + false alarms + switches) / true objects;
///   MOTP = mean similarity of the matches.
/// Identity (Ristani et al. 2016): whole tracks are matched one to one for the most frames in
/// common, IDF1 = 2 IDTP / (2 IDTP + IDFP + IDFN).
/// HOTA (Luiten et al. 2021): sqrt(DetA AssA), averaged over the thresholds.
struct TrackingScores {
  int true_objects = 0, found_objects = 0;  ///< summed over frames
  int matches = 0, misses = 0, false_alarms = 0;
  int switches = 0;   ///< a true track's match changes from one id to another
  int fragments = 0;  ///< a true track's matches stop and begin again while it is there
  double precision = 0, recall = 0;
  double mota = 0, motp = 0;
  double idf1 = 0, id_precision = 0, id_recall = 0;
  double hota = 0, detection = 0, association = 0;  ///< HOTA, DetA, AssA
  double distance_rms = 0;                          ///< of matched centres (m)
  /// Mean over true tracks with a partner of identity: |first frames' difference| + |last frames'
  /// difference| (frames).
  double lifetime_error = 0;
};

/// Scores of a tracking. Without any true object rates are 0, but 1 when nothing was found either.
/// @throws Error  when the frame counts differ or a frame holds an id twice (named)
TrackingScores tracking_scores(const TrackedFrames& truth, const TrackedFrames& found,
                               const TrackingScoreOptions& options);

}  // namespace geoprior
