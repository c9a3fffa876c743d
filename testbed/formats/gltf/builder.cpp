#include "testbed/formats/gltf/builder.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.h"

namespace geoprior::gltf {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kVertexTarget = 34962;
constexpr int kIndexTarget = 34963;

void append_word(std::string& out, std::size_t word) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>((word >> (8 * i)) & 0xFF));
}

}  // namespace

GlbBuilder::GlbBuilder() { document_["asset"] = {{"version", "2.0"}, {"generator", "geoprior"}}; }

int GlbBuilder::add_bytes(const void* values, std::size_t size, std::size_t count, const char* type,
                          int component, int target) {
  json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}};
  if (target != 0) view["target"] = target;
  document_["bufferViews"].push_back(view);
  document_["accessors"].push_back({{"bufferView", document_["bufferViews"].size() - 1},
                                    {"componentType", component},
                                    {"count", count},
                                    {"type", type}});
  const std::size_t at = bytes_.size();
  bytes_.resize(at + size);
  if (size > 0) std::memcpy(bytes_.data() + at, values, size);
  return static_cast<int>(document_["accessors"].size()) - 1;
}

int GlbBuilder::add(const std::vector<float>& values, const char* type, int columns, int target) {
  return add_bytes(values.data(), values.size() * sizeof(float), values.size() / columns, type,
                   kFloat, target);
}

int GlbBuilder::add(const std::vector<std::uint32_t>& values, const char* type, int columns,
                    int target) {
  return add_bytes(values.data(), values.size() * sizeof(std::uint32_t), values.size() / columns,
                   type, kUnsignedInt, target);
}

int GlbBuilder::add_vectors(const Eigen::MatrixX3d& V) {
  std::vector<float> values;
  values.reserve(V.size());
  for (Eigen::Index v = 0; v < V.rows(); ++v)
    for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(V(v, k)));
  const int index = add(values, "VEC3", 3, kVertexTarget);
  const Eigen::RowVector3f low = V.cast<float>().colwise().minCoeff();
  const Eigen::RowVector3f high = V.cast<float>().colwise().maxCoeff();
  json& accessor = document_["accessors"][index];
  accessor["min"] = {low[0], low[1], low[2]};
  accessor["max"] = {high[0], high[1], high[2]};
  return index;
}

int GlbBuilder::add_times(const std::vector<double>& times_s) {
  const std::vector<float> times(times_s.begin(), times_s.end());
  const int index = add(times, "SCALAR", 1);
  json& accessor = document_["accessors"][index];
  accessor["min"] = {times.front()};
  accessor["max"] = {times.back()};
  return index;
}

json GlbBuilder::primitive(const TriMesh& mesh, const Eigen::Vector3d& origin) {
  std::vector<std::uint32_t> indices;
  indices.reserve(mesh.F.size());
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
    for (int k = 0; k < 3; ++k) indices.push_back(static_cast<std::uint32_t>(mesh.F(f, k)));
  json primitive;
  primitive["attributes"]["POSITION"] = add_vectors(mesh.V.rowwise() - origin.transpose());
  primitive["indices"] = add(indices, "SCALAR", 1, kIndexTarget);
  return primitive;
}

std::string GlbBuilder::glb(const std::string& file) {
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

}  // namespace geoprior::gltf
