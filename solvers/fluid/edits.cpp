#include "solvers/fluid/edits.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/trajectory.h"

namespace geoprior {
namespace {

/// Times this close to the ends of a feature's life are inside it (s).
constexpr double kTimeTolerance = 1e-9;

/// 6x^5 - 15x^4 + 10x^3: second derivatives vanish at both ends, so nothing is jolted.
double quintic(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (x * (6 * x - 15) + 10);
}

double length_scale(const Edit& edit) {
  return std::cbrt(std::abs(edit.scale[0] * edit.scale[1] * edit.scale[2]));
}

double clock_rate(const Edit& edit) {
  return edit.froude ? edit.speed / std::sqrt(length_scale(edit)) : edit.speed;
}

double source_time_of(const Feature& feature, const Edit& edit, double target_time) {
  if (!edit.retime.empty()) return retimed(edit.retime, target_time);
  const double start = edit.start.value_or(feature.times.front());
  return feature.times.front() + (target_time - start) * clock_rate(edit);
}

/// Earliest (or latest) target time at which the retiming shows a source time.
double target_time_of(const std::vector<TimeKey>& keys, double source, bool earliest) {
  const TimeKey &first = keys.front(), &last = keys.back();
  const auto beyond = [&](const TimeKey& key, double probe) {
    const double slope = (retimed(keys, probe) - key.source) / (probe - key.target);
    return slope > 0 ? key.target + (source - key.source) / slope : key.target;
  };
  if (source < first.source || (source == first.source && earliest)) {
    return beyond(first, first.target - 1);
  }
  if (source > last.source || (source == last.source && !earliest)) {
    return beyond(last, last.target + 1);
  }
  double low = first.target, high = last.target;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high), value = retimed(keys, middle);
    (value < source || (value == source && !earliest) ? low : high) = middle;
  }
  return earliest ? high : low;
}

Eigen::Vector3d velocity_at(const Feature& feature, std::size_t i) {
  const std::size_t a = i == 0 ? 0 : i - 1, b = std::min(i + 1, feature.times.size() - 1);
  return (feature.placement[b].translation() - feature.placement[a].translation()) /
         (feature.times[b] - feature.times[a]);
}

/// Moving frame between the feature's frames: cubic in position, shortest arc in rotation.
Eigen::Isometry3d placement_at(const Feature& feature, double time) {
  const auto& times = feature.times;
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return feature.placement.front();
  const auto i = static_cast<std::size_t>(after - times.begin()) - 1;
  if (i + 1 == times.size() || time == times[i]) return feature.placement[i];
  const double dt = times[i + 1] - times[i], s = (time - times[i]) / dt, s2 = s * s, s3 = s2 * s;
  const Eigen::Isometry3d &p = feature.placement[i], &q = feature.placement[i + 1];
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::Quaterniond(p.linear())
                        .slerp(s, Eigen::Quaterniond(q.linear()))
                        .normalized()
                        .toRotationMatrix();
  result.translation() =
      p.translation() + (3 * s2 - 2 * s3) * (q.translation() - p.translation()) +
      dt * ((s3 - 2 * s2 + s) * velocity_at(feature, i) + (s3 - s2) * velocity_at(feature, i + 1));
  return result;
}

/// What an edit does to the world: scale of the path, mirror and turn about the pivot, move.
Eigen::Affine3d world_edit(const Feature& feature, const Edit& edit, const Eigen::Vector3d& up) {
  const Eigen::Isometry3d& first = feature.placement.front();
  Eigen::Vector3d pivot = first.translation();
  if (edit.pivot_x) pivot.x() = *edit.pivot_x;
  if (edit.pivot_y) pivot.y() = *edit.pivot_y;
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.translate(Eigen::Vector3d(edit.move[0], edit.move[1], edit.move[2]) + pivot);
  result.rotate(Eigen::AngleAxisd(edit.turn_deg * std::numbers::pi / 180, up));
  if (edit.mirror) {
    const Eigen::Vector3d normal = up.cross(first.linear().col(0)).normalized();
    result.linear() =
        (result.linear() * (Eigen::Matrix3d::Identity() - 2 * normal * normal.transpose())).eval();
  }
  result.translate(-pivot);
  return result;
}

/// Centre before trajectory keys, in the target.
Eigen::Vector3d edited_centre(const Feature& feature, const Edit& edit, double source_time,
                              const Eigen::Affine3d& world) {
  Eigen::Vector3d centre = placement_at(feature, source_time).translation();
  if (edit.scale_path || edit.froude) {
    const Eigen::Isometry3d& first = feature.placement.front();
    Eigen::Vector3d pivot = first.translation();
    if (edit.pivot_x) pivot.x() = *edit.pivot_x;
    if (edit.pivot_y) pivot.y() = *edit.pivot_y;
    const Eigen::Vector3d scale(edit.scale[0], edit.scale[1], edit.scale[2]);
    centre = pivot + first.linear() *
                         (scale.asDiagonal() * (first.linear().transpose() * (centre - pivot)));
  }
  return world * centre;
}

Eigen::Vector3d trajectory_offset(const Feature& feature, const Edit& edit, double target_time,
                                  const Eigen::Affine3d& world) {
  Trajectory offsets;
  for (const EditKey& key : edit.trajectory) {
    const double source = std::clamp(source_time_of(feature, edit, key.t), feature.times.front(),
                                     feature.times.back());
    Keyframe offset;
    offset.time = key.t;
    offset.shift = Eigen::Vector3d(key.position[0], key.position[1], key.position[2]) -
                   edited_centre(feature, edit, source, world);
    offsets.keys.push_back(offset);
  }
  return offsets.at(target_time).shift;
}

double fade_at(const Edit& edit, const std::array<double, 2>& interval, double target_time) {
  double fade = 1;
  if (edit.fade_in > 0) fade *= quintic((target_time - interval[0]) / edit.fade_in);
  if (edit.fade_out > 0) fade *= quintic((interval[1] - target_time) / edit.fade_out);
  return fade;
}

}  // namespace

std::array<double, 2> edited_interval(const Feature& feature, const Edit& edit) {
  if (edit.retime.empty()) {
    const double start = edit.start.value_or(feature.times.front());
    return {start, start + (feature.times.back() - feature.times.front()) / clock_rate(edit)};
  }
  return {target_time_of(edit.retime, feature.times.front(), true),
          target_time_of(edit.retime, feature.times.back(), false)};
}

std::optional<EditedFrame> edited_frame(const Feature& feature, const Edit& edit,
                                        double target_time, const Eigen::Vector3d& up) {
  const std::array<double, 2> interval = edited_interval(feature, edit);
  const double tolerance = kTimeTolerance * (1 + std::abs(target_time));
  if (target_time < interval[0] - tolerance || target_time > interval[1] + tolerance) return {};
  EditedFrame result;
  result.source_time = source_time_of(feature, edit, target_time);
  // Rounding of the clock must not turn a frame of the feature into a mixture of two.
  const auto& times = feature.times;
  const auto near = std::lower_bound(times.begin(), times.end(), result.source_time - tolerance);
  if (near == times.end()) {
    result.source_time = times.back();
  } else if (*near <= result.source_time + tolerance) {
    result.source_time = *near;
  }
  result.source_time = std::clamp(result.source_time, times.front(), times.back());
  if (feature.kind == RegionKind::differential) result.fade = fade_at(edit, interval, target_time);
  const Eigen::Affine3d world = world_edit(feature, edit, up);
  const Eigen::Isometry3d own = placement_at(feature, result.source_time);
  const Eigen::Vector3d scale(edit.scale[0], edit.scale[1], edit.scale[2]);
  result.placement.linear() = world.linear() * own.linear() * scale.asDiagonal();
  result.placement.translation() = edited_centre(feature, edit, result.source_time, world);
  if (!edit.trajectory.empty()) {
    result.placement.translation() += trajectory_offset(feature, edit, target_time, world);
  }
  return result;
}

}  // namespace geoprior
