#include "baselines/paper/adaptive/adaptive.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "baselines/paper/adaptive/pop_filter.h"
#include "baselines/paper/adaptive/recut.h"
#include "baselines/paper/adaptive/remesh.h"
#include "baselines/paper/adaptive/sizing.h"
#include "baselines/paper/dense.h"
#include "core/error.h"
#include "core/state_bytes.h"
#include "models/paper/meshing/outline.h"
#include "models/paper/meshing/transfer.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/paper/tear/frame.h"

namespace geoprior::paper {
namespace {

/// Edge length of the first mesh, over the largest allowed: splits and collapses both stay away.
constexpr double kStartSize = 0.8;

/// Distance of corners along curved lines of the outline, over the smallest edge length.
constexpr double kOutline = 2;

/// Distance from a tear within which vertices make room for it, in steps of the tear.
constexpr double kRoom = 0.7;

struct Counts {
  int splits = 0, collapses = 0, flips = 0, pop_steps = 0, settle_steps = 0;
};

class AdaptiveMesher final : public SheetMesher {
 public:
  explicit AdaptiveMesher(const AdaptiveOptions& options) : options_(options) {
    if (!(options.size_min > 0 && options.size_min <= options.size_max)) {
      throw Error("size_min is not between 0 and size_max", "adaptive options",
                  "0 < size_min <= size_max");
    }
  }

  ShellState start(const Sheet& sheet, RunContext& context) override {
    const double edge = kStartSize * options_.size_max;
    require_lattice(sheet.pattern, edge);
    const double triangles = signed_area(sheet.pattern) / (std::sqrt(3.0) / 4 * edge * edge);
    take_scene(sheet);
    return resting_state(
        sheet,
        uniform_mesh(sheet.pattern, std::max(2, static_cast<int>(std::lround(triangles))),
                     UniformLayout::equilateral, handle_points(sheet, edge), context.seed()),
        context.seed());
  }

  void stepped(const Sheet& /*sheet*/, ShellStepper& stepper, ShellState& state,
               RunContext& context) override {
    if (!tearing_) return;
    const Phase phase(context, "tear");
    tearing_->grow([&] { return plain_candidates(*torn_, tearing_->tears()); },
                   {[&](ShellState& torn) {
                      torn_->pattern = tearing_->tears().torn();
                      torn = transfer_state(torn, recut(torn.mesh, torn_->pattern, anchors_,
                                                        kRoom * options_.tearing.step));
                    },
                    [&] { torn_->pattern = tearing_->tears().torn(); }},
                   stepper, state);
  }

  bool adapt(const Sheet& given, ShellStepper& stepper, ShellState& state,
             RunContext& context) override {
    const Sheet& sheet = torn_ ? *torn_ : given;
    last_ = {};
    std::optional<ShellState> before;
    if (options_.pop_filter) before = state;
    RemeshReport report;
    {
      const Phase phase(context, "remesh");
      report = remesh(sheet, sizing_tensors(state, sheet.obstacles, options_), state);
    }
    last_.splits = report.splits;
    last_.collapses = report.collapses;
    last_.flips = report.flips;
    if (!report.any()) return false;
    if (options_.pop_filter) {
      const Phase phase(context, "pop_filter");
      last_.pop_steps =
          filter_pops(sheet, options_.stepper, *before, stepper.elastic_forces(*before),
                      report.changed, held_vertices(sheet, state), state);
    }
    return true;
  }

  bool settle(const Sheet& sheet, ShellStepper& stepper, ShellState& state,
              RunContext& context) override {
    const Phase phase(context, "settle");
    last_.settle_steps = paper::settle(sheet, options_.settle, stepper, state);
    return true;
  }

  void annotate(const ShellState& state, Frame& frame) const override {
    if (tearing_) add_tears(*tearing_, state, frame);
    frame.diagnostics["splits"] = last_.splits;
    frame.diagnostics["collapses"] = last_.collapses;
    frame.diagnostics["flips"] = last_.flips;
    frame.diagnostics["settle_steps"] = last_.settle_steps;
    if (options_.pop_filter) frame.diagnostics["pop_filter_steps"] = last_.pop_steps;
  }

  /// Counts of the last frame only: the next remeshing depends on the sheet and its tears alone.
  void save(StateWriter& out) const override {
    out.number(last_);
    if (tearing_) tearing_->save(out);
  }
  void load(const Sheet& sheet, StateReader& in) override {
    last_ = in.number<Counts>();
    take_scene(sheet);
    if (!tearing_) return;
    tearing_->load(in);
    torn_->pattern = tearing_->tears().torn();
  }

 private:
  void take_scene(const Sheet& sheet) {
    tearing_.reset();
    if (!sheet.toughness.tears()) return;
    torn_ = sheet;
    tearing_.emplace(*torn_, options_.tearing);
    anchors_ = handle_points(sheet, kStartSize * options_.size_max);
  }

  static std::vector<int> held_vertices(const Sheet& sheet, const ShellState& state) {
    std::vector<int> held;
    for (int v = 0; v < state.mesh.vertex_count(); ++v) {
      for (const Handle& handle : sheet.handles) {
        if (!handle.motion || !handle.is_active(state.time)) continue;
        if (!handle.covers(state.mesh.pattern.row(v))) continue;
        held.push_back(v);
        break;
      }
    }
    return held;
  }

  AdaptiveOptions options_;
  Counts last_;
  std::optional<Sheet> torn_;  ///< the sheet with the pattern as it is torn now
  std::optional<TearGrowth> tearing_;
  std::vector<Eigen::Vector2d> anchors_;
};

}  // namespace

void describe(OptionVisitor& v, AdaptiveOptions& options) {
  describe(v, static_cast<SizingOptions&>(options));
  v.value("pop_filter", options.pop_filter,
          {.doc = "moves vertices with new triangles until the elastic forces are what they were "
                  "before remeshing"});
  describe_group(v, "settle", options.settle,
                 {.doc = "how the sheet comes to rest after every change of the mesh"});
  describe_group(v, "tearing", options.tearing,
                 {.doc = "how tears grow in scenes whose paper tears"});
  describe_group(v, "stepper", options.stepper, {.doc = "how the sheet is stepped in time"});
}

std::unique_ptr<Process> make_adaptive_sheet(const Sheet& sheet, const AdaptiveOptions& options) {
  return std::make_unique<SheetProcess>(with_outline(sheet, kOutline * options.size_min),
                                        options.stepper, std::make_unique<AdaptiveMesher>(options));
}

}  // namespace geoprior::paper
