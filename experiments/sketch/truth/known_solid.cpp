#include "experiments/sketch/truth/known_solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace geoprior::sketch {
namespace {

using Points2 = std::vector<Eigen::Vector2d>;
using Points3 = std::vector<Eigen::Vector3d>;

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr std::array<std::string_view, 6> kSolidNames{"lampshade", "skirt",  "sleeve",
                                                      "cuff",      "mitten", "bag"};

/// A surface over (angle, height), both from 0 to 1.
using Patch = std::function<Eigen::Vector3d(double, double)>;
using Inside = std::function<bool(const Eigen::Vector3d&)>;

/// Area of a patch without what is inside of another solid, by the cross product of its chords.
double patch_area(const Patch& patch, const Inside& hidden = {}) {
  constexpr int kAround = 720, kUp = 480;
  double area = 0;
  for (int i = 0; i < kAround; ++i) {
    for (int j = 0; j < kUp; ++j) {
      const double u = 1.0 * i / kAround, v = 1.0 * j / kUp, du = 1.0 / kAround, dv = 1.0 / kUp;
      if (hidden && hidden(patch(u + 0.5 * du, v + 0.5 * dv))) continue;
      const Eigen::Vector3d a = patch(u + du, v + dv) - patch(u, v);
      const Eigen::Vector3d b = patch(u, v + dv) - patch(u + du, v);
      area += 0.5 * a.cross(b).norm();
    }
  }
  return area;
}

Points3 sampled(const Patch& patch) {
  constexpr int kAround = 360, kUp = 120;
  Points3 points;
  for (int j = 0; j <= kUp; ++j) {
    for (int i = 0; i < kAround; ++i) points.push_back(patch(1.0 * i / kAround, 1.0 * j / kUp));
  }
  return points;
}

Points2 in_view(ViewKind kind, const Points3& points) {
  Points2 seen;
  for (const Eigen::Vector3d& x : points) seen.emplace_back((view_frame(kind) * x).head<2>());
  return seen;
}

/// Counter-clockwise (Andrew's monotone chain).
Points2 convex_hull(Points2 points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  Points2 hull;
  for (int turn = 0; turn < 2; ++turn) {
    const std::size_t first = hull.size();
    for (const Eigen::Vector2d& q : points) {
      while (hull.size() >= first + 2) {
        const Eigen::Vector2d a = hull.back() - hull[hull.size() - 2], b = q - hull.back();
        if (a.x() * b.y() - a.y() * b.x() > 1e-12) break;
        hull.pop_back();
      }
      hull.push_back(q);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

bool is_inside(const Points2& convex, const Eigen::Vector2d& q) {
  for (std::size_t i = 0; i < convex.size(); ++i) {
    const Eigen::Vector2d a = convex[(i + 1) % convex.size()] - convex[i], b = q - convex[i];
    if (a.x() * b.y() - a.y() * b.x() < 0) return false;
  }
  return true;
}

/// Of points of a closed polygon the run that is outside of another one.
Points2 run_outside(const Points2& polygon, const Points2& other) {
  const std::size_t n = polygon.size();
  std::size_t first = 0;
  while (first < n &&
         !(is_inside(other, polygon[(first + n - 1) % n]) && !is_inside(other, polygon[first])))
    ++first;
  Points2 run;
  for (std::size_t i = 0; i < n && !is_inside(other, polygon[(first + i) % n]); ++i)
    run.push_back(polygon[(first + i) % n]);
  return run;
}

/// The polygon with points at most `spacing` apart.
Points2 subdivided(const Points2& polygon, double spacing) {
  Points2 fine;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const int parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
    for (int k = 0; k < parts; ++k) fine.push_back(a + 1.0 * k / parts * (b - a));
  }
  return fine;
}

/// Union of two convex polygons whose borders cross twice.
Points2 joined(const Points2& a, const Points2& b) {
  constexpr double kSpacing = 2e-4;  // m
  Points2 outline = run_outside(subdivided(a, kSpacing), b);
  const Points2 rest = run_outside(subdivided(b, kSpacing), a);
  outline.insert(outline.end(), rest.begin(), rest.end());
  return outline;
}

Stroke stroke(std::string id, StrokeKind kind, Points2 points, bool closed) {
  Stroke drawn;
  drawn.id = std::move(id);
  drawn.kind = kind;
  drawn.points = std::move(points);
  drawn.closed = closed;
  return drawn;
}

/// The part of a convex silhouette that a rim's closed curve makes: what is drawn as a border.
Points2 rim_on(const Points2& silhouette, const Points2& rim) {
  const auto on_rim = [&](const Eigen::Vector2d& q) {
    return std::any_of(rim.begin(), rim.end(),
                       [&](const Eigen::Vector2d& r) { return (r - q).norm() < 1e-9; });
  };
  const std::size_t n = silhouette.size();
  std::size_t first = 0;
  while (first < n && !(on_rim(silhouette[first]) && !on_rim(silhouette[(first + n - 1) % n])))
    ++first;
  Points2 run;
  for (std::size_t i = 0; i < n && on_rim(silhouette[(first + i) % n]); ++i)
    run.push_back(silhouette[(first + i) % n]);
  return run;
}

/// Views of a convex tube: `patch` at height 0 and, if it is open there too, at height 1 are rims.
Drawing drawn_tube(const Patch& patch, bool open_above, bool third_view) {
  Drawing drawing{"known solid", {}};
  const Points3 all = sampled(patch);
  std::vector<std::pair<std::string, Points3>> rims;
  for (const double height : {0.0, 1.0}) {
    if (height > 0 && !open_above) break;
    Points3 rim;
    for (int i = 0; i < 360; ++i) rim.push_back(patch(i / 360.0, height));
    rims.emplace_back(height > 0 ? "upper-rim" : "lower-rim", std::move(rim));
  }
  for (const ViewKind kind : {ViewKind::front, ViewKind::side, ViewKind::top}) {
    if (kind == ViewKind::top && !third_view) continue;
    const Points2 outline = convex_hull(in_view(kind, all));
    View view{kind, {stroke("outline", StrokeKind::silhouette, outline, true)}};
    for (const auto& [id, rim] : rims) {
      Points2 drawn = rim_on(outline, in_view(kind, rim));
      if (drawn.size() >= 2 && drawn.size() < outline.size())
        view.strokes.push_back(stroke(id, StrokeKind::border, std::move(drawn), false));
    }
    drawing.views.push_back(std::move(view));
  }
  return drawing;
}

/// Ellipses at heights from 0 to `height`, of half widths (x, z) at shares of it.
Patch stacked_ellipses(double height, std::function<Eigen::Vector2d(double)> half_widths) {
  return [height, half_widths = std::move(half_widths)](double u, double v) {
    const Eigen::Vector2d r = half_widths(v);
    return Eigen::Vector3d(r.x() * std::cos(kTwoPi * u), height * v, r.y() * std::sin(kTwoPi * u));
  };
}

/// Frustum of a cone about an axis in the plane z = 0.
Patch tilted_frustum(double lower, double upper, double length, double tilt_deg) {
  const double tilt = tilt_deg * std::numbers::pi / 180;
  const Eigen::Vector3d axis(std::cos(tilt), std::sin(tilt), 0), across(-axis.y(), axis.x(), 0);
  return [=](double u, double v) -> Eigen::Vector3d {
    const double r = lower + v * (upper - lower);
    return v * length * axis + r * std::cos(kTwoPi * u) * across +
           r * std::sin(kTwoPi * u) * Eigen::Vector3d::UnitZ();
  };
}

double frustum_area(double lower, double upper, double length) {
  return std::numbers::pi * (lower + upper) * std::hypot(length, upper - lower);
}

KnownSolid drawn_skirt(bool third_view) {
  const Patch skirt = stacked_ellipses(0.6, [](double v) -> Eigen::Vector2d {
    const double flare = (1 - v) * (1 - v);  // 1 at the hem, 0 at the waist
    return {0.15 + 0.14 * flare, 0.11 + 0.16 * flare};
  });
  // The outline bends inwards: its points are those of the profile.
  KnownSolid solid{drawn_tube(skirt, true, third_view), patch_area(skirt)};
  for (View& view : solid.drawing.views) {
    if (view.kind == ViewKind::top) continue;
    Points2 outline;
    constexpr int kUp = 200;
    const double quarter = view.kind == ViewKind::front ? 0 : 0.25;
    for (int j = 0; j <= kUp; ++j)
      outline.push_back(in_view(view.kind, {skirt(quarter, 1.0 * j / kUp)})[0]);
    for (int j = kUp; j >= 0; --j)
      outline.push_back(in_view(view.kind, {skirt(quarter + 0.5, 1.0 * j / kUp)})[0]);
    view.strokes[0].points = std::move(outline);
  }
  return solid;
}

/// A hand of elliptic sections and a thumb: half a ball on a cylinder that begins inside.
KnownSolid drawn_mitten(bool third_view) {
  constexpr double kHeight = 0.24, kStraight = 0.75;  // m; share of it below the tip
  const Patch hand = stacked_ellipses(kHeight, [](double v) -> Eigen::Vector2d {
    const double tip = std::max(0.0, (v - kStraight) / (1 - kStraight));
    const double close = std::sqrt(std::max(0.0, 1 - tip * tip));
    return {0.05 * close, 0.027 * close};
  });
  const Eigen::Vector3d root(0.025, 0.07, 0), along = Eigen::Vector3d(0.62, 0.78, 0).normalized();
  constexpr double kRadius = 0.019, kLength = 0.075;  // m
  const Eigen::Vector3d across(-along.y(), along.x(), 0);
  const Patch thumb = [=](double u, double v) -> Eigen::Vector3d {
    const double cap = std::max(0.0, 2 * v - 1) * std::numbers::pi / 2;
    const double way = v < 0.5 ? 2 * v * kLength : kLength + kRadius * std::sin(cap);
    const double r = kRadius * std::cos(cap);
    return root + way * along + r * std::cos(kTwoPi * u) * across +
           r * std::sin(kTwoPi * u) * Eigen::Vector3d::UnitZ();
  };
  const Inside in_hand = [=](const Eigen::Vector3d& x) {
    if (x.y() < 0 || x.y() > kHeight) return false;
    const double tip = std::max(0.0, (x.y() / kHeight - kStraight) / (1 - kStraight));
    const double close = 1 - tip * tip;
    return std::pow(x.x() / 0.05, 2) + std::pow(x.z() / 0.027, 2) < close;
  };
  const Inside in_thumb = [=](const Eigen::Vector3d& x) {
    const double way = std::clamp((x - root).dot(along), 0.0, kLength);
    return (x - root - way * along).norm() < kRadius && (x - root).dot(along) > 0;
  };
  KnownSolid solid{drawn_tube(hand, false, third_view),
                   patch_area(hand, in_thumb) + patch_area(thumb, in_hand)};
  for (View& view : solid.drawing.views) {
    if (view.kind == ViewKind::side) continue;  // the thumb is thinner than the hand
    view.strokes[0].points =
        joined(view.strokes[0].points, convex_hull(in_view(view.kind, sampled(thumb))));
  }
  return solid;
}

KnownSolid drawn_bag(bool third_view) {
  constexpr double kWidth = 0.3, kHeight = 0.25, kDepth = 0.16;  // m
  const Patch bag = [](double u, double v) -> Eigen::Vector3d {
    const int corner = static_cast<int>(4 * u) % 4;
    constexpr std::array<std::array<double, 2>, 4> kCorners{{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
    return {0.5 * kWidth * kCorners[corner][0], kHeight * (1 - v),
            0.5 * kDepth * kCorners[corner][1]};
  };
  return {drawn_tube(bag, false, third_view), 2 * kHeight * (kWidth + kDepth) + kWidth * kDepth};
}

}  // namespace

void describe(OptionVisitor& v, KnownSolidOptions& o) {
  describe_choice(v, "shape", o.shape, kSolidNames, {.doc = "the thing that is drawn"});
  v.value("third_view", o.third_view,
          {.doc = "whether it is drawn from above too, not from the front and the side alone"});
}

KnownSolid known_solid(const KnownSolidOptions& options) {
  switch (options.shape) {
    case SolidShape::lampshade: {
      const Patch shade = stacked_ellipses(0.2, [](double v) -> Eigen::Vector2d {
        return Eigen::Vector2d::Constant(0.15 - 0.07 * v);
      });
      return {drawn_tube(shade, true, options.third_view), frustum_area(0.15, 0.08, 0.2)};
    }
    case SolidShape::skirt:
      return drawn_skirt(options.third_view);
    case SolidShape::sleeve:
      return {drawn_tube(tilted_frustum(0.09, 0.06, 0.45, -35), true, options.third_view),
              frustum_area(0.09, 0.06, 0.45)};
    case SolidShape::cuff: {
      const Patch cuff = stacked_ellipses(0.08, [](double) -> Eigen::Vector2d {
        return {0.06, 0.045};
      });
      return {drawn_tube(cuff, true, options.third_view), patch_area(cuff)};
    }
    case SolidShape::mitten:
      return drawn_mitten(options.third_view);
    case SolidShape::bag:
      break;
  }
  return drawn_bag(options.third_view);
}

}  // namespace geoprior::sketch
