#include "solvers/paper/sheet/singular_point.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/angles.h"
#include "models/paper/contact/segments.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Nearest that a ruling of another piece passes a singular point, in gaps.
constexpr double kClear = 1.5;

/// Lines to all that the point sees, the nearest first: a far one must not come too near to them.
void connect(int index, RulingEditor& editor) {
  const Vector2d p = editor.structure().singular_points[index].position;
  std::vector<std::pair<double, Vector2d>> targets;
  const auto& points = editor.structure().singular_points;
  for (int s = 0; s < std::ssize(points); ++s) {
    if (s != index) targets.emplace_back(0, points[s].position);
  }
  for (const Ruling& r : editor.structure().rulings) {
    if (!r.singular_a) targets.emplace_back(0, r.a);
    if (!r.singular_b) targets.emplace_back(0, r.b);
  }
  for (auto& [distance, q] : targets) distance = (q - p).norm();
  std::stable_sort(targets.begin(), targets.end(),
                   [](const auto& x, const auto& y) { return x.first < y.first; });
  for (const auto& [distance, q] : targets) {
    if (const auto ray = editor.ray_to(index, q)) editor.add(*ray);
  }
}

}  // namespace

int fill_fan(int singular_point, const HybridOptions& options, RulingEditor& editor) {
  const double fan = options.fan_angle_deg * std::numbers::pi / 180;
  const Vector2d p = editor.structure().singular_points[singular_point].position;
  std::vector<double> angles;
  for (const int i : editor.structure().rulings_at(singular_point)) {
    const Ruling& r = editor.structure().rulings[i];
    const Vector2d d = (r.singular_a == singular_point ? r.b : r.a) - p;
    angles.push_back(std::atan2(d.y(), d.x()));
  }
  std::sort(angles.begin(), angles.end());
  if (angles.empty()) angles.push_back(0);
  int added = 0;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const double from = angles[k];
    const double to = k + 1 < angles.size() ? angles[k + 1] : angles[0] + kFullTurn;
    const int parts = static_cast<int>(std::ceil((to - from) / fan - 1e-9));
    for (int i = 1; i < parts; ++i) {
      const double angle = from + (to - from) * i / parts;
      const auto ray = editor.ray(singular_point, {std::cos(angle), std::sin(angle)});
      if (!ray) continue;
      editor.add(*ray);
      ++added;
    }
  }
  return added;
}

std::vector<bool> rulings_in_conflict(const Vector2d& p, std::optional<int> own,
                                      const Conflict& conflict, const HybridOptions& options,
                                      const RulingEditor& editor) {
  const auto& rulings = editor.structure().rulings;
  const double reach = options.cone_reach * options.seeding_distance;
  const double most_turn = options.flatten_angle_deg * std::numbers::pi / 180;
  std::vector<bool> marked(rulings.size(), false);
  std::vector<std::pair<double, std::size_t>> sides[2];
  for (std::size_t i = 0; i < rulings.size(); ++i) {
    const Ruling& r = rulings[i];
    if (own && (r.singular_a == own || r.singular_b == own)) continue;
    marked[i] = distance_to_segment(p, r.a, r.b) < kClear * editor.bounds().gap;
    if (marked[i] || i >= conflict.crossed.size() || !conflict.crossed[i]) continue;
    for (int side = 0; side < 2; ++side) {
      const Vector2d d = side == 0 ? conflict.direction : Vector2d(-conflict.direction);
      const auto t = ray_hit(p, d, r.a, r.b, 0);
      if (t && *t < reach) sides[side].emplace_back(*t, i);
    }
  }
  for (auto& side : sides) {
    std::sort(side.begin(), side.end());
    double turned = 0;
    for (const auto& [t, i] : side) {
      turned += i < conflict.folds.size() ? std::abs(conflict.folds[i]) : 0;
      if (turned > most_turn) break;
      marked[i] = true;
    }
  }
  return marked;
}

void add_singular_point(const Vector2d& p, double time, const Conflict& conflict,
                        const HybridOptions& options, RulingEditor& editor) {
  editor.remove(rulings_in_conflict(p, std::nullopt, conflict, options, editor));
  PaperStructure& structure = editor.structure();
  SingularPoint point;
  const int index = static_cast<int>(structure.singular_points.size());
  for (const SingularPoint& other : structure.singular_points)
    point.id = std::max(point.id, other.id + 1);
  point.position = p;
  point.birth = time;
  point.on_border = nearest_on_border(editor.pattern(), p).distance <= editor.same();
  structure.singular_points.push_back(point);
  connect(index, editor);
  fill_fan(index, options, editor);
}

bool widen_singular_point(int singular_point, const Conflict& conflict,
                          const HybridOptions& options, RulingEditor& editor) {
  const Vector2d p = editor.structure().singular_points[singular_point].position;
  const std::vector<bool> marked =
      rulings_in_conflict(p, singular_point, conflict, options, editor);
  if (std::none_of(marked.begin(), marked.end(), [](bool b) { return b; })) return false;
  editor.remove(marked);
  connect(singular_point, editor);
  fill_fan(singular_point, options, editor);
  return true;
}

}  // namespace geoprior::paper
