#include "models/sketch/pattern/piece_borders.h"

#include "core/error.h"
#include "models/sketch/surface/cut_surface.h"

namespace geoprior::sketch {
namespace {

std::string shape_problem(const std::vector<CutPiece>& parts) {
  if (parts.empty()) return "no triangles";
  if (parts.size() != 1) return std::to_string(parts.size()) + " parts";
  if (parts[0].borders.empty()) return "no border";
  if (parts[0].genus() != 0) return std::to_string(parts[0].genus()) + " handles";
  return {};
}

bool has_length(const TriMesh& mesh, int t) {
  return mesh.V.row(mesh.F(t, 0)) != mesh.V.row(mesh.F(t, 1)) ||
         mesh.V.row(mesh.F(t, 0)) != mesh.V.row(mesh.F(t, 2));
}

}  // namespace

std::vector<std::vector<int>> piece_borders(const TriMesh& piece, const std::string& who) {
  const std::vector<CutPiece> parts = cut_surface(piece, {});
  if (const std::string problem = shape_problem(parts); !problem.empty()) {
    throw Error("a piece of surface with " + problem + " cannot be laid flat", who,
                "one part with a border and without handles");
  }
  if (parts[0].mesh.vertex_count() != piece.vertex_count()) {
    throw Error("a vertex is in no triangle, or two fans of triangles touch in one", who,
                "one fan of triangles at each vertex");
  }
  for (int t = 0; t < piece.triangle_count(); ++t) {
    if (!has_length(piece, t)) {
      throw Error("corners coincide", who + ": triangle " + std::to_string(t),
                  "a triangle with a length");
    }
  }
  std::vector<std::vector<int>> borders;
  for (const std::vector<int>& border : parts[0].borders) {
    std::vector<int>& loop = borders.emplace_back();
    for (const int v : border) loop.push_back(parts[0].surface_vertex[v]);
  }
  return borders;
}

std::vector<int> disc_border(const TriMesh& disc, const std::string& who) {
  const std::vector<std::vector<int>> borders = piece_borders(disc, who);
  if (borders.size() != 1) {
    throw Error("a piece of surface with " + std::to_string(borders.size()) + " borders", who,
                "a disc: one border");
  }
  return borders[0];
}

}  // namespace geoprior::sketch
