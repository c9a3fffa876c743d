#include "models/paper/tear/hoop_tension.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/planar.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Of a pattern's width: points of the border that are nearer to an edge lie on it.
constexpr double kOnEdge = 1e-9;
/// Places looked at.
constexpr int kPlaces = 720;

/// The outline of a hole by its length.
class Outline {
 public:
  explicit Outline(const std::vector<Vector2d>& loop) : loop_(loop), start_{0} {
    for (std::size_t i = 0; i < loop.size(); ++i)
      start_.push_back(start_.back() + (loop[(i + 1) % loop.size()] - loop[i]).norm());
  }
  [[nodiscard]] double length() const { return start_.back(); }
  [[nodiscard]] Vector2d at(double s) const {
    const auto next = std::upper_bound(start_.begin() + 1, start_.end() - 1, s);
    const std::size_t i = static_cast<std::size_t>(next - start_.begin()) - 1;
    return loop_[i] + (s - start_[i]) * tangent(i);
  }
  /// Where an edge of the mesh begins on the outline; absent when it does not lie on it.
  [[nodiscard]] std::optional<double> begin(const Vector2d& a, const Vector2d& b,
                                            double tolerance) const {
    for (std::size_t i = 0; i < loop_.size(); ++i) {
      const Vector2d t = tangent(i), to_a = a - loop_[i], to_b = b - loop_[i];
      const double end = start_[i + 1] - start_[i] + tolerance;
      const auto on = [&](const Vector2d& d) {
        return std::abs(cross(t, d)) <= tolerance && t.dot(d) >= -tolerance && t.dot(d) <= end;
      };
      if (on(to_a) && on(to_b)) return start_[i] + std::min(t.dot(to_a), t.dot(to_b));
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] Vector2d tangent(std::size_t i) const {
    return (loop_[(i + 1) % loop_.size()] - loop_[i]).normalized();
  }
  const std::vector<Vector2d>& loop_;
  std::vector<double> start_;  ///< of each edge, and the end
};

/// An edge of the mesh on the outline.
struct BorderEdge {
  double begin, length;  ///< m
  double tension;        ///< N/m
  int from;              ///< vertex
};

/// Integral of the raised cosine, from 0 to x: -1/2 before -reach, 1/2 beyond reach.
double share_up_to(double x, double reach) {
  const double part = std::clamp(x / reach, -1.0, 1.0);
  return part / 2 + std::sin(std::numbers::pi * part) / (2 * std::numbers::pi);
}

double mean_tension(const std::vector<BorderEdge>& edges, double s, double length) {
  const double reach = length / 4;
  double sum = 0;
  for (const BorderEdge& e : edges) {
    // The way round that is shorter.
    const double from = std::remainder(e.begin + e.length / 2 - s, length) - e.length / 2;
    sum += e.tension * (share_up_to(from + e.length, reach) - share_up_to(from, reach));
  }
  return sum;
}

}  // namespace

std::optional<HoopPeak> greatest_hoop_tension(const Sheet& sheet, const ShellState& state,
                                              const MeshNeighbours& neighbours,
                                              const std::vector<Vector2d>& loop) {
  const Outline outline(loop);
  const double same = kOnEdge * width(sheet.pattern);
  std::vector<BorderEdge> edges;
  for (int f = 0; f < state.mesh.triangle_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if (neighbours.edges.across(f, k) >= 0) continue;
      const Vector2d a = state.mesh.pattern.row(state.mesh.triangles(f, k));
      const Vector2d b = state.mesh.pattern.row(state.mesh.triangles(f, (k + 1) % 3));
      const auto begin = outline.begin(a, b, same);
      if (!begin) continue;
      const Vector2d tangent = (b - a).normalized();
      const double tension = tangent.dot(membrane_tension(sheet, state, f) * tangent);
      edges.push_back({*begin, (b - a).norm(), tension, state.mesh.triangles(f, k)});
    }
  }
  std::optional<double> best;
  double most = 0;
  for (int i = 0; i < kPlaces && !edges.empty(); ++i) {
    const double s = i * outline.length() / kPlaces;
    const double tension = mean_tension(edges, s, outline.length());
    if (tension <= most) continue;
    most = tension;
    best = s;
  }
  if (!best) return std::nullopt;
  const Vector2d place = outline.at(*best);
  // Every vertex of the outline begins one of its edges.
  const auto at = std::ranges::min_element(edges, {}, [&](const BorderEdge& e) {
    return (state.mesh.pattern.row(e.from).transpose() - place).norm();
  });
  return HoopPeak{place, most, at->from};
}

}  // namespace geoprior::paper
