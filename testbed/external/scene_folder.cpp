#include "testbed/external/scene_folder.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/external/frame_layout.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/formats/gltf/writer.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/runner/journal/frame_files.h"
#include "testbed/runner/journal/frame_table.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/names.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "arrays are written as little endian");

constexpr int kSceneSchema = 1;
constexpr std::uintmax_t kLargestCopy = std::uintmax_t{1} << 30;  ///< of an input; larger: its path

template <class T, class Rows>
std::string npy_bytes(const Rows& rows, const char* type) {
  std::string head = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (" +
                     std::to_string(rows.rows()) + ", " + std::to_string(rows.cols()) + "), }";
  // Magic, version, length and text fill a multiple of 64 bytes.
  constexpr std::size_t kBefore = 10, kMultiple = 64;
  while ((kBefore + head.size() + 1) % kMultiple != 0) head += ' ';
  head += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  const auto length = static_cast<std::uint16_t>(head.size());
  bytes.append(reinterpret_cast<const char*>(&length), sizeof length);
  bytes += head;
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    for (Eigen::Index c = 0; c < rows.cols(); ++c) {
      const T value = rows(r, c);
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  }
  return bytes;
}

/// Writes files below a folder and says their names relative to it.
class SceneWriter {
 public:
  explicit SceneWriter(fs::path folder) : folder_(std::move(folder)) {
    for (const char* room : {"scene", "inputs", "out"}) make_folders(folder_ / room);
  }

  Json part(const std::string& name, const Part& part) const {
    require_name(name, "a part", "scene");
    Json json{{"kind", kind_name(part.kind)}};
    json["file"] = put(name + part_extension(part), part_to_vtk_xml(part, 0));
    if (part.kind != Part::Kind::grid) {
      json["points"] = put(name + ".points.npy", npy_text(Eigen::MatrixXd(part.points)));
    }
    if (part.kind == Part::Kind::triangles && part.triangles.rows() > 0) {
      json["triangles"] = put(name + ".triangles.npy", npy_text(Eigen::MatrixXi(part.triangles)));
      json["gltf"] = put(name + ".glb", surface_glb({part.points, part.triangles}, name));
    }
    json["arrays"] = Json::object();
    for (const NamedArray& array : part.arrays) {
      json["arrays"][array.name] = {
          {"file", put(name + "." + name_from(array.name) + ".npy", npy_text(array.values))},
          {"on", array.on == NamedArray::On::points ? "points" : "cells"},
          {"unit", array.unit},
          {"names", array.names}};
    }
    return json;
  }
  Json table(const std::string& name, const FrameTable& table) const {
    require_name(name, "a table", "scene");
    Json json{{"columns", table.columns}};
    json["file"] = put(name + ".csv", table_to_csv(table));
    json["rows"] = put(name + ".npy", npy_text(table.rows));
    return json;
  }
  Json input(const fs::path& file, std::size_t number) const {
    std::error_code ignored;
    Json json{{"name", file.filename().string()}, {"sha256", sha256_of_file(file)}};
    if (fs::file_size(file, ignored) > kLargestCopy || ignored) {
      json["file"] = fs::absolute(file).string();
      return json;
    }
    const fs::path copy =
        fs::path("inputs") / (std::to_string(number) + "-" + name_from(file.filename().string()));
    write_file_atomically(folder_ / copy, read_whole_file(file));
    json["file"] = copy.string();
    return json;
  }

 private:
  [[nodiscard]] std::string put(const std::string& name, const std::string& bytes) const {
    const fs::path file = fs::path("scene") / name;
    write_file_atomically(folder_ / file, bytes);
    return file.string();
  }

  fs::path folder_;
};

Json shape_json(const Scene& scene) {
  Json shapes = Json::array();
  for (const PartShape& shape : scene.frame_shape()) {
    Json json{{"part", shape.part}, {"kind", kind_name(shape.kind)}};
    json["vertices"] = shape.vertices ? Json(*shape.vertices) : Json(nullptr);
    shapes.push_back(std::move(json));
  }
  return shapes;
}

}  // namespace

std::string npy_text(const Eigen::MatrixXd& rows) { return npy_bytes<double>(rows, "<f8"); }
std::string npy_text(const Eigen::MatrixXi& rows) { return npy_bytes<std::int32_t>(rows, "<i4"); }

void write_scene_folder(const fs::path& folder, const MethodSite& site, const Scene& scene) {
  const SceneWriter writer(folder);
  const Frame given = scene.given();
  Json json{{"schema", kSceneSchema}, {"topic", site.topic},     {"experiment", site.experiment_id},
            {"case", site.case_name}, {"variant", site.variant}, {"seed", site.seed}};
  json["parameter"] = {{"name", scene.parameter_name()},
                       {"unit", scene.parameter_unit()},
                       {"values", scene.parameters()}};
  json["scene"] = Json::parse(site.scene_json);
  json["facts"] = scene.facts();
  json["parts"] = Json::object();
  for (const auto& [name, part] : given.parts) json["parts"][name] = writer.part(name, part);
  json["tables"] = Json::object();
  for (const auto& [name, table] : given.tables) json["tables"][name] = writer.table(name, table);
  json["inputs"] = Json::array();
  for (const fs::path& file : scene.inputs()) {
    json["inputs"].push_back(writer.input(file, json["inputs"].size()));
  }
  json["frames"] = {{"folder", "out"}, {"parts", shape_json(scene)}};
  json["reference"] = nullptr;
  if (site.reference != nullptr) {
    write_layout(folder / "reference", *site.reference, LayoutParts::as_recorded,
                 [&](const StoredFile& stored) { return site.files->bytes(stored); });
    json["reference"] = {{"variant", site.reference->name}, {"folder", "reference"}};
  }
  write_file_atomically(folder / "scene.json", json.dump(1) + "\n");
}

}  // namespace geoprior
