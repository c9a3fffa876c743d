#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/mesh.h"

namespace geoprior::grammar {

/// One stroke of a sculpting tool: what it does, where it goes. Points in metres.
///
/// Within `radius` of the tool the effect falls off as (1 - s)^4 (4 s + 1), s the distance over the
/// radius (Wendland 1995; twice differentiable, 0 beyond). A long stroke is laid out as dabs, each
/// so small that it is invertible.
struct Stroke {
  enum class Kind {
    grab,     ///< moves what it holds along the path
    inflate,  ///< away from the tool (amount > 0) or towards it
    twist,    ///< about `axis` through the tool
    bend      ///< about `axis`, the more the further along `along` from the tool
  };
  Kind kind = Kind::grab;
  std::vector<Eigen::Vector3d> path;  ///< of the tool: one point or more (grab: two or more)
  double radius = 1;                  ///< m
  Eigen::Vector3d axis{0, 0, 1};      ///< twist, bend
  Eigen::Vector3d along{0, 0, 1};     ///< bend
  double amount = 0;  ///< inflate: strain at the tool; twist, bend: largest angle (rad)
};

/// A box of control points: free-form deformation by trivariate Bernstein polynomials (Sederberg
/// and Parry 1986); the identity outside of the box.
struct Lattice {
  Eigen::Vector3d low{0, 0, 0}, high{1, 1, 1};  ///< m
  std::array<int, 3> points{2, 2, 2};           ///< along x, y, z
  std::vector<Eigen::Vector3d> shifts;          ///< of the control points, x fastest (m)
};

/// A closed mesh around the object: mean value coordinates (Ju et al. 2005).
struct Cage {
  TriMesh rest;
  Eigen::MatrixX3d moved;  ///< one row a vertex of `rest`
};

/// What a user does to an object, over time: strokes one after the other, then a lattice and a cage
/// that grow from rest over the whole of the gesture.
struct Gesture {
  std::vector<Stroke> strokes;
  std::optional<Lattice> lattice;
  std::optional<Cage> cage;
};

}  // namespace geoprior::grammar
