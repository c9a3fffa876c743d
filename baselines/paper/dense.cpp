#include "baselines/paper/dense.h"

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "models/paper/uniform_mesh.h"

namespace geoprior::paper {
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
    require_lattice(sheet.pattern, edge);
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

std::unique_ptr<Process> make_dense_sheet(const Sheet& sheet, const DenseOptions& options) {
  return std::make_unique<SheetProcess>(sheet, options.stepper,
                                        std::make_unique<UniformMesher>(options));
}

}  // namespace geoprior::paper
