#include "solvers/paper/sheet/propagation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angles.h"
#include "core/geometry/planar.h"
#include "core/random.h"
#include "models/paper/contact/segments.h"
#include "solvers/paper/sheet/singular_point.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Draws of a singular point until one keeps its distance to the others.
constexpr int kMostDraws = 16;
/// Turn of the border at a corner that counts as one (rad).
constexpr double kSharpCorner = 0.5;
/// Compression over the admissible one that does not wait for young rulings to settle.
constexpr double kSevere = 10;

/// Direction of a cylinder that ends within the seeding distance and differs by less than the merge
/// angle, or the given one.
Vector2d merged_direction(const DemandGroup& group, const RulingEditor& editor,
                          const HybridOptions& options) {
  const Vector2d d = perpendicular(group.direction);
  for (const PaperPiece& piece : editor.structure().pieces) {
    if (piece.kind == PaperPiece::Kind::cylinder &&
        line_angle(piece.direction, d) < options.merge_angle_deg * kDegree) {
      return piece.direction;
    }
  }
  return d;
}

/// Rulings on the way from the seed, as far as the group reaches.
void collect_crossings(const RulingEditor& editor, const GroupTest& in_group, Vector2d d,
                       double group_angle, Candidate& candidate) {
  std::vector<std::pair<double, int>> hits;
  const auto& rulings = editor.structure().rulings;
  for (int i = 0; i < std::ssize(rulings); ++i) {
    if (line_angle(rulings[i].b - rulings[i].a, d) < group_angle) continue;
    const auto t = ray_hit(candidate.seed, d, rulings[i].a, rulings[i].b, editor.same());
    if (t) hits.emplace_back(*t, i);
  }
  std::sort(hits.begin(), hits.end());
  for (const auto& [t, i] : hits) {
    const Vector2d crossing = candidate.seed + t * d;
    candidate.crossings.push_back(crossing);
    candidate.crossed.push_back(i);
    if (!in_group(crossing + 0.5 * editor.bounds().gap * d)) break;
  }
}

Candidate make_candidate(const Vector2d& seed, Vector2d d, const GroupTest& in_group,
                         const RulingEditor& editor, const HybridOptions& options) {
  Candidate c;
  c.seed = seed;
  const double group_angle = options.group_angle_deg * kDegree;
  c.forward = editor.propagate(seed, d);
  c.backward = editor.propagate(seed, -d);
  // A ruling met at a small angle is no conflict: follow it.
  for (const RulingHit* hit : {&c.forward, &c.backward}) {
    if (hit->kind != RulingHit::Kind::ruling) continue;
    const Ruling& r = editor.structure().rulings[hit->index];
    if (line_angle(r.b - r.a, d) < group_angle) {
      d = (r.b - r.a).normalized();
      c.forward = editor.propagate(seed, d);
      c.backward = editor.propagate(seed, -d);
      break;
    }
  }
  c.direction = d;
  collect_crossings(editor, in_group, d, group_angle, c);
  collect_crossings(editor, in_group, -d, group_angle, c);
  return c;
}

/// Rulings that candidates make where nothing is crossed.
int add_rulings(const std::vector<Candidate>& candidates, RulingEditor& editor) {
  int added = 0;
  using Kind = RulingHit::Kind;
  for (const Candidate& c : candidates) {
    std::optional<Ruling> ruling;
    if (c.forward.kind == Kind::border && c.backward.kind == Kind::border) {
      ruling = editor.chord(c.seed, c.direction);
    } else if (c.forward.kind == Kind::singular && c.backward.kind == Kind::border) {
      ruling = editor.ray(c.forward.index, c.seed - c.forward.point);
    } else if (c.backward.kind == Kind::singular && c.forward.kind == Kind::border) {
      ruling = editor.ray(c.backward.index, c.seed - c.backward.point);
    } else if (c.backward.kind == Kind::singular && c.forward.kind == Kind::singular &&
               c.backward.index != c.forward.index) {
      ruling = editor.ray_between(c.backward.index, c.forward.index);
    }
    if (!ruling) continue;
    editor.add(*ruling);
    ++added;
  }
  return added;
}

/// The place nearest to p, if it is nearer than the limit.
std::optional<Vector2d> nearest_place(const std::vector<Vector2d>& places, const Vector2d& p,
                                      double limit) {
  std::optional<Vector2d> best;
  for (const Vector2d& place : places) {
    const double distance = (place - p).norm();
    if (distance >= limit) continue;
    limit = distance;
    best = place;
  }
  return best;
}

/// True near a corner of the border that sticks out: a cone has no room there.
bool near_sharp_corner(const Pattern& pattern, const Vector2d& p, double distance) {
  for (std::size_t l = 0; l < pattern.loop_count(); ++l) {
    const std::vector<Vector2d>& loop = pattern.loop(l);
    const std::size_t n = loop.size();
    for (std::size_t k = 0; k < n; ++k) {
      const Vector2d before = loop[k] - loop[(k + n - 1) % n];
      const Vector2d after = loop[(k + 1) % n] - loop[k];
      if (cross(before, after) > 0 && ray_angle(before, after) > kSharpCorner &&
          (loop[k] - p).norm() < distance) {
        return true;
      }
    }
  }
  return false;
}

/// Moves a drawn point to what it nearly hits: an anchor inside the sheet (what a point handle
/// pushes into the sheet is a cone with its apex there), or the border. Absent when it is too near
/// to another singular point or to a corner, or in a hole.
std::optional<Vector2d> settled(Vector2d p, const RulingEditor& editor,
                                const HybridOptions& options) {
  const double s = options.seeding_distance;
  std::vector<Vector2d> inside;
  for (const Vector2d& anchor : editor.anchors()) {
    if (nearest_on_border(editor.pattern(), anchor).distance > s / 2) inside.push_back(anchor);
  }
  const BorderPoint border = nearest_on_border(editor.pattern(), p);
  if (const auto anchor = nearest_place(inside, p, options.singular_spacing * s)) {
    p = *anchor;
  } else if (border.distance < s / 2) {
    p = editor.node_near(border.point, s / 2).value_or(border.point);
  }
  if (!contains(editor.pattern(), p, editor.same())) return std::nullopt;
  if (near_sharp_corner(editor.pattern(), p, s)) return std::nullopt;
  for (const SingularPoint& other : editor.structure().singular_points) {
    if ((other.position - p).norm() < options.singular_spacing * s) return std::nullopt;
  }
  return p;
}

/// Widens the cones of the singular point nearest to p; false when that changes nothing.
bool widen_nearest(const Vector2d& p, const Conflict& conflict, const HybridOptions& options,
                   RulingEditor& editor) {
  const auto& points = editor.structure().singular_points;
  std::optional<int> nearest;
  for (int s = 0; s < std::ssize(points); ++s) {
    if (!nearest || (points[s].position - p).norm() < (points[*nearest].position - p).norm()) {
      nearest = s;
    }
  }
  return nearest && widen_singular_point(*nearest, conflict, options, editor);
}

/// What the candidates of a group run across; absent while it is too early to say.
std::optional<Conflict> find_conflict(const DemandGroup& group,
                                      const std::vector<Candidate>& candidates,
                                      const std::vector<double>& folds,
                                      const HybridOptions& options, const RulingEditor& editor) {
  Conflict conflict;
  conflict.folds = folds;
  conflict.direction = perpendicular(group.direction);
  conflict.crossed.assign(editor.structure().rulings.size(), false);
  for (const Candidate& c : candidates) {
    for (const int r : c.crossed) {
      conflict.crossed[r] = true;
      const Ruling& ruling = editor.structure().rulings[r];
      if (ruling.age_frames < options.settle_frames && group.excess < kSevere) {
        return std::nullopt;
      }
    }
  }
  return conflict;
}

}  // namespace

std::vector<Vector2d> convex_hull(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Vector2d& p : points) {
      while (hull.size() >= start + 2 && orientation(hull[hull.size() - 2], hull.back(), p) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

Vector2d point_in_hull(const std::vector<Vector2d>& hull, const Eigen::Vector3d& uniform) {
  if (hull.size() == 1) return hull[0];
  if (hull.size() == 2) return hull[0] + uniform[0] * (hull[1] - hull[0]);
  std::vector<double> sums{0};
  for (std::size_t k = 1; k + 1 < hull.size(); ++k) {
    sums.push_back(sums.back() + cross(hull[k] - hull[0], hull[k + 1] - hull[0]));
  }
  const double wanted = uniform[0] * sums.back();
  std::size_t k = 1;
  while (k + 2 < hull.size() && sums[k] < wanted) ++k;
  // Uniform in a triangle: fold the parallelogram.
  double a = uniform[1], b = uniform[2];
  if (a + b > 1) {
    a = 1 - a;
    b = 1 - b;
  }
  return hull[0] + a * (hull[k] - hull[0]) + b * (hull[k + 1] - hull[0]);
}

std::vector<Candidate> propagate_candidates(const DemandGroup& group, const GroupTest& in_group,
                                            const RulingEditor& editor,
                                            const HybridOptions& options) {
  const double s = options.seeding_distance;
  const Vector2d d = merged_direction(group, editor, options);
  std::vector<Candidate> result;
  const int first = static_cast<int>(std::ceil(group.low / s));
  const int last = static_cast<int>(std::floor(group.high / s));
  for (int k = first; k <= last; ++k) {
    const Vector2d seed = group.centre + k * s * group.direction;
    if (!contains(editor.pattern(), seed)) continue;
    result.push_back(make_candidate(seed, d, in_group, editor, options));
  }
  return result;
}

PropagationReport resolve_group(const DemandGroup& group, const GroupTest& in_group,
                                const std::vector<double>& folds, double time, std::uint64_t seed,
                                std::uint64_t& draw, const HybridOptions& options,
                                RulingEditor& editor) {
  PropagationReport report;
  const std::vector<Candidate> candidates = propagate_candidates(group, in_group, editor, options);
  std::vector<Vector2d> crossings;
  for (const Candidate& c : candidates) {
    crossings.insert(crossings.end(), c.crossings.begin(), c.crossings.end());
  }
  if (crossings.empty() || (group.by_bending && !group.bent_ground)) {
    report.new_rulings = add_rulings(candidates, editor);
    report.changed = report.new_rulings > 0;
    return report;
  }
  const auto conflict = find_conflict(group, candidates, folds, options, editor);
  if (!conflict) return report;
  const std::vector<Vector2d> hull = convex_hull(crossings);
  RandomStream random(seed, fnv1a("paper singular point") + draw++);
  for (int k = 0; k < kMostDraws; ++k) {
    const double a = random.uniform(), b = random.uniform(), c = random.uniform();
    const auto p = settled(point_in_hull(hull, {a, b, c}), editor, options);
    if (!p) continue;
    add_singular_point(*p, time, *conflict, options, editor);
    report.new_singular_points = 1;
    report.changed = true;
    return report;
  }
  report.changed = widen_nearest(group.centre, *conflict, options, editor);
  return report;
}

}  // namespace geoprior::paper
