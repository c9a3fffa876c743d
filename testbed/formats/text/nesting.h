#pragma once

#include <string>
#include <string_view>

namespace geoprior {

/// Levels that foreign text may be nested. Parsers, and what walks or frees the tree that they
/// make, take a piece of the stack for each level: deeper text is refused before it is parsed.
inline constexpr int kMostNesting = 100;

/// Brackets of JSON outside of texts. @throws Error  naming `name` and the byte
void require_shallow_json(std::string_view text, const std::string& name);

/// Brackets of TOML outside of texts and comments, and parts of a dotted key.
/// @throws Error  naming `name` and the line
void require_shallow_toml(std::string_view text, const std::string& name);

/// Elements of XML. @throws Error  naming `name` and the byte
void require_shallow_xml(std::string_view text, const std::string& name);

}  // namespace geoprior
