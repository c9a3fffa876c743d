#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// Points and faces as a reader finds them.
struct PolygonSoup {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> velocity;  ///< as many as points, or none
  std::vector<int> corners;               ///< of all faces, one after the other
  std::vector<std::size_t> ends;          ///< of each face in `corners`

  static constexpr std::size_t kMostCorners = 256;  ///< of a face
  void end_face() { ends.push_back(corners.size()); }
};

/// Cuts a face into triangles: a quad along its shorter diagonal that lies inside, others by
/// clipping ears in the plane of the face. Degenerate faces become a fan.
void triangulate_face(const std::vector<Eigen::Vector3d>& points, std::span<const int> face,
                      std::vector<Eigen::Vector3i>& triangles);

/// @throws Error  naming face and index: out of range, too few or too many corners
MeshFile mesh_of(const PolygonSoup& soup, const std::string& name);

}  // namespace geoprior
