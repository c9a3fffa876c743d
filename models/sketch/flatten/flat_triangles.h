#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <vector>

#include "core/mesh.h"

namespace geoprior::sketch {

/// A point or a vector of the plane as the number x + i y: turning is a product, the dot product of
/// a and b is the real part of conj(a) b, and their cross product the imaginary part.
using Complex = std::complex<double>;

/// A triangle of the surface laid flat by itself, and the weights of its edges.
struct FlatTriangle {
  std::array<Complex, 3> edge{};  ///< from corner k to its next corner (m)
  std::array<double, 3> angle{};  ///< at corner k (rad); their sum is pi
  /// Cotangent of the angle that lies opposite to edge k, of the triangle whose small angles are
  /// raised to the least one allowed. These are the cotangents of a true triangle, so that its
  /// Dirichlet energy is never below the area of its image.
  std::array<double, 3> cot{};
  double area = 0;  ///< m^2
};

/// Cotangents above which the angle of a needle is raised (2.9 degrees).
inline constexpr double kLargestCotangent = 20;

/// @param largest_cotangent  above 1
std::vector<FlatTriangle> flat_triangles(const TriMesh& mesh,
                                         double largest_cotangent = kLargestCotangent);

/// Cotangents of the angles opposite to the edges k of a triangle with these angles at its corners,
/// none of which is above `largest`.
std::array<double, 3> opposite_cotangents(const std::array<double, 3>& angle, double largest);

/// n x 2 coordinates as n numbers, and back.
Eigen::VectorXcd to_complex(const Eigen::MatrixX2d& points);
Eigen::MatrixX2d to_points(const Eigen::VectorXcd& z);

/// Twice the signed area of the image of a triangle (m^2).
inline double twice_signed_area(const Complex& a, const Complex& b, const Complex& c) {
  return std::imag(std::conj(b - a) * (c - a));
}

/// Triangles that are turned over or have lost their area in the plane, ascending. What has no area
/// in space either (an altitude below 1e-9 of its longest edge) counts as neither.
std::vector<int> flipped_triangles(const std::vector<FlatTriangle>& triangles,
                                   const Eigen::MatrixX3i& F, const Eigen::VectorXcd& z);

/// Multiplies `z` so that the triangles' images have together the area of the triangles.
void scale_to_area(const std::vector<FlatTriangle>& triangles, const Eigen::MatrixX3i& F,
                   Eigen::VectorXcd& z);

}  // namespace geoprior::sketch
