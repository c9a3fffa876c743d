#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace geoprior::test {

/// A glTF document under construction: buffer 0 grows in the binary chunk.
struct GltfSample {
  nlohmann::json json{{"asset", {{"version", "2.0"}}}};
  std::vector<std::byte> binary;

  /// Appends values as a buffer view; returns its index.
  template <class T>
  std::size_t view(const std::vector<T>& values) {
    const std::size_t at = binary.size();
    binary.resize((at + values.size() * sizeof(T) + 3) / 4 * 4);
    std::memcpy(binary.data() + at, values.data(), values.size() * sizeof(T));
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", at}, {"byteLength", values.size() * sizeof(T)}});
    return json["bufferViews"].size() - 1;
  }

  template <class T>
  std::size_t accessor(const std::vector<T>& values, const char* type, std::size_t columns,
                       int component, bool normalized = false) {
    json["accessors"].push_back({{"bufferView", view(values)},
                                 {"componentType", component},
                                 {"count", values.size() / columns},
                                 {"type", type},
                                 {"normalized", normalized}});
    return json["accessors"].size() - 1;
  }

  [[nodiscard]] std::vector<std::byte> bytes() const {
    nlohmann::json document = json;
    if (!document.contains("buffers"))
      document["buffers"] = nlohmann::json::array({{{"byteLength", binary.size()}}});
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<std::byte> out;
    const auto word = [&](std::size_t x) {
      for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::byte>((x >> (8 * i)) & 0xFF));
    };
    for (const std::size_t x :
         {std::size_t{0x46546C67}, std::size_t{2}, 28 + text.size() + binary.size(), text.size(),
          std::size_t{0x4E4F534A}})
      word(x);
    for (const char c : text) out.push_back(static_cast<std::byte>(c));
    word(binary.size());
    word(0x004E4942);
    out.insert(out.end(), binary.begin(), binary.end());
    return out;
  }
};

/// A square of two triangles in the plane z = 0, corners (0,0) (1,0) (1,1) (0,1), skinned to "hip"
/// at the origin and its child "knee" at (0, 1, 0): lower corners to the hip, upper ones to the
/// knee. Node 0 has the mesh, nodes 1 and 2 are the joints. Accessors: 0 positions, 1 indices, 2
/// joints, 3 weights, 4 inverse bind matrices. A clip turns the knee by 90 degrees about z in one
/// second.
inline GltfSample skinned_square() {
  GltfSample s;
  s.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 3, 5126);
  s.accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 1, 5123);
  s.accessor<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4, 5121);
  s.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4, 5126);
  std::vector<float> bind(32, 0);
  for (std::size_t i = 0; i < 4; ++i) bind[5 * i] = bind[16 + 5 * i] = 1;
  bind[16 + 13] = -1;  // the knee's head is at y = 1
  s.accessor<float>(bind, "MAT4", 16, 5126);
  s.accessor<float>({0, 1}, "SCALAR", 1, 5126);
  const float h = std::sqrt(0.5F);
  s.accessor<float>({0, 0, 0, 1, 0, 0, h, h}, "VEC4", 4, 5126);
  using nlohmann::json;
  s.json["nodes"] = json::parse(R"([{"name": "body", "mesh": 0, "skin": 0},
    {"name": "hip", "children": [2]}, {"name": "knee", "translation": [0, 1, 0]}])");
  s.json["scenes"] = json::parse(R"([{"nodes": [0, 1]}])");
  s.json["skins"] = json::parse(R"([{"joints": [1, 2], "inverseBindMatrices": 4}])");
  s.json["meshes"] = json::parse(R"([{"name": "square", "primitives": [{"indices": 1,
    "attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}}]}])");
  s.json["animations"] = json::parse(R"([{"name": "bend",
    "samplers": [{"input": 5, "output": 6}],
    "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}]}])");
  return s;
}

}  // namespace geoprior::test
