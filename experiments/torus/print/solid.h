#pragma once

#include <string>

#include "core/mesh.h"

namespace geoprior::torus {

/// A body that can be printed: the surface, a wall inside of it with the same triangles, and where
/// the surface has a border, strips between the two.
///
/// @param surface  oriented, with its normals outwards; closed, or with a border
/// @param inside   a point of the inner wall below each vertex
TriMesh body_between(const TriMesh& surface, const Eigen::MatrixX3d& inside);

/// Points of a round tube inside of a whole torus, `thickness` below the nearest of its points.
/// @param ring  radius of the centre line, which lies about the z axis
/// @param at    parameters of each vertex
/// @throws Error  where the wall is as thick as the tube
Eigen::MatrixX3d round_cavity(const TriMesh& surface, const Eigen::MatrixXd& at, double ring,
                              double thickness);

/// Points of a flat plate below a square lattice of points, `thickness` below the lowest against
/// the mean normal, between the four corners.
Eigen::MatrixX3d flat_plate(const TriMesh& surface, double thickness);

/// The mesh scaled and moved so that its box begins at 0.
TriMesh scaled(TriMesh mesh, double factor);

/// Largest side of the box around the mesh.
double extent(const TriMesh& mesh);

/// Bytes of a binary STL file: a head of 80, little-endian, single precision. Printers take its
/// numbers for millimetres, so that they are.
/// @param mesh    in m
/// @throws Error  for 2^32 triangles and more
std::string stl_bytes(const TriMesh& mesh);

}  // namespace geoprior::torus
