#include "solvers/fluid/paste/mesh_paste.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "core/geometry/solid.h"
#include "core/geometry/topology.h"

namespace geoprior::fluid {

TriMesh isolated_at(const Feature& feature, const EditedFrame& frame) {
  const auto& times = feature.times;
  const auto after = std::lower_bound(times.begin(), times.end(), frame.source_time);
  std::size_t i = after - times.begin();
  if (i == times.size() ||
      (i > 0 && frame.source_time - times[i - 1] <= times[i] - frame.source_time)) {
    --i;
  }
  TriMesh mesh = feature.meshes[i];
  mesh.V = (mesh.V * frame.placement.linear().transpose()).rowwise() +
           frame.placement.translation().transpose();
  if (frame.placement.linear().determinant() < 0) mesh.F.col(1).swap(mesh.F.col(2));
  return mesh;
}

void insert_mesh(const TriMesh& mesh, const Eigen::Vector3d& velocity, SurfaceFrame& target) {
  const Eigen::Index n = target.mesh.V.rows(), m = target.mesh.F.rows();
  const bool moving = n > 0 && target.velocity.rows() == n;
  target.mesh.V.conservativeResize(n + mesh.V.rows(), 3);
  target.mesh.V.bottomRows(mesh.V.rows()) = mesh.V;
  target.mesh.F.conservativeResize(m + mesh.F.rows(), 3);
  target.mesh.F.bottomRows(mesh.F.rows()) = mesh.F.array() + static_cast<int>(n);
  if (!moving) return;
  target.velocity.conservativeResize(n + mesh.V.rows(), 3);
  target.velocity.bottomRows(mesh.V.rows()).rowwise() = velocity.transpose();
}

namespace {

using Position = std::array<double, 3>;

/// Nothing when the mesh bounds no volume or cuts itself.
std::optional<Solid> solid_of(const TriMesh& mesh) {
  std::optional<Solid> solid = Solid::of(mesh);
  if (solid && !solid->bounds_volume()) solid.reset();
  return solid;
}

std::map<Position, int> by_position(const TriMesh& mesh) {
  std::map<Position, int> result;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    result.emplace(Position{mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2)}, static_cast<int>(v));
  }
  return result;
}

int found(const std::map<Position, int>& at, const TriMesh& mesh, Eigen::Index v) {
  const auto it = at.find({mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2)});
  return it == at.end() ? -1 : it->second;
}

/// Velocities of vertices that were there before; means of these around the others.
Eigen::MatrixX3d carried(const TriMesh& mesh, const Eigen::MatrixX3d& before,
                         const Eigen::Vector3d& velocity, const std::vector<int>& of_target,
                         const std::vector<int>& of_mesh) {
  Eigen::MatrixX3d result = Eigen::MatrixX3d::Zero(mesh.V.rows(), 3);
  const VertexGraph rings = one_rings(mesh.F, mesh.vertex_count());
  const auto known = [&](std::size_t v) { return of_target[v] >= 0 || of_mesh[v] >= 0; };
  const auto row = [&](std::size_t v) -> Eigen::RowVector3d {
    return of_target[v] >= 0 ? Eigen::RowVector3d(before.row(of_target[v])) : velocity.transpose();
  };
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (known(v)) {
      result.row(v) = row(v);
      continue;
    }
    int count = 0;
    for (const int w : rings.of(v)) {
      if (!known(w)) continue;
      result.row(v) += row(w);
      ++count;
    }
    if (count > 0) result.row(v) /= count;
  }
  return result;
}

}  // namespace

bool unite_mesh(const TriMesh& mesh, const Eigen::Vector3d& velocity, SurfaceFrame& target,
                std::vector<int>& of_target, std::vector<int>& of_mesh) {
  std::optional<Solid> a = solid_of(target.mesh), b = solid_of(mesh);
  if (!a || !b) return false;
  const std::optional<Solid> both = united(std::move(*a), std::move(*b));
  if (!both) return false;
  SurfaceFrame result;
  result.time = target.time;
  result.mesh = both->mesh();
  const std::map<Position, int> in_target = by_position(target.mesh), in_mesh = by_position(mesh);
  of_target.clear();
  of_mesh.clear();
  for (Eigen::Index v = 0; v < result.mesh.V.rows(); ++v) {
    of_target.push_back(found(in_target, result.mesh, v));
    of_mesh.push_back(of_target.back() >= 0 ? -1 : found(in_mesh, result.mesh, v));
  }
  if (target.velocity.rows() == target.mesh.V.rows()) {
    result.velocity = carried(result.mesh, target.velocity, velocity, of_target, of_mesh);
  }
  target = std::move(result);
  return true;
}

}  // namespace geoprior::fluid
