#include "testbed/formats/sequence/pvd.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "core/error.h"
#include "testbed/formats/mesh/named_files.h"
#include "testbed/formats/text/lines.h"
#include "testbed/formats/text/parsed_text.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior {

std::vector<PvdDataSet> parse_pvd(std::string_view text, const std::filesystem::path& file) {
  const std::string name = file.string();
  pugi::xml_document document;
  parse_xml(text, name, document);
  const pugi::xml_node root = document.child("VTKFile");
  const pugi::xml_node collection = root.child("Collection");
  if (!collection) throw Error("is no ParaView collection", name, "VTKFile type=\"Collection\"");
  std::vector<PvdDataSet> sets;
  for (const pugi::xml_node node : collection.children("DataSet")) {
    const std::string where = name + ", byte " + std::to_string(node.offset_debug());
    const auto time = finite_number(node.attribute("timestep").as_string("0"));
    if (!time) throw Error("timestep is no finite number", where);
    const std::string relative = node.attribute("file").as_string();
    if (relative.empty()) throw Error("DataSet without a file", where);
    sets.push_back({*time, node.attribute("name").as_string(), named_in(file, relative),
                    node.attribute("part").as_int(0)});
  }
  return sets;
}

std::vector<PvdDataSet> read_pvd(const std::filesystem::path& file) {
  return parse_pvd(read_text_file(file), file);
}

std::vector<PvdDataSet> parse_series(std::string_view text, const std::filesystem::path& file) {
  using Json = nlohmann::json;
  const std::string name = file.string();
  const Json json = parse_json(text, name);
  const char* expected = R"({"files": [{"name": "a_0.vtp", "time": 0}, …]})";
  if (!json.is_object() || !json.contains("files") || !json["files"].is_array()) {
    throw Error("is no file series: has no list \"files\"", name, expected);
  }
  std::vector<PvdDataSet> sets;
  for (const Json& entry : json["files"]) {
    const std::string where = name + ", file " + std::to_string(sets.size());
    if (!entry.is_object() || !entry.contains("name") || !entry["name"].is_string()) {
      throw Error("has no name", where, expected);
    }
    if (!entry.contains("time") || !entry["time"].is_number()) {
      throw Error("has no time", where, expected);
    }
    const auto time = entry["time"].get<double>();
    if (!std::isfinite(time)) throw Error("its time is not finite", where);
    sets.push_back({time, "", named_in(file, entry["name"].get<std::string>())});
  }
  return sets;
}

std::vector<PvdDataSet> read_series(const std::filesystem::path& file) {
  return parse_series(read_text_file(file), file);
}

}  // namespace geoprior
