#include "testbed/formats/sequence/pvd.h"

#include <pugixml.hpp>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/text/lines.h"
#include "testbed/formats/text/nesting.h"

namespace geoprior {

std::vector<PvdDataSet> parse_pvd(std::string_view text, const std::filesystem::path& file) {
  const std::string name = file.string();
  require_shallow_xml(text, name);
  pugi::xml_document document;
  const auto result = document.load_buffer(text.data(), text.size());
  if (!result) {
    throw Error(std::string("is no valid XML: ") + result.description(),
                name + ", byte " + std::to_string(result.offset));
  }
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
    sets.push_back({*time, node.attribute("name").as_string(),
                    std::filesystem::path(relative).is_absolute() ? std::filesystem::path(relative)
                                                                  : file.parent_path() / relative});
  }
  return sets;
}

std::vector<PvdDataSet> read_pvd(const std::filesystem::path& file) {
  return parse_pvd(read_whole_file(file), file);
}

}  // namespace geoprior
