#include "solvers/sketch/hidden/seen_borders.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angles.h"
#include "core/geometry/planar.h"
#include "solvers/sketch/drawing/curve_net.h"

namespace geoprior::sketch {
namespace {

/// Of the snapping distance: what covers an end lies within it.
constexpr double kCoverReach = 2;
/// The same of the ends of rulings and pairs, which a hand puts onto borders.
constexpr double kMarkReach = 4;
/// Turning at either end of a join of two stretches.
constexpr double kSmoothJoin = 50 * kDegree;
/// In deviations of the noise: within which marks lie on borders.
constexpr double kMarkNoise = 5;
/// Between whose ends lies less is noise, where more is seen of the border.
constexpr double kCrumbNoise = 4;

/// "rim" of "rim-2": what stretches of one border are called by.
std::string name_of_border(const std::string& id) {
  const std::size_t dash = id.rfind('-');
  if (dash == std::string::npos || dash + 1 == id.size()) return id;
  const bool number = std::all_of(id.begin() + static_cast<std::ptrdiff_t>(dash) + 1, id.end(),
                                  [](char c) { return c >= '0' && c <= '9'; });
  return number ? id.substr(0, dash) : id;
}

/// Puts together what is seen of each border.
class BorderReader {
 public:
  BorderReader(const View& view, double noise, SeenBorders& seen)
      : view_(view), noise_(noise), seen_(seen) {}
  void find_rulings();
  void find_covered_ends();
  void join_stretches();
  void drop_crumbs();

 private:
  [[nodiscard]] std::vector<int> borders_for_ruling(const Stroke& stroke) const;
  bool join_one();
  [[nodiscard]] bool are_opposite(const PartialBorder& a, const PartialBorder& b) const;
  [[nodiscard]] bool is_covered(const PartialBorder& own, const Eigen::Vector2d& end,
                                const Eigen::Vector2d& other_end) const;

  const View& view_;
  double noise_;  ///< m
  SeenBorders& seen_;
};

/// Whether a drawn ruling joins stretches of these borders: two sides of one panel, which lie
/// apart.
bool BorderReader::are_opposite(const PartialBorder& a, const PartialBorder& b) const {
  const auto of_one_border = [&](const PartialBorder& p, const PartialBorder& q) {
    return p.panels == q.panels &&
           name_of_border(view_.strokes[p.stroke].id) == name_of_border(view_.strokes[q.stroke].id);
  };
  return std::any_of(seen_.rulings.begin(), seen_.rulings.end(), [&](const BorderRuling& ruling) {
    const PartialBorder& first = seen_.borders[ruling.border[0]];
    const PartialBorder& second = seen_.borders[ruling.border[1]];
    return (of_one_border(first, a) && of_one_border(second, b)) ||
           (of_one_border(first, b) && of_one_border(second, a));
  });
}

/// Whether an end lies on a stroke of another border or on a silhouette, and meets no end of a
/// border of a panel of its own there. Such a border meets one of the two ends, the nearer one.
bool BorderReader::is_covered(const PartialBorder& own, const Eigen::Vector2d& end,
                              const Eigen::Vector2d& other_end) const {
  const double reach = kCoverReach * seen_.snap;
  for (const PartialBorder& other : seen_.borders) {
    if (&other == &own || other.closed || other.panels == own.panels ||
        !may_meet(own.panels, other.panels))
      continue;
    const double joint = are_opposite(own, other) ? kTouches * seen_.snap : seen_.snap;
    for (const Eigen::Vector2d& p : {other.stretches[0].front().p, other.stretches[0].back().p})
      if ((p - end).norm() <= std::min(joint, (p - other_end).norm())) return false;
  }
  for (const PartialBorder& other : seen_.borders)
    if (&other != &own && distance_to(other, end) <= reach) return true;
  return std::any_of(view_.strokes.begin(), view_.strokes.end(), [&](const Stroke& stroke) {
    if (stroke.kind != StrokeKind::silhouette || stroke.points.size() < 2) return false;
    return nearest_place({stroke.points, false}, end).distance <= reach;
  });
}

void BorderReader::find_covered_ends() {
  for (PartialBorder& border : seen_.borders) {
    if (border.closed) continue;
    const Stretch& stretch = border.stretches.front();
    const Eigen::Vector2d &front = stretch.front().p, &back = stretch.back().p;
    border.covered = {is_covered(border, front, back), is_covered(border, back, front)};
  }
}

/// Puts the best two stretches together that may be one border; false: there are none.
bool BorderReader::join_one() {
  struct Join {
    double gap = 1e300;
    int a = -1, b = -1;
    bool a_back = true, b_back = false;
  } best;
  const auto out = [&](int i, bool back) {
    const PartialBorder& border = seen_.borders[i];
    return direction_out(back ? border.stretches.back() : border.stretches.front(), back,
                         kEndPart * seen_.diagonal);
  };
  const auto end = [&](int i, bool back) -> const Eigen::Vector2d& {
    return back ? seen_.borders[i].stretches.back().back().p
                : seen_.borders[i].stretches.front().front().p;
  };
  for (int a = 0; a < std::ssize(seen_.borders); ++a) {
    for (int b = a + 1; b < std::ssize(seen_.borders); ++b) {
      if (seen_.borders[a].closed || seen_.borders[b].closed ||
          seen_.borders[a].panels != seen_.borders[b].panels)
        continue;
      const bool alike = name_of_border(view_.strokes[seen_.borders[a].stroke].id) ==
                         name_of_border(view_.strokes[seen_.borders[b].stroke].id);
      for (const bool a_back : {true, false}) {
        for (const bool b_back : {false, true}) {
          if (!seen_.borders[a].covered[a_back ? 1 : 0] ||
              !seen_.borders[b].covered[b_back ? 1 : 0])
            continue;
          const Eigen::Vector2d gap = end(b, b_back) - end(a, a_back);
          const bool smooth = gap.norm() <= seen_.snap ||
                              (std::abs(signed_angle(out(a, a_back), gap)) < kSmoothJoin &&
                               std::abs(signed_angle(out(b, b_back), -gap)) < kSmoothJoin);
          if ((smooth || alike) && gap.norm() < best.gap) best = {gap.norm(), a, b, a_back, b_back};
        }
      }
    }
  }
  if (best.a < 0) return false;
  PartialBorder &a = seen_.borders[best.a], &b = seen_.borders[best.b];
  const auto turn = [](PartialBorder& border) {
    std::reverse(border.stretches.begin(), border.stretches.end());
    for (Stretch& stretch : border.stretches) std::reverse(stretch.begin(), stretch.end());
    std::swap(border.covered[0], border.covered[1]);
  };
  if (!best.a_back) turn(a);
  if (best.b_back) turn(b);
  a.stretches.insert(a.stretches.end(), b.stretches.begin(), b.stretches.end());
  a.covered[1] = b.covered[1];
  seen_.borders.erase(seen_.borders.begin() + best.b);
  return true;
}

void BorderReader::join_stretches() {
  while (join_one()) {
  }
}

/// Short stretches that noise leaves without a direction, unless they end a border.
void BorderReader::drop_crumbs() {
  for (PartialBorder& border : seen_.borders) {
    const auto is_crumb = [&](const Stretch& stretch) {
      return std::ranges::all_of(stretch, [&](const BorderPoint& point) {
        return (point.p - stretch.front().p).norm() < kCrumbNoise * noise_;
      });
    };
    std::vector<Stretch>& stretches = border.stretches;
    if (stretches.size() < 2 || std::ranges::all_of(stretches, is_crumb)) continue;
    std::vector<Stretch> kept;
    for (std::size_t k = 0; k < stretches.size(); ++k) {
      const bool ends_it =
          (k == 0 && !border.covered[0]) || (k + 1 == stretches.size() && !border.covered[1]);
      if (ends_it || !is_crumb(stretches[k])) kept.push_back(std::move(stretches[k]));
    }
    stretches = std::move(kept);
  }
}

/// Borders that a ruling may join: those of the panel that it names, all where fewer than two are.
std::vector<int> BorderReader::borders_for_ruling(const Stroke& stroke) const {
  std::vector<int> all, named;
  for (int b = 0; b < std::ssize(seen_.borders); ++b) {
    all.push_back(b);
    if (bounds(seen_.borders[b].panels, stroke.name)) named.push_back(b);
  }
  return named.size() < 2 ? all : named;
}

/// The rulings whose ends lie on two borders (`borders_for_ruling`).
void BorderReader::find_rulings() {
  seen_.rulings.clear();
  for (const Stroke& stroke : view_.strokes) {
    if (!is_ruling(stroke) || stroke.points.size() < 2) continue;
    const std::vector<int> asked = borders_for_ruling(stroke);
    std::array<std::vector<double>, 2> distances;
    for (const int b : asked) {
      distances[0].push_back(distance_to(seen_.borders[b], stroke.points.front()));
      distances[1].push_back(distance_to(seen_.borders[b], stroke.points.back()));
    }
    const auto [first, second] = two_borders(distances[0], distances[1], seen_.mark_reach);
    if (first < 0 || second < 0 || first == second) continue;
    seen_.rulings.push_back(
        {{asked[first], asked[second]}, {stroke.points.front(), stroke.points.back()}});
  }
}

}  // namespace

double distance_to(const PartialBorder& border, const Eigen::Vector2d& p) {
  double nearest = 1e300;
  for (const Stretch& stretch : border.stretches)
    nearest = std::min(nearest, nearest_place(picture_of(stretch, border.closed), p).distance);
  return nearest;
}

SeenBorders borders_as_drawn(const View& view, double snap, double noise) {
  SeenBorders seen;
  Eigen::AlignedBox2d box;
  for (int s = 0; s < std::ssize(view.strokes); ++s) {
    const Stroke& stroke = view.strokes[s];
    if (stroke.kind != StrokeKind::border || stroke.points.size() < 2) continue;
    PartialBorder border{s, panels_in(stroke.name), stroke.closed, {{}}, {}};
    for (std::size_t k = 0; k < stroke.points.size(); ++k) {
      box.extend(stroke.points[k]);
      border.stretches.front().push_back({stroke.points[k], {s, static_cast<double>(k)}});
    }
    seen.borders.push_back(std::move(border));
  }
  const double diagonal = box.isEmpty() ? 0 : box.diagonal().norm();
  seen.diagonal = diagonal;
  seen.snap = std::max(snap * diagonal, kSnapNoise * noise);
  seen.mark_reach =
      std::max({kMarkReach * snap * diagonal, kMarkMiss * diagonal, kMarkNoise * noise});
  BorderReader(view, noise, seen).find_rulings();
  return seen;
}

SeenBorders seen_borders(const View& view, double snap, double noise) {
  SeenBorders seen = borders_as_drawn(view, snap, noise);
  BorderReader reader(view, noise, seen);
  reader.find_covered_ends();
  reader.join_stretches();
  reader.drop_crumbs();
  reader.find_rulings();
  return seen;
}

}  // namespace geoprior::sketch
