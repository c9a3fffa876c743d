#include "solvers/sketch/surface/refine_depth.h"

#include <ceres/ceres.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"

namespace geoprior::sketch {
namespace {

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Vector2 = Eigen::Matrix<T, 2, 1>;

/// Value of a form; its nodes are the parameter blocks from `first` on.
template <class T>
Vector3<T> form_value(const NodeForm& form, T const* const* blocks, std::size_t first) {
  Vector3<T> sum(T(0), T(0), T(0));
  for (std::size_t k = 0; k < form.size(); ++k)
    sum += T(form[k].second) * Eigen::Map<const Vector3<T>>(blocks[first + k]);
  return sum;
}

/// Blocks: a node, perspective.
struct AccuracyResidual {
  Eigen::Vector2d drawn, centre;
  double weight, diagonal;
  template <class T>
  bool operator()(const T* node, const T* perspective, T* out) const {
    const T scale = T(1) + perspective[0] * node[2] / T(diagonal);
    for (int k = 0; k < 2; ++k)
      out[k] = T(weight) * (T(centre(k)) + scale * (node[k] - T(centre(k))) - T(drawn(k)));
    return true;
  }
};

/// Blocks: three neighbours along a curve.
struct VariationResidual {
  double before, after, weight;  ///< drawn lengths; of the row, with its scale
  template <class T>
  bool operator()(const T* a, const T* b, const T* c, T* out) const {
    out[0] = T(weight) * ((c[2] - b[2]) / T(after) - (b[2] - a[2]) / T(before));
    return true;
  }
};

/// Blocks: nodes of the point, nodes of its image, normal.
struct SymmetryResidual {
  NodeForm point, image;
  Eigen::Vector2d tail;  ///< of sym-a, through which the plane passes
  double weight;
  template <class T>
  bool operator()(T const* const* blocks, T* out) const {
    const Vector3<T> p = form_value(point, blocks, 0);
    const Vector3<T> q = form_value(image, blocks, point.size());
    const Vector3<T> n =
        Eigen::Map<const Vector3<T>>(blocks[point.size() + image.size()]).normalized();
    const Vector3<T> d = q - p;
    const Vector3<T> across = d - d.dot(n) * n;
    for (int k = 0; k < 3; ++k) out[k] = T(weight) * across(k);
    const Vector3<T> middle = (p + q) / T(2) - Vector3<T>(T(tail.x()), T(tail.y()), T(0));
    out[3] = T(weight) * n.dot(middle);
    return true;
  }
};

/// Blocks: nodes of both tangents and of the ruling.
struct TangentPlaneResidual {
  RulingForms forms;
  double weight;  ///< with the diagonal
  template <class T>
  bool operator()(T const* const* blocks, T* out) const {
    const Vector3<T> t1 = form_value(forms.t1, blocks, 0);
    const Vector3<T> t2 = form_value(forms.t2, blocks, forms.t1.size());
    const Vector3<T> r = form_value(forms.r, blocks, forms.t1.size() + forms.t2.size());
    const Vector3<T> n1 = t1.cross(r), n2 = t2.cross(r);
    const T scale = n1.norm() * n2.norm();
    if (!(scale > T(0))) return false;
    out[0] = T(weight) * n1.cross(n2).dot(r) / (scale * r.norm());
    return true;
  }
};

/// Blocks: a node, slopes, height of a plane.
struct PlaneResidual {
  double weight, diagonal;
  template <class T>
  bool operator()(const T* node, const T* slopes, const T* height, T* out) const {
    out[0] = T(weight) *
             (node[2] - (slopes[0] * node[0] + slopes[1] * node[1]) / T(diagonal) - height[0]);
    return true;
  }
};

/// Block: normal. Depth of a vector of the plane follows from its image.
struct VectorsResidual {
  Eigen::Vector2d a, b;
  double ratio, angle_weight, ratio_weight;
  template <class T>
  static Vector3<T> in_plane(const Eigen::Vector2d& v, const T* normal) {
    return {T(v.x()), T(v.y()), -(normal[0] * T(v.x()) + normal[1] * T(v.y())) / normal[2]};
  }
  template <class T>
  bool operator()(const T* normal, T* out) const {
    const Vector3<T> a3 = in_plane(a, normal), b3 = in_plane(b, normal);
    using std::log;
    out[0] = T(angle_weight) * a3.dot(b3) / (a3.norm() * b3.norm());
    out[1] = T(ratio_weight) * log(a3.norm() / (T(ratio) * b3.norm()));
    return true;
  }
};

/// Block: perspective.
struct FlatnessResidual {
  double weight;
  template <class T>
  bool operator()(const T* perspective, T* out) const {
    out[0] = T(weight) * perspective[0];
    return true;
  }
};

/// Unknowns and residuals. Addresses of unknowns are kept by the problem: nothing moves.
class Refinement {
 public:
  Refinement(const View& view, const DepthProblem& problem, const DepthSolution& start,
             const DepthOptions& options, double vector_ratio, const RefineOptions& refine);
  RefinedDepth solve();

 private:
  double* node(int i) { return nodes_.data() + 3 * static_cast<std::size_t>(i); }
  void append(const NodeForm& form, std::vector<double*>& blocks) {
    for (const auto& [i, c] : form) blocks.push_back(node(i));
  }
  template <class Residual>
  void add_dynamic(Residual residual, const std::vector<double*>& blocks, bool with_normal,
                   int count);
  void add_accuracy();
  void add_variation();
  void add_symmetries();
  void add_tangent_planes();
  void add_planes();
  void add_plane_nodes(DepthTerm term, double weight, const std::vector<int>& nodes, double* slopes,
                       double* height);
  void add_vectors();
  [[nodiscard]] double row_weight(DepthTerm term, double weight) const {
    const int rows = start_.rows[static_cast<std::size_t>(term)];
    return rows > 0 ? std::sqrt(weight / rows) : 0;
  }
  [[nodiscard]] const Stroke& vector_stroke(const std::string& name) const;

  const View& view_;
  const DepthProblem& problem_;
  const DepthSolution& start_;
  DepthOptions options_;
  double ratio_;
  RefineOptions refine_;
  std::vector<double> nodes_;
  std::array<double, 3> normal_{};
  double perspective_ = 0;
  std::vector<std::unique_ptr<std::array<double, 3>>> planes_;  ///< slopes, height
  Eigen::Vector2d tail_{0, 0};
  ceres::Problem system_;
};

Refinement::Refinement(const View& view, const DepthProblem& problem, const DepthSolution& start,
                       const DepthOptions& options, double vector_ratio,
                       const RefineOptions& refine)
    : view_(view),
      problem_(problem),
      start_(start),
      options_(options),
      ratio_(vector_ratio),
      refine_(refine) {
  for (Eigen::Index v = 0; v < start.nodes.rows(); ++v)
    for (int k = 0; k < 3; ++k) nodes_.push_back(start.nodes(v, k));
  for (std::size_t k = 0; k < 3; ++k) normal_[k] = problem.plane.normal(k);
  tail_ = vector_stroke("sym-a").points.front();
  add_accuracy();
  add_variation();
  add_symmetries();
  if (options_.developability > 0) add_tangent_planes();
  add_planes();
  add_vectors();
  system_.SetManifold(normal_.data(), new ceres::SphereManifold<3>());
}

const Stroke& Refinement::vector_stroke(const std::string& name) const {
  for (const Stroke& stroke : view_.strokes) {
    if (stroke.kind == StrokeKind::plane_vector && stroke.name == name) return stroke;
  }
  throw Error("no vector " + name + " of the mirror plane", view_name(view_.kind),
              "one stroke each named sym-a and sym-b");
}

/// A node may be in a residual more than once (forms overlap): its blocks are then joined, since a
/// problem takes each block once.
template <class Residual>
class JoinedBlocks {
 public:
  JoinedBlocks(Residual residual, std::vector<std::size_t> slot)
      : residual_(std::move(residual)), slot_(std::move(slot)) {}
  template <class T>
  bool operator()(T const* const* unique, T* out) const {
    std::vector<const T*> blocks;
    for (const std::size_t s : slot_) blocks.push_back(unique[s]);
    return residual_(blocks.data(), out);
  }

 private:
  Residual residual_;
  std::vector<std::size_t> slot_;  ///< of each block the number among the different ones
};

template <class Residual>
void Refinement::add_dynamic(Residual residual, const std::vector<double*>& blocks,
                             bool with_normal, int count) {
  std::vector<double*> unique;
  std::vector<std::size_t> slot;
  for (double* block : blocks) {
    std::size_t k = 0;
    while (k < unique.size() && unique[k] != block) ++k;
    if (k == unique.size()) unique.push_back(block);
    slot.push_back(k);
  }
  if (with_normal) {
    slot.push_back(unique.size());
    unique.push_back(normal_.data());
  }
  using Joined = JoinedBlocks<Residual>;
  auto* cost = new ceres::DynamicAutoDiffCostFunction<Joined, 6>(
      new Joined(std::move(residual), std::move(slot)));
  for (std::size_t k = 0; k < unique.size(); ++k) cost->AddParameterBlock(3);
  cost->SetNumResiduals(count);
  system_.AddResidualBlock(cost, nullptr, unique);
}

void Refinement::add_accuracy() {
  const double weight = row_weight(DepthTerm::accuracy, options_.accuracy * refine_.accuracy);
  const std::vector<Eigen::Vector2d>& points = problem_.net.points;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : points) box.extend(p);
  for (int v = 0; v < std::ssize(points); ++v) {
    system_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<AccuracyResidual, 2, 3, 1>(
            new AccuracyResidual{points[v], box.center(), weight, problem_.net.diagonal}),
        nullptr, node(v), &perspective_);
  }
  if (!refine_.perspective) {
    system_.SetParameterBlockConstant(&perspective_);
    return;
  }
  system_.AddResidualBlock(
      new ceres::AutoDiffCostFunction<FlatnessResidual, 1, 1>(
          new FlatnessResidual{std::sqrt(refine_.flatness) * problem_.net.diagonal * weight}),
      nullptr, &perspective_);
}

void Refinement::add_variation() {
  const double weight = row_weight(DepthTerm::variation, options_.variation);
  for (const CurveTurn& turn : turns(problem_.net)) {
    const double scale = turn.scale(problem_.net.diagonal);
    system_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<VariationResidual, 1, 3, 3, 3>(
            new VariationResidual{turn.from_before, turn.to_after, weight * scale}),
        nullptr, node(turn.before), node(turn.at), node(turn.after));
  }
}

void Refinement::add_symmetries() {
  const auto add = [&](const NodeForm& point, const NodeForm& image, double weight) {
    std::vector<double*> blocks;
    append(point, blocks);
    append(image, blocks);
    add_dynamic(SymmetryResidual{point, image, tail_, weight}, blocks, true, 4);
  };
  const CurveNet& net = problem_.net;
  for (const SymmetricPair& pair : problem_.pairs) {
    add(position_form(net, pair.point_at.front()), position_form(net, pair.image_at.front()),
        row_weight(DepthTerm::pairs, options_.pairs));
  }
  for (const DenseMatch& match : problem_.matches) {
    add({{match.node, 1.0}}, position_form(net, match.image),
        row_weight(DepthTerm::dense, options_.dense));
  }
}

void Refinement::add_tangent_planes() {
  const double weight =
      row_weight(DepthTerm::developability, options_.developability) * problem_.net.diagonal;
  for (const RuledPatch& patch : problem_.ruled) {
    for (const RulingForms& forms : trusted_rulings(problem_.net, patch, options_)) {
      std::vector<double*> blocks;
      append(forms.t1, blocks);
      append(forms.t2, blocks);
      append(forms.r, blocks);
      add_dynamic(TangentPlaneResidual{forms, weight}, blocks, false, 1);
    }
  }
}

void Refinement::add_plane_nodes(DepthTerm term, double weight, const std::vector<int>& nodes,
                                 double* slopes, double* height) {
  for (const int i : nodes) {
    system_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PlaneResidual, 1, 3, 2, 1>(
            new PlaneResidual{row_weight(term, weight), problem_.net.diagonal}),
        nullptr, node(i), slopes, height);
  }
}

void Refinement::add_planes() {
  const auto make = [&]() -> std::array<double, 3>& {
    planes_.push_back(std::make_unique<std::array<double, 3>>());
    return *planes_.back();
  };
  for (const std::vector<int>& panel : problem_.planar) {
    std::array<double, 3>& plane = make();
    add_plane_nodes(DepthTerm::planarity, options_.planarity, panel, plane.data(),
                    plane.data() + 2);
  }
  for (std::size_t p = 0; p < problem_.ruled.size(); ++p) {
    const RuledPatch& patch = problem_.ruled[p];
    const double weight = problem_.parallel_weight(p, options_);
    if (!(weight > 0)) continue;
    std::array<double, 3>& plane = make();
    std::array<double, 3>& other = make();
    const std::vector<SketchCurve>& curves = problem_.net.curves;
    add_plane_nodes(DepthTerm::parallel, weight, curves[patch.first].nodes, plane.data(),
                    plane.data() + 2);
    add_plane_nodes(DepthTerm::parallel, weight, curves[patch.second].nodes, plane.data(),
                    other.data() + 2);
  }
}

void Refinement::add_vectors() {
  const Stroke& a = vector_stroke("sym-a");
  const Stroke& b = vector_stroke("sym-b");
  const double diagonal = problem_.net.diagonal;
  system_.AddResidualBlock(
      new ceres::AutoDiffCostFunction<VectorsResidual, 2, 3>(new VectorsResidual{
          a.points.back() - a.points.front(), b.points.back() - b.points.front(), ratio_,
          std::sqrt(refine_.right_angle) * diagonal, std::sqrt(refine_.vector_ratio) * diagonal}),
      nullptr, normal_.data());
}

RefinedDepth Refinement::solve() {
  ceres::Solver::Options solver;
  solver.max_num_iterations = refine_.iterations;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  solver.function_tolerance = 1e-10;
  solver.parameter_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &system_, &summary);
  if (!summary.IsSolutionUsable())
    throw Error("the non-linear refinement failed: " + summary.message, view_name(view_.kind));
  RefinedDepth refined;
  refined.solution = start_;
  for (Eigen::Index v = 0; v < refined.solution.nodes.rows(); ++v)
    refined.solution.nodes.row(v) = Eigen::Map<const Eigen::RowVector3d>(node(static_cast<int>(v)));
  const Eigen::Vector3d normal = Eigen::Map<const Eigen::Vector3d>(normal_.data()).normalized();
  refined.plane = {normal, normal.head<2>().dot(tail_)};
  const auto length_of = [&](const char* name) {
    const Stroke& stroke = vector_stroke(name);
    const Eigen::Vector2d image = stroke.points.back() - stroke.points.front();
    return VectorsResidual::in_plane(image, normal_.data()).norm();
  };
  refined.vector_ratio = length_of("sym-a") / length_of("sym-b");
  refined.perspective = perspective_;
  refined.iterations = static_cast<int>(summary.iterations.size()) - 1;
  refined.cost_before = summary.initial_cost;
  refined.cost_after = summary.final_cost;
  return refined;
}

}  // namespace

void describe(OptionVisitor& v, RefineOptions& o) {
  v.value("iterations", o.iterations,
          {.doc = "most steps of Levenberg and Marquardt", .min = 1, .max = 10000});
  const auto weight = [&](const char* key, double& x, const char* doc) {
    v.value(key, x, {.doc = doc, .min = 0, .max = 1e6});
  };
  weight("accuracy", o.accuracy, "factor on the weight of where nodes were drawn");
  weight("right_angle", o.right_angle,
         "weight of the right angle between the mirror plane's two vectors");
  weight("vector_ratio", o.vector_ratio,
         "weight of the given ratio of the plane's two vectors; 0: the ratio is found");
  v.value("perspective", o.perspective, {.doc = "whether weak perspective is unknown too"});
  weight("flatness", o.flatness, "weight of having no perspective");
}

RefinedDepth refine_depth(const View& view, const DepthProblem& problem, const DepthSolution& start,
                          const DepthOptions& options, double vector_ratio,
                          const RefineOptions& refine) {
  return Refinement(view, problem, start, options, vector_ratio, refine).solve();
}

}  // namespace geoprior::sketch
