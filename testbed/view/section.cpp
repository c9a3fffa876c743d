#include "testbed/view/section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace geoprior {
namespace {

constexpr Rgb kInside{240, 224, 212};
constexpr Rgb kOverlap{214, 62, 50};
constexpr Rgb kInsideOut{70, 110, 190};
constexpr Rgb kCurve{60, 40, 34};
constexpr int kSupersampling = 4;

/// How a step to the right across the curve changes the winding number at height y.
int crossing(const SectionSegment& s, double y) {
  const bool from_above = s.from.y() > y;
  const bool to_above = s.to.y() > y;
  if (from_above == to_above) return 0;
  return to_above ? -1 : 1;  // the solid is left of an upward piece
}

double crossing_x(const SectionSegment& s, double y) {
  const double t = (y - s.from.y()) / (s.to.y() - s.from.y());
  return s.from.x() + t * (s.to.x() - s.from.x());
}

Rgb fill_color(int winding) {
  if (winding < 0) return kInsideOut;
  return winding == 1 ? kInside : kOverlap;
}

/// Segments in pixels: x to the right, y downwards from the top left corner.
std::vector<SectionSegment> to_pixels(const std::vector<SectionSegment>& segments,
                                      const ViewWindow& window, int width_px) {
  const double scale = width_px / window.width_m;
  const auto map = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector2d((p.x() + window.width_m / 2) * scale,
                           (window.height_m / 2 - p.y()) * scale);
  };
  std::vector<SectionSegment> out;
  out.reserve(segments.size());
  for (const SectionSegment& s : segments) out.push_back({map(s.from), map(s.to)});
  return out;
}

/// Adds to `row` how much of each pixel the spans of one sample line cover, by winding number.
struct Span {
  double begin;
  double end;
  int winding;
};

std::vector<Span> spans_at(const std::vector<SectionSegment>& segments, double y, double width) {
  std::vector<std::pair<double, int>> crossings;
  for (const SectionSegment& s : segments) {
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

void fill_line(Picture& picture, int y, const std::vector<SectionSegment>& segments) {
  struct Sum {
    std::array<double, 3> color{};
    double coverage = 0;
  };
  std::vector<Sum> row(picture.width);
  for (int sample = 0; sample < kSupersampling; ++sample) {
    const double height = y + (sample + 0.5) / kSupersampling;
    for (const Span& span : spans_at(segments, height, picture.width)) {
      const Rgb color = fill_color(span.winding);
      const int last = std::min(picture.width - 1, static_cast<int>(span.end));
      for (int x = static_cast<int>(span.begin); x <= last; ++x) {
        const double covered =
            (std::min(span.end, x + 1.0) - std::max(span.begin, double{1} * x)) / kSupersampling;
        Sum& sum = row[x];
        sum.coverage += covered;
        for (std::size_t c = 0; c < 3; ++c) sum.color[c] += covered * color[c];
      }
    }
  }
  for (int x = 0; x < picture.width; ++x) {
    const Sum& sum = row[x];
    for (std::size_t c = 0; c < 3; ++c) {
      const double mixed = sum.color[c] + (1 - sum.coverage) * 255;
      picture.at(x, y)[c] = static_cast<std::uint8_t>(std::lround(std::clamp(mixed, 0.0, 255.0)));
    }
  }
}

double distance_to(const SectionSegment& s, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = s.to - s.from;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - s.from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - s.from - t * along).norm();
}

/// Coverage of the stroked curve; the greatest over the segments, so that joints do not darken.
void stroke(Picture& picture, const std::vector<SectionSegment>& segments, double thickness) {
  std::vector<double> coverage(picture.pixels.size(), 0.0);
  const double reach = thickness / 2 + 1;
  for (const SectionSegment& s : segments) {
    const auto low = [&](double a, double b) {
      return std::max(0, static_cast<int>(std::min(a, b) - reach));
    };
    const auto high = [&](double a, double b, int size) {
      return std::min(size - 1, static_cast<int>(std::max(a, b) + reach));
    };
    for (int y = low(s.from.y(), s.to.y()); y <= high(s.from.y(), s.to.y(), picture.height); ++y) {
      for (int x = low(s.from.x(), s.to.x()); x <= high(s.from.x(), s.to.x(), picture.width); ++x) {
        const double d = distance_to(s, {x + 0.5, y + 0.5});
        double& c = coverage[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                             static_cast<std::size_t>(x)];
        c = std::max(c, std::clamp(thickness / 2 + 0.5 - d, 0.0, 1.0));
      }
    }
  }
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      picture.blend(x, y, kCurve,
                    coverage[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                             static_cast<std::size_t>(x)]);
    }
  }
}

}  // namespace

std::vector<SectionSegment> cut(const Part& part, const ViewWindow& window) {
  const Eigen::VectorXd height =
      (part.points.rowwise() - window.center.transpose()) * window.direction;
  const auto flat = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector2d((p - window.center).dot(window.right),
                           (p - window.center).dot(window.up));
  };
  std::vector<SectionSegment> segments;
  for (Eigen::Index t = 0; t < part.triangles.rows(); ++t) {
    std::vector<Eigen::Vector3d> ends;
    for (int i = 0; i < 3; ++i) {
      const int a = part.triangles(t, i);
      const int b = part.triangles(t, (i + 1) % 3);
      if ((height[a] >= 0) == (height[b] >= 0)) continue;
      const double f = height[a] / (height[a] - height[b]);
      ends.emplace_back((1 - f) * part.points.row(a) + f * part.points.row(b));
    }
    if (ends.size() != 2) continue;
    const Eigen::Vector3d p = part.points.row(part.triangles(t, 0));
    const Eigen::Vector3d q = part.points.row(part.triangles(t, 1));
    const Eigen::Vector3d r = part.points.row(part.triangles(t, 2));
    const Eigen::Vector3d outward = (q - p).cross(r - p);
    const Eigen::Vector3d along = window.direction.cross(outward);
    if (along.dot(ends[1] - ends[0]) < 0) std::swap(ends[0], ends[1]);
    segments.push_back({flat(ends[0]), flat(ends[1])});
  }
  return segments;
}

int winding_number(const std::vector<SectionSegment>& segments, const Eigen::Vector2d& point) {
  int winding = 0;
  for (const SectionSegment& s : segments) {
    if (const int sign = crossing(s, point.y())) {
      if (crossing_x(s, point.y()) < point.x()) winding += sign;
    }
  }
  return winding;
}

Picture draw_section(const std::vector<SectionSegment>& segments, const ViewWindow& window,
                     int width_px, int height_px) {
  Picture picture(width_px, height_px);
  const std::vector<SectionSegment> curve = to_pixels(segments, window, width_px);
  for (int y = 0; y < height_px; ++y) fill_line(picture, y, curve);
  stroke(picture, curve, std::max(1.5, height_px / 280.0));
  return picture;
}

}  // namespace geoprior
