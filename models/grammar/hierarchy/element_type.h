#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace geoprior::grammar {

/// One number that an element of a type has.
struct ParameterType {
  std::string name;
  std::string unit = "1";
  double low = -std::numeric_limits<double>::infinity();  ///< least value that is allowed
  double high = std::numeric_limits<double>::infinity();  ///< largest value that is allowed
};

/// What elements are: their parameters, and the shape that these give them.
///
/// A shape is in the element's own frame (m): the pose of the element places it. An element that
/// has points of its own (a terrain, a path) has no shape: its points are its key points.
struct ElementType {
  std::string name;
  std::vector<ParameterType> parameters = {};
  /// Points by which the element is measured: the ends of a branch, the corners of a wall. Their
  /// number depends on the type alone. Appended to `out`.
  std::function<void(std::span<const double> parameters, std::vector<Eigen::Vector3d>& out)> keys =
      {};
  /// What is drawn; empty for an element that only holds others together.
  std::function<TriMesh(std::span<const double> parameters)> mesh = {};
  /// Of a type whose elements have points: the triangles between them; may be empty.
  Eigen::MatrixX3i triangles = {};

  /// @throws Error  naming the type, when it has no such parameter
  [[nodiscard]] int parameter(const std::string& name_of_it) const;
};

}  // namespace geoprior::grammar
