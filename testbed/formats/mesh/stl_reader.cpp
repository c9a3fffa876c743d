#include "testbed/formats/mesh/stl_reader.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "testbed/formats/text/letters.h"
#include "testbed/formats/text/lines.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read as it is");

constexpr std::size_t kHeadBytes = 84;      // 80 of text, number of triangles
constexpr std::size_t kTriangleBytes = 50;  // normal, three corners, two more bytes

std::uint32_t declared_triangles(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeadBytes - sizeof count, sizeof count);
  return count;
}

std::size_t binary_size(std::string_view bytes) {
  return kHeadBytes + kTriangleBytes * std::size_t{declared_triangles(bytes)};
}

/// Binary files may begin with "solid" too: the size tells, then whether there is text.
bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() >= kHeadBytes && binary_size(bytes) == bytes.size()) return true;
  for (const std::string_view mark : {"\xEF\xBB\xBF", "\xFF\xFE", "\xFE\xFF"}) {
    if (bytes.starts_with(mark)) return false;
  }
  std::vector<std::string_view> words;
  split_words(bytes.substr(0, std::min(bytes.find_first_of("\r\n"), bytes.size())), words);
  const bool says_solid = !words.empty() && lower(words[0]) == "solid";
  return !says_solid || bytes.substr(0, 1000).find('\0') != std::string_view::npos;
}

std::vector<Eigen::Vector3d> binary_corners(std::string_view bytes, const std::string& name,
                                            std::vector<std::string>& notes) {
  if (bytes.size() < kHeadBytes) {
    throw Error("is no STL file", name, "ascii: solid, facet, …; binary: 84 bytes and 50 a facet");
  }
  if (bytes.size() < binary_size(bytes)) {
    throw Error("is truncated: has " + std::to_string(bytes.size()) + " bytes", name,
                std::to_string(binary_size(bytes)) + " of its " +
                    std::to_string(declared_triangles(bytes)) + " triangles");
  }
  if (bytes.size() > binary_size(bytes)) {
    notes.push_back(std::to_string(bytes.size() - binary_size(bytes)) +
                    " bytes behind the last of its " + std::to_string(declared_triangles(bytes)) +
                    " triangles left out");
  }
  std::vector<Eigen::Vector3d> corners;
  corners.reserve(3 * std::size_t{declared_triangles(bytes)});
  for (std::size_t t = 0; t < declared_triangles(bytes); ++t) {
    const std::size_t normal_bytes = 3 * sizeof(float);
    for (std::size_t k = 0; k < 3; ++k) {
      Eigen::Vector3f x;
      const std::size_t at = kHeadBytes + kTriangleBytes * t + normal_bytes * (1 + k);
      std::memcpy(x.data(), bytes.data() + at, normal_bytes);
      if (!x.allFinite()) {
        throw Error("a corner of triangle " + std::to_string(t) + " is not finite",
                    name + ", byte " + std::to_string(at));
      }
      corners.push_back(x.cast<double>());
    }
  }
  return corners;
}

/// Corners between `outer loop` and `endloop`, three each; several solids are one surface.
std::vector<Eigen::Vector3d> text_corners(std::string_view text, const std::string& name,
                                          std::vector<std::string>& notes) {
  std::vector<Eigen::Vector3d> corners;
  int solids = 0;
  bool open = false;
  std::size_t loop = 0;  // its first corner
  const auto require_three = [&](const std::string& place) {
    if (corners.size() - loop == 3 || corners.size() == loop) return;
    throw Error("a facet has " + std::to_string(corners.size() - loop) + " corners", place,
                "three lines 'vertex x y z'");
  };
  TextLines lines(text, name);
  while (lines.next_with_words()) {
    const std::string word = lower(lines.words()[0].substr(0, 40));
    if (word == "vertex") {
      lines.require_words(4, "vertex x y z");
      corners.emplace_back(lines.number_at(1), lines.number_at(2), lines.number_at(3));
    } else if (word == "solid") {
      open = true;
      ++solids;
    } else if (word == "endsolid" || word == "end") {
      open = false;
    } else if (word == "endloop" || word == "outer") {
      require_three(lines.place());
      loop = corners.size();
    } else if (word != "facet" && word != "endfacet" && word != "color") {
      throw Error("has the unknown word '" + word + "'", lines.place(),
                  "solid, facet, outer loop, vertex, endloop, endfacet, endsolid");
    }
  }
  if (open) {
    throw Error("is truncated: ends before 'endsolid'",
                name + ":" + std::to_string(lines.number()));
  }
  require_three(name);
  if (solids > 1) {
    notes.push_back("its " + std::to_string(solids) + " solids are read as one surface");
  }
  return corners;
}

}  // namespace

MeshFile parse_stl(std::string_view bytes, const std::string& name) {
  MeshFile file;
  std::vector<Eigen::Vector3d> corners;
  if (is_binary_stl(bytes)) {
    corners = binary_corners(bytes, name, file.notes);
  } else {
    corners = text_corners(plain_text(std::string(bytes), name), name, file.notes);
  }
  if (corners.size() > std::numeric_limits<int>::max()) {
    throw Error("has too many triangles", name, "at most 700 million");
  }
  TriMesh split;
  split.V.resize(std::ssize(corners), 3);
  split.F.resize(std::ssize(corners) / 3, 3);
  for (Eigen::Index i = 0; i < split.V.rows(); ++i) {
    split.V.row(i) = corners[i].transpose();
    split.F(i / 3, i % 3) = static_cast<int>(i);
  }
  file.mesh = weld_by_position(split).mesh;
  note_collapsed(split, file.mesh, file.notes);
  return file;
}

}  // namespace geoprior
