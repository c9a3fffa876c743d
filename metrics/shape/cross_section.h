#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/inputs/skeleton.h"
#include "metrics/contact/joint_region.h"

namespace geoprior {

struct CrossSectionOptions {
  int planes = 13;          ///< along each bone, from the joint to its reach
  int wedge_planes = 7;     ///< half planes through the bend axis, between the two bones
  int directions = 72;      ///< of a section's radial profile; a multiple of 4
  double min_share = 0.25;  ///< a half section that the bend leaves less of is not compared
};

/// Area of one posed section over that of the same section at rest; both halves apart.
///
/// A section is the radial profile rho(phi) of the skin in a plane about a centre: the distance at
/// which a ray first meets the skin of the region; its area is the sum of rho^2 dphi / 2. Where
/// more than 5 % of the rays meet nothing at rest the section is no limb's (a palm, a web between
/// fingers): neither half of it is compared, because the rays of the other may run along the web.
/// Nor is a half that more than 5 % of its rays miss in the pose. Three families of planes, all
/// moved with the bones:
///  - `proximal`, `distal`: planes orthogonal to a bone at distance s from the joint; the centre is
///    the centroid of the rest section, carried by the bone;
///  - `wedge`: half planes that contain the bend axis and point outwards, between the two bones'
///    planes s = 0: they cover the outside of the joint, which the other two leave out.
///
/// The outer half is the one away from the bend. In the planes of a bone only triangles whose rest
/// position is on the bone's own side of the joint are seen, and on the inner side, where the two
/// limbs meet, the profile of both the posed and the rest section ends at the posed bisector plane
/// of the joint. So two rigid limbs that just meet give 1, skin of the other limb is never taken
/// for the limb's own, and a loss of section is one that the bend itself does not explain. Skin
/// farther along the bone than two radii from the section is never looked at. Near s = 0, where
/// skin of both sides lies in the plane, a section may have too few rays and be absent.
///
/// It is blind to overlap beyond the bisector plane: see overlap_volume.
struct SectionRatio {
  enum class Place { proximal, wedge, distal };
  int hinge = 0;  ///< of the region
  Place place = Place::distal;
  double s = 0;                       ///< from the joint (m); fraction 0 … 1 of the wedge
  std::optional<double> whole;        ///< area ratio; absent for a wedge
  std::optional<double> outer;        ///< area ratio; absent without a bend axis
  std::optional<double> inner;        ///< area ratio; absent where the bend leaves too little
  std::optional<double> outer_point;  ///< radius ratio of the outermost point
};

/// @param rest,posed  n x 3 (m), the mesh's vertices
/// @param pose        of all joints; only the rotation and place of the region's joints are used
std::vector<SectionRatio> cross_sections(const JointRegion& region, const Eigen::MatrixX3i& F,
                                         const Eigen::MatrixX3d& rest,
                                         const Eigen::MatrixX3d& posed, const Pose& pose,
                                         const CrossSectionOptions& options = {});

/// Extremes over all sections; absent where no section has the quantity.
struct SectionSummary {
  std::optional<double> shrink;          ///< smallest area ratio of a half (or whole) section
  std::optional<double> bulge;           ///< largest area ratio of a half (or whole) section
  std::optional<double> outer_bulge;     ///< largest growth of an outer half: ratio - 1
  std::optional<double> elbow_collapse;  ///< smallest radius ratio of the outermost point
};
SectionSummary summarize(const std::vector<SectionRatio>& sections);

}  // namespace geoprior
