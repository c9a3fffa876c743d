#include "experiments/sketch/hand/hand_drawn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "experiments/sketch/drawing/drawn_stroke.h"
#include "experiments/sketch/hand/fair_stroke.h"
#include "experiments/sketch/hand/join_strokes.h"
#include "models/sketch/drawing/outline.h"
#include "models/sketch/drawing/polyline.h"

namespace geoprior::sketch {
namespace {

std::string formatted(const char* format, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

/// Arc length of the sharpest corner of the outline near to a place of it, or that place.
/// @param scale  length of the sides that a corner is told by (m)
double corner_near(const Outline& outline, double at, double near, double scale) {
  constexpr double kCorner = 0.6;  // rad
  const double whole = outline.length();
  double best = at, sharpest = kCorner;
  for (int i = 0; i < std::ssize(outline.points()); ++i) {
    const double s = outline.arc_length(i);
    if (std::abs(std::remainder(s - at, whole)) > near) continue;
    const Eigen::Vector2d here = outline.points()[i];
    const double turn =
        std::abs(signed_angle(here - outline.at(s - scale), outline.at(s + scale) - here));
    if (turn > sharpest) {
      sharpest = turn;
      best = s;
    }
  }
  return best;
}

/// The outline from one arc length on to another, counter-clockwise.
std::vector<Eigen::Vector2d> stretch_of(const Outline& outline, double from, double to) {
  const double whole = outline.length();
  const auto wrapped = [&](double s) { return s - whole * std::floor(s / whole); };
  const double span = wrapped(to - from);
  std::vector<std::pair<double, Eigen::Vector2d>> inner;
  for (int i = 0; i < std::ssize(outline.points()); ++i) {
    const double along = wrapped(outline.arc_length(i) - from);
    if (along > 1e-9 * whole && along < span - 1e-9 * whole)
      inner.emplace_back(along, outline.points()[i]);
  }
  std::sort(inner.begin(), inner.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Eigen::Vector2d> points{outline.at(from)};
  for (const auto& [along, point] : inner) points.push_back(point);
  points.push_back(outline.at(to));
  return points;
}

}  // namespace

std::string HandDrawnView::share_text(double metres) const {
  return formatted("%.2g mm", 1e3 * metres) +
         formatted(" (%.2g %% of the view's diagonal)", 100 * metres / diagonal_);
}

bool HandDrawnView::fair(Stroke& stroke, int changes, std::vector<std::string>& notes) const {
  if (!options_.fairing) return false;
  std::optional<FairedStroke> faired = fair_stroke(stroke.points, stroke.closed, changes);
  constexpr double kLeast = 1e-3;  // of the diagonal: less is no tremor but how it was written
  if (!faired || faired->noise < kLeast * diagonal_) return false;
  if (faired->noise > options_.noise * diagonal_) {
    throw Error("stroke '" + stroke.id + "' trembles by " + share_text(faired->noise) +
                    " (standard deviation)",
                where_,
                "at most " + formatted("%.2g %%", 100 * options_.noise) +
                    "; raise scene.read.noise, or set scene.read.fairing = false");
  }
  stroke.points = std::move(faired->points);
  notes.push_back("stroke '" + stroke.id + "' trembles by " + share_text(faired->noise) +
                  " (standard deviation), and is faired: moved by at most " +
                  share_text(faired->moved) + ", " + std::to_string(faired->corners.size()) +
                  " corners kept");
  return true;
}

void HandDrawnView::fair(Stroke& stroke) const {
  std::vector<std::string> notes;
  fair(stroke, trembles_ ? kChangesBesideTremor : kTremblingChanges, notes);
  for (const std::string& note : notes) warnings_.push_back(where_ + ": " + note);
}

HandDrawnView::Attempt HandDrawnView::attempt(const std::vector<Stroke>& strokes,
                                              double snap) const {
  Attempt made;
  made.loops = join_silhouettes(strokes, snap * diagonal_);
  if (made.loops.gap) return made;
  for (const SilhouetteGap& gap : made.loops.closed) {
    const double width = (gap.end - gap.next).norm();
    if (width <= kExactSnap * diagonal_) continue;
    made.notes.push_back("a gap between the ends of '" + gap.from + "' and '" + gap.to + "' at " +
                         place_text((gap.end + gap.next) / 2) + " is closed: each moved by " +
                         share_text(width / 2));
  }
  for (Stroke& loop : made.loops.loops) {
    if (loop.points.size() >= 3 && fair(loop, kTremblingChanges, made.notes)) made.trembles = true;
  }
  made.good = made.loops.loops.size() == 1 && made.loops.loops[0].points.size() >= 3 &&
              !self_crossing(made.loops.loops[0]);
  return made;
}

SilhouetteLoops HandDrawnView::silhouettes(const std::vector<Stroke>& strokes) {
  if (strokes.empty()) return {};
  const auto accepted = [&](Attempt& made) {
    for (const std::string& note : made.notes) warnings_.push_back(where_ + ": " + note);
    trembles_ = made.trembles;
    return std::move(made.loops);
  };
  Attempt exact = attempt(strokes, std::min(kExactSnap, options_.snap));
  if (exact.good) return accepted(exact);
  // More is no hand's work, and all pairs are compared.
  constexpr std::size_t kMostStrokes = 50, kMostPoints = 20000;
  std::size_t points = 0;
  for (const Stroke& stroke : strokes) points += stroke.points.size();
  if (strokes.size() > kMostStrokes || points > kMostPoints) return accepted(exact);
  const double near = options_.snap * diagonal_;
  const auto repaired = [&](std::vector<Stroke> single, std::vector<StrokeRepair> repairs) {
    for (StrokeRepair& repair : cut_overshoots(single, near)) repairs.push_back(std::move(repair));
    Attempt made = attempt(single, options_.snap);
    for (const StrokeRepair& repair : repairs) {
      made.notes.push_back("stroke '" + repair.id + "' " + repair.what + " at " +
                           place_text(repair.at) + ", by " + share_text(repair.moved));
    }
    return made;
  };
  Attempt loose = repaired(strokes, {});
  if (loose.good) return accepted(loose);
  std::vector<Stroke> single = strokes;
  std::vector<StrokeRepair> doubles = cut_double_strokes(single, near);
  Attempt without_doubles = repaired(std::move(single), std::move(doubles));
  if (without_doubles.good) return accepted(without_doubles);
  return accepted(exact.loops.gap ? loose : exact);
}

void HandDrawnView::lay_on_silhouette(Stroke& border, const Stroke& silhouette) const {
  if (silhouette.points.size() < 3 || border.points.size() < 2) return;
  const Outline outline(silhouette.points);
  std::vector<Eigen::Vector2d> line = border.points;
  if (border.closed) line.push_back(line.front());
  constexpr int kSamples = 64;
  constexpr double kOn = 1e-3;  // of the diagonal
  const double whole = length(line);
  double farthest = 0;
  for (int i = 0; i <= kSamples; ++i) {
    const Eigen::Vector2d at = point_along(line, whole * i / kSamples);
    farthest = std::max(farthest, std::abs(outline.nearest(at).distance));
  }
  if (farthest <= kOn * diagonal_ || farthest > options_.snap * diagonal_) return;
  if (border.closed) {
    border.points = outline.points();
  } else {
    const double near = options_.snap * diagonal_, scale = 0.02 * diagonal_;
    const double from = corner_near(outline, outline.nearest(line.front()).arc_length, near, scale);
    const double to = corner_near(outline, outline.nearest(line.back()).arc_length, near, scale);
    const double middle = outline.nearest(point_along(line, whole / 2)).arc_length;
    const auto after = [&](double s) {
      return s - from - outline.length() * std::floor((s - from) / outline.length());
    };
    if (after(middle) <= after(to)) {
      border.points = stretch_of(outline, from, to);
    } else {
      border.points = stretch_of(outline, to, from);
      std::reverse(border.points.begin(), border.points.end());
    }
  }
  warnings_.push_back(where_ + ": border '" + border.id +
                      "' runs beside the silhouette, and is laid onto it: moved by at most " +
                      share_text(farthest));
}

}  // namespace geoprior::sketch
