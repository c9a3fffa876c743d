#include "testbed/formats/gltf/writer.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"

namespace geoprior {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kVertexTarget = 34962;
constexpr int kIndexTarget = 34963;

/// Binary chunk and the JSON that describes it, grown together.
class GltfBuilder {
 public:
  /// Appends an accessor of its own buffer view; returns its index.
  template <class T>
  int add(const std::vector<T>& values, const char* type, int columns, int component,
          int target = 0) {
    static_assert(sizeof(T) == 4);
    json view{
        {"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (target != 0) view["target"] = target;
    document_["bufferViews"].push_back(view);
    document_["accessors"].push_back({{"bufferView", document_["bufferViews"].size() - 1},
                                      {"componentType", component},
                                      {"count", values.size() / columns},
                                      {"type", type}});
    const std::size_t at = bytes_.size();
    bytes_.resize(at + values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(bytes_.data() + at, values.data(), values.size() * sizeof(T));
    return static_cast<int>(document_["accessors"].size()) - 1;
  }

  /// Positions or their differences; glTF wants their bounds.
  int add_vectors(const Eigen::MatrixX3d& V) {
    std::vector<float> values;
    values.reserve(V.size());
    for (Eigen::Index v = 0; v < V.rows(); ++v)
      for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(V(v, k)));
    const int index = add(values, "VEC3", 3, kFloat, kVertexTarget);
    const Eigen::RowVector3f low = V.cast<float>().colwise().minCoeff();
    const Eigen::RowVector3f high = V.cast<float>().colwise().maxCoeff();
    json& accessor = document_["accessors"][index];
    accessor["min"] = {low[0], low[1], low[2]};
    accessor["max"] = {high[0], high[1], high[2]};
    return index;
  }

  json& document() { return document_; }

  [[nodiscard]] std::string glb(const std::string& file) {
    document_["buffers"] = json::array({{{"byteLength", bytes_.size()}}});
    std::string text = document_.dump(-1, ' ', false, json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t size = 12 + 8 + text.size() + 8 + bytes_.size();
    if (size > std::numeric_limits<std::uint32_t>::max())
      throw Error("the file would have " + std::to_string(size) + " bytes", file, "at most 4 GB");
    std::string out;
    out.reserve(size);
    for (const std::size_t word :
         {std::size_t{0x46546C67}, std::size_t{2}, size, text.size(), std::size_t{0x4E4F534A}})
      append_word(out, word);
    out += text;
    append_word(out, bytes_.size());
    append_word(out, 0x004E4942);
    out += bytes_;
    return out;
  }

 private:
  static void append_word(std::string& out, std::size_t word) {
    for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>((word >> (8 * i)) & 0xFF));
  }
  json document_;
  std::string bytes_;
};

/// Times are compared in single precision, in which they are stored.
void require_times(const std::vector<double>& times_s, const std::string& where) {
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const auto time = static_cast<float>(times_s[i]);
    if (!(time >= 0) || !std::isfinite(time) ||
        (i > 0 && !(time > static_cast<float>(times_s[i - 1])))) {
      throw Error("the time of frame " + std::to_string(i) + " is " + std::to_string(times_s[i]),
                  where, "finite, >= 0, increasing (in single precision)");
    }
  }
}

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
  require_times(times_s, file);
}

void require_chain(const std::vector<GltfLink>& links, const std::vector<double>& times_s,
                   const std::string& name) {
  if (links.empty() || times_s.empty())
    throw Error("has no links or no times", name, "one or more");
  require_times(times_s, name);
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

/// Positions and indices.
json primitive_of(GltfBuilder& builder, const TriMesh& mesh, const Eigen::Vector3d& origin) {
  std::vector<std::uint32_t> indices;
  indices.reserve(mesh.F.size());
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
    for (int k = 0; k < 3; ++k) indices.push_back(static_cast<std::uint32_t>(mesh.F(f, k)));
  json primitive;
  primitive["attributes"]["POSITION"] = builder.add_vectors(mesh.V.rowwise() - origin.transpose());
  primitive["indices"] = builder.add(indices, "SCALAR", 1, kUnsignedInt, kIndexTarget);
  return primitive;
}

json mesh_of(GltfBuilder& builder, const TriMesh& mesh, const Eigen::Vector3d& origin,
             const std::string& name) {
  return {{"name", name}, {"primitives", json::array({primitive_of(builder, mesh, origin)})}};
}

/// A document of one node that has the first mesh.
void begin_one_node(json& document, const std::string& name) {
  document["asset"] = {{"version", "2.0"}, {"generator", "geoprior"}};
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

void add_turns(GltfBuilder& builder, const std::vector<GltfLink>& links,
               const std::vector<double>& times_s, const std::string& name) {
  const std::vector<float> times(times_s.begin(), times_s.end());
  const int input = builder.add(times, "SCALAR", 1, kFloat);
  json& accessor = builder.document()["accessors"][input];
  accessor["min"] = {times.front()};
  accessor["max"] = {times.back()};
  json samplers = json::array(), channels = json::array();
  for (int i = 1; i < std::ssize(links); ++i) {
    const int output = builder.add(turn_keys(links[i]), "VEC4", 4, kFloat);
    channels.push_back(
        {{"sampler", samplers.size()}, {"target", {{"node", i}, {"path", "rotation"}}}});
    samplers.push_back({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
  }
  if (channels.empty()) return;
  builder.document()["animations"] =
      json::array({{{"name", name}, {"samplers", samplers}, {"channels", channels}}});
}

void add_animation(GltfBuilder& builder, const std::vector<double>& times_s,
                   const std::string& name) {
  const std::size_t n = times_s.size();
  const std::vector<float> times(times_s.begin(), times_s.end());
  std::vector<float> weights(n * n, 0.0F);  // one target a frame: at its time alone
  for (std::size_t i = 0; i < n; ++i) weights[i * n + i] = 1.0F;
  const int input = builder.add(times, "SCALAR", 1, kFloat);
  const int output = builder.add(weights, "SCALAR", 1, kFloat);
  json& accessor = builder.document()["accessors"][input];
  accessor["min"] = {times.front()};
  accessor["max"] = {times.back()};
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
  GltfBuilder builder;
  json& document = builder.document();
  begin_one_node(document, name);
  json primitive = primitive_of(builder, base, Eigen::Vector3d::Zero());
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
  GltfBuilder builder;
  begin_one_node(builder.document(), name);
  json primitive = primitive_of(builder, mesh, Eigen::Vector3d::Zero());
  primitive["attributes"]["NORMAL"] = builder.add_vectors(vertex_normals(mesh));
  builder.document()["meshes"] =
      json::array({{{"name", name}, {"primitives", json::array({primitive})}}});
  return builder.glb(name);
}

std::string rigid_chain_glb(const std::vector<GltfLink>& links, const std::vector<double>& times_s,
                            const std::string& name) {
  require_chain(links, times_s, name);
  GltfBuilder builder;
  json& document = builder.document();
  document["asset"] = {{"version", "2.0"}, {"generator", "geoprior"}};
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
