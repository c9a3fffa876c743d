#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "experiments/grammar/measures/recorded_state.h"
#include "models/grammar/maps/spatial_map.h"
#include "models/grammar/objects/tree.h"
#include "models/grammar/record.h"

/// Objects of a few elements, and what free-form deformation makes of them, for the tests of
/// measures.
namespace geoprior::grammar::samples {

using Eigen::Vector3d;

inline const AffineMap kStay(Eigen::Affine3d::Identity());

/// A frame as free-form deformation leaves it: key points moved, elements as they were.
inline Frame moved_frame(const Hierarchy& h, const SpatialMap& map, double parameter = 0) {
  Geometry geometry = geometry_of(h, false);
  for (Eigen::Index k = 0; k < geometry.keys.rows(); ++k) {
    const Vector3d x = geometry.keys.row(k);
    geometry.keys.row(k) = map.at(x);
  }
  return frame_of(parameter, h, geometry);
}

inline RecordedState moved_state(const Hierarchy& h, const SpatialMap& map) {
  return {moved_frame(h, map), h.types()};
}

inline AffineMap shifted(double x, double y, double z) {
  return AffineMap(Eigen::Affine3d(Eigen::Translation3d(x, y, z)));
}

inline AffineMap scaled(double x, double y, double z) {
  return AffineMap(Eigen::Affine3d(Eigen::Scaling(x, y, z)));
}

/// A straight trunk of two branches of 1 m, and a side branch of 1 m at its first half.
inline Hierarchy small_tree() {
  Hierarchy h({tree_type(), branch_type()});
  h.add(0, -1, {});
  const Eigen::Quaterniond aside =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d::UnitX());
  const auto values = [](double attach, double level) {
    return std::array{1.0, 0.05, attach, level, 1.0, 1.0};
  };
  h.add(1, 0, {}, values(0, 0));
  h.add(1, 1, {{0, 0, 1}, Eigen::Quaterniond::Identity()}, values(1, 0));
  h.add(1, 1, {{0, 0, 0.5}, aside}, values(0.5, 1));
  return h;
}

/// A set of grains on a cubic lattice of spacing 1.
inline Hierarchy lattice_set(int n) {
  Hierarchy h;
  h.add_type({.name = "volume-set"});
  h.add_type({.name = "grain",
              .parameters = {{"size"}, {"radius"}},
              .keys = [](std::span<const double>, std::vector<Vector3d>& out) {
                out.emplace_back(0, 0, 0);
              }});
  h.add(0, -1, {});
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        h.add(1, 0, {Vector3d(x, y, z), Eigen::Quaterniond::Identity()}, std::array{1.0, 0.5});
  return h;
}

}  // namespace geoprior::grammar::samples
