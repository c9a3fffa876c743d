#include "testbed/formats/mesh/off_reader.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "core/error.h"
#include "testbed/formats/mesh/polygon_soup.h"
#include "testbed/formats/text/lines.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior {
namespace {

/// The words of a text and the lines that they stand on; comments and empty lines are gone.
class OffWords {
 public:
  OffWords(std::string_view text, const std::string& name) : name_(name) {
    TextLines lines(text, name);
    while (lines.next_with_words()) {
      words_.insert(words_.end(), lines.words().begin(), lines.words().end());
      lines_.push_back({words_.size(), lines.number()});
    }
    last_line_ = lines.number();
  }

  [[nodiscard]] std::size_t size() const { return words_.size(); }
  [[nodiscard]] std::size_t line_count() const { return lines_.size(); }
  [[nodiscard]] std::string_view word(std::size_t at) const { return words_[at]; }
  /// The line that a word stands on, from 0.
  [[nodiscard]] std::size_t line_of(std::size_t word) const {
    std::size_t low = 0, high = lines_.size();
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      (lines_[middle].end <= word ? low : high) = lines_[middle].end <= word ? middle + 1 : middle;
    }
    return low;
  }
  /// Just past the last word of a line.
  [[nodiscard]] std::size_t end_of(std::size_t line) const { return lines_[line].end; }
  /// "file:line" of a word, of the last line behind the last one.
  [[nodiscard]] std::string place(std::size_t word) const {
    const int line = word < size() ? lines_[line_of(word)].number : last_line_;
    return name_ + ":" + std::to_string(line);
  }
  [[nodiscard]] double number(std::size_t at) const {
    if (const auto x = finite_number(words_[at])) return *x;
    throw no_finite_number(words_[at], place(at));
  }
  [[nodiscard]] long long integer(std::size_t at) const {
    if (const auto x = whole_number(words_[at])) return *x;
    throw no_whole_number(words_[at], place(at));
  }

 private:
  struct Line {
    std::size_t end;
    int number;
  };
  const std::string& name_;
  std::vector<std::string_view> words_;
  std::vector<Line> lines_;
  int last_line_ = 0;
};

struct OffHead {
  long long vertices = 0, faces = 0;
  std::size_t words_a_vertex = 3;  ///< where lines do not say it
  bool has_colours = false;        ///< of four words, or of three
  std::size_t data = 0;            ///< first word behind the counts
};

struct OffPrefix {
  std::string_view text;
  std::size_t words;  ///< a vertex
};
/// Texture, normals, colours.
constexpr std::array<OffPrefix, 3> kPrefixes{{{"ST", 2}, {"N", 3}, {"C", 0}}};

/// What the word before the counts says ("STCNOFF", in any order); a number that is glued to it, as
/// in ModelNet, is the first count.
std::string_view read_kind(const OffWords& words, OffHead& head) {
  const std::string_view word = words.word(0);
  const std::size_t off = word.find("OFF");
  if (off == std::string_view::npos) return {};
  std::string_view kind = word.substr(0, off);
  const std::string_view glued = word.substr(off + 3);
  for (bool known = true; known && !kind.empty();) {
    known = false;
    for (const OffPrefix& prefix : kPrefixes) {
      if (!kind.starts_with(prefix.text)) continue;
      kind.remove_prefix(prefix.text.size());
      head.words_a_vertex += prefix.words;
      head.has_colours = head.has_colours || prefix.text == "C";
      known = true;
    }
  }
  const bool binary = words.size() > 1 && words.word(1) == "BINARY";
  if (!kind.empty() || binary || (!glued.empty() && !whole_number(glued))) {
    throw Error(
        "is OFF of another kind: " + std::string(word.substr(0, 40)) + (binary ? " BINARY" : ""),
        words.place(0), "ascii, three coordinates: OFF, COFF, NOFF, CNOFF, STOFF");
  }
  head.data = 1;
  return glued;
}

/// Vertices, faces and, if it is there, the number of edges, which nobody needs.
OffHead read_head(const OffWords& words, const std::string& name) {
  if (words.size() == 0) throw Error("is empty", name);
  OffHead head;
  const std::string_view glued = read_kind(words, head);
  std::vector<long long> counts;
  if (!glued.empty()) counts.push_back(*whole_number(glued));
  while (counts.size() < 2) {
    if (head.data == words.size()) throw Error("is truncated: no counts", name);
    counts.push_back(words.integer(head.data++));
  }
  constexpr long long kMost = std::numeric_limits<int>::max();
  for (const long long count : counts) {
    if (count >= 0 && count <= kMost) continue;
    throw Error("has an impossible count", words.place(head.data - 1),
                "0 to " + std::to_string(kMost));
  }
  head.vertices = counts[0];
  head.faces = counts[1];
  if (head.data == words.size()) return head;
  const std::size_t line = words.line_of(head.data);
  const bool same_line = line == words.line_of(head.data - 1);
  const bool alone = words.end_of(line) == head.data + 1;
  if ((same_line || alone) && whole_number(words.word(head.data)).value_or(-1) >= 0) ++head.data;
  return head;
}

/// Reads vertices and faces in one of the layouts in which they are found.
class OffBody {
 public:
  OffBody(const OffWords& words, const OffHead& head) : words_(words), head_(head) {}

  /// Whether each vertex and each face has a line of its own.
  [[nodiscard]] bool has_lines() const {
    const auto wanted = static_cast<std::size_t>(head_.vertices + head_.faces);
    if (wanted == 0) return true;
    if (!begins_line(head_.data)) return false;
    const std::size_t first = words_.line_of(head_.data);
    if (words_.line_count() - first < wanted) return false;
    for (std::size_t i = 0; i < wanted; ++i) {
      const std::size_t begin = first + i == 0 ? 0 : words_.end_of(first + i - 1);
      std::size_t needed = 3;
      if (i >= static_cast<std::size_t>(head_.vertices)) {
        const auto corners = whole_number(words_.word(begin));
        if (!corners || *corners < 0) return false;
        needed = 1 + static_cast<std::size_t>(*corners);
      }
      if (words_.end_of(first + i) - begin < needed) return false;
    }
    return true;
  }

  /// A line each: what follows on it (colours, normals) is passed over.
  PolygonSoup by_lines() {
    at_ = head_.data;
    for (long long i = 0; i < head_.vertices; ++i) {
      vertex(i);
      to_line_end();
    }
    for (long long i = 0; i < head_.faces; ++i) {
      face(i);
      to_line_end();
    }
    return std::move(soup_);
  }

  /// Any line breaks, `words_a_vertex` of each vertex; nothing follows the corners of a face, or
  /// what does ends with its line.
  PolygonSoup freely(std::size_t words_a_vertex, bool faces_end_lines) {
    at_ = head_.data;
    soup_ = {};
    for (long long i = 0; i < head_.vertices; ++i) {
      vertex(i);
      at_ = std::min(at_ + words_a_vertex - 3, words_.size());
    }
    for (long long i = 0; i < head_.faces; ++i) {
      if (faces_end_lines && !begins_line(at_)) {
        throw Error("a face begins within a line", words_.place(at_), "a face a line");
      }
      face(i);
      if (faces_end_lines) to_line_end();
    }
    if (at_ < words_.size()) {
      throw Error("has more words than its counts need: from '" +
                      std::string(words_.word(at_).substr(0, 40)) + "' on",
                  words_.place(at_), "as many vertices and faces as its first numbers say");
    }
    return std::move(soup_);
  }

  /// Lines with words behind the last face.
  [[nodiscard]] std::size_t lines_left() const {
    return at_ == words_.size() ? 0 : words_.line_count() - words_.line_of(at_);
  }

 private:
  [[nodiscard]] bool begins_line(std::size_t word) const {
    return word == 0 || word == words_.size() || words_.line_of(word) != words_.line_of(word - 1);
  }

  void to_line_end() {
    if (!begins_line(at_)) at_ = words_.end_of(words_.line_of(at_));
  }

  void require_words(std::size_t count, const char* what, long long i, long long of) const {
    if (words_.size() - at_ >= count) return;
    throw Error(std::string("is truncated: ends before or in ") + what + " " + std::to_string(i) +
                    " of " + std::to_string(of),
                words_.place(words_.size()));
  }

  void vertex(long long i) {
    require_words(3, "vertex", i, head_.vertices);
    soup_.points.emplace_back(words_.number(at_), words_.number(at_ + 1), words_.number(at_ + 2));
    at_ += 3;
  }

  void face(long long i) {
    require_words(1, "face", i, head_.faces);
    const long long corners = words_.integer(at_);
    if (corners < 3 || corners > static_cast<long long>(PolygonSoup::kMostCorners)) {
      throw Error("a face has " + std::to_string(corners) + " corners", words_.place(at_),
                  "3 to " + std::to_string(PolygonSoup::kMostCorners));
    }
    const auto n = static_cast<std::size_t>(corners);
    require_words(n + 1, "face", i, head_.faces);
    for (std::size_t k = at_ + 1; k <= at_ + n; ++k) {
      const long long v = words_.integer(k);
      if (v < 0 || v >= head_.vertices) {
        throw Error("refers to vertex " + std::to_string(v), words_.place(k),
                    "0 to " + std::to_string(head_.vertices - 1));
      }
      soup_.corners.push_back(static_cast<int>(v));
    }
    soup_.end_face();
    at_ += n + 1;
  }

  const OffWords& words_;
  const OffHead& head_;
  std::size_t at_ = 0;
  PolygonSoup soup_;
};

/// The first reading that uses every word; the error of the first where none does.
PolygonSoup read_freely(OffBody& body, const OffHead& head) {
  std::vector<std::size_t> sizes{head.words_a_vertex};
  if (head.has_colours) sizes = {head.words_a_vertex + 4, head.words_a_vertex + 3};
  std::optional<Error> first;
  for (const std::size_t words_a_vertex : sizes) {
    for (const bool faces_end_lines : {false, true}) {
      try {
        return body.freely(words_a_vertex, faces_end_lines);
      } catch (const Error& e) {
        if (!first) first = e;
      }
    }
  }
  throw Error(*first);
}

}  // namespace

MeshFile parse_off(std::string_view bytes, const std::string& name) {
  const std::string text = plain_text(std::string(bytes), name);
  const OffWords words(text, name);
  const OffHead head = read_head(words, name);
  OffBody body(words, head);
  const bool by_lines = body.has_lines();
  MeshFile file = mesh_of(by_lines ? body.by_lines() : read_freely(body, head), name);
  if (const std::size_t left = by_lines ? body.lines_left() : 0; left > 0) {
    file.notes.push_back(std::to_string(left) +
                         " lines behind the last face left out: more than its counts say");
  }
  return file;
}

}  // namespace geoprior
