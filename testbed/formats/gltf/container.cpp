#include "testbed/formats/gltf/container.h"

#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior::gltf {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67;        // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN"

std::uint32_t little_endian(const std::vector<std::byte>& bytes, std::size_t at) {
  std::uint32_t x = 0;
  for (std::size_t i = 0; i < 4; ++i) x |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
  return x;
}

std::string as_text(const std::vector<std::byte>& bytes, std::size_t begin, std::size_t size) {
  std::string text(size, '\0');
  if (size > 0) std::memcpy(text.data(), bytes.data() + begin, size);
  return text;
}

Container split_glb(const std::vector<std::byte>& bytes, const std::string& where) {
  if (bytes.size() < 20) {
    throw Error("the file ends inside the glb header, at byte " + std::to_string(bytes.size()),
                where, "at least 20 bytes");
  }
  if (const auto version = little_endian(bytes, 4); version != 2) {
    throw Error("glb version " + std::to_string(version), where, "2");
  }
  const std::size_t length = little_endian(bytes, 8);
  if (length > bytes.size()) {
    throw Error("truncated: the header announces " + std::to_string(length) +
                    " bytes and the file has " + std::to_string(bytes.size()),
                where);
  }
  Container result;
  std::size_t at = 12;
  bool has_json = false;
  while (at + 8 <= length) {
    const std::size_t size = little_endian(bytes, at);
    const std::uint32_t kind = little_endian(bytes, at + 4);
    at += 8;
    if (size > length - at) {
      throw Error("truncated: the chunk at byte " + std::to_string(at - 8) + " announces " +
                      std::to_string(size) + " bytes, " + std::to_string(length - at) + " are left",
                  where);
    }
    if (!has_json && kind != kJsonChunk) throw Error("the first chunk is not JSON", where);
    if (kind == kJsonChunk && !has_json) {
      result.json = as_text(bytes, at, size);
      has_json = true;
    } else if (kind == kBinaryChunk && !result.has_binary) {
      result.binary.assign(bytes.begin() + at, bytes.begin() + (at + size));
      result.has_binary = true;
    }
    at += size;
  }
  if (!has_json) throw Error("no JSON chunk", where);
  return result;
}

int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  if (c == '/') return 63;
  return -1;
}

std::vector<std::byte> decode_base64(std::string_view text, const std::string& where) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    const int value = base64_value(c);
    if (value < 0) throw Error("the data URI is not base64", where);
    group = (group << 6) | static_cast<std::uint32_t>(value);
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes.push_back(static_cast<std::byte>((group >> bits) & 0xFF));
    }
  }
  return bytes;
}

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string decode_percent(std::string_view uri, const std::string& where) {
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      path += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hex_value(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hex_value(uri[i + 2]) : -1;
    if (high < 0 || low < 0) throw Error("a '%' without two hex digits in the URI", where);
    path += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return path;
}

}  // namespace

Container split_container(const std::vector<std::byte>& bytes, const std::filesystem::path& file) {
  if (bytes.size() >= 4 && little_endian(bytes, 0) == kMagic) {
    return split_glb(bytes, file.string());
  }
  Container result;
  result.json = plain_text(as_text(bytes, 0, bytes.size()), file.string());
  return result;
}

std::optional<std::filesystem::path> file_of_uri(const std::string& uri,
                                                 const std::filesystem::path& file,
                                                 const std::string& where) {
  if (uri.starts_with("data:")) return std::nullopt;
  const std::filesystem::path relative = decode_percent(uri, where);
  const std::filesystem::path normal = relative.lexically_normal();
  const bool has_scheme = uri.find("://") != std::string::npos;
  const bool has_null = relative.string().find('\0') != std::string::npos;
  if (has_scheme || has_null || relative.empty() || relative.is_absolute() ||
      *normal.begin() == "..") {
    throw Error("the URI '" + uri.substr(0, 80) + "' is not a file beside this one", where,
                "a relative path below its folder, or a data URI");
  }
  const std::filesystem::path target = file.parent_path() / normal;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(target, ignored)) {
    throw Error("the buffer's file " + target.string() + " does not exist", where);
  }
  return target;
}

std::vector<std::byte> decode_data_uri(const std::string& uri, const std::string& where) {
  const std::string_view text(uri);
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || !text.substr(0, comma).ends_with(";base64")) {
    throw Error("a data URI that is not base64", where, "data:<type>;base64,<text>");
  }
  return decode_base64(text.substr(comma + 1), where);
}

std::vector<std::byte> read_bytes(const std::filesystem::path& file) {
  const std::string text = read_whole_file(file);
  std::vector<std::byte> bytes(text.size());
  if (!text.empty()) std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

}  // namespace geoprior::gltf
