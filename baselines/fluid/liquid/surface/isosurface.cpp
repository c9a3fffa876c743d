#include "baselines/fluid/liquid/surface/isosurface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "baselines/fluid/liquid/surface/isosurface_table.h"
#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr std::size_t kLayers = 2;  ///< layers of nodes of a parallel block
/// Vertices keep this share of an edge off its ends: no two coincide, no triangle degenerates.
constexpr double kEndMargin = 0.01;
/// Cells by which the nodes of the field's border move inwards, to make room for the layer of
/// outside nodes that closes the surface there.
constexpr double kBorderRoom = 0.02;

/// The field with a layer of outside nodes around it; where the border is inside, the surface
/// passes midway.
ScalarGrid padded(const ScalarGrid& nodes) {
  const Eigen::Vector3i inner = nodes.size, outer = inner.array() + 2;
  ScalarGrid result(outer, 0);
  parallel_blocks(outer.z(), kLayers, [&](std::size_t begin, std::size_t end) {
    for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
      for (int j = 0; j < outer.y(); ++j) {
        const int jn = std::clamp(j - 1, 0, inner.y() - 1),
                  kn = std::clamp(k - 1, 0, inner.z() - 1);
        const bool beyond = jn != j - 1 || kn != k - 1;
        const float* from = nodes.values.data() + nodes.index(0, jn, kn);
        float* to = result.values.data() + result.index(0, j, k);
        for (int i = 0; i < outer.x(); ++i) {
          const int in = std::clamp(i - 1, 0, inner.x() - 1);
          to[i] = beyond || in != i - 1 ? std::abs(from[in]) : from[in];
        }
      }
  });
  return result;
}

/// Where the vertices of a node's three upward edges are numbered.
struct NodeVertices {
  std::int32_t first = 0;
  std::uint8_t crossed = 0;  ///< bit a: the edge along axis a is crossed

  [[nodiscard]] std::int32_t of(int axis) const {
    const unsigned before = crossed & ((1U << axis) - 1U);
    return first + static_cast<std::int32_t>((before & 1U) + (before >> 1));
  }
};

class Contour {
 public:
  Contour(const ScalarGrid& nodes, const Eigen::Vector3d& origin, double cell)
      : nodes_(padded(nodes)), origin_(origin), cell_(cell), size_(nodes_.size) {
    const std::size_t nx = size_.x();
    stride_ = {1, nx, nx * size_.y()};
    for (std::size_t c = 0; c < 8; ++c)
      corner_[c] = (c & 1) * stride_[0] + ((c >> 1) & 1) * stride_[1] + (c >> 2) * stride_[2];
  }

  TriMesh run() {
    mark_inside();
    const std::size_t layers = size_.z();
    first_vertex_.assign(layers + 1, 0);
    first_triangle_.assign(layers + 1, 0);
    vertices_.resize(inside_.size());
    for_layers([&](int k) { count_layer(k); });
    for (std::size_t k = 0; k < layers; ++k) {
      first_vertex_[k + 1] += first_vertex_[k];
      first_triangle_[k + 1] += first_triangle_[k];
    }
    TriMesh mesh;
    mesh.V.resize(first_vertex_.back(), 3);
    mesh.F.resize(first_triangle_.back(), 3);
    for_layers([&](int k) { place_vertices(k, mesh); });
    for_layers([&](int k) { place_triangles(k, mesh); });
    return mesh;
  }

 private:
  template <class Body>
  void for_layers(const Body& body) const {
    parallel_blocks(size_.z(), kLayers, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) body(static_cast<int>(k));
    });
  }
  void mark_inside() {
    inside_.assign(nodes_.values.size(), 0);
    for_layers([&](int k) {
      if (k == 0 || k + 1 == size_.z()) return;
      for (int j = 1; j + 1 < size_.y(); ++j)
        for (int i = 1; i + 1 < size_.x(); ++i) {
          const std::size_t n = nodes_.index(i, j, k);
          inside_[n] = nodes_.values[n] < 0;
        }
    });
  }
  [[nodiscard]] std::size_t inside_corners(std::size_t node) const {
    std::size_t set = 0;
    for (std::size_t c = 0; c < 8; ++c) set |= std::size_t{inside_[node + corner_[c]]} << c;
    return set;
  }
  /// Bits of the axes along which the edge above a node is crossed.
  [[nodiscard]] unsigned crossed(std::size_t n, int i, int j, int k) const {
    unsigned bits = 0;
    if (i + 1 < size_.x()) bits |= unsigned{inside_[n]} ^ inside_[n + stride_[0]];
    if (j + 1 < size_.y()) bits |= (unsigned{inside_[n]} ^ inside_[n + stride_[1]]) << 1;
    if (k + 1 < size_.z()) bits |= (unsigned{inside_[n]} ^ inside_[n + stride_[2]]) << 2;
    return bits;
  }
  void count_layer(int k) {
    std::int32_t vertices = 0, triangles = 0;
    const bool has_cubes = k + 1 < size_.z();
    for (int j = 0; j < size_.y(); ++j)
      for (int i = 0; i < size_.x(); ++i) {
        const std::size_t n = nodes_.index(i, j, k);
        const unsigned bits = crossed(n, i, j, k);
        vertices_[n] = {vertices, static_cast<std::uint8_t>(bits)};
        vertices += static_cast<std::int32_t>((bits & 1U) + ((bits >> 1) & 1U) + (bits >> 2));
        if (has_cubes && i + 1 < size_.x() && j + 1 < size_.y())
          triangles += static_cast<std::int32_t>(table_.edges[inside_corners(n)].size() / 3);
      }
    first_vertex_[k + 1] = vertices;
    first_triangle_[k + 1] = triangles;
  }
  /// Coordinate of a node of the padded field in cells of the field.
  [[nodiscard]] double coordinate(int i, int axis) const {
    const int last = size_[axis] - 1;
    if (i == 0) return 0;
    if (i == last) return last - 2;
    return std::clamp<double>(i - 1, kBorderRoom, last - 2 - kBorderRoom);
  }
  void place_vertices(int k, TriMesh& mesh) {
    for (int j = 0; j < size_.y(); ++j)
      for (int i = 0; i < size_.x(); ++i) {
        NodeVertices& node = vertices_[nodes_.index(i, j, k)];
        node.first += first_vertex_[k];
        std::int32_t v = node.first;
        for (int a = 0; a < 3; ++a) {
          if (((node.crossed >> a) & 1) == 0) continue;
          const double here = nodes_(i, j, k),
                       there = nodes_(i + (a == 0), j + (a == 1), k + (a == 2));
          const double crossing = here / (here - there);
          const double t = crossing > kEndMargin ? std::min(crossing, 1 - kEndMargin) : kEndMargin;
          Eigen::Vector3d x(coordinate(i, 0), coordinate(j, 1), coordinate(k, 2));
          const int next = (a == 0 ? i : a == 1 ? j : k) + 1;
          x[a] += t * (coordinate(next, a) - x[a]);
          mesh.V.row(v++) = (origin_ + cell_ * x).transpose();
        }
      }
  }
  void place_triangles(int k, TriMesh& mesh) const {
    if (k + 1 == size_.z()) return;
    Eigen::Index t = first_triangle_[k];
    for (int j = 0; j + 1 < size_.y(); ++j)
      for (int i = 0; i + 1 < size_.x(); ++i) {
        const std::size_t n = nodes_.index(i, j, k);
        const std::size_t set = inside_corners(n);
        if (set == 0 || set == 255) continue;
        const std::vector<CubeEdge>& edges = table_.edges[set];
        for (std::size_t e = 0; e < edges.size(); e += 3, ++t)
          for (std::size_t c = 0; c < 3; ++c) {
            const CubeEdge& edge = edges[e + c];
            mesh.F(t, c) = vertices_[n + corner_[edge.corner]].of(edge.axis);
          }
      }
  }

  ScalarGrid nodes_;  ///< padded
  Eigen::Vector3d origin_;
  double cell_;
  Eigen::Vector3i size_;
  const CubeTable& table_ = cube_table();
  std::array<std::size_t, 3> stride_{};
  std::array<std::size_t, 8> corner_{};
  std::vector<std::uint8_t> inside_;
  std::vector<NodeVertices> vertices_;
  std::vector<std::int32_t> first_vertex_, first_triangle_;  ///< of every layer
};

}  // namespace

TriMesh isosurface(const ScalarGrid& nodes, const Eigen::Vector3d& origin, double cell) {
  if (nodes.size.minCoeff() < 2) return {};
  return Contour(nodes, origin, cell).run();
}

}  // namespace geoprior::fluid
