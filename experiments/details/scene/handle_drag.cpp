#include "experiments/details/scene/handle_drag.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_deformation.h>

#include <string>
#include <utility>

#include "core/error.h"
#include "core/inputs/trajectory.h"

namespace geoprior::details {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = Mesh::Vertex_index;
using Deformation = CGAL::Surface_mesh_deformation<Mesh>;

/// Vertices numbered as the rows of `rest`.
Mesh to_cgal(const TriMesh& rest) {
  Mesh mesh;
  for (Eigen::Index v = 0; v < rest.V.rows(); ++v)
    mesh.add_vertex({rest.V(v, 0), rest.V(v, 1), rest.V(v, 2)});
  const auto vertex = [](int v) { return Vertex(static_cast<Mesh::size_type>(v)); };
  for (Eigen::Index t = 0; t < rest.F.rows(); ++t) {
    const auto face =
        mesh.add_face(vertex(rest.F(t, 0)), vertex(rest.F(t, 1)), vertex(rest.F(t, 2)));
    if (face == Mesh::null_face()) {
      throw Error("triangle " + std::to_string(t) + " makes the surface non-manifold",
                  "scene.surface", "a manifold surface");
    }
  }
  return mesh;
}

struct Handle {
  Eigen::Vector3d centre;
  Trajectory motion;
  std::vector<int> vertices;
};

std::string place(std::size_t i) { return "scene.motion.drag.handles." + std::to_string(i); }

std::vector<Handle> handles_of(const TriMesh& rest, const HandleDragOptions& options) {
  if (options.handles.empty()) throw Error("has no handles", "scene.motion.drag", "at least one");
  std::vector<Handle> handles;
  std::vector<int> owner(rest.V.rows(), -1);
  std::size_t held = 0;
  for (std::size_t i = 0; i < options.handles.size(); ++i) {
    const HandleBallOptions& o = options.handles[i];
    Handle handle{to_vector(o.centre), {}, {}};
    handle.motion.keys = {Keyframe{}};
    if (!o.keys.empty()) handle.motion = to_trajectory(o.keys, place(i) + ".keys");
    for (Eigen::Index v = 0; v < rest.V.rows(); ++v) {
      if ((rest.V.row(v).transpose() - handle.centre).norm() > o.radius) continue;
      int& other = owner[v];
      if (other >= 0) {
        throw Error(
            "holds vertex " + std::to_string(v) + " as well as handle " + std::to_string(other),
            place(i), "handles that are apart");
      }
      other = static_cast<int>(i);
      handle.vertices.push_back(static_cast<int>(v));
    }
    if (handle.vertices.empty())
      throw Error("holds no vertex", place(i), "a ball that meets the surface");
    held += handle.vertices.size();
    handles.push_back(std::move(handle));
  }
  if (held == owner.size())
    throw Error("hold every vertex", "scene.motion.drag.handles", "some that can follow");
  return handles;
}

void require_start_at_rest(const std::vector<Handle>& handles, double time) {
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const Keyframe key = handles[i].motion.at(time);
    if (key.shift.isZero() && key.turn.isApprox(Eigen::Quaterniond::Identity())) continue;
    throw Error("is not at rest in the first frame", place(i) + ".keys", "no move and no turn");
  }
}

Eigen::MatrixX3d positions_of(const Mesh& mesh) {
  Eigen::MatrixX3d V(mesh.number_of_vertices(), 3);
  for (const Vertex v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    V.row(v.idx()) << p.x(), p.y(), p.z();
  }
  return V;
}

}  // namespace

void describe(OptionVisitor& v, HandleBallOptions& options) {
  v.value("centre", options.centre, {.doc = "centre of the handle's ball, at rest", .unit = "m"});
  v.value(
      "radius", options.radius,
      {.doc = "radius of the handle's ball, whose vertices are held", .unit = "m", .min = 1e-9});
  describe_keys(v, options.keys);
}

void describe(OptionVisitor& v, HandleDragOptions& options) {
  describe_list(v, "handles", options.handles, {.doc = "balls of vertices that are held or moved"});
  v.value("iterations", options.iterations,
          {.doc = "local and global steps that the surface makes after the handles in a frame",
           .min = 1,
           .max = 1000});
}

std::shared_ptr<const SurfaceMotion> drag_handles(const TriMesh& rest,
                                                  const HandleDragOptions& options,
                                                  const std::vector<double>& times) {
  const std::vector<Handle> handles = handles_of(rest, options);
  require_start_at_rest(handles, times.front());
  Mesh mesh = to_cgal(rest);
  Deformation deformation(mesh);
  for (const Vertex v : mesh.vertices()) deformation.insert_roi_vertex(v);
  for (const Handle& handle : handles)
    for (const int v : handle.vertices)
      deformation.insert_control_vertex(Vertex(static_cast<Mesh::size_type>(v)));
  if (!deformation.preprocess()) {
    throw Error("a part of the surface without a handle cannot follow", "scene.motion.drag",
                "a surface in one piece");
  }
  std::vector<Eigen::MatrixX3d> frames{rest.V};
  for (std::size_t i = 1; i < times.size(); ++i) {
    for (const Handle& handle : handles) {
      const Keyframe key = handle.motion.at(times[i]);
      for (const int v : handle.vertices) {
        const Eigen::Vector3d x = rest.V.row(v).transpose() - handle.centre;
        const Eigen::Vector3d to = handle.centre + key.turn * x + key.shift;
        deformation.set_target_position(Vertex(static_cast<Mesh::size_type>(v)),
                                        {to.x(), to.y(), to.z()});
      }
    }
    deformation.deform(static_cast<unsigned>(options.iterations), 0);
    frames.push_back(positions_of(mesh));
  }
  return std::make_shared<StoredMotion>(std::move(frames), times);
}

}  // namespace geoprior::details
