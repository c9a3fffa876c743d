#include "solvers/sketch/drawing/hidden_borders.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/planar.h"
#include "models/sketch/drawing/ellipse_fit.h"
#include "solvers/sketch/drawing/border_models.h"
#include "solvers/sketch/drawing/ruling_ends.h"

namespace geoprior::sketch {
namespace {

/// Of the snapping distance: what covers an end lies within it, a guess agrees with what is seen to
/// it, and a guess that is shorter is none.
constexpr double kCoverReach = 2;
/// The same of the rulings' ends, which a hand puts onto borders.
constexpr double kMarkReach = 4;
/// And at least this share of the diagonal.
constexpr double kMarkHand = 0.03;
/// Turning at either end of a join of two stretches.
constexpr double kSmoothJoin = 50 * kDegree;
/// Of the drawing's diagonal: along which the direction of an end is taken, spacing of guesses.
constexpr double kEndPart = 0.04;
constexpr double kGuessSpacing = 1.0 / 150;
/// To which a border is the parallel copy of another.
constexpr double kCopyEvidence = 0.005;
/// The same in deviations of the noise: within which ends meet, marks lie on borders, and a border
/// is a copy.
constexpr double kSnapNoise = 3;
constexpr double kMarkNoise = 5;
constexpr double kCopyNoise = 2;
/// Between whose ends lies less is noise, where more is seen of the border.
constexpr double kCrumbNoise = 4;
/// What must be seen of a rim that goes round: five ninths of its ellipse, or 130 degrees of it
/// between silhouettes of its own panel.
constexpr double kRimSpan = 200 * kDegree;
constexpr double kRimBetweenSilhouettes = 130 * kDegree;

/// A border in one or more stretches, in order and sense.
struct PartialBorder {
  int stroke = -1;  ///< the first that was drawn of it
  std::vector<std::string> panels;
  bool closed = false;
  std::vector<Stretch> stretches;
  std::array<bool, 2> covered{false, false};  ///< first and last end of an open one

  [[nodiscard]] bool whole() const {
    return stretches.size() == 1 && (closed || (!covered[0] && !covered[1]));
  }
};

/// "rim" of "rim-2": what stretches of one border are called by.
std::string name_of_border(const std::string& id) {
  const std::size_t dash = id.rfind('-');
  if (dash == std::string::npos || dash + 1 == id.size()) return id;
  const bool number = std::all_of(id.begin() + static_cast<std::ptrdiff_t>(dash) + 1, id.end(),
                                  [](char c) { return c >= '0' && c <= '9'; });
  return number ? id.substr(0, dash) : id;
}

/// A drawn ruling between two borders.
struct BorderRuling {
  std::array<int, 2> border{-1, -1};
  std::array<Eigen::Vector2d, 2> end;
};

class BorderCompletion {
 public:
  BorderCompletion(const View& view, const MirrorPlane& plane, double snap, Completion completion,
                   double noise);
  CompletedView complete();
  /// Strokes of the drawing.
  [[nodiscard]] std::vector<std::array<int, 2>> parallel_borders();

 private:
  void find_covered_ends();
  void join_stretches();
  void drop_crumbs();
  bool join_one();
  void find_rulings();
  void complete_all();
  bool copy_neighbour(int border, bool only_whole);
  bool go_round(int border);
  bool mirror_self(int border);
  void join_by_cubics(PartialBorder& border);
  bool follow(int border, const PictureCurve& model, const std::string& from);
  void close_panels(CompletedView& out) const;
  void put_strokes(CompletedView& out) const;

  void copy_pairs(int whole, int copy, const ParallelCopy& map);
  [[nodiscard]] bool end_lies_on(const PartialBorder& border, const Stroke& pair,
                                 const Eigen::Vector2d& end) const;
  [[nodiscard]] bool lies_on(const PartialBorder& border, const Stroke& pair) const;
  [[nodiscard]] bool joins(const PartialBorder& a, const PartialBorder& b,
                           const Stroke& pair) const;
  [[nodiscard]] bool are_opposite(const PartialBorder& a, const PartialBorder& b) const;
  [[nodiscard]] bool is_covered(const PartialBorder& own, const Eigen::Vector2d& end,
                                const Eigen::Vector2d& other_end) const;
  [[nodiscard]] std::vector<Eigen::Vector2d> seen_points(const PartialBorder& border) const;
  [[nodiscard]] CopyHints hints_between(int whole, int copy) const;
  [[nodiscard]] std::optional<PictureMirror> mirror_of(const PartialBorder& border) const;
  [[nodiscard]] bool between_own_silhouettes(int border) const;
  [[nodiscard]] double distance_to(const PartialBorder& border, const Eigen::Vector2d& p) const;

  const View& view_;
  MirrorPlane plane_;
  Completion completion_;
  double noise_;  ///< m
  double diagonal_ = 0, snap_ = 0;
  double mark_reach_ = 0, copy_evidence_ = 0;
  std::vector<PartialBorder> borders_;
  std::vector<BorderRuling> rulings_;
  std::vector<GuessedStretch> guesses_;
  std::vector<Stroke> pairs_;  ///< drawn ones, then those of parallel copies
  std::size_t drawn_pairs_ = 0;
};

BorderCompletion::BorderCompletion(const View& view, const MirrorPlane& plane, double snap,
                                   Completion completion, double noise)
    : view_(view), plane_(plane), completion_(completion), noise_(noise) {
  Eigen::AlignedBox2d box;
  for (int s = 0; s < std::ssize(view.strokes); ++s) {
    const Stroke& stroke = view.strokes[s];
    if (stroke.kind != StrokeKind::border || stroke.points.size() < 2) continue;
    PartialBorder border{s, panels_in(stroke.name), stroke.closed, {{}}, {}};
    for (std::size_t k = 0; k < stroke.points.size(); ++k) {
      box.extend(stroke.points[k]);
      border.stretches.front().push_back({stroke.points[k], {s, static_cast<double>(k)}});
    }
    borders_.push_back(std::move(border));
  }
  for (const Stroke* pair : strokes_of(view, StrokeKind::symmetric_pair))
    if (!pair->points.empty()) pairs_.push_back(*pair);
  drawn_pairs_ = pairs_.size();
  diagonal_ = box.isEmpty() ? 0 : box.diagonal().norm();
  snap_ = std::max(snap * diagonal_, kSnapNoise * noise);
  mark_reach_ =
      std::max({kMarkReach * snap * diagonal_, kMarkHand * diagonal_, kMarkNoise * noise});
  copy_evidence_ = std::max(kCopyEvidence * diagonal_, kCopyNoise * noise);
}

double BorderCompletion::distance_to(const PartialBorder& border, const Eigen::Vector2d& p) const {
  double nearest = 1e300;
  for (const Stretch& stretch : border.stretches)
    nearest = std::min(nearest, nearest_place(picture_of(stretch, border.closed), p).distance);
  return nearest;
}

/// Whether drawn rulings join borders of these panels: two sides of one panel, which lie apart.
bool BorderCompletion::are_opposite(const PartialBorder& a, const PartialBorder& b) const {
  return std::any_of(rulings_.begin(), rulings_.end(), [&](const BorderRuling& ruling) {
    const auto &first = borders_[ruling.border[0]].panels, &second = borders_[ruling.border[1]].panels;
    return (first == a.panels && second == b.panels) || (first == b.panels && second == a.panels);
  });
}

/// Whether an end lies on a stroke of another border or on a silhouette, and meets no end of a
/// border of a panel of its own there. Such a border meets one of the two ends, the nearer one.
bool BorderCompletion::is_covered(const PartialBorder& own, const Eigen::Vector2d& end,
                                  const Eigen::Vector2d& other_end) const {
  const double reach = kCoverReach * snap_;
  for (const PartialBorder& other : borders_) {
    if (&other == &own || other.closed || !may_meet(own.panels, other.panels) ||
        are_opposite(own, other))
      continue;
    for (const Eigen::Vector2d& p : {other.stretches[0].front().p, other.stretches[0].back().p})
      if ((p - end).norm() <= std::min(snap_, (p - other_end).norm()) &&
          other.panels != own.panels)
        return false;
  }
  for (const PartialBorder& other : borders_)
    if (&other != &own && distance_to(other, end) <= reach) return true;
  return std::any_of(view_.strokes.begin(), view_.strokes.end(), [&](const Stroke& stroke) {
    if (stroke.kind != StrokeKind::silhouette || stroke.points.size() < 2) return false;
    return nearest_place({stroke.points, false}, end).distance <= reach;
  });
}

void BorderCompletion::find_covered_ends() {
  for (PartialBorder& border : borders_) {
    if (border.closed) continue;
    const Stretch& stretch = border.stretches.front();
    const Eigen::Vector2d &front = stretch.front().p, &back = stretch.back().p;
    border.covered = {is_covered(border, front, back), is_covered(border, back, front)};
  }
}

/// Puts the best two stretches together that may be one border; false: there are none.
bool BorderCompletion::join_one() {
  struct Join {
    double gap = 1e300;
    int a = -1, b = -1;
    bool a_back = true, b_back = false;
  } best;
  const auto out = [&](int i, bool back) {
    const PartialBorder& border = borders_[i];
    return direction_out(back ? border.stretches.back() : border.stretches.front(), back,
                         kEndPart * diagonal_);
  };
  const auto end = [&](int i, bool back) -> const Eigen::Vector2d& {
    return back ? borders_[i].stretches.back().back().p : borders_[i].stretches.front().front().p;
  };
  for (int a = 0; a < std::ssize(borders_); ++a) {
    for (int b = a + 1; b < std::ssize(borders_); ++b) {
      if (borders_[a].closed || borders_[b].closed || borders_[a].panels != borders_[b].panels)
        continue;
      const bool alike = name_of_border(view_.strokes[borders_[a].stroke].id) ==
                         name_of_border(view_.strokes[borders_[b].stroke].id);
      for (const bool a_back : {true, false}) {
        for (const bool b_back : {false, true}) {
          if (!borders_[a].covered[a_back ? 1 : 0] || !borders_[b].covered[b_back ? 1 : 0])
            continue;
          const Eigen::Vector2d gap = end(b, b_back) - end(a, a_back);
          const bool smooth =
              gap.norm() <= snap_ || (std::abs(signed_angle(out(a, a_back), gap)) < kSmoothJoin &&
                                      std::abs(signed_angle(out(b, b_back), -gap)) < kSmoothJoin);
          if ((smooth || alike) && gap.norm() < best.gap) best = {gap.norm(), a, b, a_back, b_back};
        }
      }
    }
  }
  if (best.a < 0) return false;
  PartialBorder &a = borders_[best.a], &b = borders_[best.b];
  const auto turn = [](PartialBorder& border) {
    std::reverse(border.stretches.begin(), border.stretches.end());
    for (Stretch& stretch : border.stretches) std::reverse(stretch.begin(), stretch.end());
    std::swap(border.covered[0], border.covered[1]);
  };
  if (!best.a_back) turn(a);
  if (best.b_back) turn(b);
  a.stretches.insert(a.stretches.end(), b.stretches.begin(), b.stretches.end());
  a.covered[1] = b.covered[1];
  borders_.erase(borders_.begin() + best.b);
  return true;
}

void BorderCompletion::join_stretches() {
  while (join_one()) {
  }
}

/// Short stretches that noise leaves without a direction, unless they end a border.
void BorderCompletion::drop_crumbs() {
  for (PartialBorder& border : borders_) {
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

/// The rulings whose ends lie on two borders; of the panel that a ruling names when both name it.
void BorderCompletion::find_rulings() {
  rulings_.clear();
  for (const Stroke& stroke : view_.strokes) {
    const bool ruling = stroke.kind == StrokeKind::silhouette || stroke.kind == StrokeKind::ruling;
    if (!ruling || stroke.points.size() < 2) continue;
    std::vector<int> named;
    std::array<std::vector<double>, 2> distances;
    for (int b = 0; b < std::ssize(borders_); ++b) {
      const std::vector<std::string>& panels = borders_[b].panels;
      if (!stroke.name.empty() &&
          std::find(panels.begin(), panels.end(), stroke.name) == panels.end())
        continue;
      named.push_back(b);
      distances[0].push_back(distance_to(borders_[b], stroke.points.front()));
      distances[1].push_back(distance_to(borders_[b], stroke.points.back()));
    }
    const auto [first, second] = two_borders(distances[0], distances[1], mark_reach_);
    if (first < 0 || second < 0 || first == second) continue;
    rulings_.push_back({{named[first], named[second]},
                        {stroke.points.front(), stroke.points.back()}});
  }
}

std::vector<Eigen::Vector2d> BorderCompletion::seen_points(const PartialBorder& border) const {
  std::vector<Eigen::Vector2d> seen;
  for (const Stretch& stretch : border.stretches) {
    const PictureCurve even = evenly(picture_of(stretch, border.closed), kGuessSpacing * diagonal_);
    seen.insert(seen.end(), even.points.begin(), even.points.end());
  }
  return seen;
}

CopyHints BorderCompletion::hints_between(int whole, int copy) const {
  CopyHints hints;
  for (const BorderRuling& r : rulings_) {
    if (r.border[0] == whole && r.border[1] == copy) hints.rulings.push_back({r.end[0], r.end[1]});
    if (r.border[1] == whole && r.border[0] == copy) hints.rulings.push_back({r.end[1], r.end[0]});
  }
  const PartialBorder& border = borders_[copy];
  if (border.closed) return hints;
  if (!border.covered[0]) hints.ends.push_back(border.stretches.front().front().p);
  if (!border.covered[1]) hints.ends.push_back(border.stretches.back().back().p);
  return hints;
}

/// Fills the gaps of a border, and continues it at covered ends, along a model of the whole.
/// @return whether something was added
bool BorderCompletion::follow(int number, const PictureCurve& model, const std::string& from) {
  PartialBorder& border = borders_[number];
  const std::vector<PlacedStretch> placed = placed_along(model, border.stretches);
  // The covered ends go with the sense of the first stretch.
  std::array<bool, 2> covered = border.covered;
  if (placed.front().turned) std::swap(covered[0], covered[1]);
  const double least = snap_;
  const double last = static_cast<double>(model.points.size()) - 1;
  const PlacedStretch &first = placed.front(), &back = placed.back();
  FollowedModel whole{model, {}, 0};
  if (!model.closed && covered[0] && length_between(model, 0, first.begin) > least) {
    whole.fill(0, first.begin, std::nullopt, first.stretch.front().p);
    covered[0] = false;
  }
  for (std::size_t k = 0; k < placed.size(); ++k) {
    const Stretch& stretch = placed[k].stretch;
    whole.points.insert(whole.points.end(), stretch.begin(), stretch.end());
    if (k + 1 < placed.size())
      whole.fill(placed[k].end, placed[k + 1].begin, stretch.back().p,
                 placed[k + 1].stretch.front().p);
  }
  if (model.closed) {
    whole.fill(back.end, first.begin + last + 1, back.stretch.back().p, first.stretch.front().p);
    border.closed = true;
    covered = {false, false};
  } else if (covered[1] && length_between(model, back.end, last) > least) {
    whole.fill(back.end, last, back.stretch.back().p, std::nullopt);
    covered[1] = false;
  }
  border.stretches = {std::move(whole.points)};
  border.covered = covered;
  if (whole.added > 0) guesses_.push_back({view_.strokes[border.stroke].id, from, whole.added});
  return whole.added > 0;
}

/// Every point to the nearest one of the model.
void put_onto(const PictureCurve& model, PartialBorder& border) {
  for (Stretch& stretch : border.stretches)
    for (BorderPoint& point : stretch) point.p = point_at(model, nearest_place(model, point.p).at);
}

/// From a border that a drawn ruling joins it to.
bool BorderCompletion::copy_neighbour(int number, bool only_whole) {
  const std::vector<Eigen::Vector2d> seen = seen_points(borders_[number]);
  std::optional<ParallelCopy> best;
  int from = -1;
  for (int other = 0; other < std::ssize(borders_); ++other) {
    const PartialBorder& neighbour = borders_[other];
    if (other == number || neighbour.stretches.size() != 1 || (only_whole && !neighbour.whole()))
      continue;
    const CopyHints hints = hints_between(other, number);
    if (hints.rulings.empty()) continue;
    if (neighbour.closed && !borders_[number].closed &&
        !(borders_[number].covered[0] && borders_[number].covered[1]))
      continue;
    const PictureCurve model = evenly(picture_of(neighbour.stretches.front(), neighbour.closed),
                                      kGuessSpacing * diagonal_);
    const std::optional<ParallelCopy> copy = fit_parallel_copy(model, seen, hints, noise_);
    if (!copy || copy->rms > kCoverReach * snap_ || (best && best->rms <= copy->rms)) continue;
    best = copy;
    from = other;
  }
  if (!best) return false;
  copy_pairs(from, number, *best);
  const PartialBorder& neighbour = borders_[from];
  PictureCurve model = picture_of(neighbour.stretches.front(), neighbour.closed);
  for (Eigen::Vector2d& p : model.points) p = (*best)(p);
  model = evenly(model, kGuessSpacing * best->scale * diagonal_);
  // Of two rims the larger is the surer one.
  if (model.closed && best->scale < 1 && best->rms <= kCopyNoise * noise_)
    put_onto(model, borders_[number]);
  return follow(number, model, "the parallel border '" + view_.strokes[neighbour.stroke].id + "'");
}

/// Whether an end of a pair lies on a border that has the panels which the pair names.
bool BorderCompletion::end_lies_on(const PartialBorder& border, const Stroke& pair,
                                   const Eigen::Vector2d& end) const {
  const std::vector<std::string> panels = panels_in(pair.panels);
  const bool named = std::all_of(panels.begin(), panels.end(), [&](const std::string& name) {
    return std::find(border.panels.begin(), border.panels.end(), name) != border.panels.end();
  });
  const double own = distance_to(border, end);
  if (!named || own > mark_reach_) return false;
  // Where others of the same panels are nearer, the pair belongs to them.
  return std::none_of(borders_.begin(), borders_.end(), [&](const PartialBorder& other) {
    return &other != &border && other.panels == border.panels && distance_to(other, end) < own;
  });
}

bool BorderCompletion::lies_on(const PartialBorder& border, const Stroke& pair) const {
  return end_lies_on(border, pair, pair.points.front()) &&
         end_lies_on(border, pair, pair.points.back());
}

bool BorderCompletion::joins(const PartialBorder& a, const PartialBorder& b,
                             const Stroke& pair) const {
  const Eigen::Vector2d &front = pair.points.front(), &back = pair.points.back();
  return (end_lies_on(a, pair, front) && end_lies_on(b, pair, back)) ||
         (end_lies_on(b, pair, front) && end_lies_on(a, pair, back));
}

/// The copy of a border that is its own mirror image is so too, in the same plane: pairs of one are
/// pairs of the other, where it has none. Not where pairs join the two: then they are each other's.
void BorderCompletion::copy_pairs(int whole, int copy, const ParallelCopy& map) {
  const auto says_more = [&](const Stroke& pair) {
    return lies_on(borders_[copy], pair) || joins(borders_[whole], borders_[copy], pair);
  };
  if (std::any_of(pairs_.begin(), pairs_.end(), says_more)) return;
  const Stroke& border = view_.strokes[borders_[copy].stroke];
  std::vector<Stroke> copies;
  std::copy_if(pairs_.begin(), pairs_.end(), std::back_inserter(copies),
               [&](const Stroke& pair) { return lies_on(borders_[whole], pair); });
  for (Stroke& pair : copies) {
    pair.id = border.id + "-" + pair.id;
    pair.panels = border.name;
    for (Eigen::Vector2d& p : pair.points) p = map(p);
  }
  pairs_.insert(pairs_.end(), copies.begin(), copies.end());
}

/// Both ends lie at ends of silhouettes that join it to others: the surface turns away there.
bool BorderCompletion::between_own_silhouettes(int number) const {
  const PartialBorder& border = borders_[number];
  const auto at_ruling = [&](const Eigen::Vector2d& end) {
    return std::any_of(rulings_.begin(), rulings_.end(), [&](const BorderRuling& r) {
      for (int k = 0; k < 2; ++k)
        if (r.border[k] == number && (r.end[k] - end).norm() <= mark_reach_) return true;
      return false;
    });
  };
  return at_ruling(border.stretches.front().front().p) &&
         at_ruling(border.stretches.back().back().p);
}

bool BorderCompletion::go_round(int number) {
  PartialBorder& border = borders_[number];
  if (border.closed || !border.covered[0] || !border.covered[1]) return false;
  const std::string where = "stroke '" + view_.strokes[border.stroke].id + "'";
  try {
    const EllipseFit own = fit_ellipse(seen_points(border), where);
    const double least = between_own_silhouettes(number) ? kRimBetweenSilhouettes : kRimSpan;
    if (own.rms > kCoverReach * snap_ || own.span < least) return false;
    PictureCurve model{{}, true};
    constexpr int kAround = 240;
    for (int k = 0; k < kAround; ++k)
      model.points.push_back(own.ellipse.point(kFullTurn * k / kAround));
    return follow(number, evenly(model, kGuessSpacing * diagonal_), "an ellipse");
  } catch (const Error&) {
    return false;  // no ellipse: another way is tried
  }
}

/// From the pairs whose two ends lie on the border.
std::optional<PictureMirror> BorderCompletion::mirror_of(const PartialBorder& border) const {
  std::vector<Eigen::Vector2d> middles;
  for (const Stroke& pair : pairs_)
    if (lies_on(border, pair)) middles.emplace_back((pair.points.front() + pair.points.back()) / 2);
  const Eigen::Vector2d u = plane_.normal.head<2>().normalized();
  return fit_picture_mirror(u, middles, kEndPart * diagonal_);
}

/// The part of its mirror image that lies beyond its covered end.
bool BorderCompletion::mirror_self(int number) {
  const PartialBorder& border = borders_[number];
  if (border.closed || border.stretches.size() != 1) return false;
  const std::optional<PictureMirror> mirror = mirror_of(border);
  if (!mirror) return false;
  const PictureCurve own =
      evenly(picture_of(border.stretches.front(), false), kGuessSpacing * diagonal_);
  PictureCurve image = own;
  double sum = 0;
  int overlap = 0;
  for (Eigen::Vector2d& p : image.points) {
    p = (*mirror)(p);
    const CurvePlace place = nearest_place(own, p);
    if (place.beyond) continue;
    sum += place.distance * place.distance;
    ++overlap;
  }
  if (overlap < 2 || std::sqrt(sum / overlap) > kCoverReach * snap_) return false;
  // The whole: the image up to where the border begins or ends, and the border.
  const bool at_back = border.covered[1];
  std::reverse(image.points.begin(), image.points.end());
  PictureCurve model{{}, false};
  const Eigen::Vector2d &front = own.points.front(), &back = own.points.back();
  const CurvePlace joint = nearest_place(image, at_back ? back : front);
  if (joint.beyond) return false;
  if (at_back) {
    model.points = own.points;
    for (double k = std::floor(joint.at) + 1; k < static_cast<double>(image.points.size()); k += 1)
      model.points.push_back(point_at(image, k));
  } else {
    for (double k = 0; k < joint.at; k += 1) model.points.push_back(point_at(image, k));
    model.points.insert(model.points.end(), own.points.begin(), own.points.end());
  }
  return follow(number, evenly(model, kGuessSpacing * diagonal_), "its mirror image");
}

/// Hermite's cubic between stretches, with the directions in which they end.
void BorderCompletion::join_by_cubics(PartialBorder& border) {
  const double part = kEndPart * diagonal_;
  Stretch whole = border.stretches.front();
  for (std::size_t k = 1; k < border.stretches.size(); ++k) {
    const Stretch& next = border.stretches[k];
    const Eigen::Vector2d p = whole.back().p, q = next.front().p;
    const double gap = (q - p).norm();
    const Eigen::Vector2d u = gap * direction_out(whole, true, part),
                          v = -gap * direction_out(next, false, part);
    const int count = std::max(1, static_cast<int>(gap / (kGuessSpacing * diagonal_)));
    for (int i = 1; i < count; ++i) {
      const double t = static_cast<double>(i) / count, s = 1 - t;
      whole.push_back(
          {s * s * (1 + 2 * t) * p + t * t * (1 + 2 * s) * q + t * s * (s * u - t * v), {}});
    }
    whole.insert(whole.end(), next.begin(), next.end());
    if (gap > 0)
      guesses_.push_back({view_.strokes[border.stroke].id, "both sides of the gap", gap});
  }
  border.stretches = {std::move(whole)};
}

/// Every border in every way, those first that are surest: whole neighbours, ellipses, mirror
/// images, neighbours that are not whole.
void BorderCompletion::complete_all() {
  const bool copies = completion_ != Completion::mirror;
  const bool mirrors = completion_ != Completion::parallel;
  using Way = bool (*)(BorderCompletion&, int, bool, bool);
  const std::array<Way, 4> ways{
      [](BorderCompletion& c, int b, bool copy, bool) { return copy && c.copy_neighbour(b, true); },
      [](BorderCompletion& c, int b, bool copy, bool) { return copy && c.go_round(b); },
      [](BorderCompletion& c, int b, bool, bool mirror) { return mirror && c.mirror_self(b); },
      [](BorderCompletion& c, int b, bool copy, bool) {
        return copy && c.copy_neighbour(b, false);
      }};
  for (std::size_t w = 0; w < ways.size();) {
    bool changed = false;
    for (int b = 0; b < std::ssize(borders_) && !changed; ++b)
      changed = !borders_[b].whole() && ways[w](*this, b, copies, mirrors);
    w = changed ? 0 : w + 1;
  }
  for (PartialBorder& border : borders_)
    if (border.stretches.size() > 1) join_by_cubics(border);
}

std::vector<std::array<int, 2>> BorderCompletion::parallel_borders() {
  if (rulings_.empty()) find_rulings();
  std::vector<std::array<int, 2>> copies;
  for (int a = 0; a < std::ssize(borders_); ++a) {
    for (int b = 0; b < std::ssize(borders_); ++b) {
      if (a == b || borders_[a].stretches.size() != 1 || borders_[b].stretches.size() != 1)
        continue;
      const CopyHints hints = hints_between(a, b);
      const std::array<int, 2> other{borders_[b].stroke, borders_[a].stroke};
      if (hints.rulings.empty() || std::find(copies.begin(), copies.end(), other) != copies.end())
        continue;
      const PictureCurve whole =
          evenly(picture_of(borders_[a].stretches.front(), borders_[a].closed),
                 2 * kGuessSpacing * diagonal_);
      const std::optional<ParallelCopy> copy =
          fit_parallel_copy(whole, seen_points(borders_[b]), {hints.rulings, {}}, noise_);
      if (copy && copy->rms <= copy_evidence_)
        copies.push_back({borders_[a].stroke, borders_[b].stroke});
    }
  }
  return copies;
}

/// A flat panel whose borders end to end leave two ends open gets a straight border between them.
void BorderCompletion::close_panels(CompletedView& out) const {
  std::map<std::string, std::vector<const PartialBorder*>> members;
  for (const PartialBorder& border : borders_)
    for (const std::string& name : border.panels) members[name].push_back(&border);
  for (const auto& [name, borders] : members) {
    if (name.rfind("flat", 0) != 0) continue;
    std::vector<Eigen::Vector2d> ends;
    bool closed = false;
    for (const PartialBorder* border : borders) {
      closed = closed || border->closed;
      ends.push_back(border->stretches.front().front().p);
      ends.push_back(border->stretches.front().back().p);
    }
    if (closed) continue;
    std::vector<Eigen::Vector2d> open;
    for (std::size_t e = 0; e < ends.size(); ++e) {
      bool met = false;
      for (std::size_t f = 0; f < ends.size(); ++f)
        met = met || (f / 2 != e / 2 && (ends[e] - ends[f]).norm() <= snap_);
      if (!met) open.push_back(ends[e]);
    }
    if (open.size() != 2 || (open[0] - open[1]).norm() <= snap_) continue;
    Stroke line;
    line.id = name + "-closing";
    line.kind = StrokeKind::border;
    line.name = name;
    constexpr int kPoints = 24;
    for (int k = 0; k <= kPoints; ++k)
      line.points.emplace_back(open[0] + (open[1] - open[0]) * (static_cast<double>(k) / kPoints));
    Stroke hidden = line;
    hidden.id += "-hidden";
    hidden.kind = StrokeKind::occlusion;
    hidden.name.clear();
    out.guesses.push_back({name, "a straight line", length(line)});
    for (Stroke& stroke : std::array<Stroke, 2>{line, hidden}) {
      out.places.emplace_back(stroke.points.size());
      out.view.strokes.push_back(std::move(stroke));
    }
  }
}

/// Borders in the place of their first strokes, other strokes as they were, and one occlusion for
/// each stretch that is guessed.
void BorderCompletion::put_strokes(CompletedView& out) const {
  std::vector<Stroke> hidden;
  std::map<int, int> number_of;  // strokes of the drawing in the result
  for (int s = 0; s < std::ssize(view_.strokes); ++s) {
    Stroke stroke = view_.strokes[s];
    std::vector<DrawnPlace> places;
    if (stroke.kind != StrokeKind::border || stroke.points.size() < 2) {
      for (std::size_t k = 0; k < stroke.points.size(); ++k)
        places.push_back({s, static_cast<double>(k)});
    } else {
      const auto border = std::find_if(borders_.begin(), borders_.end(),
                                       [&](const PartialBorder& b) { return b.stroke == s; });
      if (border == borders_.end()) continue;  // it is part of another
      stroke.points.clear();
      stroke.closed = border->closed;
      Stroke run;
      run.kind = StrokeKind::occlusion;
      int number = 0;
      const Stretch& points = border->stretches.front();
      for (std::size_t k = 0; k <= points.size(); ++k) {
        const bool guessed = k < points.size() && points[k].place.stroke < 0;
        if (k < points.size()) {
          stroke.points.push_back(points[k].p);
          places.push_back(points[k].place);
        }
        if (guessed) {
          run.points.push_back(points[k].p);
          continue;
        }
        run.id = stroke.id + "-hidden-" + std::to_string(number + 1);
        if (run.points.size() > 1) {
          hidden.push_back(run);
          ++number;
        }
        run.points.clear();
      }
    }
    out.places.push_back(std::move(places));
    number_of[s] = static_cast<int>(out.view.strokes.size());
    out.view.strokes.push_back(std::move(stroke));
  }
  for (std::array<int, 2>& copy : out.copies)
    for (int& stroke : copy) stroke = number_of.at(stroke);
  hidden.insert(hidden.end(), pairs_.begin() + static_cast<std::ptrdiff_t>(drawn_pairs_),
                pairs_.end());
  for (Stroke& stroke : hidden) {
    out.places.emplace_back(stroke.points.size());
    out.view.strokes.push_back(std::move(stroke));
  }
}

CompletedView BorderCompletion::complete() {
  find_rulings();
  find_covered_ends();
  join_stretches();
  drop_crumbs();
  find_rulings();
  complete_all();
  CompletedView out;
  out.view.kind = view_.kind;
  out.view.picture = view_.picture;
  out.guesses = guesses_;
  out.copies = parallel_borders();
  put_strokes(out);
  close_panels(out);
  for (const Stroke& stroke : view_.strokes)
    if (stroke.kind == StrokeKind::border) out.drawn_length += length(stroke);
  for (const GuessedStretch& guess : out.guesses) out.guessed_length += guess.length;
  for (const PartialBorder& border : borders_)
    if (!border.whole()) out.open_ends.push_back(view_.strokes[border.stroke].id);
  return out;
}

CompletedView as_drawn(const View& view) {
  CompletedView out;
  out.view = view;
  for (int s = 0; s < std::ssize(view.strokes); ++s) {
    std::vector<DrawnPlace> places;
    for (std::size_t k = 0; k < view.strokes[s].points.size(); ++k)
      places.push_back({s, static_cast<double>(k)});
    out.places.push_back(std::move(places));
    if (view.strokes[s].kind == StrokeKind::border) out.drawn_length += length(view.strokes[s]);
  }
  return out;
}

}  // namespace

DrawnPlace CompletedView::place(int stroke, double at) const {
  const std::vector<DrawnPlace>& of = places[static_cast<std::size_t>(stroke)];
  const double low = std::floor(at);
  const DrawnPlace& a = of[static_cast<std::size_t>(low) % of.size()];
  if (at == low || a.stroke < 0) return a;
  const DrawnPlace& b = of[(static_cast<std::size_t>(low) + 1) % of.size()];
  if (b.stroke != a.stroke) return {};
  // The last point of a closed stroke is followed by its first.
  const double step = std::abs(b.at - a.at) > 1 ? 1 : b.at - a.at;
  return {a.stroke, a.at + (at - low) * step};
}

CompletedView complete_borders(const View& view, const MirrorPlane& plane, double snap,
                               Completion completion, double noise) {
  const bool marked = !strokes_of(view, StrokeKind::occlusion).empty();
  CompletedView drawn = as_drawn(view);
  if (completion == Completion::none || !(drawn.drawn_length > 0)) return drawn;
  if (marked) {
    drawn.copies = BorderCompletion(view, plane, snap, completion, noise).parallel_borders();
    return drawn;
  }
  CompletedView completed = BorderCompletion(view, plane, snap, completion, noise).complete();
  if (!completed.guesses.empty()) return completed;
  drawn.open_ends = std::move(completed.open_ends);
  drawn.copies = BorderCompletion(view, plane, snap, completion, noise).parallel_borders();
  return drawn;
}

std::string completion_note(const CompletedView& completed) {
  if (completed.guesses.empty()) return "";
  std::array<char, 80> share{};
  std::snprintf(
      share.data(), share.size(), "%.0f %% of the length of all borders",
      100 * completed.guessed_length / (completed.drawn_length + completed.guessed_length));
  std::string text = "hidden parts of borders are guessed, " + std::string(share.data()) + ":";
  for (std::size_t k = 0; k < completed.guesses.size(); ++k) {
    const GuessedStretch& guess = completed.guesses[k];
    text += (k > 0 ? ", '" : " '") + guess.border + "' from " + guess.from;
  }
  return text;
}

}  // namespace geoprior::sketch
