#include "testbed/formats/mesh/ply_header.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "testbed/formats/text/lines.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior {
namespace {

using Type = PlyHeader::Type;

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr std::array<TypeName, 16> kTypes{{{"char", Type::int8},
                                           {"int8", Type::int8},
                                           {"uchar", Type::uint8},
                                           {"uint8", Type::uint8},
                                           {"short", Type::int16},
                                           {"int16", Type::int16},
                                           {"ushort", Type::uint16},
                                           {"uint16", Type::uint16},
                                           {"int", Type::int32},
                                           {"int32", Type::int32},
                                           {"uint", Type::uint32},
                                           {"uint32", Type::uint32},
                                           {"float", Type::float32},
                                           {"float32", Type::float32},
                                           {"double", Type::float64},
                                           {"float64", Type::float64}}};

Type type_of(std::string_view word, const std::string& place) {
  const auto found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const TypeName& t) { return t.name == word; });
  if (found == kTypes.end()) {
    throw Error("has the unknown type '" + std::string(word) + "'", place,
                "char, uchar, short, ushort, int, uint, float, double");
  }
  return found->type;
}

PlyHeader::Format format_of(const TextLines& lines) {
  lines.require_words(2, "format and its name");
  const std::string_view word = lines.words()[1];
  if (word == "ascii") return PlyHeader::Format::ascii;
  if (word == "binary_little_endian") return PlyHeader::Format::little_endian;
  if (word == "binary_big_endian") return PlyHeader::Format::big_endian;
  throw Error("has the unknown format '" + std::string(word) + "'", lines.place(),
              "ascii, binary_little_endian, binary_big_endian");
}

PlyHeader::Element element_of(const TextLines& lines) {
  lines.require_words(3, "element, its name and count");
  const long long count = lines.integer_at(2);
  if (count < 0 || count > std::numeric_limits<int>::max()) {
    throw Error("has an impossible count", lines.place(),
                "0 to " + std::to_string(std::numeric_limits<int>::max()));
  }
  return {std::string(lines.words()[1]), count, {}};
}

PlyHeader::Property property_of(const TextLines& lines) {
  lines.require_words(3, "property, type and name");
  const auto& words = lines.words();
  if (words[1] != "list") return {std::string(words[2]), type_of(words[1], lines.place()), {}};
  lines.require_words(5, "property list, type of the length, type of the items, name");
  return {std::string(words[4]), type_of(words[3], lines.place()),
          type_of(words[2], lines.place())};
}

/// Bytes up to the end of the line `end_header`, all of them when there is no such line. Data of
/// any bytes follow: a \n behind a \r is one of them where the first line ends in \r alone.
std::size_t head_size(std::string_view bytes) {
  constexpr std::string_view kLast = "end_header";
  const std::size_t first_end = bytes.find_first_of("\r\n");
  const std::string_view first_ends = bytes.substr(std::min(first_end, bytes.size()), 2);
  const bool returns_alone = first_ends.starts_with('\r') && first_ends != "\r\n";
  for (std::size_t at = bytes.find(kLast); at < bytes.size(); at = bytes.find(kLast, at + 1)) {
    if (at > 0 && bytes[at - 1] != '\n' && bytes[at - 1] != '\r') continue;
    const std::size_t end = bytes.find_first_not_of(" \t", at + kLast.size());
    if (end == std::string_view::npos) return bytes.size();
    if (bytes[end] == '\n') return end + 1;
    if (bytes[end] == '\r') return end + (!returns_alone && bytes.substr(end, 2) == "\r\n" ? 2 : 1);
  }
  return bytes.size();
}

}  // namespace

std::size_t size_of(PlyHeader::Type type) {
  constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::optional<std::size_t> PlyHeader::Element::find(
    std::initializer_list<std::string_view> names) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (std::find(names.begin(), names.end(), properties[i].name) != names.end()) return i;
  }
  return std::nullopt;
}

std::size_t PlyHeader::Element::least_bytes() const {
  std::size_t bytes = 0;
  for (const Property& p : properties) bytes += size_of(p.count.value_or(p.type));
  return bytes;
}

const PlyHeader::Element* PlyHeader::element(std::string_view name) const {
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const Element& e) { return e.name == name; });
  return found == elements.end() ? nullptr : &*found;
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& name) {
  const std::string_view marked = without_byte_order_mark(bytes, name);
  PlyHeader header;
  header.data = bytes.size() - marked.size() + head_size(marked);
  const std::string head = plain_text(std::string(marked.substr(0, head_size(marked))), name);
  TextLines lines(head, name);
  if (!lines.next() || lines.line() != "ply") throw Error("is no PLY file", name);
  bool has_format = false;
  while (lines.next_with_words()) {
    const std::string_view keyword = lines.words()[0];
    if (keyword == "end_header") {
      if (!has_format) throw Error("has no format", lines.place());
      header.data_line = lines.number() + 1;
      return header;
    }
    if (keyword == "format") {
      header.format = format_of(lines);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(element_of(lines));
    } else if (keyword == "property") {
      if (header.elements.empty()) throw Error("property before any element", lines.place());
      header.elements.back().properties.push_back(property_of(lines));
    } else if (keyword != "comment" && keyword != "obj_info") {
      throw Error("has the unknown word '" + std::string(keyword.substr(0, 40)) + "'",
                  lines.place(), "format, comment, obj_info, element, property, end_header");
    }
  }
  throw Error("is truncated: the header has no end", name + ":" + std::to_string(lines.number()));
}

}  // namespace geoprior
