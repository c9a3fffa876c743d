#include "solvers/sketch/hidden/hidden_borders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/planar.h"
#include "models/sketch/drawing/ellipse_fit.h"
#include "solvers/sketch/hidden/border_models.h"
#include "solvers/sketch/hidden/completed_view.h"
#include "solvers/sketch/hidden/seen_borders.h"

namespace geoprior::sketch {
namespace {

/// Of the snapping distance: a guess agrees with what is seen to it.
constexpr double kGuessReach = 2;
/// Spacing of guesses over the drawing's diagonal.
constexpr double kGuessSpacing = 1.0 / 150;
/// To which a border is the parallel copy of another, over the diagonal and in deviations of the
/// noise.
constexpr double kCopyEvidence = 0.005;
constexpr double kCopyNoise = 2;
/// What must be seen of a rim that goes round: five ninths of its ellipse, or 130 degrees of it
/// between silhouettes of its own panel.
constexpr double kRimSpan = 200 * kDegree;
constexpr double kRimBetweenSilhouettes = 130 * kDegree;

class BorderCompletion {
 public:
  BorderCompletion(const View& view, const MirrorPlane& plane, Completion completion, double noise,
                   SeenBorders seen);
  CompletedView complete();
  /// Strokes of the drawing.
  [[nodiscard]] std::vector<std::array<int, 2>> parallel_borders();

 private:
  void complete_all();
  bool copy_neighbour(int border, bool only_whole);
  bool go_round(int border);
  bool mirror_self(int border);
  void join_by_cubics(PartialBorder& border);
  bool follow(int border, const PictureCurve& model, const std::string& from);

  void copy_pairs(int whole, int copy, const ParallelCopy& map);
  [[nodiscard]] bool end_lies_on(const PartialBorder& border, const Stroke& pair,
                                 const Eigen::Vector2d& end) const;
  [[nodiscard]] bool lies_on(const PartialBorder& border, const Stroke& pair) const;
  [[nodiscard]] bool joins(const PartialBorder& a, const PartialBorder& b,
                           const Stroke& pair) const;
  [[nodiscard]] std::vector<Eigen::Vector2d> seen_points(const PartialBorder& border) const;
  [[nodiscard]] CopyHints hints_between(int whole, int copy) const;
  [[nodiscard]] std::optional<PictureMirror> mirror_of(const PartialBorder& border) const;
  [[nodiscard]] bool between_own_silhouettes(int border) const;

  const View& view_;
  MirrorPlane plane_;
  Completion completion_;
  double noise_;  ///< m
  double diagonal_, snap_, mark_reach_;
  std::vector<PartialBorder> borders_;
  std::vector<BorderRuling> rulings_;
  std::vector<GuessedStretch> guesses_;
  std::vector<Stroke> pairs_;  ///< drawn ones, then those of parallel copies
  std::size_t drawn_pairs_ = 0;
};

BorderCompletion::BorderCompletion(const View& view, const MirrorPlane& plane,
                                   Completion completion, double noise, SeenBorders seen)
    : view_(view),
      plane_(plane),
      completion_(completion),
      noise_(noise),
      diagonal_(seen.diagonal),
      snap_(seen.snap),
      mark_reach_(seen.mark_reach),
      borders_(std::move(seen.borders)),
      rulings_(std::move(seen.rulings)) {
  for (const Stroke* pair : strokes_of(view, StrokeKind::symmetric_pair))
    if (!pair->points.empty()) pairs_.push_back(*pair);
  drawn_pairs_ = pairs_.size();
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
    if (!copy || copy->rms > kGuessReach * snap_ || (best && best->rms <= copy->rms)) continue;
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
    return bounds(border.panels, name);
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
  const auto from_to = [&](const PartialBorder& from, const PartialBorder& to) {
    return end_lies_on(from, pair, front) && end_lies_on(to, pair, back) &&
           distance_to(from, front) < distance_to(to, front) &&
           distance_to(to, back) < distance_to(from, back);
  };
  return from_to(a, b) || from_to(b, a);
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
    if (own.rms > kGuessReach * snap_ || own.span < least) return false;
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
  if (overlap < 2 || std::sqrt(sum / overlap) > kGuessReach * snap_) return false;
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
  const double evidence = std::max(kCopyEvidence * diagonal_, kCopyNoise * noise_);
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
      if (copy && copy->rms <= evidence) copies.push_back({borders_[a].stroke, borders_[b].stroke});
    }
  }
  return copies;
}

CompletedView BorderCompletion::complete() {
  complete_all();
  CompletedView out;
  out.view.kind = view_.kind;
  out.view.picture = view_.picture;
  out.guesses = guesses_;
  out.copies = parallel_borders();
  put_strokes(view_, borders_,
              {pairs_.begin() + static_cast<std::ptrdiff_t>(drawn_pairs_), pairs_.end()}, out);
  close_panels(borders_, snap_, out);
  for (const Stroke& stroke : view_.strokes)
    if (stroke.kind == StrokeKind::border) out.drawn_length += length(stroke);
  for (const GuessedStretch& guess : out.guesses) out.guessed_length += guess.length;
  for (const PartialBorder& border : borders_)
    if (!border.whole()) out.open_ends.push_back(view_.strokes[border.stroke].id);
  return out;
}

}  // namespace

CompletedView complete_borders(const View& view, const MirrorPlane& plane, double snap,
                               Completion completion, double noise) {
  CompletedView drawn = as_drawn(view);
  if (completion == Completion::none || !(drawn.drawn_length > 0)) return drawn;
  if (strokes_of(view, StrokeKind::occlusion).empty()) {
    const SeenBorders seen = seen_borders(view, snap, noise);
    CompletedView completed = BorderCompletion(view, plane, completion, noise, seen).complete();
    if (!completed.guesses.empty()) return completed;
    drawn.open_ends = std::move(completed.open_ends);
  }
  const SeenBorders seen = borders_as_drawn(view, snap, noise);
  drawn.copies = BorderCompletion(view, plane, completion, noise, seen).parallel_borders();
  return drawn;
}

}  // namespace geoprior::sketch
