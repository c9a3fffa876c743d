#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace geoprior::fluid {

/// What is known of a feature in one of its frames.
struct FrameSample {
  int frame = 0;                                         ///< of the animation, increasing
  double time = 0;                                       ///< s
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();      ///< on the bed (m)
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();     ///< mean of the bed, unit
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the area (m^2)
  double area = 0;                                       ///< m^2
};

struct FrameTime {
  int frame = 0;
  double time = 0;
};

/// Frames that move with a feature, at all times asked for (gaps between samples included).
///
/// Centre and normal: least-squares parabola over the `window` frames about each time (Savitzky and
/// Golay 1964, for times that need not be even), so steady motion and free fall pass unchanged.
/// z is the normal. x follows the path (of parabolas over three windows) when the feature travels
/// more than half its size sqrt(area); while it rests, the direction before is kept. Otherwise x is
/// one axis for all times: the longest of the summed covariances. x is carried along the normal.
std::vector<Eigen::Isometry3d> moving_frames(const std::vector<FrameSample>& samples,
                                             const std::vector<FrameTime>& times, int window);

/// Centres alone, axes of the world: isolated features.
std::vector<Eigen::Isometry3d> moving_centres(const std::vector<FrameSample>& samples,
                                              const std::vector<FrameTime>& times, int window);

}  // namespace geoprior::fluid
