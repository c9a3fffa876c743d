#include "solvers/sketch/drawing/dense_matches.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/angles.h"
#include "core/error.h"

namespace geoprior::sketch {
namespace {

/// Of the length of all pairs: by which they miss the direction of the normal at most.
constexpr double kMostMiss = 0.04;

/// Of its chord: a stretch over less of u runs along the normal's image.
constexpr double kLevel = 0.12;

/// A drawn pair as places on two borders.
struct PairAnchor {
  double first = 0;
  double second = 0;
  int pair = -1;
};

/// Stretch of the first border from `begin` to `end`, and its image from `image_begin` to
/// `image_end`; either may run down. Numbers of closed borders go on past the last node.
struct MatchedStretch {
  double begin = 0;
  double end = 0;
  double image_begin = 0;
  double image_end = 0;
};

class StretchMatcher {
 public:
  StretchMatcher(const CurveNet& net, const MirrorPlane& plane, int half_width, double steep_deg)
      : net_(net),
        across_(across_pairs(plane)),
        half_width_(half_width),
        least_slope_(std::sin(steep_deg * kDegree)) {}

  void match(int first, int second, const MatchedStretch& stretch,
             std::vector<DenseMatch>& matches) const;
  /// Whether a border runs along the normal's image at a place, as one that is its own image does
  /// where it passes through the plane.
  [[nodiscard]] bool crosses_plane(int curve, double at) const {
    return std::abs(slope(curve, static_cast<int>(std::lround(at)))) < least_slope_;
  }
  /// Whether a stretch runs along the normal's image as a whole, as the sill of a door does, so
  /// that what u has of slopes is noise.
  [[nodiscard]] bool runs_along_normal(int curve, double from, double to) const;
  /// Mean distance in u of proportional places: small for the right way round a closed border.
  [[nodiscard]] double mismatch(int first, int second, const MatchedStretch& stretch) const;

 private:
  [[nodiscard]] double u_at(int curve, double at) const {
    return across_.dot(evaluate(net_, position_form(net_, {curve, at})));
  }
  /// Derivative of u along the unit tangent in the direction of rising numbers.
  [[nodiscard]] double slope(int curve, int i) const {
    const Eigen::Vector2d t =
        evaluate(net_, tangent_form(net_.curves[curve], i, half_width_)).normalized();
    return across_.dot(t);
  }
  /// Whether u is steep at the image too, in the same sense.
  [[nodiscard]] bool runs_alike(int curve, double at, double rise) const {
    const double image = slope(curve, static_cast<int>(std::lround(at)));
    return image * rise > 0 && std::abs(image) >= least_slope_;
  }
  [[nodiscard]] std::optional<double> next_crossing(int curve, double from, double to, double u,
                                                    bool rising) const;

  const CurveNet& net_;
  Eigen::Vector2d across_;
  int half_width_;
  double least_slope_;
};

int next_node(double at, int step) {
  return static_cast<int>(step > 0 ? std::floor(at) + 1 : std::ceil(at) - 1);
}

/// First place after `from`, on the way to `to`, where u passes the value in the given sense.
std::optional<double> StretchMatcher::next_crossing(int curve, double from, double to, double u,
                                                    bool rising) const {
  const double way = to >= from ? 1 : -1;
  double at = from;
  double value = u_at(curve, at);
  while (way * (to - at) > 0) {
    double next = way > 0 ? std::floor(at) + 1 : std::ceil(at) - 1;
    if (way * (next - to) > 0) next = to;
    const double next_value = u_at(curve, next);
    const bool passes = rising ? value <= u && u <= next_value : value >= u && u >= next_value;
    if (passes && value != next_value) {
      return at + (u - value) / (next_value - value) * (next - at);
    }
    at = next;
    value = next_value;
  }
  return std::nullopt;
}

void StretchMatcher::match(int first, int second, const MatchedStretch& stretch,
                           std::vector<DenseMatch>& matches) const {
  const double way = stretch.image_end >= stretch.image_begin ? 1 : -1;
  const int step = stretch.end >= stretch.begin ? 1 : -1;
  double from = stretch.image_begin;
  for (int i = next_node(stretch.begin, step); step * (stretch.end - i) > 0; i += step) {
    const double rise = step * slope(first, i);
    if (std::abs(rise) < least_slope_) continue;
    const double u = u_at(first, i);
    const auto place = next_crossing(second, from, stretch.image_end, u, rise > 0);
    if (!place || !runs_alike(second, *place, way * rise)) continue;
    matches.push_back({node_of(net_.curves[first], i), {second, *place}});
    from = *place;
  }
}

bool StretchMatcher::runs_along_normal(int curve, double from, double to) const {
  const auto [begin, end] = std::minmax(from, to);
  double low = u_at(curve, begin), high = low;
  for (double at = std::floor(begin) + 1; at < end; at += 1) {
    low = std::min(low, u_at(curve, at));
    high = std::max(high, u_at(curve, at));
  }
  const Eigen::Vector2d chord = evaluate(net_, position_form(net_, {curve, end})) -
                                evaluate(net_, position_form(net_, {curve, begin}));
  return high - low < kLevel * chord.norm();
}

double StretchMatcher::mismatch(int first, int second, const MatchedStretch& stretch) const {
  constexpr int kProbes = 16;
  double sum = 0;
  for (int k = 1; k < kProbes; ++k) {
    const double t = static_cast<double>(k) / kProbes;
    sum +=
        std::abs(u_at(first, stretch.begin + t * (stretch.end - stretch.begin)) -
                 u_at(second, stretch.image_begin + t * (stretch.image_end - stretch.image_begin)));
  }
  return sum / (kProbes - 1);
}

std::vector<PairAnchor> anchors_on(const std::vector<SymmetricPair>& pairs, int first, int second) {
  std::vector<PairAnchor> anchors;
  const auto add = [&](const std::vector<CurvePoint>& from, const std::vector<CurvePoint>& to,
                       int pair) {
    for (const CurvePoint& a : from) {
      for (const CurvePoint& b : to) {
        if (a.curve == first && b.curve == second) anchors.push_back({a.at, b.at, pair});
      }
    }
  };
  for (int p = 0; p < std::ssize(pairs); ++p) {
    add(pairs[p].point_at, pairs[p].image_at, p);
    if (!pairs[p].in_plane) add(pairs[p].image_at, pairs[p].point_at, p);
  }
  std::sort(anchors.begin(), anchors.end(), [](const PairAnchor& a, const PairAnchor& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  return anchors;
}

/// The stretches between neighbouring anchors when the image runs by `way` (+1 or -1).
std::vector<MatchedStretch> stretches_between(const std::vector<PairAnchor>& anchors,
                                              const SketchCurve& first, const SketchCurve& second,
                                              int way) {
  std::vector<MatchedStretch> stretches;
  const bool around = first.closed && second.closed;
  const std::size_t count = around ? anchors.size() : anchors.size() - 1;
  for (std::size_t k = 0; k < count; ++k) {
    const PairAnchor& a = anchors[k];
    const PairAnchor& b = anchors[(k + 1) % anchors.size()];
    MatchedStretch s{a.first, b.first, a.second, b.second};
    if (k + 1 == anchors.size()) s.end += first.size();
    if (second.closed && way * (s.image_end - s.image_begin) <= 0)
      s.image_end += way * second.size();
    stretches.push_back(s);
  }
  return stretches;
}

/// From the outermost anchors of open borders to their ends.
std::vector<MatchedStretch> stretches_beyond(const std::vector<PairAnchor>& anchors,
                                             const SketchCurve& first, const SketchCurve& second) {
  if (first.closed || second.closed) return {};
  const PairAnchor &low = anchors.front(), &high = anchors.back();
  const double last = second.size() - 1;
  const bool falls = anchors.size() == 1 || high.second < low.second;
  return {{low.first, 0, low.second, falls ? last : 0},
          {high.first, static_cast<double>(first.size() - 1), high.second, falls ? 0 : last}};
}

/// Total way of the images: more than once around says that pairs cross.
void require_order(const std::vector<PairAnchor>& anchors,
                   const std::vector<MatchedStretch>& stretches, const SketchCurve& first,
                   const SketchCurve& second, const std::vector<SymmetricPair>& pairs) {
  double around = 0;
  double way = 0;
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    const double step = stretches[k].image_end - stretches[k].image_begin;
    if (way == 0) way = step;
    around += std::abs(step);
    const bool turns = !second.closed && way * step < 0;
    const bool laps = second.closed && around > second.size() * (1 + 1e-9);
    if (!turns && !laps) continue;
    const std::string& a = pairs[anchors[k].pair].id;
    const std::string& b = pairs[anchors[(k + 1) % anchors.size()].pair].id;
    throw Error("contradictory symmetric pairs: they cross on borders '" + first.id + "' and '" +
                    second.id + "'",
                "strokes '" + a + "' and '" + b + "'", "the same order along both borders");
  }
}

/// Whether the drawn pairs run along the plane's normal, so that u can be trusted far from them.
bool agrees_with(const MirrorPlane& plane, const std::vector<SymmetricPair>& pairs) {
  double miss = 0, length = 0;
  for (const SymmetricPair& pair : pairs) {
    miss += std::abs(across_pairs(plane).dot(pair.image - pair.point));
    length += (pair.image - pair.point).norm();
  }
  return length > 0 && miss <= kMostMiss * length;
}

}  // namespace

std::vector<DenseMatch> dense_matches(const CurveNet& net, const std::vector<SymmetricPair>& pairs,
                                      const MirrorPlane& plane, int half_width, double steep_deg) {
  const StretchMatcher matcher(net, plane, half_width, steep_deg);
  std::vector<DenseMatch> matches;
  const bool goes_on = agrees_with(plane, pairs);
  const int count = static_cast<int>(net.curves.size());
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b) {
      const std::vector<PairAnchor> anchors = anchors_on(pairs, a, b);
      // One point of the plane tells how a border is its own image, unless it lies in the plane.
      const bool is_own_image = goes_on && a == b && anchors.size() == 1 &&
                                pairs[anchors[0].pair].in_plane &&
                                matcher.crosses_plane(a, anchors[0].first);
      if (anchors.size() < 2 && !is_own_image) continue;
      const SketchCurve& first = net.curves[a];
      const SketchCurve& second = net.curves[b];
      std::vector<MatchedStretch> stretches = stretches_between(anchors, first, second, -1);
      if (second.closed && a != b) {
        const std::vector<MatchedStretch> other = stretches_between(anchors, first, second, 1);
        double down = 0, up = 0;
        for (const MatchedStretch& s : stretches) down += matcher.mismatch(a, b, s);
        for (const MatchedStretch& s : other) up += matcher.mismatch(a, b, s);
        if (up < down) stretches = other;
      }
      require_order(anchors, stretches, first, second, pairs);
      if (goes_on) {
        for (const MatchedStretch& s : stretches_beyond(anchors, first, second))
          stretches.push_back(s);
      }
      for (const MatchedStretch& s : stretches)
        if (!matcher.runs_along_normal(a, s.begin, s.end) &&
            !matcher.runs_along_normal(b, s.image_begin, s.image_end))
          matcher.match(a, b, s, matches);
    }
  }
  return matches;
}

}  // namespace geoprior::sketch
