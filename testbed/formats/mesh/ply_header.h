#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior {

/// What a PLY file says of itself before its data.
struct PlyHeader {
  enum class Format { ascii, little_endian, big_endian };
  enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
  struct Property {
    std::string name;
    Type type = Type::float32;  ///< of the value, or of the items of a list
    std::optional<Type> count;  ///< of a list: type of its length
  };
  struct Element {
    std::string name;
    long long count = 0;
    std::vector<Property> properties;
    /// Index of the property of one of these names.
    [[nodiscard]] std::optional<std::size_t> find(
        std::initializer_list<std::string_view> names) const;
    /// Bytes of one of them without its lists' items: at least so many follow in the file.
    [[nodiscard]] std::size_t least_bytes() const;
  };
  Format format = Format::ascii;
  std::vector<Element> elements;
  std::size_t data = 0;  ///< byte at which the data begins
  int data_line = 1;     ///< line at which it begins

  [[nodiscard]] const Element* element(std::string_view name) const;
};

std::size_t size_of(PlyHeader::Type type);

/// @throws Error  naming the line
PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

}  // namespace geoprior
