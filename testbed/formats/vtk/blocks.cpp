#include "testbed/formats/vtk/blocks.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/error.h"

namespace geoprior {
namespace {

std::optional<unsigned> sextet(char c) {
  static constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t at = kAlphabet.find(c);
  if (at == std::string_view::npos) return std::nullopt;
  return at;
}

/// The first bytes of base64 text, fewer where it ends or has other characters. VTK takes padding
/// at the beginning of a group of four for a digit, and reads on.
std::string first_bytes_of_base64(std::string_view text, std::size_t count,
                                  const std::string& where) {
  std::string out;
  unsigned bits = 0, held = 0;
  for (std::size_t i = 0; i < text.size() && out.size() < count; ++i) {
    if (text[i] == '=' && i % 4 < 2) throw Error("an array is no base64", where);
    const std::optional<unsigned> value = sextet(text[i]);
    if (!value) break;
    bits = (bits << 6 | *value) & 0xFFFFFF;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    out.push_back(static_cast<char>(bits >> held & 0xFF));
  }
  return out;
}

std::vector<std::uint64_t> first_words(std::string_view data, bool is_base64,
                                       const VtkEncoding& encoding, std::size_t count,
                                       const std::string& where) {
  const std::size_t bytes_wanted = count * encoding.word_bytes;
  const std::string bytes = is_base64 ? first_bytes_of_base64(data, bytes_wanted, where)
                                      : std::string(data.substr(0, bytes_wanted));
  std::vector<std::uint64_t> words(bytes.size() / encoding.word_bytes);
  for (std::size_t w = 0; w < words.size(); ++w) {
    for (std::size_t b = 0; b < encoding.word_bytes; ++b) {
      const std::size_t place = encoding.big_endian ? b : encoding.word_bytes - 1 - b;
      words[w] = words[w] << 8 | static_cast<unsigned char>(bytes[w * encoding.word_bytes + place]);
    }
  }
  return words;
}

}  // namespace

void check_block_header(std::string_view data, bool is_base64, const VtkEncoding& encoding,
                        double most_bytes, std::size_t file_bytes, const std::string& where) {
  constexpr std::size_t kFixedWords = 3;
  std::vector<std::uint64_t> words = first_words(data, is_base64, encoding, kFixedWords, where);
  if (words.size() < kFixedWords) return;
  const std::uint64_t blocks = words[0], size = words[1], last = words[2];
  const bool fits = blocks == 0 ? last == 0 : size > 0 && last <= size;
  if (!fits) {
    throw Error("an array has " + std::to_string(blocks) + " compressed blocks of " +
                    std::to_string(size) + " bytes, the last of " + std::to_string(last),
                where, "a last one that is no longer");
  }
  const double whole_blocks = static_cast<double>(blocks) - (last > 0 ? 1 : 0);
  const double bytes = whole_blocks * static_cast<double>(size) + static_cast<double>(last);
  if (blocks > file_bytes / encoding.word_bytes || bytes > most_bytes) {
    throw Error("an array has " + std::to_string(blocks) + " compressed blocks of " +
                    std::to_string(size) + " bytes: more than " + std::to_string(file_bytes) +
                    " bytes can hold",
                where);
  }
  words = first_words(data, is_base64, encoding, kFixedWords + blocks, where);
  const auto longest = std::max_element(words.begin() + kFixedWords, words.end());
  if (longest != words.end() && *longest > file_bytes) {
    throw Error("a compressed block has " + std::to_string(*longest) + " bytes", where,
                "at most the file's " + std::to_string(file_bytes));
  }
}

}  // namespace geoprior
