#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/inputs/skeleton.h"
#include "core/mesh.h"
#include "metrics/contact/joint_region.h"

namespace geoprior {

/// Volume counted more than once by a closed surface: the integral of max(0, w - 1) over space (or
/// a box), w the winding number (m^3).
///
/// Parallel columns on a square grid; along each column the integral is exact, from the signed
/// crossings with the surface. So the value does not depend on the tessellation, and the only error
/// is that of the grid: it falls about as spacing^2 and is estimated by `overlap_study`. Where the
/// surface is inside out (w < 0) nothing is counted.
///
/// A column passes on one side of each mesh edge, decided once per edge, so that neighbouring
/// triangles agree and no crossing is lost or doubled; columns stand off the mesh's likely symmetry
/// planes by irrational fractions of the spacing. A column whose signs do not add up to zero (an
/// open mesh; round-off in slivers) is left out and counted in `unbalanced_columns`.
///
/// The result does not depend on the number of threads.
struct OverlapVolume {
  double volume = 0;           ///< m^3
  double inside_out = 0;       ///< integral of max(0, -w) (m^3)
  double cut_area = 0;         ///< of the box's faces that lie in the overlap (m^2): 0 unless cut
  int columns = 0;             ///< that crossed anything
  int unbalanced_columns = 0;  ///< left out
};

/// @param V,F      closed, outward oriented mesh
/// @param box      only the part inside counts; columns are cast through its projection
/// @param spacing  distance of the columns (m)
/// @param axis     0, 1 or 2: columns run along x, y or z
/// @throws Error   on a spacing that is not positive or gives more than 2^28 columns
OverlapVolume overlap_volume(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                             const Eigen::AlignedBox3d& box, double spacing, int axis);

/// The overlap with its noise floor, by a resolution study.
struct OverlapStudy {
  double volume = 0;       ///< along the first axis at half the spacing (m^3)
  double noise_floor = 0;  ///< what cannot be told from nothing (m^3)
  double inside_out = 0;   ///< of the same columns, as `cut_area` (m^3)
  double cut_area = 0;     ///< overlap goes on outside the box across this area (m^2)
  int unbalanced_columns = 0;

  /// The overlap; 0 where it does not exceed the floor.
  [[nodiscard]] double above_floor() const { return volume > noise_floor ? volume : 0.0; }
  /// This over another one: 0 up to the larger of the two floors, which is also the least that it
  /// is divided by.
  [[nodiscard]] double ratio_to(const OverlapStudy& other) const;
};

/// What a pose has more than rest; noise floors add up, as the errors of a difference do at worst.
/// `cut_area` is 0 where rest has more.
OverlapStudy overlap_above_rest(const OverlapStudy& posed, const OverlapStudy& rest);

/// Relative change of the volume of the points inside a closed mesh, however often they are: that
/// of the signed volume, less what overlaps more and plus what is inside out more than at rest.
/// @param above       of the whole mesh (`overlap_above_rest`)
/// @param rest_union  `union_volume` at rest (m^3)
double union_volume_change(const Eigen::MatrixX3d& rest, const Eigen::MatrixX3d& posed,
                           const Eigen::MatrixX3i& F, const OverlapStudy& above, double rest_union);

/// Evaluates at spacing h and h/2 along one axis and at h along another: those in whose direction
/// the box's projection is smallest.
///
/// Noise floor: the larger of the spread |O(h) - O(h/2)|, |O(h) - O'(h)| and the detection limit
/// (h/2)^2 * depth_scale: an overlap that fits between the columns, one cell across and
/// `depth_scale` long, may be missed or seen twice.
OverlapStudy overlap_study(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                           const Eigen::AlignedBox3d& box, double spacing, double depth_scale);

/// Distance of the columns of a whole body (m), from its rest pose: 768 along the diagonal.
double body_column_spacing(const Eigen::MatrixX3d& rest);

/// The study of all of a closed mesh; `spacing` from `body_column_spacing`, so that it is the same
/// in every pose. Detects what is 48 columns deep: a finger's crease on a body.
OverlapStudy body_overlap_study(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                                double spacing);

/// The study about a region's joints, in `joint_box`, to the depth of their smallest radius.
OverlapStudy region_overlap_study(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                                  const JointRegion& region, const Pose& pose);

/// Triangles of a closed mesh in which columns enter or leave an overlap: they bound it. Ascending.
/// Overlaps that fit between the columns are missed: `intersecting_triangles` finds those.
/// @throws Error   as `overlap_volume`
std::vector<int> triangles_about_overlap(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                                         double spacing);

/// Volume of the points inside a closed mesh, however often they are (m^3): the signed volume less
/// the overlap, plus what the signed volume takes off where the surface is inside out.
/// @throws Error   as `overlap_volume`
double union_volume(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F, double spacing);

/// Box in which a region's overlap counts: the axis-aligned box of the balls of (extent + 1) radii
/// about the region's posed joints. It depends on the pose alone, so it is the same for every
/// method.
Eigen::AlignedBox3d joint_box(const JointRegion& region, const Pose& pose);

/// Smallest radius of the region's joints (m): the scale of its overlaps.
double smallest_radius(const JointRegion& region);

/// Spacing h used for a region: the smallest radius of its joints over 24.
double region_column_spacing(const JointRegion& region);

}  // namespace geoprior
