#include "models/details/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "models/details/surface_walk.h"

namespace geoprior::details {
namespace {

std::string element(const std::string& kind, Eigen::Index i) {
  return kind + " " + std::to_string(i);
}

/// First triangle of no area: its height is below round-off of its longest edge; -1 when none.
Eigen::Index flat_triangle(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F) {
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::RowVector3d a = V.row(F(t, 0)), b = V.row(F(t, 1)), c = V.row(F(t, 2));
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    if (!((b - a).cross(c - a).norm() > 1e-12 * longest)) return t;
  }
  return -1;
}

void require_indices(const TriMesh& mesh, const std::string& where) {
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.F(t, k) < 0 || mesh.F(t, k) >= mesh.V.rows()) {
        throw Error("triangle " + std::to_string(t) + " has vertex " + std::to_string(mesh.F(t, k)),
                    where, "0 … " + std::to_string(mesh.V.rows() - 1));
      }
    }
  }
}

/// Every vertex has one fan of triangles, and one piece holds them all.
void require_one_manifold(const TriMesh& mesh, const std::string& where) {
  const auto bad = non_manifold_edges(mesh.F);
  if (!bad.empty()) {
    throw Error("edge " + std::to_string(bad[0][0]) + "-" + std::to_string(bad[0][1]) +
                    " has more than two triangles, or two that turn opposite ways (" +
                    std::to_string(bad.size()) + " such edges)",
                where, "a manifold, consistently oriented surface");
  }
  const SurfaceTopology topology(mesh);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (topology.corners_of(v).empty())
      throw Error("vertex " + std::to_string(v) + " has no triangle", where,
                  "a surface in one piece");
    if (topology.fan_of(v) != topology.corners.count(v))
      throw Error("two sheets meet in vertex " + std::to_string(v), where, "a manifold surface");
  }
  std::vector<char> seen(topology.face.size(), 0);
  std::vector<int> stack{0};
  seen[0] = 1;
  while (!stack.empty()) {
    const std::size_t f = stack.back();
    stack.pop_back();
    for (const int g : topology.across[f]) {
      if (g < 0 || seen[g] != 0) continue;
      seen[g] = 1;
      stack.push_back(g);
    }
  }
  const auto other = std::find(seen.begin(), seen.end(), 0);
  if (other != seen.end()) {
    throw Error("triangle " + std::to_string(other - seen.begin()) + " is in another piece", where,
                "a surface in one piece");
  }
}

void require_surface(const TriMesh& mesh, const std::string& where) {
  if (mesh.F.rows() == 0) throw Error("the surface has no triangles", where, "a triangle mesh");
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    if (!mesh.V.row(v).allFinite())
      throw Error("vertex " + std::to_string(v) + " is not finite", where, "finite coordinates");
  }
  require_indices(mesh, where);
  require_one_manifold(mesh, where);
  const Eigen::Index flat = flat_triangle(mesh.V, mesh.F);
  if (flat >= 0)
    throw Error("triangle " + std::to_string(flat) + " has no area", where, "proper triangles");
}

void require_detail(const Detail& d, Eigen::Index i, Eigen::Index faces, const std::string& name) {
  const std::string where = name + ", " + element("detail", i);
  if (d.at.face < 0 || d.at.face >= faces) {
    throw Error("is off the surface: face " + std::to_string(d.at.face), where,
                "0 … " + std::to_string(faces - 1));
  }
  const auto& b = d.at.barycentric;
  if (!b.allFinite() || b.minCoeff() < -1e-6 || std::abs(b.sum() - 1) > 1e-6) {
    throw Error("is off the surface: barycentric coordinates outside its face", where,
                "three numbers in [0, 1] with sum 1");
  }
  for (const double w : {d.weight, d.target_weight}) {
    if (!(w >= 0 && w <= 1)) throw Error("weight " + std::to_string(w), where, "0 … 1");
  }
  if (!std::isfinite(d.tangent_angle)) throw Error("tangent angle", where, "a finite angle");
}

/// Sorted along x, so that only neighbours in x are compared.
void require_apart(const DetailScene& scene, double least) {
  const auto n = scene.details.size();
  std::vector<Eigen::Vector3d> p(n);
  for (std::size_t i = 0; i < n; ++i)
    p[i] = position_of(scene.details[i].at, scene.surface.V, scene.surface.F);
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(p[a].x(), a) < std::pair(p[b].x(), b);
  });
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n && p[order[j]].x() - p[order[i]].x() <= least; ++j) {
      if ((p[order[i]] - p[order[j]]).norm() > least) continue;
      const auto [a, b] = std::minmax(order[i], order[j]);
      throw Error("is in the place of detail " + std::to_string(a),
                  scene.name + ", detail " + std::to_string(b), "details in different places");
    }
  }
}

}  // namespace

StoredMotion::StoredMotion(std::vector<Eigen::MatrixX3d> positions, std::vector<double> parameters)
    : positions_(std::move(positions)), parameters_(std::move(parameters)) {
  if (positions_.empty() || positions_.size() != parameters_.size()) {
    throw Error(std::to_string(positions_.size()) + " frames with " +
                    std::to_string(parameters_.size()) + " parameters",
                "motion", "one parameter a frame, at least one frame");
  }
  for (std::size_t i = 1; i < positions_.size(); ++i) {
    const auto where = "motion, frame " + std::to_string(i);
    if (positions_[i].rows() != positions_[0].rows()) {
      throw Error(std::to_string(positions_[i].rows()) + " vertices", where,
                  "as many as in frame 0: " + std::to_string(positions_[0].rows()));
    }
    if (!(parameters_[i] > parameters_[i - 1]))
      throw Error("its parameter does not increase", where, "increasing parameters");
  }
}

double StoredMotion::parameter(int frame) const { return parameters_.at(frame); }

Eigen::MatrixX3d StoredMotion::positions(int frame) const { return positions_.at(frame); }

std::shared_ptr<const SurfaceMotion> motion_of_sequence(const SurfaceSequence& sequence) {
  std::vector<Eigen::MatrixX3d> positions;
  std::vector<double> times;
  Eigen::MatrixX3i first;
  for (int i = 0; i < sequence.frame_count(); ++i) {
    SurfaceFrame frame = sequence.frame(i);
    if (i == 0) first = frame.mesh.F;
    if (!same_triangles(frame.mesh.F, first) ||
        (i > 0 && frame.mesh.V.rows() != positions[0].rows())) {
      throw Error("its triangles are not those of the first frame",
                  sequence.name() + ", frame " + std::to_string(i), "a sequence of fixed topology");
    }
    positions.push_back(std::move(frame.mesh.V));
    times.push_back(frame.time);
  }
  return std::make_shared<StoredMotion>(std::move(positions), std::move(times));
}

void require_valid(const DetailScene& scene) {
  require_surface(scene.surface, scene.name);
  if (scene.details.size() < 3) {
    throw Error(std::to_string(scene.details.size()) + " details", scene.name,
                "at least 3: a mesh of details has triangles");
  }
  for (std::size_t i = 0; i < scene.details.size(); ++i)
    require_detail(scene.details[i], i, scene.surface.F.rows(), scene.name);
  require_apart(scene, 1e-9 * bounding_box_diagonal(scene.surface.V));
  if (!scene.motion || scene.motion->frame_count() < 1)
    throw Error("there is no motion", scene.name, "at least one frame");
  const Eigen::MatrixX3d start = scene.motion->positions(0);
  if (start.rows() != scene.surface.V.rows() || !((start - scene.surface.V).cwiseAbs().maxCoeff() <=
                                                  1e-9 * bounding_box_diagonal(scene.surface.V))) {
    throw Error("frame 0 of the motion is not the surface at rest", scene.name,
                "a motion that starts at rest");
  }
}

void require_valid_step(const Eigen::MatrixX3i& F, const Eigen::MatrixX3d& before,
                        const Eigen::MatrixX3d& now, int frame, const std::string& name) {
  const std::string where = name + ", frame " + std::to_string(frame);
  if (now.rows() != before.rows()) {
    throw Error("the topology changes: " + std::to_string(now.rows()) + " vertices", where,
                "as many as before: " + std::to_string(before.rows()));
  }
  for (Eigen::Index v = 0; v < now.rows(); ++v) {
    if (!now.row(v).allFinite())
      throw Error("vertex " + std::to_string(v) + " is not finite", where, "finite coordinates");
  }
  const Eigen::Index flat = flat_triangle(now, F);
  if (flat >= 0)
    throw Error("triangle " + std::to_string(flat) + " has no area", where, "proper triangles");
  Eigen::Index turned = 0, first = -1;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const auto normal = [&](const Eigen::MatrixX3d& V) -> Eigen::RowVector3d {
      const Eigen::RowVector3d a = V.row(F(t, 0)), b = V.row(F(t, 1)), c = V.row(F(t, 2));
      return (b - a).cross(c - a);
    };
    if (normal(before).dot(normal(now)) >= 0) continue;
    if (turned++ == 0) first = t;
  }
  if (turned > 0 && 2 * turned < F.rows()) {
    throw Error("triangle " + std::to_string(first) + " turned over (" + std::to_string(turned) +
                    " of " + std::to_string(F.rows()) + " did)",
                where, "a deformation that inverts no triangle");
  }
}

}  // namespace geoprior::details
