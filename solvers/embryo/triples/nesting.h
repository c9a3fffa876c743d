#pragma once

#include <string>
#include <string_view>

namespace geoprior::embryo {

// Readers of RDF call themselves for what is nested, so that a file of a few kilobytes can exhaust
// their stack. These look at the brackets before a reader does, and at nothing else: what is
// malformed is left to the reader.

/// Blank nodes "[" and lists "(" of Turtle. @throws Error  with file and line, above the limit
void require_shallow_turtle(std::string_view bytes, int limit, const std::string& where);

/// Elements of XML. @throws Error  with file and line: above the limit, an entity of another file
void require_shallow_xml(std::string_view bytes, int limit, const std::string& where);

}  // namespace geoprior::embryo
