#include "models/embryo/body/body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/disjoint_sets.h"
#include "core/error.h"
#include "models/embryo/body/convex_pieces.h"
#include "models/embryo/shape/smooth_minimum.h"

namespace geoprior::embryo {
namespace {

std::string number_text(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

MonotoneCurve length_curve(const BodyPlan& plan) {
  const Eigen::Index n = std::ssize(plan.crown_rump_length);
  std::vector<double> days;
  Eigen::MatrixXd values(n, 1);
  for (const auto& [day, length] : plan.crown_rump_length) {
    if (!(length > 0)) throw Error("length is not positive", "crown-rump length");
    values(std::ssize(days), 0) =
        plan.interpolation == Interpolation::linear ? length : std::log(length);
    days.push_back(day);
  }
  return {std::move(days), std::move(values), plan.interpolation, Ends::fading};
}

}  // namespace

/// The shapes of one day, each found when it is first asked for.
class Body::DayShapes {
 public:
  DayShapes(const Body& body, double day)
      : body_(body),
        day_(day),
        length_(body.crown_rump_length(day)),
        shapes_(body.motions_.size()),
        done_(body.motions_.size(), false) {}

  const Shape& of(int structure) {
    if (!done_[structure]) {
      shapes_[structure] = found(structure);
      done_[structure] = true;
    }
    return shapes_[structure];
  }

 private:
  Shape found(int structure) {
    const Motion& motion = body_.motions_[structure];
    if (motion.whole) return of(*motion.whole);
    const PlannedStructure& plan = body_.plan_.structures[structure];
    Shape shape = motion.keys->sizes(body_.held(day_, plan.sizes_held));
    if (motion.duct) {
      shape.points = control_points(structure);
      for (const Eigen::Vector3d& p : shape.points) shape.center += p;
      shape.center /= static_cast<double>(shape.points.size());
      return shape;
    }
    const double day = body_.held(day_, plan.place_held);
    shape.center = frame(motion) + length_ * motion.keys->place(day);
    for (const int stop : plan.stops) {
      const double k = linear() ? 0 : kStopEase * length_;
      shape.center.z() = smooth_minimum(shape.center.z(), of(stop).center.z(), k);
    }
    shape.axes = motion.keys->axes(day);
    for (const Turn& turn : plan.turns) {
      const double u = eased(day_, turn.from, turn.to, body_.plan_.interpolation);
      shape.axes = Eigen::AngleAxisd(u * turn.angle, turn.about).toRotationMatrix() * shape.axes;
    }
    return shape;
  }

  std::vector<Eigen::Vector3d> control_points(int structure) {
    const Motion& motion = body_.motions_[structure];
    const PlannedStructure& plan = body_.plan_.structures[structure];
    const double day = body_.held(day_, plan.place_held);
    std::vector<Eigen::Vector3d> points = motion.duct->between(day, surroundings(motion));
    const auto ends = this->ends(structure);
    points.insert(points.begin(), ends.first);
    points.push_back(ends.second);
    return points;
  }

  std::pair<Eigen::Vector3d, Eigen::Vector3d> ends(int structure) {
    const Motion& motion = body_.motions_[structure];
    const PlannedStructure& plan = body_.plan_.structures[structure];
    const double then = body_.held(day_, plan.ends_held);
    if (then != day_) {
      DayShapes held(body_, then);
      const auto [start, end] = held.ends_of(motion, body_.held(then, plan.place_held));
      const double growth = length_ / held.length_;
      return {growth * start, growth * end};
    }
    return ends_of(motion, body_.held(day_, plan.place_held));
  }

  std::pair<Eigen::Vector3d, Eigen::Vector3d> ends_of(const Motion& motion, double day) {
    const DuctSurroundings here = surroundings(motion);
    return {motion.duct->start().at(day, here), motion.duct->end().at(day, here)};
  }

  DuctSurroundings surroundings(const Motion& motion) {
    return {
        [this](int anchor, const Eigen::Vector3d& uvw) { return anchor_point(of(anchor), uvw); },
        frame(motion), length_};
  }

  Eigen::Vector3d frame(const Motion& motion) {
    return motion.keys->frame() ? of(*motion.keys->frame()).center : Eigen::Vector3d::Zero();
  }
  [[nodiscard]] bool linear() const { return body_.plan_.interpolation == Interpolation::linear; }

  const Body& body_;
  double day_, length_;
  std::vector<Shape> shapes_;
  std::vector<bool> done_;
};

Body::Body(BodyPlan plan) : plan_(std::move(plan)) {
  if (plan_.stages.empty()) throw Error("there is no stage", "plan of a body", "one or more");
  length_ = length_curve(plan_);
  motions_.resize(plan_.structures.size());
  for (std::size_t s = 0; s < motions_.size(); ++s) {
    const PlannedStructure& one = plan_.structures[s];
    if (one.exists.size() != plan_.stages.size())
      throw Error("existence is not given stage by stage", one.name);
    if (one.keys.empty()) continue;
    motions_[s].keys.emplace(one.keys, one.name, plan_.interpolation);
    if (motions_[s].keys->primitive() == Primitive::duct)
      motions_[s].duct.emplace(one.keys, one.name, plan_.interpolation);
  }
  for (const PlannedDivision& division : plan_.divisions)
    for (const auto& [product, sign] : division.products)
      if (!motions_[product].keys) motions_[product].whole = division.whole;
  require_order();
}

std::vector<int> Body::needs(int structure) const {
  const Motion& motion = motions_[structure];
  std::vector<int> out = plan_.structures[structure].stops;
  if (motion.whole) out.push_back(*motion.whole);
  if (motion.keys && motion.keys->frame()) out.push_back(*motion.keys->frame());
  if (motion.duct)
    for (const int anchor : motion.duct->anchors()) out.push_back(anchor);
  return out;
}

/// Walks all that every structure is placed by, in depth; what is met again on its own way is a
/// circle.
void Body::require_order() const {
  enum class Mark { fresh, on_the_way, done };
  std::vector<Mark> marks(motions_.size(), Mark::fresh);
  std::vector<std::pair<int, std::size_t>> way;
  for (std::size_t s = 0; s < motions_.size(); ++s) {
    if (marks[s] == Mark::fresh) way.push_back({static_cast<int>(s), 0});
    while (!way.empty()) {
      auto& [structure, next] = way.back();
      const std::string& name = plan_.structures[structure].name;
      marks[structure] = Mark::on_the_way;
      const std::vector<int> all = needs(structure);
      if (next == all.size()) {
        marks[structure] = Mark::done;
        way.pop_back();
        continue;
      }
      const int other = all[next++];
      if (!has_shape(other))
        throw Error("it is placed by " + plan_.structures[other].name + ", which has no geometry",
                    name);
      if (marks[other] == Mark::on_the_way)
        throw Error(
            "it is placed by " + plan_.structures[other].name + ", which is placed by it in turn",
            name, "frames, anchors and stops without a circle");
      if (marks[other] == Mark::fresh) way.push_back({other, 0});
    }
  }
}

int Body::stage_of(double day) const {
  if (!(day >= first_day() && day <= last_day()))
    throw Error("there are no data of day " + number_text(day), "day",
                number_text(first_day()) + " to " + number_text(last_day()));
  int stage = 0;
  while (stage + 1 < std::ssize(plan_.stages) && day >= plan_.stages[stage + 1].start_day) ++stage;
  return stage;
}

double Body::held(double day, const std::optional<double>& from) const {
  if (!from) return day;
  return smooth_minimum(day, *from, plan_.interpolation == Interpolation::linear ? 0 : kHoldEase);
}

bool Body::has_shape(int structure) const {
  return motions_[structure].keys.has_value() || motions_[structure].whole.has_value();
}

double Body::crown_rump_length(double day) const {
  const double value = length_.at(day)[0];
  return plan_.interpolation == Interpolation::linear ? value : std::exp(value);
}

DayState Body::at(double day) const {
  const int stage = stage_of(day);
  DayShapes shapes(*this, day);
  DayState state;
  state.day = day;
  state.crown_rump_length = crown_rump_length(day);
  std::vector<bool> divided(motions_.size(), false);
  for (const PlannedDivision& division : plan_.divisions)
    if (division.active && day >= division.to) divided[division.whole] = true;
  for (int s = 0; s < std::ssize(motions_); ++s)
    if (has_shape(s) && plan_.structures[s].exists[stage] && !divided[s])
      state.structures.push_back({s, shapes.of(s)});
  add_divisions(state, shapes);
  add_processes(state, shapes);
  add_fused(state);
  return state;
}

void Body::add_divisions(DayState& state, DayShapes& shapes) const {
  for (const PlannedDivision& division : plan_.divisions) {
    if (!division.active || state.day < division.from) continue;
    const Shape& whole = shapes.of(division.whole);
    Cut cut{
        division.whole, division.normal, whole.center, division.descent, 0, division.thickness, 0};
    cut.progress = eased(state.day, division.from, division.to, plan_.interpolation);
    const double offset = division.descent.dot(whole.center);
    const double above = -extent_along(whole, -division.descent) - offset - division.thickness;
    const double below = extent_along(whole, division.descent) - offset + division.thickness;
    cut.tip = above + cut.progress * (below - above);
    if (find_state(state, division.whole) != nullptr) state.cuts.push_back(cut);
    if (state.day < division.to) continue;
    for (const auto& [product, sign] : division.products)
      if (motions_[product].whole == division.whole && find_state(state, product) != nullptr)
        state.halves.push_back({product, division.whole, whole, cut, sign});
  }
  const auto by_product = [](const Half& a, const Half& b) { return a.product < b.product; };
  std::sort(state.halves.begin(), state.halves.end(), by_product);
  const auto by_whole = [](const Cut& a, const Cut& b) { return a.whole < b.whole; };
  std::sort(state.cuts.begin(), state.cuts.end(), by_whole);
}

void Body::add_processes(DayState& state, DayShapes& shapes) const {
  for (int p = 0; p < std::ssize(plan_.processes); ++p) {
    const PlannedProcess& process = plan_.processes[p];
    ProcessState out{p, process.active, 0, false};
    if (process.active)
      out.progress = eased(state.day, process.from, process.to, plan_.interpolation);
    const bool both = process.active && process.interacts && process.inducer && process.target &&
                      find_state(state, *process.inducer) != nullptr &&
                      find_state(state, *process.target) != nullptr;
    if (both)
      out.met = gap(shapes.of(*process.inducer), shapes.of(*process.target)) < process.within;
    state.processes.push_back(out);
  }
}

void Body::add_fused(DayState& state) const {
  std::vector<FusedGroup> groups = plan_.fused;
  for (const PlannedProcess& process : plan_.processes)
    if (process.active && state.day >= process.from && !process.fuses.empty())
      groups.push_back({process.fuses, process.blend});
  DisjointSets sets(static_cast<int>(motions_.size()));
  for (FusedGroup& group : groups) {
    std::erase_if(group.members, [&](int s) { return find_state(state, s) == nullptr; });
    for (const int member : group.members) sets.join(group.members[0], member);
  }
  std::erase_if(groups, [](const FusedGroup& group) { return group.members.size() < 2; });
  std::map<int, FusedGroup> joined;  // by the least member
  for (const FusedGroup& group : groups) {
    FusedGroup& whole = joined[sets.find(group.members[0])];
    whole.members.insert(whole.members.end(), group.members.begin(), group.members.end());
    whole.blend = std::max(whole.blend, group.blend);
  }
  for (auto& [least, group] : joined) {
    std::sort(group.members.begin(), group.members.end());
    group.members.erase(std::unique(group.members.begin(), group.members.end()),
                        group.members.end());
    state.fused.push_back(std::move(group));
  }
}

}  // namespace geoprior::embryo
