#include "baselines/paper/dense.h"

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/error.h"

namespace geoprior {
namespace {

constexpr std::array<std::string_view, 4> kLayoutNames{"automatic", "structured", "equilateral",
                                                       "delaunay"};

/// A mesh that never changes: nothing to adapt, annotate or remember.
class UniformMesher final : public SheetMesher {
 public:
  explicit UniformMesher(const DenseOptions& options) : options_(options) {}

  ShellState start(const Sheet& sheet, RunContext& context) override {
    const double edge =
        std::sqrt(4 / std::sqrt(3.0) * signed_area(sheet.pattern) / options_.triangles);
    const std::vector<Eigen::Vector2d> anchors = handle_points(sheet, edge);
    return resting_state(
        sheet,
        uniform_mesh(sheet.pattern, options_.triangles, options_.layout, anchors, context.seed()),
        context.seed());
  }
  bool adapt(const Sheet& /*sheet*/, ShellStepper& /*stepper*/, ShellState& /*state*/,
             RunContext& /*context*/) override {
    return false;
  }
  void annotate(const ShellState& /*state*/, Frame& /*frame*/) const override {}
  [[nodiscard]] State save() const override { return {}; }
  void load(const State& state) override {
    if (!state.empty()) throw Error("state of another method", "dense sheet");
  }

 private:
  DenseOptions options_;
};

}  // namespace

void describe(OptionVisitor& v, DenseOptions& options) {
  v.value("triangles", options.triangles,
          {.doc = "of the uniform mesh, aimed at", .min = 2, .max = 1e6});
  describe_choice(v, "layout", options.layout, kLayoutNames,
                  {.doc = "automatic: structured for upright rectangles, otherwise equilateral; "
                          "structured: squares "
                          "with alternating diagonals"});
  describe_group(v, "stepper", options.stepper, {.doc = "time stepping"});
}

std::vector<Eigen::Vector2d> handle_points(const Sheet& sheet, double edge) {
  const double tolerance = 1e-9 * width(sheet.pattern);
  const auto on_border = [&](const Eigen::Vector2d& p) {
    return nearest_on_border(sheet.pattern, p).distance <= tolerance;
  };
  std::vector<Eigen::Vector2d> points;
  for (const Handle& handle : sheet.handles) {
    const std::vector<Eigen::Vector2d> anchors = handle.anchors();
    points.insert(points.end(), anchors.begin(), anchors.end());
    if (!handle.segment) continue;
    const auto& [a, b] = *handle.segment;
    if (on_border(a) && on_border((a + b) / 2) && on_border(b)) continue;
    const auto pieces = static_cast<int>(std::ceil((b - a).norm() / edge));
    for (int i = 1; i < pieces; ++i) points.emplace_back(a + (b - a) * i / pieces);
  }
  return points;
}

ShellState resting_state(const Sheet& sheet, ShellMesh mesh, std::uint64_t seed) {
  ShellState state;
  state.mesh = std::move(mesh);
  const int n = state.mesh.vertex_count(), m = state.mesh.triangle_count();
  state.x.resize(n, 3);
  for (int i = 0; i < n; ++i) {
    state.x.row(i) = sheet.rest_place(state.mesh.pattern.row(i), seed);
  }
  state.v = Eigen::MatrixX3d::Zero(n, 3);
  state.plastic_curvature = Eigen::MatrixX3d::Zero(m, 3);
  state.damage = Eigen::VectorXd::Zero(m);
  return state;
}

std::unique_ptr<Process> make_dense_sheet(const Sheet& sheet, const DenseOptions& options) {
  return std::make_unique<SheetProcess>(sheet, options.stepper,
                                        std::make_unique<UniformMesher>(options));
}

}  // namespace geoprior
