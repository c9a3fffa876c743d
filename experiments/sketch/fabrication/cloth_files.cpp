#include "experiments/sketch/fabrication/cloth_files.h"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/error.h"
#include "models/sketch/pattern/piece_border.h"

namespace geoprior::sketch {
namespace {

using ClothJson = nlohmann::ordered_json;

/// As many digits as a double has.
std::string exact_number(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", x);
  return text.data();
}

/// A name as a group of an OBJ file may have it: one word.
std::string group_name(const Pattern& pattern, std::size_t piece) {
  std::string name = pattern.pieces[piece].name;
  for (char& c : name) {
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r') c = '-';
  }
  return name.empty() ? "piece-" + std::to_string(piece + 1) : name;
}

void require_surface(const Pattern& pattern, Eigen::Index vertices) {
  for (int p = 0; p < std::ssize(pattern.pieces); ++p) {
    for (const int v : pattern.pieces[p].surface_vertex) {
      if (v < 0 || v >= vertices) {
        throw Error("counts vertex " + std::to_string(v) + " of the surface",
                    piece_label(pattern, p), "0 to " + std::to_string(vertices - 1));
      }
    }
  }
}

/// First vertex of each piece in the file.
std::vector<int> first_vertices(const Pattern& pattern) {
  std::vector<int> first{0};
  for (const PatternPiece& piece : pattern.pieces)
    first.push_back(first.back() + static_cast<int>(piece.points.rows()));
  return first;
}

std::string garment_obj(const Pattern& pattern, const Eigen::MatrixX3d& surface,
                        const std::vector<int>& first) {
  std::string out = "# v: metres in space; vt: the same points of the pattern, metres\n";
  for (const PatternPiece& piece : pattern.pieces) {
    for (const int v : piece.surface_vertex) {
      out += "v " + exact_number(surface(v, 0)) + " " + exact_number(surface(v, 1)) + " " +
             exact_number(surface(v, 2)) + "\n";
    }
  }
  for (const PatternPiece& piece : pattern.pieces) {
    for (Eigen::Index i = 0; i < piece.points.rows(); ++i)
      out +=
          "vt " + exact_number(piece.points(i, 0)) + " " + exact_number(piece.points(i, 1)) + "\n";
  }
  for (std::size_t p = 0; p < pattern.pieces.size(); ++p) {
    out += "g " + group_name(pattern, p) + "\n";
    for (Eigen::Index t = 0; t < pattern.pieces[p].triangles.rows(); ++t) {
      out += "f";
      for (int k = 0; k < 3; ++k) {
        const std::string v = std::to_string(first[p] + pattern.pieces[p].triangles(t, k) + 1);
        out += " " + v + "/" + v;
      }
      out += "\n";
    }
  }
  return out;
}

ClothJson seams_json(const Pattern& pattern, const std::vector<int>& first) {
  ClothJson seams = ClothJson::array();
  for (std::size_t p = 0; p < pattern.pieces.size(); ++p) {
    const PatternPiece& piece = pattern.pieces[p];
    for (std::size_t e = 0; e < piece.edges.size(); ++e) {
      const PieceEdge& edge = piece.edges[e];
      const std::size_t q = edge.partner_piece;
      const std::size_t other = edge.partner_edge;
      if (edge.partner_piece < 0 || std::pair(q, other) < std::pair(p, e)) continue;
      const std::vector<int>& back = pattern.pieces[q].edges[other].vertices;
      ClothJson pairs = ClothJson::array();
      for (std::size_t i = 0; i < edge.vertices.size(); ++i) {
        const int a = first[p] + edge.vertices[i], b = first[q] + back[back.size() - 1 - i];
        if (a != b) pairs.push_back({a, b});  // equal at the tip of a dart
      }
      seams.push_back({{"seam", edge.seam}, {"pieces", {p, q}}, {"pairs", std::move(pairs)}});
    }
  }
  return seams;
}

}  // namespace

std::vector<FabricationFile> cloth_files(const Pattern& pattern, const Eigen::MatrixX3d& surface) {
  require_surface(pattern, surface.rows());
  const std::vector<int> first = first_vertices(pattern);
  ClothJson pieces = ClothJson::array();
  for (std::size_t p = 0; p < pattern.pieces.size(); ++p) {
    const Eigen::Vector2d grain = pattern.pieces[p].grain;
    pieces.push_back({{"name", pattern.pieces[p].name},
                      {"group", group_name(pattern, p)},
                      {"first_vertex", first[p]},
                      {"vertices", first[p + 1] - first[p]},
                      {"grain", {grain.x(), grain.y()}}});
  }
  const ClothJson root{{"format", "geoprior garment"},
                       {"version", 1},
                       {"unit", "m"},
                       {"mesh", "garment.obj"},
                       {"pieces", std::move(pieces)},
                       {"seams", seams_json(pattern, first)}};
  return {{"garment.obj", garment_obj(pattern, surface, first)},
          {"garment.json", root.dump(1, ' ', false, ClothJson::error_handler_t::replace) + "\n"}};
}

}  // namespace geoprior::sketch
