#include "solvers/sketch/layers/articulated_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "core/angles.h"
#include "core/error.h"
#include "solvers/sketch/layers/joint_range.h"

namespace geoprior::sketch {
namespace {

constexpr int kBisections = 60;
constexpr int kRadiusBisections = 30;
constexpr int kStripSamples = 24;  // of an angle, over half of the band
constexpr int kStripRows = 16;
constexpr double kMostOverlap = 0.95, kOverlapStep = 0.05;
constexpr double kMostGaping = 0.5;  // overlap of layers that cannot but gape
constexpr int kOverlapBisections = 5;

/// What is kept free between a band and those it lies below.
struct StripRoom {
  double depth = 0;         ///< between outer sides at rest (m)
  double turned_depth = 0;  ///< and where the band is turned (m)
  double free = 0;          ///< angle either way (rad)
  double margin = 0;        ///< of the rivets (m)
  bool whole = false;       ///< turned, the whole band has to have room, not its strip alone
};

/// A band that lies below the ones before it.
struct OverlapFit {
  FrustumBand band;
  double share = 0;  ///< of the visible length of the band before
  double free = 0;   ///< rad
};

/// Whether a point keeps its distance from the bands that it lies below.
bool is_below(const Eigen::Vector3d& P, const std::vector<FrustumBand>& bands, double depth) {
  return std::all_of(bands.begin(), bands.end(),
                     [&](const FrustumBand& above) { return above.has_below(P, depth); });
}

/// How far the rear rim of the band before reaches forward of the rear rim of this one, along its
/// axis: farthest at the back where the body bends down.
double visible_length(const FrustumBand& band, const FrustumBand& before) {
  double length = 0;
  for (int k = 0; k <= kStripSamples; ++k) {
    const Eigen::Vector3d rim = before.point(0, before.half_angle * k / kStripSamples);
    length = std::max(length, -band.own(rim).x());
  }
  return length;
}

/// Height above the lower border, less the margin, of the line through a point of the plane.
double above_border(const FrustumBand& band, const Eigen::Vector3d& point, double margin) {
  const Eigen::Vector3d p = band.own(point);
  return p.y() - band.lower_border(p.x(), margin);
}

LayerHinge hinge_between(const FrustumBand& front, const FrustumBand& behind, double overlap,
                         double margin) {
  LayerHinge hinge;
  hinge.axis = front.up.cross(front.axis);
  const auto at_height = [&](double y) -> Eigen::Vector3d {
    return front.rear - overlap / 2 * front.axis + y * front.up;
  };
  // Both heights grow with y: the least y at which neither is negative.
  double low = -1.5 * front.rear_radius, high = front.rear_radius;
  for (int i = 0; i < kBisections; ++i) {
    const double y = (low + high) / 2;
    const Eigen::Vector3d p = at_height(y);
    const bool inside = above_border(front, p, margin) >= 0 && above_border(behind, p, margin) >= 0;
    (inside ? high : low) = y;
  }
  hinge.point = at_height(high);
  const FrustumBand::Place f = front.side_place(front.own(hinge.point));
  const FrustumBand::Place b = behind.side_place(behind.own(hinge.point));
  hinge.front_hole_at = f.x;
  hinge.front_hole = f.s;
  hinge.rear_hole_at = b.x;
  hinge.rear_hole = b.s;
  return hinge;
}

/// Whether a band lies below those before it, at rest as a whole, and with its strip (or as a
/// whole: what is behind their rims may get below them) when it is turned about its hinge by `free`
/// either way.
bool strip_is_below(const FrustumBand& band, double overlap, const std::vector<FrustumBand>& bands,
                    const StripRoom& room) {
  const LayerHinge hinge = hinge_between(bands.back(), band, overlap, room.margin);
  for (const double turned : {0.0, -1.0, -0.5, 0.5, 1.0}) {
    const Eigen::Isometry3d turn = hinge_turn(hinge, turned * room.free);
    const double reach = turned == 0 || room.whole ? band.length : overlap;
    const double depth = turned == 0 ? room.depth : room.turned_depth;
    for (int i = 0; i <= kStripRows; ++i) {
      const double x = -band.length + reach * i / kStripRows;
      for (int k = 0; k <= kStripSamples; ++k) {
        const Eigen::Vector3d P = band.point(x, band.half_angle * k / kStripSamples);
        if (!is_below(turn * P, bands, depth)) return false;
      }
    }
    if (room.free == 0) break;
  }
  return true;
}

/// The largest front radius with which the band lies below those before it; false where half of
/// the radius before it is too much.
bool fit_front_radius(FrustumBand& band, double overlap, const std::vector<FrustumBand>& bands,
                      const StripRoom& room) {
  constexpr double kLeast = 0.5, kMost = 1.5;  // of the radius of the band before
  double low = kLeast * bands.back().rear_radius, high = kMost * bands.back().rear_radius;
  band.front_radius = low;
  if (!strip_is_below(band, overlap, bands, room)) return false;
  for (int i = 0; i < kRadiusBisections; ++i) {
    band.front_radius = (low + high) / 2;
    (strip_is_below(band, overlap, bands, room) ? low : high) = band.front_radius;
  }
  band.front_radius = low;
  return true;
}

FrustumBand band_to(const ArcCircle& circle) {
  FrustumBand band;
  band.rear = circle.centre;
  band.axis = circle.axis;
  band.up = circle.up;
  band.rear_radius = circle.radius;
  band.half_angle = circle.half_angle;
  return band;
}

/// The first band, from the first circle to the second.
FrustumBand first_band(const ArcCircle& front, const ArcCircle& circle) {
  FrustumBand band = band_to(circle);
  const Eigen::Vector3d centre = band.own(front.centre);
  band.length = -centre.x();
  band.front_radius = front.radius;
  band.half_angle = std::max(band.half_angle, front.half_angle);
  if (front.axis == circle.axis) return band;
  band.front_rise = centre.y();
  band.front_tilt = std::atan2(front.up.dot(band.axis), front.up.dot(band.up));
  // Both edges are there as far as they were drawn: generators end at different angles on them.
  double low = circle.half_angle, high = std::acos(-1.0);
  if (band.front_angle(low) >= front.half_angle) high = low;
  for (int i = 0; i < kBisections; ++i) {
    const double s = (low + high) / 2;
    (band.front_angle(s) < front.half_angle ? low : high) = s;
  }
  band.half_angle = high;
  if (!band.rims_are_apart()) {
    throw Error("the first two edges cross", "strokes '" + front.id + "' and '" + circle.id + "'",
                "edges of a layer that nowhere meet, from rivet to rivet");
  }
  return band;
}

/// What is asked of a layer's place below the one before it.
class OverlapChoice {
 public:
  OverlapChoice(const ArticulatedLayers& layers, const FrustumBand& rest,
                const LayerOptions& options)
      : layers_(layers), rest_(rest), options_(options) {
    before_ = layers.bands.back().length - layers.overlaps.back();
  }

  /// The band that reaches a share of the visible length before it below the ones before it, with
  /// room for joints to turn by `free` (rad); absent where it does not fit. Where the overlap is
  /// chosen, both solids have to be apart over these angles as well.
  [[nodiscard]] std::optional<FrustumBand> band(double share, double free) const {
    const double overlap = share * before_;
    FrustumBand band = rest_;
    band.length = visible_length(band, layers_.bands.back()) + overlap;
    const StripRoom room{(options_.thickness + options_.clearance) * layers_.unit,
                         (options_.thickness + options_.clearance / 2) * layers_.unit, free,
                         options_.rivet_margin * layers_.unit, !options_.overlap};
    if (!fit_front_radius(band, overlap, layers_.bands, room)) return {};
    return band;
  }

  /// The largest overlap that fits, with the angle that was asked for or a part of it.
  std::optional<OverlapFit> largest() {
    constexpr int kParts = 4;
    constexpr double kAny = std::numeric_limits<double>::infinity();
    for (const bool hidden : {true, false}) {
      for (int part = kParts; part >= (hidden ? 1 : 0); --part) {
        const double free = options_.free_deg * kDegree * part / kParts;
        for (const Wanted& wanted :
             {Wanted{kMostOverlap, options_.gape * layers_.unit, free, hidden},
              Wanted{kMostGaping, kAny, free, hidden}, Wanted{kMostOverlap, kAny, free, hidden}}) {
          if (auto fit = largest(wanted)) return fit;
        }
      }
    }
    return {};
  }

  [[nodiscard]] double visible_before() const { return before_; }

 private:
  struct Wanted {
    double most = 0;  ///< overlap
    double gape = 0;  ///< between the rim before and the band (m)
    double free = 0;  ///< rad
    bool hidden = true;
  };

  /// What a share gives, computed once.
  struct Candidate {
    FrustumBand band;
    LayerHinge hinge;
    double gape = 0;
    bool hidden = false;
    std::optional<bool> turns = {};
  };

  [[nodiscard]] std::optional<Candidate> candidate(double share, double free) const {
    const auto fitted = band(share, free);
    if (!fitted) return {};
    Candidate made{*fitted, {}};
    made.hinge = hinge_between(layers_.bands.back(), made.band, share * before_,
                               options_.rivet_margin * layers_.unit);
    made.gape = gape(made.band, made.hinge);
    made.hidden = is_hidden(made.band, made.hinge, layers_.bands.size() == 1 ? free : 0);
    return made;
  }

  std::optional<OverlapFit> at(double share, const Wanted& wanted) {
    const auto [found, is_new] = candidates_.try_emplace({wanted.free, share});
    if (is_new) found->second = candidate(share, wanted.free);
    if (!found->second) return {};
    Candidate& c = *found->second;
    if ((wanted.hidden && !c.hidden) || c.gape > wanted.gape) return {};
    if (!c.turns) {
      c.turns = joint_turns({layers_.bands.back(), c.band, c.hinge, share * before_}, wanted.free,
                            options_, layers_.unit);
    }
    if (!*c.turns) return {};
    return OverlapFit{c.band, share, wanted.free};
  }

  /// How far the band lies below the rim of the one before it, at rest, where it does most.
  [[nodiscard]] double gape(const FrustumBand& band, const LayerHinge& hinge) const {
    double most = 0;
    for (int k = 0; k <= kStripSamples; ++k) {
      const double s = hinge.front_hole * k / kStripSamples;
      most = std::max(most, band.height_above(layers_.bands.back().point(0, s)));
    }
    return most;
  }

  /// Whether the front rim stays behind that of the band before, at rest and turned either way.
  [[nodiscard]] bool is_hidden(const FrustumBand& band, const LayerHinge& hinge,
                               double turned) const {
    const FrustumBand& front = layers_.bands.back();
    for (const double angle : {0.0, -turned, turned}) {
      const Eigen::Isometry3d turn = hinge_turn(hinge, angle);
      for (int k = 0; k <= kStripSamples; ++k) {
        const double s = band.half_angle * k / kStripSamples;
        if (!(front.behind_front(turn * band.point(-band.length, s)) > 0)) return false;
      }
    }
    return true;
  }

  std::optional<OverlapFit> largest(const Wanted& wanted) {
    // A rivet's hole and as much again on either side of it.
    const double least = 4 * options_.rivet_radius * layers_.unit / before_;
    for (int step = static_cast<int>(std::lround(wanted.most / kOverlapStep)); step > 0; --step) {
      const double share = step * kOverlapStep;
      if (share < least) break;
      auto fit = at(share, wanted);
      if (!fit) continue;
      double low = share, high = std::min(share + kOverlapStep, wanted.most);
      for (int k = 0; low < high && k < kOverlapBisections; ++k) {
        const double middle = (low + high) / 2;
        const auto finer = at(middle, wanted);
        if (finer) fit = finer;
        (finer ? low : high) = middle;
      }
      return fit;
    }
    return {};
  }

  const ArticulatedLayers& layers_;
  FrustumBand rest_;
  const LayerOptions& options_;
  double before_ = 0;  ///< visible length of the band before (m)
  std::map<std::pair<double, double>, std::optional<Candidate>> candidates_;  ///< by angle, share
};

void add_band(ArticulatedLayers& layers, std::size_t k, const LayerOptions& options) {
  const ArcCircle& circle = layers.circles[k];
  const ArcCircle& before = layers.circles[k - 1];
  const std::string where = "stroke '" + circle.id + "'";
  if (!((circle.centre - before.centre).dot(circle.axis) > 0)) {
    throw Error("its circle lies before that of '" + before.id + "' along its own axis", where,
                "arcs in their order along the body");
  }
  if (k == 1) {
    layers.bands.push_back(first_band(before, circle));
    layers.overlaps.push_back(0);
    return;
  }
  OverlapChoice choice(layers, band_to(circle), options);
  std::optional<OverlapFit> fit;
  const double free = options.free_deg * kDegree;
  if (!options.overlap) {
    fit = choice.largest();
  } else if (const auto band = choice.band(*options.overlap, free)) {
    fit = {*band, *options.overlap, free};
  }
  if (!fit) {
    throw Error("its layer does not fit below that of '" + before.id + "'" +
                    (options.overlap ? " with this overlap" : ", however little they overlap"),
                where,
                options.overlap ? "less overlap, or none given, which chooses it; less free_deg"
                                : "an edge farther behind the one before it; less clearance");
  }
  layers.bands.push_back(fit->band);
  layers.overlaps.push_back(fit->share * choice.visible_before());
  layers.choices.push_back({fit->share, fit->free, !options.overlap});
}

}  // namespace

void describe(OptionVisitor& v, LayerOptions& o) {
  static constexpr std::array<std::string_view, 3> kAxes{"rivets", "centre", "crown"};
  const auto share = [&](const char* key, double& x, const char* doc, double most) {
    v.value(key, x, {.doc = doc, .min = 0, .max = most});
  };
  v.value("vector_ratio", o.vector_ratio,
          {.doc = "length in space of sym-a over that of sym-b", .min = 1e-3, .max = 1e3});
  v.value(
      "constrained", o.constrained,
      {.doc = "whether circles are fitted within the mirror plane, not read off their ellipses"});
  v.value(
      "overlap", o.overlap,
      {.doc = "overlap of a layer below the one before, over that one's visible length; absent: "
              "at every joint the largest that fits",
       .min = 0,
       .max = kMostOverlap});
  share("gape", o.gape,
        "distance of a layer's rim from the layer below it, at rest, over the mean radius, that a "
        "chosen overlap keeps to where it can",
        1);
  v.value("oblique", o.oblique,
          {.doc = "whether the first layer may be cut obliquely, so that its first edge is met "
                  "where it is drawn; else it has the axis of the second"});
  share("thickness", o.thickness, "thickness of the sheet, over the mean radius of the circles",
        0.2);
  share("clearance", o.clearance,
        "clearance between overlapping layers, over the mean radius of the circles", 0.2);
  share("rivet_margin", o.rivet_margin,
        "distance from rivet to lower border, over the mean radius of the circles", 0.5);
  share("rivet_radius", o.rivet_radius,
        "radius of a rivet's hole, over the mean radius of the circles", 0.2);
  v.value("free_deg", o.free_deg,
          {.doc = "angle of a joint either way for which the strip below the layer before has room",
           .unit = "deg",
           .min = 0,
           .max = 45});
  v.value("max_angle_deg", o.max_angle_deg,
          {.doc = "largest angle of a joint either way, where nothing stops it earlier",
           .unit = "deg",
           .min = 0,
           .max = 90});
  v.value("keep_covered", o.keep_covered,
          {.doc = "whether a joint stops before a gap opens between its layers"});
  describe_choice(v, "axis", o.axis, kAxes,
                  {.doc = "what layers turn about in the motion; limits are those of the rivets"});
  v.value("around", o.grid.around, {.doc = "segments of a rim", .min = 8, .max = 2000});
  v.value("along", o.grid.along, {.doc = "segments of a generator", .min = 2, .max = 200});
  v.value("poses", o.poses, {.doc = "poses of the motion, beside the rest", .min = 4, .max = 1000});
}

ArticulatedLayers build_layers(const View& view, const LayerOptions& options) {
  ArticulatedLayers layers;
  layers.planes = drawn_mirror_planes(view, options.vector_ratio);
  layers.circles =
      fit_arc_circles(view, layers.planes.chosen, options.constrained, options.oblique);
  for (const ArcCircle& circle : layers.circles) layers.unit += circle.radius;
  layers.unit /= static_cast<double>(layers.circles.size());
  for (std::size_t k = 1; k < layers.circles.size(); ++k) add_band(layers, k, options);
  for (std::size_t j = 0; j + 1 < layers.bands.size(); ++j) {
    layers.hinges.push_back(hinge_between(layers.bands[j], layers.bands[j + 1],
                                          layers.overlaps[j + 1],
                                          options.rivet_margin * layers.unit));
  }
  return layers;
}

}  // namespace geoprior::sketch
