#include "testbed/formats/mesh/off_reader.h"

#include <limits>

#include "core/error.h"
#include "testbed/formats/mesh/polygon_soup.h"
#include "testbed/formats/text/lines.h"

namespace geoprior {
namespace {

struct OffCounts {
  long long vertices = 0, faces = 0;
};

/// "OFF" with its prefixes (C: colours, N: normals, ST: texture) on a line of its own or before the
/// counts, or no such word at all.
OffCounts read_counts(TextLines& lines, const std::string& name) {
  if (!lines.next_with_words()) throw Error("is empty", name);
  std::size_t at = 0;
  if (lines.words()[0].ends_with("OFF")) {
    const std::string_view kind = lines.words()[0];
    if (kind.find_first_of("4n") != std::string_view::npos ||
        (lines.words().size() > 1 && lines.words()[1] == "BINARY")) {
      throw Error("is OFF of another kind: " + std::string(lines.line()), lines.place(),
                  "ascii, three coordinates: OFF, COFF, NOFF, CNOFF, STOFF");
    }
    at = 1;
    if (lines.words().size() == 1) {
      if (!lines.next_with_words()) throw Error("is truncated: no counts", name);
      at = 0;
    }
  }
  lines.require_words(at + 2, "vertices and faces");
  const OffCounts counts{lines.integer_at(at), lines.integer_at(at + 1)};
  constexpr long long kMost = std::numeric_limits<int>::max();
  if (counts.vertices < 0 || counts.vertices > kMost || counts.faces < 0 || counts.faces > kMost) {
    throw Error("has an impossible count", lines.place(), "0 to " + std::to_string(kMost));
  }
  return counts;
}

void next_or_truncated(TextLines& lines, const std::string& what, long long i, long long of,
                       const std::string& name) {
  if (lines.next_with_words()) return;
  throw Error(
      "is truncated: ends before " + what + " " + std::to_string(i) + " of " + std::to_string(of),
      name + ":" + std::to_string(lines.number()));
}

}  // namespace

MeshFile parse_off(std::string_view bytes, const std::string& name) {
  TextLines lines(bytes, name);
  const OffCounts counts = read_counts(lines, name);
  PolygonSoup soup;
  for (long long i = 0; i < counts.vertices; ++i) {
    next_or_truncated(lines, "vertex", i, counts.vertices, name);
    lines.require_words(3, "x y z");
    soup.points.emplace_back(lines.number_at(0), lines.number_at(1), lines.number_at(2));
  }
  for (long long i = 0; i < counts.faces; ++i) {
    next_or_truncated(lines, "face", i, counts.faces, name);
    const long long corners = lines.integer_at(0);
    if (corners < 3 || corners > static_cast<long long>(PolygonSoup::kMostCorners)) {
      throw Error("a face has " + std::to_string(corners) + " corners", lines.place(),
                  "3 to " + std::to_string(PolygonSoup::kMostCorners));
    }
    lines.require_words(static_cast<std::size_t>(corners) + 1, "count and corners");
    for (long long k = 1; k <= corners; ++k) {
      const long long v = lines.integer_at(k);
      if (v < 0 || v >= counts.vertices) {
        throw Error("refers to vertex " + std::to_string(v), lines.place(),
                    "0 to " + std::to_string(counts.vertices - 1));
      }
      soup.corners.push_back(static_cast<int>(v));
    }
    soup.end_face();
  }
  return mesh_of(soup, name);
}

}  // namespace geoprior
