#include "testbed/view/panel/plane_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace geoprior {
namespace {

constexpr int kSupersampling = 4;

/// How a step to the right across the curve changes the winding number at height y.
int crossing(const CurveSegment& s, double y) {
  const bool from_above = s.from.y() > y;
  const bool to_above = s.to.y() > y;
  if (from_above == to_above) return 0;
  return to_above ? -1 : 1;  // the solid is left of an upward piece
}

double crossing_x(const CurveSegment& s, double y) {
  const double t = (y - s.from.y()) / (s.to.y() - s.from.y());
  return s.from.x() + t * (s.to.x() - s.from.x());
}

/// Where a sample line is inside.
struct Span {
  double begin;
  double end;
  int winding;
};

std::vector<Span> spans_at(const std::vector<CurveSegment>& segments, double y, double width) {
  std::vector<std::pair<double, int>> crossings;
  for (const CurveSegment& s : segments) {
    // y points down here, which flips the sense of `crossing`.
    if (const int sign = -crossing(s, y)) crossings.emplace_back(crossing_x(s, y), sign);
  }
  std::sort(crossings.begin(), crossings.end());
  std::vector<Span> spans;
  int winding = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    winding += crossings[i].second;
    const double begin = std::clamp(crossings[i].first, 0.0, width);
    const double end = std::clamp(crossings[i + 1].first, 0.0, width);
    if (winding != 0 && end > begin) spans.push_back({begin, end, winding});
  }
  // An open surface does not come back to 0: its inside is not known on this line.
  if (!crossings.empty() && winding + crossings.back().second != 0) spans.clear();
  return spans;
}

void fill_line(Picture& picture, int y, const std::vector<CurveSegment>& segments,
               const std::function<Rgb(int)>& color) {
  struct Sum {
    std::array<double, 3> color{};
    double coverage = 0;
  };
  std::vector<Sum> row(picture.width);
  for (int sample = 0; sample < kSupersampling; ++sample) {
    const double height = y + (sample + 0.5) / kSupersampling;
    for (const Span& span : spans_at(segments, height, picture.width)) {
      const Rgb paint = color(span.winding);
      const int last = std::min(picture.width - 1, static_cast<int>(span.end));
      for (int x = static_cast<int>(span.begin); x <= last; ++x) {
        const double covered =
            (std::min(span.end, x + 1.0) - std::max(span.begin, double{1} * x)) / kSupersampling;
        Sum& sum = row[x];
        sum.coverage += covered;
        for (std::size_t c = 0; c < 3; ++c) sum.color[c] += covered * paint[c];
      }
    }
  }
  for (int x = 0; x < picture.width; ++x) {
    const Sum& sum = row[x];
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint8_t& channel = picture.at(x, y)[c];
      const double mixed = sum.color[c] + (1 - sum.coverage) * channel;
      channel = static_cast<std::uint8_t>(std::lround(std::clamp(mixed, 0.0, 255.0)));
    }
  }
}

double distance_to(const CurveSegment& s, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = s.to - s.from;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - s.from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - s.from - t * along).norm();
}

/// The pixels of one axis that something may touch.
struct PixelRange {
  int first;
  int last;
};

PixelRange touched(double a, double b, double reach, int size) {
  const double last = size - 1;
  return {static_cast<int>(std::clamp(std::min(a, b) - reach, 0.0, last + 1)),
          static_cast<int>(std::clamp(std::max(a, b) + reach, -1.0, last))};
}

/// How much of each pixel the lines cover; the greatest over the segments, so that joints do not
/// darken.
std::vector<double> stroke_coverage(const Picture& picture, const std::vector<CurveSegment>& pixels,
                                    double thickness) {
  std::vector<double> coverage(picture.pixels.size(), 0.0);
  const double reach = thickness / 2 + 1;
  for (const CurveSegment& s : pixels) {
    if (!s.from.allFinite() || !s.to.allFinite()) continue;
    const PixelRange rows = touched(s.from.y(), s.to.y(), reach, picture.height);
    const PixelRange columns = touched(s.from.x(), s.to.x(), reach, picture.width);
    for (int y = rows.first; y <= rows.last; ++y) {
      for (int x = columns.first; x <= columns.last; ++x) {
        const double d = distance_to(s, {x + 0.5, y + 0.5});
        double& c = coverage[static_cast<std::size_t>(y) * picture.width + x];
        c = std::max(c, std::clamp(thickness / 2 + 0.5 - d, 0.0, 1.0));
      }
    }
  }
  return coverage;
}

}  // namespace

Eigen::Vector2d to_pixels(const Eigen::Vector2d& point, const PlaneView& view,
                          const Picture& picture) {
  const Eigen::Vector2d p = view.pixels_per_metre * (point - view.center);
  return {picture.width / 2.0 + p.x(), picture.height / 2.0 - p.y()};
}

std::vector<CurveSegment> to_pixels(const std::vector<CurveSegment>& segments,
                                    const PlaneView& view, const Picture& picture) {
  std::vector<CurveSegment> out;
  out.reserve(segments.size());
  for (const CurveSegment& s : segments) {
    out.push_back({to_pixels(s.from, view, picture), to_pixels(s.to, view, picture)});
  }
  return out;
}

int winding_number(const std::vector<CurveSegment>& segments, const Eigen::Vector2d& point) {
  int winding = 0;
  for (const CurveSegment& s : segments) {
    if (const int sign = crossing(s, point.y())) {
      if (crossing_x(s, point.y()) < point.x()) winding += sign;
    }
  }
  return winding;
}

void fill(Picture& picture, const std::vector<CurveSegment>& pixels,
          const std::function<Rgb(int winding)>& color) {
  for (int y = 0; y < picture.height; ++y) fill_line(picture, y, pixels, color);
}

void stroke(Picture& picture, const std::vector<CurveSegment>& pixels, double thickness, Rgb color,
            double opacity) {
  const std::vector<double> coverage = stroke_coverage(picture, pixels, thickness);
  std::size_t i = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) picture.blend(x, y, color, opacity * coverage[i++]);
  }
}

std::vector<CurveSegment> dashes(const std::vector<Eigen::Vector2d>& line, double dash,
                                 double gap) {
  std::vector<CurveSegment> out;
  double left = dash;  // of the dash or gap that is being drawn
  bool on = true;
  for (std::size_t i = 1; i < line.size(); ++i) {
    Eigen::Vector2d at = line[i - 1];
    for (double way = (line[i] - at).norm(); way > 0;) {
      const double step = std::min(left, way);
      const Eigen::Vector2d next = at + step / way * (line[i] - at);
      if (on) out.push_back({at, next});
      at = next;
      way -= step;
      left -= step;
      if (left > 0) continue;
      on = !on;
      left = on ? dash : gap;
    }
  }
  return out;
}

void fill_disc(Picture& picture, const Eigen::Vector2d& center, double radius, Rgb color) {
  if (!center.allFinite()) return;
  const PixelRange rows = touched(center.y(), center.y(), radius + 1, picture.height);
  const PixelRange columns = touched(center.x(), center.x(), radius + 1, picture.width);
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      const double d = (Eigen::Vector2d(x + 0.5, y + 0.5) - center).norm();
      picture.blend(x, y, color, std::clamp(radius + 0.5 - d, 0.0, 1.0));
    }
  }
}

}  // namespace geoprior
