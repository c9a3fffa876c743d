#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "core/mesh.h"

namespace geoprior {

/// The details of one frame, by rows.
struct DetailsOfFrame {
  std::span<const std::int64_t> birth;  ///< identity, the same in all frames; none twice
  std::span<const double> weight;       ///< 0 … 1
};

/// What became of the details from one frame to the next.
struct DetailChanges {
  int inserted = 0;         ///< identities that were not there
  int removed = 0;          ///< identities that are gone: merged or faded out
  double largest_step = 0;  ///< largest change of a weight; who is not there has weight 0
};

/// A method that inserts or removes a detail of weight w at once shows a step of w.
/// @throws Error  when sizes differ or an identity is there twice (names it)
DetailChanges detail_changes(const DetailsOfFrame& before, const DetailsOfFrame& now);

/// Counts of a whole motion.
struct DetailEvents {
  int inserted = 0, removed = 0;
  /// Insertions and removals that cancel each other: inserted + removed - |net change|. A motion
  /// that only stretches needs none.
  int churn = 0;
  double largest_step = 0;
};
DetailEvents detail_events(std::span<const DetailChanges> changes);

/// Where the weights of the details of one frame go, by rows.
struct DetailTargets {
  std::span<const std::int64_t> birth;  ///< identity, the same in all frames
  std::span<const double> target;       ///< weight that the detail goes to: 0 while it fades
};

/// Details that are new, or that fade and did not before: what a method begins by itself in a frame
/// in which nothing moves. Weights that are still on their way to their targets are no event.
int details_that_begin(const DetailTargets& before, const DetailTargets& now);

/// How often a number goes from growing to shrinking or back, by at least `least` from the last
/// extreme. Stretching and returning once makes one turn, five times nine; more than the motion has
/// are oscillations. Constant: 0.
/// @param least  positive; smaller wiggles are no turns
/// @throws Error  unless `least` is positive
int turns(std::span<const double> values, double least);

/// Where and how large details are drawn, by rows, on one surface: triangle of the surface and
/// barycentric coordinates of the anchor, weight.
struct AnchoredDetails {
  DetailsOfFrame state;
  std::span<const int> face;
  Eigen::MatrixX3d barycentric;  ///< n x 3
};

/// Where the points of a drawn detail are that move most.
enum class DetailExtent {
  tip,    ///< on the normal at the anchor, `height` above it: spikes
  around  ///< up to `height` from the anchor in any direction: the rim of a hole (`height` its
          ///< radius), the vertices of an instanced mesh (the distance of the farthest)
};

/// Largest displacement of a drawn detail's points between two frames that the deformation does not
/// explain (m): popping.
///
/// A detail of weight w stands on the surface with its tip at x + w h n, n the surface's
/// normal (vertex normals, interpolated). Both frames are drawn on the surface of now: what was
/// there before is carried by its anchor, so that the deformation alone gives 0. A detail that is
/// new was a point of height 0 at its anchor, one that is gone becomes one: growing from w to w'
/// displaces the tip by |w' - w| h. A detail that slides by d displaces its tip by about d, times
/// the larger of its weights, because one of weight 0 is not seen.
///
/// `around`: the rim of a hole grows in the direction of a slide too, and a tilt by the angle a
/// moves it by 2 w h sin(a / 2): the three add up, which bounds every point of the detail.
///
/// Not seen: a detail that turns about its normal; what drawing itself does, as holes that make
/// room for each other or that are not cut while they are tiny. For these draw both sets on the
/// surface of now and take `hausdorff_distance` of the two drawings.
///
/// @param surface     of now (m)
/// @param before,now  anchors on it
/// @param height      of a detail of weight 1 (m), positive
/// @throws Error      on an anchor without a triangle, or as `detail_changes`
double largest_pop(const TriMesh& surface, const AnchoredDetails& before,
                   const AnchoredDetails& now, double height,
                   DetailExtent extent = DetailExtent::tip);

}  // namespace geoprior
