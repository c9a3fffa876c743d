#include "testbed/formats/mesh/obj_reader.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/error.h"
#include "testbed/formats/mesh/polygon_soup.h"
#include "testbed/formats/text/lines.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior {
namespace {

/// An index from 0. Positive ones may name something that comes later.
int index_from_zero(std::string_view word, std::size_t so_far, const char* what,
                    const TextLines& lines) {
  const long long index = lines.integer(word);
  const auto count = static_cast<long long>(so_far);
  if (index == 0 || index < -count || index > std::numeric_limits<int>::max()) {
    throw Error(std::string("refers to ") + what + " " + std::to_string(index) + " of " +
                    std::to_string(count),
                lines.place(), "1 and up, or -1 and down");
  }
  return static_cast<int>(index > 0 ? index - 1 : count + index);
}

/// Texture coordinates, and which of them the corners have; none of what is not the same at every
/// corner of a vertex.
class Texture {
 public:
  void add(double s, double t) { coordinates_.emplace_back(s, t); }
  /// A corner "v", "v/vt", "v//vn" or "v/vt/vn" of a vertex.
  void corner(std::string_view word, int vertex, const TextLines& lines) {
    const std::size_t first = word.find('/');
    const std::string_view text =
        first == word.npos ? "" : word.substr(first + 1, word.find('/', first + 1) - first - 1);
    if (text.empty()) {
      whole_ = false;
      return;
    }
    const int index = index_from_zero(text, coordinates_.size(), "texture coordinate", lines);
    const std::size_t v = vertex;
    if (of_vertex_.size() <= v) of_vertex_.resize(v + 1, -1);
    if (of_vertex_[v] >= 0 && of_vertex_[v] != index) whole_ = false;
    of_vertex_[v] = index;
  }
  [[nodiscard]] Eigen::MatrixX2d rows(Eigen::Index vertices) const {
    Eigen::MatrixX2d rows(vertices, 2);
    if (!whole_ || std::ssize(of_vertex_) != vertices) return {};
    for (Eigen::Index v = 0; v < vertices; ++v) {
      const int index = of_vertex_[v];
      if (index < 0 || index >= std::ssize(coordinates_)) return {};
      rows.row(v) = coordinates_[index];
    }
    return rows;
  }

 private:
  std::vector<Eigen::RowVector2d> coordinates_;
  std::vector<int> of_vertex_;
  bool whole_ = true;
};

/// Statements that are neither `v`, `vt` nor `f`.
class OtherStatements {
 public:
  void add(std::string_view word, const TextLines& lines) {
    if (is_one_of(word, kNoShape)) return;
    const auto found = first_.find(word);
    if (found != first_.end()) {
      ++found->second.count;
    } else if (first_.size() < kMostWords) {
      first_.emplace(word, First{1, lines.number()});
    } else {
      more_words_ = true;
    }
  }
  [[nodiscard]] std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    for (const auto& [word, first] : first_) {
      const std::string lines = std::to_string(first.count) +
                                (first.count == 1 ? " line" : " lines") + " '" +
                                word.substr(0, 40) + "' left out (the first is line " +
                                std::to_string(first.line) + "): ";
      notes.push_back(lines + (is_one_of(word, kOtherShapes) ? "the surface is made of faces alone"
                                                             : "OBJ has no such statement"));
    }
    if (more_words_) notes.emplace_back("lines of further words that OBJ has not are left out");
    return notes;
  }

 private:
  struct First {
    int count;
    int line;
  };
  static constexpr std::size_t kMostWords = 8;
  /// Names, groups, looks, and what belongs to the curves and surfaces below.
  static constexpr std::array<std::string_view, 31> kNoShape{
      "vt",     "vn",     "vp",     "g",        "o",        "s",          "mg",       "usemtl",
      "mtllib", "usemap", "maplib", "lod",      "bevel",    "deg",        "bmat",     "step",
      "parm",   "trim",   "hole",   "scrv",     "sp",       "end",        "con",      "ctech",
      "stech",  "csh",    "cstype", "c_interp", "d_interp", "shadow_obj", "trace_obj"};
  static constexpr std::array<std::string_view, 6> kOtherShapes{"p",     "l",    "curv",
                                                                "curv2", "surf", "call"};

  template <std::size_t n>
  static bool is_one_of(std::string_view word, const std::array<std::string_view, n>& words) {
    return std::find(words.begin(), words.end(), word) != words.end();
  }

  std::map<std::string, First, std::less<>> first_;  ///< by word
  bool more_words_ = false;
};

void read_face(const TextLines& lines, PolygonSoup& soup, Texture& texture) {
  lines.require_words(4, "f and three corners or more");
  const auto& words = lines.words();
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string_view vertex = words[i].substr(0, words[i].find('/'));
    soup.corners.push_back(index_from_zero(vertex, soup.points.size(), "vertex", lines));
    texture.corner(words[i], soup.corners.back(), lines);
  }
  soup.end_face();
}

}  // namespace

MeshFile parse_obj(std::string_view bytes, const std::string& name) {
  const std::string text = plain_text(std::string(bytes), name);
  PolygonSoup soup;
  Texture texture;
  OtherStatements others;
  TextLines lines(text, name);
  while (lines.next_with_words_continued()) {
    const auto& words = lines.words();
    if (words[0] == "v") {
      lines.require_words(4, "v x y z");
      soup.points.emplace_back(lines.number_at(1), lines.number_at(2), lines.number_at(3));
    } else if (words[0] == "vt" && words.size() >= 3) {
      texture.add(lines.number_at(1), lines.number_at(2));
    } else if (words[0] == "f" || words[0] == "fo") {
      read_face(lines, soup, texture);
    } else {
      others.add(words[0], lines);
    }
  }
  MeshFile file = mesh_of(soup, name);
  file.pattern = texture.rows(file.mesh.V.rows());
  file.notes = others.notes();
  return file;
}

}  // namespace geoprior
