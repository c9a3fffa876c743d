#include "solvers/fluid/edits.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/inputs/trajectory.h"

namespace geoprior::fluid {
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

namespace {

constexpr double kFarAway = 1e6;  // m, s

void describe_selection(OptionVisitor& v, Edit& o) {
  v.value("name", o.name, {.doc = "name of the edit in messages"});
  v.value("source", o.source,
          {.doc = "sequence or library of the scene that the features come from"});
  v.value("ids", o.ids,
          {.doc = "ids of the features; none: all that meet box, interval and smallest_area",
           .min = 1});
  v.value("box", o.box,
          {.doc = "box x0 y0 z0 x1 y1 z1 that holds the feature's centre at some time; none: any",
           .unit = "m"});
  v.value(
      "interval", o.interval,
      {.doc = "times t0 t1 between which the feature lives for a while; none: any", .unit = "s"});
  v.value("smallest_area", o.smallest_area,
          {.doc = "least size that the feature has when it is largest",
           .unit = "m^2",
           .min = 0,
           .max = 1e12});
  v.value("cut", o.cut,
          {.doc = "takes the features out of the target, which is their source, before anything is "
                  "pasted"});
}

void describe_space(OptionVisitor& v, Edit& o) {
  v.value("move", o.move, {.doc = "translation of the feature", .unit = "m"});
  v.value("turn_deg", o.turn_deg,
          {.doc = "rotation about the up axis through the pivot",
           .unit = "deg",
           .min = -3600,
           .max = 3600});
  v.value("pivot_x", o.pivot_x,
          {.doc = "x of the pivot; absent: of the feature's first centre", .unit = "m"});
  v.value("pivot_y", o.pivot_y,
          {.doc = "y of the pivot; absent: of the feature's first centre", .unit = "m"});
  v.value("scale", o.scale,
          {.doc = "scale along the feature's own axes: path, across, up", .min = 1e-3, .max = 1e3});
  v.value("scale_path", o.scale_path, {.doc = "scales the feature's path too, about the pivot"});
  v.value("mirror", o.mirror,
          {.doc = "mirrors the feature across the upright plane of its first x axis"});
  v.value(
      "froude", o.froude,
      {.doc =
           "scales the path too and lets time run sqrt(scale) slower, which keeps omega^2 = g k"});
}

void describe_time(OptionVisitor& v, Edit& o) {
  v.value("start", o.start,
          {.doc = "target time of the feature's first frame; absent: its own", .unit = "s"});
  v.value("speed", o.speed, {.doc = "speed of the feature's clock", .min = 1e-3, .max = 1e3});
  describe_list(
      v, "retime", o.retime,
      {.doc =
           "keys of a monotone cubic from target time to source time, instead of start and speed"});
  describe_list(v, "trajectory", o.trajectory,
                {.doc = "positions of the feature's centre at times; its fine motion stays"});
  v.value("fade_in", o.fade_in,
          {.doc = "time over which a map grows (quintic)", .unit = "s", .min = 0, .max = kFarAway});
  v.value(
      "fade_out", o.fade_out,
      {.doc = "time over which a map vanishes (quintic)", .unit = "s", .min = 0, .max = kFarAway});
}

}  // namespace

void describe(OptionVisitor& v, EditKey& o) {
  v.value("t", o.t,
          {.doc = "time of the key on the target's clock", .unit = "s", .required = true});
  v.value("position", o.position,
          {.doc = "position of the feature's centre", .unit = "m", .required = true});
}

void describe(OptionVisitor& v, TimeKey& o) {
  v.value("target", o.target,
          {.doc = "time of the key on the target's clock", .unit = "s", .required = true});
  v.value("source", o.source,
          {.doc = "source time that is shown at the key", .unit = "s", .required = true});
}

void describe(OptionVisitor& v, Edit& o) {
  describe_selection(v, o);
  describe_space(v, o);
  describe_time(v, o);
  v.value("volume_lock", o.volume_lock, {.doc = "shifts the pasted map so that it adds no volume"});
  v.value(
      "unite", o.unite,
      {.doc = "unites isolated features with the target exactly, instead of letting them overlap"});
}

void require_valid(const Edit& edit) {
  const std::string where = "edit '" + edit.name + "'";
  const auto require = [&](bool holds, const char* problem, const char* allowed) {
    if (!holds) throw Error(problem, where, allowed);
  };
  require(edit.box.empty() || edit.box.size() == 6, "the box is not six numbers",
          "x0 y0 z0 x1 y1 z1");
  if (edit.box.size() == 6) {
    require(edit.box[0] <= edit.box[3] && edit.box[1] <= edit.box[4] && edit.box[2] <= edit.box[5],
            "the box is inside out", "x0 <= x1, y0 <= y1, z0 <= z1");
  }
  require(
      edit.interval.empty() || (edit.interval.size() == 2 && edit.interval[0] <= edit.interval[1]),
      "the interval is not two increasing numbers", "t0 <= t1");
  require(edit.speed > 0, "the speed is not positive", "> 0; to hold a frame use retime");
  for (const double s : edit.scale) require(s > 0, "a scale is not positive", "> 0; see mirror");
  for (std::size_t i = 1; i < edit.trajectory.size(); ++i) {
    require(edit.trajectory[i - 1].t < edit.trajectory[i].t,
            "times of the trajectory do not increase", "strictly increasing t");
  }
  for (std::size_t i = 1; i < edit.retime.size(); ++i) {
    const TimeKey &a = edit.retime[i - 1], &b = edit.retime[i];
    require(a.target < b.target, "target times of the retiming do not increase",
            "strictly increasing target");
    require(a.source <= b.source, "source times of the retiming decrease",
            "source times that never decrease");
  }
}

namespace {

std::string where_of(const Edit& edit) { return "edit '" + edit.name + "'"; }

bool meets(const FeatureSummary& feature, const Edit& edit) {
  if (feature.times.empty() || feature.largest_area < edit.smallest_area) return false;
  if (edit.interval.size() == 2 &&
      (feature.times.front() > edit.interval[1] || feature.times.back() < edit.interval[0])) {
    return false;
  }
  if (edit.box.size() != 6) return true;
  return std::any_of(feature.centres.begin(), feature.centres.end(), [&](const Eigen::Vector3d& c) {
    for (int k = 0; k < 3; ++k) {
      if (c[k] < edit.box[k] || c[k] > edit.box[k + 3]) return false;
    }
    return true;
  });
}

std::string known_ids(std::span<const FeatureSummary> features) {
  if (features.empty()) return "none: the source has no features";
  std::string text;
  constexpr std::size_t kShown = 40;
  for (std::size_t i = 0; i < std::min(features.size(), kShown); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(features[i].id);
  }
  if (features.size() > kShown) {
    text += ", and " + std::to_string(features.size() - kShown) + " more";
  }
  return text;
}

}  // namespace

FeatureSummary summary_of(const Feature& feature) {
  FeatureSummary result{feature.id, feature.times, {}, 0};
  for (const Eigen::Isometry3d& p : feature.placement) result.centres.push_back(p.translation());
  for (const double area : feature.area) result.largest_area = std::max(result.largest_area, area);
  return result;
}

std::vector<int> select_features(std::span<const FeatureSummary> features, const Edit& edit) {
  require_valid(edit);
  std::vector<int> result;
  for (const double id : edit.ids) {
    const auto found = std::find_if(features.begin(), features.end(), [&](const FeatureSummary& f) {
      return static_cast<double>(f.id) == id;
    });
    if (found == features.end()) {
      const bool whole = id == std::floor(id) && std::abs(id) < 1e9;
      throw Error("there is no feature " +
                      (whole ? std::to_string(static_cast<long>(id)) : std::to_string(id)),
                  where_of(edit), known_ids(features));
    }
    result.push_back(found->id);
  }
  if (edit.ids.empty()) {
    for (const FeatureSummary& f : features) {
      if (meets(f, edit)) result.push_back(f.id);
    }
    if (result.empty()) {
      throw Error("no feature meets its box, interval and smallest area", where_of(edit),
                  features.empty() ? "a source with features of at least shortest_track frames"
                                   : "ids of the source: " + known_ids(features));
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

namespace {

double slope_after(const std::vector<TimeKey>& keys, std::size_t i) {
  return (keys[i + 1].source - keys[i].source) / (keys[i + 1].target - keys[i].target);
}

/// Slope of the cubic at a key: the mean of the slopes beside it weighted by time, limited to three
/// times the smaller one, which keeps a cubic monotone (Fritsch and Carlson 1980).
double slope_at(const std::vector<TimeKey>& keys, std::size_t i) {
  if (keys.size() < 2) return 1;
  if (i == 0) return slope_after(keys, 0);
  if (i + 1 == keys.size()) return slope_after(keys, i - 1);
  const double before = slope_after(keys, i - 1), after = slope_after(keys, i);
  if (before * after <= 0) return 0;
  const double dt_before = keys[i].target - keys[i - 1].target;
  const double dt_after = keys[i + 1].target - keys[i].target;
  const double mean = (before * dt_before + after * dt_after) / (dt_before + dt_after);
  const double limit = 3 * std::min(std::abs(before), std::abs(after));
  return std::clamp(mean, -limit, limit);
}

}  // namespace

double retimed(const std::vector<TimeKey>& keys, double target_time) {
  if (keys.empty()) return target_time;
  const std::size_t last = keys.size() - 1;
  if (target_time <= keys[0].target) {
    return keys[0].source + slope_at(keys, 0) * (target_time - keys[0].target);
  }
  if (target_time >= keys[last].target) {
    return keys[last].source + slope_at(keys, last) * (target_time - keys[last].target);
  }
  std::size_t i = 0;
  while (keys[i + 1].target <= target_time) ++i;
  const double dt = keys[i + 1].target - keys[i].target;
  const double s = (target_time - keys[i].target) / dt, s2 = s * s, s3 = s2 * s;
  return keys[i].source + (3 * s2 - 2 * s3) * (keys[i + 1].source - keys[i].source) +
         dt * ((s3 - 2 * s2 + s) * slope_at(keys, i) + (s3 - s2) * slope_at(keys, i + 1));
}

}  // namespace geoprior::fluid
