#include "core/error.h"
#include "solvers/fluid/edits.h"

namespace geoprior {
namespace {

constexpr double kFar = 1e6;  // m, s

void describe_selection(OptionVisitor& v, Edit& o) {
  v.value("name", o.name, {.doc = "what messages call the edit"});
  v.value("source", o.source, {.doc = "sequence or library of the scene the features come from"});
  v.value("ids", o.ids, {.doc = "ids of features; none: selected by what follows", .min = 1});
  v.value("box", o.box,
          {.doc = "x0 y0 z0 x1 y1 z1 that holds the feature's centre at some time; none: any",
           .unit = "m"});
  v.value("interval", o.interval,
          {.doc = "t0 t1 in which the feature lives for some time; none: any", .unit = "s"});
  v.value("smallest_area", o.smallest_area,
          {.doc = "largest area in time at least this", .unit = "m^2", .min = 0, .max = 1e12});
  v.value("cut", o.cut,
          {.doc = "the source is the target: its bed is put back under the features, drops are "
                  "removed, before anything is pasted"});
}

void describe_space(OptionVisitor& v, Edit& o) {
  v.value("move", o.move, {.doc = "translation", .unit = "m"});
  v.value("turn_deg", o.turn_deg,
          {.doc = "rotation about the up axis through the pivot",
           .unit = "deg",
           .min = -3600,
           .max = 3600});
  v.value("pivot_x", o.pivot_x, {.doc = "default: the feature's first centre", .unit = "m"});
  v.value("pivot_y", o.pivot_y, {.doc = "default: the feature's first centre", .unit = "m"});
  v.value("scale", o.scale,
          {.doc = "along the feature's own axes: path, across, up", .min = 1e-3, .max = 1e3});
  v.value("scale_path", o.scale_path, {.doc = "the path is scaled too, about the pivot"});
  v.value("mirror", o.mirror, {.doc = "across the upright plane of the feature's first x axis"});
  v.value("froude", o.froude,
          {.doc = "scale the path too and let time run sqrt(scale) slower: omega^2 = g k is kept"});
}

void describe_time(OptionVisitor& v, Edit& o) {
  v.value("start", o.start,
          {.doc = "target time of the feature's first frame; default: its own", .unit = "s"});
  v.value("speed", o.speed, {.doc = "of the feature's clock", .min = 1e-3, .max = 1e3});
  describe_list(v, "retime", o.retime,
                {.doc = "target times and the source times shown then, instead of start and speed "
                        "(monotone cubic)"});
  describe_list(v, "trajectory", o.trajectory,
                {.doc = "positions of the feature's centre at times; the fine motion stays"});
  v.value("fade_in", o.fade_in,
          {.doc = "time over which a map grows (quintic)", .unit = "s", .min = 0, .max = kFar});
  v.value("fade_out", o.fade_out,
          {.doc = "time over which a map vanishes (quintic)", .unit = "s", .min = 0, .max = kFar});
}

}  // namespace

void describe(OptionVisitor& v, EditKey& o) {
  v.value("t", o.t, {.doc = "on the target's clock", .unit = "s", .required = true});
  v.value("position", o.position,
          {.doc = "of the feature's centre", .unit = "m", .required = true});
}

void describe(OptionVisitor& v, TimeKey& o) {
  v.value("target", o.target, {.doc = "target time", .unit = "s", .required = true});
  v.value("source", o.source, {.doc = "source time shown then", .unit = "s", .required = true});
}

void describe(OptionVisitor& v, Edit& o) {
  describe_selection(v, o);
  describe_space(v, o);
  describe_time(v, o);
  v.value("volume_lock", o.volume_lock, {.doc = "the pasted map adds no volume"});
  v.value("unite", o.unite,
          {.doc = "isolated features: exact union with the target instead of overlap"});
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

}  // namespace geoprior
