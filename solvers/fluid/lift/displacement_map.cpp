#include "solvers/fluid/lift/displacement_map.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/planar.h"

namespace geoprior::fluid {
namespace {

using Value = MapPatch::Value;

/// Slack of the inside test in barycentric coordinates: a texel on an edge belongs to both
/// triangles rather than to none.
constexpr double kEdgeSlack = 1e-9;

std::size_t texel(int resolution, int i, int j) {
  return static_cast<std::size_t>(j) * resolution + i;
}

struct Range {
  int first, last;
};

/// Texels whose centres lie between two coordinates (in texels).
Range texels_between(double low, double high, int resolution) {
  return {std::max(0, static_cast<int>(std::ceil(low - 0.5))),
          std::min(resolution - 1, static_cast<int>(std::floor(high - 0.5)))};
}

/// One triangle in texel units.
struct Triangle {
  Eigen::Vector2d a, b, c;
  double area;
};

void put(const Value& value, std::size_t at, const OverlapRule& rule, MapRaster& raster) {
  if (raster.covered[at] != 0) {
    if (rule.highest_channel < 0) return;
    if (value[rule.highest_channel] <= raster.value[at][rule.highest_channel]) return;
  }
  raster.covered[at] = 1;
  raster.value[at] = value;
}

void draw(const Triangle& t, const std::array<const Value*, 3>& values, const OverlapRule& rule,
          MapRaster& raster) {
  const int n = raster.resolution;
  const Range rows = texels_between(std::min({t.a.y(), t.b.y(), t.c.y()}) - 1e-6,
                                    std::max({t.a.y(), t.b.y(), t.c.y()}) + 1e-6, n);
  const Range columns = texels_between(std::min({t.a.x(), t.b.x(), t.c.x()}) - 1e-6,
                                       std::max({t.a.x(), t.b.x(), t.c.x()}) + 1e-6, n);
  for (int j = rows.first; j <= rows.last; ++j) {
    for (int i = columns.first; i <= columns.last; ++i) {
      const Eigen::Vector2d p(i + 0.5, j + 0.5);
      const double wa = cross(t.b - p, t.c - p) / t.area, wb = cross(t.c - p, t.a - p) / t.area;
      const double wc = 1 - wa - wb;
      if (wa < -kEdgeSlack || wb < -kEdgeSlack || wc < -kEdgeSlack) continue;
      put(static_cast<float>(wa) * *values[0] + static_cast<float>(wb) * *values[1] +
              static_cast<float>(wc) * *values[2],
          texel(n, i, j), rule, raster);
    }
  }
}

/// A level of the pyramid: values weighted by how much of a texel is known.
struct Level {
  int n = 0;
  std::vector<Value> value;
  std::vector<float> weight;
};

Level coarser(const Level& fine) {
  Level result;
  result.n = (fine.n + 1) / 2;
  const auto count = static_cast<std::size_t>(result.n) * result.n;
  result.value.assign(count, Value::Zero());
  result.weight.assign(count, 0);
  for (int j = 0; j < fine.n; ++j) {
    for (int i = 0; i < fine.n; ++i) {
      const std::size_t from = texel(fine.n, i, j), to = texel(result.n, i / 2, j / 2);
      result.value[to] += fine.weight[from] * fine.value[from];
      result.weight[to] += fine.weight[from];
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (result.weight[i] > 0) result.value[i] /= result.weight[i];
    result.weight[i] = std::min(result.weight[i], 1.0F);
  }
  return result;
}

/// Bilinear value of the coarser level at the centre of a texel of the finer one.
Value from_coarser(const Level& coarse, int i, int j) {
  const int ci = i / 2, cj = j / 2;
  const int ni = std::clamp(i % 2 == 0 ? ci - 1 : ci + 1, 0, coarse.n - 1);
  const int nj = std::clamp(j % 2 == 0 ? cj - 1 : cj + 1, 0, coarse.n - 1);
  return 0.5625F * coarse.value[texel(coarse.n, ci, cj)] +
         0.1875F * (coarse.value[texel(coarse.n, ni, cj)] + coarse.value[texel(coarse.n, ci, nj)]) +
         0.0625F * coarse.value[texel(coarse.n, ni, nj)];
}

void fill_from(const Level& coarse, Level& fine) {
  for (int j = 0; j < fine.n; ++j) {
    for (int i = 0; i < fine.n; ++i) {
      const std::size_t at = texel(fine.n, i, j);
      if (fine.weight[at] >= 1) continue;
      fine.value[at] =
          fine.weight[at] * fine.value[at] + (1 - fine.weight[at]) * from_coarser(coarse, i, j);
    }
  }
}

}  // namespace

MapRaster rasterise(const MapPatch& patch, int resolution, double extent, const OverlapRule& rule) {
  MapRaster raster;
  raster.resolution = resolution;
  raster.extent = extent;
  const auto count = static_cast<std::size_t>(resolution) * resolution;
  raster.value.assign(count, Value::Zero());
  raster.covered.assign(count, 0);
  const auto in_texels = [&](int v) -> Eigen::Vector2d {
    return (patch.uv[v] / extent).array() * resolution + 0.5 * resolution;
  };
  for (const auto& f : patch.triangles) {
    Triangle t{in_texels(f[0]), in_texels(f[1]), in_texels(f[2]), 0};
    t.area = (t.b - t.a).x() * (t.c - t.a).y() - (t.b - t.a).y() * (t.c - t.a).x();
    if (t.area <= 0) continue;
    draw(t, {&patch.value[f[0]], &patch.value[f[1]], &patch.value[f[2]]}, rule, raster);
  }
  return raster;
}

void fill_uncovered(MapRaster& raster) {
  if (std::none_of(raster.covered.begin(), raster.covered.end(), [](char c) { return c == 1; })) {
    return;
  }
  std::vector<Level> levels(1);
  levels[0].n = raster.resolution;
  levels[0].value = std::move(raster.value);
  levels[0].weight.resize(raster.covered.size());
  for (std::size_t i = 0; i < raster.covered.size(); ++i) {
    levels[0].weight[i] = raster.covered[i] == 1 ? 1.0F : 0.0F;
  }
  while (levels.back().n > 1) levels.push_back(coarser(levels.back()));
  for (std::size_t l = levels.size() - 1; l-- > 0;) fill_from(levels[l + 1], levels[l]);
  raster.value = std::move(levels[0].value);
}

void mark_outside(MapRaster& raster) {
  const int n = raster.resolution;
  std::vector<int> stack;
  const auto visit = [&](int i, int j) {
    if (i < 0 || j < 0 || i >= n || j >= n) return;
    char& mark = raster.covered[texel(n, i, j)];
    if (mark != 0) return;
    mark = 2;
    stack.push_back(j * n + i);
  };
  for (int k = 0; k < n; ++k) {
    visit(k, 0);
    visit(k, n - 1);
    visit(0, k);
    visit(n - 1, k);
  }
  while (!stack.empty()) {
    const int at = stack.back();
    stack.pop_back();
    const int i = at % n, j = at / n;
    visit(i - 1, j);
    visit(i + 1, j);
    visit(i, j - 1);
    visit(i, j + 1);
  }
}

std::optional<double> height_at(const HeightRaster& raster, const Eigen::Vector2d& uv) {
  const int n = raster.resolution;
  const Eigen::Array2d g = (uv.array() / raster.extent + 0.5) * n - 0.5;
  if (!(g >= 0).all() || !(g <= n - 1).all()) return {};
  const int i = std::min(static_cast<int>(g.x()), n - 2);
  const int j = std::min(static_cast<int>(g.y()), n - 2);
  const double s = g.x() - i, t = g.y() - j;
  double height = 0;
  for (int b = 0; b < 2; ++b) {
    for (int a = 0; a < 2; ++a) {
      const std::size_t at = texel(n, i + a, j + b);
      if (raster.known[at] != 1) return {};
      height +=
          (a == 0 ? 1 - s : s) * (b == 0 ? 1 - t : t) * static_cast<double>(raster.height[at]);
    }
  }
  return height;
}

}  // namespace geoprior::fluid
