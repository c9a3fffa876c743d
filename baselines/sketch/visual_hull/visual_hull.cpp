#include "baselines/sketch/visual_hull/visual_hull.h"

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
}

std::unique_ptr<Process> make_visual_hull_process(const SketchInput& input,
                                                  const VisualHullOptions& options) {
  SketchInput seen = input;
  if (options.boxes) seen.hull.sections = HullSections::box;
  return make_sketch_process(seen, 0, [options](const PreparedSketch& prepared, RunContext&) {
    return std::make_unique<ShownHull>(options.smoothed ? prepared.start
                                                        : prepared.surface.hull.mesh.V);
  });
}

}  // namespace geoprior::sketch
