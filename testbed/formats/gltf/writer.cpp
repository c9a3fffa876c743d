#include "testbed/formats/gltf/writer.h"

#include <cmath>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/gltf/builder.h"

namespace geoprior {
namespace {

using gltf::GlbBuilder;
using nlohmann::json;

void require_sequence(const std::string& file, const TriMesh& base,
                      const std::vector<Eigen::MatrixX3d>& frames,
                      const std::vector<double>& times_s) {
  if (base.F.rows() == 0 || base.V.rows() == 0) throw Error("the mesh is empty", file);
  if (base.F.minCoeff() < 0 || base.F.maxCoeff() >= base.V.rows())
    throw Error("a triangle's index is out of range", file);
  if (!base.V.allFinite()) throw Error("a position of the base is not finite", file);
  if (frames.size() != times_s.size()) {
    throw Error(std::to_string(times_s.size()) + " times", file,
                std::to_string(frames.size()) + ", one a frame");
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string frame = "frame " + std::to_string(i);
    if (frames[i].rows() != base.V.rows()) {
      throw Error(frame + " has " + std::to_string(frames[i].rows()) + " vertices", file,
                  std::to_string(base.V.rows()));
    }
    if (!frames[i].allFinite()) throw Error("a position of " + frame + " is not finite", file);
  }
  gltf::require_times(times_s, file);
}

void require_chain(const std::vector<GltfLink>& links, const std::vector<double>& times_s,
                   const std::string& name) {
  if (links.empty() || times_s.empty())
    throw Error("has no links or no times", name, "one or more");
  gltf::require_times(times_s, name);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const GltfLink& link = links[i];
    const std::string where = name + ": link " + std::to_string(i) + " '" + link.name + "'";
    require_sequence(where, link.mesh, {}, {});
    if (link.angles.size() != times_s.size()) {
      throw Error("has " + std::to_string(link.angles.size()) + " angles", where,
                  std::to_string(times_s.size()) + ", one a time");
    }
    bool finite = link.pivot.allFinite() && link.axis.allFinite();
    for (const double angle : link.angles) finite = finite && std::isfinite(angle);
    if (!finite) throw Error("its hinge or an angle is not finite", where);
  }
}

json mesh_of(GlbBuilder& builder, const TriMesh& mesh, const Eigen::Vector3d& origin,
             const std::string& name) {
  return {{"name", name}, {"primitives", json::array({builder.primitive(mesh, origin)})}};
}

/// A document of one node that has the first mesh.
void begin_one_node(json& document, const std::string& name) {
  document["scene"] = 0;
  document["scenes"] = json::array({{{"nodes", {0}}}});
  document["nodes"] = json::array({{{"name", name}, {"mesh", 0}}});
}

/// Quaternions x y z w, one a key.
std::vector<float> turn_keys(const GltfLink& link) {
  std::vector<float> keys;
  for (const double angle : link.angles) {
    const Eigen::Vector3d v = std::sin(angle / 2) * link.axis.normalized();
    for (const double x : {v.x(), v.y(), v.z(), std::cos(angle / 2)})
      keys.push_back(static_cast<float>(x));
  }
  return keys;
}

void add_turns(GlbBuilder& builder, const std::vector<GltfLink>& links,
               const std::vector<double>& times_s, const std::string& name) {
  const int input = builder.add_times(times_s);
  json samplers = json::array(), channels = json::array();
  for (int i = 1; i < std::ssize(links); ++i) {
    const int output = builder.add(turn_keys(links[i]), "VEC4", 4);
    channels.push_back(
        {{"sampler", samplers.size()}, {"target", {{"node", i}, {"path", "rotation"}}}});
    samplers.push_back({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
  }
  if (channels.empty()) return;
  builder.document()["animations"] =
      json::array({{{"name", name}, {"samplers", samplers}, {"channels", channels}}});
}

void add_animation(GlbBuilder& builder, const std::vector<double>& times_s,
                   const std::string& name) {
  const std::size_t n = times_s.size();
  std::vector<float> weights(n * n, 0.0F);  // one target a frame: at its time alone
  for (std::size_t i = 0; i < n; ++i) weights[i * n + i] = 1.0F;
  const int input = builder.add_times(times_s);
  const int output = builder.add(weights, "SCALAR", 1);
  builder.document()["animations"] = json::array(
      {{{"name", name},
        {"samplers",
         json::array({{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}})},
        {"channels",
         json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}})}}});
}

}  // namespace

void write_glb_animation(const std::filesystem::path& file, const TriMesh& base,
                         const std::vector<Eigen::MatrixX3d>& frames,
                         const std::vector<double>& times_s, const std::string& name) {
  require_sequence(file.string(), base, frames, times_s);
  GlbBuilder builder;
  json& document = builder.document();
  begin_one_node(document, name);
  json primitive = builder.primitive(base);
  json mesh{{"name", name}};
  for (const Eigen::MatrixX3d& frame : frames) {
    primitive["targets"].push_back({{"POSITION", builder.add_vectors(frame - base.V)}});
    mesh["weights"].push_back(0);
  }
  mesh["primitives"] = json::array({primitive});
  document["meshes"] = json::array({mesh});
  if (!frames.empty()) add_animation(builder, times_s, name);
  write_file_atomically(file, std::string_view(builder.glb(file.string())));
}

std::string surface_glb(const TriMesh& mesh, const std::string& name) {
  require_sequence(name, mesh, {}, {});
  GlbBuilder builder;
  begin_one_node(builder.document(), name);
  json primitive = builder.primitive(mesh);
  primitive["attributes"]["NORMAL"] = builder.add_vectors(vertex_normals(mesh));
  builder.document()["meshes"] =
      json::array({{{"name", name}, {"primitives", json::array({primitive})}}});
  return builder.glb(name);
}

std::string rigid_chain_glb(const std::vector<GltfLink>& links, const std::vector<double>& times_s,
                            const std::string& name) {
  require_chain(links, times_s, name);
  GlbBuilder builder;
  json& document = builder.document();
  document["scene"] = 0;
  document["scenes"] = json::array({{{"name", name}, {"nodes", {0}}}});
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < links.size(); ++i) {
    const GltfLink& link = links[i];
    const Eigen::Vector3d step = link.pivot - before;
    json node{{"name", link.name},
              {"mesh", static_cast<int>(i)},
              {"translation", {step.x(), step.y(), step.z()}}};
    if (i + 1 < links.size()) node["children"] = {static_cast<int>(i) + 1};
    document["nodes"].push_back(node);
    document["meshes"].push_back(mesh_of(builder, link.mesh, link.pivot, link.name));
    before = link.pivot;
  }
  add_turns(builder, links, times_s, name);
  return builder.glb(name);
}

}  // namespace geoprior
