#include "solvers/sketch/layers/pattern.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "models/sketch/pattern/layout.h"

namespace geoprior::sketch {
namespace {

/// The rims, and the generators between them, counter-clockwise from the left end of the rear rim.
std::vector<PieceEdge> free_edges(const BandGrid& grid) {
  const int row = grid.around + 1;
  std::vector<PieceEdge> edges(4);
  for (int k = grid.around; k >= 0; --k) edges[0].vertices.push_back(grid.along * row + k);
  for (int i = grid.along; i >= 0; --i) edges[1].vertices.push_back(i * row);
  for (int k = 0; k <= grid.around; ++k) edges[2].vertices.push_back(k);
  for (int i = 0; i <= grid.along; ++i) edges[3].vertices.push_back(i * row + grid.around);
  return edges;
}

PatternPiece flat_band(const FrustumBand& band, const BandGrid& grid) {
  PatternPiece piece;
  const TriMesh sheet = band_sheet(band, grid);
  piece.triangles = sheet.F;
  piece.points.resize(sheet.V.rows(), 2);
  Eigen::Index v = 0;
  for (int i = 0; i <= grid.along; ++i) {
    const double x = -band.length * (grid.along - i) / grid.along;
    for (int k = 0; k <= grid.around; ++k) {
      const double s = band.half_angle * (2.0 * k - grid.around) / grid.around;
      piece.points.row(v++) = band.unrolled(x, s).transpose();
    }
  }
  piece.edges = free_edges(grid);
  std::vector<int> border;
  for (const PieceEdge& edge : piece.edges)
    border.insert(border.end(), edge.vertices.begin(), edge.vertices.end() - 1);
  piece.borders = {border};
  return piece;
}

void number_surface(PatternPiece& piece, std::size_t band) {
  const auto vertices = static_cast<int>(piece.points.rows());
  const auto triangles = static_cast<int>(piece.triangles.rows());
  for (int v = 0; v < vertices; ++v)
    piece.surface_vertex.push_back(static_cast<int>(band) * vertices + v);
  for (int t = 0; t < triangles; ++t)
    piece.surface_triangle.push_back(static_cast<int>(band) * triangles + t);
}

void add_holes(const FrustumBand& band, double x, double s, double radius, PatternPiece& piece) {
  for (const double side : {-s, s}) piece.holes.push_back({band.unrolled(x, side), radius});
}

/// Where the plane of the rear rim of `before` cuts the band, along its generators.
std::vector<Eigen::Vector2d> placement_line(const FrustumBand& band, const FrustumBand& before,
                                            int around) {
  std::vector<Eigen::Vector2d> line;
  for (int k = 0; k <= around; ++k) {
    const double s = band.half_angle * (2.0 * k - around) / around;
    const Eigen::Vector3d rear = band.point(0, s), front = band.point(-band.length, s);
    const double behind = (rear - before.rear).dot(before.axis);
    const double ahead = (front - before.rear).dot(before.axis);
    const double share = behind == ahead ? 0 : std::clamp(behind / (behind - ahead), 0.0, 1.0);
    line.push_back(band.unrolled(-share * band.length, s));
  }
  return line;
}

}  // namespace

std::string layer_name(const ArticulatedLayers& layers, std::size_t layer) {
  const std::string& name = layers.circles[layer + 1].name;
  return name.empty() ? "layer " + std::to_string(layer + 1) : name;
}

Pattern layer_pattern(const ArticulatedLayers& layers, const LayerOptions& options, double gap) {
  Pattern pattern;
  const double radius = options.rivet_radius * layers.unit;
  for (std::size_t j = 0; j < layers.bands.size(); ++j) {
    const FrustumBand& band = layers.bands[j];
    PatternPiece piece = flat_band(band, options.grid);
    number_surface(piece, j);
    piece.name = layer_name(layers, j);
    if (j > 0) {
      const LayerHinge& hinge = layers.hinges[j - 1];
      add_holes(band, hinge.rear_hole_at, hinge.rear_hole, radius, piece);
      piece.placements.push_back(placement_line(band, layers.bands[j - 1], options.grid.around));
    }
    if (j < layers.hinges.size()) {
      const LayerHinge& hinge = layers.hinges[j];
      add_holes(band, hinge.front_hole_at, hinge.front_hole, radius, piece);
    }
    pattern.pieces.push_back(std::move(piece));
  }
  lay_on_shelves(pattern, {.gap = gap});
  return pattern;
}

}  // namespace geoprior::sketch
