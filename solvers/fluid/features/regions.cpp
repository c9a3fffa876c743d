#include "solvers/fluid/features/regions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace geoprior::fluid {
namespace {

void add_vertex(const SurfaceGraph& graph, const SurfaceShape& shape, std::size_t v, double cell,
                Region& region) {
  const Eigen::Vector3d& x = graph.x[v];
  const double a = shape.area[v];
  region.area += a;
  region.centre += a * x;
  region.mean_curvature += a * shape.curvature[v];
  region.crest_share += shape.curvature[v] > 0 ? a : 0;
  region.box_min = region.box_min.cwiseMin(x);
  region.box_max = region.box_max.cwiseMax(x);
  const std::int64_t key = support_cube(x, cell);
  if (region.support.empty() || region.support.back() != key) region.support.push_back(key);
}

void finish(Region& region) {
  if (region.area > 0) {
    region.centre /= region.area;
    region.velocity /= region.area;
    region.mean_curvature /= region.area;
    region.crest_share /= region.area;
  } else {
    region.centre = (region.box_min + region.box_max) / 2;
  }
  std::sort(region.support.begin(), region.support.end());
  region.support.erase(std::unique(region.support.begin(), region.support.end()),
                       region.support.end());
}

}  // namespace

std::int64_t support_cube(const Eigen::Vector3d& x, double cell) {
  const auto index = [&](double c) {
    return static_cast<std::int64_t>(std::clamp(std::floor(c / (2 * cell)), -1e6, 1e6));
  };
  return support_key(index(x.x()), index(x.y()), index(x.z()));
}

bool touches_support(const std::vector<std::int64_t>& support, std::int64_t cube) {
  for (std::int64_t i = -1; i <= 1; ++i) {
    for (std::int64_t j = -1; j <= 1; ++j) {
      const std::int64_t low = cube + support_key(i, j, -1);
      const auto it = std::lower_bound(support.begin(), support.end(), low);
      if (it != support.end() && *it <= low + 2) return true;
    }
  }
  return false;
}

std::vector<Region> region_attributes(const SurfaceGraph& graph, const SurfaceShape& shape,
                                      const std::vector<int>& label, int count,
                                      const Eigen::MatrixX3d& velocity, double cell) {
  std::vector<Region> regions(count);
  for (int r = 0; r < std::ssize(regions); ++r) {
    regions[r].label = r + 1;
    regions[r].has_velocity = velocity.rows() > 0;
    regions[r].box_min.setConstant(std::numeric_limits<double>::infinity());
    regions[r].box_max.setConstant(-std::numeric_limits<double>::infinity());
  }
  for (std::size_t v = 0; v < label.size(); ++v) {
    if (label[v] == 0) continue;
    Region& region = regions[label[v] - 1];
    add_vertex(graph, shape, v, cell, region);
    if (region.has_velocity) region.velocity += shape.area[v] * velocity.row(v).transpose();
  }
  for (Region& region : regions) finish(region);
  for (std::size_t v = 0; v < label.size(); ++v) {
    if (label[v] == 0) continue;
    Region& region = regions[label[v] - 1];
    const Eigen::Vector3d d = graph.x[v] - region.centre;
    if (region.area > 0) region.covariance += shape.area[v] / region.area * d * d.transpose();
  }
  return regions;
}

}  // namespace geoprior::fluid
