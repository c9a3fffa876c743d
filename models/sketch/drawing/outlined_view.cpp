#include "models/sketch/drawing/outlined_view.h"

#include <string>

#include "core/error.h"

namespace geoprior::sketch {

std::vector<OutlinedView> outlined_views(const Drawing& aligned) {
  std::vector<OutlinedView> views;
  for (const View& view : aligned.views) {
    if (view.kind == ViewKind::photo) continue;
    const std::vector<const Stroke*> strokes = strokes_of(view, StrokeKind::silhouette);
    if (strokes.size() != 1) {
      throw Error("has " + std::to_string(strokes.size()) + " silhouettes",
                  aligned.name + ", view " + view_name(view.kind), "one");
    }
    views.push_back({view.kind, Outline(strokes[0]->points), view_frame(view.kind)});
  }
  return views;
}

}  // namespace geoprior::sketch
