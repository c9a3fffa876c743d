#include "experiments/sketch/fabrication/escaped_text.h"

namespace geoprior::sketch {
namespace {

constexpr std::string_view kHexDigits = "0123456789ABCDEF";

std::string hexadecimal(char32_t code, int digits) {
  std::string text;
  for (int i = digits - 1; i >= 0; --i) text += kHexDigits[(code >> (4 * i)) & 0xFU];
  return text;
}

void append_utf8(char32_t c, std::string& text) {
  const auto byte = [&](char32_t value) { text += static_cast<char>(value); };
  if (c < 0x80) return byte(c);
  if (c < 0x800) {
    byte(0xC0 | (c >> 6));
  } else {
    if (c < 0x10000) {
      byte(0xE0 | (c >> 12));
    } else {
      byte(0xF0 | (c >> 18));
      byte(0x80 | ((c >> 12) & 0x3F));
    }
    byte(0x80 | ((c >> 6) & 0x3F));
  }
  byte(0x80 | (c & 0x3F));
}

}  // namespace

std::string utf8_text(std::u32string_view text) {
  std::string result;
  for (const char32_t c : text) append_utf8(c, result);
  return result;
}

std::string xml_text(std::u32string_view text) {
  std::string result;
  for (const char32_t c : text) {
    switch (c) {
      case U'&':
        result += "&amp;";
        break;
      case U'<':
        result += "&lt;";
        break;
      case U'>':
        result += "&gt;";
        break;
      case U'"':
        result += "&quot;";
        break;
      case U'\'':
        result += "&apos;";
        break;
      default:
        append_utf8(c, result);
    }
  }
  return result;
}

std::string dxf_text(std::u32string_view text) {
  std::string result;
  for (const char32_t c : text) {
    if (c > 0xFFFF) {
      result += '?';
    } else if (c < 0x20 || c > 0x7E || c == U'\\' || c == U'^' || c == U'%') {
      result += "\\U+" + hexadecimal(c, 4);
    } else {
      result += static_cast<char>(c);
    }
  }
  return result;
}

std::string dxf_block_name(std::size_t number, std::u32string_view name) {
  std::string result = "P" + std::to_string(number) + "-";
  for (const char32_t c : name) {
    if (result.size() == 31) break;
    if (c >= U'a' && c <= U'z') {
      result += static_cast<char>(c - U'a' + U'A');
    } else {
      const bool plain = (c >= U'A' && c <= U'Z') || (c >= U'0' && c <= U'9') || c == U'-';
      result += plain ? static_cast<char>(c) : '_';
    }
  }
  return result;
}

std::string pdf_text(std::u32string_view text) {
  std::string result = "(";
  for (const char32_t c : text) {
    if (c == U'(' || c == U')' || c == U'\\') {
      result += '\\';
      result += static_cast<char>(c);
    } else if (c >= 0x20 && c < 0x7F) {
      result += static_cast<char>(c);
    } else if (c >= 0xA0 && c <= 0xFF) {
      // As an octal number, so that the file's text stays ASCII.
      result += '\\';
      for (const int shift : {6, 3, 0}) result += static_cast<char>('0' + ((c >> shift) & 7U));
    } else {
      result += '?';
    }
  }
  return result + ")";
}

std::string pdf_utf16_text(std::u32string_view text) {
  std::string result = "<FEFF";
  for (const char32_t c : text) {
    if (c < 0x10000) {
      result += hexadecimal(c, 4);
    } else {
      result += hexadecimal(0xD800 + ((c - 0x10000) >> 10), 4);
      result += hexadecimal(0xDC00 + ((c - 0x10000) & 0x3FF), 4);
    }
  }
  return result + ">";
}

}  // namespace geoprior::sketch
