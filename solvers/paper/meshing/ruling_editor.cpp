#include "solvers/paper/meshing/ruling_editor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/planar.h"
#include "models/paper/contact/segments.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Border points this many gaps from an end of a ruling are neighbours of that end and need not be
/// far from the ruling: on a finely sampled border they never are.
constexpr double kNeighbourhood = 3;

/// Shortest edge of the border that an end that may not snap leaves, in gaps.
constexpr double kLeastBorderEdge = 0.25;

/// Most that a line turns into a row of anchors (rad).
constexpr double kRowAngle = std::numbers::pi / 18;

bool is_ignored(const std::vector<bool>& ignored, std::size_t i) {
  return i < ignored.size() && ignored[i];
}

}  // namespace

RulingEditor::RulingEditor(const Pattern& pattern, const std::vector<Vector2d>& anchors,
                           const Bounds& bounds, PaperStructure& structure)
    : pattern_(pattern),
      corners_(corners(pattern)),
      anchors_(anchors),
      bounds_(bounds),
      structure_(structure),
      same_(1e-9 * width(pattern)) {
  for (const std::vector<Vector2d>& cut : pattern.cuts)
    corners_.insert(corners_.end(), cut.begin(), cut.end());
  for (const Vector2d& p : anchors_) {
    if (nearest_on_border(pattern_, p).distance <= same_) border_anchors_.push_back(p);
  }
}

RulingHit RulingEditor::propagate(const Vector2d& origin, const Vector2d& direction,
                                  std::optional<int> from_singular) const {
  const Vector2d d = direction.normalized();
  RulingHit hit;
  hit.distance = std::numeric_limits<double>::infinity();
  const auto offer = [&](RulingHit::Kind kind, std::optional<double> t, std::size_t index) {
    if (t && *t < hit.distance) hit = {kind, origin + *t * d, *t, static_cast<int>(index)};
  };
  std::size_t e = 0;
  each_edge(pattern_, [&](const Vector2d& a, const Vector2d& b) {
    offer(RulingHit::Kind::border, ray_hit(origin, d, a, b, same_), e++);
  });
  for (std::size_t r = 0; r < structure_.rulings.size(); ++r) {
    const Ruling& ruling = structure_.rulings[r];
    if (from_singular &&
        (ruling.singular_a == from_singular || ruling.singular_b == from_singular)) {
      continue;
    }
    offer(RulingHit::Kind::ruling, ray_hit(origin, d, ruling.a, ruling.b, same_), r);
  }
  for (int s = 0; s < std::ssize(structure_.singular_points); ++s) {
    if (from_singular == s) continue;
    const Vector2d to = structure_.singular_points[s].position - origin;
    const double t = to.dot(d);
    // A singular point decides before the rulings that end in it.
    if (t > same_ && std::abs(cross(d, to)) < bounds_.gap && t < hit.distance + bounds_.gap) {
      hit = {RulingHit::Kind::singular, structure_.singular_points[s].position, t, s};
    }
  }
  return hit;
}

std::vector<Vector2d> RulingEditor::middles_of_parts(const Vector2d& p, const Vector2d& d) const {
  std::vector<double> stops;
  each_edge(pattern_, [&](const Vector2d& a, const Vector2d& b) {
    const auto t = ray_hit(p, d, a, b, -std::numeric_limits<double>::infinity());
    if (t) stops.push_back(*t);
  });
  std::sort(stops.begin(), stops.end());
  std::vector<Vector2d> middles;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const Vector2d middle = p + (stops[i] + stops[i + 1]) / 2 * d;
    if ((stops[i + 1] - stops[i]) * d.norm() > 2 * bounds_.gap && contains(pattern_, middle))
      middles.push_back(middle);
  }
  return middles;
}

bool RulingEditor::clear_of(const Ruling& ruling, const Ruling& other) const {
  for (const Vector2d* p : {&ruling.a, &ruling.b}) {
    for (const Vector2d* q : {&other.a, &other.b}) {
      if ((*p - *q).norm() > same_) continue;
      const Vector2d& far_p = p == &ruling.a ? ruling.b : ruling.a;
      const Vector2d& far_q = q == &other.a ? other.b : other.a;
      return (far_p - far_q).norm() > same_ &&
             ray_angle(far_p - *p, far_q - *q) >= bounds_.least_angle;
    }
  }
  if (segments_meet(ruling.a, ruling.b, other.a, other.b)) return false;
  return distance_to_segment(ruling.a, other.a, other.b) >= bounds_.gap &&
         distance_to_segment(ruling.b, other.a, other.b) >= bounds_.gap &&
         distance_to_segment(other.a, ruling.a, ruling.b) >= bounds_.gap &&
         distance_to_segment(other.b, ruling.a, ruling.b) >= bounds_.gap;
}

bool RulingEditor::clear_of_points(const Ruling& ruling) const {
  const auto near = [&](const Vector2d& p, double from_ends) {
    if ((p - ruling.a).norm() <= from_ends || (p - ruling.b).norm() <= from_ends) return false;
    const double distance = distance_to_segment(p, ruling.a, ruling.b);
    return distance < bounds_.gap && distance > same_;
  };
  for (const SingularPoint& s : structure_.singular_points) {
    if ((s.position - ruling.a).norm() <= same_ || (s.position - ruling.b).norm() <= same_) {
      continue;
    }
    if (distance_to_segment(s.position, ruling.a, ruling.b) < bounds_.gap) return false;
  }
  for (const Vector2d& p : anchors_) {
    if (near(p, same_)) return false;
  }
  // Beside the knots of a cut a ruling may end, but not graze them on its way.
  for (const std::vector<Vector2d>& cut : pattern_.cuts) {
    for (const Vector2d& p : cut) {
      const double from_end = std::min((p - ruling.a).norm(), (p - ruling.b).norm());
      if (from_end > same_ && distance_to_segment(p, ruling.a, ruling.b) <
                                  std::sin(bounds_.least_angle) * std::min(from_end, bounds_.gap)) {
        return false;
      }
    }
  }
  return std::none_of(corners_.begin(), corners_.end(), [&](const Vector2d& corner) {
    return near(corner, kNeighbourhood * bounds_.gap);
  });
}

bool RulingEditor::fits(const Ruling& ruling, const std::vector<bool>& ignored) const {
  if ((ruling.b - ruling.a).norm() < 2 * bounds_.gap) return false;
  // A line along the border bounds nothing.
  const Vector2d middle = (ruling.a + ruling.b) / 2;
  if (!contains(pattern_, middle) || nearest_on_border(pattern_, middle).distance < bounds_.gap) {
    return false;
  }
  bool crosses = false;
  each_edge(pattern_, [&](const Vector2d& a, const Vector2d& b) {
    constexpr double kNear = 1e-6;
    const auto t = ray_hit(ruling.a, ruling.b - ruling.a, a, b, kNear);
    crosses = crosses || (t && *t < 1 - kNear);
  });
  if (crosses || !clear_of_points(ruling)) return false;
  for (std::size_t i = 0; i < structure_.rulings.size(); ++i) {
    if (!is_ignored(ignored, i) && !clear_of(ruling, structure_.rulings[i])) return false;
  }
  return true;
}

std::optional<Vector2d> RulingEditor::node_near(const Vector2d& p, double within) const {
  std::optional<Vector2d> nearest;
  const auto offer = [&](const Vector2d& node) {
    const double distance = (node - p).norm();
    if (distance >= within) return;
    within = distance;
    nearest = node;
  };
  for (const Vector2d& corner : corners_) offer(corner);
  for (const Vector2d& anchor : border_anchors_) offer(anchor);
  for (const SingularPoint& s : structure_.singular_points) {
    if (s.on_border) offer(s.position);
  }
  for (const Ruling& r : structure_.rulings) {
    if (!r.singular_a) offer(r.a);
    if (!r.singular_b) offer(r.b);
  }
  return nearest;
}

Vector2d RulingEditor::snapped(const Vector2d& border_point) const {
  return node_near(border_point, bounds_.gap).value_or(border_point);
}

std::optional<Vector2d> RulingEditor::border_end(const Vector2d& centre, const Vector2d& direction,
                                                 bool snap,
                                                 const std::vector<bool>& ignored) const {
  // What is ignored is about to go: look past it to the border.
  const Vector2d d = direction.normalized();
  std::optional<double> nearest;
  each_edge(pattern_, [&](const Vector2d& a, const Vector2d& b) {
    const auto t = ray_hit(centre, d, a, b, same_);
    if (t && (!nearest || *t < *nearest)) nearest = t;
  });
  if (!nearest) return std::nullopt;
  for (std::size_t i = 0; i < structure_.rulings.size(); ++i) {
    const Ruling& r = structure_.rulings[i];
    if (is_ignored(ignored, i)) continue;
    const auto t = ray_hit(centre, d, r.a, r.b, same_);
    if (t && *t < *nearest - bounds_.gap) return std::nullopt;
  }
  const Vector2d end = centre + *nearest * d;
  const Vector2d node = snapped(end);
  if (snap || node == end) return node;
  if ((node - end).norm() < kLeastBorderEdge * bounds_.gap) return std::nullopt;
  return end;
}

std::optional<Ruling> RulingEditor::chord(const Vector2d& centre, const Vector2d& direction,
                                          const std::vector<bool>& ignored) const {
  Vector2d through = centre;
  double nearest = bounds_.gap;
  const Vector2d d = direction.normalized();
  for (const Vector2d& p : anchors_) {
    const double distance = std::abs(cross(d, p - centre));
    if (distance < nearest && nearest_on_border(pattern_, p).distance > bounds_.gap) {
      nearest = distance;
      through = p;
    }
  }
  const auto line = [&](const Vector2d& along, bool snap) -> std::optional<Ruling> {
    const auto b = border_end(through, along, snap, ignored);
    const auto a = border_end(through, -along, snap, ignored);
    if (!a || !b) return std::nullopt;
    Ruling ruling;
    ruling.a = *a;
    ruling.b = *b;
    return fits(ruling, ignored) ? std::optional(ruling) : std::nullopt;
  };
  // Snapping an end would turn the line off its anchor.
  const bool snap = through == centre;
  const auto ruling = line(d, snap);
  if (ruling || snap) return ruling;
  // A row of anchors leaves one line through them.
  std::optional<Vector2d> row;
  for (const Vector2d& p : anchors_) {
    const Vector2d to = p - through;
    if (to.norm() > same_ && line_angle(to, d) < (row ? line_angle(*row, d) : kRowAngle)) row = to;
  }
  return row ? line(*row, true) : std::nullopt;
}

std::optional<Ruling> RulingEditor::turned(int ruling, double angle) const {
  Ruling result = structure_.rulings[ruling];
  std::vector<bool> itself(structure_.rulings.size(), false);
  itself[ruling] = true;
  const Vector2d middle = (result.a + result.b) / 2;
  const Vector2d d = Eigen::Rotation2Dd(angle) * (result.b - result.a);
  const auto a = border_end(middle, -d, false, itself), b = border_end(middle, d, false, itself);
  if (!a || !b) return std::nullopt;
  result.a = *a;
  result.b = *b;
  if (!fits(result, itself)) return std::nullopt;
  return result;
}

std::optional<Ruling> RulingEditor::ray(int singular_point, const Vector2d& direction) const {
  const Vector2d origin = structure_.singular_points[singular_point].position;
  const RulingHit hit = propagate(origin, direction, singular_point);
  if (hit.kind != RulingHit::Kind::border || !std::isfinite(hit.distance)) return std::nullopt;
  return ray_to(singular_point, snapped(hit.point));
}

std::optional<Ruling> RulingEditor::ray_to(int singular_point, const Vector2d& end) const {
  Ruling ruling;
  ruling.a = structure_.singular_points[singular_point].position;
  ruling.b = end;
  ruling.singular_a = singular_point;
  for (int s = 0; s < std::ssize(structure_.singular_points); ++s) {
    if ((structure_.singular_points[s].position - end).norm() <= same_) {
      ruling.singular_b = s;
    }
  }
  if (!fits(ruling)) return std::nullopt;
  return ruling;
}

std::optional<Ruling> RulingEditor::ray_between(int singular_point, int other) const {
  return ray_to(singular_point, structure_.singular_points[other].position);
}

void RulingEditor::remove_point(int singular_point) {
  std::vector<bool> marked;
  for (const Ruling& r : structure_.rulings)
    marked.push_back(r.singular_a == singular_point || r.singular_b == singular_point);
  remove(marked);
  structure_.singular_points.erase(structure_.singular_points.begin() + singular_point);
  for (Ruling& r : structure_.rulings) {
    for (std::optional<int>* end : {&r.singular_a, &r.singular_b}) {
      if (*end && **end > singular_point) --**end;
    }
  }
}

void RulingEditor::remove(const std::vector<bool>& marked) {
  std::vector<Ruling> kept;
  for (std::size_t i = 0; i < structure_.rulings.size(); ++i) {
    if (!is_ignored(marked, i)) kept.push_back(structure_.rulings[i]);
  }
  structure_.rulings = std::move(kept);
}

}  // namespace geoprior::paper
