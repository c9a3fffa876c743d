#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace pugi {
class xml_document;
}

namespace geoprior {

/// JSON of a stranger, not nested too deep. @throws Error  naming `name` and the byte
nlohmann::json parse_json(std::string_view text, const std::string& name);

/// XML of a stranger, not nested too deep. @throws Error  naming `name` and the byte
void parse_xml(std::string_view text, const std::string& name, pugi::xml_document& document);

}  // namespace geoprior
