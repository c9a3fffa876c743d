#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/frame.h"
#include "core/geometry/surface_point.h"
#include "metrics/spacing/detail_continuity.h"
#include "metrics/spacing/detail_spacing.h"
#include "models/details/scene.h"

namespace geoprior::details {

/// The part "details" of a recorded frame (models/details/process.h), by rows. What metrics read
/// are spans into it.
struct FrameDetails {
  std::vector<std::int64_t> birth;
  std::vector<double> weight, target;
  std::vector<int> face;
  Eigen::MatrixX3d barycentric;

  /// @throws Error  for an array that is missing
  explicit FrameDetails(const Part& details);

  [[nodiscard]] DetailsOfFrame state() const { return {birth, weight}; }
  [[nodiscard]] DetailTargets targets() const { return {birth, target}; }
  [[nodiscard]] AnchoredDetails anchored() const { return {state(), face, barycentric}; }
  /// Details of weight above 1/2.
  [[nodiscard]] int visible_count() const;
  [[nodiscard]] std::vector<SurfacePoint> visible_places() const;
};

/// Places of the details of a scene.
std::vector<SurfacePoint> places_of(const std::vector<Detail>& details);

/// Lengths of the edges of "detail_mesh" or "visible_mesh" among details; `outside` is against the
/// reference length (m).
DetailSpacing spacing_of(const Part& mesh, double reference);

}  // namespace geoprior::details
