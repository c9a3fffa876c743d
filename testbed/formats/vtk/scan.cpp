#include "testbed/formats/vtk/scan.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/error.h"
#include "testbed/formats/vtk/blocks.h"

namespace geoprior {
namespace {

constexpr int kDeepest = 32;  // VTK's own files: 7

/// Most values that a byte of a file stands for. zlib makes 1032 bytes of one, LZMA about 7000, and
/// the smallest value of an array is a bit, though hardly of a compressed one.
constexpr double kMostValuesAByte = 8 * 1032;

/// Most texts of an array: each takes VTK 32 bytes and more, and a zero byte of the file ends one.
constexpr std::uint64_t kMostTexts = 1U << 20;

constexpr std::string_view kSpace = " \t\r\n";

bool is_count(std::string_view attribute) {
  static constexpr std::array<std::string_view, 6> kCounts{"NumberOfPoints", "NumberOfVerts",
                                                           "NumberOfLines",  "NumberOfStrips",
                                                           "NumberOfPolys",  "NumberOfTuples"};
  return std::find(kCounts.begin(), kCounts.end(), attribute) != kCounts.end();
}

/// Attributes that say where data begin and how they are encoded.
bool is_encoding(std::string_view attribute) {
  static constexpr std::array<std::string_view, 5> kEncodings{"compressor", "byte_order",
                                                              "header_type", "format", "encoding"};
  return std::find(kEncodings.begin(), kEncodings.end(), attribute) != kEncodings.end();
}

/// VTK 9.1 follows a null pointer where an array has another type, or none.
void require_type(std::string_view type, const std::string& place) {
  static constexpr std::array<std::string_view, 12> kTypes{"Int8",    "UInt8",   "Int16",  "UInt16",
                                                           "Int32",   "UInt32",  "Int64",  "UInt64",
                                                           "Float32", "Float64", "String", "Bit"};
  if (std::find(kTypes.begin(), kTypes.end(), type) != kTypes.end()) return;
  std::string allowed;
  for (const std::string_view known : kTypes) {
    allowed += (allowed.empty() ? "" : ", ") + std::string(known);
  }
  throw Error("an array has the type '" + std::string(type.substr(0, 40)) + "'", place, allowed);
}

/// Goes through the elements. Sizes are compared as double: they need not be exact, and must not
/// wrap.
class VtkXmlScan {
 public:
  VtkXmlScan(std::string_view text, const std::string& where)
      : text_(text),
        where_(where),
        most_values_(kMostValuesAByte * static_cast<double>(text.size())) {}

  void run() {
    for (at_ = text_.find('<'); at_ < text_.size(); at_ = text_.find('<', at_)) {
      if (next_is("<!--")) {
        skip_behind("-->");
      } else if (next_is("<?")) {
        skip_behind("?>");
      } else if (next_is("<!")) {
        fail("has a document type or other declaration", "elements and comments");
      } else if (next_is("</")) {
        --depth_;
        skip_behind(">");
      } else {
        ++at_;
        if (!element()) return;
      }
    }
  }

 private:
  /// What is asked of an opening tag.
  struct Tag {
    std::string_view name, type, format, encoding;
    std::optional<std::uint64_t> offset;
    std::uint64_t tuples = 0;
  };

  [[noreturn]] void fail(const std::string& problem, const std::string& allowed = {}) const {
    throw Error(problem, place(), allowed);
  }

  [[nodiscard]] std::string place() const { return where_ + ": byte " + std::to_string(at_); }

  [[nodiscard]] bool next_is(std::string_view begin) const {
    return text_.substr(at_, begin.size()) == begin;
  }

  void skip_behind(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string_view::npos) fail("is not closed");
    at_ = found + end.size();
  }

  /// Up to the next of these characters.
  std::string_view take_until(std::string_view ends) {
    const std::size_t end = text_.find_first_of(ends, at_);
    if (end == std::string_view::npos) fail("ends within an element");
    const std::string_view taken = text_.substr(at_, end - at_);
    at_ = end;
    return taken;
  }

  void skip_space() {
    at_ = std::min(text_.find_first_not_of(kSpace, at_), text_.size());
    if (at_ == text_.size()) fail("ends within an element");
  }

  /// An opening tag behind its '<'. False at the appended data: what follows is no XML.
  bool element() {
    Tag tag;
    tag.name = take_until(" \t\r\n/>");
    if (++depth_ > kDeepest) {
      fail("has elements nested deeper than " + std::to_string(kDeepest), std::to_string(kDeepest));
    }
    if (tag.name == "Piece") largest_of_piece_ = 0;
    for (skip_space(); text_[at_] != '>' && text_[at_] != '/'; skip_space()) attribute(tag);
    const bool empty = text_[at_] == '/';
    if (empty) --depth_;
    skip_behind(">");
    if (tag.name == "DataArray" || tag.name == "Array") array(tag);
    if (tag.name != "AppendedData" || empty) return true;
    appended_data(tag);
    return false;
  }

  void attribute(Tag& tag) {
    const std::string_view name = take_until(" \t\r\n=/>");
    skip_space();
    if (name.empty() || text_[at_] != '=') fail("has an attribute without a value");
    ++at_;
    skip_space();
    const char quote = text_[at_];
    if (quote != '"' && quote != '\'') fail("has an attribute without quotes");
    ++at_;
    const std::string_view value = take_until({&quote, 1});
    if (is_encoding(name) && value.find('&') != std::string_view::npos) {
      fail(std::string(name) + " is '" + std::string(value.substr(0, 40)) + "'", "plain words");
    }
    if (depth_ == 1) encoding_attribute(name, value);
    if (name == "type") tag.type = value;
    if (name == "format") tag.format = value;
    if (name == "encoding") tag.encoding = value;
    if (name == "offset") tag.offset = number(name, value);
    if (name == "NumberOfTuples") tag.tuples = number(name, value);
    if (is_count(name)) declare(name, static_cast<double>(number(name, value)));
    if (name == "NumberOfComponents") {
      require_values(name,
                     static_cast<double>(number(name, value)) * std::max(largest_of_piece_, 1.0));
    }
    if (name == "WholeExtent" || name == "Extent") declare(name, points_of_extent(name, value));
    ++at_;
  }

  void encoding_attribute(std::string_view name, std::string_view value) {
    if (name == "compressor") encoding_.compressed = !value.empty();
    if (name == "byte_order") encoding_.big_endian = value == "BigEndian";
    if (name == "header_type") encoding_.word_bytes = value == "UInt64" ? 8 : 4;
  }

  /// An array behind its tag.
  void array(const Tag& tag) {
    require_type(tag.type, place());
    if (tag.type == "String" && tag.tuples > kMostTexts) {
      fail("an array has " + std::to_string(tag.tuples) + " texts",
           "at most " + std::to_string(kMostTexts));
    }
    if (!encoding_.compressed) return;
    if (tag.offset) {  // whatever the format says: VTK looks for this alone
      appended_.push_back(*tag.offset);
    } else if (tag.format == "binary") {
      const std::size_t begin = std::min(text_.find_first_not_of(kSpace, at_), text_.size());
      check_blocks(begin, true);
    }
  }

  /// The data behind its tag: all arrays that lie in it.
  void appended_data(const Tag& tag) const {
    const std::size_t begin = text_.find('_', at_);
    if (begin == std::string_view::npos) return;
    for (const std::uint64_t offset : appended_) {
      if (offset >= text_.size() - begin) {
        fail("an array is at byte " + std::to_string(offset) + " of the appended data",
             "up to the end of the file");
      }
      check_blocks(begin + 1 + offset, tag.encoding != "raw");
    }
  }

  void check_blocks(std::size_t at, bool is_base64) const {
    check_block_header(text_.substr(at), is_base64, encoding_, 8 * most_values_, text_.size(),
                       where_ + ": byte " + std::to_string(at));
  }

  std::uint64_t number(std::string_view name, std::string_view text) const {
    std::uint64_t value = 0;
    const auto [end, code] = std::from_chars(text.begin(), text.end(), value);
    if (code != std::errc() || end != text.end()) {
      fail(std::string(name) + " is '" + std::string(text.substr(0, 40)) + "'", "a whole number");
    }
    return value;
  }

  double points_of_extent(std::string_view name, std::string_view text) const {
    double points = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const auto from = next_coordinate(name, text), to = next_coordinate(name, text);
      if (to < from) fail(std::string(name) + " ends before it begins");
      points *= static_cast<double>(to) - static_cast<double>(from) + 1;
    }
    if (text.find_first_not_of(kSpace) != std::string_view::npos) {
      fail(std::string(name) + " has more than six numbers");
    }
    return points;
  }

  /// Takes a number off the front of the text.
  std::int32_t next_coordinate(std::string_view name, std::string_view& text) const {
    text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
    std::int32_t value = 0;
    const auto [end, code] = std::from_chars(text.begin(), text.end(), value);
    if (code != std::errc()) fail(std::string(name) + " has no six whole numbers of 32 bits");
    text.remove_prefix(end - text.begin());
    return value;
  }

  void declare(std::string_view name, double count) {
    largest_of_piece_ = std::max(largest_of_piece_, count);
    declared_ += count;
    require_values(name, declared_);
  }

  void require_values(std::string_view name, double values) const {
    if (values <= most_values_) return;
    fail(std::string(name) + " declares more than " + std::to_string(text_.size()) +
         " bytes can hold");
  }

  std::string_view text_;
  const std::string& where_;
  double most_values_;
  std::size_t at_ = 0;
  int depth_ = 0;
  VtkEncoding encoding_;
  std::vector<std::uint64_t> appended_;  ///< offsets of compressed arrays
  double largest_of_piece_ = 0;          ///< points or cells, whatever is more
  double declared_ = 0;                  ///< points, cells and tuples of all pieces
};

}  // namespace

void check_vtk_xml(std::string_view text, const std::string& where) {
  const std::string_view head = text.substr(0, std::min(text.find("<AppendedData"), text.size()));
  if (const std::size_t zero = head.find('\0'); zero != std::string_view::npos) {
    throw Error("is no XML in UTF-8", where + ": byte " + std::to_string(zero));
  }
  VtkXmlScan(text, where).run();
}

}  // namespace geoprior
