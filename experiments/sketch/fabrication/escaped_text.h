#pragma once

#include <string>
#include <string_view>

namespace geoprior::sketch {

/// UTF-8 bytes of code points.
std::string utf8_text(std::u32string_view text);

/// For text and attributes of XML: UTF-8 with & < > " ' as entities.
std::string xml_text(std::u32string_view text);

/// For a text value of DXF: ASCII; other characters, the backslash and what AutoCAD takes for
/// control codes (%% and ^) as \U+XXXX, those beyond the basic plane as '?'.
std::string dxf_text(std::u32string_view text);

/// A name of a block in DXF R12: capitals, digits, '-' and '_', at most 31, unique by its number.
std::string dxf_block_name(std::size_t number, std::u32string_view name);

/// A string of PDF with its parentheses in WinAnsiEncoding; '?' for what that has not.
std::string pdf_text(std::u32string_view text);

/// A text string of PDF's document information: UTF-16 in hexadecimal.
std::string pdf_utf16_text(std::u32string_view text);

}  // namespace geoprior::sketch
