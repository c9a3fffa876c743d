#include "metrics/tracks/scores.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "core/error.h"
#include "metrics/tracks/optimal_assignment.h"

namespace geoprior {
namespace {

double box_overlap(const TrackedObject& a, const TrackedObject& b) {
  const Eigen::Array3d common =
      (a.box_max.cwiseMin(b.box_max) - a.box_min.cwiseMax(b.box_min)).array().max(0);
  const double both = common.prod();
  const double all = (a.box_max - a.box_min).array().max(0).prod() +
                     (b.box_max - b.box_min).array().max(0).prod() - both;
  return all > 0 ? both / all : 0;
}

/// Truth and found numbered from 0, and the similarity of all pairs, frame by frame.
struct Comparison {
  std::vector<int> true_ids, found_ids;
  struct Frame {
    std::vector<int> truth, found;  ///< numbers
    Eigen::MatrixXd similarity;
  };
  std::vector<Frame> frames;
  std::vector<int> true_length, found_length;  ///< frames of the tracks
};

std::vector<int> ids_of(const TrackedFrames& frames) {
  std::set<int> ids;
  for (const auto& frame : frames) {
    for (const TrackedObject& o : frame) ids.insert(o.id);
  }
  return {ids.begin(), ids.end()};
}

std::vector<int> numbers_of(const std::vector<TrackedObject>& frame, const std::vector<int>& ids,
                            std::size_t f, std::vector<int>& length) {
  std::vector<int> numbers;
  for (const TrackedObject& o : frame) {
    const int n = static_cast<int>(std::lower_bound(ids.begin(), ids.end(), o.id) - ids.begin());
    if (std::find(numbers.begin(), numbers.end(), n) != numbers.end()) {
      throw Error("id " + std::to_string(o.id) + " twice", "frame " + std::to_string(f),
                  "every id once a frame");
    }
    numbers.push_back(n);
    ++length[n];
  }
  return numbers;
}

double similarity_of(const TrackedObject& a, const TrackedObject& b,
                     const TrackingScoreOptions& options) {
  if (a.kind != b.kind) return -1;
  if (options.similarity == TrackSimilarity::box_overlap) return box_overlap(a, b);
  return std::max(0.0, 1 - (a.centre - b.centre).norm() / options.reach);
}

Comparison compare(const TrackedFrames& truth, const TrackedFrames& found,
                   const TrackingScoreOptions& options) {
  if (truth.size() != found.size()) {
    throw Error(
        std::to_string(found.size()) + " frames found, " + std::to_string(truth.size()) + " true",
        "tracking scores", "equal numbers");
  }
  Comparison c;
  c.true_ids = ids_of(truth);
  c.found_ids = ids_of(found);
  c.true_length.assign(c.true_ids.size(), 0);
  c.found_length.assign(c.found_ids.size(), 0);
  for (std::size_t f = 0; f < truth.size(); ++f) {
    Comparison::Frame& frame = c.frames.emplace_back();
    frame.truth = numbers_of(truth[f], c.true_ids, f, c.true_length);
    frame.found = numbers_of(found[f], c.found_ids, f, c.found_length);
    frame.similarity.resize(truth[f].size(), found[f].size());
    for (std::size_t i = 0; i < truth[f].size(); ++i) {
      for (std::size_t j = 0; j < found[f].size(); ++j)
        frame.similarity(i, j) = similarity_of(truth[f][i], found[f][j], options);
    }
  }
  return c;
}

/// Matches of largest total `value` among pairs that are similar enough; -1: none.
std::vector<int> matched(const Comparison::Frame& frame, const Eigen::MatrixXd& value,
                         double threshold) {
  const auto enough = frame.similarity.array() >= threshold;
  std::vector<int> column = optimal_assignment(enough.select(value.array(), 0.0).matrix());
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (column[i] >= 0 && !enough(i, column[i])) column[i] = -1;
  }
  return column;
}

double ratio(double part, double whole, double when_empty) {
  return whole > 0 ? part / whole : when_empty;
}

/// What a true track was matched with.
struct Following {
  int last = -1;    ///< found number, ever
  int before = -1;  ///< … in the frame before
  bool interrupted = false;
};

void clear_scores(const Comparison& c, const TrackedFrames& truth, const TrackedFrames& found,
                  double threshold, TrackingScores& s) {
  std::vector<Following> following(c.true_ids.size());
  double similarity = 0, square = 0;
  for (std::size_t f = 0; f < c.frames.size(); ++f) {
    const Comparison::Frame& frame = c.frames[f];
    Eigen::MatrixXd value = frame.similarity.array() + 10;  // the most matches before the best
    for (std::size_t i = 0; i < frame.truth.size(); ++i) {
      for (std::size_t j = 0; j < frame.found.size(); ++j) {
        if (following[frame.truth[i]].before == frame.found[j]) value(i, j) += 1e4;
      }
    }
    const std::vector<int> column = matched(frame, value, threshold);
    for (Following& track : following) track.before = -1;
    for (std::size_t i = 0; i < column.size(); ++i) {
      Following& track = following[frame.truth[i]];
      if (column[i] < 0) {
        track.interrupted = track.last >= 0;
        continue;
      }
      const int j = column[i];
      ++s.matches;
      similarity += frame.similarity(i, column[i]);
      square += (truth[f][i].centre - found[f][j].centre).squaredNorm();
      if (track.last >= 0 && track.last != frame.found[j]) ++s.switches;
      if (track.interrupted) ++s.fragments;
      track = {frame.found[j], frame.found[j], false};
    }
  }
  s.misses = s.true_objects - s.matches;
  s.false_alarms = s.found_objects - s.matches;
  const double nothing = s.true_objects + s.found_objects == 0 ? 1 : 0;
  s.precision = ratio(s.matches, s.found_objects, nothing);
  s.recall = ratio(s.matches, s.true_objects, nothing);
  s.mota = s.true_objects > 0
               ? 1 - static_cast<double>(s.misses + s.false_alarms + s.switches) / s.true_objects
               : nothing;
  s.motp = ratio(similarity, s.matches, nothing);
  s.distance_rms = std::sqrt(ratio(square, s.matches, 0));
}

/// First and last frames of the tracks.
std::vector<std::pair<int, int>> lifetimes(const Comparison& c, bool of_truth) {
  std::vector<std::pair<int, int>> result(of_truth ? c.true_ids.size() : c.found_ids.size(),
                                          {-1, -1});
  for (int f = 0; f < std::ssize(c.frames); ++f) {
    for (const int n : of_truth ? c.frames[f].truth : c.frames[f].found) {
      auto& [first, last] = result[n];
      if (first < 0) first = f;
      last = f;
    }
  }
  return result;
}

void identity_scores(const Comparison& c, double threshold, TrackingScores& s) {
  Eigen::MatrixXd common = Eigen::MatrixXd::Zero(c.true_ids.size(), c.found_ids.size());
  for (const Comparison::Frame& frame : c.frames) {
    for (std::size_t i = 0; i < frame.truth.size(); ++i) {
      for (std::size_t j = 0; j < frame.found.size(); ++j) {
        if (frame.similarity(i, j) >= threshold) common(frame.truth[i], frame.found[j]) += 1;
      }
    }
  }
  const std::vector<int> partner = optimal_assignment(common);
  const auto true_life = lifetimes(c, true), found_life = lifetimes(c, false);
  double both = 0, error = 0, pairs = 0;
  for (std::size_t t = 0; t < partner.size(); ++t) {
    if (partner[t] < 0 || common(t, partner[t]) <= 0) continue;
    const auto& found = found_life[partner[t]];
    both += common(t, partner[t]);
    error +=
        std::abs(true_life[t].first - found.first) + std::abs(true_life[t].second - found.second);
    ++pairs;
  }
  const double nothing = s.true_objects + s.found_objects == 0 ? 1 : 0;
  s.idf1 = ratio(2 * both, s.true_objects + s.found_objects, nothing);
  s.id_precision = ratio(both, s.found_objects, nothing);
  s.id_recall = ratio(both, s.true_objects, nothing);
  s.lifetime_error = ratio(error, pairs, 0);
}

/// A_max: how well two tracks go together over all frames, whatever the threshold: it decides
/// between matches of one frame (Luiten et al., section 4.1.2).
Eigen::MatrixXd track_alignment(const Comparison& c) {
  Eigen::MatrixXd common = Eigen::MatrixXd::Zero(c.true_ids.size(), c.found_ids.size());
  for (const Comparison::Frame& frame : c.frames) {
    const Eigen::ArrayXXd S = frame.similarity.array().max(0);
    const Eigen::ArrayXd row = S.rowwise().sum(), column = S.colwise().sum().transpose();
    for (Eigen::Index i = 0; i < S.rows(); ++i) {
      for (Eigen::Index j = 0; j < S.cols(); ++j) {
        const double all = row(i) + column(j) - S(i, j);
        if (all > 0) common(frame.truth[i], frame.found[j]) += S(i, j) / all;
      }
    }
  }
  for (Eigen::Index t = 0; t < common.rows(); ++t) {
    for (Eigen::Index k = 0; k < common.cols(); ++k)
      common(t, k) /= c.true_length[t] + c.found_length[k] - common(t, k);
  }
  return common;
}

void higher_order_scores(const Comparison& c, TrackingScores& s) {
  constexpr int kThresholds = 19;
  const Eigen::MatrixXd alignment = track_alignment(c);
  for (int a = 1; a <= kThresholds; ++a) {
    const double threshold = 0.05 * a - 1e-12;
    std::map<std::pair<int, int>, int> together;  // frames in which two tracks match
    int matches = 0;
    for (const Comparison::Frame& frame : c.frames) {
      Eigen::MatrixXd value(frame.similarity.rows(), frame.similarity.cols());
      for (Eigen::Index i = 0; i < value.rows(); ++i) {
        for (Eigen::Index j = 0; j < value.cols(); ++j)
          value(i, j) = 1e3 + alignment(frame.truth[i], frame.found[j]) +
                        1e-3 * frame.similarity(i, j);  // the most matches before the best
      }
      const std::vector<int> column = matched(frame, value, threshold);
      for (std::size_t i = 0; i < column.size(); ++i) {
        if (column[i] < 0) continue;
        ++matches;
        ++together[{frame.truth[i], frame.found[column[i]]}];
      }
    }
    double association = 0;
    for (const auto& [pair, count] : together) {
      const int all = c.true_length[pair.first] + c.found_length[pair.second] - count;
      association += static_cast<double>(count) * count / all;
    }
    const double nothing = s.true_objects + s.found_objects == 0 ? 1 : 0;
    const double detection = ratio(matches, s.true_objects + s.found_objects - matches, nothing);
    association = ratio(association, matches, nothing);
    s.detection += detection / kThresholds;
    s.association += association / kThresholds;
    s.hota += std::sqrt(detection * association) / kThresholds;
  }
}

}  // namespace

TrackingScores tracking_scores(const TrackedFrames& truth, const TrackedFrames& found,
                               const TrackingScoreOptions& options) {
  const Comparison c = compare(truth, found, options);
  TrackingScores s;
  for (const auto& frame : truth) s.true_objects += static_cast<int>(frame.size());
  for (const auto& frame : found) s.found_objects += static_cast<int>(frame.size());
  clear_scores(c, truth, found, options.threshold, s);
  identity_scores(c, options.threshold, s);
  higher_order_scores(c, s);
  return s;
}

}  // namespace geoprior
