#include "solvers/sketch/drawing/depth_system.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/numerics/sparse_ldlt.h"

namespace geoprior::sketch {
namespace {

/// Least over greatest eigenvalue below which depth is undetermined: some hundred roundings.
constexpr double kSingular = 1e-13;

using DepthMatrix = Eigen::SparseMatrix<double>;

/// Length of the coefficients below which a ruling is left out: images of tangents and ruling that
/// are less than 8 degrees apart, as near a silhouette.
constexpr double kClearRuling = 0.2;

/// Images of tangents and ruling, of unit length.
struct UnitImages {
  Eigen::Vector2d t1, t2, r;
  Eigen::Vector3d lengths;  ///< before they were made units

  /// Coefficients with which the three are dependent.
  [[nodiscard]] Eigen::Vector3d dependence() const {
    return {cross(t2, r), cross(r, t1), cross(t1, t2)};
  }
};

UnitImages unit_images(const CurveNet& net, const RulingForms& forms) {
  const Eigen::Vector2d t1 = evaluate(net, forms.t1), t2 = evaluate(net, forms.t2),
                        r = evaluate(net, forms.r);
  return {t1.normalized(), t2.normalized(), r.normalized(), {t1.norm(), t2.norm(), r.norm()}};
}

/// Rows of the least-squares problem, in the order of the terms.
class DepthRows {
 public:
  DepthRows(const DepthProblem& problem, const DepthOptions& options);

  [[nodiscard]] int unknowns() const { return unknowns_; }
  [[nodiscard]] DepthMatrix matrix() const;
  [[nodiscard]] const Eigen::VectorXd& right_side() const { return right_; }
  void report(const Eigen::VectorXd& x, DepthSolution& solution) const;

 private:
  struct Row {
    DepthTerm term;
    double weight;  ///< of the square, over the number of the term's rows
    std::vector<std::pair<int, double>> terms;
    double right;
  };
  static int unknown(int node, int axis) { return 3 * node + axis; }
  static void add(Row& row, const NodeForm& form, int axis, double factor) {
    for (const auto& [node, c] : form) row.terms.emplace_back(unknown(node, axis), factor * c);
  }
  void add_accuracy();
  void add_variation();
  void add_symmetry(DepthTerm term, const NodeForm& p, const NodeForm& image);
  void add_pairs();
  void add_developability(const RuledPatch& patch);
  void add_plane(DepthTerm term, double weight, int node, int slopes, int height);
  void add_planes();
  void finish();

  const DepthProblem& problem_;
  DepthOptions options_;
  int unknowns_;
  std::vector<Row> rows_;
  Eigen::VectorXd right_;
};

DepthRows::DepthRows(const DepthProblem& problem, const DepthOptions& options)
    : problem_(problem),
      options_(options),
      unknowns_(3 * static_cast<int>(problem.net.points.size())) {
  add_accuracy();
  add_variation();
  add_pairs();
  if (options_.developability > 0) {
    for (const RuledPatch& patch : problem_.ruled) add_developability(patch);
  }
  add_planes();
  finish();
}

void DepthRows::add_accuracy() {
  for (int v = 0; v < std::ssize(problem_.net.points); ++v) {
    for (int axis = 0; axis < 2; ++axis) {
      rows_.push_back({DepthTerm::accuracy,
                       options_.accuracy,
                       {{unknown(v, axis), 1.0}},
                       problem_.net.points[v](axis)});
    }
  }
}

void DepthRows::add_variation() {
  for (const CurveTurn& turn : turns(problem_.net)) {
    const double scale = turn.scale(problem_.net.diagonal);
    rows_.push_back({DepthTerm::variation,
                     options_.variation,
                     {{unknown(turn.before, 2), scale / turn.from_before},
                      {unknown(turn.at, 2), -scale / turn.from_before - scale / turn.to_after},
                      {unknown(turn.after, 2), scale / turn.to_after}},
                     0});
  }
}

/// Across the normal in the picture, in depth, and the middle: three rows of one length unit each.
void DepthRows::add_symmetry(DepthTerm term, const NodeForm& p, const NodeForm& image) {
  const double weight = term == DepthTerm::pairs ? options_.pairs : options_.dense;
  const Eigen::Vector3d n = problem_.plane.normal;
  const Eigen::Vector2d u = across_pairs(problem_.plane);
  // Orthogonal to n and to the direction across: what a difference along n has none of.
  const double flat = n.head<2>().norm();
  const Eigen::Vector3d along(-n.z() * n.x() / flat, -n.z() * n.y() / flat, flat);
  Row across{term, weight, {}, 0}, depth{term, weight, {}, 0},
      middle{term, weight, {}, problem_.plane.offset};
  for (int axis = 0; axis < 3; ++axis) {
    if (axis < 2) {
      add(across, image, axis, u(axis));
      add(across, p, axis, -u(axis));
    }
    add(depth, image, axis, along(axis));
    add(depth, p, axis, -along(axis));
    add(middle, image, axis, n(axis) / 2);
    add(middle, p, axis, n(axis) / 2);
  }
  rows_.push_back(across);
  rows_.push_back(depth);
  rows_.push_back(middle);
}

void DepthRows::add_pairs() {
  const CurveNet& net = problem_.net;
  for (const SymmetricPair& pair : problem_.pairs) {
    add_symmetry(DepthTerm::pairs, position_form(net, pair.point_at.front()),
                 position_form(net, pair.image_at.front()));
  }
  for (const DenseMatch& match : problem_.matches)
    add_symmetry(DepthTerm::dense, {{match.node, 1.0}}, position_form(net, match.image));
}

void DepthRows::add_developability(const RuledPatch& patch) {
  const CurveNet& net = problem_.net;
  for (const RulingForms& ruling : trusted_rulings(net, patch, options_)) {
    const UnitImages u = unit_images(net, ruling);
    const Eigen::Vector3d a = u.dependence();
    Row row{DepthTerm::developability, options_.developability, {}, 0};
    add(row, ruling.t1, 2, net.diagonal * a(0) / u.lengths(0));
    add(row, ruling.t2, 2, net.diagonal * a(1) / u.lengths(1));
    add(row, ruling.r, 2, net.diagonal * a(2) / u.lengths(2));
    rows_.push_back(row);
  }
}

/// z - a x - b y - c = 0 at a node, with the drawn x and y; a, b in lengths per diagonal.
void DepthRows::add_plane(DepthTerm term, double weight, int node, int slopes, int height) {
  const Eigen::Vector2d p = problem_.net.points[node] / problem_.net.diagonal;
  rows_.push_back(
      {term,
       weight,
       {{unknown(node, 2), 1.0}, {slopes, -p.x()}, {slopes + 1, -p.y()}, {height, -1.0}},
       0});
}

void DepthRows::add_planes() {
  for (const std::vector<int>& panel : problem_.planar) {
    const int slopes = unknowns_;
    unknowns_ += 3;
    for (const int node : panel)
      add_plane(DepthTerm::planarity, options_.planarity, node, slopes, slopes + 2);
  }
  for (std::size_t p = 0; p < problem_.ruled.size(); ++p) {
    const RuledPatch& patch = problem_.ruled[p];
    const double weight = problem_.parallel_weight(p, options_);
    if (!(weight > 0)) continue;
    const int slopes = unknowns_;
    unknowns_ += 4;
    for (const int node : problem_.net.curves[patch.first].nodes)
      add_plane(DepthTerm::parallel, weight, node, slopes, slopes + 2);
    for (const int node : problem_.net.curves[patch.second].nodes)
      add_plane(DepthTerm::parallel, weight, node, slopes, slopes + 3);
  }
}

/// Divides the weights by the numbers of rows.
void DepthRows::finish() {
  std::array<int, kDepthTerms> count{};
  for (const Row& row : rows_) ++count[static_cast<int>(row.term)];
  right_.resize(rows_.size());
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    Row& row = rows_[r];
    row.weight = std::sqrt(row.weight / count[static_cast<int>(row.term)]);
    right_(r) = row.weight * row.right;
  }
}

DepthMatrix DepthRows::matrix() const {
  std::vector<Eigen::Triplet<double>> entries;
  for (int r = 0; r < std::ssize(rows_); ++r) {
    for (const auto& [column, c] : rows_[r].terms)
      entries.emplace_back(r, column, rows_[r].weight * c);
  }
  DepthMatrix A(rows_.size(), unknowns_);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

void DepthRows::report(const Eigen::VectorXd& x, DepthSolution& solution) const {
  std::array<double, kDepthTerms> square{};
  for (const Row& row : rows_) {
    double residual = -row.right;
    for (const auto& [column, c] : row.terms) residual += c * x(column);
    const int term = static_cast<int>(row.term);
    square[term] += residual * residual;
    ++solution.rows[term];
  }
  for (int t = 0; t < kDepthTerms; ++t)
    solution.rms[t] = solution.rows[t] > 0 ? std::sqrt(square[t] / solution.rows[t]) : 0;
}

/// Greatest eigenvalue of a positive matrix, by power iteration from a fixed start.
double greatest_eigenvalue(const DepthMatrix& N) {
  constexpr int kIterations = 40;
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(N.rows(), 1, 2).normalized();
  double value = 0;
  for (int k = 0; k < kIterations; ++k) {
    const Eigen::VectorXd y = N * x;
    value = y.norm();
    x = y / value;
  }
  return value;
}

/// Mode with the least eigenvalue, by inverse iteration.
struct WeakestMode {
  double eigenvalue = 0;
  Eigen::VectorXd vector;
};

WeakestMode weakest_mode(const DepthMatrix& N, const SparseLdlt& factor) {
  constexpr int kIterations = 12;
  WeakestMode mode;
  mode.vector.resize(N.rows());
  // Without pattern, so that no mode is orthogonal to the start but by chance.
  for (Eigen::Index i = 0; i < N.rows(); ++i)
    mode.vector(i) = std::sin(1.0 + static_cast<double>(i) * 1.618);
  for (int k = 0; k < kIterations; ++k) {
    mode.vector = factor.solve(mode.vector);
    mode.vector.normalize();
  }
  mode.eigenvalue = std::max(mode.vector.dot(N * mode.vector), 0.0);
  return mode;
}

std::string curves_that_move(const CurveNet& net, const Eigen::VectorXd& mode) {
  constexpr double kMoves = 0.3;  // of the largest motion
  double largest = 0;
  for (std::size_t v = 0; v < net.points.size(); ++v)
    largest = std::max(largest, std::abs(mode(3 * v + 2)));
  std::vector<std::string> ids;
  for (const SketchCurve& curve : net.curves) {
    double most = 0;
    for (const int node : curve.nodes) most = std::max(most, std::abs(mode(3 * node + 2)));
    if (most >= kMoves * largest && std::find(ids.begin(), ids.end(), curve.id) == ids.end())
      ids.push_back(curve.id);
  }
  std::string text;
  for (const std::string& id : ids) text += (text.empty() ? "'" : ", '") + id + "'";
  return "strokes " + text;
}

}  // namespace

void describe(OptionVisitor& v, DepthOptions& o) {
  const auto weight = [&](const char* key, double& x, const char* doc) {
    v.value(key, x, {.doc = doc, .min = 0, .max = 1e6});
  };
  weight("accuracy", o.accuracy, "weight of x, y as drawn");
  weight("variation", o.variation, "weight of even variation of depth along curves");
  weight("pairs", o.pairs, "weight of the symmetry of drawn pairs");
  weight("dense", o.dense, "weight of the symmetry of matches between drawn pairs");
  weight("developability", o.developability, "weight of one tangent plane along a ruling");
  weight("planarity", o.planarity, "weight of the plane of a flat panel's border");
  weight("parallel_planes", o.parallel_planes,
         "weight of parallel planes of both borders of a ruled patch");
  weight("copied_planes", o.copied_planes,
         "weight of parallel planes of both borders of a ruled patch of which one is the other's "
         "copy in the picture, when parallel_planes is 0");
  v.value("tangent_half_width", o.tangent_half_width,
          {.doc = "nodes on either side in the fit of a tangent", .min = 1, .max = 100});
  v.value("end_angle_deg", o.end_angle_deg,
          {.doc = "difference of its end angles above which a ruling is left out",
           .unit = "deg",
           .min = 0,
           .max = 180});
}

double DepthProblem::parallel_weight(std::size_t patch, const DepthOptions& options) const {
  if (options.parallel_planes > 0) return options.parallel_planes;
  return patch < copied.size() && copied[patch] ? options.copied_planes : 0;
}

const char* depth_term_name(DepthTerm term) {
  constexpr std::array<const char*, kDepthTerms> kNames{
      "accuracy", "variation", "pairs", "dense", "developability", "planarity", "parallel"};
  return kNames[static_cast<int>(term)];
}

std::vector<RulingForms> trusted_rulings(const CurveNet& net, const RuledPatch& patch,
                                         const DepthOptions& options, bool near_silhouettes) {
  const SketchCurve& first = net.curves[patch.first];
  const SketchCurve& second = net.curves[patch.second];
  std::vector<RulingForms> trusted;
  for (const SketchRuling& ruling : patch.rulings) {
    if (ruling.held) continue;
    RulingForms forms{tangent_form(first, ruling.node, options.tangent_half_width),
                      tangent_form(second, ruling.at, options.tangent_half_width),
                      position_form(net, {patch.second, ruling.at})};
    forms.r.emplace_back(node_of(first, ruling.node), -1.0);
    const UnitImages u = unit_images(net, forms);
    if (!(u.lengths.minCoeff() > 0)) continue;
    if (!near_silhouettes && u.dependence().norm() < kClearRuling) continue;
    if (std::abs(signed_angle(u.t1, u.t2)) > options.end_angle_deg * kDegree) continue;
    trusted.push_back(std::move(forms));
  }
  return trusted;
}

DepthSolution solve_depth(const DepthProblem& problem, const DepthOptions& options) {
  const DepthRows rows(problem, options);
  const DepthMatrix A = rows.matrix();
  DepthMatrix N = A.transpose() * A;
  const double greatest = greatest_eigenvalue(N);
  DepthMatrix shifted = N;
  // Keeps the pivots of an undetermined mode away from zero, so that the mode can be found.
  for (int i = 0; i < rows.unknowns(); ++i) shifted.coeffRef(i, i) += 1e-16 * greatest;
  const SparseLdlt factor(shifted);
  const WeakestMode weakest = weakest_mode(N, factor);
  if (!factor.succeeded() || weakest.eigenvalue <= kSingular * greatest) {
    throw Error("depth is not determined", curves_that_move(problem.net, weakest.vector),
                "a symmetric pair, or a ruling to a border whose depth is known");
  }
  const Eigen::VectorXd b = A.transpose() * rows.right_side();
  Eigen::VectorXd x = factor.solve(b);
  x += factor.solve(b - N * x);
  DepthSolution solution;
  solution.condition = greatest / weakest.eigenvalue;
  const Eigen::Index nodes = problem.net.points.size();
  solution.nodes.resize(nodes, 3);
  for (Eigen::Index v = 0; v < nodes; ++v) solution.nodes.row(v) = x.segment<3>(3 * v).transpose();
  rows.report(x, solution);
  return solution;
}

}  // namespace geoprior::sketch
