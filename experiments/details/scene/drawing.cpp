#include "experiments/details/scene/drawing.h"

#include <optional>
#include <string>
#include <utility>

#include "experiments/details/drawing/detail_drawing.h"

namespace geoprior::details {
namespace {

enum DrawnClass { kSurface = 0, kOriginal = 1, kBorn = 2 };

/// Class of every point of a drawing by the detail it belongs to.
Eigen::VectorXd classes_of(const Part& drawing, const Part& details) {
  const auto& detail = drawing.require_array("detail", NamedArray::On::points, 1).values;
  const auto& born = details.require_array("birth_frame", NamedArray::On::points, 1).values;
  Eigen::VectorXd classes = Eigen::VectorXd::Constant(drawing.points.rows(), kSurface);
  for (Eigen::Index i = 0; i < classes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(detail(i, 0));
    if (row >= 0) classes[i] = born(row, 0) > 0 ? kBorn : kOriginal;
  }
  return classes;
}

Part joined(const Part& a, const Part& b) {
  Part part;
  part.points.resize(a.points.rows() + b.points.rows(), 3);
  part.points << a.points, b.points;
  part.triangles.resize(a.triangles.rows() + b.triangles.rows(), 3);
  part.triangles << a.triangles, b.triangles.array() + static_cast<int>(a.points.rows());
  return part;
}

class DrawingSink final : public FrameSink {
 public:
  DrawingSink(FrameSink& to, const DetailsScene& scene) : to_(to), scene_(scene) {}
  void frame(Frame frame) override {
    if (scene_.is_drawn(frame.parameter)) frame.parts["drawn"] = drawn_surface(frame, scene_);
    to_.frame(std::move(frame));
  }
  void event(const Event& event) override { to_.event(event); }
  void artifact(Artifact artifact) override { to_.artifact(std::move(artifact)); }
  void checkpoint(const State& state) override { to_.checkpoint(state); }

 private:
  FrameSink& to_;
  const DetailsScene& scene_;
};

class DrawnProcess final : public Process {
 public:
  DrawnProcess(std::unique_ptr<Process> process, const DetailsScene& scene)
      : process_(std::move(process)), scene_(scene) {}
  void run(FrameSink& sink, RunContext& context, const std::optional<State>& resume_from) override {
    DrawingSink drawing(sink, scene_);
    process_->run(drawing, context, resume_from);
  }

 private:
  std::unique_ptr<Process> process_;
  const DetailsScene& scene_;
};

}  // namespace

Part drawn_surface(Frame& frame, const DetailsScene& scene) {
  const DrawingOptions& look = scene.drawing->look;
  const std::string name = add_drawing(frame, look, scene.rest_edge(), scene.instance);
  const Part drawing = std::move(frame.parts.extract(name).mapped());
  Eigen::VectorXd kind = classes_of(drawing, frame.require_part("details"));
  Part drawn;
  if (look.kind == DrawnKind::hole) {
    drawn.points = drawing.points;
    drawn.triangles = drawing.triangles;
    kind.setConstant(kSurface);
  } else {
    const Part& surface = frame.require_part("surface");
    drawn = joined(surface, drawing);
    const Eigen::VectorXd details = kind;
    kind = Eigen::VectorXd::Constant(drawn.points.rows(), kSurface);
    kind.tail(details.size()) = details;
  }
  drawn.arrays.push_back({"kind", "1", NamedArray::On::points, kind});
  return drawn;
}

std::unique_ptr<Process> with_drawing(std::unique_ptr<Process> process, const DetailsScene& scene) {
  if (!scene.drawing) return process;
  return std::make_unique<DrawnProcess>(std::move(process), scene);
}

}  // namespace geoprior::details
