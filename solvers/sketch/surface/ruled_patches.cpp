#include "solvers/sketch/surface/ruled_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/error.h"

namespace geoprior::sketch {
namespace {

/// Of a border's nodes, to either side of a ruling: by which its sense is told.
constexpr int kSensePart = 8;
/// Cosine of two directions that say clearly whether borders run alike.
constexpr double kClearSense = 0.5;

/// A drawn ruling as nodes of two borders.
struct DrawnRuling {
  std::string id;
  int i = 0;
  int j = 0;
};

/// Nodes of a border from one drawn ruling towards the next.
struct NodeRun {
  int begin = 0;
  int way = 1;
  int count = 0;
  bool ends = true;  ///< false: goes once around a closed border

  [[nodiscard]] int number(int k) const { return begin + way * k; }
};

void require_straight(const Stroke& stroke, double tolerance) {
  const std::string where = "stroke '" + stroke.id + "'";
  if (stroke.points.size() < 2 || !((stroke.points.back() - stroke.points.front()).norm() > 0))
    throw Error("ruling has no length", where, "two different points");
  const Eigen::Vector2d chord = (stroke.points.back() - stroke.points.front()).normalized();
  for (const Eigen::Vector2d& p : stroke.points) {
    const Eigen::Vector2d d = p - stroke.points.front();
    const double off = (d - d.dot(chord) * chord).norm();
    if (off > tolerance) {
      throw Error("ruling is bent by " + std::to_string(off) + " m", where,
                  "at most " + std::to_string(tolerance) +
                      " m: silhouettes of developable patches are straight");
    }
  }
}

/// Node where an end of a ruling lies. Within `snap` of an open border's end, that end.
int node_near(const CurveNet& net, const CurvePoint& place) {
  const SketchCurve& curve = net.curves[place.curve];
  const int node = static_cast<int>(std::lround(place.at));
  if (curve.closed) return node % curve.size();
  const double reach = net.snap / net.spacing;
  if (place.at <= reach) return 0;
  if (place.at >= curve.size() - 1 - reach) return curve.size() - 1;
  return node;
}

/// Places of the two ends on two different borders.
std::array<CurvePoint, 2> borders_of_ruling(const CurveNet& net, const Stroke& stroke) {
  const std::array<CurvePoint, 2> ends = ruling_ends(net, stroke);
  const std::string where = "stroke '" + stroke.id + "'";
  const std::string allowed = "each end within " + std::to_string(reach_of_rulings(net)) +
                              " m of a border of its own; borders end at corners";
  if (ends[0].curve < 0 || ends[1].curve < 0)
    throw Error("an end of the ruling joins no border", where, allowed);
  if (ends[0].curve == ends[1].curve)
    throw Error("the ruling does not join two different borders", where, allowed);
  return ends;
}

using RulingsOfBorders = std::map<std::pair<int, int>, std::vector<DrawnRuling>>;

RulingsOfBorders read_rulings(const View& view, const CurveNet& net) {
  RulingsOfBorders rulings;
  for (const Stroke& stroke : view.strokes) {
    if (!is_ruling(stroke)) continue;
    require_straight(stroke, net.snap);
    auto [a, b] = borders_of_ruling(net, stroke);
    if (a.curve > b.curve) std::swap(a, b);
    rulings[{a.curve, b.curve}].push_back({stroke.id, node_near(net, a), node_near(net, b)});
  }
  return rulings;
}

/// The steps of a mesh along a map from the nodes of one run to places on another: each node is
/// joined to the node nearest to its place.
std::vector<std::array<int, 2>> cells_of(const std::vector<double>& image) {
  std::vector<std::array<int, 2>> cells{{0, static_cast<int>(std::lround(image.front()))}};
  for (int i = 1; i < std::ssize(image); ++i) {
    const int to = static_cast<int>(std::lround(image[i]));
    int j = std::min(cells.back()[1] + 1, to);
    cells.push_back({i, j});
    while (j < to) cells.push_back({i, ++j});
  }
  return cells;
}

/// Sweeps the patch between two borders.
class PatchSweep {
 public:
  PatchSweep(const CurveNet& net, const std::pair<int, int>& borders, int half_width,
             const RulingWarpOptions& options)
      : net_(net), half_width_(half_width), options_(options) {
    patch_.first = borders.first;
    patch_.second = borders.second;
  }
  RuledPatch run(std::vector<DrawnRuling> drawn);

 private:
  [[nodiscard]] const SketchCurve& first() const { return net_.curves[patch_.first]; }
  [[nodiscard]] const SketchCurve& second() const { return net_.curves[patch_.second]; }
  [[nodiscard]] Eigen::Vector2d tangent(const SketchCurve& curve, int i, int way) const {
    return way * evaluate(net_, tangent_form(curve, i, half_width_)).normalized();
  }
  [[nodiscard]] bool goes_on(const DrawnRuling& at, int way) const;
  [[nodiscard]] int same_sense(const DrawnRuling& at) const;
  [[nodiscard]] NodeRun run_to_end(const SketchCurve& curve, int from, int way) const;
  [[nodiscard]] BorderRun samples(const SketchCurve& curve, const NodeRun& run) const;
  void order(std::vector<DrawnRuling>& drawn) const;
  void sweep(const NodeRun& a, const NodeRun& b);
  void sweep_between(const DrawnRuling& from, const DrawnRuling& to);
  void sweep_beyond(const DrawnRuling& from, int way);

  const CurveNet& net_;
  int half_width_;
  RulingWarpOptions options_;
  RuledPatch patch_;
};

/// Whether there is a patch on either side of a ruling when the second border runs by `way`.
bool PatchSweep::goes_on(const DrawnRuling& at, int way) const {
  const auto has_next = [](const SketchCurve& curve, int i, int step) {
    return curve.closed || (i + step >= 0 && i + step < curve.size());
  };
  return (has_next(first(), at.i, 1) && has_next(second(), at.j, way)) ||
         (has_next(first(), at.i, -1) && has_next(second(), at.j, -way));
}

/// Whether the borders run alike (+1) or against each other: by their directions over a part that
/// noise at an end does not turn; where these are no answer, so that there is a patch.
int PatchSweep::same_sense(const DrawnRuling& at) const {
  const auto direction = [&](const SketchCurve& curve, int i) {
    const int half_width = std::max(half_width_, curve.size() / kSensePart);
    return evaluate(net_, tangent_form(curve, i, half_width)).normalized();
  };
  const double cosine = direction(first(), at.i).dot(direction(second(), at.j));
  const int way = cosine >= 0 ? 1 : -1;
  return goes_on(at, way) || std::abs(cosine) > kClearSense ? way : -way;
}

NodeRun PatchSweep::run_to_end(const SketchCurve& curve, int from, int way) const {
  if (curve.closed) return {from, way, curve.size() + 1, false};
  return {from, way, way > 0 ? curve.size() - from : from + 1, true};
}

BorderRun PatchSweep::samples(const SketchCurve& curve, const NodeRun& run) const {
  BorderRun border;
  for (int k = 0; k < run.count; ++k) {
    border.points.push_back(net_.points[node_of(curve, run.number(k))]);
    border.tangents.push_back(tangent(curve, run.number(k), run.way));
  }
  return border;
}

/// In the order of a border that is open, when there is one: a closed one is entered anywhere.
void PatchSweep::order(std::vector<DrawnRuling>& drawn) const {
  const bool by_second = first().closed && !second().closed;
  const int way = patch_.second_way;
  std::stable_sort(drawn.begin(), drawn.end(), [&](const DrawnRuling& x, const DrawnRuling& y) {
    return by_second ? way * x.j < way * y.j : x.i < y.i;
  });
}

/// Warps two runs and appends what it finds, in the order of the runs; the ruling that they start
/// from is there already unless they are the first.
void PatchSweep::sweep(const NodeRun& a, const NodeRun& b) {
  if (a.count < 2 || b.count < 2) return;
  const WarpEnd end = a.ends == b.ends ? WarpEnd::both_end
                      : a.ends         ? WarpEnd::second_open
                                       : WarpEnd::first_open;
  const RulingPath path = warp_rulings(samples(first(), a), samples(second(), b), end, options_);
  const std::size_t begin = patch_.cells.empty() ? 0 : 1;
  for (std::size_t i = begin; i < path.image.size(); ++i)
    patch_.rulings.push_back({a.number(static_cast<int>(i)), b.begin + b.way * path.image[i],
                              i == 0 || i + 1 == path.image.size()});
  const std::vector<std::array<int, 2>> cells = cells_of(path.image);
  for (std::size_t k = begin; k < cells.size(); ++k)
    patch_.cells.push_back({a.number(cells[k][0]), b.number(cells[k][1])});
}

/// From one drawn ruling forward to the next; a way of no nodes leads once around a closed border.
void PatchSweep::sweep_between(const DrawnRuling& from, const DrawnRuling& to) {
  const int way = patch_.second_way;
  int i_steps = to.i - from.i, j_steps = way * (to.j - from.j);
  if (first().closed && i_steps <= 0) i_steps += first().size();
  if (second().closed && j_steps <= 0) j_steps += second().size();
  if (i_steps <= 0 || j_steps <= 0) {
    throw Error("drawn rulings cross or meet", "strokes '" + from.id + "' and '" + to.id + "'",
                "the same order along both borders");
  }
  const std::array<int, 2> here =
      patch_.cells.empty() ? std::array<int, 2>{from.i, from.j} : patch_.cells.back();
  sweep({here[0], 1, i_steps + 1, true}, {here[1], way, j_steps + 1, true});
}

/// From the last drawn ruling forward or from the first one backward, to the ends.
void PatchSweep::sweep_beyond(const DrawnRuling& from, int way) {
  const std::array<int, 2> here =
      patch_.cells.empty() ? std::array<int, 2>{from.i, from.j} : patch_.cells.back();
  NodeRun a = run_to_end(first(), from.i, way);
  NodeRun b = run_to_end(second(), from.j, way * patch_.second_way);
  a.begin = here[0];
  b.begin = here[1];
  sweep(a, b);
}

RuledPatch PatchSweep::run(std::vector<DrawnRuling> drawn) {
  patch_.id = drawn.front().id;
  patch_.second_way = same_sense(drawn.front());
  patch_.around = first().closed && second().closed;
  order(drawn);
  if (!patch_.around) {
    sweep_beyond(drawn.front(), -1);
    std::reverse(patch_.rulings.begin(), patch_.rulings.end());
    std::reverse(patch_.cells.begin(), patch_.cells.end());
  }
  for (std::size_t k = 0; k + 1 < drawn.size(); ++k) sweep_between(drawn[k], drawn[k + 1]);
  if (patch_.around) {
    sweep_between(drawn.back(), drawn.front());
  } else {
    sweep_beyond(drawn.back(), 1);
  }
  if (patch_.cells.empty()) {
    throw Error("no patch on either side of the ruling: its borders end there",
                "stroke '" + patch_.id + "'", "borders that go on");
  }
  return patch_;
}

}  // namespace

std::vector<RuledPatch> sweep_ruled_patches(const View& view, const CurveNet& net, int half_width,
                                            const RulingWarpOptions& options) {
  std::vector<RuledPatch> patches;
  for (const auto& [borders, drawn] : read_rulings(view, net))
    patches.push_back(PatchSweep(net, borders, half_width, options).run(drawn));
  return patches;
}

}  // namespace geoprior::sketch
