#include "experiments/sketch/drawing/drawing_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace geoprior::sketch {
namespace {

constexpr int kHeights = 64;

/// Widths of a silhouette at heights from the ground up, over the largest.
std::array<double, kHeights> width_profile(const Stroke& silhouette, double height) {
  std::array<double, kHeights> widths{};
  for (int h = 0; h < kHeights; ++h) {
    const double y = height * (h + 0.5) / kHeights;
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t i = 0; i < silhouette.points.size(); ++i) {
      const Eigen::Vector2d& a = silhouette.points[i];
      const Eigen::Vector2d& b = silhouette.points[(i + 1) % silhouette.points.size()];
      if ((a.y() > y) == (b.y() > y)) continue;
      const double x = a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      left = std::min(left, x);
      right = std::max(right, x);
    }
    widths[h] = std::max(0.0, right - left);
  }
  const double widest = *std::max_element(widths.begin(), widths.end());
  for (double& width : widths) width = widest > 0 ? width / widest : 0;
  return widths;
}

struct HeightRange {
  const Stroke* border = nullptr;
  double low = 0, high = 0;
};

std::vector<HeightRange> border_heights(const View& view) {
  std::vector<HeightRange> ranges;
  for (const Stroke* border : strokes_of(view, StrokeKind::border)) {
    if (border->inside) continue;
    HeightRange range{border, std::numeric_limits<double>::infinity(), 0};
    range.high = -range.low;
    for (const Eigen::Vector2d& p : border->points) {
      range.low = std::min(range.low, p.y());
      range.high = std::max(range.high, p.y());
    }
    ranges.push_back(range);
  }
  return ranges;
}

bool has_partner(const HeightRange& one, const std::vector<HeightRange>& others, double near) {
  return std::any_of(others.begin(), others.end(), [&](const HeightRange& other) {
    return one.low <= other.high + near && other.low <= one.high + near;
  });
}

std::vector<HeightRange> turned_over(std::vector<HeightRange> ranges, double height) {
  for (HeightRange& range : ranges) {
    const double low = height - range.high;
    range.high = height - range.low;
    range.low = low;
  }
  return ranges;
}

/// Borders of `view` that have no partner in the other one; once for all where that has none.
void warn_of_lone_borders(const std::string& drawing, ViewKind view, ViewKind other,
                          const std::vector<HeightRange>& borders,
                          const std::vector<HeightRange>& others, double near,
                          std::vector<std::string>& warnings) {
  if (others.empty() && borders.size() > 1) {
    warnings.push_back(drawing + ": view:" + view_name(view) + ": stroke '" +
                       borders.front().border->id + "' and " + std::to_string(borders.size() - 1) +
                       " more are borders, and view:" + view_name(other) +
                       " has none: draw the rim in every view that shows it");
    return;
  }
  for (const HeightRange& range : borders) {
    if (has_partner(range, others, near)) continue;
    std::array<char, 160> text;
    std::snprintf(text.data(), text.size(), " between heights %.4g mm and %.4g mm, and view:%s ",
                  1e3 * range.low, 1e3 * range.high, view_name(other));
    warnings.push_back(drawing + ": view:" + view_name(view) + ": stroke '" + range.border->id +
                       "' is a border" + text.data() +
                       "has none there: draw the rim in every view that shows it");
  }
}

/// Borders at opposite ends, or widths that agree only when one view is turned over.
bool are_turned_over(const Stroke& front, const Stroke& side, double height,
                     const std::vector<HeightRange>& front_borders,
                     const std::vector<HeightRange>& side_borders, double near) {
  const auto all_meet = [&](const std::vector<HeightRange>& others) {
    return std::all_of(front_borders.begin(), front_borders.end(),
                       [&](const HeightRange& one) { return has_partner(one, others, near); });
  };
  const bool both = !front_borders.empty() && !side_borders.empty();
  const bool upright = both && all_meet(side_borders);
  if (both && !upright && all_meet(turned_over(side_borders, height))) return true;
  if (upright) return false;
  const auto f = width_profile(front, height), s = width_profile(side, height);
  double as_drawn = 0, turned = 0;
  for (int h = 0; h < kHeights; ++h) {
    as_drawn += std::abs(f[h] - s[h]) / kHeights;
    turned += std::abs(f[h] - s[kHeights - 1 - h]) / kHeights;
  }
  constexpr double kMuchBetter = 0.4, kLeast = 0.06;
  return turned < kMuchBetter * as_drawn && as_drawn - turned > kLeast;
}

}  // namespace

std::vector<std::string> doubtful_views(const Drawing& aligned) {
  std::vector<std::string> warnings;
  bool open = false;
  for (const View& view : aligned.views) {
    open = open || !strokes_of(view, StrokeKind::border).empty() ||
           !strokes_of(view, StrokeKind::seam).empty();
  }
  if (!open) {
    warnings.push_back(aligned.name +
                       ": no view has a border or a seam: the whole surface is one closed piece, "
                       "which cannot be laid flat, and is cut open where the program finds it "
                       "shortest; draw a border (blue) where it is open, or seams (red)");
  }
  const View *front = aligned.find(ViewKind::front), *side = aligned.find(ViewKind::side);
  if (front == nullptr || side == nullptr) return warnings;
  const std::vector<const Stroke*> outline = strokes_of(*front, StrokeKind::silhouette);
  const std::vector<const Stroke*> flank = strokes_of(*side, StrokeKind::silhouette);
  if (outline.size() != 1 || flank.size() != 1) return warnings;
  double height = 0;
  for (const Eigen::Vector2d& p : outline[0]->points) height = std::max(height, p.y());
  const double near = 0.05 * height;
  const std::vector<HeightRange> of_front = border_heights(*front), of_side = border_heights(*side);
  if (are_turned_over(*outline[0], *flank[0], height, of_front, of_side, near)) {
    warnings.push_back(aligned.name +
                       ": view:front and view:side fit each other only when one of them is turned "
                       "upside down: the silhouettes are '" +
                       outline[0]->id + "' and '" + flank[0]->id + "'");
    return warnings;
  }
  warn_of_lone_borders(aligned.name, ViewKind::front, ViewKind::side, of_front, of_side, near,
                       warnings);
  warn_of_lone_borders(aligned.name, ViewKind::side, ViewKind::front, of_side, of_front, near,
                       warnings);
  return warnings;
}

}  // namespace geoprior::sketch
