#include "solvers/sketch/surface/ruled_fill.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace geoprior::sketch {
namespace {

/// Place of the apex of a triangle whose base is laid from a to b, on the left.
Eigen::Vector2d laid_apex(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double base,
                          double to_a, double to_b) {
  const double along = (base * base + to_a * to_a - to_b * to_b) / (2 * base);
  const double height = std::sqrt(std::max(to_a * to_a - along * along, 0.0));
  const Eigen::Vector2d u = (b - a) / base;
  return a + along * u + height * Eigen::Vector2d(-u.y(), u.x());
}

}  // namespace

RuledStrip ruled_strip(const CurveNet& net, const RuledPatch& patch,
                       const Eigen::MatrixX3d& positions) {
  const SketchCurve& first = net.curves[patch.first];
  const SketchCurve& second = net.curves[patch.second];
  RuledStrip strip;
  std::vector<std::array<int, 3>> triangles;
  const auto add_vertex = [&](const SketchCurve& curve, int number) {
    strip.node.push_back(node_of(curve, number));
    return static_cast<int>(strip.node.size()) - 1;
  };
  const auto add_triangle = [&](int a, int b, int c) {
    const int x = strip.node[a], y = strip.node[b], z = strip.node[c];
    if (x != y && y != z && z != x) triangles.push_back({a, b, c});
  };
  int a = add_vertex(first, patch.cells.front()[0]);
  int b = add_vertex(second, patch.cells.front()[1]);
  for (std::size_t k = 1; k < patch.cells.size(); ++k) {
    const bool a_moves = patch.cells[k][0] != patch.cells[k - 1][0];
    const bool b_moves = patch.cells[k][1] != patch.cells[k - 1][1];
    const int next_a = a_moves ? add_vertex(first, patch.cells[k][0]) : a;
    const int next_b = b_moves ? add_vertex(second, patch.cells[k][1]) : b;
    const auto distance = [&](int u, int v) {
      return (positions.row(strip.node[u]) - positions.row(strip.node[v])).norm();
    };
    const bool from_a = a_moves && (!b_moves || distance(next_a, b) <= distance(a, next_b));
    if (from_a) {
      add_triangle(a, next_a, b);
      if (b_moves) add_triangle(next_a, next_b, b);
    } else {
      add_triangle(a, next_b, b);
      if (a_moves) add_triangle(a, next_a, next_b);
    }
    a = next_a;
    b = next_b;
  }
  strip.triangles.resize(triangles.size(), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) strip.triangles(t, k) = triangles[t][k];
  return strip;
}

Eigen::MatrixX2d unroll_strip(const RuledStrip& strip, const Eigen::MatrixX3d& positions) {
  Eigen::MatrixX2d flat = Eigen::MatrixX2d::Zero(strip.node.size(), 2);
  std::vector<bool> laid(strip.node.size(), false);
  const auto distance = [&](int u, int v) {
    return (positions.row(strip.node[u]) - positions.row(strip.node[v])).norm();
  };
  for (Eigen::Index t = 0; t < strip.triangles.rows(); ++t) {
    Eigen::Vector3i corner = strip.triangles.row(t).transpose();
    if (t == 0) {
      flat(corner(1), 0) = distance(corner(0), corner(1));
      laid[corner(0)] = laid[corner(1)] = true;
    }
    // Every later triangle has one new corner, which goes last.
    while (laid[corner(2)] && !(laid[corner(0)] && laid[corner(1)] && laid[corner(2)]))
      corner = Eigen::Vector3i(corner(1), corner(2), corner(0));
    const int a = corner(0), b = corner(1), c = corner(2);
    flat.row(c) = laid_apex(flat.row(a).transpose(), flat.row(b).transpose(), distance(a, b),
                            distance(a, c), distance(b, c))
                      .transpose();
    laid[c] = true;
  }
  return flat;
}

}  // namespace geoprior::sketch
