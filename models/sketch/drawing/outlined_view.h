#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/sketch/drawing/drawing.h"
#include "models/sketch/drawing/outline.h"

namespace geoprior::sketch {

/// A view with its silhouette.
struct OutlinedView {
  ViewKind kind = ViewKind::front;
  Outline outline;
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< view_frame(kind)

  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& x) const {
    return frame.topRows<2>() * x;
  }
};

/// Views other than `photo`, with their silhouettes as outlines.
/// @throws Error  when a view has no silhouette or more than one
std::vector<OutlinedView> outlined_views(const Drawing& aligned);

}  // namespace geoprior::sketch
