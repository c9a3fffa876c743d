#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace geoprior::assembly {

/// A rigid motion, or a frame: columns of the rotation are its axes. Layouts in the plane have
/// z = 0 and turn about z.
using Pose = Eigen::Isometry3d;

/// Where a part can be connected. The frame's x axis points out of the part, its z axis up.
struct PortType {
  std::string name;
  Pose frame = Pose::Identity();  ///< in the part's coordinates (m)
};

/// A way through a part (of a ball, of a train): from port to port, or from or to its inside.
struct Way {
  static constexpr int kInside = -1;
  int from = kInside;
  int to = kInside;
  std::vector<Eigen::Vector3d> points;  ///< in the part's coordinates, in the direction of the way
};

/// A rigid motion that carries a part onto itself: port i comes to where port `ports[i]` was.
struct Symmetry {
  std::vector<int> ports;
  Pose motion = Pose::Identity();
};

/// A box of the part's body, for collisions: half extents about its pose.
struct Box {
  Pose pose = Pose::Identity();  ///< in the part's coordinates
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
};

/// A kind of part: all parts with one label have the same ports and the same body.
struct PartType {
  std::string label;
  std::vector<PortType> ports;       ///< ordered
  std::vector<Symmetry> symmetries;  ///< without the identity; a group with it
  TriMesh mesh;                      ///< in the part's coordinates (m); may be empty
  std::vector<Way> ways;
  std::vector<Box> boxes;
};

/// Where a port's counterpart is: its frame turned by half a turn about z.
Pose mated(const Pose& port);

/// How far two ports, in the world, are from being mated.
struct Misfit {
  double translation = 0;  ///< m
  double angle = 0;        ///< rad
};
Misfit misfit(const Pose& port, const Pose& other);

/// Rigid motions, other than the identity, that carry ports onto ports and the vertices of the mesh
/// and the boxes' corners onto themselves, each within `tolerance` (m).
///
/// A part without mesh is judged by its ports alone. Ways are not looked at: a ramp that a ball can
/// only go down has no motion that keeps its ports' z axes and its slope.
std::vector<Symmetry> find_symmetries(const PartType& type, double tolerance);

}  // namespace geoprior::assembly
