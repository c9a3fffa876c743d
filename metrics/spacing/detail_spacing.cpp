#include "metrics/spacing/detail_spacing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "core/connectivity.h"
#include "core/error.h"

namespace geoprior {
namespace {

void require_points(const Eigen::MatrixX3i& triangles, std::size_t count) {
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const int v = triangles(t, c);
      if (v < 0 || static_cast<std::size_t>(v) >= count) {
        throw Error("no point " + std::to_string(v), "triangle " + std::to_string(t),
                    "0 to " + std::to_string(count) + " excluded");
      }
    }
  }
}

double decile(const std::vector<double>& sorted, int tenths) {
  // The smallest value with that share of the edges at or below it: ceil(n k / 10) - 1.
  const std::size_t upto = (sorted.size() * tenths + 9) / 10;
  return sorted[upto - 1];
}

double relative(double now, double original) { return (now - original) / original; }

}  // namespace

std::vector<std::pair<int, int>> edges_among_details(const Eigen::MatrixX3i& triangles,
                                                     std::span<const char> ghosts) {
  if (!ghosts.empty()) require_points(triangles, ghosts.size());
  const auto ghost = [&](int v) { return !ghosts.empty() && ghosts[v] != 0; };
  // Triangles with a ghost are not looked at, so their edges lack a partner.
  std::vector<std::array<int, 3>> whole;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const std::array<int, 3> f{triangles(t, 0), triangles(t, 1), triangles(t, 2)};
    if (!ghost(f[0]) && !ghost(f[1]) && !ghost(f[2])) whole.push_back(f);
  }
  // Two details may share several edges; each has a half-edge of either direction.
  const EdgeConnectivity connectivity(whole);
  std::vector<std::pair<int, int>> edges;
  for (int e = 0; e < connectivity.edge_count(); ++e) {
    const auto [low, high] = connectivity.edge(e);
    if (low == high) continue;
    const std::span<const int> here = connectivity.half_edges(e);
    const auto up =
        std::count_if(here.begin(), here.end(), [&](int h) { return connectivity.ascends(h); });
    const auto pairs = std::min(up, std::ssize(here) - up);
    edges.insert(edges.end(), pairs, {low, high});
  }
  return edges;
}

DetailSpacing detail_spacing(const Eigen::MatrixX3d& positions, const Eigen::MatrixX3i& triangles,
                             std::span<const char> ghosts, double reference) {
  require_points(triangles, positions.rows());
  std::vector<double> lengths;
  for (const auto& [a, b] : edges_among_details(triangles, ghosts)) {
    lengths.push_back((positions.row(a) - positions.row(b)).norm());
  }
  DetailSpacing s;
  if (lengths.empty()) return s;
  std::sort(lengths.begin(), lengths.end());
  const double n = static_cast<double>(lengths.size());
  s.edges = static_cast<int>(lengths.size());
  for (const double length : lengths) s.mean += length / n;
  double variance = 0;
  for (const double length : lengths) variance += (length - s.mean) * (length - s.mean) / n;
  s.variation = s.mean > 0 ? std::sqrt(variance) / s.mean : 0;
  s.smallest = lengths.front();
  for (int k = 1; k <= 9; ++k) s.deciles[k - 1] = decile(lengths, k);
  const double unit = reference > 0 ? reference : s.mean;
  const auto outside = std::count_if(lengths.begin(), lengths.end(), [&](double length) {
    return length < 0.7 * unit || length > 1.4 * unit;
  });
  s.outside = static_cast<double>(outside) / n;
  return s;
}

SpacingChange spacing_change(const DetailSpacing& original, const DetailSpacing& now) {
  if (!(original.deciles[0] > 0)) {
    throw Error("the original has no spacing", "spacing change", "edges of positive length");
  }
  SpacingChange change;
  change.mean = relative(now.mean, original.mean);
  for (std::size_t k = 0; k < 9; ++k) {
    change.deciles[k] = relative(now.deciles[k], original.deciles[k]);
  }
  return change;
}

WorstChange worst_mean_change(std::span<const DetailSpacing> frames) {
  if (frames.empty() || !(frames.front().mean > 0)) {
    throw Error("the original has no spacing", "worst mean change", "edges of positive length");
  }
  WorstChange worst;
  for (int i = 0; i < std::ssize(frames); ++i) {
    const double change = relative(frames[i].mean, frames.front().mean);
    if (std::abs(change) > std::abs(worst.change)) worst = {change, i};
  }
  return worst;
}

double density_ratio(int count, std::span<const int> faces, const Eigen::VectorXd& areas_then,
                     const Eigen::VectorXd& areas_now) {
  if (faces.empty() || areas_then.size() != areas_now.size()) {
    throw Error(std::to_string(faces.size()) + " details, " + std::to_string(areas_then.size()) +
                    " and " + std::to_string(areas_now.size()) + " areas",
                "density ratio", "at least one detail and equal numbers of areas");
  }
  double wanted = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const int f = faces[i];
    if (f < 0 || f >= areas_then.size() || !(areas_then(f) > 0)) {
      throw Error("face " + std::to_string(f) + " is none with an area",
                  "detail " + std::to_string(i));
    }
    wanted += areas_now(f) / areas_then(f);
  }
  if (!(wanted > 0)) throw Error("the surface has no area left", "density ratio");
  return static_cast<double>(count) / wanted;
}

}  // namespace geoprior
