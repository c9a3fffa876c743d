#include "models/sketch/drawing/align_views.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>

#include "core/error.h"

namespace geoprior::sketch {
namespace {

struct AxisExtent {
  double low = 0, size = 0;
  ViewKind view = ViewKind::front;  ///< that decided it
};

struct ViewBox {
  Eigen::Vector2d low, high;
};

ViewBox silhouette_box(const View& view, const std::string& drawing) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  ViewBox box{{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
  for (const Stroke* stroke : strokes_of(view, StrokeKind::silhouette)) {
    for (const Eigen::Vector2d& p : stroke->points) {
      box.low = box.low.cwiseMin(p);
      box.high = box.high.cwiseMax(p);
    }
  }
  if (!(box.low.x() < box.high.x()) || !(box.low.y() < box.high.y())) {
    throw Error("there is no silhouette", drawing + ", view " + view_name(view.kind),
                "a closed stroke of the kind silhouette");
  }
  return box;
}

std::string percent(double ratio) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.1f %%", 100 * ratio);
  return text.data();
}

/// What was done to a view that was drawn larger or smaller than another.
std::string scaling_text(const std::string& drawing, ViewKind view, int axis,
                         const AxisExtent& known, double size) {
  std::array<char, 64> change;
  std::snprintf(change.data(), change.size(), "%.2g mm (%.1f %%)", 1e3 * (known.size - size),
                100 * (known.size / size - 1));
  return drawing + ": view:" + view_name(view) + ": its extent along " + "xyz"[axis] +
         " differs from that in view:" + view_name(known.view) +
         ": all its strokes are scaled by " + change.data();
}

}  // namespace

void describe(OptionVisitor& v, AlignOptions& o) {
  v.value("tolerance", o.tolerance,
          {.doc = "relative difference that the extents shared by two views may have",
           .min = 0,
           .max = 0.5});
}

Drawing align_views(const Drawing& drawing, const AlignOptions& options,
                    std::vector<std::string>* warnings) {
  Drawing aligned = drawing;
  std::array<std::optional<AxisExtent>, 3> extents;
  for (View& view : aligned.views) {
    if (view.kind == ViewKind::photo) continue;
    const ViewBox box = silhouette_box(view, drawing.name);
    Eigen::Vector2d scale{1, 1}, shift{0, 0};
    for (int c = 0; c < 2; ++c) {
      const ViewAxis along = view_axis(view_frame(view.kind), c);
      const double size = box.high[c] - box.low[c];
      std::optional<AxisExtent>& known = extents[along.axis];
      if (!known) known = AxisExtent{along.axis == 1 ? 0 : -size / 2, size, view.kind};
      const double ratio = known->size / size;
      if (std::abs(ratio - 1) > options.tolerance) {
        throw Error(
            std::string("its extent along ") + "xyz"[along.axis] + " differs from that in " +
                "view " + view_name(known->view) + " by " + percent(1 / ratio - 1),
            drawing.name + ", view " + view_name(view.kind),
            "at most " + percent(options.tolerance) + "; scene.align.tolerance allows more");
      }
      constexpr double kSaid = 0.01;
      if (warnings != nullptr && std::abs(ratio - 1) > kSaid)
        warnings->push_back(scaling_text(drawing.name, view.kind, along.axis, *known, size));
      scale[c] = ratio;
      // The lowest coordinate of the view is the highest of an axis that it sees reversed.
      shift[c] = along.sign > 0 ? known->low : -(known->low + known->size);
    }
    for (Stroke& stroke : view.strokes) {
      for (Eigen::Vector2d& p : stroke.points) p = (p - box.low).cwiseProduct(scale) + shift;
    }
    view.picture.origin = (view.picture.origin - box.low).cwiseProduct(scale) + shift;
    view.picture.size = view.picture.size.cwiseProduct(scale);
  }
  return aligned;
}

}  // namespace geoprior::sketch
