#include "baselines/paper/adaptive/remesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "baselines/paper/adaptive/editable_sheet.h"
#include "core/geometry/planar.h"

namespace geoprior::paper {
namespace {

using Kind = EditableSheet::Kind;
using Side = EditableSheet::Side;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Edges longer than kSplit are split; a collapse must leave none longer than kCollapse, and a flip
/// must gain more than kFlip (of what it could, from a straight angle on). Between them nothing
/// happens: every change of the mesh changes the curvature that it measures, and with less room a
/// sheet at rest on a ball was split and collapsed in turn for ever, a millimetre a frame.
constexpr double kSplit = 1, kCollapse = 0.6, kFlip = 0.15;
/// A fold that no flip may cross (rad).
constexpr double kFold = 40 * std::numbers::pi / 180;
/// Flattest triangle that an operation may make: smallest altitude over longest edge.
constexpr double kLeastAltitude = 0.03;
/// Chord over arc that a collapse may leave, as strain: a turn of 60 degrees along the edge.
constexpr double kMostStrain = 0.045;
/// Rounds of each pass: sizes at new vertices are interpolated, so a few rounds suffice.
constexpr int kRounds = 20;

/// An edge by its ends, and where it was when it was noted.
struct Edge {
  int a, b;
  Side hint;
  double length = 0;
};

class Remesher {
 public:
  Remesher(const Sheet& sheet, const std::vector<SizeTensor>& sizes, const ShellState& state)
      : mesh_(state) {
    classify(sheet);
    for (std::size_t v = 0; v < sizes.size(); ++v) mesh_.vertices()[v].size = sizes[v];
  }

  RemeshReport run();
  [[nodiscard]] ShellState state(double time) const { return mesh_.state(time); }

 private:
  void classify(const Sheet& sheet);
  [[nodiscard]] const EditableSheet::Vertex& vertex(int v) const { return mesh_.vertices()[v]; }
  [[nodiscard]] double length(int a, int b) const {
    return metric_length(vertex(b).pattern - vertex(a).pattern, vertex(a).size, vertex(b).size);
  }
  /// Edges whose length passes the test, each once, in the order of the triangles.
  template <class Test>
  [[nodiscard]] std::vector<Edge> edges(Test&& test) const;
  [[nodiscard]] bool should_flip(Side s) const;
  [[nodiscard]] double fold(Side s) const;
  void flip_all();
  /// Flips until the edges on the stack, and those about every flip, are Delaunay.
  void settle();
  void push_triangle(int triangle);
  void push_star(int v);
  bool split_round();
  bool collapse_round();
  bool try_collapse(int v, int w);

  EditableSheet mesh_;
  RemeshReport report_;
  std::vector<Edge> stack_;  ///< edges that may want a flip
  std::vector<int> scratch_;
};

/// Anchors and corners stay, border vertices keep to their straight part, vertices on a handle's
/// segment to that.
void Remesher::classify(const Sheet& sheet) {
  const double tolerance = 1e-9 * width(sheet.pattern);
  auto& vertices = mesh_.vertices();
  for (const EditableSheet::Triangle& t : mesh_.triangles()) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (t.neighbour[k] >= 0) continue;
      vertices[t.vertex[k]].kind = Kind::side;
      vertices[t.vertex[(k + 1) % 3]].kind = Kind::side;
    }
  }
  std::vector<Vector2d> fixed = corners(sheet.pattern);
  for (const auto& cut : sheet.pattern.cuts) fixed.insert(fixed.end(), cut.begin(), cut.end());
  for (const Handle& handle : sheet.handles) {
    const std::vector<Vector2d> anchors = handle.anchors();
    fixed.insert(fixed.end(), anchors.begin(), anchors.end());
  }
  for (EditableSheet::Vertex& v : vertices) {
    const auto is_here = [&](const Vector2d& p) { return (p - v.pattern).norm() <= tolerance; };
    if (std::any_of(fixed.begin(), fixed.end(), is_here)) v.kind = Kind::fixed;
    for (int h = 0; h < std::ssize(sheet.handles); ++h) {
      if (sheet.handles[h].segment && sheet.handles[h].covers(v.pattern)) {
        v.segment = h;
      }
    }
  }
}

template <class Test>
std::vector<Edge> Remesher::edges(Test&& test) const {
  std::vector<Edge> result;
  for (int t = 0; t < static_cast<int>(mesh_.triangles().size()); ++t) {
    const EditableSheet::Triangle& triangle = mesh_.triangles()[t];
    if (triangle.vertex[0] < 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      if (triangle.neighbour[k] > t) continue;
      const int a = triangle.vertex[k], b = triangle.vertex[k == 2 ? 0 : k + 1];
      const double l = length(a, b);
      if (test(l)) result.push_back({a, b, {t, static_cast<int>(k)}, l});
    }
  }
  return result;
}

/// Angle between the normals of the two triangles (rad).
double Remesher::fold(Side s) const {
  const Side o = mesh_.opposite(s);
  const Vector3d a = vertex(mesh_.start(s)).x, b = vertex(mesh_.end(s)).x;
  const Vector3d n = (b - a).cross(vertex(mesh_.apex(s)).x - a);
  const Vector3d m = (a - b).cross(vertex(mesh_.apex(o)).x - b);
  return std::atan2(n.cross(m).norm(), n.dot(m));
}

/// The angles opposite to the edge, at c and d, exceed a straight angle in the metric there:
/// sin(c + d) < 0, with sines proportional to areas and cosines to products in the metric.
bool Remesher::should_flip(Side s) const {
  const Side o = mesh_.opposite(s);
  if (o.triangle < 0) return false;
  const auto &a = vertex(mesh_.start(s)), &b = vertex(mesh_.end(s)), &c = vertex(mesh_.apex(s)),
             &d = vertex(mesh_.apex(o));
  const SizeTensor M = (a.size + b.size + c.size + d.size) / 4;
  const Vector2d ca = a.pattern - c.pattern, cb = b.pattern - c.pattern;
  const Vector2d db = b.pattern - d.pattern, da = a.pattern - d.pattern;
  const double sine_c = cross(ca, cb), cosine_c = ca.dot(M * cb);
  const double sine_d = cross(db, da), cosine_d = db.dot(M * da);
  const double margin = kFlip * (std::abs(sine_c * cosine_d) + std::abs(cosine_c * sine_d));
  return sine_c * cosine_d + cosine_c * sine_d < -margin && mesh_.can_flip(s, kLeastAltitude) &&
         fold(s) < kFold;
}

void Remesher::push_triangle(int triangle) {
  for (int k = 0; k < 3; ++k) {
    const Side s{triangle, k};
    stack_.push_back({mesh_.start(s), mesh_.end(s), s});
  }
}

void Remesher::push_star(int v) {
  mesh_.star(v, scratch_);
  for (const int t : scratch_) push_triangle(t);
}

void Remesher::settle() {
  // A metric that varies has no Delaunay triangulation to end at: the budget ends a cycle.
  std::size_t budget = 3 * stack_.size() + 30;
  while (!stack_.empty() && budget-- > 0) {
    const Edge e = stack_.back();
    stack_.pop_back();
    const Side s = mesh_.find(e.a, e.b, e.hint);
    if (s.triangle < 0 || !should_flip(s)) continue;
    const int other = mesh_.opposite(s).triangle;
    mesh_.flip(s);
    ++report_.flips;
    push_triangle(s.triangle);
    push_triangle(other);
  }
  stack_.clear();
}

void Remesher::flip_all() {
  stack_ = edges([](double) { return true; });
  settle();
}

bool Remesher::split_round() {
  std::vector<Edge> longest = edges([](double l) { return l > kSplit; });
  std::sort(longest.begin(), longest.end(), [](const Edge& p, const Edge& q) {
    return std::tie(q.length, p.a, p.b) < std::tie(p.length, q.a, q.b);
  });
  for (const Edge& e : longest) {
    const Side s = mesh_.find(e.a, e.b, e.hint);
    if (s.triangle < 0) continue;  // flipped away
    push_star(mesh_.split(s));
    ++report_.splits;
    settle();
  }
  return !longest.empty();
}

bool Remesher::try_collapse(int v, int w) {
  if (vertex(v).kind == Kind::fixed) return false;
  const bool too_long = mesh_.around(v, [&](int t, int k) {
    const int r = mesh_.end({t, k}), q = mesh_.apex({t, k});
    return (r != w && length(w, r) > kCollapse) || (q != w && length(w, q) > kCollapse);
  });
  if (too_long) return false;
  if (!mesh_.can_collapse(v, w, kLeastAltitude, kMostStrain)) return false;
  mesh_.collapse(v, w);
  ++report_.collapses;
  push_star(w);
  settle();
  return true;
}

bool Remesher::collapse_round() {
  std::vector<Edge> shortest = edges([](double l) { return l < kCollapse; });
  std::sort(shortest.begin(), shortest.end(), [](const Edge& p, const Edge& q) {
    return std::tie(p.length, p.a, p.b) < std::tie(q.length, q.a, q.b);
  });
  bool any = false;
  for (const Edge& e : shortest) {
    if (mesh_.find(e.a, e.b, e.hint).triangle < 0) continue;
    // The later vertex goes first: what a split has made a collapse unmakes.
    const auto [earlier, later] = std::minmax({e.a, e.b});
    any = try_collapse(later, earlier) || try_collapse(earlier, later) || any;
  }
  return any;
}

RemeshReport Remesher::run() {
  flip_all();
  for (int round = 0; round < kRounds && split_round(); ++round) {
  }
  for (int round = 0; round < kRounds && collapse_round(); ++round) {
  }
  report_.changed = mesh_.changed();
  return report_;
}

}  // namespace

RemeshReport remesh(const Sheet& sheet, const std::vector<SizeTensor>& sizes, ShellState& state) {
  Remesher remesher(sheet, sizes, state);
  RemeshReport report = remesher.run();
  if (report.any()) state = remesher.state(state.time);
  return report;
}

}  // namespace geoprior::paper
