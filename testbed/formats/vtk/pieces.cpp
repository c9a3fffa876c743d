#include "testbed/formats/vtk/pieces.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace geoprior {
namespace {

struct TextRange {
  std::size_t begin = 0, end = 0;
};

/// Just past the '>' of the tag at `at`.
std::size_t tag_end(std::string_view text, std::size_t at) {
  for (; at < text.size() && text[at] != '>'; ++at) {
    if (text[at] == '"' || text[at] == '\'')
      at = std::min(text.find(text[at], at + 1), text.size());
  }
  return std::min(at + 1, text.size());
}

/// The elements <Piece> before the appended data.
std::vector<TextRange> piece_ranges(std::string_view text) {
  constexpr std::string_view kBegin = "<Piece", kEnd = "</Piece>";
  const std::string_view head = text.substr(0, std::min(text.find("<AppendedData"), text.size()));
  std::vector<TextRange> pieces;
  for (std::size_t at = head.find(kBegin); at < head.size(); at = head.find(kBegin, at)) {
    TextRange piece{at, tag_end(head, at)};
    if (head[piece.end - 2] != '/') {
      const std::size_t end = head.find(kEnd, piece.end);
      piece.end = end == std::string_view::npos ? head.size() : end + kEnd.size();
    }
    pieces.push_back(piece);
    at = piece.end;
  }
  return pieces;
}

/// The array of this name of a part; of another place or width none.
const NamedArray* same_array(const Part& part, const NamedArray& wanted) {
  const auto found =
      std::find_if(part.arrays.begin(), part.arrays.end(), [&](const NamedArray& array) {
        return array.name == wanted.name && array.on == wanted.on &&
               array.values.cols() == wanted.values.cols();
      });
  return found == part.arrays.end() ? nullptr : &*found;
}

/// Rows of an array of all pieces below each other; none where one of them lacks it.
std::vector<NamedArray> common_arrays(const std::vector<VtkFile>& pieces) {
  std::vector<NamedArray> common;
  for (const NamedArray& first : pieces.front().part.arrays) {
    std::vector<const NamedArray*> all;
    Eigen::Index rows = 0;
    for (const VtkFile& piece : pieces) {
      const NamedArray* array = same_array(piece.part, first);
      const bool of_surface = piece.part.kind == Part::Kind::triangles;
      if (array == nullptr || (array->on == NamedArray::On::cells && !of_surface)) break;
      all.push_back(array);
      rows += array->values.rows();
    }
    if (all.size() < pieces.size()) continue;
    NamedArray& joined = common.emplace_back(first);
    joined.values.resize(rows, first.values.cols());
    Eigen::Index at = 0;
    for (const NamedArray* array : all) {
      joined.values.middleRows(at, array->values.rows()) = array->values;
      at += array->values.rows();
    }
  }
  return common;
}

}  // namespace

std::vector<std::string> parted_by_ghosts(const std::string& text) {
  const std::vector<TextRange> pieces = piece_ranges(text);
  const auto ghosts = std::count_if(pieces.begin(), pieces.end(), [&](const TextRange& piece) {
    return std::string_view(text)
               .substr(piece.begin, piece.end - piece.begin)
               .find("vtkGhostType") != std::string_view::npos;
  });
  if (ghosts == 0 || ghosts == std::ssize(pieces)) return {};
  std::vector<std::string> parted;
  for (std::size_t kept = 0; kept < pieces.size(); ++kept) {
    std::string one;
    std::size_t at = 0;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      if (p == kept) continue;
      one.append(text, at, pieces[p].begin - at);
      at = pieces[p].end;
    }
    parted.push_back(one.append(text, at, std::string::npos));
  }
  return parted;
}

VtkFile joined_pieces(std::vector<VtkFile> pieces) {
  VtkFile all;
  all.parameter = pieces.front().parameter;
  all.part.arrays = common_arrays(pieces);
  Eigen::Index points = 0, triangles = 0;
  for (const VtkFile& piece : pieces) {
    points += piece.part.points.rows();
    triangles += piece.part.triangles.rows();
  }
  all.part.points.resize(points, 3);
  all.part.triangles.resize(triangles, 3);
  Eigen::Index v = 0, t = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const Part& part = pieces[p].part;
    all.part.points.middleRows(v, part.points.rows()) = part.points;
    all.part.triangles.middleRows(t, part.triangles.rows()) =
        part.triangles.array() + static_cast<int>(v);
    v += part.points.rows();
    t += part.triangles.rows();
    for (const std::string& note : pieces[p].notes)
      all.notes.push_back("piece " + std::to_string(p) + ": " + note);
  }
  return all;
}

}  // namespace geoprior
