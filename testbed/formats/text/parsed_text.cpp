#include "testbed/formats/text/parsed_text.h"

#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "core/error.h"
#include "testbed/formats/text/nesting.h"

namespace geoprior {

nlohmann::json parse_json(std::string_view text, const std::string& name) {
  require_shallow_json(text, name);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& e) {
    throw Error("is no valid JSON", name + ", byte " + std::to_string(e.byte));
  } catch (const nlohmann::json::exception&) {
    throw Error("holds a number that is too large", name);
  }
}

void parse_xml(std::string_view text, const std::string& name, pugi::xml_document& document) {
  require_shallow_xml(text, name);
  const auto result = document.load_buffer(text.data(), text.size());
  if (result) return;
  throw Error(std::string("is no valid XML: ") + result.description(),
              name + ", byte " + std::to_string(result.offset));
}

}  // namespace geoprior
