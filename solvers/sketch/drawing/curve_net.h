#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/options.h"
#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// How the borders of a one-view drawing become sampled curves.
struct CurveNetOptions {
  int samples = 96;  ///< on the longest curve
  double snap = 0.02;
};
void describe(OptionVisitor& v, CurveNetOptions& options);

/// A linear form over the nodes: sum of coefficient times node.
using NodeForm = std::vector<std::pair<int, double>>;

/// A border without corners, sampled at even distances. Curves that meet share nodes.
struct SketchCurve {
  std::string id;                   ///< of its stroke
  int stroke = -1;                  ///< of the view
  std::vector<std::string> panels;  ///< that its stroke names ("roof + gable")
  bool closed = false;              ///< the last node is joined to the first
  std::vector<int> nodes;           ///< in order; a loop with a corner ends with its first node
  std::vector<double> drawn_at;     ///< of each node: point of the stroke, with its fraction

  [[nodiscard]] int size() const { return static_cast<int>(nodes.size()); }
};

/// Place on a curve: a number of a node and the fraction of the way to the next.
struct CurvePoint {
  int curve = -1;
  double at = 0;
};

/// Of the snapping distance: nearer, even opposite sides of a panel touch, as at the tips of a
/// visor.
inline constexpr double kTouches = 0.1;
/// Deviations of the noise within which ends meet, however finely they are snapped.
inline constexpr double kSnapNoise = 3;
/// Of the diagonal of the drawing: by so much a hand misses a border with the end of a ruling or of
/// a pair, however finely ends are snapped.
inline constexpr double kMarkMiss = 0.03;

/// All borders of a view.
struct CurveNet {
  std::vector<Eigen::Vector2d> points;  ///< of the nodes, in the view (m)
  std::vector<bool> hidden;             ///< nodes that something hides
  std::vector<SketchCurve> curves;
  double spacing = 0;   ///< between nodes of a curve (m), up to rounding to a whole number
  double diagonal = 0;  ///< of the box about all borders (m)
  double snap = 0;      ///< m
};

/// Borders and occlusions of a view as curves: strokes are cut at corners (a vertex that turns by
/// more than 40 degrees between two chords of more than three spacings each), ends that lie
/// within `snap` of each other become one node, an end within `snap` of the inside of another curve
/// becomes that curve's nearest node unless they name panels and have none in common, or a drawn
/// ruling joins the two strokes and the end does not touch, or is hidden (one merely covers the
/// other then), and a stroke whose two ends meet each other only, without a corner, is closed. An
/// occlusion that runs along a border (to `snap`, root mean square) marks the part of it that
/// something hides; another one is a border that is hidden whole.
///
/// @throws Error  when no border is drawn, or a stroke has no length (names it)
CurveNet build_curve_net(const View& view, const CurveNetOptions& options);

/// Node number `i` of a curve, counted on around a closed one; inside the range for an open one.
int node_of(const SketchCurve& curve, int i);

/// Three nodes in a row on a curve.
struct CurveTurn {
  int before = -1, at = -1, after = -1;
  double from_before = 0, to_after = 0;  ///< distances in the view, positive (m)

  /// Brings a difference of slopes at the middle node to a curvature by the drawing's diagonal.
  [[nodiscard]] double scale(double diagonal) const {
    return diagonal * diagonal / ((from_before + to_after) / 2);
  }
};

/// Every triple of distinct consecutive nodes, curve by curve; around the closed ones.
std::vector<CurveTurn> turns(const CurveNet& net);

/// Position on a curve by linear interpolation, as a form over at most two nodes.
NodeForm position_form(const CurveNet& net, const CurvePoint& where);

/// Tangent at a node: derivative, by node number, of the least-squares parabola through the nodes
/// up to `half_width` away; one-sided at open ends. Form over those nodes: the same form on the
/// depths is the tangent's depth.
NodeForm tangent_form(const SketchCurve& curve, int i, int half_width);
/// Between nodes, interpolated.
NodeForm tangent_form(const SketchCurve& curve, double at, int half_width);

/// Value of a form on positions in the view.
Eigen::Vector2d evaluate(const CurveNet& net, const NodeForm& form);

/// A place on a border near a point.
struct NearestOnNet {
  CurvePoint place;  ///< curve -1: none
  double distance = 0;
};
/// Nearest place on one border.
NearestOnNet nearest_on_curve(const CurveNet& net, int curve, const Eigen::Vector2d& point);

/// How far from borders the ends of rulings may lie, which are drawn onto them by hand (m).
double reach_of_rulings(const CurveNet& net);

/// The two different borders on which the ends of a stroke lie within reach, with the least sum of
/// distances: one that is nearest to both ends belongs to one of them.
/// @param from_first   distance of each border from the first end; `from_second` of the second
/// @return without two such borders the nearest one for each end, -1 for none within reach
std::array<int, 2> two_borders(const std::vector<double>& from_first,
                               const std::vector<double>& from_second, double reach);

/// Places of the two ends of a ruling on two different borders of the panel that it names, or of
/// any, with the least sum of distances.
/// @return a place without a curve for an end that lies on no border; two places on one curve when
///         there is no other border for either end
std::array<CurvePoint, 2> ruling_ends(const CurveNet& net, const Stroke& ruling);

}  // namespace geoprior::sketch
