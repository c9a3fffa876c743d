#include "testbed/formats/mesh/named_files.h"

#include <algorithm>
#include <pugixml.hpp>
#include <system_error>

#include "core/error.h"
#include "testbed/formats/text/parsed_text.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior {

namespace fs = std::filesystem;

fs::path named_in(const fs::path& file, const std::string& name) {
  const auto beside = [&](const fs::path& given) {
    return given.is_absolute() ? given : file.parent_path() / given;
  };
  const fs::path found = beside(name);
  std::error_code unknown;  // a name may be too long for the system
  if (name.find('\\') == std::string::npos || fs::exists(found, unknown)) return found;
  std::string with_slashes = name;
  std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
  return beside(with_slashes).lexically_normal();
}

std::vector<fs::path> parse_pvtp(std::string_view text, const fs::path& file) {
  const std::string name = file.string();
  pugi::xml_document document;
  parse_xml(text, name, document);
  const pugi::xml_node pieces = document.child("VTKFile").child("PPolyData");
  if (!pieces) throw Error("holds no PPolyData", name, "VTKFile type=\"PPolyData\"");
  std::vector<fs::path> files;
  for (const pugi::xml_node piece : pieces.children("Piece")) {
    const std::string source = piece.attribute("Source").as_string();
    if (source.empty()) {
      throw Error("Piece without a Source",
                  name + ", byte " + std::to_string(piece.offset_debug()));
    }
    files.push_back(named_in(file, source));
    if (files.back().extension() != ".vtp") {
      throw Error("names a piece with the extension '" + files.back().extension().string() + "'",
                  name + ", byte " + std::to_string(piece.offset_debug()), ".vtp");
    }
  }
  if (files.empty()) throw Error("names no piece", name, "<Piece Source=\"name_0.vtp\"/>");
  return files;
}

std::vector<fs::path> pvtp_pieces(const fs::path& file) {
  return parse_pvtp(read_text_file(file), file);
}

}  // namespace geoprior
