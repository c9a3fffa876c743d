#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/random.h"
#include "models/details/scene.h"
#include "tests/core/geometry/shapes.h"

namespace geoprior::details::detail_scenes {

/// A point of the surface, uniform by area. `sums` are partial sums of the areas of the faces.
inline SurfacePoint uniform_point(const Eigen::VectorXd& sums, RandomStream& random) {
  const double s = random.uniform() * sums[sums.size() - 1];
  const auto face = std::upper_bound(sums.data(), sums.data() + sums.size() - 1, s) - sums.data();
  const double r = std::sqrt(random.uniform()), t = random.uniform();
  return {static_cast<int>(face), {1 - r, r * (1 - t), r * t}};
}

inline Eigen::VectorXd area_sums(const TriMesh& mesh) {
  Eigen::VectorXd sums = triangle_areas(mesh.V, mesh.F);
  for (Eigen::Index i = 1; i < sums.size(); ++i) sums[i] += sums[i - 1];
  return sums;
}

/// `count` uniform random details: a Poisson process of fixed number.
inline std::vector<Detail> random_details(const TriMesh& mesh, int count, std::uint64_t seed) {
  RandomStream random(seed, "details");
  const Eigen::VectorXd sums = area_sums(mesh);
  std::vector<Detail> details(count);
  for (Detail& d : details) d.at = uniform_point(sums, random);
  return details;
}

/// Best of ten candidates (Mitchell 1991), by distance in space: evenly spread, like Poisson-disk.
inline std::vector<Detail> even_details(const TriMesh& mesh, int count, std::uint64_t seed) {
  RandomStream random(seed, "details");
  const Eigen::VectorXd sums = area_sums(mesh);
  const double spacing = std::sqrt(sums[sums.size() - 1] / count), cell = 1.5 * spacing;
  const auto key = [&](const Eigen::Vector3d& p, int dx, int dy, int dz) {
    return std::array<int, 3>{static_cast<int>(std::floor(p.x() / cell)) + dx,
                              static_cast<int>(std::floor(p.y() / cell)) + dy,
                              static_cast<int>(std::floor(p.z() / cell)) + dz};
  };
  std::map<std::array<int, 3>, std::vector<Eigen::Vector3d>> grid;
  const auto nearest2 = [&](const Eigen::Vector3d& p) {
    double least = 2.25 * spacing * spacing;
    for (int c = 0; c < 27; ++c) {
      const auto found = grid.find(key(p, c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1));
      if (found == grid.end()) continue;
      for (const Eigen::Vector3d& q : found->second) least = std::min(least, (p - q).squaredNorm());
    }
    return least;
  };
  std::vector<Detail> details;
  for (int i = 0; i < count; ++i) {
    Detail best;
    double best_distance = -1;
    for (int candidate = 0; candidate < 10 + i / std::max(1, count / 30); ++candidate) {
      const SurfacePoint at = uniform_point(sums, random);
      const double d = nearest2(position_of(at, mesh.V, mesh.F));
      if (d <= best_distance) continue;
      best_distance = d;
      best.at = at;
    }
    const Eigen::Vector3d p = position_of(best.at, mesh.V, mesh.F);
    grid[key(p, 0, 0, 0)].push_back(p);
    details.push_back(best);
  }
  return details;
}

/// Frames 0 … frames of x -> map(x, s), s from 0 to 1.
inline std::shared_ptr<StoredMotion> motion(
    const TriMesh& mesh, int frames,
    const std::function<Eigen::Vector3d(const Eigen::Vector3d&, double)>& map) {
  std::vector<Eigen::MatrixX3d> positions;
  std::vector<double> parameters;
  for (int i = 0; i <= frames; ++i) {
    const double s = frames == 0 ? 0 : static_cast<double>(i) / frames;
    Eigen::MatrixX3d V = mesh.V;
    for (Eigen::Index v = 0; v < V.rows(); ++v) V.row(v) = map(mesh.V.row(v), s).transpose();
    positions.push_back(std::move(V));
    parameters.push_back(s);
  }
  return std::make_shared<StoredMotion>(std::move(positions), std::move(parameters));
}

/// x -> (1 + (factor - 1) s) x along the x axis.
inline std::shared_ptr<StoredMotion> stretch(const TriMesh& mesh, int frames, double factor) {
  return motion(mesh, frames, [&](const Eigen::Vector3d& p, double s) {
    return Eigen::Vector3d((1 + (factor - 1) * s) * p.x(), p.y(), p.z());
  });
}

/// Uniform scaling: the area grows by `area_factor`.
inline std::shared_ptr<StoredMotion> inflate(const TriMesh& mesh, int frames, double area_factor) {
  return motion(mesh, frames, [&](const Eigen::Vector3d& p, double s) -> Eigen::Vector3d {
    return (1 + (std::sqrt(area_factor) - 1) * s) * p;
  });
}

inline DetailScene scene(const TriMesh& mesh, std::vector<Detail> details,
                         std::shared_ptr<const SurfaceMotion> motion) {
  return {mesh, std::move(details), std::move(motion), "scene"};
}

}  // namespace geoprior::details::detail_scenes
