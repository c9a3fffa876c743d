#include "metrics/contact/harm.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/geometry/triangle_tree.h"

namespace geoprior {
namespace {

/// The triangles of a list that have an area, as a tree; absent when there are none.
std::optional<TriangleTree> tree_of(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                                    const std::vector<int>& triangles) {
  TriMesh part;
  part.V = V;
  part.F.resize(triangles.size(), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    part.F.row(i) = F.row(triangles[i]);
  }
  if (faces_with_area(part).empty()) return std::nullopt;
  return TriangleTree(part);
}

}  // namespace

std::vector<int> unasked_vertices(const BoneRings& rings, const Eigen::MatrixX3i& F,
                                  const Eigen::MatrixX3d& reference, const Pose& pose,
                                  const std::vector<int>& overlapping, const HarmOptions& options) {
  const Eigen::VectorXd section = rings.section_ratios(reference, pose);
  const std::optional<TriangleTree> overlap = tree_of(reference, F, overlapping);
  std::vector<int> unasked;
  for (int v = 0; v < rings.vertex_count(); ++v) {
    const std::optional<double> radius = rings.radius(v);
    if (!radius || std::abs(section(v) - 1) > options.section_change) continue;
    const double clear = options.clear_radii * *radius;
    const Eigen::Vector3d x = reference.row(v).transpose();
    if (overlap && overlap->squared_distance(x) <= clear * clear) continue;
    unasked.push_back(v);
  }
  return unasked;
}

std::optional<Harm> harm(const BoneRings& rings, const std::vector<int>& unasked,
                         const Eigen::MatrixX3d& posed, const Eigen::MatrixX3d& reference) {
  if (posed.rows() != reference.rows()) {
    throw Error(std::to_string(posed.rows()) + " posed vertices", "harm",
                std::to_string(reference.rows()) + ", as the reference");
  }
  if (unasked.empty()) return std::nullopt;
  Harm harm;
  const double whole_area = rings.vertex_area().sum();
  for (const int v : unasked) {
    const double displacement = (posed.row(v) - reference.row(v)).norm();
    harm.max = std::max(harm.max, displacement / rings.radius(v).value());
    harm.unasked_share += rings.vertex_area()(v) / whole_area;
  }
  return harm;
}

}  // namespace geoprior
