#include "models/paper/tear/tears.h"

#include <algorithm>
#include <utility>

#include "models/paper/contact/segments.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// A point so near to a knot of a tear, over the pattern's width, lies on it.
constexpr double kOnKnot = 1e-9;

}  // namespace

double Tear::length() const {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

Vector2d Tear::heading() const {
  if (knots.size() < 2) return Vector2d::Zero();
  return (path.back() - path[knots[knots.size() - 2]]).normalized();
}

int Tear::torn_from() const {
  int from = 0;
  while (from + 1 < std::ssize(times) && times[from + 1] == 0) ++from;
  return from;
}

Tears::Tears(const Pattern& whole, double tolerance) : whole_(whole), tolerance_(tolerance) {
  whole_.cuts.clear();
  for (const std::vector<Vector2d>& cut : whole.cuts) {
    const int tear = start(cut.front(), 0);
    for (int i = 1; i < std::ssize(cut); ++i) {
      tears_[tear].path.push_back(cut[i]);
      tears_[tear].times.push_back(0);
      tears_[tear].shear.push_back(0);
      tears_[tear].knots.push_back(i);
    }
  }
  for (int t = 0; t < std::ssize(tears_); ++t) {
    for (const Vector2d& end : {tears_[t].path.front(), tears_[t].path.back()}) join(t, end);
  }
  rebuild();
}

double Tears::length() const {
  double sum = 0;
  for (const Tear& tear : tears_) sum += tear.length();
  return sum;
}

int Tears::start(const Vector2d& p, double time) {
  Tear tear;
  tear.path = {p};
  tear.times = {time};
  tear.shear = {0};
  tear.knots = {0};
  tears_.push_back(std::move(tear));
  return static_cast<int>(tears_.size()) - 1;
}

void Tears::advance(int tear, const Vector2d& p, double time) {
  tears_[tear].path.push_back(p);
  tears_[tear].times.push_back(time);
  tears_[tear].shear.push_back(0);
  update(tear);
}

void Tears::note_pull(int tear, const Vector2d& direction, double step, double shear) {
  tears_[tear].last_pull = direction;
  tears_[tear].last_step = step;
  tears_[tear].shear.back() = shear;
}

void Tears::end(int tear) {
  tears_[tear].ended = true;
  join(tear, tears_[tear].tip());
}

/// A knot stays where a tear ends on the last edge of another one, which else would turn away.
void Tears::join(int tear, const Vector2d& end) {
  for (int t = 0; t < std::ssize(tears_); ++t) {
    Tear& other = tears_[t];
    if (t == tear || other.knots.size() < 2) continue;
    const Vector2d& last_knot = other.path[other.knots[other.knots.size() - 2]];
    if (distance_to_segment(end, last_knot, other.tip()) <= kOnKnot * width(whole_))
      other.joined = true;
  }
}

/// Sets knots on the path since the last one wherever it is farther than the tolerance from the
/// chords between them (Ramer 1972; Douglas and Peucker 1973).
void Tears::update(int tear) {
  Tear& t = tears_[tear];
  if (t.knots.size() > 1 && !t.joined) t.knots.pop_back();  // the tip before
  t.joined = false;
  const int last = static_cast<int>(t.path.size()) - 1;
  const int from = t.knots.back();
  set_knots(t, from, last);
  t.knots.push_back(last);
  rebuild();
}

void Tears::set_knots(Tear& tear, int from, int to) const {
  double farthest = tolerance_;
  int knot = -1;
  for (int i = from + 1; i < to; ++i) {
    const double distance = distance_to_segment(tear.path[i], tear.path[from], tear.path[to]);
    if (distance <= farthest) continue;
    farthest = distance;
    knot = i;
  }
  if (knot < 0) return;
  set_knots(tear, from, knot);
  tear.knots.push_back(knot);
  set_knots(tear, knot, to);
}

Pattern Tears::torn_without(int tear) const {
  Pattern torn = whole_;
  for (int t = 0; t < std::ssize(tears_); ++t) {
    if (tears_[t].path.size() < 2 || t == tear) continue;
    std::vector<Vector2d>& cut = torn.cuts.emplace_back();
    for (const int i : tears_[t].knots) cut.push_back(tears_[t].path[i]);
  }
  return torn;
}

void Tears::rebuild() { torn_ = torn_without(-1); }

std::optional<Vector2d> Tears::obstruction(int tear, const Vector2d& to, double margin) const {
  const Vector2d from = tears_[tear].tip();
  const double length = (to - from).norm();
  const Vector2d d = (to - from) / length;
  std::optional<double> nearest;
  each_edge(torn_, [&](const Vector2d& a, const Vector2d& b) {
    if ((a - from).norm() <= 1e-9 * length || (b - from).norm() <= 1e-9 * length) return;
    const auto t = ray_hit(from, d, a, b, 1e-6 * length);
    if (t && *t <= length + margin && (!nearest || *t < *nearest)) nearest = t;
  });
  if (nearest) return from + *nearest * d;
  // Beside its own lips, and away from what it leaves, it may be as near as it is.
  const BorderPoint near = nearest_on_border(torn_without(tear), to);
  if (near.distance < margin && d.dot(near.point - to) > 0 && (near.point - from).norm() > margin)
    return near.point;
  return std::nullopt;
}

void Tears::save(StateWriter& out) const {
  out.number(tears_.size());
  for (const Tear& tear : tears_) {
    out.items(tear.path);
    out.items(tear.times);
    out.items(tear.shear);
    out.items(tear.knots);
    out.number(tear.last_pull.x());
    out.number(tear.last_pull.y());
    out.number(tear.last_step);
    out.number(tear.ended);
    out.number(tear.joined);
  }
}

void Tears::load(StateReader& in) {
  tears_.resize(in.count());
  for (Tear& tear : tears_) {
    in.items(tear.path);
    in.items(tear.times);
    in.items(tear.shear);
    in.items(tear.knots);
    tear.last_pull.x() = in.number<double>();
    tear.last_pull.y() = in.number<double>();
    tear.last_step = in.number<double>();
    tear.ended = in.number<bool>();
    tear.joined = in.number<bool>();
  }
  rebuild();
}

}  // namespace geoprior::paper
