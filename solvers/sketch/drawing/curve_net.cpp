#include "solvers/sketch/drawing/curve_net.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/angles.h"
#include "core/disjoint_sets.h"
#include "core/error.h"
#include "core/geometry/planar.h"

namespace geoprior::sketch {
namespace {

/// A vertex between long chords that turns by more is a corner. Ours; 5 to 100 degrees give the
/// same on every drawing of the experiments.
constexpr double kCornerTurn = 40 * kDegree;

/// A drawn vertex is a corner only between chords of this many spacings, so that the short and
/// trembling chords of a traced curve are none.
constexpr double kLongChord = 3;
/// Ends of rulings may miss by this many snapping distances.
constexpr double kRulingReach = 2;
/// Nodes of a small closed border, so that tangents are not fitted to half of it.
constexpr int kLeastAround = 32;

/// Parameter in [0, 1] of the point of a chord nearest to p.
double nearest_on_chord(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                        const Eigen::Vector2d& b) {
  const double square = (b - a).squaredNorm();
  return square > 0 ? std::clamp((b - a).dot(p - a) / square, 0.0, 1.0) : 0.0;
}

/// Part of a stroke between corners, with the number of each point in the stroke.
struct DrawnPiece {
  int stroke = -1;
  bool closed = false;
  std::vector<Eigen::Vector2d> points;
  std::vector<double> at;
};

double chain_length(const DrawnPiece& piece) {
  double sum = 0;
  for (std::size_t i = 1; i < piece.points.size(); ++i)
    sum += (piece.points[i] - piece.points[i - 1]).norm();
  if (piece.closed) sum += (piece.points.front() - piece.points.back()).norm();
  return sum;
}

/// The stroke without repeated points.
DrawnPiece whole_stroke(const Stroke& stroke, int index) {
  DrawnPiece piece{index, stroke.closed, {}, {}};
  for (std::size_t i = 0; i < stroke.points.size(); ++i) {
    if (!piece.points.empty() && piece.points.back() == stroke.points[i]) continue;
    piece.points.push_back(stroke.points[i]);
    piece.at.push_back(static_cast<double>(i));
  }
  while (piece.closed && piece.points.size() > 1 && piece.points.front() == piece.points.back()) {
    piece.points.pop_back();
    piece.at.pop_back();
  }
  const std::size_t least = piece.closed ? 3 : 2;
  if (piece.points.size() < least) {
    throw Error("border has no length", "stroke '" + stroke.id + "'",
                piece.closed ? "three different points" : "two different points");
  }
  return piece;
}

std::vector<std::size_t> corners_of(const DrawnPiece& piece, double spacing, double turn) {
  const std::size_t n = piece.points.size();
  std::vector<std::size_t> corners;
  const std::size_t first = piece.closed ? 0 : 1, last = piece.closed ? n : n - 1;
  for (std::size_t i = first; i < last; ++i) {
    const Eigen::Vector2d in = piece.points[i] - piece.points[(i + n - 1) % n];
    const Eigen::Vector2d out = piece.points[(i + 1) % n] - piece.points[i];
    if (std::min(in.norm(), out.norm()) < kLongChord * spacing) continue;
    if (std::abs(signed_angle(in, out)) > turn) corners.push_back(i);
  }
  return corners;
}

/// The piece cut at its corners. A closed one with a corner becomes open pieces.
std::vector<DrawnPiece> cut_at_corners(const DrawnPiece& piece, double spacing, double turn) {
  std::vector<std::size_t> cuts = corners_of(piece, spacing, turn);
  if (cuts.empty()) return {piece};
  const std::size_t n = piece.points.size();
  if (piece.closed) {
    cuts.push_back(cuts.front() + n);
  } else {
    cuts.insert(cuts.begin(), 0);
    cuts.push_back(n - 1);
  }
  std::vector<DrawnPiece> parts;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    DrawnPiece part{piece.stroke, false, {}, {}};
    for (std::size_t i = cuts[k]; i <= cuts[k + 1]; ++i) {
      part.points.push_back(piece.points[i % n]);
      part.at.push_back(piece.at[i % n] + (i >= n ? piece.at.back() + 1 : 0.0));
    }
    parts.push_back(part);
  }
  return parts;
}

/// `count` + 1 points at even distances along the piece; the last is left out of a closed one.
DrawnPiece resampled(const DrawnPiece& piece, int count) {
  DrawnPiece even{piece.stroke, piece.closed, {}, {}};
  std::vector<Eigen::Vector2d> points = piece.points;
  std::vector<double> at = piece.at;
  if (piece.closed) {
    points.push_back(points.front());
    at.push_back(at.back() + 1);
  }
  const double step = chain_length(piece) / count;
  std::size_t k = 0;
  double before = 0;  // length up to points[k]
  for (int i = 0; i < (piece.closed ? count : count + 1); ++i) {
    const double wanted = step * i;
    double chord = (points[k + 1] - points[k]).norm();
    while (k + 2 < points.size() && before + chord < wanted) {
      before += chord;
      ++k;
      chord = (points[k + 1] - points[k]).norm();
    }
    const double t = std::clamp((wanted - before) / chord, 0.0, 1.0);
    even.points.push_back((1 - t) * points[k] + t * points[k + 1]);
    even.at.push_back((1 - t) * at[k] + t * at[k + 1]);
  }
  return even;
}

/// Ends of open pieces: end 0 and 1 of piece p are 2 p and 2 p + 1.
struct PieceEnds {
  const std::vector<DrawnPiece>& pieces;
  [[nodiscard]] bool exists(int e) const { return !pieces[e / 2].closed; }
  [[nodiscard]] const Eigen::Vector2d& at(int e) const {
    const DrawnPiece& piece = pieces[e / 2];
    return e % 2 == 0 ? piece.points.front() : piece.points.back();
  }
  [[nodiscard]] int count() const { return 2 * static_cast<int>(pieces.size()); }
};

DisjointSets joined_ends(const PieceEnds& ends, double snap) {
  DisjointSets sets(ends.count());
  for (int e = 0; e < ends.count(); ++e) {
    for (int f = e + 1; f < ends.count(); ++f) {
      if (ends.exists(e) && ends.exists(f) && (ends.at(e) - ends.at(f)).norm() <= snap)
        sets.join(e, f);
    }
  }
  return sets;
}

/// Closes the open pieces whose two ends meet each other and no third, smoothly.
void close_loops(std::vector<DrawnPiece>& pieces, double snap, double turn) {
  const PieceEnds ends{pieces};
  DisjointSets sets = joined_ends(ends, snap);
  std::vector<int> members(ends.count(), 0);
  for (int e = 0; e < ends.count(); ++e) ++members[sets.find(e)];
  for (int p = 0; p < std::ssize(pieces); ++p) {
    DrawnPiece& piece = pieces[p];
    const int e = 2 * p;
    const std::size_t n = piece.points.size();
    if (piece.closed || n < 4 || sets.find(e) != sets.find(e + 1) || members[sets.find(e)] != 2)
      continue;
    const Eigen::Vector2d in = piece.points[n - 1] - piece.points[n - 2];
    const Eigen::Vector2d out = piece.points[1] - piece.points[0];
    if (std::abs(signed_angle(in, out)) > turn) continue;
    piece.points.front() = (piece.points.front() + piece.points.back()) / 2;
    piece.points.pop_back();
    piece.at.pop_back();
    piece.closed = true;
  }
}

double distance_to_stroke(const Eigen::Vector2d& p, const Stroke& stroke) {
  const std::size_t n = stroke.points.size();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + (stroke.closed ? 0 : 1) < n; ++i) {
    const Eigen::Vector2d& a = stroke.points[i];
    const Eigen::Vector2d& b = stroke.points[(i + 1) % n];
    const double t = nearest_on_chord(p, a, b);
    nearest = std::min(nearest, ((1 - t) * a + t * b - p).norm());
  }
  return nearest;
}

/// Whether an occlusion runs along borders; a hand trembles, and single points stray.
bool marks_border(const View& view, const Stroke& occlusion, double reach) {
  double sum = 0;
  for (const Eigen::Vector2d& p : occlusion.points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Stroke& border : view.strokes) {
      if (border.kind == StrokeKind::border)
        nearest = std::min(nearest, distance_to_stroke(p, border));
    }
    sum += nearest * nearest;
  }
  return sum <= reach * reach * static_cast<double>(occlusion.points.size());
}

double drawn_diagonal(const View& view) {
  Eigen::AlignedBox2d box;
  for (const Stroke& stroke : view.strokes) {
    if (stroke.kind != StrokeKind::border && stroke.kind != StrokeKind::occlusion) continue;
    for (const Eigen::Vector2d& p : stroke.points) box.extend(p);
  }
  if (box.isEmpty()) throw Error("no border is drawn", view_name(view.kind), "one border or more");
  return box.diagonal().norm();
}

std::vector<DrawnPiece> drawn_pieces(const View& view, const CurveNetOptions& options,
                                     CurveNet& net) {
  net.diagonal = drawn_diagonal(view);
  net.snap = options.snap * net.diagonal;
  std::vector<DrawnPiece> whole;
  double longest = 0;
  for (int s = 0; s < std::ssize(view.strokes); ++s) {
    const Stroke& stroke = view.strokes[s];
    const bool hidden = stroke.kind == StrokeKind::occlusion;
    if (hidden ? marks_border(view, stroke, net.snap) : stroke.kind != StrokeKind::border) continue;
    whole.push_back(whole_stroke(stroke, s));
    longest = std::max(longest, chain_length(whole.back()));
  }
  net.spacing = longest / options.samples;
  std::vector<DrawnPiece> pieces;
  for (const DrawnPiece& piece : whole) {
    for (DrawnPiece& part : cut_at_corners(piece, net.spacing, kCornerTurn))
      pieces.push_back(std::move(part));
  }
  return pieces;
}

/// Nodes of all curves before ends are joined to the inside of others.
void add_curves(const View& view, const std::vector<DrawnPiece>& pieces, CurveNet& net) {
  DisjointSets sets = joined_ends(PieceEnds{pieces}, net.snap);
  std::vector<int> node_of_end(2 * pieces.size(), -1);
  std::vector<int> joined;  // ends averaged into a node so far
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const Stroke& stroke = view.strokes[pieces[p].stroke];
    const double length = chain_length(pieces[p]);
    const int least = pieces[p].closed ? kLeastAround : 2;
    const DrawnPiece even =
        resampled(pieces[p], std::max(least, static_cast<int>(std::lround(length / net.spacing))));
    SketchCurve curve{stroke.id, pieces[p].stroke, panels_in(stroke.name), even.closed,
                      {},        even.at};
    for (std::size_t i = 0; i < even.points.size(); ++i) {
      const bool end = !even.closed && (i == 0 || i + 1 == even.points.size());
      const int key = end ? sets.find(static_cast<int>(2 * p + (i == 0 ? 0 : 1))) : -1;
      int node = end ? node_of_end[key] : -1;
      if (node < 0) {
        node = static_cast<int>(net.points.size());
        net.points.push_back(even.points[i]);
        joined.push_back(1);
        if (end) node_of_end[key] = node;
      } else {
        net.points[node] += (even.points[i] - net.points[node]) / ++joined[node];
      }
      curve.nodes.push_back(node);
    }
    net.curves.push_back(std::move(curve));
  }
}

bool holds(const SketchCurve& curve, int node) {
  return std::find(curve.nodes.begin(), curve.nodes.end(), node) != curve.nodes.end();
}

/// Borders that an end of a ruling may lie on: those of the panel that it names, else all.
std::vector<int> borders_for_ruling(const CurveNet& net, const Stroke& stroke) {
  std::vector<int> all, named;
  for (int c = 0; c < std::ssize(net.curves); ++c) {
    all.push_back(c);
    if (bounds(net.curves[c].panels, stroke.name)) named.push_back(c);
  }
  return named.size() < 2 ? all : named;
}

/// Whether an occlusion runs by.
bool is_marked_hidden(const View& view, const Eigen::Vector2d& p, double reach) {
  return std::any_of(view.strokes.begin(), view.strokes.end(), [&](const Stroke& stroke) {
    return stroke.kind == StrokeKind::occlusion && distance_to_stroke(p, stroke) <= reach;
  });
}

/// Strokes that a drawn ruling joins, the lower number first: two sides of one panel, which lie
/// apart. Not curves, of which a trembling stroke may be several.
std::set<std::pair<int, int>> opposite_borders(const View& view, const CurveNet& net) {
  std::set<std::pair<int, int>> opposite;
  for (const Stroke& stroke : view.strokes) {
    if (!is_ruling(stroke) || stroke.points.size() < 2) continue;
    const auto [a, b] = ruling_ends(net, stroke);
    if (a.curve < 0 || b.curve < 0 || a.curve == b.curve) continue;
    opposite.insert(std::minmax(net.curves[a.curve].stroke, net.curves[b.curve].stroke));
  }
  return opposite;
}

/// Joins free ends that touch the inside of another curve to its nearest node.
void weld_touching_ends(const View& view, CurveNet& net) {
  const std::set<std::pair<int, int>> opposite = opposite_borders(view, net);
  const auto can_meet = [&](const SketchCurve& a, const SketchCurve& b, double within) {
    return may_meet(a.panels, b.panels) && (within <= kTouches * net.snap || a.stroke == b.stroke ||
                                            !opposite.contains(std::minmax(a.stroke, b.stroke)));
  };
  for (int c = 0; c < std::ssize(net.curves); ++c) {
    if (net.curves[c].closed) continue;
    for (const bool front : {true, false}) {
      int& end = front ? net.curves[c].nodes.front() : net.curves[c].nodes.back();
      int users = 0;
      for (const SketchCurve& curve : net.curves) users += holds(curve, end) ? 1 : 0;
      if (users > 1) continue;
      // A hidden end that seems to touch passes behind.
      const bool hidden = is_marked_hidden(view, net.points[end], net.snap / 2);
      NearestOnNet near{{}, net.snap};
      for (int other = 0; other < std::ssize(net.curves); ++other) {
        if (other == c) continue;
        const NearestOnNet place = nearest_on_curve(net, other, net.points[end]);
        if (place.distance < near.distance &&
            can_meet(net.curves[c], net.curves[other], hidden ? net.snap : place.distance))
          near = place;
      }
      if (near.place.curve < 0) continue;
      const SketchCurve& other = net.curves[near.place.curve];
      end = node_of(other, static_cast<int>(std::lround(near.place.at)));
    }
  }
}

/// Renumbers the nodes by their first use, without those that welding left behind.
void drop_unused_nodes(CurveNet& net) {
  std::vector<int> number(net.points.size(), -1);
  std::vector<Eigen::Vector2d> kept;
  for (SketchCurve& curve : net.curves) {
    for (int& node : curve.nodes) {
      if (number[node] < 0) {
        number[node] = static_cast<int>(kept.size());
        kept.push_back(net.points[node]);
      }
      node = number[node];
    }
  }
  net.points = std::move(kept);
}

/// Nodes along an occlusion.
void mark_hidden(const View& view, CurveNet& net) {
  for (const Eigen::Vector2d& p : net.points)
    net.hidden.push_back(is_marked_hidden(view, p, net.snap / 2));
}

}  // namespace

void describe(OptionVisitor& v, CurveNetOptions& o) {
  v.value("samples", o.samples, {.doc = "samples of the longest border", .min = 12, .max = 2000});
  v.value("snap", o.snap,
          {.doc = "distance of ends that are one junction, over the drawing's diagonal",
           .min = 0,
           .max = 0.2});
}

CurveNet build_curve_net(const View& view, const CurveNetOptions& options) {
  CurveNet net;
  std::vector<DrawnPiece> pieces = drawn_pieces(view, options, net);
  close_loops(pieces, net.snap, kCornerTurn);
  add_curves(view, pieces, net);
  weld_touching_ends(view, net);
  drop_unused_nodes(net);
  mark_hidden(view, net);
  return net;
}

int node_of(const SketchCurve& curve, int i) {
  const int n = curve.size();
  return curve.nodes[curve.closed ? ((i % n) + n) % n : std::clamp(i, 0, n - 1)];
}

std::vector<CurveTurn> turns(const CurveNet& net) {
  std::vector<CurveTurn> all;
  for (const SketchCurve& curve : net.curves) {
    const int n = curve.size();
    for (int i = curve.closed ? 0 : 1; i < (curve.closed ? n : n - 1); ++i) {
      CurveTurn turn{node_of(curve, i - 1), node_of(curve, i), node_of(curve, i + 1)};
      turn.from_before = (net.points[turn.at] - net.points[turn.before]).norm();
      turn.to_after = (net.points[turn.after] - net.points[turn.at]).norm();
      if (turn.before != turn.after && turn.from_before > 0 && turn.to_after > 0)
        all.push_back(turn);
    }
  }
  return all;
}

NodeForm position_form(const CurveNet& net, const CurvePoint& where) {
  const SketchCurve& curve = net.curves[where.curve];
  const double low = std::floor(where.at);
  const double t = where.at - low;
  const int i = static_cast<int>(low);
  if (t == 0) return {{node_of(curve, i), 1.0}};
  return {{node_of(curve, i), 1 - t}, {node_of(curve, i + 1), t}};
}

NodeForm tangent_form(const SketchCurve& curve, int i, int half_width) {
  const int n = curve.size();
  int low = i - half_width, high = i + half_width;
  if (curve.closed) {
    const int widest = (n - 1) / 2;
    low = i - std::min(half_width, widest);
    high = i + std::min(half_width, widest);
  } else {
    low = std::max(low, 0);
    high = std::min(high, n - 1);
  }
  const int count = high - low + 1;
  const int degree = std::min(2, count - 1);
  Eigen::MatrixXd powers(count, degree + 1);
  for (int k = 0; k < count; ++k) {
    const double x = low + k - i;
    powers(k, 0) = 1;
    for (int p = 1; p <= degree; ++p) powers(k, p) = powers(k, p - 1) * x;
  }
  const Eigen::MatrixXd inverse = (powers.transpose() * powers).ldlt().solve(powers.transpose());
  NodeForm form;
  for (int k = 0; k < count; ++k) form.emplace_back(node_of(curve, low + k), inverse(1, k));
  return form;
}

NodeForm tangent_form(const SketchCurve& curve, double at, int half_width) {
  const double low = std::floor(at);
  const double t = at - low;
  const int i = static_cast<int>(low);
  NodeForm form = tangent_form(curve, i, half_width);
  if (t == 0) return form;
  for (auto& [node, c] : form) c *= 1 - t;
  for (const auto& [node, c] : tangent_form(curve, i + 1, half_width))
    form.emplace_back(node, t * c);
  return form;
}

Eigen::Vector2d evaluate(const CurveNet& net, const NodeForm& form) {
  Eigen::Vector2d sum(0, 0);
  for (const auto& [node, c] : form) sum += c * net.points[node];
  return sum;
}

NearestOnNet nearest_on_curve(const CurveNet& net, int curve, const Eigen::Vector2d& point) {
  const SketchCurve& border = net.curves[curve];
  NearestOnNet best{{}, std::numeric_limits<double>::infinity()};
  const int chords = border.closed ? border.size() : border.size() - 1;
  for (int i = 0; i < chords; ++i) {
    const Eigen::Vector2d& a = net.points[node_of(border, i)];
    const Eigen::Vector2d& b = net.points[node_of(border, i + 1)];
    const double t = nearest_on_chord(point, a, b);
    const double distance = ((1 - t) * a + t * b - point).norm();
    if (distance < best.distance) best = {{curve, i + t}, distance};
  }
  return best;
}

double reach_of_rulings(const CurveNet& net) {
  return std::max(kRulingReach * net.snap, kMarkMiss * net.diagonal);
}

std::array<int, 2> two_borders(const std::vector<double>& from_first,
                               const std::vector<double>& from_second, double reach) {
  const int count = static_cast<int>(from_first.size());
  std::array<int, 2> best{-1, -1};
  double least = std::numeric_limits<double>::infinity();
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b) {
      const double sum = from_first[a] + from_second[b];
      if (a == b || from_first[a] >= reach || from_second[b] >= reach || sum >= least) continue;
      least = sum;
      best = {a, b};
    }
  }
  if (best[0] >= 0) return best;
  const auto nearest = [&](const std::vector<double>& distances) {
    const auto least_of = std::min_element(distances.begin(), distances.end());
    if (least_of == distances.end() || *least_of >= reach) return -1;
    return static_cast<int>(least_of - distances.begin());
  };
  return {nearest(from_first), nearest(from_second)};
}

std::array<CurvePoint, 2> ruling_ends(const CurveNet& net, const Stroke& ruling) {
  std::array<std::vector<CurvePoint>, 2> places;
  std::array<std::vector<double>, 2> distances;
  for (const int c : borders_for_ruling(net, ruling)) {
    for (const int k : {0, 1}) {
      const NearestOnNet near =
          nearest_on_curve(net, c, k == 0 ? ruling.points.front() : ruling.points.back());
      places[k].push_back(near.place);
      distances[k].push_back(near.distance);
    }
  }
  const std::array<int, 2> found = two_borders(distances[0], distances[1], reach_of_rulings(net));
  std::array<CurvePoint, 2> ends;
  for (const int k : {0, 1})
    if (found[k] >= 0) ends[k] = places[k][found[k]];
  return ends;
}

}  // namespace geoprior::sketch
