#include "experiments/grammar/processes/deformer.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/frame_loop.h"

namespace geoprior::grammar {
namespace {

/// About as many elements are recorded of a scene of which only a sample is.
constexpr int kSampledElements = 1000;

/// A map must not fold: asked at the elements, or at a sample of so many.
constexpr int kCheckedPlaces = 2000;

void require_invertible(const SpatialMap& map, const Hierarchy& h, std::size_t step) {
  const int stride = std::max(1, h.size() / kCheckedPlaces);
  for (int e = 0; e < h.size(); e += stride) {
    if (!h.present(e)) continue;
    const MappedPoint m = map.with_jacobian(h.position(e));
    if (!m.position.allFinite() || !(m.jacobian.determinant() > 0))
      throw Error("the gesture folds space over at element '" + h.label(e) + "'",
                  "step " + std::to_string(step), "maps of positive determinant");
  }
}

/// Of the elements only every so many: their key points, without triangles.
void keep_sample(const Hierarchy& h, Geometry& geometry, Hierarchy& sampled) {
  const int stride = std::max(1, h.size() / kSampledElements);
  for (int e = 0; e < h.size(); ++e)
    if (e % stride != 0) sampled.set_present(e, false);
  geometry = geometry_of(sampled, false);
}

class DeformingModel final : public FrameModel {
 public:
  DeformingModel(const GrammarScene& scene, std::unique_ptr<Deformer> method)
      : scene_(scene), method_(std::move(method)) {}

  [[nodiscard]] int frame_count() const override { return static_cast<int>(scene_.steps.size()); }

  void load(StateReader& in, int next_frame) override {
    for (int i = 1; i < next_frame; ++i)
      if (scene_.steps[i].kind == Step::Kind::edit) method_->edit(edit_of(i));
    method_->load(in);
  }
  void save(StateWriter& out) const override { method_->save(out); }

  void advance(int frame, FrameSink&, RunContext& context) override {
    if (scene_.steps[frame].kind == Step::Kind::edit) {
      const geoprior::Phase phase(context, "edit");
      method_->edit(edit_of(frame));
      return;
    }
    const auto map = scene_.asked_map(frame);
    require_invertible(*map, scene_.rest, frame);
    const geoprior::Phase phase(context, "deform");
    method_->deform(frame, map);
  }

  void record(int frame, FrameSink& sink, RunContext&) override {
    const bool surface = scene_.record == GrammarSceneOptions::Record::surface;
    const Hierarchy& shown = method_->shown();
    Frame out;
    if (scene_.record == GrammarSceneOptions::Record::sample) {
      Hierarchy sampled = shown;
      Geometry geometry;
      keep_sample(shown, geometry, sampled);
      out = frame_of(frame, sampled, geometry);
    } else {
      out = frame_of(frame, shown, method_->geometry(surface));
    }
    out.diagnostics = method_->diagnostics();
    mark_edited(shown, out);
    add_gesture(frame, out);
    method_->add_parts(out);
    sink.frame(std::move(out));
    if (frame > 0)
      for (Artifact& file : method_->artifacts(frame)) sink.artifact(std::move(file));
  }

 private:
  [[nodiscard]] const SceneEdit& edit_of(int frame) const {
    return scene_.edits[scene_.steps[frame].number];
  }

  /// Adds the array `edited` over the cells of the surface: 2 of elements that the scene edits, 1
  /// of those below them, else 0; of frames before the edit, too.
  void mark_edited(const Hierarchy& shown, Frame& out) const {
    const auto found = out.parts.find("surface");
    if (found == out.parts.end() || scene_.edits.empty()) return;
    Part& surface = found->second;
    const NamedArray& element = surface.require_array("element", NamedArray::On::cells, 1);
    NamedArray edited{"edited", "1", NamedArray::On::cells,
                      Eigen::MatrixXd::Zero(surface.triangles.rows(), 1)};
    for (Eigen::Index f = 0; f < edited.values.rows(); ++f) {
      const int e = static_cast<int>(element.values(f, 0));
      for (const SceneEdit& edit : scene_.edits) {
        if (e == edit.wish.element) edited.values(f, 0) = 2;
        if (edited.values(f, 0) == 0 && shown.is_below(e, edit.wish.element))
          edited.values(f, 0) = 1;
      }
    }
    surface.arrays.push_back(std::move(edited));
  }

  void add_gesture(int frame, Frame& out) const {
    if (scene_.record != GrammarSceneOptions::Record::surface) return;
    const DrawnGesture lines = scene_.drawn_gesture(frame);
    if (lines.lines.empty()) return;
    Part& part = out.parts["gesture"];
    part.kind = Part::Kind::lines;
    part.points.resize(static_cast<int>(lines.points.size()), 3);
    for (std::size_t i = 0; i < lines.points.size(); ++i)
      part.points.row(static_cast<int>(i)) = lines.points[i];
    part.lines = lines.lines;
  }

  const GrammarScene& scene_;
  std::unique_ptr<Deformer> method_;
};

}  // namespace

std::unique_ptr<Process> deforming_process(
    const GrammarScene& scene, std::function<std::unique_ptr<Deformer>(RunContext&)> make) {
  return frame_process([&scene, make = std::move(make)](RunContext& context) {
    return std::make_unique<DeformingModel>(scene, make(context));
  });
}

}  // namespace geoprior::grammar
