#include <algorithm>
#include <cmath>
#include <utility>

#include "baselines/details/intrinsic_triangulation.h"

namespace geoprior {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Angle opposite to an edge of length a.
double angle(double a, double b, double c, double area) {
  return std::atan2(4 * area, b * b + c * c - a * a);
}

}  // namespace

TriangulationReport IntrinsicTriangulation::check() const {
  TriangulationReport report;
  std::vector<int> corners_of(out_.size(), 0);
  std::vector<std::pair<int, int>> edges;
  int edge_count = 0;
  for (int t = 0; t < triangle_slots(); ++t) {
    if (!triangle_alive(t)) continue;
    ++report.triangles;
    const auto l = [&](int h) { return length_[index(h)]; };
    const double longest = std::max({l(3 * t), l(3 * t + 1), l(3 * t + 2)});
    if (!(l(3 * t) + l(3 * t + 1) + l(3 * t + 2) >= 2 * longest * (1 - 1e-12)))
      ++report.broken_triangles;
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      ++corners_of[index(origin(h))];
      const int g = twin(h);
      if (g < 0) {
        ++report.border_edges;
        ++edge_count;
        edges.emplace_back(std::min(origin(h), tip(h)), std::max(origin(h), tip(h)));
        continue;
      }
      if (twin(g) != h || origin(g) != tip(h) || tip(g) != origin(h)) ++report.broken_links;
      if (l(g) != l(h)) ++report.broken_triangles;
      if (g < h) continue;
      ++edge_count;
      edges.emplace_back(std::min(origin(h), tip(h)), std::max(origin(h), tip(h)));
      const double sum = angle(l(h), l(next(h)), l(previous(h)), area(t)) +
                         angle(l(g), l(next(g)), l(previous(g)), area(g / 3));
      report.worst_angle_sum = std::max(report.worst_angle_sum, sum);
      if (sum <= kPi + 1e-8) continue;
      ++(adjacent(origin(previous(h)), origin(previous(g))) ? report.blocked : report.not_delaunay);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges[i].first == edges[i].second || (i > 0 && edges[i] == edges[i - 1]))
      ++report.repeated_edges;
  }
  for (int v = 0; v < vertex_slots(); ++v) {
    if (!vertex_alive(v)) {
      report.broken_vertices += corners_of[index(v)] > 0 ? 1 : 0;
      continue;
    }
    ++report.vertices;
    if (origin(out_[index(v)]) != v || degree(v) != corners_of[index(v)]) ++report.broken_vertices;
  }
  report.euler = report.vertices - edge_count + report.triangles;
  return report;
}

}  // namespace geoprior
