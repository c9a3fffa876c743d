#include "baselines/sketch/visual_hull/visual_hull.h"

#include "baselines/sketch/visual_hull/rounded_hull.h"

namespace geoprior::sketch {
namespace {

class ShownHull final : public SketchMethod {
 public:
  explicit ShownHull(const Eigen::MatrixX3d& X) : X_(X) {}
  void step(RunContext& /*context*/) override {}
  [[nodiscard]] const Eigen::MatrixX3d& positions() const override { return X_; }
  void load(StateReader& in) override { in.matrix(X_); }

 private:
  Eigen::MatrixX3d X_;
};

}  // namespace

void describe(OptionVisitor& v, VisualHullOptions& o) {
  v.value("smoothed", o.smoothed, {.doc = "whether the hull is smoothed as the methods begin"});
  v.value("boxes", o.boxes,
          {.doc = "whether its sections are all that the views see, whatever the scene says"});
  v.value("double_steps", o.double_steps,
          {.doc = "number of double steps of a smoothed hull; absent: the scene's",
           .min = 0,
           .max = 100000});
  v.value("rounded", o.rounded,
          {.doc = "radius of a ball that rounds the hull's ridges, in edge lengths of its grid",
           .min = 0,
           .max = 100});
}

std::unique_ptr<Process> make_visual_hull_process(const SketchInput& input,
                                                  const VisualHullOptions& options) {
  SketchInput seen = input;
  if (options.boxes) seen.hull.sections = HullSections::box;
  if (options.double_steps) seen.smoothing.double_steps = *options.double_steps;
  return make_sketch_process(seen, 0, [options](const PreparedSketch& prepared, RunContext&) {
    return std::make_unique<ShownHull>(
        options.smoothed
            ? prepared.start
            : rounded_hull(prepared.surface, options.rounded * prepared.surface.hull.spacing));
  });
}

}  // namespace geoprior::sketch
