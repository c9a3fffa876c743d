#include "solvers/sketch/drawing/symmetric_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/error.h"

namespace geoprior::sketch {
namespace {

/// Ends of pairs are drawn onto borders by hand: they may miss by this many snapping distances.
constexpr double kPairReach = 2;
/// Variance of a faired border over that of a drawn point.
constexpr double kBorderVariance = 0.1;
/// Deviations by which an end slides at most.
constexpr double kMostSlide = 3;
/// Pairs that say which borders are each other's image, against one that does not.
constexpr int kVotes = 2;
/// Nodes on either side in the fit of the direction in which an end slides.
constexpr int kSlideHalfWidth = 3;

/// The place and, where it is a node of other curves too, its places on them.
std::vector<CurvePoint> all_places(const CurveNet& net, const CurvePoint& place) {
  const SketchCurve& curve = net.curves[place.curve];
  const double rounded = std::round(place.at);
  const int node = node_of(curve, static_cast<int>(rounded));
  const double off = (net.points[node] - evaluate(net, position_form(net, place))).norm();
  std::vector<CurvePoint> places;
  if (off <= std::max(net.snap, net.spacing / 2)) {
    for (int c = 0; c < std::ssize(net.curves); ++c) {
      if (c == place.curve) continue;
      const std::vector<int>& nodes = net.curves[c].nodes;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i] == node) places.push_back({c, static_cast<double>(i)});
      }
    }
  }
  // At a junction the place is the junction itself, on every curve.
  places.insert(places.begin(), places.empty() ? place : CurvePoint{place.curve, rounded});
  return places;
}

/// Borders that belong to all panels that a pair names.
std::vector<int> borders_for_pair(const CurveNet& net, const Stroke& stroke) {
  const std::vector<std::string> panels = panels_in(stroke.panels);
  std::vector<int> borders;
  for (int c = 0; c < std::ssize(net.curves); ++c) {
    const std::vector<std::string>& own = net.curves[c].panels;
    const bool belongs = std::all_of(panels.begin(), panels.end(),
                                     [&](const std::string& name) { return bounds(own, name); });
    if (belongs) borders.push_back(c);
  }
  if (borders.empty()) {
    throw Error("no border belongs to the panels '" + stroke.panels + "' that the pair names",
                "stroke '" + stroke.id + "'", "panels of one border, or none");
  }
  return borders;
}

double reach_of_ends(const CurveNet& net) {
  return std::max(kPairReach * net.snap, kMarkMiss * net.diagonal);
}

NearestOnNet border_of_end(const CurveNet& net, const std::vector<int>& borders,
                           const Eigen::Vector2d& end, const std::string& where) {
  const double reach = reach_of_ends(net);
  NearestOnNet best{{}, reach};
  for (const int c : borders) {
    const NearestOnNet near = nearest_on_curve(net, c, end);
    if (near.distance < best.distance) best = near;
  }
  if (best.place.curve >= 0) return best;
  throw Error("an end of the symmetric pair lies on no border", where,
              "within " + std::to_string(reach) + " m of one");
}

/// Puts the ends onto the nearest borders, or both onto one that fits about as well: where the
/// images of two borders cross, a pair most likely belongs to one border that is its own mirror
/// image. Not where the ends would come together: then it joins two borders that run beside each
/// other.
std::array<CurvePoint, 2> borders_of_ends(const CurveNet& net, const std::vector<int>& borders,
                                          const SymmetricPair& pair, const MirrorPlane& plane,
                                          const std::string& where) {
  const NearestOnNet point = border_of_end(net, borders, pair.point, where);
  const NearestOnNet image = border_of_end(net, borders, pair.image, where);
  std::array<CurvePoint, 2> best{point.place, image.place};
  if (point.place.curve == image.place.curve) return best;
  const auto between = [&](const NearestOnNet& a, const NearestOnNet& b) -> Eigen::Vector2d {
    return evaluate(net, position_form(net, b.place)) - evaluate(net, position_form(net, a.place));
  };
  const auto misfit = [&](const NearestOnNet& a, const NearestOnNet& b) {
    return a.distance + b.distance + std::abs(across_pairs(plane).dot(between(a, b)));
  };
  double least = misfit(point, image) + net.snap;
  for (const int c : borders) {
    const NearestOnNet a = nearest_on_curve(net, c, pair.point);
    const NearestOnNet b = nearest_on_curve(net, c, pair.image);
    if (std::max(a.distance, b.distance) > reach_of_ends(net)) continue;
    if (misfit(a, b) >= least || between(a, b).norm() < (pair.image - pair.point).norm() / 2)
      continue;
    least = misfit(a, b);
    best = {a.place, b.place};
  }
  return best;
}

/// An end that may slide along its border.
struct SlidingEnd {
  CurvePoint& place;
  double step = 0;  ///< m, that a number stands for
  double rate = 0;  ///< of the miss, a metre along the border

  SlidingEnd(const CurveNet& net, std::vector<CurvePoint>& places, const Eigen::Vector2d& across)
      : place(places.front()) {
    const SketchCurve& curve = net.curves[place.curve];
    const bool at_end = !curve.closed && (place.at <= 1 || place.at >= curve.size() - 2);
    if (places.size() > 1 || at_end) return;
    const Eigen::Vector2d tangent = evaluate(net, tangent_form(curve, place.at, kSlideHalfWidth));
    step = tangent.norm();
    if (step > 0) rate = across.dot(tangent) / step;
  }
  void slide(const CurveNet& net, double by) {
    if (!(step > 0)) return;
    const SketchCurve& curve = net.curves[place.curve];
    place.at += by / step;
    const double n = curve.size();
    if (curve.closed) place.at -= n * std::floor(place.at / n);
    if (!curve.closed) place.at = std::clamp(place.at, 0.0, n - 1);
  }
};

/// Lets both ends slide to where the pair runs along the normal.
void slide_ends(SymmetricPair& pair, const CurveNet& net, const MirrorPlane& plane, double noise) {
  const Eigen::Vector2d across = across_pairs(plane);
  SlidingEnd point(net, pair.point_at, across), image(net, pair.image_at, across);
  const double square = point.rate * point.rate + image.rate * image.rate;
  if (!(square > 0)) return;
  const double miss = across.dot(pair.image - pair.point);
  const double by = miss / (square + kBorderVariance), most = kMostSlide * noise;
  point.slide(net, std::clamp(by * point.rate, -most, most));
  image.slide(net, std::clamp(-by * image.rate, -most, most));
}

/// A drawn pair before its ends are put onto borders.
struct DrawnPair {
  SymmetricPair pair;
  std::string panels;
  std::array<CurvePoint, 2> ends;

  [[nodiscard]] std::array<int, 2> borders() const {
    return {std::min(ends[0].curve, ends[1].curve), std::max(ends[0].curve, ends[1].curve)};
  }
};

DrawnPair drawn_pair(const Stroke& stroke, const CurveNet& net, const MirrorPlane& plane) {
  const std::string where = "stroke '" + stroke.id + "'";
  if (stroke.points.empty()) throw Error("symmetric pair without points", where, "two points");
  SymmetricPair pair{stroke.id, stroke.points.front(), stroke.points.back(), false, {}, {}};
  pair.in_plane = (pair.image - pair.point).norm() <= net.snap / 4;
  return {pair, stroke.panels,
          borders_of_ends(net, borders_for_pair(net, stroke), pair, plane, where)};
}

/// The border that pairs of the same panels say is the image of a border on which one pair has both
/// its ends: two of them at least, and more than there are for any other. -1: there is none, or a
/// point of the plane says that the border is its own image.
int image_by_votes(const std::vector<DrawnPair>& pairs, const DrawnPair& drawn) {
  const int curve = drawn.ends[0].curve;
  std::map<int, int> votes;
  for (const DrawnPair& other : pairs) {
    const auto [a, b] = other.borders();
    if (&other == &drawn || other.panels != drawn.panels || (a != curve && b != curve)) continue;
    if (other.pair.in_plane) return -1;
    ++votes[a == curve ? b : a];
  }
  int image = -1, most = kVotes - 1;
  for (const auto& [border, count] : votes) {
    if (count == most) image = -1;
    if (count <= most) continue;
    most = count;
    image = border;
  }
  return image == curve ? -1 : image;
}

/// Where two borders are each other's image a pair of the same panels joins them, too, although
/// both its ends were drawn nearer to one: a border has one image.
void join_as_others(std::vector<DrawnPair>& pairs, const CurveNet& net) {
  const std::vector<DrawnPair> as_drawn = pairs;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    DrawnPair& drawn = pairs[p];
    const auto [curve, same] = drawn.borders();
    if (curve != same || drawn.pair.in_plane) continue;
    const int image = image_by_votes(as_drawn, as_drawn[p]);
    if (image < 0) continue;
    const auto ends_on = [&](int first, int second) {
      return std::array<NearestOnNet, 2>{nearest_on_curve(net, first, drawn.pair.point),
                                         nearest_on_curve(net, second, drawn.pair.image)};
    };
    const auto distance = [](const std::array<NearestOnNet, 2>& ends) {
      return std::max(ends[0].distance, ends[1].distance);
    };
    const auto one = ends_on(curve, image), other = ends_on(image, curve);
    const auto& best = distance(one) <= distance(other) ? one : other;
    if (distance(best) <= reach_of_ends(net)) drawn.ends = {best[0].place, best[1].place};
  }
}

SymmetricPair placed_pair(const DrawnPair& drawn, const CurveNet& net, const MirrorPlane& plane,
                          double noise) {
  const std::array<CurvePoint, 2>& ends = drawn.ends;
  SymmetricPair pair = drawn.pair;
  pair.point_at = all_places(net, ends[0]);
  pair.image_at = pair.in_plane ? pair.point_at : all_places(net, ends[1]);
  if (noise > 0 && !pair.in_plane) {
    pair.point = evaluate(net, position_form(net, pair.point_at.front()));
    pair.image = evaluate(net, position_form(net, pair.image_at.front()));
    slide_ends(pair, net, plane, noise);
  }
  pair.point = evaluate(net, position_form(net, pair.point_at.front()));
  pair.image = evaluate(net, position_form(net, pair.image_at.front()));
  return pair;
}

void require_along_normal(const SymmetricPair& pair, const MirrorPlane& plane, double tolerance) {
  const double miss = std::abs(across_pairs(plane).dot(pair.image - pair.point));
  if (miss <= tolerance) return;
  throw Error("symmetric pair contradicts the mirror plane: its direction misses the normal by " +
                  std::to_string(miss) + " m",
              "stroke '" + pair.id + "'", "at most " + std::to_string(tolerance) + " m");
}

/// Two pairs that start at one point but end at two, in either sense.
void require_one_partner(const SymmetricPair& a, const SymmetricPair& b, double near,
                         double tolerance) {
  const std::pair<Eigen::Vector2d, Eigen::Vector2d> from_a[2] = {{a.point, a.image},
                                                                 {a.image, a.point}};
  const std::pair<Eigen::Vector2d, Eigen::Vector2d> from_b[2] = {{b.point, b.image},
                                                                 {b.image, b.point}};
  for (const auto& [p, p_image] : from_a) {
    for (const auto& [q, q_image] : from_b) {
      const double apart = (p_image - q_image).norm();
      if ((p - q).norm() > near || apart <= tolerance) continue;
      throw Error("contradictory symmetric pairs: one point has two partners, " +
                      std::to_string(apart) + " m apart",
                  "strokes '" + a.id + "' and '" + b.id + "'",
                  "at most " + std::to_string(tolerance) + " m");
    }
  }
}

}  // namespace

PairDepths pair_depths(const MirrorPlane& plane, const Eigen::Vector2d& p,
                       const Eigen::Vector2d& image) {
  const Eigen::Vector2d n = plane.normal.head<2>();
  const double nz = plane.normal.z();
  const double difference = nz * (image - p).dot(n) / n.squaredNorm();
  const double sum = (2 * plane.offset - n.dot(p + image)) / nz;
  return {(sum - difference) / 2, (sum + difference) / 2};
}

Eigen::Vector2d across_pairs(const MirrorPlane& plane) {
  return Eigen::Vector2d(-plane.normal.y(), plane.normal.x()).normalized();
}

std::vector<SymmetricPair> read_symmetric_pairs(const View& view, const CurveNet& net,
                                                const MirrorPlane& plane, double tolerance,
                                                double noise) {
  std::vector<DrawnPair> drawn;
  for (const Stroke* stroke : strokes_of(view, StrokeKind::symmetric_pair))
    drawn.push_back(drawn_pair(*stroke, net, plane));
  join_as_others(drawn, net);
  std::vector<SymmetricPair> pairs;
  for (const DrawnPair& pair : drawn) pairs.push_back(placed_pair(pair, net, plane, noise));
  if (pairs.empty()) {
    throw Error("no symmetric pair is drawn: depth is not determined", view_name(view.kind),
                "one pair or more");
  }
  const double miss = tolerance * net.diagonal;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    require_along_normal(pairs[i], plane, miss);
    for (std::size_t j = 0; j < i; ++j) require_one_partner(pairs[j], pairs[i], net.snap / 2, miss);
  }
  return pairs;
}

}  // namespace geoprior::sketch
