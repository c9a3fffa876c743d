#include "models/sketch/sections/tube_sections.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>

namespace geoprior::sketch {
namespace {

constexpr int kSectionSamples = 400;
/// Sections are larger than the widths by this share, and cut by the views: these keep a strip of
/// their own along their silhouettes, which lies on them exactly.
constexpr double kSectionSlack = 0.005;
constexpr double kVisibleShare = 0.6;  ///< of the widest part, from which a part is seen beside it

double half_width(const Slice& s) { return std::max(0.5 * s.width(), 1e-12); }

int quadrant(double u, double v) { return (u > 0 ? 1 : 0) + (v > 0 ? 2 : 0); }

/// (|u|^n + |v|^n)^(1/n) without overflow.
double superellipse_norm(double u, double v, double n) {
  const double large = std::max(std::abs(u), std::abs(v));
  const double small = std::min(std::abs(u), std::abs(v));
  if (large == 0) return 0;
  return large * std::pow(1 + std::pow(small / large, n), 1 / n);
}

/// The exponent whose superellipse, nearly as large as the slack allows, passes through a point of
/// the box, by bisection.
double exponent_through(double u, double v) {
  constexpr double kNorm = 1 + 0.8 * kSectionSlack;
  double low = 1, high = 4 * kBoxExponent;
  if (superellipse_norm(u, v, high) > kNorm) return std::numeric_limits<double>::infinity();
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (superellipse_norm(u, v, middle) > kNorm ? low : high) = middle;
  }
  return high;
}

/// How far a place is outside of a slice; negative inside.
double outside(const Slice& s, double x) { return std::max(s.low - x, x - s.high); }

/// The other width of a part that is hidden: of a circular tube that is tilted as its middle runs.
Slice circular(const Slice& own, const Slice& seen) {
  const double tilt = 0.5 * (own.low_slope + own.high_slope);
  const double half = 0.5 * std::min(own.width() / std::sqrt(1 + tilt * tilt), seen.width());
  return {seen.middle() - half, seen.middle() + half, seen.low_slope, seen.high_slope};
}

Slice between(const Slice& a, const Slice& b, double share) {
  return {a.low + share * (b.low - a.low), a.high + share * (b.high - a.high), a.low_slope,
          a.high_slope};
}

/// Extent of a rim along an axis of space.
Slice rim_extent(const Rim& rim, const OutlinedView& view, int axis) {
  const int c = view_axis(view.frame, 0).axis == axis ? 0 : 1;
  const double sign = view_axis(view.frame, c).sign;
  Slice extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Eigen::Vector2d& q : rim.points) {
    extent.low = std::min(extent.low, sign * q[c]);
    extent.high = std::max(extent.high, sign * q[c]);
  }
  return extent;
}

double widest_of(const std::vector<Slice>& slices) {
  double most = 0;
  for (const Slice& s : slices) most = std::max(most, s.width());
  return most;
}

}  // namespace

const SectionPart* TubeSection::nearest(double p, double q) const {
  const SectionPart* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const SectionPart& part : parts) {
    const double away = std::max(0.0, outside(part.p, p)) + std::max(0.0, outside(part.q, q));
    if (away >= least) continue;
    least = away;
    nearest = &part;
  }
  return nearest;
}

bool TubeSection::is_guessed(double p, double q) const {
  const SectionPart* part = nearest(p, q);
  return part != nullptr && part->hidden;
}

double TubeSection::value(double p, double q) const {
  const SectionPart* part = nearest(p, q);
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  if (part == nullptr || part->round <= 0 || part->tube < 0) return kNone;
  const double a = half_width(part->p), b = half_width(part->q);
  const double u = (p - part->p.middle()) / a, v = (q - part->q.middle()) / b;
  const double n = exponents[part->tube][quadrant(u, v)] / part->round;
  if (n > kBoxExponent && !part->hidden) return kNone;
  const double norm = superellipse_norm(u, v, std::min(n, 4 * kBoxExponent));
  return (norm / (1 + kSectionSlack) - 1) * std::min(a, b);
}

const OutlinedView& TubeSections::showing(const std::vector<OutlinedView>& views, int axis,
                                          int nth) {
  for (const OutlinedView& view : views) {
    const bool shows =
        view_axis(view.frame, 0).axis == axis || view_axis(view.frame, 1).axis == axis;
    if (shows && nth-- == 0) return view;
  }
  return views.front();
}

namespace {

/// Numbers of the views that show an axis, in their order; then of those that look along it.
std::pair<std::vector<int>, std::vector<int>> views_by_axis(const std::vector<OutlinedView>& views,
                                                            int axis) {
  std::pair<std::vector<int>, std::vector<int>> by;
  for (int v = 0; v < std::ssize(views); ++v) {
    const bool shows =
        view_axis(views[v].frame, 0).axis == axis || view_axis(views[v].frame, 1).axis == axis;
    (shows ? by.first : by.second).push_back(v);
  }
  return by;
}

}  // namespace

TubeSections::TubeSections(const std::vector<OutlinedView>& views, const std::vector<Rim>& rims,
                           int axis)
    : axis_(axis),
      first_(showing(views, axis, 0), axis, rims, views_by_axis(views, axis).first.front()) {
  const auto [showing_it, along_it] = views_by_axis(views, axis);
  if (showing_it.size() > 1) second_.emplace(views[showing_it[1]], axis, rims, showing_it[1]);
  if (!along_it.empty()) {
    end_view_ = &views[along_it.front()];
    end_.emplace(*end_view_, first_.across());
  }
  second_axis_ = 3 - axis - first_.across();
  first_cuts_ = cuts_of_others(views, rims, showing_it[0]);
  if (second_) second_cuts_ = cuts_of_others(views, rims, showing_it[1]);
  start_ = first_.first();
  double end = first_.last();
  if (second_) {
    start_ = std::max(start_, second_->first());
    end = std::min(end, second_->last());
  }
  step_ = (end - start_) / kSectionSamples;
  for (int i = 0; i < kSectionSamples; ++i)
    samples_.push_back(parts_at(start_ + (i + 0.5) * step_));
  for (const Rim& rim : rims) {
    if (rim.axis != axis) continue;
    exponents_.push_back({2, 2, 2, 2});
    // In the view that the rim was drawn in, its part is the one that it spans.
    Rim spanning = rim;
    const OutlinedView& view = views[rim.view];
    const int c = view_axis(view.frame, 0).axis == axis ? 0 : 1;
    for (Eigen::Vector2d& x : spanning.points)
      x = {view_axis(view.frame, c).sign * x[c], view_axis(view.frame, 1 - c).sign * x[1 - c]};
    spanning.outward = {view_axis(view.frame, c).sign * rim.outward[c], 0};
    spanning.axis = view_axis(view.frame, 1 - c).axis;
    track(spanning, static_cast<int>(exponents_.size()) - 1);
  }
  if (end_) fill_end_view();
  end_view_ = nullptr;
}

std::vector<TubeSections::CutEnd> TubeSections::cuts_of_others(
    const std::vector<OutlinedView>& views, const std::vector<Rim>& rims, int view) const {
  std::vector<CutEnd> cuts;
  for (const Rim& rim : rims) {
    if (rim.axis != axis_ || rim.view == view) continue;
    const Slice extent = rim_extent(rim, views[rim.view], axis_);
    const bool is_drawn_here = std::any_of(rims.begin(), rims.end(), [&](const Rim& other) {
      return other.axis == axis_ && other.view == view &&
             rim_extent(other, views[view], axis_).overlap(extent) >= 0;
    });
    if (is_drawn_here) continue;
    const int c = view_axis(views[rim.view].frame, 0).axis == axis_ ? 0 : 1;
    const bool is_up = view_axis(views[rim.view].frame, c).sign * rim.outward[c] > 0;
    cuts.push_back(is_up ? CutEnd{extent.low, extent.high} : CutEnd{extent.high, extent.low});
  }
  return cuts;
}

int TubeSections::tubes() const {
  std::set<int> used;
  for (const std::vector<SectionPart>& parts : samples_) {
    for (const SectionPart& part : parts) {
      if (part.tube >= 0) used.insert(part.tube);
    }
  }
  return static_cast<int>(used.size());
}

Slice TubeSections::widest_from_end(double p) const {
  Slice widest;
  for (const Slice& s : end_->at(p)) {
    if (s.width() > widest.width()) widest = s;
  }
  return widest;
}

std::vector<SectionPart> TubeSections::parts_at(double along) const {
  const auto uncut = [along](const std::vector<CutEnd>& cuts) {
    for (const CutEnd& cut : cuts) {
      const auto [low, high] = std::minmax(cut.inner, cut.outer);
      if (along > low && along < high) return cut.inner;
    }
    return along;
  };
  std::vector<SectionPart> parts;
  const std::vector<Slice> p = first_.at(uncut(first_cuts_));
  if (!second_) {
    for (const Slice& s : p) {
      const Slice seen = widest_from_end(s.middle());
      parts.push_back({s, circular(s, seen), s, seen, true});
    }
    return parts;
  }
  const std::vector<Slice> q = second_->at(uncut(second_cuts_));
  const double widest_p = kVisibleShare * widest_of(p), widest_q = kVisibleShare * widest_of(q);
  if (p.size() > 1 && q.size() > 1) return parts;
  for (const Slice& a : p) {
    for (const Slice& b : q) {
      SectionPart part{a, b, a, b};
      part.hidden = a.width() < widest_p || b.width() < widest_q;
      if (a.width() < widest_p) part.q = circular(a, b);
      if (b.width() < widest_q) part.p = circular(b, a);
      parts.push_back(part);
    }
  }
  return parts;
}

const SectionPart* TubeSections::part_like(const SectionPart& part, int sample) const {
  const SectionPart* like = nullptr;
  double most = 0;
  for (const SectionPart& other : samples_[std::clamp(sample, 0, kSectionSamples - 1)]) {
    const double shared = std::min(other.p.overlap(part.p) / half_width(part.p),
                                   other.q.overlap(part.q) / half_width(part.q));
    if (shared <= most) continue;
    most = shared;
    like = &other;
  }
  return like;
}

TubeSection TubeSections::at(double along) const {
  TubeSection section{parts_at(along), exponents_};
  const double place = (along - start_) / step_ - 0.5;
  const int below = static_cast<int>(std::floor(std::clamp(place, -1.0, 1.0 * kSectionSamples)));
  const double share = std::clamp(place - below, 0.0, 1.0);
  for (SectionPart& part : section.parts) {
    const SectionPart* before = part_like(part, below);
    const SectionPart* after = part_like(part, below + 1);
    if (before != nullptr) part.round += (1 - share) * before->round;
    if (after != nullptr) part.round += share * after->round;
    if (after != nullptr && after->tube >= 0) part.tube = after->tube;
    if (before != nullptr && before->tube >= 0) part.tube = before->tube;
    part.p = between(part.p_seen, part.p, part.round);
    part.q = between(part.q_seen, part.q, part.round);
  }
  return section;
}

double TubeSections::value(const Eigen::Vector3d& x) const {
  return at(x[axis_]).value(x[first_across()], x[second_across()]);
}

bool TubeSections::is_guessed(const Eigen::Vector3d& x) const {
  return at(x[axis_]).is_guessed(x[first_across()], x[second_across()]);
}

Eigen::Vector3d TubeSections::gradient(const Eigen::Vector3d& x, double step) const {
  const int p = first_across(), q = second_across();
  const TubeSection here = at(x[axis_]), beyond = at(x[axis_] + step);
  const double value = here.value(x[p], x[q]);
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  gradient[axis_] = (beyond.value(x[p], x[q]) - value) / step;
  gradient[p] = (here.value(x[p] + step, x[q]) - value) / step;
  gradient[q] = (here.value(x[p], x[q] + step) - value) / step;
  for (double& g : gradient) g = std::isfinite(g) ? g : 0;
  return gradient;
}

bool TubeSections::widens(const std::vector<Node>& path, const SectionPart& next) const {
  constexpr double kSteepest = 2.25, kWindow = 0.12, kAllowed = 0.03;
  const auto grows = [&](const Slice& from, const Slice& to, double way, double width) {
    const double allowed = kSteepest * way + kAllowed * width;
    return from.low - to.low > allowed || to.high - from.high > allowed;
  };
  for (int back = 1; back <= std::ssize(path); ++back) {
    const Node& node = path[path.size() - back];
    const SectionPart& from = samples_[node.at][node.part];
    const double way = back * step_, width = std::max(from.p.width(), from.q.width());
    if (back > 1 && way > kWindow * width) break;
    if (grows(from.p, next.p, way, width)) return true;
    if (!from.hidden && !next.hidden && grows(from.q, next.q, way, width)) return true;
  }
  return false;
}

std::optional<TubeSections::Node> TubeSections::start_of(const Rim& rim) const {
  const double out = rim.outward.x() < 0 ? -1 : 1;
  double most = -std::numeric_limits<double>::infinity();
  Slice span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Eigen::Vector2d& x : rim.points) {
    most = std::max(most, out * x.x());
    span.low = std::min(span.low, x.y());
    span.high = std::max(span.high, x.y());
  }
  const double place = (out * most - start_) / step_ - 0.5 * out;
  Node node{std::clamp(static_cast<int>(std::floor(place)), 0, kSectionSamples - 1), -1};
  double shared = 0;
  for (std::size_t i = 0; i < samples_[node.at].size(); ++i) {
    const SectionPart& part = samples_[node.at][i];
    const double overlap = (rim.axis == first_.across() ? part.p : part.q).overlap(span);
    if (overlap <= shared) continue;
    shared = overlap;
    node.part = static_cast<int>(i);
  }
  if (node.part < 0) return {};
  return node;
}

void TubeSections::track(const Rim& rim, int tube) {
  const std::optional<Node> start = start_of(rim);
  if (!start) return;
  const int step = rim.outward.x() < 0 ? 1 : -1;
  std::vector<std::vector<Node>> paths{{*start}};
  while (!paths.empty()) {
    std::vector<Node> path = std::move(paths.back());
    paths.pop_back();
    bool is_stopped = false;
    while (true) {
      const Node& last = path.back();
      const int next = last.at + step;
      if (next < 0 || next >= kSectionSamples) break;
      const SectionPart& part = samples_[last.at][last.part];
      std::vector<Node> onward;
      for (int i = 0; i < std::ssize(samples_[next]); ++i) {
        const SectionPart& other = samples_[next][i];
        if (other.p.overlap(part.p) > 0 && other.q.overlap(part.q) > 0) {
          onward.push_back({next, i});
          if (widens(path, other)) is_stopped = true;
        }
      }
      if (onward.empty() || is_stopped) {
        is_stopped = is_stopped || samples_[next].empty();
        break;
      }
      for (std::size_t i = 1; i < onward.size(); ++i) {
        paths.push_back(path);
        paths.back().push_back(onward[i]);
      }
      path.push_back(onward[0]);
    }
    mark(path, is_stopped, tube);
  }
}

void TubeSections::mark(const std::vector<Node>& path, bool is_stopped, int tube) {
  const SectionPart& last = samples_[path.back().at][path.back().part];
  const double blend = std::min(0.25 * std::max(last.p.width(), last.q.width()),
                                0.5 * step_ * static_cast<double>(path.size()));
  for (std::size_t i = 0; i < path.size(); ++i) {
    SectionPart& part = samples_[path[i].at][path[i].part];
    const double to_end = step_ * static_cast<double>(path.size() - 1 - i);
    part.round = std::max(part.round, is_stopped ? std::min(1.0, to_end / blend) : 1.0);
    if (part.tube < 0) part.tube = tube;
  }
}

void TubeSections::fill_end_view() {
  const int p = view_axis(end_view_->frame, 0).axis == first_.across() ? 0 : 1;
  const ViewAxis to_p = view_axis(end_view_->frame, p), to_q = view_axis(end_view_->frame, 1 - p);
  const Outline& outline = end_view_->outline;
  constexpr int kPlaces = 512;
  const double inset = 1e-6 * outline.diagonal();
  for (int i = 0; i < kPlaces; ++i) {
    const Eigen::Vector2d on = outline.at(outline.length() * (i + 0.5) / kPlaces);
    const Eigen::Vector2d seen = on - inset * outline.nearest(on).normal;
    fill({to_p.sign * seen[p], to_q.sign * seen[1 - p]});
  }
}

/// Raises the exponent of the tube that has to grow least so that a section has the point in it.
void TubeSections::fill(const Eigen::Vector2d& seen) {
  double least = std::numeric_limits<double>::infinity();
  int tube = -1, where = 0;
  const auto share = [](double x, const Slice& s) { return (x - s.middle()) / half_width(s); };
  constexpr double kBeyond = 1 + kSectionSlack;  // samples lie beside the widest place
  for (const std::vector<SectionPart>& parts : samples_) {
    for (const SectionPart& part : parts) {
      double u = share(seen.x(), part.p), v = share(seen.y(), part.q);
      if (std::abs(u) > kBeyond || std::abs(v) > kBeyond) continue;
      if (part.round < 0.3) return;
      u = std::clamp(u, -1.0, 1.0);
      v = std::clamp(v, -1.0, 1.0);
      const double n = exponent_through(u, v) * part.round;
      if (n <= exponents_[part.tube][quadrant(u, v)]) return;
      if (n >= least) continue;
      least = n;
      tube = part.tube;
      where = quadrant(u, v);
    }
  }
  if (tube >= 0) exponents_[tube][where] = least;
}

}  // namespace geoprior::sketch
