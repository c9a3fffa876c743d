#include "models/assembly/search/rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "models/assembly/graph/labels.h"

namespace geoprior::assembly {

void describe(OptionVisitor& v, PartLimit& options) {
  v.value("label", options.label,
          {.doc = "label of the parts that are counted, or its beginning and a star",
           .required = true});
  v.value("most", options.most,
          {.doc = "most parts of this label that an assembly may have", .min = 0, .max = 100000});
}

void describe(OptionVisitor& v, PartCount& options) {
  v.value("labels", options.labels, {.doc = "labels of the parts that are counted together"});
  v.value("least", options.least, {.doc = "fewest parts of these labels", .min = 0, .max = 100000});
  v.value("most", options.most, {.doc = "most parts of these labels", .min = 0, .max = 100000});
}

void describe(OptionVisitor& v, Bounds& options) {
  v.value("low", options.low, {.doc = "lowest corner of the box", .unit = "m"});
  v.value("high", options.high, {.doc = "highest corner of the box", .unit = "m"});
}

void describe(OptionVisitor& v, Rules& options) {
  describe_group(v, "tolerance", options.tolerance, {.doc = "most that a joint may be off"});
  v.value("relax", options.relax,
          {.doc = "whether misfits are spread over all joints before they are held against the "
                  "tolerance"});
  v.value("grounded", options.grounded,
          {.doc = "labels of parts whose lowest point is on the floor z = 0; here and in all "
                  "lists of labels a star at the end stands for any ending"});
  v.value("ground_tolerance", options.ground_tolerance,
          {.doc = "most that a grounded part's lowest point may be above or below the floor",
           .unit = "m",
           .min = 0});
  describe_group(v, "entries", options.entries,
                 {.doc = "parts where a ball's way begins; absent: any number"});
  describe_group(v, "exits", options.exits,
                 {.doc = "parts where a ball's way ends; absent: any number"});
  v.value("rise", options.rise,
          {.doc = "most that a ball's way from an entry may rise above its lowest point so far; "
                  "each way has to end in an exit then; absent: ways are not followed",
           .unit = "m",
           .min = 0});
  v.value("collisions", options.collisions,
          {.doc = "whether parts that are not joined must not meet"});
  v.value("clearance", options.clearance,
          {.doc = "how much the parts' boxes are shrunk, on each side, before they are tried for "
                  "collisions",
           .unit = "m",
           .min = 0});
  describe_list(v, "bill", options.bill, {.doc = "bill of materials: the parts that one owns"});
  v.value("parts", options.parts, {.doc = "most parts of an assembly", .min = 1, .max = 100000});
  v.value("connected", options.connected, {.doc = "whether all parts must hang together"});
  describe_group(v, "box", options.box,
                 {.doc = "box that all parts stay in; absent: they may be anywhere"});
}

std::string filter_name(Filter filter) {
  constexpr std::array<const char*, 9> kNames = {"bill", "counts", "connected", "closure", "ground",
                                                 "box",  "way",    "collision", "none"};
  return kNames[static_cast<std::size_t>(filter)];
}

namespace {

int count_of(const Assembly& assembly, const std::vector<PartType>& types,
             const std::vector<std::string>& labels) {
  int n = 0;
  for (const PlacedPart& part : assembly.parts)
    if (is_among(labels, types[part.type].label)) ++n;
  return n;
}

bool counts_hold(const Assembly& assembly, const std::vector<PartType>& types,
                 const std::optional<PartCount>& rule) {
  if (!rule) return true;
  const int n = count_of(assembly, types, rule->labels);
  return n >= rule->least && n <= rule->most;
}

void box_corners(const Box& box, const Pose& pose, std::array<Eigen::Vector3d, 8>& out) {
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d x = box.half;
    for (int axis = 0; axis < 3; ++axis)
      if (corner >> axis & 1) x[axis] = -x[axis];
    out[corner] = pose * (box.pose * x);
  }
}

bool is_in_box(const Assembly& assembly, const std::vector<PartType>& types, const Bounds& bounds) {
  constexpr double kRoundOff = 1e-9;
  std::array<Eigen::Vector3d, 8> corners;
  for (const PlacedPart& part : assembly.parts)
    for (const Box& box : types[part.type].boxes) {
      box_corners(box, part.pose, corners);
      for (const Eigen::Vector3d& x : corners)
        for (int axis = 0; axis < 3; ++axis)
          if (x[axis] < bounds.low[axis] - kRoundOff || x[axis] > bounds.high[axis] + kRoundOff)
            return false;
    }
  return true;
}

bool is_on_floor(const Assembly& assembly, const std::vector<PartType>& types, const Rules& rules) {
  for (const PlacedPart& part : assembly.parts)
    if (is_among(rules.grounded, types[part.type].label) &&
        std::abs(lowest_point(types[part.type], part.pose)) > rules.ground_tolerance)
      return false;
  return true;
}

bool ways_hold(const Assembly& assembly, const std::vector<PartType>& types, const Rules& rules) {
  if (!rules.rise || !rules.entries) return true;
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
    if (!is_among(rules.entries->labels, types[assembly.parts[i].type].label)) continue;
    const std::vector<BallWay> ways = ball_ways(assembly, types, static_cast<int>(i));
    if (ways.empty()) return false;
    for (const BallWay& way : ways) {
      const std::string& last = types[assembly.parts[way.last_part].type].label;
      if (!way.ends_inside || (rules.exits && !is_among(rules.exits->labels, last))) return false;
      if (largest_rise(way.points) > *rules.rise) return false;
    }
  }
  return true;
}

struct PlacedBounds {
  int part = 0;
  Eigen::AlignedBox3d bounds;
};

/// Parts with a body, by the lowest x of their boxes.
std::vector<PlacedBounds> placed_bounds(const Assembly& assembly,
                                        const std::vector<PartType>& types, double shrink) {
  std::vector<PlacedBounds> out;
  std::array<Eigen::Vector3d, 8> corners;
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
    PlacedBounds placed{static_cast<int>(i), {}};
    for (const Box& box : types[assembly.parts[i].type].boxes) {
      box_corners(box, assembly.parts[i].pose, corners);
      for (const Eigen::Vector3d& x : corners) placed.bounds.extend(x);
    }
    if (placed.bounds.isEmpty()) continue;
    placed.bounds.min().array() += shrink;
    placed.bounds.max().array() -= shrink;
    out.push_back(placed);
  }
  std::sort(out.begin(), out.end(), [](const PlacedBounds& a, const PlacedBounds& b) {
    return std::pair(a.bounds.min().x(), a.part) < std::pair(b.bounds.min().x(), b.part);
  });
  return out;
}

bool parts_meet(const Assembly& assembly, const std::vector<PartType>& types, int a, int b,
                double shrink) {
  const PlacedPart &p = assembly.parts[a], &q = assembly.parts[b];
  for (const Box& s : types[p.type].boxes)
    for (const Box& t : types[q.type].boxes)
      if (boxes_meet(s, p.pose, t, q.pose, shrink)) return true;
  return false;
}

bool collides(const Assembly& assembly, const std::vector<PartType>& types, double shrink) {
  std::vector<std::pair<int, int>> joined;
  for (const Connection& c : assembly.connections)
    joined.emplace_back(std::minmax(c.a.part, c.b.part));
  std::sort(joined.begin(), joined.end());
  const std::vector<PlacedBounds> order = placed_bounds(assembly, types, shrink);
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1;
         j < order.size() && order[j].bounds.min().x() < order[i].bounds.max().x(); ++j) {
      const Eigen::AlignedBox3d &s = order[i].bounds, &t = order[j].bounds;
      if (s.min().y() >= t.max().y() || t.min().y() >= s.max().y() || s.min().z() >= t.max().z() ||
          t.min().z() >= s.max().z())
        continue;
      const std::pair<int, int> pair = std::minmax(order[i].part, order[j].part);
      if (std::binary_search(joined.begin(), joined.end(), pair)) continue;
      if (parts_meet(assembly, types, pair.first, pair.second, shrink)) return true;
    }
  return false;
}

/// Walks ways through ports, depth first.
class WayWalker {
 public:
  WayWalker(const Assembly& assembly, const std::vector<PartType>& types)
      : assembly_(assembly),
        types_(types),
        links_(assembly, types),
        seen_(assembly.parts.size(), 0) {}

  std::vector<BallWay> from(int part) {
    follow({part, Way::kInside}, {});
    return std::move(out_);
  }

 private:
  void follow(PortRef entered, const std::vector<Eigen::Vector3d>& so_far) {
    // A ball that comes to a part again goes round for ever: its way ends there.
    if (seen_[entered.part]) return finish(so_far, entered.part, false);
    seen_[entered.part] = 1;
    const PlacedPart& part = assembly_.parts[entered.part];
    bool goes_on = false;
    for (const Way& way : types_[part.type].ways) {
      if (way.from != entered.port) continue;
      goes_on = true;
      std::vector<Eigen::Vector3d> points = so_far;
      for (const Eigen::Vector3d& x : way.points) points.push_back(part.pose * x);
      if (way.to == Way::kInside) {
        finish(points, entered.part, true);
        continue;
      }
      const int c = links_.connection({entered.part, way.to});
      if (c < 0)
        finish(points, entered.part, false);
      else
        follow(other_end(assembly_.connections[c], {entered.part, way.to}), points);
    }
    if (!goes_on && entered.port != Way::kInside) finish(so_far, entered.part, false);
    seen_[entered.part] = 0;
  }

  void finish(const std::vector<Eigen::Vector3d>& points, int part, bool inside) {
    out_.push_back({points, part, inside});
  }

  const Assembly& assembly_;
  const std::vector<PartType>& types_;
  Links links_;
  std::vector<char> seen_;
  std::vector<BallWay> out_;
};

}  // namespace

void put_on_floor(Assembly& assembly, const std::vector<PartType>& types, const Rules& rules) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const PlacedPart& part : assembly.parts)
    if (is_among(rules.grounded, types[part.type].label))
      lowest = std::min(lowest, lowest_point(types[part.type], part.pose));
  // Round-off of one replacement would add to that of the next.
  constexpr double kRoundOff = 1e-12;
  if (!std::isfinite(lowest) || std::abs(lowest) < kRoundOff) return;
  for (PlacedPart& part : assembly.parts) part.pose.translation().z() -= lowest;
}

Filter first_broken_by_graph(const Assembly& assembly, const std::vector<PartType>& types,
                             const Rules& rules) {
  if (static_cast<int>(assembly.parts.size()) > rules.parts) return Filter::bill;
  for (const PartLimit& limit : rules.bill)
    if (count_of(assembly, types, {limit.label}) > limit.most) return Filter::bill;
  if (!counts_hold(assembly, types, rules.entries) || !counts_hold(assembly, types, rules.exits))
    return Filter::counts;
  if (rules.connected && components(assembly).count > 1) return Filter::connected;
  return Filter::none;
}

Filter first_broken(Assembly& assembly, const std::vector<PartType>& types, const Rules& rules) {
  if (const Filter filter = first_broken_by_graph(assembly, types, rules); filter != Filter::none)
    return filter;
  const Misfit worst = rules.relax ? relax(assembly, types, rules.tolerance)
                                   : largest(joint_misfits(assembly, types));
  if (!within(worst, rules.tolerance)) return Filter::closure;
  if (!is_on_floor(assembly, types, rules)) return Filter::ground;
  if (rules.box && !is_in_box(assembly, types, *rules.box)) return Filter::box;
  if (!ways_hold(assembly, types, rules)) return Filter::way;
  if (rules.collisions && collides(assembly, types, rules.clearance)) return Filter::collision;
  return Filter::none;
}

std::vector<BallWay> ball_ways(const Assembly& assembly, const std::vector<PartType>& types,
                               int entry_part) {
  return WayWalker(assembly, types).from(entry_part);
}

double largest_rise(const std::vector<Eigen::Vector3d>& points) {
  double lowest = std::numeric_limits<double>::infinity(), rise = 0;
  for (const Eigen::Vector3d& x : points) {
    lowest = std::min(lowest, x.z());
    rise = std::max(rise, x.z() - lowest);
  }
  return rise;
}

double lowest_point(const PartType& type, const Pose& pose) {
  double lowest = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < type.mesh.V.rows(); ++i)
    lowest = std::min(lowest, (pose * type.mesh.V.row(i).transpose().eval()).z());
  if (type.mesh.V.rows() > 0) return lowest;
  std::array<Eigen::Vector3d, 8> corners;
  for (const Box& box : type.boxes) {
    box_corners(box, pose, corners);
    for (const Eigen::Vector3d& x : corners) lowest = std::min(lowest, x.z());
  }
  return lowest;
}

bool boxes_meet(const Box& a, const Pose& a_pose, const Box& b, const Pose& b_pose, double shrink) {
  const Pose A = a_pose * a.pose, B = b_pose * b.pose;
  const Eigen::Vector3d ha = (a.half.array() - shrink).max(0),
                        hb = (b.half.array() - shrink).max(0);
  const Eigen::Matrix3d R = A.linear().transpose() * B.linear();
  const Eigen::Vector3d t = A.linear().transpose() * (B.translation() - A.translation());
  constexpr double kParallel = 1e-12;  // keeps a cross product of parallel edges from separating
  const Eigen::Matrix3d Q = (R.cwiseAbs().array() + kParallel).matrix();
  for (int i = 0; i < 3; ++i)
    if (std::abs(t[i]) >= ha[i] + Q.row(i).dot(hb)) return false;
  for (int j = 0; j < 3; ++j)
    if (std::abs(t.dot(R.col(j))) >= hb[j] + Q.col(j).dot(ha)) return false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double reach =
          ha[i1] * Q(i2, j) + ha[i2] * Q(i1, j) + hb[j1] * Q(i, j2) + hb[j2] * Q(i, j1);
      if (std::abs(t[i2] * R(i1, j) - t[i1] * R(i2, j)) >= reach) return false;
    }
  return true;
}

}  // namespace geoprior::assembly
