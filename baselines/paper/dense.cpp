#include "baselines/paper/dense.h"

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "models/paper/meshing/outline.h"
#include "models/paper/meshing/transfer.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/paper/tear/frame.h"

namespace geoprior::paper {
namespace {

constexpr std::array<std::string_view, 4> kLayoutNames{"automatic", "structured", "equilateral",
                                                       "delaunay"};

/// A mesh that only tears change: they are cut into its lattice.
class UniformMesher final : public SheetMesher {
 public:
  explicit UniformMesher(const DenseOptions& options) : options_(options) {}

  ShellState start(const Sheet& sheet, RunContext& context) override {
    take_scene(sheet);
    return resting_state(sheet, mesh(context), context.seed());
  }
  void stepped(const Sheet& sheet, ShellStepper& stepper, ShellState& state,
               RunContext& context) override {
    if (!tearing_) return;
    const Phase phase(context, "tear");
    tearing_->grow([&] { return plain_candidates(sheet, tearing_->tears()); },
                   {[&](ShellState& torn) { torn = transfer_state(torn, mesh(context)); }}, stepper,
                   state);
  }
  bool adapt(const Sheet& /*sheet*/, ShellStepper& /*stepper*/, ShellState& /*state*/,
             RunContext& /*context*/) override {
    return false;
  }
  void annotate(const ShellState& state, Frame& frame) const override {
    if (tearing_) add_tears(*tearing_, state, frame);
  }
  void save(StateWriter& out) const override {
    if (tearing_) tearing_->save(out);
  }
  void load(const Sheet& sheet, StateReader& in) override {
    take_scene(sheet);
    if (tearing_) tearing_->load(in);
  }

 private:
  void take_scene(const Sheet& sheet) {
    pattern_ = sheet.pattern;
    const double edge = equilateral_edge(signed_area(sheet.pattern), options_.triangles);
    require_lattice(sheet.pattern, edge);
    anchors_ = handle_points(sheet, edge);
    if (!sheet.toughness.tears()) return;
    tearing_.emplace(sheet, options_.tearing);
    // Squares have no room for a tear between them.
    layout_ = options_.layout == UniformLayout::delaunay ? UniformLayout::delaunay
                                                         : UniformLayout::equilateral;
    edge_ = 0;
  }

  [[nodiscard]] ShellMesh mesh(RunContext& context) {
    if (!tearing_) {
      return uniform_mesh(pattern_, options_.triangles, options_.layout, anchors_, context.seed());
    }
    if (edge_ == 0)
      edge_ = uniform_edge(pattern_, options_.triangles, layout_, anchors_, context.seed());
    std::vector<Eigen::Vector2d> tips;
    for (const Tear& tear : tearing_->tears().all()) {
      if (!tear.ended) tips.push_back(tear.tip());
    }
    return lattice_mesh(tearing_->tears().torn(), edge_, layout_, anchors_, context.seed(), tips);
  }

  DenseOptions options_;
  Pattern pattern_;
  std::vector<Eigen::Vector2d> anchors_;
  std::optional<TearGrowth> tearing_;
  UniformLayout layout_ = UniformLayout::equilateral;
  double edge_ = 0;  ///< of the lattice, once it is made (m)
};

}  // namespace

void describe(OptionVisitor& v, DenseOptions& options) {
  v.value("triangles", options.triangles,
          {.doc = "number of triangles that the uniform mesh aims at", .min = 2, .max = 1e6});
  describe_choice(v, "layout", options.layout, kLayoutNames,
                  {.doc = "layout of the mesh: structured (squares with alternating diagonals), "
                          "equilateral, delaunay (irregular), or automatic: structured on upright "
                          "rectangles, otherwise equilateral"});
  describe_group(v, "tearing", options.tearing,
                 {.doc = "how tears grow in scenes whose paper tears"});
  describe_group(v, "stepper", options.stepper, {.doc = "how the sheet is stepped in time"});
}

std::unique_ptr<Process> make_dense_sheet(const Sheet& sheet, const DenseOptions& options) {
  const double edge = equilateral_edge(signed_area(sheet.pattern), options.triangles);
  return std::make_unique<SheetProcess>(with_outline(sheet, edge), options.stepper,
                                        std::make_unique<UniformMesher>(options));
}

}  // namespace geoprior::paper
