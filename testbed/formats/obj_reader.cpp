#include "testbed/formats/obj_reader.h"

#include <limits>

#include "core/error.h"
#include "testbed/formats/polygon_soup.h"
#include "testbed/formats/text_lines.h"

namespace geoprior {
namespace {

/// Corner "v", "v/vt", "v//vn" or "v/vt/vn" as an index from 0. Positive ones may name a vertex
/// that comes later; `mesh_of` checks them.
int corner(std::string_view word, std::size_t vertices, const TextLines& lines) {
  const long long index = lines.integer(word.substr(0, word.find('/')));
  const auto count = static_cast<long long>(vertices);
  if (index == 0 || index < -count || index > std::numeric_limits<int>::max()) {
    throw Error("refers to vertex " + std::to_string(index) + " of " + std::to_string(count),
                lines.place(), "1 and up, or -1 and down");
  }
  return static_cast<int>(index > 0 ? index - 1 : count + index);
}

}  // namespace

MeshFile parse_obj(std::string_view bytes, const std::string& name) {
  PolygonSoup soup;
  TextLines lines(bytes, name);
  while (lines.next_with_words()) {
    const auto& words = lines.words();
    if (words.back() == "\\") throw Error("lines that go on are not read", lines.place());
    if (words[0] == "v") {
      lines.require_words(4, "v x y z");
      soup.points.emplace_back(lines.number_at(1), lines.number_at(2), lines.number_at(3));
    } else if (words[0] == "f") {
      lines.require_words(4, "f and three corners or more");
      for (std::size_t i = 1; i < words.size(); ++i) {
        soup.corners.push_back(corner(words[i], soup.points.size(), lines));
      }
      soup.end_face();
    }
  }
  return mesh_of(soup, name);
}

}  // namespace geoprior
