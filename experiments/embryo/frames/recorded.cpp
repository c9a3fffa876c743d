#include "experiments/embryo/frames/recorded.h"

#include <algorithm>

#include "core/disjoint_sets.h"
#include "core/error.h"

namespace geoprior::embryo {
namespace {

/// Some triangles of a part with the vertices that they use, in order.
TriMesh cut_out(const Part& part, const std::vector<int>& triangles) {
  std::vector<int> number(part.points.rows(), -1);
  for (const int t : triangles)
    for (int k = 0; k < 3; ++k) number[part.triangles(t, k)] = 0;
  int count = 0;
  for (int& n : number)
    if (n == 0) n = count++;
  TriMesh mesh;
  mesh.V.resize(count, 3);
  for (Eigen::Index v = 0; v < part.points.rows(); ++v)
    if (number[v] >= 0) mesh.V.row(number[v]) = part.points.row(v);
  mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) mesh.F(i, k) = number[part.triangles(triangles[i], k)];
  return mesh;
}

const NamedArray& structure_array(const Part& part) {
  return part.require_array(recorded::kStructure, NamedArray::On::cells, 1, recorded::kSurface);
}

}  // namespace

std::vector<RecordedShape> recorded_shapes(const Frame& frame) {
  std::vector<RecordedShape> shapes;
  const FrameTable* table = frame.find_table(recorded::kShapes);
  if (table == nullptr) return shapes;
  for (Eigen::Index r = 0; r < table->rows.rows(); ++r) {
    const auto row = table->rows.row(r);
    RecordedShape one;
    one.structure = static_cast<int>(row[0]);
    one.shape.primitive = static_cast<Primitive>(static_cast<int>(row[1]));
    one.shape.center = row.segment<3>(2).transpose();
    one.shape.axes = Eigen::Quaterniond(row[5], row[6], row[7], row[8]).toRotationMatrix();
    one.shape.radii = row.segment<3>(9).transpose();
    one.shape.egg = row[12];
    one.shape.branchings = row[13];
    shapes.push_back(one);
  }
  return shapes;
}

const RecordedShape* find_shape(const std::vector<RecordedShape>& shapes, int structure) {
  const auto found = std::find_if(shapes.begin(), shapes.end(), [&](const RecordedShape& one) {
    return one.structure == structure;
  });
  return found == shapes.end() ? nullptr : &*found;
}

std::vector<RecordedPiece> recorded_pieces(const Frame& frame) {
  std::vector<RecordedPiece> pieces;
  const Part* part = frame.find_part(recorded::kSurface);
  if (part == nullptr || part->triangles.rows() == 0) return pieces;
  DisjointSets sets(static_cast<int>(part->points.rows()));
  for (Eigen::Index t = 0; t < part->triangles.rows(); ++t) {
    sets.join(part->triangles(t, 0), part->triangles(t, 1));
    sets.join(part->triangles(t, 0), part->triangles(t, 2));
  }
  std::map<int, int> piece_of_root;
  std::vector<std::vector<int>> triangles;
  for (Eigen::Index t = 0; t < part->triangles.rows(); ++t) {
    const auto [it, is_new] = piece_of_root.try_emplace(sets.find(part->triangles(t, 0)),
                                                        static_cast<int>(triangles.size()));
    if (is_new) triangles.emplace_back();
    triangles[it->second].push_back(static_cast<int>(t));
  }
  const NamedArray& codes = structure_array(*part);
  for (const std::vector<int>& list : triangles) {
    RecordedPiece& piece = pieces.emplace_back();
    piece.mesh = cut_out(*part, list);
    for (const int t : list)
      piece.structure_of_triangle.push_back(static_cast<int>(codes.values(t, 0)));
    piece.structures = piece.structure_of_triangle;
    std::sort(piece.structures.begin(), piece.structures.end());
    piece.structures.erase(std::unique(piece.structures.begin(), piece.structures.end()),
                           piece.structures.end());
  }
  return pieces;
}

std::map<int, TriMesh> recorded_surfaces(const Frame& frame) {
  std::map<int, TriMesh> surfaces;
  const Part* part = frame.find_part(recorded::kSurface);
  if (part == nullptr || part->triangles.rows() == 0) return surfaces;
  const NamedArray& codes = structure_array(*part);
  std::map<int, std::vector<int>> triangles;
  for (Eigen::Index t = 0; t < part->triangles.rows(); ++t)
    triangles[static_cast<int>(codes.values(t, 0))].push_back(static_cast<int>(t));
  for (const auto& [structure, list] : triangles) surfaces[structure] = cut_out(*part, list);
  return surfaces;
}

double crown_rump_length(const Frame& frame) {
  return frame.require_table(recorded::kBody).rows(0, 0);
}

}  // namespace geoprior::embryo
