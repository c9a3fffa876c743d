#include "solvers/sketch/one_view.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string_view>

#include "core/connectivity.h"
#include "core/error.h"
#include "solvers/sketch/drawing/dense_matches.h"
#include "solvers/sketch/drawing/faired_borders.h"
#include "solvers/sketch/drawing/symmetric_pairs.h"
#include "solvers/sketch/drawing/unpaired_borders.h"
#include "solvers/sketch/surface/fair_patch.h"
#include "solvers/sketch/surface/ruled_patches.h"

namespace geoprior::sketch {
namespace {

/// Solves with the surface's own Laplacian in panels without rulings.
/// Ours.
constexpr int kFairSolves = 6;

/// Vertices nearer to the mirror plane than this share of the spacing are put onto it.
constexpr double kPlaneReach = 0.1;
/// Halves whose visible borders differ by less than this share are equally visible.
constexpr double kEvenHalves = 0.02;

/// Weight of the ratio of the drawn vectors' lengths when it is held.
constexpr double kHeldRatio = 1;
/// Of the cost with the ratio held over that without: above it, the vectors were drawn unequal.
constexpr double kClearGain = 3;
/// Deviations of the ratio's logarithm above which noise does not explain it.
constexpr double kClearRatio = 3;
/// Deviations of the noise below which a panel is too narrow to be sure of.
constexpr double kNarrowPanel = 30;
/// Noise over the diagonal at which a drawn point is held half as much as in an exact drawing; and
/// by how much less it is held at most: a tenth of that leaves more depth wrong in ten drawings
/// each of four objects, ten times that lets panels fold.
constexpr double kSureShare = 1e-4;
constexpr double kMostFreedom = 14;
/// What an end of a pair misses in a drawing without noise, over the diagonal.
constexpr double kPairMiss = 5e-4;

constexpr std::array<std::string_view, 4> kCompletionNames{"all", "mirror", "parallel", "none"};

/// 1 for the nodes that no drawn stroke passes through.
std::vector<double> guessed_nodes(const OneViewResult& result) {
  std::vector<double> guessed(result.net.points.size(), 1);
  for (const SketchCurve& curve : result.net.curves) {
    for (int i = 0; i < curve.size(); ++i)
      if (result.completed.place(curve.stroke, curve.drawn_at[i]).stroke >= 0)
        guessed[curve.nodes[i]] = 0;
  }
  return guessed;
}

/// Triangles of all patches over the nodes of the net, then inner vertices.
class SurfaceBuilder {
 public:
  explicit SurfaceBuilder(const OneViewResult& result)
      : result_(result), guessed_(guessed_nodes(result)) {
    for (Eigen::Index v = 0; v < result.depth.nodes.rows(); ++v)
      positions_.push_back(result.depth.nodes.row(v).transpose());
  }
  void add_strip(const RuledStrip& strip, int patch);
  void add_panel(const std::vector<int>& loop, const TriMesh& mesh, int patch);
  [[nodiscard]] TexturedSurface surface(const Eigen::AlignedBox2d& picture) const;
  [[nodiscard]] double guessed_share() const;

 private:
  const OneViewResult& result_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<double> guessed_;  ///< of each position: 1 on a guessed border, 0 on a drawn one
  std::vector<Eigen::Vector3i> triangles_;
  std::vector<int> patch_;
};

void SurfaceBuilder::add_strip(const RuledStrip& strip, int patch) {
  for (Eigen::Index t = 0; t < strip.triangles.rows(); ++t) {
    triangles_.emplace_back(strip.node[strip.triangles(t, 0)], strip.node[strip.triangles(t, 1)],
                            strip.node[strip.triangles(t, 2)]);
    patch_.push_back(patch);
  }
}

void SurfaceBuilder::add_panel(const std::vector<int>& loop, const TriMesh& mesh, int patch) {
  std::vector<int> vertex = loop;
  double mean = 0;
  for (const int node : loop) mean += guessed_[node] / static_cast<double>(loop.size());
  guessed_.resize(positions_.size() + mesh.V.rows() - loop.size(), mean);
  for (Eigen::Index v = loop.size(); v < mesh.V.rows(); ++v) {
    vertex.push_back(static_cast<int>(positions_.size()));
    positions_.push_back(mesh.V.row(v).transpose());
  }
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    triangles_.emplace_back(vertex[mesh.F(t, 0)], vertex[mesh.F(t, 1)], vertex[mesh.F(t, 2)]);
    patch_.push_back(patch);
  }
}

/// A triangle counts by the share of its vertices that is guessed.
double SurfaceBuilder::guessed_share() const {
  double guessed = 0, whole = 0;
  for (const Eigen::Vector3i& t : triangles_) {
    const Eigen::Vector3d &a = positions_[t(0)], &b = positions_[t(1)], &c = positions_[t(2)];
    const double area = (b - a).cross(c - a).norm() / 2;
    whole += area;
    guessed += area * (guessed_[t(0)] + guessed_[t(1)] + guessed_[t(2)]) / 3;
  }
  return whole > 0 ? guessed / whole : 0;
}

/// Only vertices that triangles use, in the order of the triangles.
TexturedSurface SurfaceBuilder::surface(const Eigen::AlignedBox2d& picture) const {
  TexturedSurface s;
  std::vector<int> number(positions_.size(), -1);
  std::vector<int> used;
  s.mesh.F.resize(triangles_.size(), 3);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int v = triangles_[t](k);
      if (number[v] < 0) {
        number[v] = static_cast<int>(used.size());
        used.push_back(v);
      }
      s.mesh.F(t, k) = number[v];
    }
  }
  const Eigen::Index count = used.size();
  s.mesh.V.resize(count, 3);
  s.texture.resize(count, 2);
  const Eigen::Vector2d size = picture.sizes().cwiseMax(1e-300);
  for (Eigen::Index v = 0; v < count; ++v) {
    const int source = used[v];
    s.mesh.V.row(v) = positions_[source].transpose();
    // What was drawn is textured where it was drawn, not where the solution moved it.
    const bool is_node = source < std::ssize(result_.net.points);
    const Eigen::Vector2d at =
        is_node ? result_.net.points[source] : Eigen::Vector2d(positions_[source].head<2>());
    s.texture.row(v) = (at - picture.min()).cwiseQuotient(size).transpose();
  }
  s.patch = patch_;
  s.mirror_image.assign(patch_.size(), false);
  return s;
}

/// Sum of area times height over the centre: positive when triangles face outward.
double outwardness(const TriMesh& mesh, const std::vector<int>& triangles) {
  Eigen::RowVector3d centre(0, 0, 0);
  for (const int t : triangles)
    for (int k = 0; k < 3; ++k)
      centre += mesh.V.row(mesh.F(t, k)) / (3.0 * static_cast<double>(triangles.size()));
  double sum = 0;
  double depth = 0;
  double scale = 0;
  for (const int t : triangles) {
    const Eigen::Vector3d a = (mesh.V.row(mesh.F(t, 0)) - centre).transpose();
    const Eigen::Vector3d b = (mesh.V.row(mesh.F(t, 1)) - centre).transpose();
    const Eigen::Vector3d c = (mesh.V.row(mesh.F(t, 2)) - centre).transpose();
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    sum += normal.dot(a);
    depth += normal.z();
    scale += normal.norm() * std::max({a.norm(), b.norm(), c.norm()});
  }
  return std::abs(sum) > 1e-6 * scale ? sum : depth;  // a plane piece faces the eye
}

/// Turns triangles so that neighbours agree and every connected piece faces outward.
void orient_surface(TriMesh& mesh) {
  const EdgeConnectivity edges(mesh.F);
  const Eigen::MatrixX3i F = mesh.F;
  std::vector<int> sense(F.rows(), 0);
  for (Eigen::Index seed = 0; seed < F.rows(); ++seed) {
    if (sense[seed] != 0) continue;
    sense[seed] = 1;
    std::vector<int> piece{static_cast<int>(seed)};
    for (std::size_t next = 0; next < piece.size(); ++next) {
      for (int k = 0; k < 3; ++k) {
        const int h = 3 * piece[next] + k;
        const int twin = edges.twin(h);
        if (twin < 0 || sense[twin / 3] != 0) continue;
        const bool agree = edges.origin(h) != edges.origin(twin);
        sense[twin / 3] = agree ? sense[piece[next]] : -sense[piece[next]];
        piece.push_back(twin / 3);
      }
    }
    for (const int t : piece)
      if (sense[t] < 0) std::swap(mesh.F(t, 1), mesh.F(t, 2));
    if (outwardness(mesh, piece) < 0)
      for (const int t : piece) std::swap(mesh.F(t, 1), mesh.F(t, 2));
  }
}

/// Length of the borders that nothing hides, on the positive side and on the other (m).
std::array<double, 2> visible_lengths(const OneViewResult& result) {
  std::array<double, 2> length{0, 0};
  const CurveNet& net = result.net;
  for (const SketchCurve& curve : net.curves) {
    const int chords = curve.closed ? curve.size() : curve.size() - 1;
    for (int i = 0; i < chords; ++i) {
      const int a = node_of(curve, i), b = node_of(curve, i + 1);
      if (net.hidden[a] && net.hidden[b]) continue;
      const Eigen::Vector3d p = result.depth.nodes.row(a).transpose();
      const Eigen::Vector3d q = result.depth.nodes.row(b).transpose();
      const bool positive = signed_distance(result.planes.chosen, (p + q) / 2) > 0;
      length[positive ? 0 : 1] += (q - p).norm();
    }
  }
  return length;
}

Eigen::AlignedBox2d picture_box(const View& view, const CurveNet& net) {
  Eigen::AlignedBox2d box;
  const Picture& picture = view.picture;
  if ((picture.size.array() > 0).all()) {
    box.extend(picture.origin);
    box.extend(picture.origin + picture.size);
  } else {
    for (const Eigen::Vector2d& p : net.points) box.extend(p);
  }
  return box;
}

/// The panel that both borders of a ruled patch name, else its first drawn ruling.
std::string name_of_patch(const CurveNet& net, const RuledPatch& patch) {
  const std::vector<std::string>& second = net.curves[patch.second].panels;
  for (const std::string& name : net.curves[patch.first].panels) {
    if (std::find(second.begin(), second.end(), name) != second.end()) return name;
  }
  return patch.id;
}

/// Whether one border of a patch is the parallel copy of the other.
bool is_copied(const CompletedView& completed, const CurveNet& net, const RuledPatch& patch) {
  const int a = net.curves[patch.first].stroke, b = net.curves[patch.second].stroke;
  return std::any_of(completed.copies.begin(), completed.copies.end(), [&](const auto& copy) {
    return (copy[0] == a && copy[1] == b) || (copy[0] == b && copy[1] == a);
  });
}

/// Refined with the drawn vectors' ratio held, or without it where that costs clearly less and
/// gives a ratio that noise does not explain.
RefinedDepth refine_either(const View& view, const DepthProblem& problem, double noise,
                           const DepthSolution& linear, const OneViewOptions& options) {
  RefineOptions refine = *options.refine;
  const bool free_ratio = refine.vector_ratio == 0;
  if (free_ratio) refine.vector_ratio = kHeldRatio;
  RefinedDepth held =
      refine_depth(view, problem, linear, options.depth, options.vector_ratio, refine);
  if (!free_ratio) return held;
  DepthProblem other = problem;
  other.plane = plane_from_pairs(view, problem.plane);
  if (noise > 0)
    other.pairs =
        read_symmetric_pairs(view, problem.net, other.plane, options.pair_tolerance, noise);
  other.matches =
      dense_matches(problem.net, other.pairs, other.plane, options.depth.tangent_half_width);
  RefinedDepth found = refine_depth(view, other, solve_depth(other, options.depth), options.depth,
                                    options.vector_ratio, *options.refine);
  found.ratio_gain = held.ratio_gain = held.cost_after / std::max(found.cost_after, 1e-300);
  const double unlike = std::abs(std::log(found.vector_ratio / options.vector_ratio));
  const double spread = spread_of_ratio(view, problem.plane, noise);
  return held.ratio_gain > kClearGain && unlike > kClearRatio * spread ? found : held;
}

/// Fills the patches and welds them.
void fill_patches(const View& view, const std::vector<DrawnPanel>& panels, OneViewResult& result) {
  SurfaceBuilder builder(result);
  const Eigen::MatrixX3d& nodes = result.depth.nodes;
  for (const RuledPatch& ruled : result.rulings) {
    OneViewPatch patch{
        name_of_patch(result.net, ruled), true, false, ruled_strip(result.net, ruled, nodes), {}};
    patch.unrolled = unroll_strip(patch.strip, nodes);
    builder.add_strip(patch.strip, static_cast<int>(result.patches.size()));
    result.patches.push_back(std::move(patch));
  }
  for (const DrawnPanel& panel : panels) {
    Eigen::MatrixX3d border(panel.loop.size(), 3);
    for (std::size_t k = 0; k < panel.loop.size(); ++k) border.row(k) = nodes.row(panel.loop[k]);
    const std::string where = "panel '" + panel.name + "'";
    const TriMesh mesh = panel.flat ? flat_patch(border, where)
                                    : fair_patch(border, result.net.spacing, kFairSolves, where);
    builder.add_panel(panel.loop, mesh, static_cast<int>(result.patches.size()));
    result.patches.push_back({panel.name, false, panel.flat, {}, {}});
  }
  result.surface = builder.surface(picture_box(view, result.net));
  result.guessed_area = builder.guessed_share();
  orient_surface(result.surface.mesh);
}

FairedView faired_view(const View& view, const OneViewOptions& options) {
  return options.fair ? faired_borders(view, options.curves.snap) : FairedView{view, 0, 0};
}

/// Ends meet within what noise moves them by; a pair counts less the less its ends are sure, beside
/// matches, which are as sure as faired borders; and refined points are held less to where they
/// were drawn.
OneViewOptions fit_for_noise(OneViewOptions options, const FairedView& faired) {
  if (!(faired.noise > 0)) return options;
  const double share = faired.noise / faired.diagonal;
  options.curves.snap = std::max(options.curves.snap, kSnapNoise * share);
  options.depth.pairs /= 1 + (share / kPairMiss) * (share / kPairMiss);
  if (options.refine)
    options.refine->accuracy /= 1 + std::min(std::pow(share / kSureShare, 2), kMostFreedom);
  return options;
}

/// Least width of points, across the direction in which they reach farthest (m).
double least_width(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d mean(0, 0);
  for (const Eigen::Vector2d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points) moment += (p - mean) * (p - mean).transpose();
  const Eigen::Vector2d across =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(moment).eigenvectors().col(0);
  double low = 0, high = 0;
  for (const Eigen::Vector2d& p : points) {
    low = std::min(low, across.dot(p - mean));
    high = std::max(high, across.dot(p - mean));
  }
  return high - low;
}

/// Which borders have a depth that no symmetry tells, in a sentence; empty when there is none, and
/// of a drawing that is refused.
std::string pairs_note(const View& view, const MirrorPlane& plane, double noise,
                       const OneViewOptions& options) {
  std::vector<std::string> ids;
  try {
    const CurveNet net = build_curve_net(view, options.curves);
    const std::vector<SymmetricPair> pairs =
        read_symmetric_pairs(view, net, plane, options.pair_tolerance, noise);
    ids = unpaired_borders(view, net, pairs);
  } catch (const Error&) {
    return "";  // the reconstruction says why
  }
  std::string text;
  for (const std::string& id : ids) text += (text.empty() ? "'" : ", '") + id + "'";
  if (text.empty()) return text;
  return "no symmetric pair ends on " + text +
         ": how far away it lies follows from rulings alone, and may be wrong by the object's own "
         "size; draw a pair on it, or a mark where it crosses the mirror plane";
}

/// Which panels are too narrow for the noise, in a sentence; empty when none is.
std::string noise_note(const FairedView& faired) {
  std::map<std::string, std::vector<Eigen::Vector2d>> borders;
  for (const Stroke& stroke : faired.view.strokes) {
    if (stroke.kind != StrokeKind::border) continue;
    for (const std::string& panel : panels_in(stroke.name))
      borders[panel].insert(borders[panel].end(), stroke.points.begin(), stroke.points.end());
  }
  std::string narrow;
  for (const auto& [panel, points] : borders) {
    if (points.empty() || least_width(points) >= kNarrowPanel * faired.noise) continue;
    narrow += (narrow.empty() ? "'" : ", '") + panel + "'";
  }
  if (narrow.empty()) return "";
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(),
                "drawn points are off by about %.2f %% of the drawing's diagonal: the sizes of "
                "panels that are drawn ",
                100 * faired.noise / faired.diagonal);
  return std::string(text.data()) + "narrower than " +
         std::to_string(static_cast<int>(kNarrowPanel)) +
         " times that, and depth beside them, are not to be relied upon: " + narrow;
}

}  // namespace

void describe(OptionVisitor& v, OneViewOptions& o) {
  describe_group(v, "curves", o.curves, {.doc = "how borders are sampled"});
  describe_group(v, "rulings", o.rulings, {.doc = "how rulings are found by time warping"});
  describe_group(v, "depth", o.depth, {.doc = "weights of the quadratic energy"});
  v.value("vector_ratio", o.vector_ratio,
          {.doc = "length in space of sym-a over that of sym-b", .min = 1e-3, .max = 1e3});
  v.value("pair_tolerance", o.pair_tolerance,
          {.doc = "tolerance on the direction of a symmetric pair, over the drawing's diagonal",
           .min = 1e-6,
           .max = 1});
  v.value("mirror", o.mirror, {.doc = "whether the more visible half is kept and mirrored"});
  v.value("disagreement", o.disagreement,
          {.doc = "pixels of the photograph by which it and the drawing may disagree: colours of a "
                  "texture that lie so near to a panel's border go on from farther inside",
           .min = 0,
           .max = 50});
  v.value("fair", o.fair, {.doc = "whether trembling borders are faired before all else"});
  describe_choice(v, "complete", o.complete, kCompletionNames,
                  {.doc = "what hidden parts of borders are guessed from, in a drawing that marks "
                          "none: mirror images, parallel borders, both, or nothing"});
  describe_group(v, "refine", o.refine,
                 {.doc = "non-linear least squares with the mirror plane free, after the linear"});
}

OneViewResult reconstruct_one_view(const View& drawn, const OneViewOptions& asked) {
  if (drawn.kind != ViewKind::photo)
    throw Error("reconstruction from one view needs a photo view", view_name(drawn.kind), "photo");
  OneViewResult result;
  result.disagreement = asked.disagreement;
  result.planes = drawn_mirror_planes(drawn, asked.vector_ratio);
  const FairedView faired = faired_view(drawn, asked);
  result.noise = faired.noise;
  result.completed = complete_borders(faired.view, result.planes.chosen, asked.curves.snap,
                                      asked.complete, faired.noise);
  const View& view = result.completed.view;
  const MirrorPlane plane = result.planes.chosen;
  const OneViewOptions options = fit_for_noise(asked, faired);
  const int half_width = options.depth.tangent_half_width;
  result.net = build_curve_net(view, options.curves);
  DepthProblem problem{result.net, plane, {}, {}, {}, {}, {}};
  problem.pairs =
      read_symmetric_pairs(view, result.net, plane, options.pair_tolerance, result.noise);
  problem.matches = dense_matches(result.net, problem.pairs, plane, half_width);
  result.matches = static_cast<int>(problem.matches.size());
  problem.ruled = sweep_ruled_patches(view, result.net, half_width, options.rulings);
  result.rulings = problem.ruled;
  for (const RuledPatch& patch : problem.ruled)
    problem.copied.push_back(is_copied(result.completed, result.net, patch));
  const std::vector<DrawnPanel> panels =
      find_drawn_panels(result.net, problem.ruled, options.complete == Completion::none);
  for (const DrawnPanel& panel : panels)
    if (panel.flat) problem.planar.push_back(panel.loop);
  result.depth = solve_depth(problem, options.depth);
  if (options.refine) {
    result.refined = refine_either(view, problem, result.noise, result.depth, options);
    result.depth = result.refined->solution;
    result.planes.chosen = result.refined->plane;
  }
  fill_patches(view, panels, result);
  if (!options.mirror || result.surface.mesh.F.rows() == 0) return result;
  const auto [positive, negative] = visible_lengths(result);
  result.kept_positive = positive >= (1 - kEvenHalves) * negative;
  result.surface = mirror_half(result.surface, result.planes.chosen, result.kept_positive,
                               kPlaneReach * result.net.spacing);
  return result;
}

std::vector<std::string> one_view_notes(const View& view, const OneViewOptions& asked) {
  if (view.kind != ViewKind::photo) return {};
  const FairedView faired = faired_view(view, asked);
  const MirrorPlane plane = drawn_mirror_planes(view, asked.vector_ratio).chosen;
  const CompletedView completed =
      complete_borders(faired.view, plane, asked.curves.snap, asked.complete, faired.noise);
  std::vector<std::string> notes{
      completion_note(completed), noise_note(faired),
      pairs_note(completed.view, plane, faired.noise, fit_for_noise(asked, faired))};
  std::erase(notes, "");
  return notes;
}

}  // namespace geoprior::sketch
