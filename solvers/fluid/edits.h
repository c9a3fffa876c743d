#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "solvers/fluid/feature.h"

namespace geoprior {

struct EditKey {
  double t = 0;                             ///< on the target's clock (s)
  std::array<double, 3> position{0, 0, 0};  ///< of the feature's centre (m)
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
  std::string source;       ///< which of the scene's sequences or libraries
  std::vector<double> ids;  ///< of features; empty: by box and size below
  std::vector<double>
      box;  ///< x0 y0 z0 x1 y1 z1 that holds the feature's centre at some time; empty: any
  std::vector<double> interval;            ///< t0 t1 in which it lives; empty: any
  double smallest_area = 0;                ///< largest area in time at least this (m^2)
  std::array<double, 3> move{0, 0, 0};     ///< m
  double turn_deg = 0;                     ///< about the up axis, through the pivot
  std::optional<double> pivot_x, pivot_y;  ///< default: the feature's first centre
  std::array<double, 3> scale{1, 1, 1};    ///< along the feature's own axes
  bool mirror = false;                     ///< across the plane of its path
  bool froude = false;          ///< time runs sqrt(scale) times slower (omega^2 = g k kept)
  std::optional<double> start;  ///< target time of the feature's first frame (s); default: its own
  double speed = 1;             ///< of the clock
  std::vector<TimeKey> retime;  ///< instead of start and speed
  std::vector<EditKey> trajectory;   ///< positions at times; the fine motion stays
  double fade_in = 0, fade_out = 0;  ///< s, quintic
  bool volume_lock = false;          ///< the pasted map adds no volume
  bool unite = false;                ///< isolated: exact union with the target instead of overlap
};
void describe(OptionVisitor& v, Edit& options);

/// A feature at a target time under an edit: nothing when it is not there then.
struct EditedFrame {
  double source_time = 0;  ///< s
  double fade = 1;         ///< 0 … 1
  Eigen::Affine3d placement =
      Eigen::Affine3d::Identity();  ///< feature frame -> target, scale included
};
std::optional<EditedFrame> edited_frame(const Feature& feature, const Edit& edit,
                                        double target_time, const Eigen::Vector3d& up);
/// Target times between which the feature is there (s).
std::array<double, 2> edited_interval(const Feature& feature, const Edit& edit);

/// Monotone cubic (Fritsch and Carlson 1980) through keys; linear beyond them with the end slopes.
double retimed(const std::vector<TimeKey>& keys, double target_time);

}  // namespace geoprior
