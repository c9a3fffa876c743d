#include "experiments/embryo/measures/surfaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/connectivity.h"
#include "metrics/volume/closedness.h"

namespace geoprior::embryo {
namespace {

bool has_any(const RecordedPiece& piece, const std::set<int>& structures) {
  return std::any_of(piece.structures.begin(), piece.structures.end(),
                     [&](int s) { return structures.contains(s); });
}

std::optional<double> pieces_of(const std::vector<RecordedPiece>& pieces,
                                const std::set<int>& structures) {
  if (structures.empty()) return std::nullopt;
  return static_cast<double>(std::count_if(
      pieces.begin(), pieces.end(), [&](const auto& piece) { return has_any(piece, structures); }));
}

std::set<int> kidneys(const Ontology& ontology) {
  std::set<int> found;
  for (std::size_t i = 0; i < ontology.structures.size(); ++i)
    if (ontology.structures[i].kind == "kidney") found.insert(static_cast<int>(i));
  return found;
}

/// What a division acts on, and what it makes.
std::set<int> divided(const Ontology& ontology) {
  std::set<int> found;
  for (const ProcessEntry& process : ontology.processes) {
    if (process.kind != ProcessKind::division || process.dormant) continue;
    found.insert(process.acts_on.begin(), process.acts_on.end());
    found.insert(process.produces.begin(), process.produces.end());
  }
  return found;
}

}  // namespace

SurfaceMeasures surface_measures(const EmbryoScene& scene, const Frame& frame) {
  SurfaceMeasures m;
  const std::vector<RecordedPiece> pieces = recorded_pieces(frame);
  std::map<int, int> triangles;
  for (const RecordedPiece& piece : pieces) {
    const Closedness closed = closedness(piece.mesh);
    m.defects += closed.defects();
    m.not_spheres += closed.euler_characteristic == 2 ? 0 : 1;
    for (const int s : piece.structure_of_triangle) ++triangles[s];
    m.triangles += piece.mesh.triangle_count();
  }
  m.structures = static_cast<double>(triangles.size());
  m.pieces = static_cast<double>(pieces.size());
  const auto least = std::min_element(triangles.begin(), triangles.end(),
                                      [](auto& a, auto& b) { return a.second < b.second; });
  if (least != triangles.end()) m.least_triangles = least->second;
  m.kidney_pieces = pieces_of(pieces, kidneys(scene.ontology));
  m.cloaca_pieces = pieces_of(pieces, divided(scene.ontology));
  m.surface_error = surface_error(scene, frame, pieces);
  m.overlap = undeclared_overlap(scene, pieces);
  m.seam_deg = seam_angle(pieces);
  return m;
}

std::optional<double> seam_angle(const std::vector<RecordedPiece>& pieces) {
  double squares = 0, length = 0;
  for (const RecordedPiece& piece : pieces) {
    if (piece.structures.size() < 2) continue;
    const EdgeConnectivity edges(piece.mesh.F);
    const Eigen::MatrixX3d normals = triangle_normals(piece.mesh);
    for (int e = 0; e < edges.edge_count(); ++e) {
      const auto both = edges.half_edges(e);
      if (both.size() != 2) continue;
      const int a = both[0] / 3, b = both[1] / 3;
      if (piece.structure_of_triangle[a] == piece.structure_of_triangle[b]) continue;
      const double cosine = std::clamp(normals.row(a).dot(normals.row(b)), -1.0, 1.0);
      const double angle = std::acos(cosine) * 180 / std::numbers::pi;
      const auto [u, v] = edges.edge(e);
      const double weight = (piece.mesh.V.row(u) - piece.mesh.V.row(v)).norm();
      squares += weight * angle * angle;
      length += weight;
    }
  }
  if (length == 0) return std::nullopt;
  return std::sqrt(squares / length);
}

}  // namespace geoprior::embryo
