#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/options.h"
#include "solvers/fluid/feature.h"

namespace geoprior::fluid {

struct EditKey {
  double t = 0;
  std::array<double, 3> position{0, 0, 0};
};
void describe(OptionVisitor& v, EditKey& options);

/// Retiming: source time of a target time, cubic and monotone between the keys.
struct TimeKey {
  double target = 0, source = 0;  ///< s
};
void describe(OptionVisitor& v, TimeKey& options);

/// What happens to selected features on their way into the target. Lists of these, in order, are an
/// edit list.
struct Edit {
  std::string name;
  std::string source;
  std::vector<double> ids;
  std::vector<double>
      box;  ///< x0 y0 z0 x1 y1 z1 that holds the feature's centre at some time; empty: any
  std::vector<double> interval;
  double smallest_area = 0;
  bool cut = false;  ///< the source is the target: the features are taken out of it first
  std::array<double, 3> move{0, 0, 0};  ///< m
  double turn_deg = 0;
  std::optional<double> pivot_x, pivot_y;  ///< default: the feature's first centre
  std::array<double, 3> scale{1, 1, 1};
  bool scale_path = false;
  bool mirror = false;
  bool froude = false;
  std::optional<double> start;
  double speed = 1;
  std::vector<TimeKey> retime;
  std::vector<EditKey> trajectory;
  double fade_in = 0, fade_out = 0;  ///< s, quintic
  bool volume_lock = false;
  bool unite = false;
};
void describe(OptionVisitor& v, Edit& options);

/// A feature and what is done to it.
struct Insertion {
  const Feature* feature = nullptr;
  Edit edit;
};

/// @throws Error  naming the edit: box, interval, keys or scale that have no meaning
void require_valid(const Edit& edit);

/// A feature at a target time under an edit.
struct EditedFrame {
  double source_time = 0;  ///< s
  double fade = 1;         ///< 0 … 1
  Eigen::Affine3d placement =
      Eigen::Affine3d::Identity();  ///< feature frame -> target, scale included
};

/// Where a feature is at a target time: nothing when it is not there then.
///
/// In this order: the feature's own frame at the source time (cubic between its frames), scale
/// along its axes, mirror, scale of the path and turn about the pivot, move, offset of the
/// trajectory keys (cubic, so that the fine motion stays). Isolated features do not fade.
std::optional<EditedFrame> edited_frame(const Feature& feature, const Edit& edit,
                                        double target_time, const Eigen::Vector3d& up);
/// Target times between which the feature is there (s). A retiming that stands still at an end
/// ends at its last key.
std::array<double, 2> edited_interval(const Feature& feature, const Edit& edit);

/// Monotone cubic (Fritsch and Carlson 1980) through keys; linear beyond them with the end slopes.
double retimed(const std::vector<TimeKey>& keys, double target_time);

/// What selection looks at: known of a track before it is lifted, and of a feature.
struct FeatureSummary {
  int id = 0;
  std::vector<double> times;             ///< s
  std::vector<Eigen::Vector3d> centres;  ///< at these times (m)
  double largest_area = 0;               ///< m^2
};
FeatureSummary summary_of(const Feature& feature);

/// Ids that an edit selects, ascending: those it names, or all that meet its box, interval and
/// smallest area.
/// @throws Error  for an id that does not exist (names those that do), or a selection of nothing
std::vector<int> select_features(std::span<const FeatureSummary> features, const Edit& edit);

}  // namespace geoprior::fluid
